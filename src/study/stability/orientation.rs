//! Orientations kept orthonormal in other ways than carom's, to compare with.

use faer::Mat;

use crate::mat3::Mat3;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::trigonometry::sin_cos;
use crate::vec3::Vec3;

/// `U Vᵗ` of the singular value decomposition `U S Vᵗ`: the orthonormal matrix
/// nearest to this one (Fan and Hoffman 1955).
/// No numbers if there is none.
pub(super) fn nearest_orthonormal<T: Real>(m: Mat3<T>) -> Mat3<T> {
    let rows = m.rows().each(T::to_f64);
    let full = Mat::from_fn(3, 3, |row, column| rows[3 * row + column]);
    let polar = full.svd().map(|parts| parts.U() * parts.V().transpose());
    let element = |k: usize| polar.as_ref().map_or(f64::NAN, |polar| polar[(k / 3, k % 3)]);
    Mat3::from_rows(array::from_fn(|k| T::from_f64(element(k))))
}

/// The quaternion of a rotation, `[cos h, sin h n]`, `h = |w|t/2`.
pub(super) fn quaternion<T: Real>(spin: Vec3<T>, time: T) -> [T; 4] {
    let speed = spin.length();
    let half = speed * time * T::ratio(1, 2);
    let (sine, cosine) = sin_cos(half);
    let n = spin * (sine / speed);
    [cosine, n.x, n.y, n.z]
}

/// The rotation of the second, then of the first.
pub(super) fn product<T: Real>([a, b, c, d]: [T; 4], [e, f, g, h]: [T; 4]) -> [T; 4] {
    [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ]
}

/// Of length 1.
pub(super) fn normalised<T: Real>(q: [T; 4]) -> [T; 4] {
    let [a, b, c, d] = q;
    let length = (a * a + b * b + c * c + d * d).sqrt();
    q.each(|part| part / length)
}

/// The matrix of a unit quaternion.
pub(super) fn to_matrix<T: Real>([a, b, c, d]: [T; 4]) -> Mat3<T> {
    let (one, two) = (T::ONE, T::whole(2));
    Mat3::from_rows([
        one - two * (c * c + d * d),
        two * (b * c - a * d),
        two * (b * d + a * c),
        two * (b * c + a * d),
        one - two * (b * b + d * d),
        two * (c * d - a * b),
        two * (b * d - a * c),
        two * (c * d + a * b),
        one - two * (b * b + c * c),
    ])
}

/// The quaternion of a rotation, to a few ε: from the greatest of its four parts
/// (Shepperd 1978).
pub(super) fn from_matrix<T: Real>(m: Mat3<T>) -> [T; 4] {
    let [x, y, z] = m.columns;
    // Of the parts, times four.
    let squares = [
        T::ONE + x.x + y.y + z.z,
        T::ONE + x.x - y.y - z.z,
        T::ONE - x.x + y.y - z.z,
        T::ONE - x.x - y.y + z.z,
    ];
    let sums = [x.y + y.x, x.z + z.x, y.z + z.y];
    let differences = [y.z - z.y, z.x - x.z, x.y - y.x];
    let greatest = squares.iter().fold(T::ZERO, |most, &square| square.greater(most));
    normalised(match squares.iter().position(|&square| square == greatest) {
        Some(1) => [differences[0], squares[1], sums[0], sums[1]],
        Some(2) => [differences[1], sums[0], squares[2], sums[2]],
        Some(3) => [differences[2], sums[1], sums[2], squares[3]],
        _ => [squares[0], differences[0], differences[1], differences[2]],
    })
}
