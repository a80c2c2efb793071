//! Frustum: a solid cylinder or cone with its ends.

use super::Clearance;
use super::axis::Axis;
use super::piece::Piece;
use super::pieced::Pieced;
use super::slant::Slant;
use super::solid::Obstacle;
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::Lane;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// What a sphere touches of a solid [`Cylinder`](super::Cylinder) with ends, or of a
/// solid [`Cone`](super::Cone).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum<T> {
    /// From the base up.
    axis: Axis<T>,
    /// Out of the axis along the base, up the wall, and back along the top.
    profile: [Slant<T>; 3],
}

impl<T: Real> Frustum<T> {
    /// About an axis from the middle of its base, with the radii of its base and its top.
    pub(super) fn new(axis: Axis<T>, height: T, [base, top]: [T; 2]) -> Self {
        let corners = [[T::ZERO, T::ZERO], [base, T::ZERO], [top, height], [T::ZERO, height]];
        let mut profile: [Slant<T>; 3] = array::from_fn(|k| Slant::new(corners[k], corners[k + 1]));
        // Also of a tip.
        profile[2].along = [-T::ONE, T::ZERO];
        Self { axis, profile }
    }

    /// The distance from the surface, negative inside, and the unit normal.
    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> (L, Vec3<L>) {
        let place = self.axis.place(place);
        let [base, wall, top] =
            self.profile.refs().each(|slant| slant.beside(place.distance, place.height));
        let is_inside = !base.is_right & !wall.is_right & !top.is_right;
        top.or_nearer(wall.or_nearer(base)).about(&self.axis, &place, is_inside)
    }
}

impl<T: Real> Obstacle<T> for Frustum<T> {
    /// A centre inside is pushed out through the nearest face.
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        Clearance::off(self.nearest(center), radius)
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        let [base, _, top] = self.profile.each(|slant| slant.bounds(&self.axis));
        Some(joined(base, top))
    }

    fn farthest(&self) -> f64 {
        let [base, _, top] = self.profile.each(|slant| slant.bounds(&self.axis));
        let corners = [base, top].concat();
        corners.iter().map(|corner| greatest_component(corner.cast())).fold(0.0, f64::max)
    }
}

impl<T: Real> Pieced<T> for Frustum<T> {
    fn is_convex(&self) -> bool {
        true
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        let (distance, normal) = self.nearest(place);
        normal * distance.greater(T::ZERO)
    }

    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        let Self { axis, profile: [_, wall, _] } = *self;
        visit(Piece::Face { point: axis.center, normal: -axis.direction });
        visit(Piece::Wall { axis, slant: wall, is_hollow: false });
        let [_, height] = wall.end;
        visit(Piece::Face { point: axis.point(height), normal: axis.direction });
        for end in [wall.start, wall.end] {
            visit(Piece::at_end(axis, end));
        }
    }
}
