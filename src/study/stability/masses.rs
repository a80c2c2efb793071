//! Masses in great proportions.

use super::case::{
    Case, Extent, Findings, Random, Studied, Trial, greatest, in_epsilon, t3, trial,
};
use super::{Figure, StudyError, gas, pair};
use crate::contact::Surface;
use crate::scene::{Scene, Spheres};
use crate::space::PeriodicBox;
use crate::study::table::power_of_ten;

pub(super) const CASE: Case = Case {
    name: "mass-ratio",
    title: "masses of 1 and up to 10¹²",
    law: "A collision of two is right to a few ε, of the relative velocity for the light body, and \
          for the heavy one of its own, however small its share. A gas of both at one temperature \
          keeps energy and momentum but for a walk of 12 √n ε of one body's share. Where the ratio is \
          within three decades of 1/ε, 1/m + 1/M rounds to the same side again and again, and \
          the energy drifts.",
    trials,
    combine: Findings::joined,
    picture: None,
};

fn trials(extent: Extent) -> Vec<Trial> {
    let (pairs, collisions) = extent.of((20_000, 2_000_000), (500, 20_000));
    let mut trials = Vec::new();
    for power in [0, 3, 6, 9, 12] {
        trials.extend([two::<f32>(power, pairs), two::<f64>(power, pairs)]);
        trials.extend([many::<f32>(power, collisions), many::<f64>(power, collisions)]);
    }
    trials
}

fn two<T: Studied>(power: i32, pairs: u64) -> Trial {
    let ten = power_of_ten(power);
    trial::<T, _>(format!("pairs, {ten}"), 1e-4 * pairs as f64, move || {
        let mut random = Random(1);
        // Light on heavy, and heavy on light; the light one's error, the heavy one's.
        let mut worst = [[0.0; 2]; 2];
        for k in 0..pairs {
            let (heavy, surface) =
                (k as usize % 2, [Surface::Smooth, Surface::Rough][k as usize / 2 % 2]);
            let mut masses = [1.0; 2];
            masses[heavy] = 10.0_f64.powi(power);
            let aim = 0.7 * random.unit();
            let mut balls = pair::meeting(&mut random, [0.5; 2], masses, aim);
            balls[heavy].spin = balls[heavy].spin * if heavy == 0 { 1.0 } else { 0.0 };
            let Some((error, expected)) = pair::measured::<T>(&balls, surface, 10.0)? else {
                continue;
            };
            let light = 1 - heavy;
            let own = error[heavy] / expected.speeds()[heavy];
            worst[heavy] =
                [greatest([worst[heavy][0], error[light]]), greatest([worst[heavy][1], own])];
        }
        let mut figures = Vec::new();
        for (heavy, what) in ["heavy on light", "light on heavy"].into_iter().enumerate() {
            for (error, which) in worst[heavy].into_iter().zip(["light", "heavy"]) {
                let name = format!("{what}, {ten}: the {which} one");
                figures.push(Figure::at_most(
                    T::PRECISION,
                    name,
                    in_epsilon::<T>(error),
                    16.0,
                    "ε",
                ));
            }
        }
        Ok(figures)
    })
}

fn many<T: Studied>(power: i32, collisions: u64) -> Trial {
    let ten = power_of_ten(power);
    trial::<T, _>(format!("gas, {ten}"), 1e-6 * collisions as f64, move || {
        let mut figures = Vec::new();
        for surface in [Surface::Smooth, Surface::Rough] {
            let kept = gas::run(mixture::<T>(power, surface)?, collisions, 9.0)?;
            let name = |what: &str| format!("{what} of a {surface} gas, {ten}");
            let rounds_alike = gas::rounds_alike::<T>(10.0_f64.powi(-power));
            figures.push(kept.energy::<T>(name).beyond_precision_if(rounds_alike));
            figures.push(kept.momentum::<T>(name));
        }
        Ok(figures)
    })
}

/// As many light spheres as heavy ones.
fn mixture<T: Studied>(power: i32, surface: Surface) -> Result<Scene<T>, StudyError> {
    let mut builder = Scene::<T>::builder()
        .surface(surface)
        .periodic(PeriodicBox::new(t3([0.0; 3]), t3([9.0; 3])));
    for mass in [1.0, 10.0_f64.powi(power)] {
        let spheres = Spheres::random(100).radius(0.5).mass(mass);
        let spin = if surface == Surface::Rough { 1.0 } else { 0.0 };
        builder = builder.spheres(spheres.temperature(1.0).spin_temperature(spin));
    }
    Ok(builder.build()?)
}
