//! World: a scene in motion, by whichever engine moves it.

use super::{Collisions, Compiled, EngineError, EventDriven, Execution, Listener, Plan, Stepped};
use crate::bodies::Bodies;
use crate::real::Real;
use crate::scene::{EngineKind, Scene};
use crate::vec3::Vec3;

/// Into how many parts the duration of an event-driven run is divided: a stretch
/// of one is over after such a part, or after one collision.
const PARTS: f64 = 1_048_576.0;

/// A scene in motion, by the engine that it names. How far it is, is told in
/// steps or in time.
///
/// ```
/// use carom::engine::{Execution, World};
/// use carom::scene::SceneFile;
///
/// let scene = SceneFile::builtin("superball").ok_or("no such scene")?.build::<f64>()?;
/// let mut world = World::new(scene, Execution::default())?;
/// let length = world.length(1.0);
/// while !world.advance(length, length, 1000, None)? {
///     println!("{} collisions up to {}", world.collisions().total(), world.time());
/// }
/// assert!((world.time() - 1.0).abs() < 1e-3);
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

    /// How far a run of this duration goes: the whole number of steps nearest to
    /// it, at least one, or the time itself. A checked scene has no more steps
    /// than can be counted.
    #[must_use]
    pub fn length(&self, duration: f64) -> f64 {
        match self {
            Self::Stepped(world) => (duration / world.exact_dt()).round().max(1.0),
            Self::EventDriven(_) => duration,
        }
    }

    /// How far the world is.
    #[must_use]
    pub fn place(&self) -> f64 {
        match self {
            Self::Stepped(world) => world.steps() as f64,
            Self::EventDriven(world) => world.time(),
        }
    }

    /// Goes on towards `mark` on a way of the given length, and returns whether
    /// it is there. A `stretch` is so many steps, or collisions, or parts of the
    /// way without any: a world where much happens comes back too.
    ///
    /// # Errors
    /// Of the event-driven engine, see
    /// [`advance_to`](EventDriven::advance_to).
    pub fn advance(
        &mut self,
        mark: f64,
        length: f64,
        stretch: u64,
        on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        match self {
            Self::Stepped(world) => {
                let left = (mark - world.steps() as f64).ceil() as u64;
                let steps = stretch.min(left);
                world.take_steps(steps, on_event);
                Ok(steps == left)
            }
            Self::EventDriven(world) => {
                let end = world.time() + length * (stretch as f64 / PARTS);
                let is_last = end >= mark;
                let end = if is_last { mark } else { end };
                Ok(world.advance_to(end, stretch, on_event)? && is_last)
            }
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
