//! Fixed sphere: a solid ball, or the hollow in one.

use super::Clearance;
use super::free_flight::FreeFlight;
use crate::contact::{Approach, Start};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// A sphere fixed in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedSphere<T> {
    /// Its centre, length.
    pub center: Vec3<T>,
    /// Its radius, length.
    pub radius: T,
    /// Whether bodies are inside of it: a spherical container.
    pub inside: bool,
}

impl<T: Real> FixedSphere<T> {
    /// A solid sphere that bodies bounce off.
    #[must_use]
    pub fn solid(center: [T; 3], radius: T) -> Self {
        Self { center: center.into(), radius, inside: false }
    }

    /// A spherical container that bodies are inside of.
    #[must_use]
    pub fn container(center: [T; 3], radius: T) -> Self {
        Self { center: center.into(), radius, inside: true }
    }

    /// Where spheres with these centres and radii stand to the fixed one.
    ///
    /// At the common centre, where no normal is defined, the arm is zero and
    /// no impulse follows.
    #[inline(always)]
    pub fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let offset = center - Vec3::splat(self.center);
        let distance = offset.length();
        let fixed_radius = L::splat(self.radius);
        // The arm in proportion to the true distance, as for two free spheres:
        // at contact it has length r exactly.
        if self.inside {
            let reach = fixed_radius - radius;
            Clearance { gap: reach - distance, arm: -(offset * (radius / reach)) }
        } else {
            let reach = fixed_radius + radius;
            Clearance { gap: distance - reach, arm: offset * (radius / reach) }
        }
    }

    /// When a sphere collides with the fixed one: for centres at the sum of the
    /// radii, inside at their difference.
    pub(super) fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        let radius = if self.inside { -flight.radius } else { flight.radius };
        let approach = Approach {
            offset: flight.center - self.center,
            velocity: flight.velocity,
            acceleration: flight.acceleration.unwrap_or(Vec3::ZERO),
            reach: self.radius + radius,
            is_hollow: self.inside,
        };
        let slack = approach.squared(flight.slack(self.center));
        let start = Start::at(approach.gap_squared(), slack, flight.is_leaving);
        approach.contact_time(start, |_| true)
    }
}
