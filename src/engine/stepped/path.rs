//! Path: where a body was within the step that has just been taken.

use crate::contact::FreeFlight;
use crate::lane::Lane;
use crate::motion::Integrator;
use crate::real::Real;
use crate::scene::Impact;
use crate::surroundings::FeatureRef;
use crate::vec3::Vec3;

/// How the integrator's path runs back from the end of a step:
/// `c(τ) = c − uτ + ½ b τ²`, `u = v − lag`, τ before the end.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct Path<T> {
    /// Length of the step.
    pub duration: T,
    /// By how much the velocity at the end differs from the path's.
    lag: Vec3<T>,
    /// The path's acceleration.
    bend: Vec3<T>,
    /// Whether that is not zero.
    is_bent: bool,
}

/// A part of the step in which no body moves faster than a certain speed, both
/// ends by their times before the end of the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<T> {
    pub from: T,
    pub until: T,
    pub fastest: T,
}

impl<T: Real> Stretch<T> {
    /// How far a body moves in it at most, length.
    pub fn way(&self) -> T {
        self.fastest * (self.from - self.until)
    }
}

impl<T: Real> Path<T> {
    /// The paths of steps of a length. Contacts at the end of a step have no
    /// use for the path that leads there.
    pub fn new(integrator: Integrator, impact: Impact, acceleration: Vec3<T>, duration: T) -> Self {
        let still = Vec3::ZERO;
        let (lag, bend) = match (impact, integrator) {
            (Impact::EndOfStep, _) | (_, Integrator::SemiImplicitEuler) => (still, still),
            (_, Integrator::ExplicitEuler) => (acceleration * duration, still),
            (_, Integrator::VelocityVerlet) => (still, acceleration),
        };
        let is_bent = bend.to_array().iter().any(|&component| component != T::ZERO);
        Self { duration, lag, bend, is_bent }
    }

    /// The path's velocity at the end of the step.
    #[inline(always)]
    pub fn end_velocity<L: Lane<Scalar = T>>(&self, velocity: Vec3<L>) -> Vec3<L> {
        velocity - Vec3::splat(self.lag)
    }

    /// The path's velocity a time before the end.
    #[inline(always)]
    pub fn velocity<L: Lane<Scalar = T>>(&self, end_velocity: Vec3<L>, ago: L) -> Vec3<L> {
        end_velocity - Vec3::splat(self.bend) * ago
    }

    /// The centre a time before the end.
    #[inline(always)]
    pub fn center<L: Lane<Scalar = T>>(&self, end: Vec3<L>, velocity: Vec3<L>, ago: L) -> Vec3<L> {
        let half = L::ratio(1, 2);
        end - velocity * ago + Vec3::splat(self.bend) * (half * ago * ago)
    }

    /// How long before the end of the step a sphere first touches a feature, on
    /// the path that it has had since a time before the end; None if it does not
    /// within the step.
    ///
    /// What touches the feature at the start of its path and approaches touches
    /// it then, whatever rounding says. `is_leaving`: as
    /// [`Feature::contact_time`](crate::surroundings::Feature::contact_time) has it.
    pub fn contact(
        &self,
        feature: &FeatureRef<'_, T>,
        (end, end_velocity): (Vec3<T>, Vec3<T>),
        radius: T,
        since: T,
        is_leaving: bool,
    ) -> Option<T> {
        let center = self.center(end, end_velocity, since);
        let velocity = self.velocity(end_velocity, since);
        let acceleration = self.is_bent.then_some(self.bend);
        let flight = FreeFlight { center, velocity, acceleration, radius, is_leaving };
        let wait = feature.contact_time(&flight)?;
        // One that comes back within the rounding of time rests there, and would
        // come back without end: it waits for the next step.
        let is_at_rest = is_leaving && wait <= self.duration * T::EPSILON * T::whole(256);
        (wait <= since && !is_at_rest).then(|| since - wait)
    }
}
