//! Rotation: how an orientation follows a constant angular velocity.

use crate::compensated::{two_product, two_sum};
use crate::lane::{Lane, Mask};
use crate::mat3::Mat3;
use crate::real::Real;
use crate::trigonometry::{cosine, sin_cos, sin_cos_of_sum, sine_ratio};
use crate::vec3::Vec3;

/// The rotation by `|w|t` about `w`, as `W Rz(|w|t) Wᵗ` with
/// `W = [wx, wy, wz]`, `wz = w/|w|`, `wx = unit((0,1,0) × wz)`,
/// `wy = wz × wx`.
///
/// The formula as printed, as a reference for [`turned`]: a sine and a cosine,
/// two roots and two divisions for each body. Where it is undefined it is
/// mended: a spin all but parallel to `y` takes `(1,0,0)` for the helper axis,
/// and no spin is no rotation.
///
/// `spin` in rad per time, for `|w|²` neither under- nor overflowing; error of
/// the elements a few ε and `ε|w|t`.
#[inline(always)]
pub fn reference_rotation<L: Lane>(spin: Vec3<L>, time: L) -> Mat3<L> {
    let unit_z = Vec3::new(L::ZERO, L::ZERO, L::ONE);
    let speed = spin.length();
    let is_still = speed.same(L::ZERO);
    let wz = Vec3::select(is_still, unit_z, spin * (L::ONE / L::select(is_still, L::ONE, speed)));

    // (0,1,0) × wz and (1,0,0) × wz.
    let from_y = Vec3::new(wz.z, L::ZERO, -wz.x);
    let from_x = Vec3::new(L::ZERO, -wz.z, wz.y);
    let is_parallel = from_y.length_squared().lt(L::splat(L::Scalar::EPSILON));
    let helper = Vec3::select(is_parallel, from_x, from_y);
    let wx = helper * (L::ONE / helper.length());
    let wy = wz.cross(wx);

    let (sine, cosine) = sin_cos(speed * time);
    let about_z = Mat3::from_columns(
        Vec3::new(cosine, sine, L::ZERO),
        Vec3::new(-sine, cosine, L::ZERO),
        unit_z,
    );
    let axes = Mat3::from_columns(wx, wy, wz);
    axes * about_z * axes.transpose()
}

/// The orientation a time `t` later, `R M` with `R` the rotation by `|w|t`
/// about `w`, orthonormal again.
///
/// `spin` in rad per time; `time` of any size and sign, a step or the age of
/// the last collision. Up to a quarter turn there is no root and no division,
/// only even polynomials of `|wt/2|²`.
/// Beyond it the angle is worked out to twice the digits, so that the error is
/// a few ε at any angle up to `ε⁻¹` rad, and not `ε|w|t`: an orientation may
/// well be left alone for ten thousand turns.
///
/// `R M` alone leaves the orthonormal matrices: `‖MᵗM − 1‖` is 2e-2 (`f32`) or
/// 4e-11 (`f64`) after 10⁶ steps of 0.01 rad. One Newton step
/// `M(3 − MᵗM)/2` holds it at 2e-7 or 4e-16; Gram–Schmidt, or a renormalised
/// quaternion, would have ten times the error of the angle.
///
/// ```
/// use carom::mat3::Mat3;
/// use carom::motion::rotation::turned;
/// use carom::vec3::Vec3;
/// let quarter = core::f64::consts::FRAC_PI_2;
/// let m = turned(Mat3::IDENTITY, Vec3::new(0.0, 0.0, quarter), 1.0);
/// let x_axis = m.columns[0];
/// assert!((x_axis - Vec3::new(0.0, 1.0, 0.0)).length() < 1e-15);
/// ```
#[inline(always)]
pub fn turned<L: Lane>(orientation: Mat3<L>, spin: Vec3<L>, time: L) -> Mat3<L> {
    let (w, axis) = half_angle_quaternion(spin, time);

    // R − 1, so that small rotations are added with all their digits.
    let twice = axis + axis;
    let (xx, yy, zz) = (axis.x * twice.x, axis.y * twice.y, axis.z * twice.z);
    let (xy, xz, yz) = (axis.x * twice.y, axis.x * twice.z, axis.y * twice.z);
    let (wx, wy, wz) = (w * twice.x, w * twice.y, w * twice.z);
    let change = Mat3::from_columns(
        Vec3::new(-(yy + zz), xy + wz, xz - wy),
        Vec3::new(xy - wz, -(xx + zz), yz + wx),
        Vec3::new(xz + wy, yz - wx, -(xx + yy)),
    );
    orthonormalised(Mat3 { columns: orientation.columns.map(|axis| axis + change * axis) })
}

/// One Newton step towards the nearest orthonormal matrix:
/// `M(3 − MᵗM)/2 = M + M(1 − MᵗM)/2`. An error `δ` becomes `¾δ²`, down to
/// rounding.
#[inline(always)]
pub fn orthonormalised<L: Lane>(m: Mat3<L>) -> Mat3<L> {
    let [a, b, c] = m.columns;
    let half = L::ratio(1, 2);
    let short = |axis: Vec3<L>| (L::ONE - axis.length_squared()) * half;
    let skew = |one: Vec3<L>, other: Vec3<L>| -(one.dot(other) * half);
    let (ab, ac, bc) = (skew(a, b), skew(a, c), skew(b, c));
    Mat3::from_columns(
        a + (a * short(a) + b * ab + c * ac),
        b + (a * ab + b * short(b) + c * bc),
        c + (a * ac + b * bc + c * short(c)),
    )
}

/// The unit quaternion `(cos|h|, sin|h| h/|h|)` of the rotation by `2|h|` about
/// `h = wt/2`.
#[inline(always)]
fn half_angle_quaternion<L: Lane>(spin: Vec3<L>, time: L) -> (L, Vec3<L>) {
    let half_time = time * L::ratio(1, 2);
    let half_angle = spin * half_time;
    let square = half_angle.length_squared();
    let (cosine, ratio) = (cosine(square), sine_ratio(square));

    let [quarter_turn, ..] = L::Scalar::QUARTER_TURN;
    let is_near = square.le(L::splat(quarter_turn * quarter_turn * L::Scalar::ratio(1, 4)));
    if is_near.all() {
        (cosine, half_angle * ratio)
    } else {
        let (far_cosine, far_ratio) = far_cosine_and_ratio(spin, half_time);
        let ratio = L::select(is_near, ratio, far_ratio);
        (L::select(is_near, cosine, far_cosine), half_angle * ratio)
    }
}

/// `cos|h|` and `sin|h|/|h|` of a great `h = w·t/2`, with `|h|` to twice the
/// digits.
#[cold]
fn far_cosine_and_ratio<L: Lane>(spin: Vec3<L>, half_time: L) -> (L, L) {
    let (mut square, mut square_tail) = (L::ZERO, L::ZERO);
    for component in spin.to_array() {
        let (h, h_tail) = two_product(component, half_time);
        let (product, error) = two_product(h, h);
        let (sum, lost) = two_sum(square, product);
        square = sum;
        square_tail = square_tail + ((lost + error) + (h + h) * h_tail);
    }
    let length = square.sqrt();
    let (product, error) = two_product(length, length);
    let tail = ((square - product) - error + square_tail) / (length + length);
    let (sine, cosine) = sin_cos_of_sum(length, tail);
    (cosine, sine / length)
}
