//! Facet: a thin triangle, touched from both sides.

use super::Clearance;
use super::axis::Axis;
use super::piece::Piece;
use super::pieced::Pieced;
use super::solid::Obstacle;
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// What a sphere touches of a [`Triangle`](super::Triangle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet<T> {
    corners: [Vec3<T>; 3],
    /// From each corner to the next one.
    sides: [Vec3<T>; 3],
    /// Unit vector.
    normal: Vec3<T>,
}

impl<T: Real> Facet<T> {
    pub(super) fn new(corners: [Vec3<T>; 3]) -> Self {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let normal = normal * (T::ONE / normal.length());
        Self { corners, sides: [b - a, c - b, a - c], normal }
    }

    /// From the nearest point to places, and the unit vector of that.
    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> (L, Vec3<L>) {
        let normal = Vec3::<L>::splat(self.normal);
        let height = (place - Vec3::splat(self.corners[0])).dot(normal);
        let side = L::select(height.ge(L::ZERO), L::ONE, -L::ONE);
        let mut is_above = L::ZERO.le(L::ZERO);
        let mut best = (L::ZERO, Vec3::ZERO);
        for (k, (corner, side)) in self.corners.iter().zip(self.sides).enumerate() {
            let offset = place - Vec3::splat(*corner);
            let length_squared = L::splat(side.length_squared());
            let side = Vec3::<L>::splat(side);
            is_above = is_above & side.cross(offset).dot(normal).ge(L::ZERO);
            let share = offset.dot(side) / length_squared;
            let offset = offset - side * share.greater(L::ZERO).lesser(L::ONE);
            let squared = offset.length_squared();
            let is_nearer = if k == 0 { L::ZERO.le(L::ZERO) } else { squared.lt(best.0) };
            best = (L::select(is_nearer, squared, best.0), Vec3::select(is_nearer, offset, best.1));
        }
        // Above the face by its own normal, which rounding of the place leaves alone.
        let distance = best.0.sqrt();
        let is_level = is_above | !distance.gt(L::ZERO);
        (
            L::select(is_above, height.abs(), distance),
            Vec3::select(is_level, normal * side, best.1 * (L::ONE / distance)),
        )
    }
}

impl<T: Real> Obstacle<T> for Facet<T> {
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let (distance, normal) = self.nearest(center);
        Clearance { gap: distance - radius, arm: normal * radius }
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        let [a, b, c] = self.corners;
        Some([a.lesser(b).lesser(c), a.greater(b).greater(c)])
    }

    fn farthest(&self) -> f64 {
        self.corners.map(|corner| greatest_component(corner.cast())).into_iter().fold(0.0, f64::max)
    }
}

impl<T: Real> Pieced<T> for Facet<T> {
    fn is_convex(&self) -> bool {
        true
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        let (distance, normal) = self.nearest(place);
        normal * distance
    }

    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        for normal in [self.normal, -self.normal] {
            visit(Piece::Face { point: self.corners[0], normal });
        }
        for (center, side) in self.corners.into_iter().zip(self.sides) {
            visit(Piece::Corner { center, radius: T::ZERO, is_hollow: false });
            let axis = Axis { center, direction: side * (T::ONE / side.length()) };
            visit(Piece::Edge { axis, radius: T::ZERO, is_hollow: false });
        }
    }
}
