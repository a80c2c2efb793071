//! A number with 105 digits runs through the same formulas: known digits and
//! identities to 1e-30.

mod common;

use carom::DoubleDouble;
use carom::column::Column;
use carom::lane::Lane;
use carom::mat3::Mat3;
use carom::motion::Integrator;
use carom::motion::integrator::{FlightStep, VelocityVerlet};
use carom::motion::rotation::{reference_rotation, turned};
use carom::motion::turning::turn;
use carom::real::Real;
use carom::space::OpenSpace;
use carom::trigonometry::sin_cos;
use carom::vec3::Vec3;
use common::numbers::Random;

type Number = DoubleDouble;

fn is_near(found: Number, expected: Number, within: f64) -> bool {
    (found - expected).abs().to_f64() < within
}

fn are_near(a: Mat3<Number>, b: Mat3<Number>, within: f64) -> bool {
    a.rows().into_iter().zip(b.rows()).all(|(a, b)| is_near(a, b, within))
}

/// Both parts, the sign of zero and infinity.
#[test]
fn a_cast_keeps_what_the_other_precision_can_hold() {
    let third = Number::ratio(1, 3);
    let same: Number = third.cast();
    assert_eq!([same.high(), same.low()], [third.high(), third.low()]);
    assert_eq!(third.cast::<f64>(), 1.0 / 3.0);
    assert_eq!(third.cast::<f32>(), 1.0 / 3.0);
    for value in [-0.0, 0.5, -1e300, f64::MIN_POSITIVE, f64::INFINITY] {
        let bits = [value, value.cast::<Number>().cast()].map(f64::to_bits);
        assert_eq!(bits[0], bits[1]);
    }
    let vector = Vec3::new(third, Number::ZERO, -third);
    assert_eq!(vector.cast::<f64>().to_array(), [1.0 / 3.0, 0.0, -1.0 / 3.0]);
    assert_eq!(vector.cast::<Number>(), vector);
}

#[test]
fn sine_and_cosine_have_known_digits() {
    // From 400 bits.
    let known: [(f64, [f64; 2], [f64; 2]); 6] = [
        (
            1.0,
            [0.8414709848078965, 1.776845092935536e-18],
            [0.5403023058681398, -4.760954612604417e-17],
        ),
        (
            0.001,
            [0.0009999998333333417, 5.670638989736153e-21],
            [0.9999995000000417, -7.831485455398128e-18],
        ),
        (
            100.5,
            [-0.030959966783271346, 8.320928549434447e-19],
            [0.9995206253283515, -5.012512561737467e-17],
        ),
        (
            -2.5,
            [-0.5984721441039565, 5.521403334082375e-17],
            [-0.8011436155469337, -1.8674742705085553e-17],
        ),
        (
            1e10,
            [-0.4875060250875107, -1.665199285246269e-17],
            [0.873119622676856, -5.41448904944852e-17],
        ),
        (
            1099511627776.0,
            [-0.40570501153282873, 1.0038186701476513e-17],
            [-0.914004071991557, -2.5615698270212482e-17],
        ),
    ];
    for (x, sine, cosine) in known {
        let found = sin_cos(Number::new(x, 0.0));
        assert!(is_near(found.0, Number::new(sine[0], sine[1]), 1e-31));
        assert!(is_near(found.1, Number::new(cosine[0], cosine[1]), 1e-31));
    }
}

#[test]
fn sine_and_cosine_obey_their_identities() {
    let mut random = Random(30);
    let half = Number::ratio(1, 2);
    for _ in 0..2000 {
        let x: Number = random.magnitude(-6, 12);
        let (sine, cosine) = sin_cos(x);
        assert!(is_near(sine * sine + cosine * cosine, Number::ONE, 1e-31));
        let (half_sine, half_cosine) = sin_cos(x * half);
        assert!(is_near(sine, (half_sine + half_sine) * half_cosine, 2e-31));
        assert!(is_near(cosine, Number::ONE - (half_sine + half_sine) * half_sine, 2e-31));
    }
}

#[test]
fn rotations_agree_and_compose() {
    let mut random = Random(31);
    for _ in 0..1000 {
        let spin: Vec3<Number> = random.vector();
        let time: Number = random.magnitude(-3, 3);
        let reference = reference_rotation(spin, time);
        let fast = turned(Mat3::IDENTITY, spin, time);
        assert!(are_near(fast, reference, 3e-29));
        assert!(are_near(fast.transpose() * fast, Mat3::IDENTITY, 1e-30));
        assert!(are_near(turned(fast, spin, -time), Mat3::IDENTITY, 1e-29));
    }
}

#[test]
fn columns_turn_and_fly() {
    // A turn in a hundred steps.
    let turn_in_steps = Number::QUARTER_TURN[0] + Number::QUARTER_TURN[1] + Number::QUARTER_TURN[2];
    let dt = turn_in_steps * Number::ratio(4, 100);
    let zero = Column::new(3, Number::ZERO);
    let spin = Column::new(3, Number::ONE);
    let mut rows: [Column<Number>; 9] =
        core::array::from_fn(|k| Column::new(3, Number::whole(i32::from(k % 4 == 0))));
    for _ in 0..100 {
        turn::<Number>(rows.each_mut().map(|row| &mut row[..]), [&zero, &zero, &spin], dt);
    }
    let m = Mat3::from_rows(core::array::from_fn(|k| rows[k][2]));
    assert!(are_near(m, Mat3::IDENTITY, 1e-30));

    // A throw of 3 s in 300 steps, by the exact parabola.
    let gravity = Vec3::new(Number::ZERO, Number::ZERO, Number::ratio(-981, 100));
    let (mut x, mut z) = (Column::new(3, Number::ZERO), Column::new(3, Number::ZERO));
    let (mut u, mut w) = (Column::new(3, Number::ONE), Column::new(3, Number::whole(10)));
    let (mut y, mut v) = (zero.clone(), zero.clone());
    for _ in 0..300 {
        Integrator::VelocityVerlet.flight::<Number, _>(
            [&mut x, &mut y, &mut z],
            [&mut u, &mut v, &mut w],
            Some(gravity),
            Number::ratio(1, 100),
            OpenSpace,
        );
    }
    let (end, velocity) = VelocityVerlet::step(
        Vec3::ZERO,
        Vec3::new(Number::ONE, Number::ZERO, Number::whole(10)),
        gravity,
        Number::whole(3),
    );
    assert!(is_near(x[2], end.x, 1e-29) && is_near(z[2], end.z, 1e-28));
    assert!(is_near(w[2], velocity.z, 1e-29));
}
