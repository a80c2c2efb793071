//! The same events, bit by bit, in every lane width.

use carom::contact::Surface;
use carom::engine::{Compiled, EngineError, Event, EventDriven, Execution, Lanes, Order};
use carom::observe::{StateHash, state_hash};
use carom::scene::{Scene, SceneFile, Spheres, builtin_scenes};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, FixedSphere};

use crate::{FAST, builder, t3, world};

const OTHERS: [Lanes; 4] = [Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen];

/// Threads that windows of time are tried on.
const THREADS: [usize; 4] = [1, 2, 3, 7];

/// All events up to a time and the state there; whether time has stood still.
fn story<T: Compiled>(
    scene: Scene<T>,
    execution: Execution,
    end: f64,
) -> (Vec<Event<T>>, StateHash, bool) {
    let mut world = EventDriven::with_execution(scene, execution).unwrap();
    let mut events = Vec::new();
    let result = world.for_each_event(end, |event| events.push(*event));
    let is_stalled = matches!(result, Err(EngineError::Stalled { .. }));
    assert!(result.is_ok() || is_stalled, "{result:?}");
    (events, state_hash(&world.bodies()), is_stalled)
}

/// Compares the first events of a scene on all paths.
fn paths_agree<T: Compiled>(scene: &Scene<T>, most: u64) -> usize {
    let lanes = OTHERS.map(|lanes| FAST.lanes(lanes));
    let events = agree(scene, most, &lanes);
    // Windows of a few bodies have a collision each.
    let most = if scene.bodies.len() < 1_000 { most.min(500) } else { most };
    agree(scene, most, &THREADS.map(|threads| FAST.order(Order::Windows).threads(threads)));
    events
}

/// Compares the first events of a scene with those of other executions.
fn agree<T: Compiled>(scene: &Scene<T>, most: u64, others: &[Execution]) -> usize {
    let mut first = EventDriven::with_execution(scene.clone(), FAST).unwrap();
    // One that stalls does so on all paths.
    let _ = first.advance_until(most, 20.0);
    let end = first.time();
    let expected = story(scene.clone(), FAST, end);
    for &other in others {
        let found = story(scene.clone(), other, end);
        let name = &scene.name;
        for (k, (found, expected)) in found.0.iter().zip(&expected.0).enumerate() {
            assert_eq!(found, expected, "event {k} of {name} in {} {other:?}", T::NAME);
        }
        assert_eq!(found.0.len(), expected.0.len(), "{name} in {} {other:?}", T::NAME);
        assert_eq!((found.1, found.2), (expected.1, expected.2), "{name} {} {other:?}", T::NAME);
    }
    expected.0.len()
}

#[test]
fn every_builtin_scene() {
    fn builtin<T: Compiled>() {
        for builtin in builtin_scenes() {
            let scene = SceneFile::builtin(builtin.name).unwrap().build::<T>().unwrap();
            let events = paths_agree(&scene, 10_000);
            println!("{} in {}: {events} events", builtin.name, T::NAME);
        }
    }
    builtin::<f32>();
    builtin::<f64>();
}

#[test]
fn gases() {
    fn gases<T: Compiled>() {
        let builder = |name: &str, surface| builder::<T>().name(name).surface(surface);
        let gravity = t3::<T>([0.0, 0.5, -4.0]);
        let mixed = Spheres::random(400)
            .radius(0.05..=0.5)
            .density(1.0..=3.0)
            .temperature(1.0)
            .spin_temperature(1.0)
            .seed(4);
        for surface in [Surface::Smooth, Surface::Rough] {
            let gas = Spheres::fcc(2_000).radius(0.5).temperature(1.0);
            let scenes = [
                builder("gas", surface)
                    .periodic_cube()
                    .spheres(gas.clone().number_density(0.2).spin_temperature(0.5)),
                builder("dense", surface).periodic_cube().spheres(gas.clone().number_density(1.0)),
                builder("falling", surface)
                    .gravity(gravity)
                    .surroundings(Cuboid::container(t3([0.0; 3]), t3([20.0; 3])))
                    .spheres(gas.clone()),
                builder("mixed sizes", surface)
                    .gravity(gravity)
                    .surroundings(Cuboid::container(t3([0.0; 3]), t3([9.0; 3])))
                    .surroundings(Cuboid::solid(t3([1.5; 3]), t3([2.5; 3])))
                    .surroundings(FixedSphere::solid(t3([6.0; 3]), T::from_f64(0.8)))
                    .spheres(mixed.clone()),
                builder("periodic, mixed sizes", surface)
                    .periodic(PeriodicBox::new(t3([-2.0; 3]), t3([5.0; 3])))
                    .spheres(mixed.clone()),
                builder("narrow", surface)
                    .periodic(PeriodicBox::new(t3([0.0; 3]), t3([2.1, 3.3, 30.0])))
                    .spheres(Spheres::random(60).radius(0.5).temperature(1.0).seed(3)),
            ];
            for scene in scenes {
                let scene = scene.build().unwrap();
                let events = paths_agree(&scene, 10_000);
                assert!(events > 1_000, "{}: {events} events", scene.name);
            }
        }
    }
    gases::<f32>();
    gases::<f64>();
}

/// Up to a number of events and up to their time is the same.
#[test]
fn events_or_time_tell_the_same_story() {
    let spheres = Spheres::fcc(500).radius(0.5).number_density(0.5).temperature(1.0).seed(2);
    let scene = builder::<f64>().periodic_cube().spheres(spheres).build().unwrap();
    let mut first = world(scene.clone());
    first.advance_until(20_000, 100.0).unwrap();
    let mut second = world(scene);
    second.advance(first.time()).unwrap();
    assert_eq!(state_hash(&first.bodies()), state_hash(&second.bodies()));
}
