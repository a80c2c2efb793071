//! Boxes for tests of what is near what.

use super::Bounds;
use crate::real::Real;
use crate::vec3::Vec3;

/// A cube by its centre and half of its side, length.
pub(super) fn cube<T: Real>(center: [f64; 3], half: f64) -> Bounds<T> {
    let corner = |sign: f64| Vec3::from(center.map(|c| T::from_f64(c + sign * half)));
    [corner(-1.0), corner(1.0)]
}

/// Whether two boxes have a point in common.
pub(super) fn touch<T: Real>(a: &Bounds<T>, b: &Bounds<T>) -> bool {
    let [a, b] = [a.map(Vec3::to_array), b.map(Vec3::to_array)];
    (0..3).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}
