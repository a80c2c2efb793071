//! Spheres that graze each other.

use super::case::{Case, Extent, Findings, Random, Studied, Trial, greatest, in_epsilon, trial};
use super::{Figure, StudyError, pair};
use crate::contact::Surface;

pub(super) const CASE: Case = Case {
    name: "grazing",
    title: "two spheres whose paths come within 1 − δ of contact, δ = ±0.9 … ±10⁻¹⁷",
    law: "The normal is right to ε/√δ, as the place of contact moves so much along the path; the smooth \
          map is continuous, so no error is greater than some √ε. The rough map has a step at δ = 0: \
          the pair parts as one that meets or as one that misses, each to the same error, and by no \
          other way. Which one is decided rightly for |δ| of 64 ε or more.",
    trials,
    combine: Findings::joined,
    picture: None,
};

fn trials(extent: Extent) -> Vec<Trial> {
    let pairs = extent.of(5_000, 100);
    [Surface::Smooth, Surface::Rough]
        .into_iter()
        .flat_map(|surface| [graze::<f32>(surface, pairs), graze::<f64>(surface, pairs)])
        .collect()
}

/// What is measured of all pairs.
#[derive(Default)]
struct Worst {
    /// Over ε/√δ, where the precision decides whether they meet.
    normal: f64,
    /// Over √ε, everywhere, from the nearer of the two ways to part.
    step: f64,
    /// Pairs that met and should not, or missed and should not.
    wrong: u64,
    /// The same where the precision cannot decide.
    undecided: u64,
}

fn graze<T: Studied>(surface: Surface, pairs: u64) -> Trial {
    trial::<T, _>(surface.to_string(), 36.0 * 3e-5 * pairs as f64, move || {
        let mut random = Random(5);
        let mut worst = Worst::default();
        for k in 0..36 * pairs {
            let side = if k % 2 == 0 { 1.0 } else { -1.0 };
            let delta = side * 10.0_f64.powi(-(k as i32 / 2 % 18)) * 0.9;
            measure::<T>(&mut random, surface, delta, &mut worst)?;
        }
        let name = |what: &str| format!("{what}, {surface}");
        Ok(vec![
            Figure::at_most(T::PRECISION, name("decided wrongly"), worst.wrong as f64, 0.0, ""),
            Figure::at_most(T::PRECISION, name("off where decided"), worst.normal, 16.0, "ε/√δ"),
            Figure::at_most(
                T::PRECISION,
                name("off, from either way to part"),
                worst.step,
                8.0,
                "√ε",
            ),
            Figure::at_most(
                T::PRECISION,
                name("on the other side, nearer"),
                worst.undecided as f64,
                0.0,
                "",
            )
            .beyond_precision(),
        ])
    })
}

/// One pair, whose paths come within `1 − δ` of the sum of the radii.
fn measure<T: Studied>(
    random: &mut Random,
    surface: Surface,
    delta: f64,
    worst: &mut Worst,
) -> Result<(), StudyError> {
    let radii = [0.5, 0.25 + 0.125 * random.unit()];
    let balls = pair::meeting(random, radii, [1.0, 1.5], 1.0 - delta);
    let scene = pair::scene::<T>(&balls, surface)?;
    // The rounded scene has a δ of its own.
    let delta = pair::depth(&scene);
    let (expected, missed) = (pair::expected(&scene), pair::untouched(&scene));
    let touching = pair::touching(&scene);
    let found = pair::found(scene, 10.0)?;
    let is_decided = delta.abs() >= 64.0 * T::EPSILON.to_f64();
    match (is_decided, found.is_some() == expected.is_some()) {
        (true, false) => worst.wrong += 1,
        (false, false) => worst.undecided += 1,
        _ => {}
    }
    let error = match found {
        Some(found) => {
            // One that should miss is held to one that just touches.
            greatest(found.off(&expected.unwrap_or(touching)))
        }
        None if surface == Surface::Smooth => greatest(missed.off(&expected.unwrap_or(missed))),
        None => 0.0,
    };
    if is_decided {
        worst.normal = greatest([worst.normal, in_epsilon::<T>(error) * delta.abs().sqrt()]);
    }
    worst.step = greatest([worst.step, error / T::EPSILON.to_f64().sqrt()]);
    Ok(())
}
