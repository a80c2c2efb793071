//! Pace: when something is due again and again on the way of a run that may go on from
//! where it was kept.

use carom::engine::World;
use carom::real::Real;
use carom::study::{Course, Schedule};
use serde::{Deserialize, Serialize};

/// When something is due.
#[derive(Debug)]
pub struct Pace {
    every: f64,
    schedule: Schedule,
}

/// What is to be remembered of it.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct KeptPace {
    every: f64,
    done: u64,
}

impl KeptPace {
    /// The time from one to the next.
    pub fn every(&self) -> f64 {
        self.every
    }

    /// Whether it has this time from one to the next.
    pub fn is_every(&self, every: f64) -> bool {
        self.every == every
    }
}

impl Pace {
    /// Every so much time from `start` on, after what was done at the same pace before,
    /// otherwise from where the world is.
    pub fn new<T: Real>(
        world: &World<T>,
        course: &Course,
        every: f64,
        start: f64,
        kept: Option<KeptPace>,
    ) -> Self {
        let schedule = Schedule::new(world, course, every).starting(start);
        let schedule = match kept.filter(|kept| kept.is_every(every)) {
            Some(kept) => schedule.after(kept.done),
            None => schedule.from(Course::position(world)),
        };
        Self { every, schedule }
    }

    /// Where it is due next.
    pub fn mark(&self) -> Option<f64> {
        self.schedule.mark()
    }

    /// Done at a place.
    pub fn pass(&mut self, position: f64) {
        self.schedule.pass(position);
    }

    /// What is to be remembered.
    pub fn kept(&self) -> KeptPace {
        KeptPace { every: self.every, done: self.schedule.done() }
    }
}
