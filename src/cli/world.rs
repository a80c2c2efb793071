//! World: a scene in motion, by whichever engine moves it.

use carom::bodies::Bodies;
use carom::engine::{
    Collisions, EngineError, EngineKind, EventDriven, Execution, Listener, Plan, Stepped,
};
use carom::output::Work;
use carom::real::Real;
use carom::scene::Scene;

/// Into how many parts the duration of an event-driven run is divided: a stretch
/// of one is over after such a part, or after one collision.
const PARTS: f64 = 1_048_576.0;

/// A scene in motion. How far it is, is told in steps or in time.
pub enum World<T: Real> {
    Stepped(Stepped<T>),
    EventDriven(EventDriven<T>),
}

impl<T: Real> World<T> {
    /// A scene at its start, with the engine that it names.
    pub fn new(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        Ok(match scene.engine {
            EngineKind::Stepped => Self::Stepped(Stepped::with_execution(scene, execution)?),
            EngineKind::EventDriven => {
                Self::EventDriven(EventDriven::with_execution(scene, execution)?)
            }
        })
    }

    /// What the scene needs.
    pub fn plan(&self) -> &Plan {
        match self {
            Self::Stepped(world) => world.plan(),
            Self::EventDriven(world) => world.plan(),
        }
    }

    /// The bodies now.
    pub fn bodies(&self) -> Bodies<T> {
        match self {
            Self::Stepped(world) => world.bodies(),
            Self::EventDriven(world) => world.bodies(),
        }
    }

    /// Time since the start.
    pub fn time(&self) -> f64 {
        match self {
            Self::Stepped(world) => world.time(),
            Self::EventDriven(world) => world.time(),
        }
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        match self {
            Self::Stepped(world) => world.steps(),
            Self::EventDriven(_) => 0,
        }
    }

    /// Collisions since the start.
    pub fn collisions(&self) -> Collisions {
        match self {
            Self::Stepped(world) => world.collisions(),
            Self::EventDriven(world) => world.collisions(),
        }
    }

    /// How far a run of this duration goes: the whole number of steps nearest to
    /// it, at least one, or the time itself. A checked scene has no more steps
    /// than can be counted.
    pub fn length(&self, duration: f64) -> f64 {
        match self {
            Self::Stepped(world) => (duration / world.exact_dt()).round().max(1.0),
            Self::EventDriven(_) => duration,
        }
    }

    /// How far the world is.
    pub fn place(&self) -> f64 {
        match self {
            Self::Stepped(world) => world.steps() as f64,
            Self::EventDriven(world) => world.time(),
        }
    }

    /// Goes on towards `mark` on a way of the given length, and returns whether
    /// it is there. A `stretch` is so many steps, or collisions, or parts of the
    /// way without any: a world where much happens comes back too.
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
                match on_event {
                    None => world.advance_steps(steps),
                    Some(on_event) => (0..steps).for_each(|_| world.step_with(on_event)),
                }
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

    /// What the engine has done, but for what only the run knows.
    pub fn work(&self) -> Work {
        let (impulse_from_surroundings, virial, mean_free_path) = match self {
            Self::Stepped(world) => (world.impulse_from_surroundings(), world.virial(), None),
            Self::EventDriven(world) => {
                (world.impulse_from_surroundings(), world.virial(), world.mean_free_path())
            }
        };
        Work {
            time: self.time(),
            steps: self.steps(),
            collisions: self.collisions(),
            impulse_from_surroundings,
            virial,
            mean_free_path,
            mean_temperature: None,
            wall_seconds: 0.0,
        }
    }
}
