//! Sums: how positions and velocities add up over many short steps.

use carom::engine::{Compiled, Stepped};
use carom::motion::Integrator;
use carom::real::Real;
use carom::scene::{Scene, SceneBuilder, Sphere, Summation};
use carom::space::PeriodicBox;

/// A ball of one radius at a coordinate along `x`, and one far away, so that the scene
/// has no better origin of its own.
fn two_balls<T: Real>(x: f64, speed: f64) -> SceneBuilder<T> {
    let ball = |x: f64| Sphere::new([x, 0.0, 0.0]).radius(0.5);
    Scene::<T>::builder().sphere(ball(x).velocity([speed, 0.0, 0.0])).sphere(ball(-x - 2.0))
}

fn end<T: Compiled>(scene: SceneBuilder<T>, dt: f64, steps: u64) -> (f64, f64) {
    let mut world = Stepped::new(scene.dt(dt).build().unwrap()).unwrap();
    world.advance_steps(steps);
    let bodies = world.bodies();
    (bodies.position_of(0).x.to_f64(), bodies.velocity_of(0).x.to_f64())
}

/// A ball at 1000 with speed 1 moves, however short the step.
#[test]
fn no_body_is_frozen() {
    for dt in [1e-3, 1e-5, 1e-7] {
        let (x, _) = end::<f32>(two_balls(1000.0, 1.0), dt, 100_000);
        let exact = 1000.0 + f64::from(dt as f32) * 100_000.0;
        assert!((x - exact).abs() <= 0.5 * 2.0_f64.powi(-14), "{dt}: {x}");
        let plain = two_balls(1000.0, 1.0).summation(Summation::Plain);
        let (x, _) = end::<f32>(plain, dt, 100_000);
        assert!((x - exact).abs() > 0.01 || dt < 1e-6 && x == 1000.0, "{dt}: {x}");
    }
    let (x, _) = end::<f64>(two_balls(1e12, 1.0), 1e-5, 100_000);
    assert!((x - 1e12 - 1.0).abs() <= 2.0_f64.powi(-13), "{x}");
}

/// After 10⁶ steps of any length the error is a few ε of the way and of the coordinate.
#[test]
fn the_error_of_the_way_is_a_few_epsilon() {
    fn errors<T: Compiled>() {
        let epsilon = T::EPSILON.to_f64();
        for (dt, speed) in [(1e-3, 0.7), (1e-4, 1.3), (3e-6, 0.9)] {
            let scene = || two_balls::<T>(10.0, speed).summation(Summation::Compensated);
            let steps = 1_000_000;
            let (x, _) = end(scene(), dt, steps);
            let way = T::from_f64(speed).to_f64() * T::from_f64(dt).to_f64() * steps as f64;
            let error = (x - 10.0 - way).abs();
            assert!(error <= 2.0 * epsilon * (10.0 + way), "{} {dt}: {error:e}", T::NAME);
        }
    }
    errors::<f32>();
    errors::<f64>();
}

/// A free fall by velocity Verlet is the parabola to a few ε, over 10⁵ steps.
#[test]
fn a_fall_is_a_parabola() {
    fn falls<T: Compiled>() {
        let (dt, steps) = (1e-4, 100_000);
        let gravity = T::from_f64(-9.81);
        let scene = two_balls::<T>(30.0, 0.25)
            .integrator(Integrator::VelocityVerlet)
            .summation(Summation::Compensated)
            .gravity([gravity, T::ZERO, T::ZERO]);
        let (x, speed) = end(scene, dt, steps);
        let time = T::from_f64(dt).to_f64() * steps as f64;
        let exact_speed = 0.25 + gravity.to_f64() * time;
        let exact = 30.0 + 0.25 * time + 0.5 * gravity.to_f64() * time * time;
        let epsilon = T::EPSILON.to_f64();
        assert!((speed - exact_speed).abs() <= 2.0 * epsilon * exact_speed.abs(), "{speed}");
        assert!((x - exact).abs() <= 4.0 * epsilon * exact.abs(), "{} {x} {exact}", T::NAME);
    }
    falls::<f32>();
    falls::<f64>();
}

/// In a periodic box, through its boundary many times.
#[test]
fn wrapping_loses_nothing() {
    let scene = Scene::<f32>::builder()
        .periodic(PeriodicBox::new([-64.0; 3], [64.0; 3]))
        .sphere(Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]));
    // 100 boxes of 128, in steps of 2⁻¹⁰.
    let (x, _) = end(scene, 2.0_f64.powi(-10), 128 * 100 * 1024 / 16);
    assert_eq!(x, 800.0 - 768.0);
}

/// Where steps are long beside the digits of the coordinates, sums are plain.
#[test]
fn sums_are_compensated_where_they_need_it() {
    fn summation<T: Compiled>(x: f64, dt: f64) -> Summation {
        Stepped::new(two_balls::<T>(x, 1.0).dt(dt).build().unwrap()).unwrap().plan().summation
    }
    assert_eq!(summation::<f32>(10.0, 1e-2), Summation::Compensated);
    assert_eq!(summation::<f64>(10.0, 1e-3), Summation::Plain);
    assert_eq!(summation::<f64>(1e6, 1e-3), Summation::Compensated);
}
