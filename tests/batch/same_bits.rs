//! The same bits as alone, for any lanes, threads and number of scenes.

use carom::bodies::Bodies;
use carom::contact::Surface;
use carom::engine::{Batch, Collisions, Compiled, Event, Execution, Lanes, World};
use carom::motion::Integrator;
use carom::real::Real;
use carom::scene::{
    Buildable, EngineKind, Impact, OrientationUpdate, Scene, SceneError, Spheres, Spread, Summation,
};
use carom::surroundings::{Capsule, Cuboid, FixedSphere, Plane};
use rand::rngs::SmallRng;
use rand::{RngExt, SeedableRng};

/// What a batch is made of.
struct Shape {
    bodies: u64,
    is_rough: bool,
    has_gravity: bool,
    has_sizes: bool,
    fixed: usize,
    integrator: Integrator,
    summation: Summation,
    impact: Impact,
    engine: EngineKind,
    orientation: OrientationUpdate,
}

impl Shape {
    fn random(random: &mut SmallRng) -> Self {
        let rarely = |random: &mut SmallRng| random.random_ratio(1, 12);
        Self {
            bodies: random.random_range(1..24),
            is_rough: random.random(),
            has_gravity: random.random(),
            has_sizes: random.random(),
            fixed: random.random_range(0..4),
            integrator: [
                Integrator::SemiImplicitEuler,
                Integrator::ExplicitEuler,
                Integrator::VelocityVerlet,
            ][random.random_range(0..3)],
            summation: [Summation::Auto, Summation::Plain, Summation::Compensated]
                [random.random_range(0..3)],
            impact: if random.random() { Impact::SubStep } else { Impact::EndOfStep },
            engine: if rarely(random) { EngineKind::EventDriven } else { EngineKind::Stepped },
            orientation: match rarely(random) {
                true => OrientationUpdate::EachStep,
                false => OrientationUpdate::WhenAsked,
            },
        }
    }

    /// Scene `k` of a batch, whose step and gravity may be its own.
    fn scene<T: Buildable>(&self, k: u64, is_varied: bool) -> Result<Scene<T>, SceneError> {
        let t3 = |vector: [f64; 3]| vector.map(T::from_f64);
        let own = if is_varied { k as f64 } else { 0.0 };
        let gravity = if self.has_gravity { -1.0 - 0.125 * own } else { 0.0 };
        let mut spheres = Spheres::random(self.bodies)
            .within([0.0; 3], [5.0, 5.0, 6.0])
            .temperature(1.0)
            .spin_temperature(if self.is_rough { 1.0 } else { 0.0 })
            .seed(k);
        spheres = match self.has_sizes {
            true => spheres.radius(Spread::from(0.25..=0.5)).mass(Spread::from(0.5..=2.0)),
            false => spheres.radius(0.5),
        };
        let mut builder = Scene::<T>::builder()
            .engine(self.engine)
            .gravity(t3([0.0, 0.0, gravity]))
            .surface(if self.is_rough { Surface::Rough } else { Surface::Smooth })
            .integrator(self.integrator)
            .impact(self.impact)
            .summation(self.summation)
            .orientation(self.orientation)
            .dt(0.01 * (1.0 + own / 100.0))
            .duration(0.5 + 0.05 * own)
            .spheres(spheres);
        if self.fixed > 0 {
            builder = builder.surroundings(Cuboid::container(t3([0.0; 3]), t3([5.0, 5.0, 6.0])));
        }
        if self.fixed > 1 {
            builder = builder.surroundings(FixedSphere::solid(t3([0.0; 3]), T::from_f64(0.75)));
            builder = builder.surroundings(Plane::new(t3([0.0, 0.0, -1.0]), t3([0.5, 0.0, 1.0])));
        }
        if self.fixed > 2 {
            let ends = [t3([2.0, 5.0, 0.0]), t3([3.0, 5.0, 6.0])];
            builder = builder.surroundings(Capsule::solid(ends[0], ends[1], T::from_f64(0.25)));
        }
        builder.build()
    }
}

/// A scene after some time, and its collisions.
#[derive(Debug, PartialEq)]
struct After<T: Real> {
    bodies: Bodies<T>,
    time: f64,
    collisions: Collisions,
    events: Vec<Event<T>>,
}

fn alone<T: Compiled>(scene: Scene<T>, duration: f64) -> After<T> {
    let execution = Execution::new().lanes(Lanes::Scalar).threads(1);
    let mut world = World::new(scene, execution).unwrap();
    let mut events = Vec::new();
    world.for_each_event(duration, |event| events.push(*event)).unwrap();
    world.advance(duration / 2.0).unwrap();
    After { bodies: world.bodies(), time: world.time(), collisions: world.collisions(), events }
}

fn together<T: Compiled>(batch: &mut Batch<T>, duration: f64) -> Vec<After<T>> {
    let mut events = vec![Vec::new(); batch.len()];
    batch.for_each_event(duration, |scene, event| events[scene].push(*event)).unwrap();
    batch.advance(duration / 2.0).unwrap();
    let events = events.into_iter().enumerate();
    events
        .map(|(k, events)| After {
            bodies: batch.bodies(k).unwrap(),
            time: batch.time(k).unwrap(),
            collisions: batch.collisions_of(k).unwrap(),
            events,
        })
        .collect()
}

fn paths(random: &mut SmallRng) -> Execution {
    let lanes = [Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen, Lanes::Auto];
    Execution::new().lanes(lanes[random.random_range(0..5)]).threads(random.random_range(1..4))
}

/// How many scenes with contacts at the end of steps and within them were in lanes, and how
/// many collisions there were.
fn tries<T: Compiled>(seed: u64, trials: usize) -> ([usize; 2], u64) {
    let mut random = SmallRng::seed_from_u64(seed);
    let (mut in_lanes, mut collisions) = ([0; 2], 0);
    for _ in 0..trials {
        let shape = Shape::random(&mut random);
        let count: u64 = random.random_range(1..40);
        let is_varied: bool = random.random();
        let scene = |k: usize| shape.scene::<T>(k as u64, is_varied);
        // Of random places some have no room: those are no scenes, and the others go on.
        let Ok(mut batch) = Batch::made(count as usize, paths(&mut random), scene) else {
            continue;
        };
        let duration = random.random_range(0.0..2.0);
        let fixed = batch.faults().count();
        if fixed == 0 {
            let found = together(&mut batch, duration);
            for (k, found) in found.into_iter().enumerate() {
                assert_eq!(found, alone(scene(k).unwrap(), duration), "scene {k}");
                collisions += found.collisions.total();
            }
        }
        in_lanes[usize::from(shape.impact == Impact::SubStep)] += batch.in_lanes();
    }
    (in_lanes, collisions)
}

#[test]
fn any_batch_in_f32() {
    let (in_lanes, collisions) = tries::<f32>(1, 100);
    let are_both = in_lanes.iter().all(|&scenes| scenes > 300);
    assert!(are_both && collisions > 10_000, "{in_lanes:?} {collisions}");
}

#[test]
fn any_batch_in_f64() {
    let (in_lanes, collisions) = tries::<f64>(2, 100);
    let are_both = in_lanes.iter().all(|&scenes| scenes > 300);
    assert!(are_both && collisions > 10_000, "{in_lanes:?} {collisions}");
}
