//! Engines: a small scene of ordinary sizes moves as elastic spheres do, with the same
//! bits on every path, in either precision, whatever its units and its origin.

use carom::contact::Surface;
use carom::engine::{
    Compiled, EngineError, Event, EventDriven, Execution, Lanes, Order, Partner, Stepped,
};
use carom::motion::Integrator;
use carom::observe::state_hash;
use carom::real::Real;
use carom::scene::{Impact, OrientationUpdate, Scene, SceneBuilder, Sphere, Summation};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, FixedSphere, Plane};

use super::Outcome;
use super::draws::Draws;
use super::invariants::{Run, check};

/// Cells along an edge of the lattice in which the bodies start, one in each.
const EDGE: usize = 3;

/// Collisions of a run.
const MOST_EVENTS: u64 = 100;

const LANES: [Lanes; 4] = [Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen];

/// Powers of ten that units are multiplied by.
const UNITS: [i32; 8] = [0, 0, 0, 0, -3, 5, -12, 12];

/// A scene in the making, in units of its own: about 1 apart, at speeds of about 1.
struct Described<T: Real> {
    builder: SceneBuilder<T>,
    /// The scene's unit of time.
    time: f64,
    /// Whether bodies may come to rest, where time stands still.
    may_stand_still: bool,
    /// Whether some may do so from the start.
    may_rest: bool,
}

/// Bytes as a scene, moved event by event.
pub fn event_driven(bytes: &[u8]) -> Outcome {
    let mut draws = Draws::new(bytes);
    if draws.flag() { events::<f32>(&mut draws) } else { events::<f64>(&mut draws) }
}

/// Bytes as a scene, moved in steps.
pub fn stepped(bytes: &[u8]) -> Outcome {
    let mut draws = Draws::new(bytes);
    if draws.flag() { steps::<f32>(&mut draws) } else { steps::<f64>(&mut draws) }
}

fn events<T: Compiled>(draws: &mut Draws) -> Outcome {
    let duration = 6.0 * draws.share();
    let (lanes, part) = (draws.pick(&LANES), draws.share());
    let described = describe::<T>(draws, false);
    let duration = duration * described.time;
    let Ok(scene) = described.builder.build() else { return Outcome::Refused };

    show(&scene);
    let strictly = Execution::new().order(Order::Strict).threads(1);
    let (found, end) = story(&scene, strictly, &[duration]);
    check(&scene, &found);
    let is_stopped = match end {
        Ok(()) => false,
        Err(EngineError::Stalled { .. }) if described.may_stand_still => true,
        Err(error) => panic!("{error}"),
    };
    if is_stopped {
        return Outcome::Stopped;
    }
    goes_on_as_a_new_scene(&scene, &found, duration / 8.0);
    // In other lanes, with a stop on the way, and in windows of time, it is the same.
    // Threads that come and go take longer than all else.
    let threads = if part < 0.1 { 3 } else { 1 };
    for other in [strictly, Execution::new().order(Order::Windows).threads(threads)] {
        let (same, end) = story(&scene, other.lanes(lanes), &[found.time * part, found.time]);
        assert!(end.is_ok(), "{end:?}");
        check_same(&found, &same);
    }
    Outcome::Ran
}

/// What a world leaves is a scene, which both engines take.
fn goes_on_as_a_new_scene<T: Compiled>(scene: &Scene<T>, run: &Run<T>, time: f64) {
    let left = scene.with_bodies(run.bodies.clone()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(state_hash(&left.bodies), state_hash(&run.bodies));
    if left.stepped.dt.is_some() {
        let later = march(&left, Execution::new().threads(1), &[2]);
        scene.with_bodies(later.bodies).unwrap_or_else(|error| panic!("{error}"));
    }
    let (later, end) = story(&left, Execution::new().threads(1), &[time]);
    // What a step leaves in others may rattle between them.
    assert!(matches!(end, Ok(()) | Err(EngineError::Stalled { .. })), "{end:?}");
    scene.with_bodies(later.bodies).unwrap_or_else(|error| panic!("{error}"));
}

/// All events up to the last of some times, or up to the time of the last of a number.
fn story<T: Compiled>(
    scene: &Scene<T>,
    execution: Execution,
    times: &[f64],
) -> (Run<T>, Result<(), EngineError>) {
    let mut world = EventDriven::with_execution(scene.clone(), execution).unwrap();
    let mut events = Vec::new();
    let mut end = Ok(());
    let mut listener = |event: &Event<T>| events.push(*event);
    for &time in times {
        end = world.advance_to(time, MOST_EVENTS, Some(&mut listener)).and_then(|is_there| {
            // All that happens at the time of the last one.
            let now = if is_there { time } else { world.time() };
            world.advance_to(now, u64::MAX, Some(&mut listener)).map(|_| ())
        });
        if end.is_err() {
            break;
        }
    }
    let run = Run {
        time: world.time(),
        steps: 0,
        events,
        impulse_from_surroundings: world.impulse_from_surroundings(),
        bodies: world.bodies(),
    };
    (run, end)
}

fn steps<T: Compiled>(draws: &mut Draws) -> Outcome {
    let dt = [0.002, 0.02, 0.1, 0.5][usize::from(draws.below(4))] * (draws.share() + 0.1);
    let steps = 1 + u64::from(draws.below(48));
    let (lanes, threads) = (draws.pick(&LANES), 1 + usize::from(draws.below(32) == 0));
    let verlet = Integrator::VelocityVerlet;
    let others = [verlet, verlet, Integrator::SemiImplicitEuler, Integrator::ExplicitEuler];
    let integrator = draws.pick(&others);
    let impact = draws.pick(&[Impact::SubStep, Impact::SubStep, Impact::EndOfStep]);
    let summation = draws.pick(&[Summation::Auto, Summation::Plain, Summation::Compensated]);
    let update = draws.pick(&[OrientationUpdate::WhenAsked, OrientationUpdate::EachStep]);
    let described = describe::<T>(draws, true);
    let builder = described.builder.dt(dt * described.time).integrator(integrator).impact(impact);
    let Ok(scene) = builder.summation(summation).orientation(update).build() else {
        return Outcome::Refused;
    };
    show(&scene);
    let found = march(&scene, Execution::new().threads(1), &[steps]);
    check(&scene, &found);
    goes_on_as_a_new_scene(&scene, &found, found.time / 8.0);
    let execution = Execution::new().lanes(lanes).threads(threads);
    check_same(&found, &march(&scene, execution, &[steps / 2, steps - steps / 2]));
    let is_exact = impact == Impact::SubStep && integrator == verlet && !described.may_rest;
    if T::EPSILON.to_f64() == f64::EPSILON && is_exact {
        let (exact, _) = story(&scene, Execution::new().threads(1), &[found.time]);
        check_first_events(&scene, &found, &exact);
    }
    Outcome::Ran
}

/// Both engines have the same first collisions, as far as their order is no chance.
fn check_first_events<T: Real>(scene: &Scene<T>, found: &Run<T>, exact: &Run<T>) {
    /// Of the time of the run, and of the speed. Each collision makes an error greater by
    /// the way over the radius.
    const NEAR: f64 = 1e-6;
    const COMPARED: usize = 3;
    let near = NEAR * found.time;
    let partner = |event: &Event<T>| match event.partner {
        Partner::Body { index, .. } => [0, index],
        Partner::Surroundings(part) => [1, part],
        _ => [2, 0],
    };
    // Rounding decides whether what grazes meets.
    let is_blow = |event: &&Event<T>| {
        let impulse = (event.normal_impulse / scene.bodies.mass.of(event.a as usize)).to_f64();
        impulse > NEAR * event.velocity.cast::<f64>().length()
    };
    let blows: Vec<_> = found.events.iter().filter(is_blow).collect();
    let exact: Vec<_> = exact.events.iter().filter(is_blow).collect();
    for (k, right) in exact.iter().enumerate().take(COMPARED) {
        let next = exact.get(k + 1).map_or(found.time, |event| event.time);
        // At the start bodies may touch.
        if right.time <= near || next - right.time <= near {
            return;
        }
        let speed = right.velocity.cast::<f64>().length();
        let Some(event) = blows.get(k) else { panic!("no event {k}: {right:?}") };
        let change = (event.velocity - right.velocity).cast::<f64>().length();
        let is_same = event.a == right.a && partner(event) == partner(right);
        let is_near = (event.time - right.time).abs() <= near && change <= NEAR.sqrt() * speed;
        assert!(is_same && is_near, "event {k}: {event:?} is not {right:?}");
    }
}

/// Steps, in parts.
fn march<T: Compiled>(scene: &Scene<T>, execution: Execution, parts: &[u64]) -> Run<T> {
    let mut world = Stepped::with_execution(scene.clone(), execution).unwrap();
    let mut events = Vec::new();
    for &steps in parts {
        world.take_steps(steps, Some(&mut |event| events.push(*event)));
    }
    Run {
        time: world.time(),
        steps: world.steps(),
        events,
        impulse_from_surroundings: world.impulse_from_surroundings(),
        bodies: world.bodies(),
    }
}

/// Prints a scene if the environment has `SHOW`: what an input means.
pub(super) fn show<T: Real>(scene: &Scene<T>) {
    if std::env::var_os("SHOW").is_some() {
        println!("{scene:?}");
    }
}

fn check_same<T: Real>(found: &Run<T>, other: &Run<T>) {
    assert_eq!(found.events, other.events);
    assert_eq!((found.time, found.steps), (other.time, other.steps));
    assert_eq!(state_hash(&found.bodies), state_hash(&other.bodies));
    assert_eq!(found.impulse_from_surroundings, other.impulse_from_surroundings);
}

/// A few bodies, each in a cell of its own, in some space. `may_rest`: whether what
/// touches may be pressed together, too.
fn describe<T: Real>(draws: &mut Draws, may_rest: bool) -> Described<T> {
    let power = |exponent: i32| 10_f64.powi(exponent);
    let (length, time) = (power(draws.pick(&UNITS)), power(draws.pick(&UNITS) / 2));
    let far = draws.pick(&[0.0, 0.0, 0.0, 1.0, -300.0, 1e4]);
    let at = |place: [f64; 3]| place.map(|x| (x + far) * length);
    let speed = length / time;
    let surface = draws.pick(&[Surface::Smooth, Surface::Rough]);
    let mut builder = Scene::<T>::builder().surface(surface);
    let may_stand_still = draws.below(3) == 0;
    if may_stand_still {
        let acceleration = draws.direction().map(|x| 4.0 * x * speed / time);
        builder = builder.gravity(acceleration.map(T::from_f64));
    }
    builder = surroundings(builder, draws, at, length);
    // Cells that are full have bodies that touch their neighbours.
    // Rough ones that touch two others can rattle between them without end.
    let may_touch = surface == Surface::Smooth && (may_rest || !may_stand_still);
    let fill = draws.pick(&[if may_touch { 0.5 } else { 0.49 }, 0.45, 0.3, 0.1]);
    let may_rest = may_stand_still && fill == 0.5;
    let count = 1 + usize::from(draws.below(7));
    let first = usize::from(draws.byte());
    for k in 0..count {
        // All cells come once: 10 has no factor in common with their number.
        let cell = (first + 10 * k) % (EDGE * EDGE * EDGE);
        let radius = fill * draws.pick(&[1.0, 1.0, 0.7, 0.1]);
        let room = 0.5 - radius;
        let cell = [cell % EDGE, cell / EDGE % EDGE, cell / (EDGE * EDGE)];
        let moved = draws.direction();
        let place = core::array::from_fn(|axis| cell[axis] as f64 + 0.5 + room * moved[axis]);
        let mut velocity = draws.direction();
        if draws.flag() {
            // Along an axis, at a speed like others.
            velocity =
                core::array::from_fn(|axis| velocity[axis].signum() * f64::from(axis == k % 3));
        }
        let sphere = Sphere::new(at(place))
            .radius(radius * length)
            .velocity(velocity.map(|v| v * draws.pick(&[1.0, 1.0, 0.0, 20.0, 1e-3]) * speed))
            .spin(draws.direction().map(|w| 3.0 * w / time))
            .mass(draws.pick(&[1.0, 1.0, 3.0, 0.01, 1e3]))
            .inertia_factor(draws.pick(&[0.4, 0.4, 2.0 / 3.0, 0.01]));
        builder = builder.sphere(sphere);
    }
    Described { builder, time, may_stand_still, may_rest }
}

/// What is around the cells.
fn surroundings<T: Real>(
    builder: SceneBuilder<T>,
    draws: &mut Draws,
    at: impl Fn([f64; 3]) -> [f64; 3],
    length: f64,
) -> SceneBuilder<T> {
    let point = |place: [f64; 3]| at(place).map(T::from_f64);
    let long = |x: f64| T::from_f64(x * length);
    let side = EDGE as f64;
    // With no room behind, a row of bodies that touch would rattle without end.
    let room = draws.pick(&[0.01, 0.1, 1.0]);
    let (lower, upper) = (point([0.0; 3]), point([side + room; 3]));
    let (middle, out) = (point([side / 2.0; 3]), draws.pick(&[0.0, 0.01, 1.0]));
    match draws.below(9) {
        0 | 1 => builder,
        2 => builder.periodic(PeriodicBox::new(lower, upper)),
        3 => builder.surroundings(Cuboid::container(lower, upper)),
        4 => {
            // Around the corners of the cells.
            let hollow = FixedSphere::container(middle, long(side * 0.867 + out));
            builder.surroundings(hollow)
        }
        5 => {
            let normal = [draws.signed() / 4.0, draws.signed() / 4.0, 1.0];
            let below = point([side / 2.0, side / 2.0, -side / 2.0 - out]);
            builder.surroundings(Plane::new(below, normal.map(T::from_f64)))
        }
        6 => {
            let solid = FixedSphere::solid(point([side / 2.0, side / 2.0, -1.0]), long(1.0));
            builder
                .surroundings(Cuboid::container(point([0.0, 0.0, -2.0]), upper))
                .surroundings(solid)
        }
        7 => {
            let solid = Cuboid::solid(point([0.25, 0.25, -1.0]), point([side - 0.5, 1.0, 0.0]));
            builder.surroundings(solid)
        }
        _ => {
            let solid = FixedSphere::solid(point([side / 2.0, side / 2.0, -1.0]), long(0.8));
            let space = PeriodicBox::new(point([0.0, 0.0, -2.0]), upper);
            builder.periodic(space).surroundings(solid)
        }
    }
}
