//! World: a scene in motion, by whichever engine moves it.

use super::{Collisions, Compiled, EngineError, Event, EventDriven, Execution, Plan, Stepped};
use crate::bodies::Bodies;
use crate::real::Real;
use crate::scene::{EngineKind, Scene};
use crate::vec3::Vec3;

/// A scene in motion, by the engine that it names.
///
/// ```
/// use carom::engine::{Execution, World};
/// use carom::scene::SceneFile;
///
/// let scene = SceneFile::builtin("superball").ok_or("no such scene")?.build::<f64>()?;
/// let mut world = World::new(scene, Execution::default())?;
/// world.for_each_event(0.5, |event| println!("sphere {} at {}", event.a, event.time))?;
/// assert!(world.collisions().total() > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub enum World<T: Real> {
    /// In steps.
    Stepped(Stepped<T>),
    /// From collision to collision.
    EventDriven(EventDriven<T>),
}

impl<T: Compiled> World<T> {
    /// A scene at its start.
    ///
    /// # Errors
    /// Those of the engines' own `with_execution`.
    pub fn new(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        Ok(match scene.engine {
            EngineKind::Stepped => Self::Stepped(Stepped::with_execution(scene, execution)?),
            EngineKind::EventDriven => {
                Self::EventDriven(EventDriven::with_execution(scene, execution)?)
            }
        })
    }
}

impl<T: Real> World<T> {
    /// What the scene needs.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        match self {
            Self::Stepped(world) => world.plan(),
            Self::EventDriven(world) => world.plan(),
        }
    }

    /// The bodies now.
    #[must_use]
    pub fn bodies(&self) -> Bodies<T> {
        match self {
            Self::Stepped(world) => world.bodies(),
            Self::EventDriven(world) => world.bodies(),
        }
    }

    /// The uniform acceleration, length per time².
    #[must_use]
    pub fn gravity(&self) -> Vec3<T> {
        match self {
            Self::Stepped(world) => world.gravity(),
            Self::EventDriven(world) => world.gravity(),
        }
    }

    /// Time since the start.
    #[must_use]
    pub fn time(&self) -> f64 {
        match self {
            Self::Stepped(world) => world.time(),
            Self::EventDriven(world) => world.time(),
        }
    }

    /// Steps taken.
    #[must_use]
    pub fn steps(&self) -> u64 {
        match self {
            Self::Stepped(world) => world.steps(),
            Self::EventDriven(_) => 0,
        }
    }

    /// Collisions since the start.
    #[must_use]
    pub fn collisions(&self) -> Collisions {
        match self {
            Self::Stepped(world) => world.collisions(),
            Self::EventDriven(world) => world.collisions(),
        }
    }

    /// Lets time pass: the whole number of steps nearest to the duration, or the
    /// duration itself.
    ///
    /// # Errors
    /// Those of the engine's own `advance`.
    pub fn advance(&mut self, duration: f64) -> Result<(), EngineError> {
        match self {
            Self::Stepped(world) => world.advance(duration),
            Self::EventDriven(world) => world.advance(duration),
        }
    }

    /// [`advance`](World::advance), and reports every collision on the way, in order
    /// of time.
    ///
    /// # Errors
    /// As [`advance`](World::advance).
    pub fn for_each_event(
        &mut self,
        duration: f64,
        on_event: impl FnMut(&Event<T>),
    ) -> Result<(), EngineError> {
        match self {
            Self::Stepped(world) => world.for_each_event(duration, on_event),
            Self::EventDriven(world) => world.for_each_event(duration, on_event),
        }
    }

    /// The impulse of the surroundings on the bodies so far, mass × length per
    /// time.
    #[must_use]
    pub fn impulse_from_surroundings(&self) -> [f64; 3] {
        match self {
            Self::Stepped(world) => world.impulse_from_surroundings(),
            Self::EventDriven(world) => world.impulse_from_surroundings(),
        }
    }

    /// `Σ σ|J_n|` over the pair collisions so far, mass × length² per time.
    #[must_use]
    pub fn virial(&self) -> f64 {
        match self {
            Self::Stepped(world) => world.virial(),
            Self::EventDriven(world) => world.virial(),
        }
    }

    /// Mean length of the flights between collisions, where the engine knows it.
    #[must_use]
    pub fn mean_free_path(&self) -> Option<f64> {
        match self {
            Self::Stepped(_) => None,
            Self::EventDriven(world) => world.mean_free_path(),
        }
    }

    /// The bytes that it holds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::Stepped(world) => world.bytes(),
            Self::EventDriven(world) => world.bytes(),
        }
    }
}
