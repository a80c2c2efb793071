//! Periodic box: space that closes upon itself.

use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// A box whose opposite faces are the same place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicBox<T> {
    /// The corner with the least coordinates, length.
    pub lower: Vec3<T>,
    /// The corner with the greatest coordinates, length.
    pub upper: Vec3<T>,
}

impl<T: Real> PeriodicBox<T> {
    /// The box between two corners.
    #[must_use]
    pub fn new(lower: [T; 3], upper: [T; 3]) -> Self {
        Self { lower: lower.into(), upper: upper.into() }
    }

    /// The lengths of its sides.
    #[must_use]
    pub fn sides(&self) -> Vec3<T> {
        self.upper - self.lower
    }

    /// The image of a point inside the box, for a point that left it by less
    /// than one side.
    #[inline(always)]
    pub fn wrap<L: Lane<Scalar = T>>(&self, point: Vec3<L>) -> Vec3<L> {
        let wrap = |c: L, low: T, high: T, side: T| {
            let side = L::splat(side);
            let is_below = c.lt(L::splat(low));
            let is_above = c.ge(L::splat(high));
            L::select(is_below, c + side, L::select(is_above, c - side, c))
        };
        let sides = self.sides();
        Vec3::new(
            wrap(point.x, self.lower.x, self.upper.x, sides.x),
            wrap(point.y, self.lower.y, self.upper.y, sides.y),
            wrap(point.z, self.lower.z, self.upper.z, sides.z),
        )
    }

    /// The shortest image of a difference of two points inside the box.
    #[inline(always)]
    pub fn nearest_image<L: Lane<Scalar = T>>(&self, difference: Vec3<L>) -> Vec3<L> {
        let nearest = |d: L, side: T| {
            let half = L::splat(side * T::ratio(1, 2));
            let side = L::splat(side);
            L::select(d.gt(half), d - side, L::select(d.lt(-half), d + side, d))
        };
        let sides = self.sides();
        Vec3::new(
            nearest(difference.x, sides.x),
            nearest(difference.y, sides.y),
            nearest(difference.z, sides.z),
        )
    }
}
