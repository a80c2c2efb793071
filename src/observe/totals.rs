//! Totals: the conserved quantities of a state together.

use crate::bodies::Bodies;
use crate::observe::{AngularMomentum, Energy, Momentum};
use crate::real::Real;
use crate::vec3::Vec3;

/// What motion conserves, or changes by a known amount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals {
    /// Energy, mass × length² per time².
    pub energy: Energy,
    /// Momentum, mass × length per time.
    pub momentum: Momentum,
    /// Angular momentum about the origin, mass × length² per time.
    pub angular_momentum: AngularMomentum,
}

impl Totals {
    /// The totals of bodies in a uniform field of acceleration `gravity`.
    #[must_use]
    pub fn of<T: Real>(bodies: &Bodies<T>, gravity: Vec3<T>) -> Self {
        Self {
            energy: Energy::of(bodies, gravity),
            momentum: Momentum::of(bodies),
            angular_momentum: AngularMomentum::of(bodies),
        }
    }

    /// Whether every figure is a number: neither infinite nor NaN.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let vectors = [self.momentum.0, self.angular_momentum.0];
        let mut figures = vectors.into_iter().flat_map(|vector| vector.to_array());
        self.energy.total().is_finite() && figures.all(f64::is_finite)
    }
}
