//! Plane: a half space of solid.

use super::Clearance;
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// The solid half space behind a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane<T> {
    /// A point of the plane, length.
    pub point: Vec3<T>,
    /// Unit normal, out of the solid.
    pub normal: Vec3<T>,
}

impl<T: Real> Plane<T> {
    /// The plane through `point` with the solid on the side that `normal`
    /// points away from. `normal` may have any length but zero.
    ///
    /// ```
    /// use carom::surroundings::Plane;
    /// let floor = Plane::new([0.0; 3], [0.0, 0.0, 2.0]);
    /// assert_eq!(floor.normal.to_array(), [0.0, 0.0, 1.0]);
    /// ```
    #[must_use]
    pub fn new(point: [T; 3], normal: [T; 3]) -> Self {
        let normal = Vec3::from(normal);
        let length = normal.length();
        Self {
            point: point.into(),
            normal: Vec3::new(normal.x / length, normal.y / length, normal.z / length),
        }
    }

    /// Where spheres with these centres and radii stand to the plane.
    #[inline(always)]
    pub fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let normal = Vec3::splat(self.normal);
        let height = (center - Vec3::splat(self.point)).dot(normal);
        Clearance { gap: height - radius, arm: normal * radius }
    }
}
