//! Schedule: when something is due again and again on a course.

use super::Course;
use crate::engine::World;
use crate::real::Real;

/// What is due at the start and then every so much time: of an event-driven world at
/// exactly that time, of a stepped one after the step whose end is at it or next behind
/// it.
///
/// ```
/// use carom::engine::{Execution, World};
/// use carom::scene::SceneFile;
/// use carom::study::{Course, Schedule};
///
/// let scene = SceneFile::builtin("superball").ok_or("no such scene")?.build::<f64>()?;
/// let mut world = World::new(scene, Execution::default())?;
/// let course = Course::new(&world, 1.0);
/// let mut schedule = Schedule::new(&world, &course, 0.25);
/// let mut times = Vec::new();
/// while let Some(mark) = schedule.mark() {
///     course.finish(&mut world, mark, None)?;
///     times.push(world.time());
///     schedule.pass(mark);
/// }
/// assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    every: f64,
    /// Time of the first.
    start: f64,
    /// Length of a step; `None` without steps.
    step: Option<f64>,
    length: f64,
    next: u64,
}

/// Times that differ by less than this part are one: a product of a whole number and
/// an interval is rounded.
const ROUNDING: f64 = 1e-9;

impl Schedule {
    /// Every so much time on a course, from its start to its end.
    #[must_use]
    pub fn new<T: Real>(world: &World<T>, course: &Course, every: f64) -> Self {
        let step = match world {
            World::Stepped(world) => Some(world.exact_dt()),
            World::EventDriven(_) => None,
        };
        Self { every, start: 0.0, step, length: course.length(), next: 0 }
    }

    /// The same, with the first at another time than the start of the run.
    #[must_use]
    pub fn starting(self, start: f64) -> Self {
        Self { start, ..self }
    }

    /// Where it is due next, in steps or in time; `None` if that is not on the course.
    #[must_use]
    pub fn mark(&self) -> Option<f64> {
        let mark = self.position(self.next);
        (mark <= self.length).then_some(mark)
    }

    /// Done at a place, and whatever else was due up to there.
    pub fn pass(&mut self, position: f64) {
        self.skip(position, |due| due <= position);
    }

    /// The same where nothing before a place is due any more.
    #[must_use]
    pub fn from(mut self, position: f64) -> Self {
        self.skip(position, |due| due < position);
        self
    }

    /// Passes over what is due about a place as long as it counts as done.
    fn skip(&mut self, position: f64, is_done: impl Fn(f64) -> bool) {
        let time = position * self.step.unwrap_or(1.0);
        self.next = self.next.max(((time - self.start) / self.every) as u64);
        while is_done(self.position(self.next)) {
            self.next += 1;
        }
    }

    /// How often it was due and done.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.next
    }

    /// The same where it was done this often before.
    #[must_use]
    pub fn after(self, done: u64) -> Self {
        Self { next: done, ..self }
    }

    fn position(&self, number: u64) -> f64 {
        let time = self.start + number as f64 * self.every;
        let position = match self.step {
            None => time,
            Some(step) => {
                let steps = time / step;
                let nearest = steps.round();
                let is_at = (steps - nearest).abs() <= ROUNDING * nearest;
                if is_at { nearest } else { steps.ceil() }
            }
        };
        let is_end = (position - self.length).abs() <= ROUNDING * self.length;
        if is_end { self.length } else { position }
    }
}
