//! Integrators: how a step of free flight on a uniform field is taken.

use serde::{Deserialize, Serialize};

/// One step of length `Δt` in a uniform acceleration `a`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Velocity first: `v += aΔt; c += vΔt`. Each step loses `Δt²|a|²m/2` of
    /// energy.
    #[default]
    SemiImplicitEuler,
    /// Position first: `c += vΔt; v += aΔt`. Each step gains `Δt²|a|²m/2`.
    ExplicitEuler,
    /// `c += vΔt + ½aΔt²; v += aΔt`: the exact parabola.
    VelocityVerlet,
}
