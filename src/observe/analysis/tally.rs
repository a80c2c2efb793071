//! Tally: what adds up in an analysis from look to look, in blocks, from which means of it
//! and of whatever is made of means get their errors.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use crate::observe::Statistic;

/// The most blocks; then two neighbours become one.
const MOST: usize = 128;

/// Weighted values that were added to a number of channels.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Sums {
    /// Of each channel the sum of the values, and that of their weights.
    channels: Vec<[f64; 2]>,
}

impl Sums {
    fn add(&mut self, channel: usize, value: f64, weight: f64) {
        if channel >= self.channels.len() {
            self.channels.resize(channel + 1, [0.0; 2]);
        }
        self.channels[channel][0] += value;
        self.channels[channel][1] += weight;
    }

    fn join(&mut self, other: &Self) {
        for (channel, [value, weight]) in other.channels.iter().enumerate() {
            self.add(channel, *value, *weight);
        }
    }

    /// The sum of what was added to a channel.
    pub fn sum(&self, channel: usize) -> f64 {
        self.channels.get(channel).map_or(0.0, |sums| sums[0])
    }

    /// The weight of what was added to a channel.
    pub fn weight(&self, channel: usize) -> f64 {
        self.channels.get(channel).map_or(0.0, |sums| sums[1])
    }

    /// The mean of a channel, if it has anything.
    pub fn mean(&self, channel: usize) -> Option<f64> {
        Some(self.sum(channel) / self.weight(channel)).filter(|_| self.weight(channel) > 0.0)
    }
}

/// Sums block by block. Blocks hold equally many looks, and their number stays between 64
/// and 128 however many looks there are: memory is that of the channels.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Tally {
    blocks: Vec<Sums>,
    /// The block that is not full yet.
    open: Sums,
    /// Looks that it has.
    held: u64,
    /// Looks of a full one.
    size: u64,
    looks: u64,
}

impl Default for Tally {
    fn default() -> Self {
        Self { blocks: Vec::new(), open: Sums::default(), held: 0, size: 1, looks: 0 }
    }
}

impl Tally {
    /// Adds a value of weight 1 to a channel.
    pub fn add(&mut self, channel: usize, value: f64) {
        self.open.add(channel, value, 1.0);
    }

    /// Adds what has a weight to a channel.
    pub fn add_weighted(&mut self, channel: usize, sum: f64, weight: f64) {
        self.open.add(channel, sum, weight);
    }

    /// A look is over.
    pub fn end_look(&mut self) {
        self.held += 1;
        self.looks += 1;
        if self.held < self.size {
            return;
        }
        self.held = 0;
        self.blocks.push(core::mem::take(&mut self.open));
        if self.blocks.len() == MOST {
            self.size *= 2;
            self.blocks = self
                .blocks
                .chunks(2)
                .map(|pair| {
                    let mut joined = pair[0].clone();
                    pair[1..].iter().for_each(|other| joined.join(other));
                    joined
                })
                .collect();
        }
    }

    /// How many looks there were.
    pub fn looks(&self) -> u64 {
        self.looks
    }

    /// All that was added.
    pub fn total(&self) -> Sums {
        let mut total = Sums::default();
        self.blocks.iter().chain([&self.open]).for_each(|block| total.join(block));
        total
    }

    /// A figure that is made of sums, of all together; its error from the same of each
    /// block that has it, where these are enough.
    pub fn figure(&self, name: &'static str, of: impl Fn(&Sums) -> Option<f64>) -> Option<Figure> {
        self.figures(1, name, |sums, _| of(sums)).pop()?
    }

    /// As many figures, each by its number.
    pub fn figures(
        &self,
        count: usize,
        name: &'static str,
        of: impl Fn(&Sums, usize) -> Option<f64>,
    ) -> Vec<Option<Figure>> {
        let total = self.total();
        let one = |number| {
            let mean = of(&total, number)?;
            let blocks: Vec<f64> =
                self.blocks.iter().filter_map(|block| of(block, number)).collect();
            let statistic = Statistic::of(&blocks);
            let drifts = statistic.is_some_and(|it| it.drifts);
            Some(Figure { name, mean, error: statistic.map(|it| it.error), drifts })
        };
        (0..count).map(one).collect()
    }
}

/// A column of means, and one of their errors.
pub fn columns(figures: &[Option<Figure>]) -> (Vec<Option<f64>>, Vec<Option<f64>>) {
    let columns = |it: &Option<Figure>| (it.map(|it| it.mean), it.and_then(|it| it.error));
    figures.iter().map(columns).unzip()
}

/// A mean, with its statistical error where it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize))]
#[non_exhaustive]
pub struct Figure {
    /// What it is called.
    pub name: &'static str,
    /// The mean.
    pub mean: f64,
    /// Its standard error, from 32 looks on; see [`Statistic`].
    #[cfg_attr(feature = "files", serde(skip_serializing_if = "Option::is_none"))]
    pub error: Option<f64>,
    /// Whether the halves of the run differ by more than chance.
    pub drifts: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_joined_and_nothing_is_lost() {
        let mut tally = Tally::default();
        for look in 0..1000 {
            tally.add(0, f64::from(look % 7));
            if look % 2 == 0 {
                tally.add(3, 1.0);
            }
            tally.end_look();
        }
        assert_eq!((tally.blocks.len(), tally.size), (125, 8));
        let total = tally.total();
        let expected: i32 = (0..1000).map(|look| look % 7).sum();
        assert_eq!((total.sum(0), total.weight(0)), (f64::from(expected), 1000.0));
        assert_eq!((total.sum(3), total.mean(1), tally.looks()), (500.0, None, 1000));
        let figure = tally.figure("ratio", |sums| Some(sums.sum(3) / sums.weight(0)));
        assert_eq!(figure.map(|it| (it.mean, it.error)), Some((0.5, Some(0.0))));
    }
}
