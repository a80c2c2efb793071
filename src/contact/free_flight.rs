//! Free flight: the path of one sphere between two collisions.

use super::approach::greatest_component;
use crate::real::Real;
use crate::vec3::Vec3;

/// A sphere on the path `c + v t + a t²/2`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FreeFlight<T> {
    /// Its centre now, length.
    pub(crate) center: Vec3<T>,
    /// Length per time.
    pub(crate) velocity: Vec3<T>,
    /// Length per time²; None for straight flight.
    pub(crate) acceleration: Option<Vec3<T>>,
    /// Length.
    pub(crate) radius: T,
    /// Whether it has just bounced off the feature in question.
    pub(crate) is_leaving: bool,
}

impl<T: Real> FreeFlight<T> {
    /// Where its centre will be.
    pub(crate) fn position(&self, time: T) -> Vec3<T> {
        match self.acceleration {
            None => self.center + self.velocity * time,
            Some(pull) => self.center + (self.velocity + pull * (T::ratio(1, 2) * time)) * time,
        }
    }

    /// How fast it will be.
    pub(crate) fn velocity_at(&self, time: T) -> Vec3<T> {
        self.acceleration.map_or(self.velocity, |pull| self.velocity + pull * time)
    }

    /// Its acceleration, also where that is zero.
    pub(crate) fn pull(&self) -> Vec3<T> {
        self.acceleration.unwrap_or(Vec3::ZERO)
    }

    /// The gap, length, up to which a sphere that has just bounced off a
    /// feature at `place` is still in contact: what rounding of its path can
    /// have left.
    pub(crate) fn slack(&self, place: Vec3<T>) -> T {
        let places = greatest_component(self.center).greater(greatest_component(place));
        T::whole(64) * T::EPSILON * (places + self.radius)
    }

    /// What one rounding of a place on the path up to a time is worth, length, beside
    /// something of a size.
    pub(crate) fn rounding(&self, time: T, size: T) -> T {
        let way = greatest_component(self.velocity)
            + greatest_component(self.pull()) * (T::ratio(1, 2) * time);
        T::EPSILON * (greatest_component(self.center) + way * time + self.radius + size)
    }
}
