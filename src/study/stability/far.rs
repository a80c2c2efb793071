//! Places far from the origin.

use super::case::{
    Case, Extent, Findings, Random, Studied, Trial, greatest, in_epsilon, t3, trial,
};
use super::{Figure, StudyError, gas, pair};
use crate::contact::Surface;
use crate::scene::{Scene, Spheres};
use crate::study::table::power_of_ten;
use crate::surroundings::Cuboid;
use crate::vec3::Vec3;

pub(super) const CASE: Case = Case {
    name: "far-away",
    title: "10⁸ diameters from the origin",
    law: "A place at X is right to ε X: so is the direction of a normal, and by 4 ε X at most of \
          the velocity two bodies part wrongly; overlaps are no deeper than 4 δ, the rounding of a place \
          and of the time. Energy does not know of \
          places: 12 √n ε of one body's share, as everywhere. Where ε X is more than 0.01 \
          diameters the precision cannot hold the scene.",
    trials,
    combine: Findings::joined,
    picture: None,
};

fn trials(extent: Extent) -> Vec<Trial> {
    let (pairs, collisions) = extent.of((20_000, 1_000_000), (500, 20_000));
    let mut trials = Vec::new();
    for power in [0, 2, 4, 6, 8] {
        trials.extend([two::<f32>(power, pairs), two::<f64>(power, pairs)]);
        trials.extend([many::<f32>(power, collisions), many::<f64>(power, collisions)]);
    }
    trials
}

/// Whether a position this number of powers of ten of diameters away is uncertain by more
/// than a hundredth of one.
fn is_lost<T: Studied>(power: i32) -> bool {
    T::EPSILON.to_f64() * 10.0_f64.powi(power) > 0.01
}

/// What is shown where the scene cannot even be built.
fn lost<T: Studied>(name: String, bound: f64, unit: &str) -> Figure {
    Figure::at_most(T::PRECISION, name, f64::NAN, bound, unit).beyond_precision()
}

fn two<T: Studied>(power: i32, pairs: u64) -> Trial {
    let ten = power_of_ten(power);
    trial::<T, _>(format!("pairs, {ten}"), 1e-4 * pairs as f64, move || {
        let far = 10.0_f64.powi(power);
        let name = format!("two that meet at {ten}");
        if is_lost::<T>(power) {
            return Ok(vec![lost::<T>(name, 4.0, "ε X")]);
        }
        let mut random = Random(4);
        let mut worst: f64 = 0.0;
        for k in 0..pairs {
            let surface = [Surface::Smooth, Surface::Rough][k as usize % 2];
            let aim = 0.7 * random.unit();
            let mut balls = pair::meeting(&mut random, [0.5; 2], [1.0; 2], aim);
            for ball in &mut balls {
                ball.position += Vec3::new(far, far, -far);
            }
            if let Some((off, _)) = pair::measured::<T>(&balls, surface, 10.0)? {
                worst = greatest([worst, greatest(off)]);
            }
        }
        let off = in_epsilon::<T>(worst) / far.max(3.0);
        Ok(vec![Figure::at_most(T::PRECISION, name, off, 4.0, "ε X")])
    })
}

fn many<T: Studied>(power: i32, collisions: u64) -> Trial {
    let ten = power_of_ten(power);
    trial::<T, _>(format!("gas, {ten}"), 1e-6 * collisions as f64, move || {
        let name = |what: &str| format!("{what} of a gas at {ten}");
        if is_lost::<T>(power) {
            return Ok(vec![
                lost::<T>(name("energy"), gas::WALK, "√n ε"),
                lost::<T>(name("overlap"), 4.0, "δ"),
            ]);
        }
        let far = 10.0_f64.powi(power);
        let kept = gas::run(distant_gas::<T>(far)?, collisions, far + 8.0)?;
        Ok(vec![kept.energy::<T>(name), kept.overlap::<T>(name)])
    })
}

/// A rough gas in a box whose lower corner is far away.
fn distant_gas<T: Studied>(far: f64) -> Result<Scene<T>, StudyError> {
    let (lower, upper) = ([far; 3], [far + 8.0; 3]);
    let spheres = Spheres::random(100).radius(0.5).temperature(1.0).spin_temperature(1.0);
    let scene = Scene::<T>::builder()
        .surface(Surface::Rough)
        .surroundings(Cuboid::container(t3(lower), t3(upper)))
        .spheres(spheres);
    Ok(scene.build()?)
}
