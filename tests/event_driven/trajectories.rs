//! Three unequal spheres in the unit box, 120 events in 80-digit arithmetic
//! (`tests/data/trajectories.json`): a rough gas, and smooth spheres that fall.

use carom::contact::Surface;
use carom::engine::{Compiled, Event, Partner};
use carom::real::Real;
use carom::scene::{Buildable, Scene, Sphere};
use carom::surroundings::Cuboid;
use serde::Deserialize;

use crate::{builder, events, t3, world};

#[derive(Deserialize)]
struct Known {
    rough: bool,
    g: [f64; 3],
    radii: [f64; 3],
    mass: [f64; 3],
    c0: [[f64; 3]; 3],
    v0: [[f64; 3]; 3],
    w0: [[f64; 3]; 3],
    /// Kind, body, other body or axis, side, time.
    events: Vec<(String, u32, u32, u32, f64)>,
    /// Centres, velocities and spins after a number of events.
    states: std::collections::BTreeMap<u64, State>,
}

#[derive(Deserialize)]
struct State {
    c: [[f64; 3]; 3],
    v: [[f64; 3]; 3],
    w: [[f64; 3]; 3],
}

fn known(name: &str) -> Known {
    let text = include_str!("../data/trajectories.json");
    let mut scenes: std::collections::BTreeMap<String, Known> = serde_json::from_str(text).unwrap();
    scenes.remove(name).unwrap()
}

fn scene<T: Buildable>(known: &Known) -> Scene<T> {
    let surface = if known.rough { Surface::Rough } else { Surface::Smooth };
    let mut builder = builder::<T>()
        .surface(surface)
        .gravity(t3(known.g))
        .surroundings(Cuboid::container(t3([0.0; 3]), t3([1.0; 3])));
    for k in 0..3 {
        let sphere = Sphere::new(known.c0[k]).radius(known.radii[k]).mass(known.mass[k]);
        builder = builder.sphere(sphere.velocity(known.v0[k]).spin(known.w0[k]));
    }
    builder.build().unwrap()
}

/// Body, other body or axis, side: what the file calls an event.
fn named<T: Real>(event: &Event<T>) -> (&'static str, u32, u32, u32) {
    match event.partner {
        Partner::Body { index, .. } => ("pair", event.a, index, 0),
        Partner::Surroundings(_) => {
            let normal = event.normal.to_array().map(T::to_f64);
            let axis = (0..3).find(|&axis| normal[axis].abs() == 1.0).unwrap();
            ("wall", event.a, axis as u32, u32::from(normal[axis] < 0.0))
        }
        other => panic!("{other:?}"),
    }
}

/// How many events come as they should.
fn events_in_order<T: Compiled>(known: &Known) -> usize {
    let end = known.events.last().unwrap().4;
    let found = events(&mut world(scene::<T>(known)), end * 1.01);
    let is_right = |(found, (kind, a, b, side, _)): (&Event<T>, &(String, u32, u32, u32, f64))| {
        named(found) == (kind.as_str(), *a, *b, *side)
    };
    found.iter().zip(&known.events).take_while(|&pair| is_right(pair)).count()
}

/// The greatest errors of any component of the centres, velocities and spins,
/// and of the time, after some numbers of events.
fn errors<T: Compiled>(known: &Known) -> Vec<(u64, [f64; 4])> {
    let mut world = world(scene::<T>(known));
    let mut errors = Vec::new();
    for (&count, state) in &known.states {
        let before = world.collisions().total();
        world.advance_until(count - before, 1e3).unwrap();
        let bodies = world.bodies();
        let mut error = [0.0_f64; 4];
        for k in 0..3 {
            let found = [bodies.position_of(k), bodies.velocity_of(k), bodies.spin_of(k)];
            for (what, exact) in [state.c[k], state.v[k], state.w[k]].into_iter().enumerate() {
                for (x, exact) in found[what].to_array().into_iter().zip(exact) {
                    error[what] = error[what].max((x.to_f64() - exact).abs());
                }
            }
        }
        error[3] = (world.time() - known.events[count as usize - 1].4).abs();
        errors.push((count, error));
    }
    errors
}

/// Each event in its order, in `f64` all of them; and errors that are what
/// rounding at the start has grown to, `bounds` after 10, 30, 60 and 100 events.
fn follows(name: &str, single: usize, bounds: [f64; 4]) {
    let known = known(name);
    let in_order = [events_in_order::<f32>(&known), events_in_order::<f64>(&known)];
    println!("{name}: f32 {} events in order, f64 {}", in_order[0], in_order[1]);
    assert!(in_order[0] >= single, "f32: {}", in_order[0]);
    assert_eq!(in_order[1], known.events.len());
    for ((count, error), bound) in errors::<f64>(&known).into_iter().zip(bounds) {
        let [c, v, w, t] = error;
        println!("{name}: after {count} events c {c:.1e} v {v:.1e} w {w:.1e} t {t:.1e}");
        assert!(c <= bound, "after {count} events: {c:e}");
    }
}

#[test]
fn rough_gas() {
    follows("gas3_rough", 70, [2e-15, 4e-14, 2e-11, 2e-8]);
}

#[test]
fn smooth_spheres_that_fall() {
    follows("grav3_smooth", 56, [4e-15, 8e-13, 3e-9, 4e-6]);
}
