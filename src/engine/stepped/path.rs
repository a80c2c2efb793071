//! Path: where a body was within the step that has just been taken.

use crate::lane::{Lane, Mask};
use crate::motion::Integrator;
use crate::real::Real;
use crate::scene::Impact;
use crate::surroundings::Feature;
use crate::vec3::Vec3;

/// How the integrator's path runs back from the end of a step:
/// `c(τ) = c − uτ + ½ b τ²`, `u = v − lag`, τ before the end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path<T> {
    /// Length of the step.
    pub duration: T,
    /// By how much the velocity at the end differs from the path's.
    lag: Vec3<T>,
    /// The path's acceleration.
    bend: Vec3<T>,
}

/// Steps of Newton's method; each doubles the digits, and a path that only
/// grazes a curved feature halves its error.
const MOST_NEWTON_STEPS: usize = 12;

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
        Self { duration, lag, bend }
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

    /// How long ago spheres that are inside a feature at the end of the step
    /// touched it; 0 where they were inside at its beginning already.
    ///
    /// Newton's method on the gap along the path, for any feature. From inside
    /// a flat one it comes nearer from one side only.
    #[inline(never)]
    pub fn touch<L: Lane<Scalar = T>>(
        &self,
        feature: &Feature<T>,
        end: Vec3<L>,
        end_velocity: Vec3<L>,
        radius: L,
    ) -> L {
        let duration = L::splat(self.duration);
        let mut ago = L::ZERO;
        for _ in 0..MOST_NEWTON_STEPS {
            let center = self.center(end, end_velocity, ago);
            let clearance = feature.clearance(center, radius);
            let approach =
                self.velocity(end_velocity, ago).dot(clearance.arm) / clearance.arm.length();
            let next = ago + clearance.gap / approach;
            let is_valid = next.ge(L::ZERO) & next.le(duration);
            let next = L::select(is_valid, next, L::select(next.gt(duration), duration, L::ZERO));
            let is_settled = next.same(ago);
            ago = next;
            if is_settled.all() {
                break;
            }
        }
        let start = feature.clearance(self.center(end, end_velocity, duration), radius);
        L::select(start.gap.lt(L::ZERO), L::ZERO, ago)
    }
}
