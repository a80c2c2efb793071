//! Integrators: how a step of free flight on a uniform field is taken.
//!
//! All are composed of [`drift`] and [`kick`]; each is a type, so that a sweep
//! is compiled for it, and [`Integrator`] names it at run time.

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use crate::lane::Lane;
use crate::vec3::Vec3;

/// One step of length `Δt` in a uniform acceleration `a`.
///
/// ```
/// use carom::Integrator;
/// assert_eq!(Integrator::VelocityVerlet.to_string(), "velocity Verlet");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Integrator {
    /// [`SemiImplicitEuler`]: each step loses `Δt²|a|²m/2` of energy.
    SemiImplicitEuler,
    /// [`ExplicitEuler`]: each step gains `Δt²|a|²m/2`.
    ExplicitEuler,
    /// [`VelocityVerlet`]: the exact parabola.
    #[default]
    VelocityVerlet,
}

impl fmt::Display for Integrator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SemiImplicitEuler => "semi-implicit Euler",
            Self::ExplicitEuler => "explicit Euler",
            Self::VelocityVerlet => "velocity Verlet",
        })
    }
}

/// Position after flying with constant velocity: `c + vΔt`, length.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::integrator::drift;
/// assert_eq!(drift(Vec3::ZERO, Vec3::new(1.0, 0.0, 2.0), 0.5), Vec3::new(0.5, 0.0, 1.0));
/// ```
#[inline(always)]
pub fn drift<L: Lane>(position: Vec3<L>, velocity: Vec3<L>, dt: L) -> Vec3<L> {
    position + velocity * dt
}

/// Velocity after a constant acceleration: `v + aΔt`, length per time.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::integrator::kick;
/// assert_eq!(kick(Vec3::ZERO, Vec3::new(0.0, 0.0, -10.0), 0.5), Vec3::new(0.0, 0.0, -5.0));
/// ```
#[inline(always)]
pub fn kick<L: Lane>(velocity: Vec3<L>, acceleration: Vec3<L>, dt: L) -> Vec3<L> {
    velocity + acceleration * dt
}

/// A step of free flight as a type.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::integrator::{FlightStep, SemiImplicitEuler, VelocityVerlet};
///
/// /// The height after a second of fall in steps of 1/8 s.
/// fn height<I: FlightStep>() -> f64 {
///     let gravity = Vec3::new(0.0, 0.0, -8.0);
///     let mut state = (Vec3::ZERO, Vec3::ZERO);
///     for _ in 0..8 {
///         state = I::step(state.0, state.1, gravity, 0.125);
///     }
///     state.0.z
/// }
/// assert_eq!(height::<VelocityVerlet>(), -4.0);
/// assert_eq!(height::<SemiImplicitEuler>(), -4.5);
/// ```
pub trait FlightStep {
    /// Whether the step can change a velocity; if not, sweeps store none.
    const CHANGES_VELOCITY: bool = true;

    /// The velocity with which the centre moves through the step, length per time.
    fn mean_velocity<L: Lane>(velocity: Vec3<L>, acceleration: Vec3<L>, dt: L) -> Vec3<L>;

    /// Position and velocity a time `dt` later. Any sign and size of `dt` is
    /// valid; each component takes one rounding for each `+` and `×` of the
    /// formula.
    #[inline(always)]
    fn step<L: Lane>(
        position: Vec3<L>,
        velocity: Vec3<L>,
        acceleration: Vec3<L>,
        dt: L,
    ) -> (Vec3<L>, Vec3<L>) {
        let mean = Self::mean_velocity(velocity, acceleration, dt);
        let after =
            if Self::CHANGES_VELOCITY { kick(velocity, acceleration, dt) } else { velocity };
        (drift(position, mean, dt), after)
    }
}

/// No field: `c += vΔt`. The acceleration is not read.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::integrator::{Coasting, FlightStep};
/// let gravity = Vec3::new(0.0, 0.0, -8.0);
/// let (c, v) = Coasting::step(Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), gravity, 0.5);
/// assert_eq!(c, Vec3::new(1.0, 0.0, 0.0));
/// assert_eq!(v, Vec3::new(2.0, 0.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coasting;

impl FlightStep for Coasting {
    const CHANGES_VELOCITY: bool = false;

    #[inline(always)]
    fn mean_velocity<L: Lane>(velocity: Vec3<L>, _: Vec3<L>, _: L) -> Vec3<L> {
        velocity
    }
}

/// Velocity first: `v += aΔt; c += vΔt`.
///
/// On a uniform field `E_n = E_0 − nΔt²|a|²m/2`: the method keeps a neighbour
/// of the energy exactly (Hairer, Lubich and Wanner, *Geometric Numerical
/// Integration*, I.1).
///
/// ```
/// use carom::motion::integrator::{FlightStep, SemiImplicitEuler};
/// use carom::vec3::Vec3;
/// let gravity = Vec3::new(0.0, 0.0, -10.0);
/// let (c, v) = SemiImplicitEuler::step(Vec3::ZERO, Vec3::new(1.0, 0.0, 0.0), gravity, 0.5);
/// assert_eq!(v, Vec3::new(1.0, 0.0, -5.0));
/// assert_eq!(c, Vec3::new(0.5, 0.0, -2.5));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SemiImplicitEuler;

impl FlightStep for SemiImplicitEuler {
    #[inline(always)]
    fn mean_velocity<L: Lane>(velocity: Vec3<L>, acceleration: Vec3<L>, dt: L) -> Vec3<L> {
        kick(velocity, acceleration, dt)
    }
}

/// Position first: `c += vΔt; v += aΔt`.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::integrator::{ExplicitEuler, FlightStep};
/// let gravity = Vec3::new(0.0, 0.0, -8.0);
/// let (c, v) = ExplicitEuler::step(Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), gravity, 0.5);
/// assert_eq!(c, Vec3::new(1.0, 0.0, 0.0));
/// assert_eq!(v, Vec3::new(2.0, 0.0, -4.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExplicitEuler;

impl FlightStep for ExplicitEuler {
    #[inline(always)]
    fn mean_velocity<L: Lane>(velocity: Vec3<L>, _: Vec3<L>, _: L) -> Vec3<L> {
        velocity
    }
}

/// `c += vΔt + ½aΔt²; v += aΔt`, as a drift with the mean velocity
/// `v + ½aΔt`.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::integrator::{FlightStep, VelocityVerlet};
/// let gravity = Vec3::new(0.0, 0.0, -8.0);
/// let (c, v) = VelocityVerlet::step(Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0), gravity, 0.5);
/// assert_eq!(c, Vec3::new(1.0, 0.0, -1.0));
/// assert_eq!(v, Vec3::new(2.0, 0.0, -4.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VelocityVerlet;

impl FlightStep for VelocityVerlet {
    #[inline(always)]
    fn mean_velocity<L: Lane>(velocity: Vec3<L>, acceleration: Vec3<L>, dt: L) -> Vec3<L> {
        kick(velocity, acceleration, dt * L::ratio(1, 2))
    }
}
