//! Collision statistics: how long bodies fly from one collision to the next, and how far,
//! beside collisions at random, `exp(−t/τ)/τ`.
//!
//! A flight counts when it ends, if its start was seen too. Between collisions a body is
//! taken to keep its speed, as it does without gravity.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::tally::{Figure, Sums, Tally, columns};
use super::{Bins, Chosen, Findings, Members, Unfit};
use crate::engine::{Event, Partner};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// How many bins, by default.
const BINS: usize = 100;

/// From how many flights the range is taken, by default.
const FIRST: usize = 1000;

/// How many of their means it has.
const MEANS: f64 = 6.0;

/// The flights of a run under way.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct CollisionStatistics {
    count: usize,
    /// Which bodies count; `None` for all.
    of: Option<Vec<bool>>,
    /// The time of the last collision of each body, once it is seen, and the speed since.
    since: Vec<Option<(f64, f64)>>,
    /// Flights that came before the bins.
    first: Vec<[f64; 2]>,
    /// Those of times and those of ways.
    bins: Option<[Bins; 2]>,
    counts: [Vec<u64>; 2],
    totals: [f64; 2],
    flights: u64,
    begun: bool,
    tally: Tally,
}

impl CollisionStatistics {
    pub fn new(chosen: &Chosen<'_>) -> Result<Self, Unfit> {
        chosen.begins_at_zero()?;
        let Members { some, .. } = chosen.only();
        let count = chosen.bins(BINS);
        let bodies = chosen.bodies;
        let of = some.map(|some| {
            let mut of = vec![false; bodies];
            some.into_iter().for_each(|index| of[index as usize] = true);
            of
        });
        if chosen.range()[1].is_some() {
            let wanted = "collision-statistics takes six mean flights; leave it out";
            return Err(Unfit::new("range", "chosen", wanted));
        }
        Ok(Self {
            count,
            of,
            since: vec![None; bodies],
            first: Vec::new(),
            bins: None,
            counts: [vec![0; count], vec![0; count]],
            totals: [0.0; 2],
            flights: 0,
            begun: false,
            tally: Tally::default(),
        })
    }

    pub fn hear<T: Real>(&mut self, event: &Event<T>) {
        if !self.begun {
            return;
        }
        self.hit(event.time, event.a, event.velocity);
        if let Partner::Body { index, velocity, .. } = event.partner {
            self.hit(event.time, index, velocity);
        }
    }

    /// A body has collided, and flies on.
    fn hit<T: Real>(&mut self, time: f64, index: u32, velocity: Vec3<T>) {
        let index = index as usize;
        if self.of.as_ref().is_some_and(|of| !of[index]) {
            return;
        }
        let speed = velocity.cast::<f64>().length();
        if let Some((start, speed)) = self.since[index].replace((time, speed)) {
            let passed = time - start;
            self.count_flight([passed, speed * passed]);
        }
    }

    fn count_flight(&mut self, flight: [f64; 2]) {
        self.flights += 1;
        self.totals.iter_mut().zip(flight).for_each(|(total, it)| *total += it);
        let Some(bins) = &self.bins else {
            self.first.push(flight);
            if self.first.len() == FIRST {
                self.choose();
            }
            return;
        };
        for ((bins, counts), it) in bins.iter().zip(&mut self.counts).zip(flight) {
            if let Some(bin) = bins.of(it) {
                counts[bin] += 1;
            }
        }
    }

    /// Chooses the bins by the first flights, and puts these into them.
    fn choose(&mut self) {
        let first = core::mem::take(&mut self.first);
        let mean = |k: usize| first.iter().map(|it| it[k]).sum::<f64>() / first.len() as f64;
        let bins = [0, 1].each(|k| Bins::new(0.0, MEANS * mean(k), self.count));
        for flight in first {
            for (k, bins) in bins.iter().enumerate() {
                if let Some(bin) = bins.of(flight[k]) {
                    self.counts[k][bin] += 1;
                }
            }
        }
        self.bins = Some(bins);
    }

    /// Closes what was heard since the look before.
    pub fn look(&mut self) {
        if !core::mem::replace(&mut self.begun, true) {
            return;
        }
        if self.bins.is_some() {
            let flights = self.flights as f64;
            for k in 0..2 {
                self.tally.add_weighted(k, self.totals[k], flights);
                for (bin, count) in self.counts[k].iter_mut().enumerate() {
                    let channel = Self::channel(k, bin, self.count);
                    self.tally.add_weighted(channel, *count as f64, flights);
                    *count = 0;
                }
            }
            (self.totals, self.flights) = ([0.0; 2], 0);
        }
        self.tally.end_look();
    }

    /// Of the times or the ways: first the two of their totals, then those of their bins.
    fn channel(kind: usize, bin: usize, count: usize) -> usize {
        2 + kind * count + bin
    }

    pub fn findings(&self) -> Findings {
        let bins = self.bins.unwrap_or([Bins::new(0.0, 1.0, self.count); 2]);
        let mean = |name, k: usize| self.tally.figure(name, |sums| sums.mean(k));
        let means: [Option<Figure>; 2] = [mean("mean_free_time", 0), mean("mean_free_path", 1)];
        let mut found = Vec::new();
        let names = [
            ["time", "time_density", "time_error", "time_at_random"],
            ["path", "path_density", "path_error", "path_at_random"],
        ];
        for (k, [middle, density, error, random]) in names.into_iter().enumerate() {
            let of = |sums: &Sums, bin: usize| {
                Some(sums.mean(Self::channel(k, bin, self.count))? / bins[k].width)
            };
            let (densities, errors) = columns(&self.tally.figures(self.count, density, of));
            let law = |bin: usize| {
                let mean = means[k]?.mean;
                let [near, far] = [bins[k].edge(bin), bins[k].edge(bin + 1)];
                Some(((-near / mean).exp() - (-far / mean).exp()) / bins[k].width)
            };
            found.push((middle, bins[k].middles()));
            found.push((density, densities));
            found.push((error, errors));
            found.push((random, (0..self.count).map(law).collect()));
        }
        if self.bins.is_none() {
            found.iter_mut().for_each(|(_, column)| column.fill(None));
        }
        Findings {
            columns: found,
            figures: means.into_iter().flatten().collect(),
            looks: self.tally.looks(),
        }
    }
}
