//! Totals: the conserved quantities of a state together.

use crate::bodies::Bodies;
use crate::observe::{AngularMomentum, Energy, Momentum};
use crate::real::Real;
use crate::vec3::Vec3;

/// What motion conserves, or changes by a known amount.
///
/// ```
/// use carom::observe::Totals;
/// use carom::{Bodies, Vec3};
///
/// let ball = Bodies::from_positions(&[[0.0, 2.0, 0.0]]).velocities(&[[3.0, 0.0, 0.0]]);
/// let totals = Totals::of(&ball.radius(0.5).build()?, Vec3::ZERO);
/// assert_eq!(totals.energy.total(), 4.5);
/// assert_eq!(totals.momentum.0.x, 3.0);
/// assert_eq!(totals.angular_momentum.0.z, -6.0);
/// assert!(totals.is_finite());
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
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
