//! Free flight: the energy laws of the integrators, and the sweeps' edges.

mod common;

use carom::motion::Integrator;
use carom::motion::flight::{flight, flight_and_fastest};
use carom::motion::integrator::{
    Coasting, ExplicitEuler, FlightStep, SemiImplicitEuler, VelocityVerlet,
};
use carom::space::{OpenSpace, PeriodicBox};
use carom::vec3::Vec3;
use common::numbers::Random;

const FIELD: Vec3<f64> = Vec3::new(1.0, -2.0, 4.0);
const DT: f64 = 1.0 / 64.0;

/// Energy over mass on the uniform field.
fn energy((position, velocity): (Vec3<f64>, Vec3<f64>)) -> f64 {
    velocity.length_squared() / 2.0 - FIELD.dot(position)
}

/// Energy gained in `steps` steps over `Δt²|a|²/2`, per step.
fn gain<I: FlightStep>(steps: i32) -> f64 {
    let mut random = Random(40);
    let start = (random.vector(), random.vector());
    let mut state = start;
    for _ in 0..steps {
        state = I::step(state.0, state.1, FIELD, DT);
    }
    (energy(state) - energy(start)) / (DT * DT * FIELD.length_squared() / 2.0) / f64::from(steps)
}

#[test]
fn energy_follows_its_laws() {
    assert!((gain::<SemiImplicitEuler>(1000) + 1.0).abs() < 1e-9);
    assert!((gain::<ExplicitEuler>(1000) - 1.0).abs() < 1e-9);
    assert!(gain::<VelocityVerlet>(1000).abs() < 1e-9);
}

#[test]
fn a_step_of_verlet_is_the_parabola() {
    let (position, velocity) =
        VelocityVerlet::step(Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 0.0), FIELD, 2.0);
    assert_eq!(position, Vec3::new(3.0, 2.0, 8.0));
    assert_eq!(velocity, Vec3::new(2.0, -1.0, 8.0));
}

#[test]
fn coasting_looks_at_no_field() {
    let (position, velocity) =
        Coasting::step(Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0), FIELD * f64::NAN, 0.5);
    assert_eq!(position, Vec3::new(0.5, 1.0, 1.5));
    assert_eq!(velocity, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn the_shortest_column_counts() {
    let (mut x, mut y, mut z) = ([0.0; 9], [0.0; 7], [0.0; 8]);
    let (mut u, mut v, mut w) = ([1.0; 9], [1.0; 9], [1.0; 6]);
    flight::<wide::f64x4, Coasting, _>(
        [&mut x, &mut y, &mut z],
        [&mut u, &mut v, &mut w],
        Vec3::ZERO,
        1.0,
        OpenSpace,
    );
    assert_eq!(x, [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    assert_eq!(y, [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0]);
}

#[test]
fn the_fastest_is_found_anywhere() {
    for fastest in 0..37 {
        let mut zeros = [[0.0_f32; 37]; 5];
        let mut speed = [1.0_f32; 37];
        speed[fastest] = -3.0;
        speed[(fastest + 5) % 37] = f32::NAN;
        let [x, y, z, u, v] = zeros.each_mut().map(|column| column.as_mut_slice());
        let found = flight_and_fastest::<wide::f32x16, Coasting, _>(
            [x, y, z],
            [u, v, &mut speed],
            Vec3::ZERO,
            1.0,
            OpenSpace,
        );
        assert_eq!(found, 9.0);
    }
    let none = Integrator::default().flight_and_fastest::<wide::f32x16, _>(
        [&mut [], &mut [], &mut []],
        [&mut [], &mut [], &mut []],
        None,
        1.0,
        OpenSpace,
    );
    assert_eq!(none, 0.0);
}

#[test]
fn a_periodic_box_takes_bodies_back() {
    let space = PeriodicBox::new([0.0; 3], [10.0; 3]);
    let (mut x, mut y, mut z) = ([9.5; 5], [0.5; 5], [5.0; 5]);
    let (mut u, mut v, mut w) = ([1.0; 5], [-1.0; 5], [1.0; 5]);
    Integrator::SemiImplicitEuler.flight::<wide::f64x4, _>(
        [&mut x, &mut y, &mut z],
        [&mut u, &mut v, &mut w],
        None,
        1.0,
        space,
    );
    assert_eq!((x, y, z), ([0.5; 5], [9.5; 5], [6.0; 5]));
}
