//! Lags: what becomes of a vector of each body after times of very different lengths.
//!
//! Looks are kept on levels, each with half as many of them as the one before (Dubbeldam,
//! Ford, Ellis and Snurr 2009): on the first every look, and lags up to sixteen of them; on
//! each further one lags twice as long. Nothing is averaged on the way. Time and memory are
//! those of `16 + 8` lags, times the levels for the memory.

use std::collections::VecDeque;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::tally::{Figure, Sums, Tally};
use super::{Chosen, Members, Unfit};

/// Looks that are kept on a level.
const KEPT: usize = 16;

/// How often a lag has to be seen to be part of a figure.
const OFTEN: f64 = 128.0;

/// By what part of itself rounding may have a lag beyond the longest.
const ROUNDING: f64 = 1e-9;

/// A mean over bodies after a time, under way.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Lags {
    members: Members,
    longest: f64,
    levels: Vec<VecDeque<Kept>>,
    pub tally: Tally,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
struct Kept {
    time: f64,
    vectors: Vec<[f64; 3]>,
}

/// What is known of a lag.
#[derive(Clone, Copy, Debug)]
pub struct Lag {
    /// The time, a mean over all looks where these are not as far apart.
    pub time: f64,
    /// The channel of its values.
    pub channel: usize,
    /// How often it was seen.
    pub often: f64,
}

impl Lags {
    pub fn new(chosen: &Chosen<'_>) -> Result<Self, Unfit> {
        chosen.without_bins()?;
        chosen.begins_at_zero()?;
        let longest = chosen.range()[1].unwrap_or(f64::INFINITY);
        let tally = Tally::default();
        Ok(Self { members: chosen.only(), longest, levels: Vec::new(), tally })
    }

    /// The channel of the values of a lag of a number of looks of a level, and behind it that
    /// of the times. Channel 0 is the lag of 0.
    fn channel(level: usize, lag: usize) -> usize {
        1 + 2 * (level * KEPT + lag - 1)
    }

    /// Adds a look: `vector` of each body, and the value of `figure` of then and now.
    pub fn look(
        &mut self,
        time: f64,
        vector: impl Fn(usize) -> [f64; 3],
        figure: impl Fn([f64; 3], [f64; 3]) -> f64,
    ) {
        let look = self.tally.looks();
        let vectors: Vec<[f64; 3]> = self.members.indices().map(vector).collect();
        let mean = |then: &[[f64; 3]]| {
            let values = then.iter().zip(&vectors).map(|(then, now)| figure(*then, *now));
            values.sum::<f64>() / vectors.len() as f64
        };
        self.tally.add(0, mean(&vectors));
        for level in 0.. {
            if !look.is_multiple_of(1 << level) {
                break;
            }
            if level == self.levels.len() {
                // The level before has to be full, and its lags to be wanted.
                let before = level.checked_sub(1).and_then(|before| self.levels.get(before));
                let is_due = before.is_none_or(|before| {
                    let first = before.front().map_or(time, |first| first.time);
                    before.len() == KEPT && time - first < self.longest
                });
                if !is_due {
                    break;
                }
                self.levels.push(VecDeque::with_capacity(KEPT));
            }
            let kept = &mut self.levels[level];
            // Shorter lags are those of the level before.
            let least = if level == 0 { 1 } else { KEPT / 2 + 1 };
            for (back, then) in kept.iter().rev().enumerate() {
                let (lag, passed) = (back + 1, time - then.time);
                if lag >= least && passed <= self.longest * (1.0 + ROUNDING) {
                    let channel = Self::channel(level, lag);
                    self.tally.add(channel, mean(&then.vectors));
                    self.tally.add(channel + 1, passed);
                }
            }
            if kept.len() == KEPT {
                kept.pop_front();
            }
            kept.push_back(Kept { time, vectors: vectors.clone() });
        }
        self.tally.end_look();
    }

    /// The lags that were seen, from the shortest on, without that of 0.
    pub fn seen(&self) -> Vec<Lag> {
        let total = self.tally.total();
        let lag = |(level, lag)| {
            let channel = Self::channel(level, lag);
            let time = total.mean(channel + 1)?;
            Some(Lag { time, channel, often: total.weight(channel) })
        };
        let all = (0..self.levels.len()).flat_map(|level| (1..=KEPT).map(move |k| (level, k)));
        all.filter_map(lag).collect()
    }

    /// A figure that is made of the lags that were seen often: of none if they are few.
    pub fn figure(
        &self,
        name: &'static str,
        of: impl Fn(&Sums, &[Lag]) -> Option<f64>,
    ) -> Option<Figure> {
        let often: Vec<Lag> = self.seen().into_iter().filter(|lag| lag.often >= OFTEN).collect();
        self.tally.figure(name, |sums| of(sums, &often)).filter(|_| !often.is_empty())
    }
}
