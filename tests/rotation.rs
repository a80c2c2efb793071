//! Orientations: the fast path against the reference, orthonormality and angle
//! after a million steps, and the closed form at great angles.

mod common;

use carom::DoubleDouble;
use carom::lane::Lane;
use carom::mat3::Mat3;
use carom::motion::rotation::{orthonormalised, reference_rotation, turned};
use carom::real::Real;
use carom::vec3::Vec3;
use common::numbers::Random;

/// A precision with a better one to judge it by.
trait Judged: Real {
    type Judge: Real;
}

impl Judged for f32 {
    type Judge = f64;
}

impl Judged for f64 {
    type Judge = DoubleDouble;
}

fn exact<T: Judged>(value: T) -> T::Judge {
    T::Judge::from_f64(value.to_f64())
}

fn exact_vector<T: Judged>(v: Vec3<T>) -> Vec3<T::Judge> {
    v.to_array().map(exact).into()
}

fn exact_matrix<T: Judged>(m: Mat3<T>) -> Mat3<T::Judge> {
    Mat3 { columns: m.columns.map(exact_vector) }
}

/// Greatest element of the difference.
fn distance<T: Real>(a: Mat3<T>, b: Mat3<T>) -> f64 {
    (a - b).rows().into_iter().fold(0.0, |most, element| f64::max(most, element.abs().to_f64()))
}

/// Greatest element of `MᵗM − 1`.
fn skewness<T: Judged>(m: Mat3<T>) -> f64 {
    let m = exact_matrix(m);
    distance(m.transpose() * m, Mat3::IDENTITY)
}

/// Angle of the rotation between two orientations, where it is small.
fn angle<T: Real>(a: Mat3<T>, b: Mat3<T>) -> f64 {
    let squares = (a - b).columns.map(Vec3::length_squared);
    ((squares[0] + squares[1] + squares[2]) * T::ratio(1, 2)).sqrt().to_f64()
}

/// What the orientation should be, in the judge's precision.
fn judged<T: Judged>(m: Mat3<T>, spin: Vec3<T>, time: T::Judge) -> Mat3<T::Judge> {
    reference_rotation(exact_vector(spin), time) * exact_matrix(m)
}

/// Random spins, with special directions among them.
fn spins<T: Real>(random: &mut Random, count: usize) -> Vec<Vec3<T>> {
    let (zero, one) = (T::ZERO, T::ONE);
    let tiny = T::EPSILON * T::EPSILON;
    let mut spins = vec![
        Vec3::new(zero, one, zero),
        Vec3::new(zero, -one, zero),
        Vec3::new(tiny, one, zero),
        Vec3::new(zero, -one, tiny),
        Vec3::new(T::EPSILON, one, -T::EPSILON),
        Vec3::new(one, zero, zero),
        Vec3::new(zero, zero, -one),
        Vec3::new(tiny, tiny, tiny),
        Vec3::new(zero, zero, zero),
    ];
    spins.extend((spins.len()..count).map(|_| random.vector()));
    spins
}

/// The reference and the fast path against the judge, for angles of
/// `10^least` to `10^most`; gives the greatest errors in ε.
fn errors<T: Judged>(least: i32, most: i32) -> [f64; 2] {
    let mut random = Random(10);
    let mut errors = [0.0, 0.0];
    for spin in spins::<T>(&mut random, 20_000) {
        let m: Mat3<T> = orthonormalised(random.orientation());
        let time = random.magnitude(least, most);
        let expected = judged(m, spin, exact(time));
        let reference = reference_rotation(spin, time) * m;
        let fast = turned(m, spin, time);
        for (error, found) in errors.iter_mut().zip([reference, fast]) {
            *error = f64::max(*error, distance(exact_matrix(found), expected));
        }
    }
    errors.map(|error| error / T::EPSILON.to_f64())
}

fn agrees_with_the_judge<T: Judged>() {
    let [reference, fast] = errors::<T>(-8, 0);
    println!("{}, up to a radian: reference {reference:.2} ε, fast {fast:.2} ε", T::NAME);
    assert!(reference < 5.0 && fast < 2.0);
    let [reference, fast] = errors::<T>(0, 4);
    println!("{}, up to 1e4 rad: reference {reference:.2} ε, fast {fast:.2} ε", T::NAME);
    assert!(reference < 2e4 && fast < 5.0);
    let [reference, fast] = errors::<T>(4, 7);
    println!("{}, up to 1e7 rad: reference {reference:.2} ε, fast {fast:.2} ε", T::NAME);
    assert!(fast < 6.0);
}

#[test]
fn agrees_with_the_reference_f32() {
    agrees_with_the_judge::<f32>();
}

#[test]
fn agrees_with_the_reference_f64() {
    agrees_with_the_judge::<f64>();
}

#[test]
fn no_spin_is_no_rotation() {
    let mut random = Random(11);
    let m: Mat3<f64> = orthonormalised(random.orientation());
    assert_eq!(reference_rotation(Vec3::ZERO, 3.0), Mat3::<f64>::IDENTITY);
    assert_eq!(turned(Mat3::IDENTITY, Vec3::ZERO, 3.0), Mat3::<f64>::IDENTITY);
    assert!(distance(turned(m, Vec3::ZERO, 3.0), m) < 4e-16);
    assert_eq!(turned(Mat3::IDENTITY, random.vector(), 0.0), Mat3::<f64>::IDENTITY);
}

#[test]
fn there_and_back_again() {
    let mut random = Random(12);
    for _ in 0..1000 {
        let (m, spin, time) = (random.orientation(), random.vector(), random.magnitude(-3, 3));
        let back: Mat3<f64> = turned(turned(m, spin, time), spin, -time);
        assert!(distance(back, m) < 3e-15);
    }
}

#[test]
fn newton_squares_an_error() {
    let mut random = Random(13);
    let m: Mat3<f64> = random.orientation();
    let skew = Mat3 { columns: m.columns.map(|axis| axis * 1.001) };
    assert!(skewness(orthonormalised(skew)) < 4e-6);
    assert!(skewness(orthonormalised(orthonormalised(skew))) < 1e-11);
}

/// A million steps of 0.01 rad: orthonormality and angle at the end, the worst
/// of a pack of random spins.
fn million_steps<L: Lane>() -> [f64; 2]
where
    L::Scalar: Judged,
{
    const STEPS: i32 = 1_000_000;
    let mut random = Random(14);
    let dt = <L::Scalar as Lane>::ratio(1, 100);
    let start: Vec<_> = (0..L::WIDTH)
        .map(|_| {
            let spin: Vec3<L::Scalar> = random.vector();
            let m: Mat3<L::Scalar> = orthonormalised(random.orientation());
            (m, spin * (L::Scalar::ONE / spin.length()))
        })
        .collect();
    let spin = Vec3::from(core::array::from_fn(|k| L::from_fn(|i| start[i].1.to_array()[k])));
    let mut m = Mat3::from_rows(core::array::from_fn(|k| L::from_fn(|i| start[i].0.rows()[k])));
    for _ in 0..STEPS {
        m = turned(m, spin, L::splat(dt));
    }
    let mut worst = [0.0, 0.0];
    for (i, &(m0, spin)) in start.iter().enumerate() {
        let found = Mat3::from_rows(m.rows().map(|element| element.to_array().as_ref()[i]));
        let expected = judged(m0, spin, exact(dt) * Real::whole(STEPS));
        worst[0] = f64::max(worst[0], skewness(found));
        worst[1] = f64::max(worst[1], angle(exact_matrix(found), expected));
    }
    println!(
        "{}, a million steps of 0.01 rad: |MᵗM − 1| {:.2e}, angle off by {:.2e} rad",
        L::Scalar::NAME,
        worst[0],
        worst[1]
    );
    worst
}

/// The greatest `MᵗM − 1` in ten thousand steps of angles up to `10^most`.
fn skewness_of_great_steps<T: Judged>(most: i32) -> f64 {
    let mut random = Random(15);
    let mut m: Mat3<T> = orthonormalised(random.orientation());
    (0..10_000).fold(0.0, |worst, _| {
        m = turned(m, random.vector(), random.magnitude(-1, most));
        f64::max(worst, skewness(m))
    })
}

#[test]
fn great_steps_keep_it_orthonormal() {
    for most in [1, 2, 6] {
        let (single, double) =
            (skewness_of_great_steps::<f32>(most), skewness_of_great_steps::<f64>(most));
        println!("steps of up to 10^{most} rad: |MᵗM − 1| {single:.2e} (f32), {double:.2e} (f64)");
        assert!(single < 1e-6 && double < 2e-15);
    }
}

#[test]
fn a_million_steps_f32() {
    let [skewness, angle] = million_steps::<wide::f32x16>();
    assert!(skewness < 3e-7 && angle < 1e-4);
}

#[test]
fn a_million_steps_f64() {
    let [skewness, angle] = million_steps::<wide::f64x8>();
    assert!(skewness < 1e-15 && angle < 2e-13);
}
