//! Exact cases: cradles, bouncing balls, superballs, pair collisions.

use carom::contact::Surface;
use carom::engine::Compiled;
use carom::motion::Integrator;
use carom::observe::Energy;
use carom::scene::Impact;
use carom::scene::{Scene, SceneBuilder, Sphere};
use carom::surroundings::Plane;
use carom::vec3::Vec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::common::known::{CRADLES, SUPERBALL};
use crate::{FAST, world};

const BOTH: [Impact; 2] = [Impact::EndOfStep, Impact::SubStep];

fn floor<T: Compiled>() -> Plane<T> {
    Plane::new([T::ZERO; 3], [T::ZERO, T::ZERO, T::ONE])
}

/// Cradles, touching or not, pairwise in order.
#[test]
fn cradles() {
    for impact in BOTH {
        for gap in [0.0, 0.1] {
            for (masses, before, after, collisions) in CRADLES {
                let mut builder = Scene::<f64>::builder().impact(impact).dt(1.0 / 64.0);
                for (k, (mass, velocity)) in masses.iter().zip(before).enumerate() {
                    let sphere = Sphere::new([k as f64 * (1.0 + gap), 0.0, 0.0]).radius(0.5);
                    builder = builder.sphere(sphere.mass(*mass).velocity([*velocity, 0.0, 0.0]));
                }
                let mut world = world(builder.build().unwrap(), FAST);
                world.advance(4.0).unwrap();
                assert_eq!(world.collisions().pairs, collisions, "{masses:?} {gap} {impact:?}");
                for (k, exact) in after.iter().enumerate() {
                    let error = (world.bodies().velocity_of(k).x - exact).abs();
                    assert!(error <= 4.0 * f64::EPSILON, "{masses:?} {gap} {impact:?}: {error:e}");
                }
                // Touching balls pass it on at once, within the step.
                if gap == 0.0 && impact == Impact::SubStep && masses.len() == 3 {
                    let last = world.bodies().position_of(2).x;
                    let exact = 2.0 + after[2] * 4.0;
                    assert!((last - exact).abs() < 1e-14, "{masses:?}: {last} against {exact}");
                }
            }
        }
    }
}

/// Galperin's billiard: a ball at rest between a wall and a ball `100^k` times
/// as heavy coming in collides `⌊π 10^k⌋` times in all, however many of them
/// fall into one step.
#[test]
fn galperin() {
    for (k, collisions) in [(0, 3), (1, 31), (2, 314)] {
        for dt in [1e-3, 1e-2, 1e-1] {
            let ball = |x: f64| Sphere::new([x, 0.0, 0.0]).radius(0.1);
            let scene = Scene::<f64>::builder()
                .surroundings(Plane::new([0.0; 3], [1.0, 0.0, 0.0]))
                .sphere(ball(1.0))
                .sphere(ball(5.0).mass(100.0_f64.powi(k)).velocity([-1.0, 0.0, 0.0]))
                .impact(Impact::SubStep)
                .dt(dt)
                .build()
                .unwrap();
            let mut world = world(scene, FAST);
            world.advance(40.0).unwrap();
            let found = world.collisions();
            println!("{k} {dt}: {found:?}");
            assert_eq!(found.pairs + found.surroundings, collisions, "k = {k}, Δt = {dt}");
        }
    }
}

fn bouncing<T: Compiled>(integrator: Integrator, impact: Impact, dt: f64) -> SceneBuilder<T> {
    Scene::<T>::builder()
        .gravity([T::ZERO, T::ZERO, -T::ONE])
        .surroundings(floor())
        .sphere(Sphere::new([0.0, 0.0, 1.5]).radius(0.5))
        .integrator(integrator)
        .impact(impact)
        .dt(dt)
}

/// With the time of impact inside the step and the exact parabola the apex
/// stays where it was: 1 ± 1e-12 after 1,000 bounces.
#[test]
fn apex_after_a_thousand_bounces() {
    fn apex<T: Compiled>() -> f64 {
        let scene = bouncing::<T>(Integrator::VelocityVerlet, Impact::SubStep, 1.0 / 240.0);
        let mut world = world(scene.build().unwrap(), FAST);
        while world.collisions().surroundings < 1_000 {
            world.advance_steps(1);
        }
        let bodies = world.bodies();
        let (height, speed) = (bodies.position_of(0).z.to_f64(), bodies.velocity_of(0).z.to_f64());
        height - 0.5 + speed * speed / 2.0
    }
    let (single, double) = (apex::<f32>() - 1.0, apex::<f64>() - 1.0);
    println!("f32 {single:+.1e}, f64 {double:+.1e}");
    assert!(double.abs() < 1e-12 && single.abs() < 1e-3, "{single:e} {double:e}");
}

/// Plain reversal at the end of the step, velocity first: energy `1 − 30h` at
/// `T = 60`, exactly.
#[test]
fn plain_reversal_loses_what_the_law_says() {
    for steps_per_time in [64_u32, 128, 256] {
        let dt = 1.0 / f64::from(steps_per_time);
        let scene = bouncing::<f64>(Integrator::SemiImplicitEuler, Impact::EndOfStep, dt);
        let scene = scene.build().unwrap();
        let gravity = scene.gravity;
        let mut world = world(scene, FAST);
        world.advance(60.0).unwrap();
        // From the floor that the ball's centre cannot pass.
        let energy = Energy::of(&world.bodies(), gravity).total() - 0.5;
        let exact = 1.0 - 30.0 * dt;
        assert!((energy - exact).abs() < 1e-12, "{energy} against {exact}");
    }
}

/// A rough ball between floor and ceiling without gravity, from no spin: its
/// velocity and spin after each bounce (Garwin 1969: the third comes back).
#[test]
fn superball() {
    fn errors<T: Compiled>(impact: Impact) -> f64 {
        let (radius, height) = (0.5, 2.0);
        let ceiling =
            Plane::new([T::ZERO, T::ZERO, T::from_f64(height)], [T::ZERO, T::ZERO, -T::ONE]);
        let scene = Scene::<T>::builder()
            .surface(Surface::Rough)
            .impact(impact)
            .surroundings(floor())
            .surroundings(ceiling)
            .sphere(Sphere::new([0.0, 0.0, 1.0]).radius(radius).velocity([1.0, 0.0, -1.0]))
            .dt(1.0 / 128.0);
        let mut world = world(scene.build().unwrap(), FAST);
        let mut worst = 0.0_f64;
        for (bounce, (velocity, surface)) in SUPERBALL.into_iter().enumerate() {
            while world.collisions().surroundings <= bounce as u64 {
                world.advance_steps(1);
            }
            let bodies = world.bodies();
            let found = (bodies.velocity_of(0).x.to_f64(), radius * bodies.spin_of(0).y.to_f64());
            worst = worst.max((found.0 - velocity).abs());
            // The spin of the source turns the other way about.
            worst = worst.max((found.1.abs() - surface.abs()).abs());
        }
        worst / T::EPSILON.to_f64()
    }
    for impact in BOTH {
        let (single, double) = (errors::<f32>(impact), errors::<f64>(impact));
        println!("{impact:?}: f32 {single:.1} ε, f64 {double:.1} ε");
        assert!(single < 10.0 && double < 10.0, "{single} {double}");
    }
}

/// In a vertical channel under gravity a rough ball never falls: its heights at
/// the bounces from rest, in units of gT².
#[test]
fn rough_ball_in_a_channel_does_not_fall() {
    let scene = Scene::<f64>::builder()
        .surface(Surface::Rough)
        .impact(Impact::SubStep)
        .integrator(Integrator::VelocityVerlet)
        .gravity([0.0, 0.0, -1.0])
        .surroundings(Plane::new([0.0; 3], [1.0, 0.0, 0.0]))
        .surroundings(Plane::new([2.0, 0.0, 0.0], [-1.0, 0.0, 0.0]))
        .sphere(Sphere::new([0.5, 0.0, 0.0]).radius(0.5).velocity([1.0, 0.0, 0.0]))
        .dt(1.0 / 100.0)
        .build()
        .unwrap();
    let mut world = world(scene, FAST);
    // At the times of the bounces, T = 1 apart.
    let exact = [-1.0 / 2.0, -10.0 / 7.0, -169.0 / 98.0, -360.0 / 343.0, -841.0 / 4802.0];
    let mut heights = Vec::new();
    for _ in 0..550 {
        world.take_steps(1, Some(&mut |event| heights.push(event.point.z)));
    }
    assert_eq!(heights.len(), exact.len());
    for (found, exact) in heights.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-12, "{found} against {exact}");
    }
}

/// Mean error of the velocity after a smooth collision of two equal spheres,
/// relative to the speed, over impact parameters; `travel` is how far they move
/// in a step, in diameters.
fn pair_error<T: Compiled>(impact: Impact, travel: f64) -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(10);
    let mut sum = 0.0;
    let count = 2_000;
    for _ in 0..count {
        let aside: f64 = random.random_range(0.0..0.9);
        let start = random.random_range(1.2..1.5);
        let sphere = |x: f64, y: f64| Sphere::new([x, y, 0.0]).radius(0.5);
        let scene = Scene::<T>::builder()
            .sphere(sphere(-start, aside).velocity([1.0, 0.0, 0.0]))
            .sphere(sphere(0.0, 0.0))
            .impact(impact)
            .dt(travel)
            .build()
            .unwrap();
        let (x, y) =
            (scene.bodies.position_of(0).x.to_f64(), scene.bodies.position_of(0).y.to_f64());
        assert!(x < 0.0);
        let normal = Vec3::new(-(1.0 - y * y).sqrt(), y, 0.0);
        let exact = Vec3::new(1.0, 0.0, 0.0) - normal * normal.x;
        let mut world = world(scene, FAST);
        world.advance(2.5).unwrap();
        assert_eq!(world.collisions().pairs, 1, "aside {aside}");
        let found = world.bodies().velocity_of(0);
        let found = Vec3::from(found.to_array().map(T::to_f64));
        sum += (found - exact).length();
    }
    sum / f64::from(count)
}

/// At the end of the step the normal is off by half a step's travel on average;
/// with the time of impact the error is rounding.
#[test]
fn error_of_a_pair_collision() {
    for travel in [0.02, 0.01] {
        let [single, double] = [
            pair_error::<f32>(Impact::SubStep, travel),
            pair_error::<f64>(Impact::SubStep, travel),
        ];
        let end = pair_error::<f64>(Impact::EndOfStep, travel);
        println!("{travel}: end of step {end:.2e}, sub-step f32 {single:.1e}, f64 {double:.1e}");
        assert!(single < 2e-6 && double < 4e-15, "{single:e} {double:e}");
        // First order: about half of a step's travel, aside of the line.
        assert!(end > 0.1 * travel && end < travel, "{end}");
    }
}
