//! Facet: a thin triangle, touched from both sides.

use super::axis::Axis;
use super::piece::Piece;
use super::pieced::Pieced;
use super::solid::Obstacle;
use super::{Clearance, Plane};
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::Lane;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// What a sphere touches of a [`Triangle`](super::Triangle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet<T> {
    pub(super) corners: [Vec3<T>; 3],
    /// From each corner to the next one.
    pub(super) sides: [Side<T>; 3],
    /// A point of its plane, and a unit normal; `None` if the corners are on a line.
    pub(super) face: Option<Plane<T>>,
    /// The greatest coordinate, length.
    size: T,
}

/// A side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Side<T> {
    /// An end of it, and the way to the other one.
    pub(super) from: Vec3<T>,
    pub(super) way: Vec3<T>,
    /// Whether the triangle is on the left of that way, seen against the normal.
    is_left: bool,
    /// Of a side behind which the plane goes on: its length, in units of rounding; else 0.
    give: T,
}

/// How many roundings a place may be beyond a side behind which the plane goes on to be
/// above the triangle still, when it is looked for and when it is found again.
pub(super) const LOOKED_FOR: i32 = 16;
const FOUND: i32 = 64;

/// What of a triangle is nearest to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Nearest {
    Face,
    /// A side, by its number.
    Side(usize),
    /// A corner, by its number.
    Corner(usize),
}

impl<T: Real> Facet<T> {
    pub(super) fn new(corners: [Vec3<T>; 3]) -> Self {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let normal = normal * (T::ONE / normal.length());
        Self {
            sides: [[a, b], [b, c], [c, a]].each(|ends| Side::new(ends, true, false)),
            face: Some(Plane { point: a, normal }),
            size: farthest(corners),
            corners,
        }
    }

    /// With sides of their own, in a plane of its own.
    pub(super) fn with(corners: [Vec3<T>; 3], sides: [Side<T>; 3], face: Option<Plane<T>>) -> Self {
        Self { size: farthest(corners), corners, sides, face }
    }

    /// Whether places are above the face, or below; up to some roundings beyond a side
    /// behind which the plane goes on.
    #[inline(always)]
    pub(super) fn is_above<L: Lane<Scalar = T>>(&self, place: Vec3<L>, roundings: i32) -> L::Mask {
        let Some(face) = &self.face else { return L::ZERO.lt(L::ZERO) };
        let normal = Vec3::<L>::splat(face.normal);
        let size = place.x.abs().greater(place.y.abs()).greater(place.z.abs());
        let size = (size + L::splat(self.size)) * L::splat(T::whole(roundings));
        let mut is_above = L::ZERO.le(L::ZERO);
        for side in &self.sides {
            let beside = Vec3::splat(side.way).cross(place - Vec3::splat(side.from)).dot(normal);
            let beside = if side.is_left { beside } else { -beside };
            is_above = is_above & beside.ge(-(L::splat(side.give) * size));
        }
        is_above
    }

    /// From the nearest point to places, and the unit vector of that.
    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> (L, Vec3<L>) {
        let mut best = (L::ZERO, Vec3::ZERO);
        for (k, side) in self.sides.iter().enumerate() {
            let (offset, _) = side.offset(place);
            let squared = offset.length_squared();
            let is_nearer = if k == 0 { L::ZERO.le(L::ZERO) } else { squared.lt(best.0) };
            best = (L::select(is_nearer, squared, best.0), Vec3::select(is_nearer, offset, best.1));
        }
        let distance = best.0.sqrt();
        let Some(face) = &self.face else {
            // At a line itself there is no normal, and no impulse follows.
            let is_off = distance.gt(L::ZERO);
            let unit = best.1 * (L::ONE / L::select(is_off, distance, L::ONE));
            return (distance, unit);
        };
        // Above the face by its own normal, which rounding of the place leaves alone.
        let normal = Vec3::<L>::splat(face.normal);
        let height = (place - Vec3::splat(face.point)).dot(normal);
        let up = L::select(height.ge(L::ZERO), L::ONE, -L::ONE);
        let is_above = self.is_above(place, FOUND);
        let is_level = is_above | !distance.gt(L::ZERO);
        (
            L::select(is_above, height.abs(), distance),
            Vec3::select(is_level, normal * up, best.1 * (L::ONE / distance)),
        )
    }

    /// What is nearest to a place.
    pub(super) fn nearest_piece(&self, place: Vec3<T>) -> Nearest {
        if self.is_above(place, FOUND) {
            return Nearest::Face;
        }
        let mut nearest: Option<(T, Nearest)> = None;
        for (k, side) in self.sides.iter().enumerate() {
            let (offset, share) = side.offset(place);
            let squared = offset.length_squared();
            if nearest.is_none_or(|(least, _)| squared < least) {
                let is_end = share <= T::ZERO || share >= T::ONE;
                // A side may go from its second corner to the first.
                let is_first = (share <= T::ZERO) == (side.from == self.corners[k]);
                let corner = if is_first { k } else { (k + 1) % 3 };
                let piece = if is_end { Nearest::Corner(corner) } else { Nearest::Side(k) };
                nearest = Some((squared, piece));
            }
        }
        nearest.map_or(Nearest::Face, |(_, piece)| piece)
    }

    /// The face as a plane that looks to the side of a place.
    pub(super) fn face_towards(&self, place: Vec3<T>) -> Option<Plane<T>> {
        let face = self.face?;
        let is_below = (place - face.point).dot(face.normal) < T::ZERO;
        Some(if is_below { Plane { normal: -face.normal, ..face } } else { face })
    }
}

impl<T: Real> Side<T> {
    /// From one end to the other; behind a seam the plane goes on.
    pub(super) fn new([from, to]: [Vec3<T>; 2], is_left: bool, is_seam: bool) -> Self {
        let way = to - from;
        let give = if is_seam { way.length() * T::EPSILON } else { T::ZERO };
        Self { from, way, is_left, give }
    }

    /// From the nearest point of the side to places, and how far along it that is.
    #[inline(always)]
    fn offset<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> (Vec3<L>, L) {
        let offset = place - Vec3::splat(self.from);
        let length_squared = self.way.length_squared();
        let length_squared = if length_squared > T::ZERO { length_squared } else { T::ONE };
        let way = Vec3::<L>::splat(self.way);
        let share = offset.dot(way) / L::splat(length_squared);
        let share = share.greater(L::ZERO).lesser(L::ONE);
        (offset - way * share, share)
    }
}

fn farthest<T: Real>(corners: [Vec3<T>; 3]) -> T {
    corners.each(greatest_component).into_iter().fold(T::ZERO, T::greater)
}

impl<T: Real> Obstacle<T> for Facet<T> {
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        Clearance::off(self.nearest(center), radius)
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        let [a, b, c] = self.corners;
        Some([a.lesser(b).lesser(c), a.greater(b).greater(c)])
    }

    fn farthest(&self) -> f64 {
        self.size.to_f64()
    }
}

impl<T: Real> Pieced<T> for Facet<T> {
    fn is_convex(&self) -> bool {
        true
    }

    fn is_flat(&self) -> bool {
        true
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        let (distance, normal) = self.nearest(place);
        normal * distance
    }

    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        if let Some(Plane { point, normal }) = self.face {
            for normal in [normal, -normal] {
                visit(Piece::Face { point, normal });
            }
        }
        for (center, side) in self.corners.into_iter().zip(self.sides) {
            visit(Piece::Corner { center, radius: T::ZERO, is_hollow: false });
            let length = side.way.length();
            if length > T::ZERO {
                let axis = Axis { center: side.from, direction: side.way * (T::ONE / length) };
                visit(Piece::Edge { axis, radius: T::ZERO, is_hollow: false });
            }
        }
    }
}
