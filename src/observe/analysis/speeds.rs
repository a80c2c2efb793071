//! Speed distribution: how many bodies have a speed, in units of their own thermal one,
//! `c = |v|/√(kT/m)`, beside that of Maxwell, `√(2/π) c² exp(−c²/2)`.

use core::f64::consts::PI;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::tally::Tally;
use super::{Bins, Chosen, Findings, Members, Moment, Unfit};
use crate::observe::{Momentum, Temperature, total_mass};

/// How many bins, by default.
const BINS: usize = 100;

/// How far they go, by default: of 10⁵ bodies one is faster.
const FASTEST: f64 = 5.0;

/// The speed distribution under way. Behind the channels of the bins are those of `c²` and
/// `c⁴`.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct SpeedDistribution {
    bins: Bins,
    members: Members,
    tally: Tally,
    counts: Vec<u64>,
}

impl SpeedDistribution {
    pub fn new(chosen: &Chosen<'_>) -> Result<Self, Unfit> {
        let [from, to] = chosen.range();
        let bins = Bins::new(from.unwrap_or(0.0), to.unwrap_or(FASTEST), chosen.bins(BINS));
        Ok(Self {
            bins,
            members: chosen.only(),
            tally: Tally::default(),
            counts: vec![0; bins.count],
        })
    }

    /// Bodies at rest have no thermal speed; such a look counts for nothing.
    pub fn look(&mut self, moment: &Moment<'_>) {
        let bodies = moment.bodies;
        let temperature = Temperature::of(bodies).map_or(0.0, |gas| gas.translational);
        if temperature > 0.0 {
            // Of the motion relative to all bodies together, as the temperature is.
            let drift = Momentum::of(bodies).0 * (1.0 / total_mass(bodies));
            self.counts.fill(0);
            let (mut second, mut fourth) = (0.0, 0.0);
            for index in self.members.indices() {
                let velocity = bodies.velocity_of(index) - drift;
                let square = velocity.length_squared() * bodies.mass.of(index) / temperature;
                if let Some(bin) = self.bins.of(square.sqrt()) {
                    self.counts[bin] += 1;
                }
                second += square;
                fourth += square * square;
            }
            let count = self.members.count as f64;
            for (bin, found) in self.counts.iter().enumerate() {
                self.tally.add_weighted(bin, *found as f64, count);
            }
            self.tally.add_weighted(self.bins.count, second, count);
            self.tally.add_weighted(self.bins.count + 1, fourth, count);
        }
        self.tally.end_look();
    }

    pub fn findings(&self) -> Findings {
        let count = self.bins.count;
        let (density, error) = self.bins.density(&self.tally);
        let law = |c: f64| (2.0 / PI).sqrt() * c * c * (-0.5 * c * c).exp();
        // The mean over a bin, by Simpson's rule.
        let maxwell = (0..count).map(|bin| {
            let ends = law(self.bins.edge(bin)) + law(self.bins.edge(bin + 1));
            Some((ends + 4.0 * law(self.bins.middle(bin))) / 6.0)
        });
        // The first coefficient in Sonine's polynomials, 0 of Maxwell's distribution.
        let sonine = self.tally.figure("sonine", |sums| {
            let (second, fourth) = (sums.mean(count)?, sums.mean(count + 1)?);
            Some(0.6 * fourth / (second * second) - 1.0)
        });
        Findings {
            columns: vec![
                ("speed", self.bins.middles()),
                ("density", density),
                ("error", error),
                ("maxwell", maxwell.collect()),
            ],
            figures: sonine.into_iter().collect(),
            looks: self.tally.looks(),
        }
    }
}
