//! Builder: whatever numbers the library is given, they are a scene or one clear error.

use carom::bodies::Bodies;
use carom::contact::Surface;
use carom::engine::{Compiled, EngineError, EventDriven, Execution, Stepped};
use carom::motion::Integrator;
use carom::observe::not_finite;
use carom::real::Real;
use carom::scene::{
    Arrangement, Encounters, EngineKind, Impact, OrientationUpdate, Scene, SceneBuilder, Sphere,
    Spheres, Spread, Summation,
};
use carom::space::PeriodicBox;
use carom::surroundings::{
    Capsule, Cone, Cuboid, Cylinder, Disc, FixedSphere, Plane, Shape, Torus, Triangle, Tube,
};

use super::draws::Draws;
use super::engines::show;
use super::{Outcome, check_message};

/// Calls of the builder, and bodies of a group.
const MOST_CALLS: usize = 12;
const MOST_IN_GROUP: u8 = 40;

/// Bytes as calls of a builder, in either precision; what it makes is moved a little.
pub fn builder(bytes: &[u8]) -> Outcome {
    let mut draws = Draws::new(bytes);
    draws.choose_hostility();
    if draws.flag() { build::<f32>(draws) } else { build::<f64>(draws) }
}

fn build<T: Compiled>(mut draws: Draws) -> Outcome {
    let mut builder = Scene::<T>::builder();
    for _ in 0..MOST_CALLS {
        builder = call(builder, &mut draws);
        if draws.is_empty() {
            break;
        }
    }
    match builder.build() {
        Ok(scene) => moves_a_little(scene),
        Err(error) => {
            check_message(&error.to_string());
            Outcome::Refused
        }
    }
}

fn call<T: Real>(builder: SceneBuilder<T>, draws: &mut Draws) -> SceneBuilder<T> {
    let t3 = |vector: [f64; 3]| vector.map(T::from_f64);
    match draws.below(16) {
        0 => builder.gravity(t3(draws.vector())),
        1 => builder.surface(draws.pick(&[Surface::Smooth, Surface::Rough])),
        2 => {
            let all = [Encounters::All, Encounters::Surroundings, Encounters::None];
            builder.encounters(draws.pick(&all))
        }
        3 => builder.periodic(PeriodicBox::new(t3(draws.vector()), t3(draws.vector()))),
        4 => builder.periodic_cube(),
        5 | 6 => builder.surroundings(shape(draws)),
        7 => builder.dt(draws.figure()).duration(draws.figure()),
        8 => {
            let all = [
                Integrator::SemiImplicitEuler,
                Integrator::ExplicitEuler,
                Integrator::VelocityVerlet,
            ];
            builder
                .integrator(draws.pick(&all))
                .impact(draws.pick(&[Impact::EndOfStep, Impact::SubStep]))
        }
        9 => {
            let updates = [OrientationUpdate::WhenAsked, OrientationUpdate::EachStep];
            let sums = [Summation::Auto, Summation::Plain, Summation::Compensated];
            builder.orientation(draws.pick(&updates)).summation(draws.pick(&sums))
        }
        10 => builder.engine(draws.pick(&[EngineKind::Stepped, EngineKind::EventDriven])),
        11 | 12 => builder.spheres(group(draws)),
        13 => ready(builder, draws),
        _ => builder.sphere(sphere(draws)),
    }
}

fn shape<T: Real>(draws: &mut Draws) -> Shape<T> {
    let t3 = |vector: [f64; 3]| vector.map(T::from_f64);
    let (first, second) = (t3(draws.vector()), t3(draws.vector()));
    let radius = T::from_f64(draws.figure());
    let (third, other) = (t3(draws.vector()), T::from_f64(draws.figure()));
    let is_container = draws.flag();
    match draws.below(10) {
        0 => Plane::new(first, second).into(),
        1 if is_container => Cuboid::container(first, second).into(),
        1 => Shape::from(Cuboid::solid(first, second)).turned(third, T::ONE),
        2 if is_container => FixedSphere::container(first, radius).into(),
        2 | 3 => FixedSphere::solid(first, radius).into(),
        4 => Triangle::new(first, second, third).into(),
        5 if is_container => Capsule::container(first, second, radius).into(),
        5 => Capsule::solid(first, second, radius).into(),
        6 if is_container => Cylinder::container(first, second, radius, Some(other)).into(),
        6 => Cylinder::solid(first, second, radius, Some(other)).into(),
        7 if is_container => Cone::container(first, second, radius, [other, T::ONE]).into(),
        7 => Cone::solid(first, second, radius, [other, T::ZERO]).into(),
        8 if is_container => Disc::new(first, second, radius, other).into(),
        8 => Tube::new(first, second, radius, [other, T::ONE]).into(),
        _ if is_container => Torus::container(first, second, radius, other).into(),
        _ => Torus::solid(first, second, radius, other).into(),
    }
}

fn spread(draws: &mut Draws) -> Spread {
    let least = draws.figure();
    if draws.flag() { Spread::Same(least) } else { (least..=draws.figure()).into() }
}

fn sphere(draws: &mut Draws) -> Sphere {
    let sphere = Sphere::new(draws.vector()).velocity(draws.vector()).radius(draws.figure());
    match draws.below(5) {
        0 => sphere.mass(spread(draws)),
        1 => sphere.density(spread(draws)),
        2 => sphere.inertia_factor(draws.figure()),
        3 => sphere.spin(draws.vector()),
        _ => sphere,
    }
}

fn group(draws: &mut Draws) -> Spheres {
    let arrangements = [Arrangement::Fcc, Arrangement::Cubic, Arrangement::Random];
    let count = u64::from(draws.below(MOST_IN_GROUP));
    let group = Spheres::new(count, draws.pick(&arrangements)).radius(spread(draws));
    let group = match draws.below(4) {
        0 => group.within(draws.vector(), draws.vector()),
        1 => group.number_density(draws.figure()),
        2 => group.within([0.0; 3], [draws.figure() * 8.0; 3]),
        _ => group,
    };
    match draws.below(5) {
        0 => group.temperature(draws.figure()).spin_temperature(draws.figure()),
        1 => group.velocity(draws.vector()).spin(draws.vector()),
        2 => group.mass(spread(draws)),
        3 => group.density(spread(draws)).inertia_factor(draws.figure()),
        _ => group,
    }
}

/// Bodies whose whole state is there.
fn ready<T: Real>(builder: SceneBuilder<T>, draws: &mut Draws) -> SceneBuilder<T> {
    let t3 = |vector: [f64; 3]| vector.map(T::from_f64);
    let positions = [t3(draws.vector()), t3(draws.vector())];
    let velocities = [t3(draws.vector()), t3(draws.vector())];
    let radii = [draws.figure(), draws.figure()].map(T::from_f64);
    let bodies = Bodies::from_positions(&positions).velocities(&velocities).radii(&radii);
    match bodies.mass(T::from_f64(draws.figure())).build() {
        Ok(bodies) => builder.bodies(bodies),
        Err(error) => {
            check_message(&error.to_string());
            builder
        }
    }
}

/// Starts a scene in both engines and lets each take a few steps or events. What comes
/// of hostile numbers need not be finite; it comes.
pub(super) fn moves_a_little<T: Compiled>(scene: Scene<T>) -> Outcome {
    let execution = Execution::new().threads(1);
    let bodies = scene.bodies.len();
    let start = scene.clone();
    let has_flow = !scene.inlets.is_empty() || scene.removes.contains(&true);
    let checked = |left: &Bodies<T>| {
        assert!(has_flow || left.len() == bodies);
        if not_finite(left).is_none() {
            start.with_bodies(left.clone()).unwrap_or_else(|error| panic!("{error}"));
        }
    };
    checked(&scene.bodies);
    for columns in [&scene.bodies.position, &scene.bodies.velocity, &scene.bodies.spin] {
        assert!(columns.iter().flat_map(|column| column.iter()).all(|x| x.is_finite()));
    }
    show(&scene);
    let brief = brief(&scene);
    // Longer steps are legal, and can have collisions without number.
    if scene.stepped.dt.is_some_and(|dt| dt < 4.0 * brief) {
        let mut world = Stepped::with_execution(scene.clone(), execution).unwrap();
        world.advance_steps(2);
        checked(&world.bodies());
    }
    let mut world = EventDriven::with_execution(scene, execution).unwrap();
    match world.advance_until(16, brief) {
        Ok(events) => assert!(events <= 16),
        Err(
            error @ (EngineError::Stalled { .. }
            | EngineError::TooFast { .. }
            | EngineError::NoDuration(_)),
        ) => {
            check_message(&error.to_string());
            return Outcome::Stopped;
        }
        Err(error) => panic!("{error}"),
    }
    checked(&world.bodies());
    Outcome::Ran
}

/// In which the fastest body moves through about a radius of the smallest one.
fn brief<T: Real>(scene: &Scene<T>) -> f64 {
    let bodies = &scene.bodies;
    let radii = (0..bodies.len()).map(|k| bodies.radius.of(k).to_f64());
    let radius = radii.fold(f64::INFINITY, f64::min);
    let components = bodies.velocity.iter().flat_map(|column| column.iter());
    let speed = components.map(|v| v.to_f64().abs()).fold(0.0, f64::max);
    let time = radius / speed.max((scene.gravity.length().to_f64() * radius).sqrt());
    if time.is_finite() { time } else { 1.0 }
}
