//! Memory is bounded by the number of bodies and of fixed parts, whatever their
//! sizes and distances. An allocation beyond the bound aborts the tests.

use std::alloc::System;
use std::sync::{Mutex, PoisonError};

use approx::assert_abs_diff_eq;
use cap::Cap;
use carom::bodies::Bodies;
use carom::engine::{Compiled, EventDriven};
use carom::real::Real;
use carom::scene::{EngineKind, Scene, SceneBuilder, Sphere, Spheres};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, FixedSphere};

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Bytes that any scene may take, and for each body or fixed part.
const BESIDES: usize = 64 << 20;
const EACH: usize = 2 << 10;

/// Pairs that are looked at for each body, fixed part or event: few periods pass.
const TRIED: u64 = 1_000;

/// Builds a scene of `count` bodies and fixed parts and runs it event by event,
/// within the bounds of memory and of pairs looked at.
fn run<T: Compiled>(count: usize, duration: f64, scene: SceneBuilder<T>) -> Bodies<T> {
    // The limit is one for all tests.
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    ALLOCATOR.set_limit(ALLOCATOR.allocated() + BESIDES + EACH * count).unwrap();
    let mut world = EventDriven::new(scene.build().unwrap()).unwrap();
    world.advance(duration).unwrap();
    let bodies = world.bodies();
    let [tried, events] = [world.effort().tried, world.collisions().total()];
    let most = TRIED * (count as u64 + events);
    assert!(tried < most, "{tried} pairs tried for {count} bodies and {events} events");
    drop(world);
    ALLOCATOR.set_limit(usize::MAX).unwrap();
    bodies
}

fn scene<T: Real>() -> SceneBuilder<T> {
    Scene::builder().engine(EngineKind::EventDriven)
}

fn ball(x: f64, y: f64, z: f64) -> Sphere {
    Sphere::new([x, y, z]).radius(0.5)
}

#[test]
fn two_spheres_far_apart() {
    for distance in [1e3, 1e7, 1e12, 1e30] {
        let second = ball(distance, distance, distance).velocity([-distance, 0.0, 0.0]);
        let bodies = run(2, 0.5, scene::<f64>().sphere(ball(0.0, 0.0, 0.0)).sphere(second));
        assert_eq!(bodies.position_of(1).x, 0.5 * distance);
        let on_a_line = ball(distance, 0.0, 0.0).velocity([-1.0, 0.0, 0.0]);
        run(2, 1.0, scene::<f64>().sphere(ball(0.0, 0.0, 0.0)).sphere(on_a_line));
    }
}

#[test]
fn few_in_a_large_periodic_box() {
    let dilute = Spheres::random(10).radius(0.5).temperature(1.0);
    run(10, 1.0, scene::<f64>().periodic(PeriodicBox::new([0.0; 3], [1e3; 3])).spheres(dilute));
    let two = scene::<f64>()
        .periodic(PeriodicBox::new([0.0; 3], [1e7; 3]))
        .sphere(ball(1.0, 1.0, 1.0))
        .sphere(ball(9e6, 9e6, 9e6));
    run(2, 1.0, two);
    let tiny = Spheres::random(20).radius(1e-19).mass(1e38).temperature(1e38);
    run(20, 1.0, scene::<f32>().periodic(PeriodicBox::new([0.0; 3], [1.0; 3])).spheres(tiny));
}

#[test]
fn a_crowd_in_a_corner_of_a_large_box() {
    let count = 10_000;
    for side in [1e3, 1e5, 1e9] {
        let container = Cuboid::container([0.0; 3], [side; 3]);
        let periodic = PeriodicBox::new([0.0; 3], [side; 3]);
        let crowd =
            |upper| Spheres::random(count).radius(0.5).temperature(1.0).within([0.0; 3], upper);
        for upper in [[30.0; 3], [300.0, 300.0, 1.5]] {
            run(10_000, 0.2, scene::<f64>().surroundings(container).spheres(crowd(upper)));
            run(10_000, 0.2, scene::<f64>().periodic(periodic).spheres(crowd(upper)));
        }
    }
}

#[test]
fn a_small_ball_at_a_large_fixed_sphere() {
    for (radius, duration) in [(0.01, 1.0), (1e-6, 1.0)] {
        let ball = Sphere::new([-10.5, 0.0, 0.0]).radius(radius).velocity([1.0, 0.0, 0.0]);
        let scene =
            scene::<f64>().surroundings(FixedSphere::solid([0.0; 3], 10.0)).sphere(ball.mass(1e-3));
        let bodies = run(2, duration, scene);
        // There and back.
        let x = -(10.0 + radius) - (duration - (0.5 - radius));
        assert_abs_diff_eq!(bodies.position_of(0).x, x, epsilon = 1e-12);
        assert_eq!(bodies.velocity_of(0).x, -1.0);
    }
}

#[test]
fn a_marble_over_a_slab() {
    let slab = Cuboid::solid([-10.0, -10.0, -1.0], [10.0, 10.0, 0.0]);
    let marble = Sphere::new([0.0, 0.0, 0.108]).radius(0.008);
    let scene = scene::<f64>().gravity([0.0, 0.0, -10.0]).surroundings(slab).sphere(marble);
    // At the top again after its third bounce.
    let bodies = run(2, 6.0 * (0.02_f64).sqrt(), scene);
    assert_abs_diff_eq!(bodies.position_of(0).z, 0.108, epsilon = 1e-9);
}

#[test]
fn a_crowd_and_one_far_away() {
    let crowd = Spheres::random(5_000).radius(0.01).within([0.0; 3], [1.0; 3]).temperature(1.0);
    for far in [10.0, 1e3, 1e6] {
        let stray = ball(far, far, far).radius(0.01).velocity([-1.0, 2.0, 3.0]);
        run(5_001, 0.02, scene::<f64>().spheres(crowd.clone()).sphere(stray));
    }
}

#[test]
fn a_giant_in_dust() {
    let dust = Spheres::random(5_000).radius(0.05).mass(1e-3).temperature(1e-3);
    let scene = scene::<f64>()
        .surroundings(Cuboid::container([0.0; 3], [40.0; 3]))
        .sphere(Sphere::new([20.0; 3]).radius(15.0).mass(1e3))
        .spheres(dust);
    run(5_001, 1e-3, scene);
}

#[test]
fn many_fixed_parts_and_few_balls() {
    // A lattice of posts, and walls that all cross each other.
    let mut posts = scene::<f64>();
    let mut walls = scene::<f64>();
    for k in 0..20_000 {
        let at = [k / 625, k / 25 % 25, k % 25].map(f64::from);
        posts = posts.surroundings(FixedSphere::solid(at, 0.4));
    }
    for k in 0..1_000 {
        let x = f64::from(k);
        let mut corners = [[-1.0; 3], [1_000.0; 3]];
        let axis = (k % 3) as usize;
        (corners[0][axis], corners[1][axis]) = (x, x + 0.5);
        walls = walls.surroundings(Cuboid::solid(corners[0], corners[1]));
    }
    let ball = |x| Sphere::new([x; 3]).radius(1e-3).velocity([1.0, 0.5, 0.25]);
    run(20_001, 10.0, posts.sphere(ball(0.45)));
    run(1_001, 10.0, walls.sphere(ball(-2.0)));
}
