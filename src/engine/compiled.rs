//! Compiled: the precisions that engines are there for.

use super::frame::{Frame, Framed};
use super::interface::{EventEngine, StepEngine};
use super::{EngineError, Execution, event_driven, stepped};
#[cfg(feature = "study")]
use crate::real::DoubleDouble;
use crate::real::Real;
use crate::scene::Scene;

/// A precision that this crate has engines for.
///
/// They are compiled here once, so that a crate that runs them does not compile
/// them again.
pub trait Compiled: Real + sealed::Engines {}

pub(super) mod sealed {
    use super::{EngineError, EventEngine, Execution, Real, Scene, StepEngine};

    /// What makes the engines of a precision; not generic, so that it is compiled
    /// in this crate.
    pub trait Engines: Real {
        fn event_driven(scene: Scene<Self>, execution: Execution) -> Box<dyn EventEngine<Self>>;

        fn stepped(
            scene: Scene<Self>,
            execution: Execution,
        ) -> Result<Box<dyn StepEngine<Self>>, EngineError>;
    }
}

macro_rules! compile {
    ($($real:ty),*) => {$(
        impl Compiled for $real {}

        impl sealed::Engines for $real {
            fn event_driven(scene: Scene<Self>, execution: Execution) -> Box<dyn EventEngine<Self>> {
                let driver = |scene| event_driven::Driver::new(scene, execution);
                match Frame::of(&scene) {
                    None => Box::new(driver(scene)),
                    Some(frame) => Box::new(Framed { engine: driver(frame.enter(scene)), frame }),
                }
            }

            fn stepped(
                scene: Scene<Self>,
                execution: Execution,
            ) -> Result<Box<dyn StepEngine<Self>>, EngineError> {
                let driver = |scene| stepped::Driver::new(scene, execution);
                Ok(match Frame::of(&scene) {
                    None => Box::new(driver(scene)?),
                    Some(frame) => Box::new(Framed { engine: driver(frame.enter(scene))?, frame }),
                })
            }
        }
    )*};
}

compile!(f32, f64);
#[cfg(feature = "study")]
compile!(DoubleDouble);
