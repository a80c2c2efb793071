//! Slant: a straight line of a profile, turned about an axis.

use super::axis::{Axis, Place, pi};
use super::entry::{AXIS, BASE, HEIGHT, RADIUS, TOP_RADIUS};
use super::mistake::{Mistake, direction, not_negative, point, positive};
use crate::lane::{Lane, Mask};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// A line from one place of a half plane to another, each by its distance from the axis
/// and its height: what is turned about the axis to a disc, a cylinder or a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slant<T> {
    /// Distance and height of its first end, length.
    pub(super) start: [T; 2],
    /// Distance and height of its second end, length.
    pub(super) end: [T; 2],
    /// The unit vector from the first end to the second one.
    pub(super) along: [T; 2],
    /// Length.
    pub(super) length: T,
}

/// Where a place of the half plane is to a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside<L: Lane> {
    /// Length, from the line's nearest point.
    pub(super) distance: L,
    /// From there, distance from the axis and height of the unit vector.
    pub(super) normal: [L; 2],
    /// Whether that is on the line's right-hand side, as seen from its first end with the
    /// axis on the left.
    pub(super) is_right: L::Mask,
}

impl<L: Lane> Beside<L> {
    /// The same of the nearer of two lines; of the other one where both are as near.
    #[inline(always)]
    pub(super) fn or_nearer(self, other: Self) -> Self {
        let is_nearer = self.distance.lt(other.distance);
        let pick = |k: usize| L::select(is_nearer, self.normal[k], other.normal[k]);
        Self {
            distance: L::select(is_nearer, self.distance, other.distance),
            normal: [pick(0), pick(1)],
            is_right: (is_nearer & self.is_right) | (!is_nearer & other.is_right),
        }
    }

    /// Of a place about the axis: the distance, negative inside of something solid, and the
    /// unit normal out of it.
    #[inline(always)]
    pub(super) fn about(
        &self,
        axis: &Axis<L::Scalar>,
        place: &Place<L>,
        is_inside: L::Mask,
    ) -> (L, Vec3<L>) {
        let [out, up] = self.normal;
        let normal = place.outward * out + Vec3::splat(axis.direction) * up;
        (
            L::select(is_inside, -self.distance, self.distance),
            Vec3::select(is_inside, -normal, normal),
        )
    }
}

impl<T: Real> Slant<T> {
    /// From one end to the other; a line of no length leads out.
    pub(super) fn new(start: [T; 2], end: [T; 2]) -> Self {
        let [out, up] = [end[0] - start[0], end[1] - start[1]];
        let length = (out * out + up * up).sqrt();
        let along = if length > T::ZERO { [out / length, up / length] } else { [T::ONE, T::ZERO] };
        Self { start, end, along, length }
    }

    /// From the axis on without end, so far out for so far up.
    pub(super) fn endless(slope: T) -> Self {
        let infinite = T::from_f64(f64::INFINITY);
        let Self { along, .. } = Self::new([T::ZERO; 2], [slope, T::ONE]);
        Self { start: [T::ZERO; 2], end: [infinite; 2], along, length: infinite }
    }

    /// The unit normal to the right: out of the axis, of what goes up.
    pub(super) fn right(&self) -> [T; 2] {
        [self.along[1], -self.along[0]]
    }

    /// The same line, the other way.
    pub(super) fn reversed(&self) -> Self {
        let [out, up] = self.along;
        Self { start: self.end, end: self.start, along: [-out, -up], length: self.length }
    }

    /// How far places are to the right of the line, which goes on without end.
    #[inline(always)]
    pub(super) fn rightward<L: Lane<Scalar = T>>(&self, distance: L, height: L) -> L {
        let ([out, up], [far, high]) = (self.along.each(L::splat), self.start.each(L::splat));
        (distance - far) * up - (height - high) * out
    }

    /// Where places are to the line.
    #[inline(always)]
    pub(super) fn beside<L: Lane<Scalar = T>>(&self, distance: L, height: L) -> Beside<L> {
        let [out, up] = self.along.each(L::splat);
        let from_start = [distance - L::splat(self.start[0]), height - L::splat(self.start[1])];
        let from_end = [distance - L::splat(self.end[0]), height - L::splat(self.end[1])];
        let along = from_start[0] * out + from_start[1] * up;
        let right = self.rightward(distance, height);
        let is_right = right.ge(L::ZERO);

        // Between the ends by the line's own normal, which rounding of the place leaves
        // alone.
        let side = L::select(is_right, L::ONE, -L::ONE);
        let is_before = along.le(L::ZERO);
        let is_beyond = along.ge(L::splat(self.length));
        let is_between = !is_before & !is_beyond;
        let level = Beside { distance: right.abs(), normal: [up * side, -(out * side)], is_right };
        if is_between.all() {
            return level;
        }
        let pick = |k: usize| L::select(is_before, from_start[k], from_end[k]);
        let offset = [pick(0), pick(1)];
        let to_end = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
        let is_off = is_between | !to_end.gt(L::ZERO);
        let normal = |k: usize| L::select(is_off, level.normal[k], offset[k] / to_end);
        Beside {
            distance: L::select(is_between, level.distance, to_end),
            normal: [normal(0), normal(1)],
            is_right,
        }
    }

    /// The area of what it makes, on one side, length².
    pub(super) fn area(&self) -> T {
        pi::<T>() * (self.start[0] + self.end[0]) * self.length
    }

    /// The corners of the box around what it makes, length.
    pub(super) fn bounds(&self, axis: &Axis<T>) -> [Vec3<T>; 2] {
        let [start, end] =
            [self.start, self.end].each(|[distance, height]| axis.around(height, distance));
        joined(start, end)
    }
}

/// A mistake unless these are the axis from the middle of a base, the height and the radii
/// of base and top of what is round and slanted.
pub(super) fn check_slanted<T: Real>(
    axis: &Axis<T>,
    height: T,
    radii: [T; 2],
) -> Result<(), Mistake> {
    point(BASE.name, axis.center)?;
    direction(AXIS.name, axis.direction)?;
    positive::<T>(HEIGHT.name, height.to_f64(), "a height")?;
    let [base, top] = radii.each(T::to_f64);
    if base == 0.0 && top == 0.0 {
        return Err(Mistake::value(RADIUS.name, base, "the base or the top must have a radius"));
    }
    not_negative::<T>(RADIUS.name, base, "a radius")?;
    not_negative::<T>(TOP_RADIUS.name, top, "a radius")
}
