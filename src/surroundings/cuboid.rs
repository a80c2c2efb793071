//! Cuboid: a solid box with its edges and corners, or the hollow in one.

use super::axis::Axis;
use super::entry::{INSIDE, Key, Meaning, ShapeEntry};
use super::gate::Gate;
use super::mistake::{Mistake, corners};
use super::piece::Piece;
use super::pieced::Pieced;
use super::placement::Placement;
use super::skin::{Corners, Detail, fan, from_inside};
use super::solid::{Obstacle, Solid};
use super::{Clearance, Feature, Plane};
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::{Lane, Mask};
use crate::mat3::Mat3;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// A box fixed in space.
///
/// In a scene file: `shape = "box"` with `lower`, `upper` and `inside`; `inside = true` makes
/// a container. Its sides are along the axes, unless it is [turned](super::Shape::turned).
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
    /// The corner with the least coordinates, length; before the rotation.
    pub lower: Vec3<T>,
    /// The corner with the greatest coordinates, length; before the rotation.
    pub upper: Vec3<T>,
    /// How it is turned about its middle; `None`: not at all.
    pub rotation: Option<Mat3<T>>,
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
        Self { lower: lower.into(), upper: upper.into(), rotation: None, inside: false }
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
        Self { lower: lower.into(), upper: upper.into(), rotation: None, inside: true }
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
        let face = |point, normal| Plane { point: self.placed(point), normal: self.along(normal) };
        [
            face(self.lower, Vec3::new(one, zero, zero)),
            face(self.upper, Vec3::new(-one, zero, zero)),
            face(self.lower, Vec3::new(zero, one, zero)),
            face(self.upper, Vec3::new(zero, -one, zero)),
            face(self.lower, Vec3::new(zero, zero, one)),
            face(self.upper, Vec3::new(zero, zero, -one)),
        ]
    }

    fn middle(&self) -> Vec3<T> {
        (self.lower + self.upper) * T::ratio(1, 2)
    }

    /// A point of the box before its rotation, where it is in the world.
    fn placed(&self, point: Vec3<T>) -> Vec3<T> {
        let middle = self.middle();
        self.rotation.map_or(point, |rotation| middle + rotation * (point - middle))
    }

    /// A vector of the box before its rotation, as it is in the world.
    fn along(&self, vector: Vec3<T>) -> Vec3<T> {
        self.rotation.map_or(vector, |rotation| rotation * vector)
    }

    /// The corners of the box around it.
    fn around(&self) -> [Vec3<T>; 2] {
        let Some(rotation) = self.rotation else { return [self.lower, self.upper] };
        let half = (self.upper - self.lower) * T::ratio(1, 2);
        let [a, b, c] = rotation.columns;
        let reach = |a: T, b: T, c: T| a.abs() * half.x + b.abs() * half.y + c.abs() * half.z;
        let reach = Vec3::new(reach(a.x, b.x, c.x), reach(a.y, b.y, c.y), reach(a.z, b.z, c.z));
        [self.middle() - reach, self.middle() + reach]
    }

    /// The box before its rotation, and a flight as it is seen from there.
    fn straightened(&self, flight: &FreeFlight<T>) -> (Self, FreeFlight<T>) {
        let Some(rotation) = self.rotation else { return (*self, *flight) };
        let (back, middle) = (rotation.transpose(), self.middle());
        let flight = FreeFlight {
            center: middle + back * (flight.center - middle),
            velocity: back * flight.velocity,
            acceleration: flight.acceleration.map(|pull| back * pull),
            ..*flight
        };
        (Self { rotation: None, ..*self }, flight)
    }
}

impl<T: Real> Obstacle<T> for Cuboid<T> {
    /// To the nearest point of a face, an edge or a corner. A centre inside the
    /// solid is pushed out through the nearest face.
    #[inline(always)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let Some(rotation) = self.rotation else {
            return self.level_clearance(center, radius);
        };
        let (rotation, middle) = (Mat3::<L>::splat(rotation), Vec3::splat(self.middle()));
        let seen = middle + rotation.transpose() * (center - middle);
        let Clearance { gap, arm } = self.level_clearance(seen, radius);
        Clearance { gap, arm: rotation * arm }
    }

    /// The earliest contact with a face, an edge or a corner.
    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        let (level, flight) = self.straightened(flight);
        level.collision_time(&flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        (!self.inside).then(|| self.around())
    }

    fn farthest(&self) -> f64 {
        let [lower, upper] = self.around().each(Vec3::cast::<f64>);
        greatest_component(lower).max(greatest_component(upper))
    }
}

impl<T: Real> Pieced<T> for Cuboid<T> {
    fn is_convex(&self) -> bool {
        true
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        place - self.lower.greater(place).lesser(self.upper)
    }

    /// The faces, edges and corners, by where along each axis they lie.
    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        for Plane { point, normal } in self.faces() {
            visit(Piece::Face { point, normal: -normal });
        }
        let [lower, upper] = [self.lower.to_array(), self.upper.to_array()];
        for corner in 0..8 {
            let end = |axis: usize| if corner >> axis & 1 == 0 { lower[axis] } else { upper[axis] };
            let center = Vec3::new(end(0), end(1), end(2));
            visit(Piece::Corner { center, radius: T::ZERO, is_hollow: false });
            for axis in 0..3 {
                if corner >> axis & 1 == 0 {
                    let unit = |k: usize| if k == axis { T::ONE } else { T::ZERO };
                    let direction = Vec3::new(unit(0), unit(1), unit(2));
                    let axis = Axis { center, direction };
                    visit(Piece::Edge { axis, radius: T::ZERO, is_hollow: false });
                }
            }
        }
    }
}

impl<T: Real> Cuboid<T> {
    /// The clearance before the rotation.
    #[inline(always)]
    fn level_clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
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
}

const LOWER: Key = Key::new("lower", Meaning::Point);
const UPPER: Key = Key::new("upper", Meaning::Point);

impl<T: Real> Solid<T> for Cuboid<T> {
    type In<B: Real> = Cuboid<B>;

    const NAME: &'static str = "box";
    const KEYS: &'static [Key] = &[LOWER, UPPER, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<Cuboid<f64>, Mistake> {
        let (lower, upper) = (entry.vector(LOWER)?.into(), entry.vector(UPPER)?.into());
        Ok(Cuboid { lower, upper, rotation: None, inside: entry.flag(INSIDE) })
    }

    fn check(&self) -> Result<(), Mistake> {
        corners(self.lower, self.upper)
    }

    fn cast<B: Real>(&self) -> Cuboid<B> {
        Cuboid {
            lower: self.lower.cast(),
            upper: self.upper.cast(),
            rotation: self.rotation.map(Mat3::cast),
            inside: self.inside,
        }
    }

    /// A container is six faces.
    fn features(&self) -> Vec<Feature<T>> {
        if self.inside { self.faces().each(Feature::Plane).into() } else { vec![(*self).into()] }
    }

    fn area(&self) -> Option<T> {
        let Vec3 { x, y, z } = self.upper - self.lower;
        Some((x * y + y * z + z * x) * T::whole(2))
    }

    fn triangles(&self, _: &Detail<T>) -> Vec<Corners<T>> {
        let faces =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let corner = |k: usize| {
            let pick = |bit: usize| if k >> bit & 1 == 0 { self.lower } else { self.upper };
            self.placed(Vec3::new(pick(0).x, pick(1).y, pick(2).z))
        };
        let triangles = faces.into_iter().flat_map(|face| fan(&face.each(corner))).collect();
        from_inside(triangles, self.inside)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.around().into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        let Some(turn) = at.rotation() else {
            return Self { lower: at.point(self.lower), upper: at.point(self.upper), ..*self };
        };
        let half = self.upper - self.lower;
        let half = half * at.length(T::ratio(1, 2));
        let middle = at.point(self.middle());
        let rotation = Some(self.rotation.map_or(turn, |rotation| turn * rotation));
        Self { lower: middle - half, upper: middle + half, rotation, ..*self }
    }

    fn gate(&self) -> Option<Gate<T>> {
        Some(Gate::closed(|inside| Self { inside, ..*self }.features()))
    }

    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        self.inside.then(|| self.around())
    }

    /// Turned, it takes a cube.
    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        let Some(rotation) = self.rotation else { return self.interior() };
        let half = ((self.upper - self.lower) * T::ratio(1, 2)).to_array();
        let widths = rotation.columns.each(|axis| axis.x.abs() + axis.y.abs() + axis.z.abs());
        let fits = half.into_iter().zip(widths).map(|(half, width)| half / width);
        let reach = fits.reduce(T::lesser)?;
        let reach = Vec3::new(reach, reach, reach);
        self.inside.then(|| [self.middle() - reach, self.middle() + reach])
    }
}
