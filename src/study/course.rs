//! Course: a run from its start to its end, in stretches between which others may
//! look at it.

use crate::engine::{EngineError, Listener, World};
use crate::real::Real;

/// Into how many parts the duration of an event-driven run is divided: a stretch
/// of one is over after such a part, or after one collision.
const PARTS: f64 = 1_048_576.0;

/// How far a run goes, in steps of a stepped world or in time of an event-driven
/// one.
///
/// ```
/// use carom::engine::{Execution, World};
/// use carom::scene::SceneFile;
/// use carom::study::Course;
///
/// let scene = SceneFile::builtin("superball").ok_or("no such scene")?.build::<f64>()?;
/// let mut world = World::new(scene, Execution::default())?;
/// let course = Course::new(&world, 1.0);
/// while !course.advance(&mut world, course.length(), 1000, None)? {
///     println!("{:.0} % done", 100.0 * course.done(&world));
/// }
/// assert!((world.time() - 1.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    length: f64,
}

impl Course {
    /// A run of this duration: the whole number of steps nearest to it, at least
    /// one, or the time itself. A checked scene has no more steps than can be
    /// counted.
    #[must_use]
    pub fn new<T: Real>(world: &World<T>, duration: f64) -> Self {
        let length = match world {
            World::Stepped(world) => (duration / world.exact_dt()).round().max(1.0),
            World::EventDriven(_) => duration,
        };
        Self { length }
    }

    /// How long it is, in steps or in time.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// How far a world is, in steps or in time.
    #[must_use]
    pub fn position<T: Real>(world: &World<T>) -> f64 {
        match world {
            World::Stepped(world) => world.steps() as f64,
            World::EventDriven(world) => world.time(),
        }
    }

    /// The part of it that a world has done, 0 to 1.
    #[must_use]
    pub fn done<T: Real>(&self, world: &World<T>) -> f64 {
        Self::position(world) / self.length
    }

    /// Where a world is after a time that is at least one step, in steps or in time.
    #[must_use]
    pub fn after<T: Real>(&self, world: &World<T>, time: f64) -> f64 {
        match world {
            World::Stepped(world) => {
                world.steps() as f64 + (time / world.exact_dt()).floor().max(1.0)
            }
            World::EventDriven(world) => world.time() + time,
        }
    }

    /// Goes on towards `mark`, in steps or in time, and returns whether the world is
    /// there. A `stretch` is a number of steps, or of collisions, or of small parts
    /// of the course without any: a world where much happens comes back too.
    ///
    /// # Errors
    /// Of the event-driven engine, see
    /// [`advance_about`](crate::EventDriven::advance_about).
    pub fn advance<T: Real>(
        &self,
        world: &mut World<T>,
        mark: f64,
        stretch: u64,
        on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        match world {
            World::Stepped(world) => {
                let left = (mark - world.steps() as f64).ceil() as u64;
                let steps = stretch.min(left);
                world.go(steps, on_event)?;
                Ok(steps == left)
            }
            World::EventDriven(world) => {
                let end = world.time() + self.length * (stretch as f64 / PARTS);
                let is_last = end >= mark;
                let end = if is_last { mark } else { end };
                Ok(world.advance_about(end, stretch, on_event)? && is_last)
            }
        }
    }

    /// Goes on to `mark`.
    ///
    /// # Errors
    /// As [`advance`](Course::advance).
    pub fn finish<T: Real>(
        &self,
        world: &mut World<T>,
        mark: f64,
        mut on_event: Listener<'_, T>,
    ) -> Result<(), EngineError> {
        /// Long enough to cost nothing.
        const STRETCH: u64 = 1 << 20;
        loop {
            let listener: Listener<'_, T> = match &mut on_event {
                None => None,
                Some(on_event) => Some(&mut **on_event),
            };
            if self.advance(world, mark, STRETCH, listener)? {
                return Ok(());
            }
        }
    }
}
