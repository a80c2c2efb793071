//! How each figure is measured: the same steps and the same arithmetic for
//! every engine.

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use crate::peer::{
    BounceFigures, EnergyFigures, PairFigures, PeerError, SeamFigures, SpinFigures, Timing, World,
};
use crate::reference::{
    add_scaled, angle_between, contact_time, difference, dot, elastic_collision, length, rotation,
};
use crate::scene::{DT, RADIUS, SPIN, Scene, Surroundings};

/// A ball whose apex is below this part of the height of the drop has stopped.
pub const LEAST_APEX: f64 = 0.01;

/// At most this many steps before the clock starts: engines set up their
/// trees and buffers in them.
const WARM_UP_STEPS: usize = 20;

/// Steps after which all pairs of [`Scene::pairs`] have parted.
const PAIR_STEPS: usize = 60;

/// Wall time of a gas.
pub fn gas(mut world: Box<dyn World>, bodies: usize, steps: usize) -> Result<Timing, PeerError> {
    timed(world.as_mut(), bodies, steps)
}

/// Wall time of free flight.
pub fn free_flight(
    mut world: Box<dyn World>,
    bodies: usize,
    steps: usize,
) -> Result<Timing, PeerError> {
    timed(world.as_mut(), bodies, steps)
}

/// Wall time of spheres over hills.
pub fn terrain(
    mut world: Box<dyn World>,
    bodies: usize,
    steps: usize,
) -> Result<Timing, PeerError> {
    timed(world.as_mut(), bodies, steps)
}

fn timed(world: &mut dyn World, bodies: usize, steps: usize) -> Result<Timing, PeerError> {
    world.advance(WARM_UP_STEPS.min(steps))?;
    let start = Instant::now();
    world.advance(steps)?;
    // Asked for while the clock runs: an engine may leave orientations until then.
    black_box(world.orientation(bodies - 1));
    let nanoseconds = start.elapsed().as_secs_f64() * 1e9;
    Ok(Timing { nanoseconds: nanoseconds / (bodies as f64 * steps as f64) })
}

/// Energy change and collisions of many spheres.
pub fn energy(
    mut world: Box<dyn World>,
    scene: &Scene,
    steps: usize,
) -> Result<EnergyFigures, PeerError> {
    let bodies = scene.spheres.len();
    let initial = total_energy(world.as_ref(), scene);
    let collisions = world.advance_counted(steps)?;
    let final_energy = total_energy(world.as_ref(), scene);
    let holds = |place: [f64; 3]| match &scene.surroundings {
        Surroundings::Container { side } => place.iter().all(|x| (0.0..=*side).contains(x)),
        Surroundings::Terrain(terrain) => terrain.holds(place),
        Surroundings::None | Surroundings::Floor | Surroundings::FlatMesh(_) => true,
    };
    let escaped = (0..bodies).filter(|&i| !holds(world.position(i))).count();
    Ok(EnergyFigures { energy_change: final_energy / initial - 1.0, escaped, collisions, steps })
}

/// Energy of solid spheres of mass 1: ½ v² + ½ · ⅖ r² w² each, and that of
/// their height over z = 0.
fn total_energy(world: &dyn World, scene: &Scene) -> f64 {
    (0..scene.spheres.len())
        .map(|i| {
            let (v, w) = (world.velocity(i), world.spin(i));
            let moving = 0.5 * dot(v, v) + 0.2 * RADIUS * RADIUS * dot(w, w);
            moving - scene.gravity * world.position(i)[2]
        })
        .sum()
}

/// Apex after a number of bounces.
///
/// Between bounces the heights at the ends of steps lie on a parabola, with
/// any integrator that is exact or semi-implicit: three of them give the apex
/// between steps.
pub fn bounce(mut world: Box<dyn World>, bounces: usize) -> Result<BounceFigures, PeerError> {
    // A bounce takes 2 √2 units of time, 679 steps; ten of them are long
    // enough to say that there will be no other apex.
    const PATIENCE: usize = 6790;
    let mut figures = BounceFigures { bounces: 0, apex: 1.0, stopped: false };
    let height = |world: &dyn World| world.position(0)[2] - RADIUS;
    let mut before = height(world.as_ref());
    world.advance(1)?;
    let mut middle = height(world.as_ref());
    let mut waited = 0;
    while figures.bounces < bounces {
        world.advance(1)?;
        let after = height(world.as_ref());
        waited += 1;
        let is_apex = before < middle && middle >= after;
        if is_apex {
            let slope = 0.5 * (after - before);
            let curvature = before - 2.0 * middle + after;
            let apex = middle - 0.5 * slope * slope / curvature;
            if apex < LEAST_APEX {
                figures.stopped = true;
                break;
            }
            figures.apex = apex;
            figures.bounces += 1;
            waited = 0;
        }
        if waited > PATIENCE {
            figures.stopped = true;
            break;
        }
        (before, middle) = (middle, after);
    }
    Ok(figures)
}

/// What a ball on a flat mesh differs by from one on a plane, step by step.
pub fn seams(mut worlds: [Box<dyn World>; 2], steps: usize) -> Result<SeamFigures, PeerError> {
    let mut figures = SeamFigures::default();
    let [vx, vy, _] = worlds[0].velocity(0);
    let along = vx.hypot(vy);
    for _ in 0..steps {
        for world in &mut worlds {
            world.advance(1)?;
        }
        let [on_mesh, on_plane] = &worlds;
        let position = length(difference(on_mesh.position(0), on_plane.position(0)));
        let velocity = length(difference(on_mesh.velocity(0), on_plane.velocity(0)));
        figures.position = figures.position.max(position);
        figures.velocity = figures.velocity.max(velocity / along);
    }
    Ok(figures)
}

/// Angle error of a sphere that spins.
pub fn spin(mut world: Box<dyn World>, steps: usize) -> Result<SpinFigures, PeerError> {
    let initial = world.orientation(0);
    world.advance(steps)?;
    // Exact: the angle per step has 18 bits, the number of steps 20.
    let angle = length(SPIN) * DT * steps as f64;
    // Two turns of a quaternion are one; a thousand times what `TAU` leaves out
    // of 2 π would show.
    const TAU_TAIL: f64 = 2.4492935982947064e-16;
    let double_turns = (angle / (2.0 * TAU)).floor();
    let rest = angle % (2.0 * TAU) - 2.0 * TAU_TAIL * double_turns;
    let exact = rotation(SPIN, rest);
    debug_assert_eq!(initial, [0.0, 0.0, 0.0, 1.0], "bodies start unrotated");
    Ok(SpinFigures { angle_error: angle_between(exact, world.orientation(0)) })
}

/// Velocity errors of single collisions.
pub fn pairs(mut world: Box<dyn World>, scene: &Scene) -> Result<PairFigures, PeerError> {
    world.advance(PAIR_STEPS)?;
    let mut sum = 0.0;
    let mut energy_sum = 0.0;
    let mut largest: f64 = 0.0;
    let mut count = 0;
    for (i, pair) in scene.spheres.chunks_exact(2).enumerate() {
        let (one, two) = (pair[0], pair[1]);
        let r = difference(one.position, two.position);
        let v = difference(one.velocity, two.velocity);
        let Some(time) = contact_time(r, v, 2.0 * RADIUS) else {
            continue;
        };
        let exact = elastic_collision(one.velocity, two.velocity, add_scaled(r, time, v));
        let found = [world.velocity(2 * i), world.velocity(2 * i + 1)];
        for (exact, found) in exact.into_iter().zip(found) {
            let error = length(difference(found, exact)) / length(v);
            sum += error;
            largest = largest.max(error);
            count += 1;
        }
        let after = difference(found[0], found[1]);
        energy_sum += 2.0 * (dot(after, after) / dot(v, v) - 1.0);
    }
    Ok(PairFigures {
        mean_velocity_error: sum / f64::from(count),
        largest_velocity_error: largest,
        mean_energy_change: energy_sum / f64::from(count),
    })
}
