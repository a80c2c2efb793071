//! Plane: a half space of solid.

use super::Clearance;
use super::free_flight::FreeFlight;
use crate::contact::{Start, fall_of_height};
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

    /// When a sphere collides with the plane: the fall of its height, a
    /// quadratic in time.
    pub(super) fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        let height = self.clearance(flight.center, flight.radius).gap;
        let start = Start::at(height, flight.slack(self.point), flight.is_leaving);
        let pull =
            flight.acceleration.map_or(T::ZERO, |acceleration| acceleration.dot(self.normal));
        fall_of_height(height, flight.velocity.dot(self.normal), pull, start)
    }
}
