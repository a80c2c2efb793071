//! Method: how a scene is moved, as far as its result depends on it.

use core::fmt;

use serde::{Deserialize, Serialize};

use crate::motion::Integrator;
use crate::scene::{Buildable, EngineKind, Impact};
use crate::scene::{Precision, Scene, SceneError, SceneFile};

/// How the stepped engine goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stepping {
    /// How a step of free flight is taken.
    pub integrator: Integrator,
    /// Where inside a step a contact takes effect.
    pub impact: Impact,
    /// Length of a step, in the scene's unit of time.
    pub dt: f64,
}

/// An engine with its settings, and the numbers that it computes in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Method {
    /// In which numbers.
    pub precision: Precision,
    /// In steps; `None` from collision to collision.
    pub stepping: Option<Stepping>,
}

/// Methods that differ in the length of a step only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Family {
    /// In which numbers.
    pub precision: Precision,
    /// Integrator and impact of the stepped engine.
    pub stepping: Option<(Integrator, Impact)>,
}

impl Method {
    /// Which methods it belongs to.
    #[must_use]
    pub fn family(&self) -> Family {
        let stepping = self.stepping.map(|stepping| (stepping.integrator, stepping.impact));
        Family { precision: self.precision, stepping }
    }

    /// Whether it is what all others are measured by.
    pub(super) fn is_reference(&self) -> bool {
        self.precision == Precision::DoubleDouble && self.stepping.is_none()
    }

    /// What its point is called: with all digits of its step.
    pub(super) fn key(&self) -> String {
        match self.stepping {
            None => self.family().to_string(),
            Some(Stepping { dt, .. }) => format!("{}, Δt {dt:e}", self.family()),
        }
    }

    /// A scene that is moved in this way up to a time. `T` has to be the
    /// method's own precision, or the reference's.
    pub(super) fn scene<T: Buildable>(
        &self,
        file: &SceneFile,
        end: f64,
    ) -> Result<Scene<T>, SceneError> {
        let mut file = file.clone();
        file.duration = Some(end);
        file.engine = match self.stepping {
            None => EngineKind::EventDriven,
            Some(stepping) => {
                file.dt = Some(stepping.dt);
                EngineKind::Stepped
            }
        };
        let mut scene = file.build::<T>()?;
        if let Some(Stepping { integrator, impact, .. }) = self.stepping {
            scene.stepped.integrator = integrator;
            scene.stepped.impact = impact;
        }
        Ok(scene)
    }

    /// The time at which its state is compared with the truth: a stated one, or
    /// the end of the step that is nearest to it.
    pub(super) fn time_near(&self, stated: f64) -> f64 {
        match self.stepping {
            None => stated,
            Some(Stepping { dt, .. }) => {
                let time = (stated / dt).round().max(1.0) * dt;
                // Steps that should end there do, but for a rounding.
                let is_there = self.precision != Precision::DoubleDouble
                    && (time - stated).abs() <= 4.0 * f64::EPSILON * stated;
                if is_there { stated } else { time }
            }
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.family().fmt(f)?;
        match self.stepping {
            None => Ok(()),
            Some(Stepping { dt, .. }) => write!(f, ", Δt {dt:.3e}"),
        }
    }
}

impl Family {
    /// How it moves, whatever the precision.
    pub(super) fn way(&self) -> String {
        match self.stepping {
            None => "event-driven".to_owned(),
            Some((integrator, Impact::EndOfStep)) => format!("{integrator}, end of step"),
            Some((integrator, Impact::SubStep)) => format!("{integrator}, sub-step"),
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.way(), self.precision)
    }
}
