//! Clock: how far time is, and whether it advances.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::calendar::Turn;
use crate::compensated::CompensatedSum;
#[cfg(feature = "files")]
use crate::engine::snapshot::{Misfit, Reals};
#[cfg(feature = "files")]
use crate::numbers::array;
use crate::real::Real;

/// Turns that may pass while time stands still, for scenes of few bodies.
const PATIENCE: u64 = 1 << 20;

/// Periods in which nothing happens before they grow longer.
const IDLE: u32 = 16;

/// Time, counted from the start of the present period. A restart file keeps all
/// of it.
#[derive(Clone, Debug)]
pub(super) struct Clock<T> {
    /// The present period's start, time.
    origin: CompensatedSum,
    /// Length of the present period, time.
    pub period: T,
    /// The square of the speed from which the period is too long.
    pub too_fast: T,
    /// Time of the last collision in this period.
    pub last_collision: T,
    /// Time that has been asked for, since the start of the run.
    pub time: f64,
    /// Periods since the last one in which bodies collided.
    idle: u32,
    /// Turns taken in this period.
    pub turns: u64,
    /// Turns in a time of the last period that had any.
    turns_per_time: Option<f64>,
    /// Length of the next window; `None` in strict order of time.
    pub window: Option<T>,
    /// The longest that a window may be.
    pub longest_window: T,
    /// Time of the period up to which windows are worked off.
    pub worked_off: T,
    /// Time has advanced when it is past this one.
    progress: T,
    /// Turns since it did.
    standstill: u64,
}

/// What a snapshot keeps of a clock.
#[cfg(feature = "files")]
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct ClockState {
    origin: CompensatedSum,
    time: f64,
    idle: u32,
    turns: u64,
    standstill: u64,
    /// Period, square of the speed, last collision, progress.
    reals: Reals,
}

#[cfg(feature = "files")]
impl<T: Real> Clock<T> {
    /// What a snapshot keeps.
    pub fn save(&self) -> ClockState {
        let Self { origin, time, idle, turns, standstill, .. } = *self;
        let reals = Reals::of([self.period, self.too_fast, self.last_collision, self.progress]);
        ClockState { origin, time, idle, turns, standstill, reals }
    }

    /// The clock that a snapshot was taken of.
    pub fn restored(saved: &ClockState) -> Result<Self, Misfit> {
        let ClockState { origin, time, idle, turns, standstill, .. } = *saved;
        let reals: Vec<T> = saved.reals.read(4, "clock")?;
        let [period, too_fast, last_collision, progress] = array::from_fn(|k| reals[k]);
        Ok(Self {
            origin,
            period,
            too_fast,
            last_collision,
            time,
            idle,
            turns,
            turns_per_time: None,
            window: None,
            longest_window: T::ZERO,
            worked_off: last_collision,
            progress,
            standstill,
        })
    }
}

impl<T: Real> Clock<T> {
    /// The start of a run.
    pub fn new() -> Self {
        Self {
            origin: CompensatedSum::default(),
            period: T::ZERO,
            too_fast: T::ZERO,
            last_collision: T::ZERO,
            time: 0.0,
            idle: 0,
            turns: 0,
            turns_per_time: None,
            window: None,
            longest_window: T::ZERO,
            worked_off: T::ZERO,
            progress: T::ZERO,
            standstill: 0,
        }
    }

    /// Ends the present period at a time of it.
    pub fn end_period(&mut self, end: T) {
        let rounded = end.to_f64();
        self.origin.add(rounded);
        // What a finer precision than `f64` has besides.
        self.origin.add((end - T::from_f64(rounded)).to_f64());
        self.last_collision = T::ZERO;
        self.progress = T::ZERO;
        self.worked_off = T::ZERO;
        let turns = core::mem::take(&mut self.turns);
        if turns > 0 && end != T::ZERO {
            self.turns_per_time = Some(turns as f64 / end.to_f64());
        }
    }

    /// Turns in a time, if any were counted.
    pub fn turns_per_time(&self) -> Option<f64> {
        self.turns_per_time
    }

    /// How much longer than others the next period is, as a binary exponent: after a few
    /// in which nothing happens each is twice as long as the one before.
    pub fn idle_exponent(&mut self) -> u32 {
        let is_idle = self.last_collision == T::ZERO;
        self.idle = if is_idle { self.idle.saturating_add(1) } else { 0 };
        self.idle.saturating_sub(IDLE)
    }

    /// The present period's start, time since the start of the run.
    pub fn origin(&self) -> f64 {
        self.origin.value()
    }

    /// A time since the start of the run, as one since the start of the present
    /// period.
    pub fn in_period(&self, time: f64) -> T {
        T::from_f64(time - self.origin.value()) - T::from_f64(self.origin.remainder())
    }

    /// A time of the present period, as one since the start of the run.
    pub fn since_start(&self, time: T) -> f64 {
        self.origin.value() + time.to_f64()
    }

    /// The first time since the start of the run, but for rounding, that is not before
    /// a time of the present period: a world that is advanced to it has had all
    /// collisions up to that one.
    pub fn not_before(&self, time: T) -> f64 {
        let mut now = self.since_start(time);
        while self.in_period(now) < time {
            now = now.next_up();
        }
        now
    }

    /// Now, since the period's start.
    pub fn now(&self) -> T {
        self.in_period(self.time)
    }

    /// Counts a turn that is taken.
    #[inline(always)]
    pub fn count(&mut self) {
        self.turns += 1;
    }

    /// Whether time still advances, a few turns without any forgiven for each of
    /// the bodies; otherwise how many turns it has stood still.
    #[inline(always)]
    pub fn check_progress(&mut self, turn: Turn<T>, bodies: usize) -> Result<(), u64> {
        if turn.time > self.progress {
            self.progress = turn.time + self.period * (T::EPSILON * T::whole(64));
            self.standstill = 0;
            return Ok(());
        }
        self.standstill += 1;
        if self.standstill <= PATIENCE + 64 * bodies as u64 {
            return Ok(());
        }
        Err(self.standstill)
    }
}
