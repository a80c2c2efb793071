//! Cuboid: a solid box with its edges and corners, or the hollow in one.

mod part;

use part::Part;

use super::entry::{INSIDE, Key, Meaning, ShapeEntry};
use super::free_flight::FreeFlight;
use super::mistake::{Mistake, corners};
use super::solid::{Obstacle, Solid};
use super::{Clearance, Feature, Plane};
use crate::contact::greatest_component;
use crate::lane::{Lane, Mask};
use crate::real::Real;
use crate::vec3::Vec3;

/// An axis-aligned box fixed in space.
///
/// In a scene file: `shape = "box"` with `lower`, `upper` and `inside`;
/// `inside = true` makes a container.
///
/// ```
/// use carom::surroundings::{Cuboid, Feature};
/// use carom::vec3::Vec3;
///
/// let cube = Feature::from(Cuboid::solid([0.0; 3], [1.0; 3]));
/// let clearance = cube.clearance(Vec3::new(4.0, 5.0, 0.5), 1.0);
/// assert_eq!((clearance.gap, clearance.arm.y), (4.0, 0.8));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid<T> {
    /// The corner with the least coordinates, length.
    pub lower: Vec3<T>,
    /// The corner with the greatest coordinates, length.
    pub upper: Vec3<T>,
    /// Whether bodies are inside of it: a container.
    pub inside: bool,
}

impl<T: Real> Cuboid<T> {
    /// A solid box that bodies bounce off, from its lower to its upper corner,
    /// length.
    ///
    /// ```
    /// use carom::surroundings::Cuboid;
    /// assert!(!Cuboid::solid([0.0; 3], [1.0, 2.0, 3.0]).inside);
    /// ```
    #[must_use]
    pub fn solid(lower: [T; 3], upper: [T; 3]) -> Self {
        Self { lower: lower.into(), upper: upper.into(), inside: false }
    }

    /// A container that bodies are inside of, from its lower to its upper corner,
    /// length.
    ///
    /// ```
    /// use carom::surroundings::Cuboid;
    /// assert!(Cuboid::container([0.0; 3], [1.0, 2.0, 3.0]).inside);
    /// ```
    #[must_use]
    pub fn container(lower: [T; 3], upper: [T; 3]) -> Self {
        Self { lower: lower.into(), upper: upper.into(), inside: true }
    }

    /// The six faces as planes that look into the box.
    ///
    /// ```
    /// use carom::surroundings::Cuboid;
    /// let [left, right, ..] = Cuboid::container([0.0; 3], [1.0, 2.0, 3.0]).faces();
    /// assert_eq!((left.normal.x, right.normal.x), (1.0, -1.0));
    /// assert_eq!((left.point.x, right.point.x), (0.0, 1.0));
    /// ```
    #[must_use]
    pub fn faces(&self) -> [Plane<T>; 6] {
        let [one, zero] = [T::ONE, T::ZERO];
        let face = |point, normal| Plane { point, normal };
        [
            face(self.lower, Vec3::new(one, zero, zero)),
            face(self.upper, Vec3::new(-one, zero, zero)),
            face(self.lower, Vec3::new(zero, one, zero)),
            face(self.upper, Vec3::new(zero, -one, zero)),
            face(self.lower, Vec3::new(zero, zero, one)),
            face(self.upper, Vec3::new(zero, zero, -one)),
        ]
    }

    /// Whether a sphere has just bounced off, and is still there.
    fn is_left(&self, flight: &FreeFlight<T>) -> bool {
        let gap = self.clearance(flight.center, flight.radius).gap;
        flight.is_leaving && gap <= self.slack(flight)
    }

    /// As [`FreeFlight::slack`], for all of the box.
    fn slack(&self, flight: &FreeFlight<T>) -> T {
        flight.slack(self.lower).greater(flight.slack(self.upper))
    }
}

impl<T: Real> Obstacle<T> for Cuboid<T> {
    /// To the nearest point of a face, an edge or a corner. A centre inside the
    /// solid is pushed out through the nearest face.
    #[inline(always)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let lower = Vec3::<L>::splat(self.lower);
        let upper = Vec3::<L>::splat(self.upper);
        let beyond = |c: L, low: L, high: L| c - low.greater(c).lesser(high);
        let outward = Vec3::new(
            beyond(center.x, lower.x, upper.x),
            beyond(center.y, lower.y, upper.y),
            beyond(center.z, lower.z, upper.z),
        );
        let distance = outward.length();
        let is_outside = distance.gt(L::ZERO);
        let away = Clearance { gap: distance - radius, arm: outward * (radius / distance) };
        if is_outside.all() {
            return away;
        }

        // Depth below the nearer face of each axis, and that face's normal.
        let below = |c: L, low: L, high: L| {
            let to_low = c - low;
            let to_high = high - c;
            let is_low = to_low.lt(to_high);
            (L::select(is_low, to_low, to_high), L::select(is_low, -L::ONE, L::ONE))
        };
        let (depth_x, side_x) = below(center.x, lower.x, upper.x);
        let (depth_y, side_y) = below(center.y, lower.y, upper.y);
        let (depth_z, side_z) = below(center.z, lower.z, upper.z);
        let is_x = depth_x.le(depth_y) & depth_x.le(depth_z);
        let is_y = !is_x & depth_y.le(depth_z);
        let is_z = !is_x & !is_y;
        let depth = L::select(is_x, depth_x, L::select(is_y, depth_y, depth_z));
        let normal = Vec3::new(
            L::select(is_x, side_x, L::ZERO),
            L::select(is_y, side_y, L::ZERO),
            L::select(is_z, side_z, L::ZERO),
        );
        Clearance {
            gap: L::select(is_outside, away.gap, -(depth + radius)),
            arm: Vec3::select(is_outside, away.arm, normal * radius),
        }
    }

    /// The earliest contact with a face, an edge or a corner.
    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        if flight.acceleration.is_none() && self.is_left(flight) {
            // A straight path never comes back to what is convex.
            return None;
        }
        let faces = Part::faces(self, flight);
        if faces.iter().any(|face| face.is_outside()) {
            // Most flights end here: past the box or on a face.
            let entries = faces.iter().filter_map(|face| face.entry());
            let first = entries.reduce(|a, b| if b.time < a.time { b } else { a })?;
            if first.is_contact {
                return Some(first.time);
            }
        }
        Part::all(self, flight).filter_map(|part| part.contact_time()).reduce(T::lesser)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        (!self.inside).then_some([self.lower, self.upper])
    }

    fn farthest(&self) -> f64 {
        let [lower, upper] = [self.lower, self.upper].map(Vec3::cast::<f64>);
        greatest_component(lower).max(greatest_component(upper))
    }
}

const LOWER: Key = Key::new("lower", Meaning::Point);
const UPPER: Key = Key::new("upper", Meaning::Point);

impl<T: Real> Solid<T> for Cuboid<T> {
    type In<B: Real> = Cuboid<B>;

    const NAME: &'static str = "box";
    const KEYS: &'static [Key] = &[LOWER, UPPER, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<Cuboid<f64>, Mistake> {
        let (lower, upper) = (entry.vector(LOWER)?.into(), entry.vector(UPPER)?.into());
        Ok(Cuboid { lower, upper, inside: entry.flag(INSIDE) })
    }

    fn check(&self) -> Result<(), Mistake> {
        corners(self.lower, self.upper)
    }

    fn cast<B: Real>(&self) -> Cuboid<B> {
        Cuboid { lower: self.lower.cast(), upper: self.upper.cast(), inside: self.inside }
    }

    /// A container is six faces.
    fn features(&self) -> Vec<Feature<T>> {
        if self.inside { self.faces().map(Feature::Plane).into() } else { vec![(*self).into()] }
    }

    fn points(&self) -> Vec<Vec3<T>> {
        vec![self.lower, self.upper]
    }

    fn in_frame(&self, origin: Vec3<T>, scale: T) -> Self {
        Self {
            lower: (self.lower - origin) * scale,
            upper: (self.upper - origin) * scale,
            inside: self.inside,
        }
    }

    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        self.inside.then_some([self.lower, self.upper])
    }
}
