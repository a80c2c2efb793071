//! Parts of the surroundings that come and go.

use carom::bodies::Bodies;
use carom::engine::{Compiled, Execution, PartHandle, Snapshot, World};
use carom::scene::EngineKind;
use carom::surroundings::{Capsule, Disc, Sensor, Shape};
use carom::{FixedSphere, Plane, Scene, Sphere};

use super::common::numbers::noise;
use super::{BOX, FAR, FLUID, scene, tell};

/// A part somewhere in the box of a size from a corner, in its units.
fn part<T: Compiled>(noise: &mut impl FnMut() -> f64, corner: [f64; 3], size: f64) -> Shape<T> {
    let mut place = || core::array::from_fn(|axis| T::from_f64(corner[axis] + size * noise()));
    let (a, b): ([T; 3], [T; 3]) = (place(), place());
    let small = T::from_f64(0.05 * size);
    match (noise() * 4.0) as usize {
        0 => FixedSphere::solid(a, small).into(),
        1 => Capsule::solid(a, b, small).into(),
        2 => Disc::new(a, [T::ZERO, T::ONE, T::ONE], small + small, T::ZERO).into(),
        _ => {
            let floor = T::from_f64(corner[2] - 0.01 * size * noise());
            Plane::new([T::ZERO, T::ZERO, floor], [T::ZERO, T::ZERO, T::ONE]).into()
        }
    }
}

/// The same state as a new world, of the scene of the start with these parts.
fn new_world<T: Compiled>(
    bodies: Bodies<T>,
    start: &Scene<T>,
    parts: &[(PartHandle, Shape<T>)],
) -> World<T> {
    let mut state = start.clone();
    state.surroundings = parts.iter().map(|(_, shape)| shape.clone()).collect();
    state.part_names = vec![None; parts.len()];
    state.removes = vec![false; parts.len()];
    let state = state.with_bodies(bodies).unwrap();
    World::new(state, Execution::new().threads(1)).unwrap()
}

fn check<T: Compiled>(text: &str, (corner, size): ([f64; 3], f64), time: f64) {
    for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
        let mut noise = noise(3);
        let start = scene::<T>(text, engine);
        let mut world = World::new(start.clone(), Execution::default()).unwrap();
        let handles = (0..).map_while(|part| world.part_handle_of(part));
        let mut parts: Vec<_> = handles.zip(start.surroundings.iter().cloned()).collect();
        let kept = parts.len();
        let (mut added, mut removed, mut refused, mut met) = (0, 0, 0, 0);
        for round in 0..40 {
            tell(&mut world, 0.25 * time);
            let before = (world.time(), world.collisions(), world.steps());
            let bodies = world.bodies();
            let totals = world.parts();
            let mut change = world.change();
            let shape = part::<T>(&mut noise, corner, size);
            let index = change.add_part(shape.clone());
            let handle = change.part_handle_of(index).unwrap();
            assert!(parts.iter().all(|(known, _)| *known != handle));
            let gone = (parts.len() > kept + 2).then(|| {
                let gone = kept + (noise() * (parts.len() - kept) as f64) as usize;
                change.remove_part(gone);
                gone
            });
            let applied = change.apply();
            let after = (world.time(), world.collisions(), world.steps());
            assert_eq!(after, before);
            // Orientations are rounded once more when a world begins.
            assert_eq!(world.bodies().position, bodies.position);
            assert_eq!(world.bodies().velocity, bodies.velocity);
            if let Err(error) = applied {
                assert!(error.to_string().contains("body "), "{error}");
                assert_eq!((world.bodies(), world.parts()), (bodies, totals));
                assert_eq!(world.part_index_of(handle), None);
                refused += 1;
                continue;
            }
            added += 1;
            let mut before_of: Vec<_> = totals.iter().map(|totals| totals.collisions).collect();
            parts.push((handle, shape));
            before_of.push(0);
            if let Some(gone) = gone {
                let (handle, _) = parts.remove(gone);
                before_of.remove(gone);
                assert_eq!(world.part_index_of(handle), None);
                removed += 1;
            }
            for (index, (handle, shape)) in parts.iter().enumerate() {
                assert_eq!(world.part_index_of(*handle), Some(index));
                assert_eq!(world.part_handle_of(index), Some(*handle));
                assert_eq!(world.scene().surroundings[index], *shape);
            }
            let mut new = new_world(bodies, &start, &parts);
            let bytes = postcard::to_stdvec(&world.snapshot()).unwrap();
            let expected = tell(&mut new, 0.25 * time);
            met += expected.events.len();
            assert_eq!(tell(&mut world, 0.25 * time), expected, "{engine:?} {round}");
            // Its totals go on, by what the new world has met.
            let since = new.parts().into_iter().map(|part| part.collisions);
            let expected_totals: Vec<_> = before_of.iter().zip(since).map(|(a, b)| a + b).collect();
            let now: Vec<_> = world.parts().iter().map(|part| part.collisions).collect();
            assert_eq!(now, expected_totals);
            // From a snapshot, in the scene with these parts and in no other one.
            let snapshot: Snapshot = postcard::from_bytes(&bytes).unwrap();
            let resume = |scene| World::resume(scene, Execution::new().threads(1), &snapshot);
            let mut again = resume(world.scene().clone()).unwrap();
            assert_eq!(tell(&mut again, 0.25 * time), expected, "{engine:?} {round} again");
            assert_eq!((again.time(), again.parts()), (world.time(), world.parts()));
            assert_eq!(again.part_index_of(handle), world.part_index_of(handle));
            let mut other = world.scene().clone();
            other.surroundings.swap(0, parts.len() - 1);
            let error = resume(other).unwrap_err().to_string();
            assert!(error.contains("parts of the surroundings"), "{error}");
            assert!(resume(start.clone()).is_err());
        }
        assert!(added > 8 && removed > 3 && met > 50, "{engine:?}: {added} {removed} {met}");
        assert!(refused > 0, "{engine:?}");
    }
}

#[test]
fn parts_come_and_go() {
    check::<f64>(BOX, ([0.0; 3], 6.0), 1.0);
    check::<f32>(BOX, ([0.0; 3], 6.0), 1.0);
}

#[test]
fn parts_come_and_go_in_a_frame() {
    check::<f64>(FAR, ([5000.0, 0.0, 0.0], 3e-5), 2.0_f64.powi(-20));
}

#[test]
fn a_part_that_cannot_be_changes_nothing() {
    for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
        let mut world = World::new(scene::<f64>(BOX, engine), Execution::default()).unwrap();
        tell(&mut world, 1.0);
        let before = postcard::to_stdvec(&world.snapshot()).unwrap();
        let at = world.bodies().position_of(3).to_array();
        let cases: [(Shape<f64>, &str); 6] = [
            (FixedSphere::solid(at, 0.01).into(), "inside of surroundings[2], which is solid"),
            (FixedSphere::container([3.0; 3], 1.0).into(), "outside of its container"),
            (Plane::new([0.0, 0.0, 3.0], [0.0, 0.0, 1.0]).into(), "which is solid"),
            (FixedSphere::solid([3.0; 3], -1.0).into(), "surroundings[2].radius is -1.0"),
            (Plane::new([f64::NAN, 0.0, 0.0], [0.0, 0.0, 1.0]).into(), "surroundings[2].point"),
            (Plane::new([0.0; 3], [0.0; 3]).into(), "surroundings[2].normal"),
        ];
        for (shape, words) in cases {
            let mut change = world.change();
            change.add_part(shape);
            let error = change.apply().unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        let mut change = world.change();
        change.remove_part(2);
        let error = change.apply().unwrap_err().to_string();
        assert!(error.contains("no part 2 of the surroundings: the world has 2"), "{error}");
        let mut change = world.change();
        for _ in 0..2 {
            change.add_named_part("floor", Plane::new([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]));
        }
        let error = change.apply().unwrap_err().to_string();
        assert!(error.contains("is called so already"), "{error}");
        assert!(postcard::to_stdvec(&world.snapshot()).unwrap() == before);
        assert_eq!(world.scene().surroundings.len(), 2);
    }
    // What ends space does not fit into a periodic box.
    let fluid = scene::<f64>(FLUID, EngineKind::EventDriven);
    let mut world = World::new(fluid, Execution::default()).unwrap();
    let mut change = world.change();
    change.add_part(Plane::new([0.0; 3], [0.0, 0.0, 1.0]));
    let error = change.apply().unwrap_err().to_string();
    assert!(error.contains("a periodic box"), "{error}");
}

/// With impacts at the end of a step a body could jump through something thin.
#[test]
fn nothing_thin_where_a_body_is_too_fast() {
    let ball = Sphere::new([0.0; 3]).radius(0.1).velocity([9.0, 0.0, 0.0]);
    let scene = Scene::<f64>::builder()
        .engine(EngineKind::Stepped)
        .impact(carom::scene::Impact::EndOfStep)
        .dt(0.125)
        .sphere(ball);
    let mut world = World::new(scene.build().unwrap(), Execution::default()).unwrap();
    let mut change = world.change();
    change.add_part(Disc::new([3.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0, 0.0));
    assert!(change.apply().unwrap_err().to_string().contains("could jump through it"));
}

/// A part that takes spheres out is removed; one that counts is added.
#[test]
fn drains_and_sensors() {
    for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
        let ball = |height| Sphere::new([0.0, 0.0, height]).radius(0.5).velocity([0.0, 0.0, -1.0]);
        let scene = Scene::<f64>::builder()
            .engine(engine)
            .dt(0.125)
            .surroundings(Plane::new([0.0, 0.0, -9.0], [0.0, 0.0, 1.0]))
            .removing_surroundings("drain", Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
            .sphere(ball(2.0))
            .sphere(ball(4.0))
            .sphere(ball(6.0))
            .build()
            .unwrap();
        let mut world = World::new(scene, Execution::default()).unwrap();
        world.advance(2.0).unwrap();
        assert_eq!((world.bodies().len(), world.exchange().removed.spheres), (2, 1));
        let drain = world.part_handle_of(1).unwrap();
        // The drain moves up when the part before it goes.
        let mut change = world.change();
        change.remove_part(0);
        change.apply().unwrap();
        assert_eq!(world.part_index_of(drain), Some(0));
        assert_eq!((world.parts()[0].part, world.parts()[0].removed), (0, 1));
        world.advance(2.0).unwrap();
        assert_eq!((world.bodies().len(), world.parts()[0].removed), (1, 2));
        // Without it the last one falls on, through what counts.
        let mut change = world.change();
        change.remove_part(0);
        let sensor = change.add_part(Sensor::new(Plane::new([0.0; 3], [0.0, 0.0, 1.0])));
        let sensor = change.part_handle_of(sensor).unwrap();
        change.apply().unwrap();
        let snapshot = world.snapshot();
        world.advance(4.0).unwrap();
        assert_eq!(world.part_index_of(sensor), Some(0));
        assert_eq!((world.bodies().len(), world.exchange().removed.spheres), (1, 2));
        assert_eq!(world.bodies().position_of(0).z, -2.0);
        assert_eq!(world.parts()[0].passages.unwrap().inward, 1);
        let mut again =
            World::resume(world.scene().clone(), Execution::default(), &snapshot).unwrap();
        again.advance(4.0).unwrap();
        assert_eq!((again.bodies(), again.parts()), (world.bodies(), world.parts()));
        assert_eq!(again.exchange(), world.exchange());
    }
}
