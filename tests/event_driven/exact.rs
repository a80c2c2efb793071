//! Exact cases: superballs, bouncing balls, parabolas, a ball in a sphere.

use carom::contact::Surface;
use carom::engine::Compiled;
use carom::scene::Sphere;
use carom::space::PeriodicBox;
use carom::surroundings::{FixedSphere, Plane};

use crate::common::known::SUPERBALL;
use crate::{builder, events, floor, t3, world};

/// A rough ball between floor and ceiling without gravity, from no spin: its
/// velocity and spin after each bounce (Garwin 1969: the third comes back).
#[test]
fn superball() {
    fn errors<T: Compiled>() -> f64 {
        let scene = builder::<T>()
            .surface(Surface::Rough)
            .surroundings(floor())
            .surroundings(Plane::new(t3([0.0, 0.0, 2.0]), t3([0.0, 0.0, -1.0])))
            .sphere(Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([1.0, 0.0, -1.0]));
        let found = events(&mut world(scene.build().unwrap()), 6.0);
        assert_eq!(found.len(), SUPERBALL.len());
        let mut worst = 0.0_f64;
        for (k, (event, (velocity, surface))) in found.iter().zip(SUPERBALL).enumerate() {
            assert_eq!(event.time, 0.5 + k as f64);
            worst = worst.max((event.velocity.x.to_f64() - velocity).abs());
            // The spin of the source turns the other way about.
            worst = worst.max((0.5 * event.spin.y.to_f64() + surface).abs());
        }
        worst / T::EPSILON.to_f64()
    }
    let (single, double) = (errors::<f32>(), errors::<f64>());
    println!("f32 {single:.1} ε, f64 {double:.1} ε");
    assert!(single < 10.0 && double < 10.0, "{single} {double}");
}

/// In a vertical channel under gravity a rough ball never falls: its heights at
/// the bounces from rest, in units of gT².
#[test]
fn rough_ball_in_a_channel_does_not_fall() {
    fn errors<T: Compiled>() -> f64 {
        let scene = builder::<T>()
            .surface(Surface::Rough)
            .gravity(t3([0.0, 0.0, -1.0]))
            .surroundings(Plane::new(t3([0.0; 3]), t3([1.0, 0.0, 0.0])))
            .surroundings(Plane::new(t3([2.0, 0.0, 0.0]), t3([-1.0, 0.0, 0.0])))
            .sphere(Sphere::new([0.5, 0.0, 0.0]).radius(0.5).velocity([1.0, 0.0, 0.0]));
        let mut world = world(scene.build().unwrap());
        // At the times of the bounces, T = 1 apart.
        let exact: [f64; 6] = [
            -1.0 / 2.0,
            -10.0 / 7.0,
            -169.0 / 98.0,
            -360.0 / 343.0,
            -841.0 / 4802.0,
            -1690.0 / 16807.0,
        ];
        let found = events(&mut world, 6.5);
        assert_eq!(found.len(), exact.len());
        let errors = found.iter().zip(exact).map(|(event, exact)| {
            let time = (event.time - event.time.round()).abs();
            time.max((event.point.z.to_f64() - exact).abs())
        });
        let worst = errors.fold(0.0, f64::max) / T::EPSILON.to_f64();
        for _ in 0..1000 {
            world.advance(1.0).unwrap();
            let height = world.bodies().position_of(0).z.to_f64();
            assert!((-1.75..1e-3).contains(&height), "{height}");
        }
        worst
    }
    let (single, double) = (errors::<f32>(), errors::<f64>());
    println!("f32 {single:.1} ε, f64 {double:.1} ε");
    assert!(single < 40.0 && double < 40.0, "{single} {double}");
}

/// `I w − (r/R) m c × v` of a rough ball inside a fixed sphere, `R = Rc − r`.
#[test]
fn rough_ball_in_a_sphere_keeps_its_generalised_spin() {
    fn error<T: Compiled>() -> f64 {
        let (radius, fixed) = (0.3, 2.0);
        let ball = Sphere::new([0.1, 0.2, -0.3]).radius(radius);
        let scene = builder::<T>()
            .surface(Surface::Rough)
            .surroundings(FixedSphere::container(t3([0.0; 3]), T::from_f64(fixed)))
            .sphere(ball.velocity([1.0, -2.0, 0.5]).spin([3.0, 1.0, -2.0]))
            .build()
            .unwrap();
        let inertia = scene.bodies.inertia.of(0);
        let mut world = world(scene);
        let mut all = Vec::new();
        for _ in 0..20 {
            world.advance_until(50, 1e3).unwrap();
            let bodies = world.bodies();
            let orbit = bodies.position_of(0).cross(bodies.velocity_of(0));
            let share = T::from_f64(radius / (fixed - radius));
            all.push(bodies.spin_of(0) * inertia - orbit * share);
        }
        assert_eq!(world.collisions().surroundings, 1000);
        let errors = all.iter().map(|value| (*value - all[0]).length() / all[0].length());
        errors.fold(0.0, |most: f64, error| most.max(error.to_f64())) / T::EPSILON.to_f64()
    }
    let (single, double) = (error::<f32>(), error::<f64>());
    println!("f32 {single:.1} ε, f64 {double:.1} ε after 1,000 bounces");
    assert!(single < 1000.0 && double < 1000.0, "{single} {double}");
}

/// A ball dropped from a height of 1 at g = 1: it is down at √2 and then every
/// 2√2, and as high as at the start after 1,000 bounces.
#[test]
fn bouncing_ball() {
    fn errors<T: Compiled>() -> [f64; 2] {
        let scene = builder::<T>()
            .gravity(t3([0.0, 0.0, -1.0]))
            .surroundings(floor())
            .sphere(Sphere::new([0.0, 0.0, 1.5]).radius(0.5));
        let mut world = world(scene.build().unwrap());
        let half_period = 2.0_f64.sqrt();
        let found = events(&mut world, 2000.0 * half_period);
        assert_eq!(found.len(), 1000);
        let late = found.iter().enumerate().map(|(k, event)| {
            let exact = half_period * (2 * k + 1) as f64;
            (event.time - exact).abs() / exact
        });
        let bodies = world.bodies();
        let (height, speed) = (bodies.position_of(0).z.to_f64(), bodies.velocity_of(0).z.to_f64());
        let apex = (height - 0.5 + speed * speed / 2.0 - 1.0).abs();
        [late.fold(0.0, f64::max), apex].map(|error| error / T::EPSILON.to_f64())
    }
    let (single, double) = (errors::<f32>(), errors::<f64>());
    println!("time, apex: f32 {single:.1?} ε, f64 {double:.1?} ε after 1,000 bounces");
    for [time, apex] in [single, double] {
        assert!(time < 1000.0 && apex < 2000.0, "{time} ε in time, {apex} ε in height");
    }
}

/// A ball that comes down just after a whole time, when the engine begins to
/// count time again: it is not taken for one that has just bounced off.
#[test]
fn bounces_near_whole_times() {
    fn bounce<T: Compiled>() {
        for k in -40..=40 {
            // Down after 16, 48, 80 … and a little.
            let height = 128.5 + f64::from(128 * k) * T::EPSILON.to_f64();
            let scene = builder::<T>()
                .gravity(t3([0.0, 0.0, -1.0]))
                .surroundings(floor())
                .sphere(Sphere::new([1000.0, 0.0, height]).radius(0.5));
            let mut world = world(scene.build().unwrap());
            world.advance(2048.0).unwrap();
            assert_eq!(world.collisions().surroundings, 64, "{} {k}", T::NAME);
            assert!(world.bodies().position_of(0).z > T::ZERO, "{} {k}", T::NAME);
        }
    }
    bounce::<f32>();
    bounce::<f64>();
}

/// Parabolas against a fixed sphere, together of radius 1, in rationals.
#[test]
fn parabolas_meet_a_sphere_at_the_exact_time() {
    fn errors<T: Compiled>() -> f64 {
        let cases = [
            ([0.0, 2.8, 0.0], [0.0; 3], 0.6),
            ([1.6, 2.05, -0.5], [-2.0, 0.0, 1.0], 0.5),
            ([-0.25, -1.8125, 0.0], [1.0, 4.5, 0.0], 0.25),
        ];
        let mut worst = 0.0_f64;
        for (position, velocity, time) in cases {
            let scene = builder::<T>()
                .gravity(t3([0.0, -10.0, 0.0]))
                .surroundings(FixedSphere::solid(t3([0.0; 3]), T::from_f64(0.75)))
                .sphere(Sphere::new(position).radius(0.25).velocity(velocity));
            let found = events(&mut world(scene.build().unwrap()), 0.61);
            worst = worst.max((found[0].time - time).abs());
        }
        worst / T::EPSILON.to_f64()
    }
    let (single, double) = (errors::<f32>(), errors::<f64>());
    println!("f32 {single:.1} ε, f64 {double:.1} ε");
    assert!(single < 4.0 && double < 4.0, "{single} {double}");
}

/// Two equal balls on a line in a periodic box: each in turn goes round and meets the other
/// from its other side, at times that periods of the engine can begin at, too.
#[test]
fn the_same_two_meet_again_through_the_other_side() {
    fn around<T: Compiled>() {
        for eighths in 1..=16 {
            let gap = f64::from(eighths) / 8.0;
            let scene = builder::<T>()
                .periodic(PeriodicBox::new(t3([0.0; 3]), t3([4.0; 3])))
                .sphere(Sphere::new([0.5, 2.0, 2.0]).radius(0.5).velocity([1.0, 0.0, 0.0]))
                .sphere(Sphere::new([1.5 + gap, 2.0, 2.0]).radius(0.5));
            let mut world = world(scene.build().unwrap());
            let times: Vec<f64> = events(&mut world, 50.0).iter().map(|event| event.time).collect();
            let right: Vec<f64> = (0..25).map(|k| gap + 2.0 * f64::from(k)).collect();
            assert_eq!(times, right, "{gap} in {}", T::NAME);
        }
    }
    around::<f32>();
    around::<f64>();
}

/// Two bodies fly side by side and approach each other by a few units in the last place of
/// their velocities, which a coarser precision rounds away or turns.
#[test]
fn side_by_side() {
    fn meet<T: Compiled>() {
        let slow = 16.0 * T::EPSILON.to_f64();
        for (gap, time) in [(0.0, 0.0), (0.25 * slow, 0.25), (0.5 * slow, 0.5)] {
            for velocity in [[0.0, 1.0, 0.0], [0.7, -0.3, 0.9], [-0.51, 0.49, 0.02]] {
                let velocity = velocity.map(|v| T::from_f64(v).to_f64());
                let [x, y, z] = velocity;
                let scene = builder::<T>()
                    .sphere(Sphere::new([0.0; 3]).radius(0.5).velocity([x + slow, y, z]))
                    .sphere(Sphere::new([1.0 + gap, 0.0, 0.0]).radius(0.5).velocity(velocity))
                    .sphere(Sphere::new([0.0, 2.0, 2.0]).radius(0.5).velocity([0.0, 2.0, 2.0]));
                let found = events(&mut world(scene.build().unwrap()), 1.0);
                assert_eq!(found.len(), 1, "{velocity:?}, gap {gap:e}");
                assert!((found[0].time - time).abs() < 0.07, "{} for {time}", found[0].time);
            }
        }
    }
    meet::<f32>();
    meet::<f64>();
}
