//! Cascades of collisions that come ever faster, in wedges.

use core::f64::consts::PI;

use super::Figure;
use super::case::{Case, Extent, Findings, Studied, Trial, in_epsilon, t3, trial};
use crate::engine::EventDriven;
use crate::numbers::array::Each;
use crate::scene::{Scene, Sphere};
use crate::surroundings::Plane;

pub(super) const CASE: Case = Case {
    name: "cascades",
    title: "collisions that come ever faster, and end",
    law: "A sphere that flies into a wedge of angle α along one side leaves it after ⌊π/α⌋ bounces; \
          so does a light ball between two heavy ones that close in, cos α = M/(M + m), as three \
          balls on a line are a point in a wedge (Galperin 2003). At α = π/(n + ½) the count bears an \
          error of π/2n. Where n ε/2, of a normal or a mass that is rounded once and taken n times, \
          is more, the precision cannot count. A ball that jumps in a wedge keeps its energy but for a walk \
          of 12 √n ε.",
    trials,
    combine: Findings::joined,
    picture: None,
};

fn trials(extent: Extent) -> Vec<Trial> {
    let decades = extent.of(6, 4);
    let mut trials = Vec::new();
    for decade in 1..=decades {
        let n = 10_u64.pow(decade);
        trials.extend([wedge::<f32>(n), wedge::<f64>(n), squeezed::<f32>(n), squeezed::<f64>(n)]);
    }
    let jumps = extent.of(1_000_000, 10_000);
    for slope in [0.1, 1.0, 10.0] {
        trials.extend([jumping::<f32>(slope, jumps), jumping::<f64>(slope, jumps)]);
    }
    trials
}

/// The count of a cascade of `n`, judged where the precision can count it.
fn counted<T: Studied>(name: String, n: u64, found: u64) -> Figure {
    let figure = Figure::equal(T::PRECISION, name, found as f64, n as f64, "");
    let (error, margin) = (n as f64 * T::EPSILON.to_f64() / 2.0, PI / (2.0 * n as f64));
    figure.beyond_precision_if(error > margin)
}

fn wedge<T: Studied>(n: u64) -> Trial {
    trial::<T, _>(format!("wedge, {n}"), 3e-7 * n as f64, move || {
        let angle = PI / (n as f64 + 0.5);
        let radius = 1.0 / 16.0;
        // The planes that hold the sphere's centre meet at the origin.
        let normals = [[0.0, 1.0, 0.0], [angle.sin(), -angle.cos(), 0.0]];
        let mut builder = Scene::<T>::builder();
        for normal in normals {
            let point = normal.each(|component| -radius * component);
            builder = builder.surroundings(Plane::new(t3(point), t3(normal)));
        }
        let ball = Sphere::new([1.0, 0.5 * angle, 0.0]).radius(radius).velocity([-1.0, 0.0, 0.0]);
        let mut world = EventDriven::new(builder.sphere(ball).build()?)?;
        world.advance(64.0)?;
        let found = world.collisions().total();
        let speed = world.bodies().velocity_of(0).length().to_f64();
        let walk = in_epsilon::<T>((speed - 1.0).abs()) / (n as f64).sqrt();
        Ok(vec![
            counted::<T>(format!("bounces in a wedge of π/{n}½"), n, found),
            Figure::at_most(T::PRECISION, format!("speed after that, π/{n}½"), walk, 4.0, "√n ε"),
        ])
    })
}

fn squeezed<T: Studied>(n: u64) -> Trial {
    trial::<T, _>(format!("squeezed, {n}"), 3e-7 * n as f64, move || {
        // 1/cos α − 1, without a difference of what is nearly equal.
        let angle = PI / (n as f64 + 0.5);
        let half = (0.5 * angle).sin();
        let light = 2.0 * half * half / angle.cos();
        let ball = |x: f64| Sphere::new([x, 0.0, 0.0]).radius(0.0625);
        let scene = Scene::<T>::builder()
            .sphere(ball(0.0).mass(1.0))
            .sphere(ball(1.0).mass(light))
            .sphere(ball(3.0).mass(1.0).velocity([-1.0, 0.0, 0.0]));
        let mut world = EventDriven::new(scene.build()?)?;
        world.advance(64.0)?;
        let found = world.collisions().total();
        Ok(vec![counted::<T>(format!("collisions of three, π/{n}½"), n, found)])
    })
}

fn jumping<T: Studied>(slope: f64, jumps: u64) -> Trial {
    trial::<T, _>(format!("jumping, slope {slope}"), 3e-7 * jumps as f64, move || {
        let plane = |side: f64| Plane::new(t3([0.0; 3]), t3([side, 0.0, 1.0 / slope]));
        let gravity = -1.0;
        let scene = Scene::<T>::builder()
            .gravity(t3([0.0, 0.0, gravity]))
            .surroundings(plane(1.0))
            .surroundings(plane(-1.0))
            .sphere(Sphere::new([0.3, 0.0, 20.0]).radius(0.25));
        let mut world = EventDriven::new(scene.build()?)?;
        let start = world.energy().total();
        world.advance_until(jumps, 1e12)?;
        let change = (world.energy().total() / start - 1.0).abs();
        let walk = in_epsilon::<T>(change) / (jumps as f64).sqrt();
        let name = format!("energy of a ball in a wedge, slope {slope}");
        Ok(vec![Figure::at_most(T::PRECISION, name, walk, 12.0, "√n ε")])
    })
}
