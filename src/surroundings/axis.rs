//! Axis: a line with a point on it, and where places are about it.

use super::placement::Placement;
use crate::lane::{Lane, Mask};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// The axis of something round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis<T> {
    /// The point that heights are counted from, length.
    pub(super) center: Vec3<T>,
    /// Unit vector.
    pub(super) direction: Vec3<T>,
}

/// A place about an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<L> {
    /// Along the axis, length.
    pub(super) height: L,
    /// From the axis, length.
    pub(super) distance: L,
    /// Unit vector from the axis; on the axis, one of those across it.
    pub(super) outward: Vec3<L>,
}

impl<T: Real> Axis<T> {
    /// Through a point, length, along a vector of any length but 0.
    pub(super) fn new(center: [T; 3], direction: [T; 3]) -> Self {
        let direction = Vec3::from(direction);
        let length = direction.length();
        let Vec3 { x, y, z } = direction;
        Self { center: center.into(), direction: Vec3::new(x / length, y / length, z / length) }
    }

    /// The same line, scaled, turned and moved.
    pub(super) fn placed(&self, at: &Placement<T>) -> Self {
        Self { center: at.point(self.center), direction: at.unit(self.direction) }
    }

    /// The same line with another point of it.
    pub(super) fn moved(&self, height: T) -> Self {
        Self { center: self.point(height), ..*self }
    }

    /// Where places are.
    #[inline(always)]
    pub(super) fn place<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> Place<L> {
        let direction = Vec3::<L>::splat(self.direction);
        let offset = place - Vec3::splat(self.center);
        let height = offset.dot(direction);
        let across = offset - direction * height;
        let distance = across.length();
        let outward = across * (L::ONE / distance);
        let is_off = distance.gt(L::ZERO);
        if is_off.all() {
            return Place { height, distance, outward };
        }
        let outward = Vec3::select(is_off, outward, Vec3::splat(self.side()));
        Place { height, distance, outward }
    }

    /// A vector's part across the axis.
    pub(super) fn across(&self, vector: Vec3<T>) -> Vec3<T> {
        vector - self.direction * vector.dot(self.direction)
    }

    /// A point of the axis.
    pub(super) fn point(&self, height: T) -> Vec3<T> {
        self.center + self.direction * height
    }

    /// A unit vector across the axis.
    pub(super) fn side(&self) -> Vec3<T> {
        let is_steep = self.direction.x.abs() < T::ratio(3, 5);
        let other = if is_steep {
            Vec3::new(T::ONE, T::ZERO, T::ZERO)
        } else {
            Vec3::new(T::ZERO, T::ONE, T::ZERO)
        };
        let side = self.direction.cross(other);
        side * (T::ONE / side.length())
    }

    /// The corners of the box around a circle about the axis, length.
    pub(super) fn around(&self, height: T, radius: T) -> [Vec3<T>; 2] {
        let reach =
            |component: T| radius * (T::ONE - component * component).greater(T::ZERO).sqrt();
        let Vec3 { x, y, z } = self.direction;
        let reach = Vec3::new(reach(x), reach(y), reach(z));
        let center = self.point(height);
        [center - reach, center + reach]
    }

    /// Every number becomes the nearest of another precision.
    pub(super) fn cast<B: Real>(&self) -> Axis<B> {
        Axis { center: self.center.cast(), direction: self.direction.cast() }
    }
}

/// Half the length of a circle over its radius.
pub(super) fn pi<T: Real>() -> T {
    let [first, second, third] = T::QUARTER_TURN;
    (first + (second + third)) * T::whole(2)
}

/// The corners of a box that fits into a cylinder of a radius and half a height about the
/// middle of an axis: the box around the cylinder, made smaller.
pub(super) fn inscribed<T: Real>(axis: &Axis<T>, radius: T, half: T) -> [Vec3<T>; 2] {
    let [low, high] = [-half, half].each(|height| axis.around(height, radius));
    let [lower, upper] = joined(low, high);
    let reach = (upper - lower) * T::ratio(1, 2);
    let share = |x: T, y: T, z: T| {
        let corner = Vec3::new(reach.x * x, reach.y * y, reach.z * z);
        let along = corner.dot(axis.direction).abs();
        let across = axis.across(corner).length();
        // 0/0, of nothing across, asks for nothing.
        (half / along).lesser(T::ONE).lesser((radius / across).lesser(T::ONE))
    };
    let (one, minus) = (T::ONE, -T::ONE);
    let corners = [[one, one, one], [minus, one, one], [one, minus, one], [one, one, minus]];
    let least = corners.each(|[x, y, z]| share(x, y, z)).into_iter().fold(T::ONE, T::lesser);
    // Short of the surface, so that rounding leaves the corners inside.
    let reach = reach * (least * (T::ONE - T::whole(8) * T::EPSILON));
    [axis.center - reach, axis.center + reach]
}
