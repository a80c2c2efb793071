//! Plane: a half space of solid.

use super::entry::{Key, Meaning, ShapeEntry};
use super::gate::Gate;
use super::mistake::{Mistake, direction, point};
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::solid::{Obstacle, Solid};
use super::{Clearance, Feature};
use crate::contact::{FreeFlight, Start, fall_of_height, greatest_component};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// The solid half space behind a plane.
///
/// In a scene file: `shape = "plane"` with a `point` and a `normal` of any
/// length, out of the solid.
///
/// ```
/// use carom::surroundings::{Feature, Plane};
/// use carom::vec3::Vec3;
///
/// let slope = Plane::new([0.0; 3], [0.0, 3.0, 4.0]);
/// assert_eq!(Feature::from(slope).clearance(Vec3::new(9.0, 0.0, 5.0), 1.0).gap, 3.0);
/// ```
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
}

impl<T: Real> Obstacle<T> for Plane<T> {
    #[inline(always)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let normal = Vec3::splat(self.normal);
        let height = (center - Vec3::splat(self.point)).dot(normal);
        Clearance { gap: height - radius, arm: normal * radius }
    }

    /// The fall of its height, a quadratic in time.
    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        let height = self.clearance(flight.center, flight.radius).gap;
        let start = Start::at(height, flight.slack(self.point), flight.is_leaving);
        let pull =
            flight.acceleration.map_or(T::ZERO, |acceleration| acceleration.dot(self.normal));
        fall_of_height(height, flight.velocity.dot(self.normal), pull, start)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        None
    }

    fn farthest(&self) -> f64 {
        greatest_component(self.point.cast())
    }
}

const POINT: Key = Key::new("point", Meaning::Point);
const NORMAL: Key = Key::new("normal", Meaning::Direction);

impl<T: Real> Solid<T> for Plane<T> {
    type In<B: Real> = Plane<B>;

    const NAME: &'static str = "plane";
    const KEYS: &'static [Key] = &[POINT, NORMAL];

    fn read(entry: &ShapeEntry) -> Result<Plane<f64>, Mistake> {
        Ok(Plane::new(entry.vector(POINT)?, entry.vector(NORMAL)?))
    }

    fn check(&self) -> Result<(), Mistake> {
        point(POINT.name, self.point)?;
        direction(NORMAL.name, self.normal)
    }

    fn cast<B: Real>(&self) -> Plane<B> {
        Plane { point: self.point.cast(), normal: self.normal.cast() }
    }

    fn features(&self) -> Vec<Feature<T>> {
        vec![(*self).into()]
    }

    fn gate(&self) -> Option<Gate<T>> {
        Some(Gate::flat(*self, None))
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        detail.plane(self.point, self.normal)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        vec![self.point]
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self { point: at.point(self.point), normal: at.unit(self.normal) }
    }
}
