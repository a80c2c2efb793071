//! Clock: variants of one task, timed in turn.
//!
//! A machine has quick and slow minutes, and other programs. So each variant is run once to
//! warm up; what is quick is run several times a sample, since a clock has a grain; samples
//! are taken in rounds, each variant once a round, so that a slow minute falls on all; and
//! rounds go on while medians are uncertain.

use std::hint::black_box;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::fit::quantile;
use super::{Course, StudyError};
use crate::engine::{EngineError, World};
use crate::real::Real;

/// The least that a sample takes, seconds.
const SAMPLE: f64 = 0.005;

/// What runs so long is a sample even if it is the first: nothing has to warm up, seconds.
const LONG: f64 = 0.1;

/// The most rounds that are run, over those asked for.
const MOST_ROUNDS: usize = 3;

/// Up to this share of itself on either side a median is as good as known.
const SHARP: f64 = 0.02;

/// From this share on it is uncertain.
const UNCERTAIN: f64 = 0.1;

/// The times of one variant, seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Half of the samples took less.
    pub median: f64,
    /// A quarter of the samples took less.
    pub lower_quartile: f64,
    /// A quarter of the samples took more.
    pub upper_quartile: f64,
    /// What a run took in each sample, round by round.
    pub runs: Vec<f64>,
}

impl Timing {
    /// Of some samples, seconds a run; NaN of none.
    #[must_use]
    pub fn of(runs: Vec<f64>) -> Self {
        Self {
            median: quantile(&runs, 0.5),
            lower_quartile: quantile(&runs, 0.25),
            upper_quartile: quantile(&runs, 0.75),
            runs,
        }
    }

    /// Between which two samples the median of all runs that could be made lies, with a
    /// probability of 95 %; the least and the greatest of fewer than six samples, where it
    /// is up to 94 %. By ranks (Conover 1999, chapter 3.2): whatever the distribution.
    ///
    /// ```
    /// use carom::study::clock::Timing;
    /// let times = (1..=11).map(f64::from).collect();
    /// assert_eq!(Timing::of(times).interval(), [2.0, 10.0]);
    /// ```
    #[must_use]
    pub fn interval(&self) -> [f64; 2] {
        let mut sorted = self.runs.clone();
        sorted.sort_by(f64::total_cmp);
        let Some(last) = sorted.len().checked_sub(1) else { return [f64::NAN; 2] };
        let rank = rank_below_median(sorted.len());
        [sorted[rank], sorted[last - rank]]
    }

    /// Half of the [interval](Self::interval), as a share of the median.
    ///
    /// ```
    /// use carom::study::clock::Timing;
    /// assert_eq!(Timing::of(vec![0.5, 1.0, 1.25]).uncertainty(), 0.375);
    /// ```
    #[must_use]
    pub fn uncertainty(&self) -> f64 {
        let [low, high] = self.interval();
        (high - low) / 2.0 / self.median
    }

    /// Whether the median is uncertain by more than a tenth.
    ///
    /// ```
    /// use carom::study::clock::Timing;
    /// assert!(Timing::of(vec![1.0, 1.0, 9.0]).is_uncertain());
    /// ```
    #[must_use]
    pub fn is_uncertain(&self) -> bool {
        // A time of zero, below the grain of the clock, says nothing either.
        let uncertainty = self.uncertainty();
        uncertainty > UNCERTAIN || uncertainty.is_nan()
    }

    /// Samples that something else has slowed down: beyond the upper quartile by more than
    /// three times the distance of the quartiles (Tukey 1977).
    ///
    /// ```
    /// use carom::study::clock::Timing;
    /// assert_eq!(Timing::of(vec![1.0, 1.1, 1.2, 1.1, 1.0, 9.0]).outliers(), 1);
    /// ```
    #[must_use]
    pub fn outliers(&self) -> usize {
        let fence = self.upper_quartile + 3.0 * (self.upper_quartile - self.lower_quartile);
        self.runs.iter().filter(|run| **run > fence).count()
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

/// The greatest rank, from 0, at or below which the median of a distribution is with a
/// probability of no more than 1/40, among that number of samples; 0 at least.
fn rank_below_median(samples: usize) -> usize {
    let len = samples as f64;
    if samples > 100 {
        // By the normal distribution: powers of a half leave the range of numbers.
        return (len / 2.0 - 0.98 * len.sqrt()) as usize - 1;
    }
    let mut chance = 0.5_f64.powi(samples as i32);
    let (mut sum, mut rank) = (chance, 0);
    loop {
        chance *= (len - rank as f64) / (rank + 1) as f64;
        sum += chance;
        if sum > 1.0 / 40.0 {
            return rank;
        }
        rank += 1;
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

/// Times each variant in at least a number of rounds, there and back: the first variant
/// of one round is the last of the next.
///
/// All are run once before, to warm up; where all of them take long, that is the first round. A
/// sample is as many runs as the quickest variant needs for 5 ms. Rounds are added, up to
/// three times as many, for each with an outlier in it, and while a median is not known to
/// 2 %. All variants run equally often.
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
pub fn rounds(variants: &mut [Variant<'_>], least: usize) -> Result<Vec<Timing>, StudyError> {
    let first = variants.iter_mut().map(|variant| variant()).collect::<Result<Vec<_>, _>>()?;
    let quickest = first.iter().copied().fold(f64::INFINITY, f64::min);
    let repeats = (SAMPLE / quickest.max(1e-7)).ceil().max(1.0) as u32;
    let is_sample = quickest >= LONG;
    let mut runs: Vec<Vec<f64>> =
        first.into_iter().map(|time| if is_sample { vec![time] } else { Vec::new() }).collect();
    let mut round = usize::from(is_sample);
    let mut wanted = least;
    while round < wanted {
        for nth in 0..variants.len() {
            let k = if round % 2 == 0 { nth } else { variants.len() - 1 - nth };
            let sum =
                (0..repeats).try_fold(0.0, |sum, _| Ok::<_, StudyError>(sum + variants[k]()?))?;
            runs[k].push(sum / f64::from(repeats));
        }
        round += 1;
        if round == wanted {
            wanted = more_rounds(&runs, least).clamp(wanted, least.saturating_mul(MOST_ROUNDS));
        }
    }
    Ok(runs.into_iter().map(Timing::of).collect())
}

/// How many rounds are needed, by what was measured in those that were.
fn more_rounds(runs: &[Vec<f64>], least: usize) -> usize {
    let timings: Vec<_> = runs.iter().cloned().map(Timing::of).collect();
    let outliers = timings.iter().map(Timing::outliers).max().unwrap_or(0);
    let done = runs.first().map_or(0, Vec::len);
    // One sample says nothing of its uncertainty, and is what was asked for.
    let is_sharp = |timing: &Timing| least < 2 || timing.uncertainty() <= SHARP;
    let for_sharpness = if timings.iter().all(is_sharp) { done } else { done + 1 };
    (least + outliers).max(for_sharpness)
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
                Ok(f64::from(k + 1))
            })
        };
        // What takes long has its first sample from the first run.
        let timings = rounds(&mut [variant(0), variant(1), variant(2)], 3)?;
        assert_eq!(*order.borrow(), [0, 1, 2, 2, 1, 0, 0, 1, 2]);
        assert_eq!(timings[1], Timing::of(vec![2.0; 3]));
        assert_eq!(timings[2].ratio_to(&timings[1]).runs, [1.5; 3]);
        Ok(())
    }

    #[test]
    fn what_is_quick_is_run_often() -> Result<(), StudyError> {
        let (quick, slow) = (RefCell::new(0), RefCell::new(0));
        let mut variants: [Variant<'_>; 2] = [
            Box::new(|| {
                *quick.borrow_mut() += 1;
                Ok(0.000_2)
            }),
            Box::new(|| {
                *slow.borrow_mut() += 1;
                Ok(0.5)
            }),
        ];
        let timings = rounds(&mut variants, 4)?;
        drop(variants);
        // Once to warm up, then 25 times a sample.
        assert_eq!((*quick.borrow(), *slow.borrow()), (101, 101));
        assert_eq!(timings[0].runs.len(), 4);
        assert!((timings[0].median - 0.000_2).abs() < 1e-12);
        Ok(())
    }

    #[test]
    fn what_was_disturbed_is_measured_again() -> Result<(), StudyError> {
        // Two slow runs among quick ones, and then quick ones only.
        let mut run = 0;
        let mut variant: [Variant<'_>; 1] = [Box::new(|| {
            run += 1;
            Ok(if run == 3 || run == 5 { 9.0 } else { 1.0 })
        })];
        let [timing] = &rounds(&mut variant, 11)?[..] else { return Ok(()) };
        assert_eq!((timing.runs.len(), timing.outliers()), (13, 2));
        assert_eq!((timing.median, timing.uncertainty()), (1.0, 0.0));
        assert!(!timing.is_uncertain());
        Ok(())
    }

    #[test]
    fn what_stays_uncertain_ends_and_says_so() -> Result<(), StudyError> {
        let mut run = 0;
        let mut variant: [Variant<'_>; 1] = [Box::new(|| {
            run += 1;
            Ok(f64::from(run))
        })];
        let timings = rounds(&mut variant, 5)?;
        assert_eq!(timings[0].runs.len(), 15);
        assert!(timings[0].is_uncertain());
        // One run is what was asked for.
        assert_eq!(rounds(&mut variant, 1)?[0].runs.len(), 1);
        Ok(())
    }

    /// The ranks of tables.
    #[test]
    fn intervals_are_those_of_tables() {
        for (samples, ranks) in [
            (1, [1, 1]),
            (5, [1, 5]),
            (6, [1, 6]),
            (9, [2, 8]),
            (15, [4, 12]),
            (25, [8, 18]),
            (100, [40, 61]),
            (101, [40, 62]),
            (3000, [1446, 1555]),
        ] {
            let timing = Timing::of((1..=samples).rev().map(f64::from).collect());
            assert_eq!(timing.interval(), ranks.map(f64::from), "{samples} samples");
        }
    }

    #[test]
    fn a_failed_run_ends_it() {
        let mut variants: [Variant<'_>; 1] = [Box::new(|| Err(StudyError::Asked("no".into())))];
        assert!(rounds(&mut variants, 2).is_err());
    }
}
