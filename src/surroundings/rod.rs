//! Rod: a cylinder without end, solid or hollow.

use super::Clearance;
use super::axis::Axis;
use super::piece::Piece;
use super::solid::Obstacle;
use crate::contact::{FreeFlight, Start, greatest_component};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// A cylinder without end: a [`Cylinder`](super::Cylinder) without a height, or the wall
/// of a hollow one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod<T> {
    pub(super) axis: Axis<T>,
    pub(super) radius: T,
    pub(super) inside: bool,
}

impl<T: Real> Rod<T> {
    fn piece(&self) -> Piece<T> {
        Piece::Edge { axis: self.axis, radius: self.radius, is_hollow: self.inside }
    }
}

impl<T: Real> Obstacle<T> for Rod<T> {
    /// On the axis of a hollow one, where no normal is defined, the arm is zero and no
    /// impulse follows.
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let place = self.axis.place(center);
        let across = place.outward * place.distance;
        Clearance::round(across, place.distance, L::splat(self.radius), radius, self.inside)
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        let slack = flight.slack(Vec3::new(T::from_f64(self.farthest()), T::ZERO, T::ZERO));
        let approach = self.piece().approach(flight)?;
        let slack = approach.squared(slack);
        let start = Start::at(approach.gap_squared(), slack, flight.is_leaving);
        approach.contact_time(start, &|_| true)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        None
    }

    fn farthest(&self) -> f64 {
        greatest_component(self.axis.center.cast::<f64>()) + self.radius.to_f64()
    }

    fn is_hollow(&self) -> bool {
        self.inside
    }

    fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        self.piece().hop(flight, wait)
    }
}
