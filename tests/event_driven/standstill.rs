//! What never comes to an end: every run does, some with an error.

use std::time::{Duration, Instant};

use carom::contact::Surface;
use carom::engine::{Compiled, EngineError};
use carom::scene::{SceneBuilder, Sphere};
use carom::surroundings::{Cuboid, Plane};

use crate::{builder, floor, t3, world};

/// What may be wanted of a run that cannot go on.
const QUICK: Duration = Duration::from_secs(10);

/// Runs a scene in which time comes to stand still, and returns when it did.
fn stall<T: Compiled>(scene: SceneBuilder<T>, body: u32) -> f64 {
    let mut world = world(scene.build().unwrap());
    let start = Instant::now();
    let error = world.advance(100.0).unwrap_err();
    assert!(start.elapsed() < QUICK, "{:?}", start.elapsed());
    let EngineError::Stalled { time, events, body: found } = error else { panic!("{error}") };
    assert_eq!(found, body);
    assert!(events > 1_000_000, "given up after {events} events");
    assert_eq!(world.time(), time);
    let bodies = world.bodies();
    assert!(bodies.position.iter().all(|column| column.iter().all(|x| x.is_finite())));
    // It stays where it is.
    assert!(world.advance(0.0).is_ok() || world.time() == time);
    time
}

#[test]
fn a_ball_at_rest_on_a_floor() {
    fn at_rest<T: Compiled>() {
        for surface in [Surface::Smooth, Surface::Rough] {
            let scene = builder::<T>()
                .surface(surface)
                .gravity(t3([0.0, 0.0, -1.0]))
                .surroundings(floor())
                .sphere(Sphere::new([0.0, 0.0, 9.0]).radius(0.5))
                .sphere(Sphere::new([4.0, 0.0, 0.5]).radius(0.5));
            assert_eq!(stall(scene.clone(), 1), 0.0);
            let rolling = Sphere::new([8.0, 0.0, 0.5]).radius(0.5).velocity([1.0, 0.0, 0.0]);
            let scene = builder::<T>().surface(surface).gravity(t3([0.0, 0.0, -1.0]));
            assert_eq!(stall(scene.surroundings(floor()).sphere(rolling), 0), 0.0);
        }
    }
    at_rest::<f32>();
    at_rest::<f64>();
}

/// A ball that moves between two walls which it touches both is no scene; one
/// with a little room is.
#[test]
fn a_ball_between_walls_as_wide_as_itself() {
    fn between<T: Compiled>() {
        let scene = |width: f64| {
            let walls = Cuboid::container(t3([0.0; 3]), t3([width, 4.0, 4.0]));
            let ball = Sphere::new([width / 2.0, 2.0, 2.0]).radius(0.5);
            builder::<T>().surroundings(walls).sphere(ball.velocity([1.0, 0.25, 0.0])).build()
        };
        let error = scene(1.0).unwrap_err().to_string();
        assert!(error.contains("the container leaves body 0 no room in x"), "{error}");
        world(scene(1.01).unwrap()).advance(1.0).unwrap();
    }
    between::<f32>();
    between::<f64>();
}

/// A ball jumps in a wedge, and comes close to its edge now and then. It goes on
/// or stalls.
#[test]
fn a_ball_in_a_wedge() {
    fn in_a_wedge<T: Compiled>() {
        let mut stalled = 0;
        let start = Instant::now();
        for surface in [Surface::Smooth, Surface::Rough] {
            for slope in [0.02, 0.3, 1.0, 3.0, 50.0] {
                for aside in [0.0, 0.01, 0.37] {
                    let plane = |side: f64| Plane::new(t3([0.0; 3]), t3([side, 0.0, 1.0 / slope]));
                    let scene = builder::<T>()
                        .surface(surface)
                        .gravity(t3([0.0, 0.0, -10.0]))
                        .surroundings(plane(1.0))
                        .surroundings(plane(-1.0))
                        .sphere(Sphere::new([aside, 0.0, 60.0]).radius(0.5));
                    let mut world = world(scene.build().unwrap());
                    match world.advance(200.0) {
                        Ok(()) => assert_eq!(world.time(), 200.0),
                        Err(EngineError::Stalled { .. }) => stalled += 1,
                        Err(error) => panic!("{error}"),
                    }
                    assert!(world.collisions().surroundings > 10);
                    let height = world.bodies().position_of(0).z.to_f64();
                    assert!((0.0..61.0).contains(&height), "{slope} {aside}: {height}");
                }
            }
        }
        println!("{}: {stalled} of 30 stalled, in {:?}", T::NAME, start.elapsed());
        assert!(start.elapsed() < QUICK);
    }
    in_a_wedge::<f32>();
    in_a_wedge::<f64>();
}

/// A ball rests on another one, and both in a corner.
#[test]
fn a_pile() {
    fn pile<T: Compiled>() {
        let scene = builder::<T>()
            .gravity(t3([0.0, 0.0, -1.0]))
            .surroundings(Cuboid::container(t3([0.0; 3]), t3([4.0; 3])))
            .sphere(Sphere::new([0.5, 0.5, 0.5]).radius(0.5))
            .sphere(Sphere::new([0.5, 0.5, 1.5]).radius(0.5));
        let mut world = world(scene.build().unwrap());
        assert!(matches!(world.advance(1.0), Err(EngineError::Stalled { .. })));
    }
    pile::<f32>();
    pile::<f64>();
}
