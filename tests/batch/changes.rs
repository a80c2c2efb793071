//! Impulses, new starts, durations and faults: each concerns one scene.

use carom::bodies::Bodies;
use carom::contact::Surface;
use carom::engine::{Batch, ChangeError, Compiled, Execution, Fault, Lanes, World};
use carom::scene::{Buildable, EngineKind, Impact, Scene, Sphere, Spheres, Summation};
use carom::surroundings::Cuboid;

const ALONE: Execution = Execution::new().lanes(Lanes::Scalar).threads(1);

fn scene<T: Buildable>(surface: Surface, seed: u64) -> Scene<T> {
    let t3 = |vector: [f64; 3]| vector.map(T::from_f64);
    let spheres = Spheres::random(6).radius(0.5).temperature(1.0).spin_temperature(1.0);
    Scene::<T>::builder()
        .engine(EngineKind::Stepped)
        .gravity(t3([0.0, 0.0, -1.0]))
        .surface(surface)
        .impact(Impact::EndOfStep)
        .dt(0.01)
        .surroundings(Cuboid::container(t3([0.0; 3]), t3([4.0; 3])))
        .spheres(spheres.within([0.0; 3], [4.0; 3]).seed(seed))
        .build()
        .unwrap()
}

fn batch<T: Compiled>(surface: Surface, lanes: Lanes) -> Batch<T> {
    let execution = Execution::new().lanes(lanes).threads(2);
    let batch = Batch::made(21, execution, |k| Ok(scene(surface, k as u64))).unwrap();
    assert_eq!(batch.in_lanes(), 21);
    batch
}

fn impulses<T: Compiled>() {
    let vector = [0.5, -1.0, 2.0].map(T::from_f64);
    for surface in [Surface::Smooth, Surface::Rough] {
        for lanes in [Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen] {
            let mut batch = batch::<T>(surface, lanes);
            batch.advance(0.7).unwrap();
            for k in [3, 4, 20] {
                batch.apply_impulse(k, 5, vector).unwrap();
            }
            batch.advance(0.7).unwrap();
            for k in 0..batch.len() {
                let mut world = World::new(scene::<T>(surface, k as u64), ALONE).unwrap();
                world.advance(0.7).unwrap();
                if [3, 4, 20].contains(&k) {
                    let mut change = world.change();
                    change.apply_impulse(5, vector);
                    change.apply().unwrap();
                }
                world.advance(0.7).unwrap();
                assert_eq!(batch.bodies(k).unwrap(), world.bodies(), "{surface} {lanes} {k}");
            }
        }
    }
}

#[test]
fn an_impulse_is_a_change_of_the_world() {
    impulses::<f32>();
    impulses::<f64>();
}

#[test]
fn a_scene_that_is_put_back_goes_on_from_there() {
    let mut batch = batch::<f64>(Surface::Rough, Lanes::Four);
    batch.advance(0.5).unwrap();
    let (start, other) = (scene::<f64>(Surface::Rough, 77), scene::<f64>(Surface::Rough, 78));
    batch.reset(2, &start).unwrap();
    // Lanes do not take this one: it goes on beside them.
    let mut events = other;
    events.engine = EngineKind::EventDriven;
    batch.reset(9, &events).unwrap();
    assert_eq!(batch.in_lanes(), 20);
    batch.advance(0.5).unwrap();
    for k in 0..batch.len() {
        let (scene, time) = match k {
            2 => (start.clone(), 0.5),
            9 => (events.clone(), 0.5),
            k => (scene(Surface::Rough, k as u64), 1.0),
        };
        let mut world = World::new(scene, ALONE).unwrap();
        world.advance(time).unwrap();
        assert_eq!(batch.bodies(k).unwrap(), world.bodies(), "{k}");
        assert_eq!(batch.time(k), Some(time));
        assert_eq!(batch.collisions_of(k), Some(world.collisions()));
    }
    // What is no scene changes nothing.
    let mut overlapping = start.clone();
    overlapping.bodies.position = std::array::from_fn(|_| overlapping.bodies.position[0].clone());
    overlapping.bodies.position[0][1] = overlapping.bodies.position[0][0];
    overlapping.bodies.position[1][1] = overlapping.bodies.position[1][0];
    overlapping.bodies.position[2][1] = overlapping.bodies.position[2][0];
    let before = batch.bodies(2);
    assert!(matches!(batch.reset(2, &overlapping), Err(ChangeError::Scene(_))));
    assert_eq!(batch.bodies(2), before);
    let none = batch.reset(21, &start).unwrap_err().to_string();
    assert_eq!(none, "there is no scene 21: the batch has 21, counted from 0");
    assert!(matches!(
        batch.apply_impulse(2, 6, [0.0; 3]),
        Err(ChangeError::Body { body: 6, bodies: 6 })
    ));
}

#[test]
fn each_scene_runs_for_its_own_duration() {
    for lanes in [Lanes::Scalar, Lanes::Four, Lanes::Sixteen] {
        let timed = |k: usize| {
            let mut scene = scene::<f64>(Surface::Rough, k as u64);
            // Far apart, equal, or left open.
            scene.duration = [Some(0.013), Some(1.0 + k as f64 / 10.0), None][k % 3];
            scene.stepped.dt = Some(if k.is_multiple_of(2) { 0.01 } else { 0.02 });
            scene
        };
        let execution = Execution::new().lanes(lanes).threads(2);
        let mut batch = Batch::made(50, execution, |k| Ok(timed(k))).unwrap();
        batch.run();
        // They have run: nothing is left to do.
        batch.run();
        for k in 0..50 {
            let scene = timed(k);
            let steps = scene.duration.map_or(0, |duration| {
                (duration / scene.stepped.dt.unwrap()).round().max(1.0) as u64
            });
            assert_eq!(batch.steps(k), Some(steps), "{k}");
            let World::Stepped(mut world) = World::new(scene, ALONE).unwrap() else { panic!() };
            world.advance_steps(steps);
            assert_eq!(batch.bodies(k).unwrap(), world.bodies(), "{k}");
            assert_eq!(batch.collisions_of(k), Some(world.collisions()), "{k}");
        }
        assert_eq!(batch.in_lanes(), 50);
    }
}

/// A scene whose bodies leave the numbers after some steps, if it is so wanted.
fn fast(is_lost: bool) -> Scene<f32> {
    Scene::<f32>::builder()
        .engine(EngineKind::Stepped)
        .impact(Impact::EndOfStep)
        .summation(Summation::Plain)
        .dt(if is_lost { 3e37 } else { 0.5 })
        .sphere(Sphere::new([0.0; 3]).radius(0.5).velocity([0.25, 0.0, 0.0]))
        .sphere(Sphere::new([2.0, 0.0, 0.0]).radius(0.5))
        .sphere(Sphere::new([0.0, 9.0, 0.0]).radius(0.5).velocity([3.0, 0.0, 0.0]))
        .build()
        .unwrap()
}

#[test]
fn what_goes_wrong_disturbs_no_other() {
    for lanes in [Lanes::Scalar, Lanes::Eight] {
        let execution = Execution::new().lanes(lanes).threads(2);
        let make = |k: usize| match k {
            // No scene at all.
            5 => Scene::builder().sphere(Sphere::new([0.0; 3]).radius(-1.0)).build(),
            k => Ok(fast(k == 7)),
        };
        let mut batch = Batch::made(12, execution, make).unwrap();
        batch.advance_steps(200).unwrap();
        let faults: Vec<(usize, String)> =
            batch.faults().map(|(k, fault)| (k, fault.to_string())).collect();
        assert_eq!(faults.iter().map(|(k, _)| *k).collect::<Vec<_>>(), [5, 7]);
        assert!(faults[0].1.contains("radius"), "{faults:?}");
        assert!(faults[1].1.contains("no longer finite"), "{faults:?}");
        assert!(matches!(batch.fault(7), Some(Fault::NotFinite { .. })));
        assert_eq!(batch.in_lanes(), 11);
        let mut world = World::new(fast(false), ALONE).unwrap();
        world.advance(100.0).unwrap();
        let expected: Bodies<f32> = world.bodies();
        for k in (0..12).filter(|k| ![5, 7].contains(k)) {
            assert_eq!(batch.bodies(k).as_ref(), Some(&expected), "{k}");
        }
        assert_eq!((batch.bodies(5), batch.bodies(7)), (None, None));
        assert_eq!(batch.energies().iter().filter(|energy| energy.is_none()).count(), 2);
        // A new start makes it good.
        batch.reset(7, &fast(false)).unwrap();
        batch.advance_steps(200).unwrap();
        assert_eq!(batch.bodies(7).as_ref(), Some(&expected));
        assert_eq!(batch.faults().count(), 1);
    }
}

#[test]
fn an_engine_that_stands_still_is_a_fault_of_its_scene() {
    // A ball that rests on a floor: time stands still.
    let scene = |k: usize| {
        let height = if k == 3 { 0.5 } else { 1.0 };
        Scene::<f64>::builder()
            .gravity([0.0, 0.0, -1.0])
            .surroundings(carom::Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
            .sphere(Sphere::new([0.0, 0.0, height]).radius(0.5))
            .build()
    };
    let mut batch = Batch::made(5, Execution::new().threads(2), scene).unwrap();
    assert_eq!(batch.in_lanes(), 0);
    batch.advance(3.0).unwrap();
    assert_eq!(batch.faults().map(|(k, _)| k).collect::<Vec<_>>(), [3]);
    assert!(batch.fault(3).unwrap().to_string().contains("time stands still"));
    assert_eq!(batch.time(4), Some(3.0));
    assert!(batch.step().unwrap_err().to_string().contains("step"));
    // The others go on, and it does not.
    batch.advance(1.0).unwrap();
    assert_eq!(batch.time(4), Some(4.0));
}

#[test]
fn copies_are_checked_as_scenes_are() {
    let first = scene::<f64>(Surface::Smooth, 1);
    let varied = |vary: fn(&mut Scene<f64>)| {
        let batch = Batch::varied(&first, 2, ALONE, |k, scene| {
            if k == 1 {
                vary(scene);
            }
        });
        batch.unwrap().fault(1).map(ToString::to_string).unwrap_or_default()
    };
    assert_eq!(varied(|_| {}), "");
    assert_eq!(varied(|scene| scene.bodies.velocity[0][0] = 2.0), "");
    assert_eq!(varied(|scene| scene.bodies.scale_motion(-1.0)), "");
    for (vary, words) in [
        ((|scene| scene.bodies.position[0][0] = -9.0) as fn(&mut Scene<f64>), "outside"),
        (|scene| scene.bodies.spin[1][2] = f64::INFINITY, "is not finite"),
        (|scene| scene.gravity.x = f64::NAN, "gravity"),
        (|scene| scene.stepped.dt = Some(-1.0), "dt"),
        (|scene| scene.duration = Some(0.0), "duration"),
        (|scene| scene.bodies.mass = carom::bodies::PerBody::Same(-1.0), "mass"),
        (|scene| scene.bodies.velocity[1] = Default::default(), "velocity"),
    ] {
        let found = varied(vary);
        assert!(found.contains(words), "{words}: {found}");
    }
    let overlapping = varied(|scene| {
        for column in &mut scene.bodies.position {
            column[1] = column[0];
        }
    });
    assert!(overlapping.contains("overlap"), "{overlapping}");
    assert!(Batch::varied(&first, 0, ALONE, |_, _| {}).is_err());
}

#[test]
fn a_first_scene_without_a_step_changes_no_other() {
    let scene = |k: usize| {
        let mut scene = Scene::<f64>::builder()
            .sphere(Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
            .sphere(Sphere::new([2.1, 0.0, 0.0]).radius(0.5))
            .build()
            .unwrap();
        scene.engine = EngineKind::Stepped;
        scene.stepped.dt = (k > 0).then_some(0.25);
        scene
    };
    let mut batch = Batch::made(2, ALONE, |k| Ok(scene(k))).unwrap();
    assert!(matches!(batch.fault(0), Some(Fault::Engine(_))));
    batch.advance_steps(8).unwrap();
    let World::Stepped(mut alone) = World::new(scene(1), ALONE).unwrap() else { unreachable!() };
    alone.advance_steps(8);
    assert_eq!(alone.collisions().pairs, 1);
    assert_eq!(batch.bodies(1).unwrap(), alone.bodies());
}
