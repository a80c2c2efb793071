//! Clock: variants of one task, timed in turn.
//!
//! A machine has quick and slow minutes. What is to be compared is run in
//! rounds, each variant once a round, so that a slow minute falls on all.

use std::hint::black_box;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::fit::quantile;
use super::{Course, StudyError};
use crate::engine::{EngineError, World};
use crate::real::Real;

/// The times of one variant, seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Half of the runs took less.
    pub median: f64,
    /// A quarter of the runs took less.
    pub lower_quartile: f64,
    /// A quarter of the runs took more.
    pub upper_quartile: f64,
    /// Each run, round by round.
    pub runs: Vec<f64>,
}

impl Timing {
    /// Of some runs, seconds each; NaN of none.
    #[must_use]
    pub fn of(runs: Vec<f64>) -> Self {
        Self {
            median: quantile(&runs, 0.5),
            lower_quartile: quantile(&runs, 0.25),
            upper_quartile: quantile(&runs, 0.75),
            runs,
        }
    }

    /// How many times as long as another variant in the same rounds: the median
    /// and the quartiles of the ratios within a round, no longer seconds.
    ///
    /// ```
    /// use carom::study::clock::Timing;
    /// // The second round fell into a slow minute.
    /// let (one, other) = (Timing::of(vec![2.0, 9.0, 2.0]), Timing::of(vec![1.0, 3.0, 1.0]));
    /// assert_eq!(one.ratio_to(&other).median, 2.0);
    /// ```
    #[must_use]
    pub fn ratio_to(&self, other: &Self) -> Self {
        Self::of(self.runs.iter().zip(&other.runs).map(|(one, other)| one / other).collect())
    }
}

/// A variant: runs once, and gives the seconds of what is to be timed, as
/// [`seconds`] measures them. What it does before and after is not timed.
pub type Variant<'a> = Box<dyn FnMut() -> Result<f64, StudyError> + 'a>;

/// What some work gives, and how long it takes, seconds.
pub fn seconds<R>(work: impl FnOnce() -> R) -> (R, f64) {
    let start = Instant::now();
    let result = black_box(work());
    (result, start.elapsed().as_secs_f64())
}

/// Times each variant in a number of rounds, there and back: the first variant
/// of one round is the last of the next. Nothing is run to warm up.
///
/// # Errors
/// The first one that a variant has.
///
/// ```
/// use carom::study::clock::{Variant, rounds, seconds};
///
/// let add: Variant = Box::new(|| Ok(seconds(|| (0..1000_u64).sum::<u64>()).1));
/// let sort: Variant = Box::new(|| {
///     let mut numbers: Vec<u64> = (0..1000).rev().collect();
///     Ok(seconds(|| numbers.sort()).1)
/// });
/// let timings = rounds(&mut [add, sort], 5)?;
/// assert!(timings[1].lower_quartile <= timings[1].median);
/// # Ok::<(), carom::study::StudyError>(())
/// ```
pub fn rounds(variants: &mut [Variant<'_>], rounds: usize) -> Result<Vec<Timing>, StudyError> {
    let mut runs = vec![Vec::with_capacity(rounds.min(1 << 10)); variants.len()];
    for round in 0..rounds {
        for nth in 0..variants.len() {
            let k = if round % 2 == 0 { nth } else { variants.len() - 1 - nth };
            runs[k].push(variants[k]()?);
        }
    }
    Ok(runs.into_iter().map(Timing::of).collect())
}

/// About how many seconds a world takes to the end of a course, by its first
/// `enough` seconds; the world is then somewhere on it.
///
/// # Errors
/// If the engine stops.
pub(super) fn outlook<T: Real>(
    world: &mut World<T>,
    course: Course,
    enough: f64,
) -> Result<f64, EngineError> {
    let start = Instant::now();
    let mut stretch = 1;
    loop {
        let is_there = course.advance(world, course.length(), stretch, None)?;
        let taken = start.elapsed().as_secs_f64();
        if is_there || taken > enough {
            return Ok(taken / course.done(world).max(1e-9));
        }
        stretch *= 2;
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use super::*;

    #[test]
    fn variants_take_turns() -> Result<(), StudyError> {
        let order = RefCell::new(Vec::new());
        let order = &order;
        let variant = |k: u32| -> Variant<'_> {
            Box::new(move || {
                order.borrow_mut().push(k);
                Ok(f64::from(k) * order.borrow().len() as f64)
            })
        };
        let timings = rounds(&mut [variant(0), variant(1), variant(2)], 3)?;
        assert_eq!(*order.borrow(), [0, 1, 2, 2, 1, 0, 0, 1, 2]);
        assert_eq!(timings[1], Timing::of(vec![2.0, 5.0, 8.0]));
        assert_eq!(timings[1].median, 5.0);
        assert_eq!(timings[2].ratio_to(&timings[1]).runs, [3.0, 1.6, 2.25]);
        Ok(())
    }

    #[test]
    fn a_failed_run_ends_it() {
        let mut variants: [Variant<'_>; 1] = [Box::new(|| Err(StudyError::Asked("no".into())))];
        assert!(rounds(&mut variants, 2).is_err());
    }
}
