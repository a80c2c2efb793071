//! Free flight: the path of one sphere between two collisions.

use crate::contact::greatest_component;
use crate::real::Real;
use crate::vec3::Vec3;

/// A sphere on the path `c + v t + a t²/2`.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeFlight<T> {
    /// Its centre now, length.
    pub(super) center: Vec3<T>,
    /// Length per time.
    pub(super) velocity: Vec3<T>,
    /// Length per time²; None for straight flight.
    pub(super) acceleration: Option<Vec3<T>>,
    /// Length.
    pub(super) radius: T,
    /// Whether it has just bounced off the feature in question.
    pub(super) is_leaving: bool,
}

impl<T: Real> FreeFlight<T> {
    /// The gap, length, up to which a sphere that has just bounced off a
    /// feature at `place` is still in contact: what rounding of its path can
    /// have left.
    pub(super) fn slack(&self, place: Vec3<T>) -> T {
        let places = greatest_component(self.center).greater(greatest_component(place));
        T::whole(64) * T::EPSILON * (places + self.radius)
    }
}
