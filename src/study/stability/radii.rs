//! Radii in great proportions.

use super::case::{
    Case, Extent, Findings, Random, Studied, Trial, greatest, in_epsilon, t3, trial,
};
use super::{Figure, StudyError, gas, pair};
use crate::contact::Surface;
use crate::numbers::array::Each;
use crate::scene::{Scene, Sphere, Spheres};
use crate::study::table::power_of_ten;
use crate::surroundings::Cuboid;

pub(super) const CASE: Case = Case {
    name: "radius-ratio",
    title: "radii of 1 and down to 10⁻⁶",
    law: "A collision of two of the same density (masses up to 10¹⁸) is right to a few ε of the \
          relative velocity, and so are the surfaces' velocities r w. A hundred small spheres around a \
          great one in a box of width 4 keep the energy but for a walk of 12 √n ε of one body's \
          share, and overlap by 4 δ at most, the rounding of a place and of the time.",
    trials,
    combine: Findings::joined,
    picture: None,
};

fn trials(extent: Extent) -> Vec<Trial> {
    let (pairs, collisions) = extent.of((20_000, 1_000_000), (500, 20_000));
    let mut trials = Vec::new();
    for power in [0, 2, 4, 6] {
        trials.extend([two::<f32>(power, pairs), two::<f64>(power, pairs)]);
        if power > 0 {
            trials.extend([many::<f32>(power, collisions), many::<f64>(power, collisions)]);
        }
    }
    trials
}

fn two<T: Studied>(power: i32, pairs: u64) -> Trial {
    let ten = power_of_ten(power);
    trial::<T, _>(format!("pairs, {ten}"), 1e-4 * pairs as f64, move || {
        let mut random = Random(2);
        let mut worst: f64 = 0.0;
        for k in 0..pairs {
            let (small, surface) =
                (k as usize % 2, [Surface::Smooth, Surface::Rough][k as usize / 2 % 2]);
            let mut radii = [1.0; 2];
            radii[small] = 10.0_f64.powi(-power);
            let aim = 0.7 * random.unit();
            let balls = pair::meeting(&mut random, radii, radii.each(|r| r * r * r), aim);
            if let Some((off, _)) = pair::measured::<T>(&balls, surface, 10.0)? {
                worst = greatest([worst, greatest(off)]);
            }
        }
        let name = format!("a pair, {ten}");
        Ok(vec![Figure::at_most(T::PRECISION, name, in_epsilon::<T>(worst), 16.0, "ε")])
    })
}

fn many<T: Studied>(power: i32, collisions: u64) -> Trial {
    let ten = power_of_ten(power);
    trial::<T, _>(format!("dust, {ten}"), 1e-6 * collisions as f64, move || {
        let mut figures = Vec::new();
        for surface in [Surface::Smooth, Surface::Rough] {
            let kept = gas::run(dust::<T>(power, surface)?, collisions, SIDE)?;
            let name = |what: &str| format!("{what}, {surface}, {ten}");
            figures.extend([kept.energy::<T>(name), kept.overlap::<T>(name)]);
        }
        Ok(figures)
    })
}

/// Of the box.
const SIDE: f64 = 4.0;

/// A great sphere among small ones of the same mass.
fn dust<T: Studied>(power: i32, surface: Surface) -> Result<Scene<T>, StudyError> {
    let spin = if surface == Surface::Rough { 1.0 } else { 0.0 };
    let dust = Spheres::random(100).radius(10.0_f64.powi(-power)).mass(1.0);
    let scene = Scene::<T>::builder()
        .surface(surface)
        .surroundings(Cuboid::container(t3([0.0; 3]), t3([SIDE; 3])))
        .sphere(Sphere::new([2.0, 1.9, 2.1]).radius(1.0).mass(1.0).velocity([0.5, 1.0, -1.0]))
        .spheres(dust.temperature(1.0).spin_temperature(spin));
    Ok(scene.build()?)
}
