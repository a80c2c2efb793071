//! Settings: what a scene asks of numbers, surfaces, time and engines.

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use crate::motion::Integrator;
use crate::real::Real;

/// In which numbers a scene is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Precision {
    /// Single precision, 24 binary digits.
    F32,
    /// Double precision, 53 binary digits.
    #[default]
    F64,
}

impl Precision {
    /// What the scene file and the summary call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => f32::NAME,
            Self::F64 => f64::NAME,
        }
    }

    /// Distance from 1 to the next greater number.
    #[must_use]
    pub fn epsilon(self) -> f64 {
        match self {
            Self::F32 => f64::from(f32::EPSILON),
            Self::F64 => f64::EPSILON,
        }
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How an engine goes through time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum EngineKind {
    /// Steps of fixed length.
    Stepped,
    /// Every collision at its exact time.
    #[default]
    EventDriven,
}

/// What spheres can meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Encounters {
    /// Spheres meet each other and the surroundings.
    #[default]
    All,
    /// Spheres meet the surroundings only, and pass through each other.
    Surroundings,
    /// Spheres fly freely through everything.
    None,
}

/// What only the stepped engine asks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteppedSettings {
    /// Length of a step, time. The stepped engine needs it.
    pub dt: Option<f64>,
    /// How a step of free flight is taken.
    pub integrator: Integrator,
    /// Where inside a step a contact takes effect.
    pub impact: Impact,
    /// When orientations are brought up to date.
    pub orientation: OrientationUpdate,
    /// How positions and velocities are added up from step to step.
    pub summation: Summation,
}

/// Where inside a step of the stepped engine a contact takes effect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Impact {
    /// At the end of the step, where the bodies are found to overlap: the fastest way.
    /// A sphere in a field may sink into what it lies on.
    EndOfStep,
    /// At the time of impact inside the step: back to contact, impulse at the
    /// true normal, forward again.
    #[default]
    SubStep,
}

impl fmt::Display for Impact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::EndOfStep => "at the end of a step",
            Self::SubStep => "at their time within a step",
        })
    }
}

/// When orientations are brought up to date.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum OrientationUpdate {
    /// As a closed form of the last change of spin, when it is asked for.
    #[default]
    WhenAsked,
    /// `M ← R M` in each step.
    EachStep,
}

/// How the stepped engine adds up positions and velocities from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Summation {
    /// Compensated where steps are short beside the coordinates: less than `2²⁶`
    /// units in the last digit of these. In `f32` that is every scene, in `f64` few.
    #[default]
    Auto,
    /// Rounded in each step: a body that moves by less than half a unit in the last
    /// digit of its position stands still.
    Plain,
    /// What the rounding leaves out is added in the next step.
    Compensated,
}

/// The most bodies that a scene may have: one hundred million.
pub const MOST_BODIES: u64 = 100_000_000;

/// The most steps that a run may have: `2⁵³`, up to which their count is exact
/// in an `f64`.
pub const MOST_STEPS: f64 = 9_007_199_254_740_992.0;
