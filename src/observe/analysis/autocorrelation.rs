//! Velocity autocorrelation: how much of a velocity is left after a time, `⟨v(0)·v(t)⟩`, and
//! how fast bodies diffuse, `D = ∫⟨v(0)·v(t)⟩dt / 3` (Green and Kubo).

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::lags::{Lag, Lags};
use super::tally::{Sums, columns};
use super::{Chosen, Findings, Moment, Unfit};

/// The velocity autocorrelation under way.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct VelocityAutocorrelation {
    lags: Lags,
}

impl VelocityAutocorrelation {
    pub fn new(chosen: &Chosen<'_>) -> Result<Self, Unfit> {
        Ok(Self { lags: Lags::new(chosen)? })
    }

    pub fn look(&mut self, moment: &Moment<'_>) {
        self.lags.look(
            moment.time,
            |index| moment.bodies.velocity_of(index).to_array(),
            |then, now| then[0] * now[0] + then[1] * now[1] + then[2] * now[2],
        );
    }

    pub fn findings(&self) -> Findings {
        let zero = Lag { time: 0.0, channel: 0, often: self.lags.tally.looks() as f64 };
        let lags: Vec<Lag> = core::iter::once(zero).chain(self.lags.seen()).collect();
        let correlation = self
            .lags
            .tally
            .figures(lags.len(), "correlation", |sums, row| sums.mean(lags[row].channel));
        let total = self.lags.tally.total();
        let diffusion_to = |row: usize| diffusion(&total, &lags[1..=row]);
        let (correlation, error) = columns(&correlation);
        Findings {
            columns: vec![
                ("time", lags.iter().map(|lag| Some(lag.time)).collect()),
                ("correlation", correlation),
                ("error", error),
                ("diffusion", (0..lags.len()).map(diffusion_to).collect()),
            ],
            figures: self.lags.figure("diffusion", diffusion).into_iter().collect(),
            looks: self.lags.tally.looks(),
        }
    }
}

/// A third of the integral up to the last of some lags, by the trapezoidal rule.
fn diffusion(sums: &Sums, lags: &[Lag]) -> Option<f64> {
    let (mut time, mut value) = (0.0, sums.mean(0)?);
    let mut integral = 0.0;
    for lag in lags {
        let next = sums.mean(lag.channel)?;
        integral += 0.5 * (lag.time - time) * (value + next);
        (time, value) = (lag.time, next);
    }
    Some(integral / 3.0)
}
