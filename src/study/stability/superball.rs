//! A superball between floor and ceiling: what a million bounces leave of it.

use super::case::{
    Case, Curve, Extent, Findings, Studied, Trial, greatest, in_epsilon, ratio, t3, trial,
};
use super::{Figure, StudyError};
use crate::contact::Surface;
use crate::engine::EventDriven;
use crate::lane::Lane;
use crate::real::Real;
use crate::scene::{Scene, Sphere};
use crate::surroundings::Plane;

pub(super) const CASE: Case = Case {
    name: "superball",
    title: "a rough ball between floor and ceiling, without gravity",
    law: "With I = q m r², z = vₓ + i(−1)ⁿ √q r w turns by α at every bounce, cos α = \
          (1 − q)/(1 + q) (Garwin 1969). Roundings let |z| walk: 8 √n ε at most. The angle may be \
          off by ε at every bounce, n ε in all, as I itself is rounded: the same each time.",
    trials,
    combine: Findings::joined,
    picture: None,
};

/// `I / (m r²)`: solid, hollow, and one that has a period of six bounces.
const FACTORS: [(i32, i32); 3] = [(2, 5), (2, 3), (1, 3)];

fn trials(extent: Extent) -> Vec<Trial> {
    let bounces = extent.of(1 << 20, 1 << 14);
    let of = |factor| [superball::<f32>(factor, bounces), superball::<f64>(factor, bounces)];
    FACTORS.into_iter().flat_map(of).collect()
}

fn superball<T: Studied>(factor: (i32, i32), bounces: u64) -> Trial {
    let (p, q) = factor;
    trial::<T, Findings>(format!("q = {p}/{q}"), 3e-7 * bounces as f64, move || {
        let errors = errors::<T>(factor, bounces)?;
        let size = |n: u64, size: f64| in_epsilon::<T>(size) / (n as f64).sqrt();
        let phase = |n: u64, angle: f64| in_epsilon::<T>(angle) / n as f64;
        let angles: Vec<_> = errors.iter().map(|&(n, _, angle)| (n as f64, angle)).collect();
        let is = T::PRECISION;
        let name = |what: &str| format!("{what}, q = {p}/{q}, {bounces} bounces");
        let figures = vec![
            Figure::at_most(
                is,
                name("|z| off"),
                greatest(errors.iter().map(|&(n, s, _)| size(n, s))),
                8.0,
                "√n ε",
            ),
            Figure::at_most(
                is,
                name("angle off"),
                greatest(errors.iter().map(|&(n, _, a)| phase(n, a))),
                1.0,
                "n ε",
            ),
        ];
        let name = format!("q = {p}/{q}");
        Ok(Findings { figures, curves: vec![Curve::new(is, name, angles)] })
    })
}

/// The relative error of `|z|` and the absolute one of its angle, rad, after
/// numbers of bounces, each twice the one before.
fn errors<T: Studied>(
    (p, q): (i32, i32),
    bounces: u64,
) -> Result<Vec<(u64, f64, f64)>, StudyError> {
    let radius = 0.5;
    let ball = Sphere::new([0.0, 0.0, 1.0]).radius(radius).velocity([1.0, 0.0, -1.0]);
    let scene = Scene::<T>::builder()
        .surface(Surface::Rough)
        .surroundings(Plane::new(t3([0.0; 3]), t3([0.0, 0.0, 1.0])))
        .surroundings(Plane::new(t3([0.0, 0.0, 2.0]), t3([0.0, 0.0, -1.0])))
        .sphere(ball.inertia_factor(f64::from(p) / f64::from(q)))
        .build()?;
    let mut world = EventDriven::new(scene)?;

    // z after 2ᵏ bounces, from 1: one turn, squared again and again.
    let factor = ratio::<T>(p, q);
    let one = T::Judge::ONE;
    let (cosine, root) = ((one - factor) / (one + factor), factor.sqrt());
    let mut turned = (cosine, (one - cosine * cosine).sqrt());
    let mut errors = Vec::new();
    let mut n = 1;
    while n <= bounces {
        world.advance_until(n - world.collisions().total(), 4.0 * bounces as f64)?;
        let bodies = world.bodies();
        let side = if n % 2 == 0 { -one } else { one };
        let spin = bodies.spin_of(0).y.cast::<T::Judge>() * T::Judge::from_f64(radius);
        let (x, y) = (bodies.velocity_of(0).x.cast::<T::Judge>(), side * root * spin);
        let size = (x * x + y * y).sqrt();
        // Sine of the angle from what it should be, which is small.
        let off = (x * turned.1 - y * turned.0) / size;
        let angle = if x * turned.0 + y * turned.1 > T::Judge::ZERO { off.to_f64() } else { 2.0 };
        errors.push((n, (size - one).to_f64().abs(), angle.abs()));
        let (c, s) = turned;
        turned = (c * c - s * s, (c + c) * s);
        n *= 2;
    }
    Ok(errors)
}
