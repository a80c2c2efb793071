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
/// sides and at the rims; or the wall of a hollow [`Cone`](super::Cone), from inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band<T> {
    pub(super) axis: Axis<T>,
    /// Out or up.
    pub(super) slant: Slant<T>,
    /// Whether it is the wall of a container: solid on its right-hand side, without rims.
    pub(super) is_lining: bool,
}

impl<T: Real> Band<T> {
    fn is_flat(&self) -> bool {
        self.slant.along[1] == T::ZERO
    }

    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> (L, Vec3<L>) {
        let place = self.axis.place(place);
        let beside = self.slant.beside(place.distance, place.height);
        let [out, up] = beside.normal;
        let normal = place.outward * out + Vec3::splat(self.axis.direction) * up;
        if !self.is_lining {
            return (beside.distance, normal);
        }
        (
            L::select(beside.is_right, -beside.distance, beside.distance),
            Vec3::select(beside.is_right, -normal, normal),
        )
    }
}

impl<T: Real> Obstacle<T> for Band<T> {
    #[inline(always)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let (distance, normal) = self.nearest(center);
        Clearance { gap: distance - radius, arm: normal * radius }
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        (!self.is_lining).then(|| self.slant.bounds(&self.axis))
    }

    fn farthest(&self) -> f64 {
        let corners = self.slant.bounds(&self.axis).map(|corner| corner.cast::<f64>());
        corners.into_iter().map(greatest_component).fold(0.0, f64::max)
    }

    fn is_hollow(&self) -> bool {
        !self.is_flat()
    }

    fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        self.long_hop(flight, wait)
    }
}

impl<T: Real> Pieced<T> for Band<T> {
    /// A disc without a hole.
    fn is_convex(&self) -> bool {
        self.is_flat() && self.slant.start[0] == T::ZERO
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        let (distance, normal) = self.nearest(place);
        normal * distance
    }

    fn each_piece(&self, mut visit: impl FnMut(Piece<T>)) {
        let Self { axis, slant, is_lining } = *self;
        if self.is_flat() {
            let point = axis.point(slant.start[1]);
            for normal in [axis.direction, -axis.direction] {
                visit(Piece::Face { point, normal });
            }
        } else {
            visit(Piece::Wall { axis, slant, is_hollow: true });
            if !is_lining {
                visit(Piece::Wall { axis, slant, is_hollow: false });
            }
        }
        let is_whole = |end: [T; 2]| self.is_flat() && end[0] == T::ZERO;
        for end in [slant.start, slant.end] {
            if !is_lining && !is_whole(end) {
                visit(Piece::at_end(axis, end));
            }
        }
    }
}
