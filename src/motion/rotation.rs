//! Rotation: how an orientation follows a constant angular velocity.

use crate::compensated::{two_product, two_sum};
use crate::lane::{Lane, Mask};
use crate::mat3::Mat3;
use crate::real::Real;
use crate::trigonometry::{cosine_deficit, sin_cos, sin_cos_of_sum, sine_ratio_deficit};
use crate::vec3::Vec3;

/// The rotation by `|w|t` about `w`, as `W Rz(|w|t) Wᵗ` with
/// `W = [wx, wy, wz]`, `wz = w/|w|`, `wx = unit((0,1,0) × wz)`,
/// `wy = wz × wx`.
///
/// The formula as printed, as a reference for [`turned`]: a sine and a cosine,
/// two roots and two divisions for each body. Where it is undefined: a spin
/// nearly parallel to `y` takes `(1,0,0)` for the helper axis, and no spin is no
/// rotation.
///
/// `spin` in rad per time, for `|w|²` neither under- nor overflowing; error of
/// the elements a few ε and `ε|w|t`.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::rotation::reference_rotation;
/// let half_turn = reference_rotation(Vec3::new(0.0, 0.0, core::f64::consts::PI), 1.0);
/// let x_axis = half_turn * Vec3::new(1.0, 0.0, 0.0);
/// assert!((x_axis - Vec3::new(-1.0, 0.0, 0.0)).length() < 1e-15);
/// ```
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

/// The orientation a time `t` later: `R M` with `R` the rotation by `|w|t`
/// about `w`, for an orthonormal `M`, which it keeps so.
///
/// `spin` in rad per time; `time` of any size and sign, a step or the age of
/// the last collision. The error of an element is a few ε at any angle up to
/// `ε⁻¹` rad, and not `ε|w|t`: an orientation can be left alone for a
/// thousand turns. Up to a quarter turn there is no root and no division, only
/// even polynomials of `|wt/2|²`; greater angles are worked out to twice the
/// digits.
///
/// `R M` alone leaves the orthonormal matrices: `‖MᵗM − 1‖` is 2e-2 (`f32`) or
/// 4e-11 (`f64`) after 10⁶ steps of 0.01 rad. So there is one Newton step
/// `M(3 − MᵗM)/2` in it, and the whole is one sum
/// `M + (N + [wt]×(M + N) + …)` with `N = M(1 − MᵗM)/2`, rounded once. After the
/// 10⁶ steps `‖MᵗM − 1‖` is 1e-7 or 2e-16 and the angle is off by 4e-5 or
/// 6e-14 rad. What was tried before, at the same cost: the Newton step after
/// the rotation, a second rounding, 2e-4 or 5e-13 rad; `wt` rounded and added
/// to the small terms, the same error in each step, 6e-4 or 2e-12 rad.
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
    let (x, x_tail) = two_product(spin.x, time);
    let (y, y_tail) = two_product(spin.y, time);
    let (z, z_tail) = two_product(spin.z, time);
    let (angle, angle_tail) = (Vec3::new(x, y, z), Vec3::new(x_tail, y_tail, z_tail));

    // What (sin h)/h and cos h lack to 1, and their product.
    let square = angle.length_squared() * L::ratio(1, 4);
    let (ratio, cosine) = (sine_ratio_deficit(square), cosine_deficit(square));
    let product = (ratio + cosine) - ratio * cosine;
    let rest = change(angle, angle_tail - angle * product, L::ONE - ratio);
    let after = changed(orientation, angle, rest);

    let [quarter_turn, ..] = L::Scalar::QUARTER_TURN;
    let is_small = square.le(L::splat(quarter_turn * quarter_turn * L::Scalar::ratio(1, 4)));
    if is_small.all() {
        after
    } else {
        Mat3::select(is_small, after, turned_far(orientation, spin, time))
    }
}

/// [`turned`] for angles beyond a quarter turn. The change has errors of some ε
/// itself here, so there is a second Newton step.
#[cold]
fn turned_far<L: Lane>(orientation: Mat3<L>, spin: Vec3<L>, time: L) -> Mat3<L> {
    let (cosine, ratio) = far_cosine_and_ratio(spin, time);
    let angle = spin * time;
    let all = change(angle, angle * (cosine * ratio), ratio);
    orthonormalised(changed(orientation, Vec3::ZERO, all))
}

/// `R − 1` of the rotation by the angle vector `a = |a| n`, which is
/// `[sin|a| n]× + (1 − cos|a|) [n]×²` (Rodrigues 1840), from `sines = sin|a| n`
/// and `ratio = (sin h)/h`, `h = |a|/2`: `(1 − cos|a|)/|a|² = ½ ratio²`.
#[inline(always)]
fn change<L: Lane>(angle: Vec3<L>, sines: Vec3<L>, ratio: L) -> Mat3<L> {
    let scaled = angle * (ratio * ratio * L::ratio(1, 2));
    let (xx, yy, zz) = (scaled.x * angle.x, scaled.y * angle.y, scaled.z * angle.z);
    let (xy, xz, yz) = (scaled.x * angle.y, scaled.x * angle.z, scaled.y * angle.z);
    Mat3::from_columns(
        Vec3::new(-(yy + zz), xy + sines.z, xz - sines.y),
        Vec3::new(xy - sines.z, -(xx + zz), yz + sines.x),
        Vec3::new(xz + sines.y, yz - sines.x, -(xx + yy)),
    )
}

/// `(1 + [lead]× + rest) (M + N)`, with the Newton correction `N` of `M`, as one
/// sum whose small terms are added first.
#[inline(always)]
fn changed<L: Lane>(m: Mat3<L>, lead: Vec3<L>, rest: Mat3<L>) -> Mat3<L> {
    let after = |axis: Vec3<L>, correction: Vec3<L>| {
        let mended = axis + correction;
        axis + (correction + (lead.cross(mended) + rest * mended))
    };
    let [a, b, c] = m.columns;
    let [a_newton, b_newton, c_newton] = newton_correction(m).columns;
    Mat3::from_columns(after(a, a_newton), after(b, b_newton), after(c, c_newton))
}

/// One Newton step towards the nearest orthonormal matrix, `M(3 − MᵗM)/2`. An
/// error `δ` becomes `¾δ²`, down to rounding.
///
/// ```
/// use carom::mat3::Mat3;
/// use carom::motion::rotation::orthonormalised;
/// use carom::vec3::Vec3;
/// let long = Mat3 { columns: Mat3::IDENTITY.columns.map(|axis: Vec3<f64>| axis * 1.001) };
/// assert!((orthonormalised(long).columns[0].x - 1.0).abs() < 2e-6);
/// ```
#[inline(always)]
pub fn orthonormalised<L: Lane>(m: Mat3<L>) -> Mat3<L> {
    let ([a, b, c], [da, db, dc]) = (m.columns, newton_correction(m).columns);
    Mat3::from_columns(a + da, b + db, c + dc)
}

/// `M(1 − MᵗM)/2`.
#[inline(always)]
fn newton_correction<L: Lane>(m: Mat3<L>) -> Mat3<L> {
    let [a, b, c] = m.columns;
    let half = L::ratio(1, 2);
    let short = |axis: Vec3<L>| (L::ONE - axis.length_squared()) * half;
    let skew = |one: Vec3<L>, other: Vec3<L>| -(one.dot(other) * half);
    let (ab, ac, bc) = (skew(a, b), skew(a, c), skew(b, c));
    Mat3::from_columns(
        a * short(a) + b * ab + c * ac,
        a * ab + b * short(b) + c * bc,
        a * ac + b * bc + c * short(c),
    )
}

/// `cos h` and `(sin h)/h` of a great `h = |w|t/2`, with `h` to twice the
/// digits.
#[inline(always)]
fn far_cosine_and_ratio<L: Lane>(spin: Vec3<L>, time: L) -> (L, L) {
    let half_time = time * L::ratio(1, 2);
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
