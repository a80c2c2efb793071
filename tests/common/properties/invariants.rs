//! Invariants: what two states of a scene and the events between them must satisfy.

use carom::bodies::Bodies;
use carom::engine::{Event, Partner};
use carom::motion::Integrator;
use carom::observe::{Totals, energy_scale, fall_energy, integrator_drift, not_finite};
use carom::real::Real;
use carom::scene::{Encounters, Impact, Scene};
use carom::vec3::Vec3;

/// Roundings of a collision, of a step and of a body, in units of ε, that any bound
/// allows for.
const ROUNDINGS: f64 = 64.0;

/// Collisions that a body has in a step at most.
const MOST_IN_STEP: usize = 10_000;

/// What an engine says of a run.
pub struct Run<T: Real> {
    pub time: f64,
    pub steps: u64,
    pub events: Vec<Event<T>>,
    pub impulse_from_surroundings: [f64; 3],
    pub bodies: Bodies<T>,
}

/// What bounds are made of: the greatest figures of the run.
struct Scales {
    /// Coordinates, length.
    far: f64,
    /// Length per time.
    speed: f64,
    /// What roundings come to, as a fraction.
    rounding: f64,
}

impl Scales {
    fn of<T: Real>(scene: &Scene<T>, run: &Run<T>) -> Self {
        let greatest = |bodies: [&Bodies<T>; 2], of: fn(&Bodies<T>, usize) -> Vec3<T>| {
            let vectors =
                bodies.into_iter().flat_map(|bodies| (0..bodies.len()).map(move |k| of(bodies, k)));
            vectors.map(|vector| vector.cast::<f64>().length()).fold(0.0, f64::max)
        };
        let both = [&scene.bodies, &run.bodies];
        let shapes = scene.surroundings.iter().flat_map(|shape| shape.features());
        let corners = shapes.filter_map(|feature| feature.bounds()).flatten();
        let farthest = corners.map(|corner| corner.cast::<f64>().length()).fold(0.0, f64::max);
        let fallen = scene.gravity.cast::<f64>().length() * run.time;
        let ends = run.events.len() as f64 + run.steps as f64 + scene.bodies.len() as f64;
        let speed = run.events.iter().map(|event| event.velocity.cast::<f64>().length());
        Self {
            far: greatest(both, |bodies, k| bodies.position_of(k)).max(farthest),
            speed: speed.fold(greatest(both, |bodies, k| bodies.velocity_of(k)) + fallen, f64::max),
            rounding: ROUNDINGS * T::EPSILON.to_f64() * (ends + 1.0),
        }
    }
}

/// Holds a run against all that elastic motion keeps.
pub fn check<T: Real>(scene: &Scene<T>, run: &Run<T>) {
    if let Some(not_finite) = not_finite(&run.bodies) {
        panic!("{not_finite:?}");
    }
    let scales = Scales::of(scene, run);
    check_events(scene, run);
    check_totals(scene, run, &scales);
    // A body that has had its collisions of a step moves through what it meets after them.
    let is_spent = run.events.len() >= MOST_IN_STEP;
    if run.steps == 0 || (scene.stepped.impact == Impact::SubStep && !is_spent) {
        check_gaps(scene, run, &scales);
    }
}

fn check_events<T: Real>(scene: &Scene<T>, run: &Run<T>) {
    let mut before = 0.0;
    for event in &run.events {
        assert!(event.time >= before && event.time <= run.time, "{} in {event:?}", run.time);
        before = event.time;
        assert!(event.normal_impulse >= T::ZERO, "{event:?}");
        let length = event.normal.cast::<f64>().length();
        assert!((length - 1.0).abs() < 8.0 * T::EPSILON.to_f64(), "{event:?}");
        assert!((event.a as usize) < scene.bodies.len());
        match event.partner {
            Partner::Body { index, .. } => assert!(event.a < index, "{event:?}"),
            Partner::Surroundings(part) => assert!((part as usize) < scene.surroundings.len()),
            _ => {}
        }
    }
}

/// Energy, momentum and angular momentum are kept, or change by a known amount.
fn check_totals<T: Real>(scene: &Scene<T>, run: &Run<T>, scales: &Scales) {
    let Scales { far, speed, rounding } = *scales;
    let bodies = &scene.bodies;
    let mass: f64 = (0..bodies.len()).map(|k| bodies.mass.of(k).to_f64()).sum();
    let (before, after) =
        (Totals::of(bodies, scene.gravity), Totals::of(&run.bodies, scene.gravity));
    assert!(after.is_finite(), "{after:?}");
    let gravity = scene.gravity.cast::<f64>();

    // Where space wraps, so does the potential. The law of an integrator is exact where
    // collisions change velocities only.
    let is_at_end = run.steps > 0 && scene.stepped.impact == Impact::EndOfStep;
    let is_exact = scene.stepped.integrator == Integrator::VelocityVerlet;
    let has_law = scene.periodic.is_none() && (run.steps == 0 || is_at_end || is_exact);
    if has_law || gravity == Vec3::ZERO {
        let kinetic = [before.energy.kinetic(), after.energy.kinetic()];
        let potential = [before.energy.potential, after.energy.potential];
        let scale = energy_scale(kinetic, potential, fall_energy(scene)) + mass * speed * speed;
        let law = if is_at_end {
            let dt = scene.stepped.dt.unwrap_or(0.0);
            integrator_drift(scene.stepped.integrator, run.steps, dt, gravity.length(), mass)
        } else {
            0.0
        };
        let change = after.energy.total() - before.energy.total() - law;
        let bound = rounding * (scale + law.abs() + mass * gravity.length() * far);
        assert!(change.abs() <= bound, "energy: {change:e} is above {bound:e}");
    }

    let bound = rounding * mass * (speed + gravity.length() * run.time);
    let given = Vec3::from(run.impulse_from_surroundings) + gravity * (mass * run.time);
    let change = (after.momentum.0 - before.momentum.0 - given).length();
    assert!(change <= bound, "momentum: {change:e} is above {bound:e}");

    if scene.periodic.is_none() && scene.surroundings.is_empty() && gravity == Vec3::ZERO {
        let spin = |bodies: &Bodies<T>| -> f64 {
            let spins = (0..bodies.len())
                .map(|k| bodies.spin_of(k).cast::<f64>() * bodies.inertia.of(k).to_f64());
            spins.map(|spin| spin.length()).sum()
        };
        let bound = rounding * (mass * far * speed + spin(bodies) + spin(&run.bodies));
        let change = (after.angular_momentum.0 - before.angular_momentum.0).length();
        assert!(change <= bound, "angular momentum: {change:e} is above {bound:e}");
    }
}

/// Nothing overlaps beyond the rounding of places.
fn check_gaps<T: Real>(scene: &Scene<T>, run: &Run<T>, scales: &Scales) {
    let bodies = &run.bodies;
    let reach = |a: usize, b: usize| (bodies.radius.of(a) + bodies.radius.of(b)).to_f64();
    let radius = bodies.radius.greatest().to_f64();
    // In steps, what rests on something falls for a step and is thrown back in the next.
    let dt = if run.steps > 0 { scene.stepped.dt.unwrap_or(0.0) } else { 0.0 };
    let fall = scene.gravity.cast::<f64>().length() * dt * dt;
    let bound = fall + scales.rounding * (scales.far + scales.speed * run.time + radius);
    if scene.encounters == Encounters::All {
        for b in 0..bodies.len() {
            for a in 0..b {
                let mut offset = (bodies.position_of(a).cast::<f64>()
                    - bodies.position_of(b).cast::<f64>())
                .to_array();
                if let Some(space) = scene.periodic {
                    let sides = space.sides().cast::<f64>().to_array();
                    for (x, side) in offset.iter_mut().zip(sides) {
                        *x -= side * (*x / side).round();
                    }
                }
                let gap = Vec3::from(offset).length() - reach(a, b);
                assert!(gap >= -bound, "bodies {a} and {b}: {gap:e} is below -{bound:e}");
            }
        }
    }
    // An image of what is fixed is as near as the thing itself: seen by the others.
    if scene.periodic.is_none() && scene.encounters != Encounters::None {
        for (part, shape) in scene.surroundings.iter().enumerate() {
            for feature in shape.features() {
                for k in 0..bodies.len() {
                    let gap = feature.clearance(bodies.position_of(k), bodies.radius.of(k)).gap;
                    let gap = gap.to_f64();
                    assert!(
                        gap >= -bound,
                        "body {k} in surroundings[{part}]: {gap:e} below -{bound:e}"
                    );
                }
            }
        }
    }
}
