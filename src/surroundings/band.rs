//! Band: a thin disc, tube or funnel.

use super::Clearance;
use super::axis::Axis;
use super::piece::Piece;
use super::pieced::Pieced;
use super::slant::Slant;
use super::solid::Obstacle;
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// What a sphere touches of a [`Disc`](super::Disc) or a [`Tube`](super::Tube), from both
/// sides and at the rims; or the wall of a [`Cone`](super::Cone), from inside or outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band<T> {
    pub(super) axis: Axis<T>,
    /// Out or up.
    pub(super) slant: Slant<T>,
    pub(super) sides: Sides,
    /// Whether it has a rim at its start and its end.
    pub(super) rims: [bool; 2],
}

/// The sides from which it is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sides {
    /// It is thin.
    Both,
    /// It is solid on its right-hand side: the wall of a container.
    Inner,
    /// It is solid on its left-hand side.
    Outer,
}

impl<T: Real> Band<T> {
    /// Thin, with a rim at every end but the axis.
    pub(super) fn thin(axis: Axis<T>, slant: Slant<T>) -> Self {
        Self { axis, slant, sides: Sides::Both, rims: [true; 2] }
    }

    /// The wall of a container.
    pub(super) fn lining(axis: Axis<T>, slant: Slant<T>) -> Self {
        Self { axis, slant, sides: Sides::Inner, rims: [false; 2] }
    }

    /// A solid cone that goes on without end from its tip.
    pub(super) fn endless(axis: Axis<T>, slant: Slant<T>) -> Self {
        Self { axis, slant, sides: Sides::Outer, rims: [true, false] }
    }

    fn is_level(&self) -> bool {
        self.slant.along[1] == T::ZERO
    }

    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> (L, Vec3<L>) {
        let place = self.axis.place(place);
        let beside = self.slant.beside(place.distance, place.height);
        let is_solid = match self.sides {
            Sides::Both => L::ZERO.lt(L::ZERO),
            Sides::Inner => beside.is_right,
            Sides::Outer => !beside.is_right,
        };
        beside.about(&self.axis, &place, is_solid)
    }
}

impl<T: Real> Obstacle<T> for Band<T> {
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        Clearance::off(self.nearest(center), radius)
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        (self.sides == Sides::Both).then(|| self.slant.bounds(&self.axis))
    }

    fn farthest(&self) -> f64 {
        let ends = [self.slant.start, self.slant.end].into_iter().filter(|end| end[1].is_finite());
        let corners = ends.flat_map(|[distance, height]| self.axis.around(height, distance));
        corners.map(|corner| greatest_component(corner.cast::<f64>())).fold(0.0, f64::max)
    }

    fn is_hollow(&self) -> bool {
        !self.is_level() && self.sides != Sides::Outer
    }

    fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        self.long_hop(flight, wait)
    }
}

impl<T: Real> Pieced<T> for Band<T> {
    /// A disc without a hole, or a solid cone.
    fn is_convex(&self) -> bool {
        self.is_level() && self.slant.start[0] == T::ZERO || self.sides == Sides::Outer
    }

    fn is_flat(&self) -> bool {
        self.is_level()
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        let (distance, normal) = self.nearest(place);
        normal * distance.greater(T::ZERO)
    }

    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        let Self { axis, slant, sides, rims } = *self;
        if self.is_level() {
            let point = axis.point(slant.start[1]);
            for normal in [axis.direction, -axis.direction] {
                visit(Piece::Face { point, normal });
            }
        } else {
            for (is_hollow, other) in [(true, Sides::Outer), (false, Sides::Inner)] {
                if sides != other {
                    visit(Piece::Wall { axis, slant, is_hollow });
                }
            }
        }
        let is_whole = |end: [T; 2]| self.is_level() && end[0] == T::ZERO;
        for (end, is_rim) in [slant.start, slant.end].into_iter().zip(rims) {
            if is_rim && !is_whole(end) {
                visit(Piece::at_end(axis, end));
            }
        }
    }
}
