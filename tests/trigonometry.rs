//! Sine and cosine against references of more digits.

mod common;

use carom::DoubleDouble;
use carom::real::Real;
use carom::trigonometry::sin_cos;
use common::numbers::Random;

/// Error of `found` in units of the last place of `expected`, for a number of
/// `digits` binary digits and the least exponent `least`.
fn ulps(found: f64, expected: f64, difference: f64, digits: i32, least: i32) -> f64 {
    if difference == 0.0 {
        return 0.0;
    }
    let exponent = (expected.abs().log2().floor() as i32).max(least);
    assert!(found.is_finite());
    difference.abs() / 2_f64.powi(exponent - digits + 1)
}

/// Greatest errors over every `stride`-th `f32` of the range of the table in
/// [`sin_cos`]: in units of the last place up to where quarter turns are counted,
/// absolute beyond.
#[allow(clippy::disallowed_methods)] // The platform's f64 functions are the reference.
fn sweep_f32(stride: usize) -> (f64, f64) {
    let counted = 262_144.0 * core::f32::consts::FRAC_PI_2;
    let (mut worst, mut worst_far) = (0.0, 0.0);
    for bits in (0..(2_f32.powi(38)).to_bits()).step_by(stride) {
        let x = f32::from_bits(bits);
        let (sine, cosine) = sin_cos(x);
        let (expected_sine, expected_cosine) = f64::from(x).sin_cos();
        for (found, expected) in [(sine, expected_sine), (cosine, expected_cosine)] {
            let found = f64::from(found);
            if x <= counted {
                worst = f64::max(worst, ulps(found, expected, found - expected, 24, -126));
            } else {
                worst_far = f64::max(worst_far, (found - expected).abs());
            }
        }
    }
    (worst, worst_far)
}

#[test]
fn f32_is_right_to_the_last_place() {
    let (worst, worst_far) = sweep_f32(997);
    println!("f32: {worst:.3} units in the last place, {worst_far:.1e} beyond");
    assert!(worst < 0.81 && worst_far < 6e-8);
}

#[test]
#[ignore = "all numbers: a minute"]
fn every_f32_is_right_to_the_last_place() {
    let (worst, worst_far) = sweep_f32(1);
    println!("f32: {worst:.3} units in the last place, {worst_far:.1e} beyond");
    assert!(worst < 0.81 && worst_far < 6e-8);
}

/// The `f64` of the table's first range that are nearest to a multiple of π/2,
/// found by continued fractions, with sine and cosine from 400 bits.
const NEAREST: [(f64, f64, f64); 9] = [
    (45.553093477052, 1.0, -6.189806365883577e-19),
    (91.106186954104, -1.2379612731767154e-18, -1.0),
    (14461176.67027838, -1.0, -1.6985038298986004e-18),
    (182.212373908208, 2.475922546353431e-18, 1.0),
    (28922353.34055676, 3.3970076597972008e-18, -1.0),
    (57844706.68111352, -6.7940153195944015e-18, 1.0),
    (563416747700.2246, 1.0, 1.5011223641895818e-17),
    (205097628711448.4, 1.0, 1.9177273808217003e-17),
    (1457.698991265664, 1.9807380370827447e-17, 1.0),
];

#[test]
fn multiples_of_a_quarter_turn_keep_their_digits() {
    for (x, sine, cosine) in NEAREST {
        let (found_sine, found_cosine) = sin_cos(x);
        assert!(ulps(found_sine, sine, found_sine - sine, 53, -1022) <= 1.0, "sin {x}");
        assert!(ulps(found_cosine, cosine, found_cosine - cosine, 53, -1022) <= 1.0, "cos {x}");
    }
}

#[test]
fn f64_is_right_to_the_last_place() {
    let mut random = Random(20);
    let quarter = core::f64::consts::FRAC_PI_2;
    let (mut worst, mut worst_far) = (0.0, 0.0);
    for case in 0..300_000_u32 {
        let x = match case % 3 {
            0 => random.magnitude(-9, 13),
            1 => random.unit::<f64>() * 10.0,
            // Next to a multiple of half a quarter turn.
            _ => f64::from(case) * (quarter / 2.0) * (1.0 + 3e-16 * random.unit::<f64>()),
        };
        // The reference counts turns to 53 digits.
        let far = random.magnitude::<f64>(14, 16);
        for (x, is_far) in [(x, false), (far, true)] {
            let (sine, cosine) = sin_cos(x);
            let expected = sin_cos(DoubleDouble::new(x, 0.0));
            for (found, expected) in [(sine, expected.0), (cosine, expected.1)] {
                let difference = (expected - DoubleDouble::new(found, 0.0)).high();
                if is_far {
                    worst_far = f64::max(worst_far, difference.abs());
                } else {
                    worst = f64::max(worst, ulps(found, expected.high(), difference, 53, -1022));
                }
            }
        }
    }
    println!("f64: {worst:.3} units in the last place, {worst_far:.1e} beyond");
    assert!(worst < 0.81 && worst_far < 2.2e-16);
}

/// What holds for any number at all.
fn is_defined_everywhere<T: Real>(great: &[T], no_number: &[T]) {
    for &x in great {
        for x in [x, -x] {
            let (sine, cosine) = sin_cos(x);
            let bound = T::ONE + T::EPSILON;
            assert!(sine.abs() <= bound && cosine.abs() <= bound);
            let error = (sine * sine + cosine * cosine - T::ONE).abs();
            assert!(error <= T::EPSILON * T::whole(2));
        }
    }
    for &x in no_number {
        for x in [x, -x] {
            let (sine, cosine) = sin_cos(x);
            assert!(!sine.is_finite() && !cosine.is_finite());
        }
    }
}

#[test]
fn any_number_has_a_sine() {
    let great = (0..300).map(|k| 1.4_f64.powi(k)).collect::<Vec<_>>();
    is_defined_everywhere(&great, &[f64::NAN, f64::INFINITY]);
    is_defined_everywhere(&[f64::MAX, 1e300, 7e28, 8e28], &[]);
    let great = (0..263).map(|k| 1.4_f32.powi(k)).collect::<Vec<_>>();
    is_defined_everywhere(&great, &[f32::NAN, f32::INFINITY]);
    is_defined_everywhere(&[f32::MAX, 1e30, 2.7e11, 2.8e11], &[]);
    assert_eq!(sin_cos(f64::MAX), (0.0, 1.0));
}

#[test]
fn zeros_and_the_least_numbers_are_their_own_sine() {
    for x in [0.0, f64::from_bits(1), f64::MIN_POSITIVE, 1e-200] {
        for x in [x, -x] {
            let (sine, cosine) = sin_cos(x);
            assert_eq!((sine.to_bits(), cosine), (x.to_bits(), 1.0));
        }
    }
}
