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

/// Reads the digits of a number back, bit by bit.
#[track_caller]
fn goes_round(given: Number) -> String {
    let text = given.to_string();
    let read: Number = text.parse().unwrap();
    assert_eq!(read.halves().map(f64::to_bits), given.halves().map(f64::to_bits), "{text}");
    // Who reads no more finds the nearest f64.
    assert_eq!(text.parse::<f64>(), Ok(given.high()));
    text
}

#[test]
fn digits_of_known_numbers() {
    let of = |high| goes_round(Number::new(high, 0.0));
    assert_eq!(of(0.5), "0.5");
    assert_eq!(of(-3.0), "-3.0");
    assert_eq!(of(1e22), "10000000000000000000000.0");
    assert_eq!(of(2.0_f64.powi(-20)), "9.5367431640625e-7");
    assert_eq!((of(0.0).as_str(), Number::new(-0.0, 0.0).to_string().as_str()), ("0.0", "-0.0"));
    // All digits of the f64, and those of a tenth, with more than an f64 has.
    assert_eq!(of(0.1), "0.1000000000000000055511151231257827021181583404541015625");
    assert_eq!(goes_round(Number::ratio(1, 10)), "0.100000000000000000");
    for text in ["0.33333333333333333333333333333333", "-66.666666666666666666666666666667"] {
        assert_eq!(goes_round(text.parse().unwrap()), text);
    }
    assert_eq!(of(f64::from_bits(1)).len(), 751 + ".e-324".len());
    let tiny = goes_round(Number::new(1.0, 1e-200));
    assert!(tiny.starts_with("1.000000000") && tiny.len() > 200, "{tiny}");
    assert_eq!(Number::new(f64::INFINITY, 0.0).to_string(), "inf");
    assert_eq!(format!("{:.2}", Number::ratio(2, 3)), "0.67");
}

#[test]
fn texts_are_read_to_the_nearest() {
    let read = |text: &str| text.parse::<Number>().map(Real::halves);
    assert_eq!(read("0.1"), Ok([0.1, -5.551115123125783e-18]));
    assert_eq!(read("-.5"), Ok([-0.5, 0.0]));
    assert_eq!(read("+5.e-1"), Ok([0.5, 0.0]));
    assert_eq!(read("0.0000e99999999"), Ok([0.0, 0.0]));
    assert_eq!(read("1e400"), Ok([f64::INFINITY, 0.0]));
    assert_eq!(read("9007199254740993"), Ok([9007199254740992.0, 1.0]));
    for text in ["", "one", "1.5x", "0.5+1e-20", "--1"] {
        assert!(read(text).is_err(), "{text}");
    }
}

/// Halves of any sizes, next to each other or far apart, of either sign.
#[test]
fn all_digits_go_round() {
    let mut state = 1_u64;
    let mut next = || {
        // xorshift* (Vigna 2016).
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        state.wrapping_mul(0x2545_F491_4F6C_DD1D)
    };
    let mut longest = 0;
    for k in 0..20_000 {
        let size: u64 = if k % 4 == 0 { 900 } else { 40 };
        let mantissa = 1.0 + (next() >> 12) as f64 * f64::EPSILON;
        let high = mantissa * 2.0_f64.powi((next() % size) as i32 - size as i32 / 2);
        let is_near = k % 8 != 0;
        let gap = (next() % if is_near { 4 } else { 100 }) as i32;
        let part = (next() >> 11) as f64 * f64::EPSILON / 2.0;
        let low = high * f64::EPSILON / 4.0 * part * 2.0_f64.powi(-gap);
        let [high, low] = [high, low].map(|half| if next() % 2 == 0 { half } else { -half });
        let text = goes_round(Number::new(high, low));
        let digits = text.split('e').next().unwrap_or("").bytes().filter(u8::is_ascii_digit);
        if is_near && part > 0.25 {
            longest = longest.max(digits.skip_while(|digit| *digit == b'0').count());
        }
    }
    println!("{longest} digits at most");
    assert!((32..=36).contains(&longest), "{longest}");
}
