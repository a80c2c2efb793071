//! Galperin's billiard: the digits of π, counted in collisions.

use core::f64::consts::PI;

use super::case::{Case, Extent, Findings, Studied, Trial, t3, trial};
use super::{Figure, StudyError};
use crate::engine::EventDriven;
use crate::scene::{Scene, Sphere};
use crate::surroundings::Plane;

pub(super) const CASE: Case = Case {
    name: "galperin",
    title: "the digits of π, counted in collisions",
    law: "A ball at rest between a wall and one 100ᵏ times as heavy that comes in: ⌊π·10ᵏ⌋ \
          collisions (Galperin 2003). Each turns the velocities by 10⁻ᵏ rad, so to miscount none \
          the angle may be off by no more than the fraction of π·10ᵏ leaves; n roundings put it \
          off by √n ε. Judged where that is a third of it or less.",
    trials,
    combine: Findings::joined,
    picture: None,
};

/// The last k in each precision. In f64 k = 8 takes about 72 s. k = 9 was counted
/// once, in some 12 minutes of processor time: 3,141,592,653, which is right.
fn trials(extent: Extent) -> Vec<Trial> {
    let [single, double] = extent.of([6, 8], [5, 6]);
    (0..=double)
        .rev()
        .flat_map(|k| {
            let single = (k <= single).then(|| billiard::<f32>(k));
            single.into_iter().chain([billiard::<f64>(k)])
        })
        .collect()
}

fn billiard<T: Studied>(k: i32) -> Trial {
    let expected = PI * 10.0_f64.powi(k);
    let quantity = format!("collisions, k = {k}");
    trial::<T, _>(quantity.clone(), 2.3e-7 * expected, move || {
        let counted = collisions::<T>(100.0_f64.powi(k))? as f64;
        let margin = expected.fract().min(1.0 - expected.fract()) * 10.0_f64.powi(-k);
        let error = expected.sqrt() * T::EPSILON.to_f64();
        let figure = Figure::equal(T::PRECISION, quantity.clone(), counted, expected.floor(), "");
        Ok(vec![figure.beyond_precision_if(3.0 * error > margin)])
    })
}

/// The collisions in all of a billiard with this ratio of masses.
fn collisions<T: Studied>(ratio: f64) -> Result<u64, StudyError> {
    let ball = |x: f64| Sphere::new([x, 0.0, 0.0]).radius(0.0625);
    let scene = Scene::<T>::builder()
        .surroundings(Plane::new(t3([0.0; 3]), t3([1.0, 0.0, 0.0])))
        .sphere(ball(1.0))
        .sphere(ball(5.0).mass(ratio).velocity([-1.0, 0.0, 0.0]))
        .build()?;
    let mut world = EventDriven::new(scene)?;
    world.advance(400.0)?;
    Ok(world.collisions().total())
}
