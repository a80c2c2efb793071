//! Mean squared displacement: how far bodies have moved after a time, through the faces of
//! a periodic box, and how fast they diffuse, `D = d⟨|r(t) − r(0)|²⟩/dt / 6` (Einstein).

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::lags::{Lag, Lags};
use super::tally::{Sums, columns};
use super::{Chosen, Findings, Moment, Unfit};

/// The mean squared displacement under way.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct MeanSquaredDisplacement {
    lags: Lags,
}

impl MeanSquaredDisplacement {
    pub fn new(chosen: &Chosen<'_>) -> Result<Self, Unfit> {
        Ok(Self { lags: Lags::new(chosen)? })
    }

    pub fn look(&mut self, moment: &Moment<'_>) {
        self.lags.look(
            moment.time,
            |index| moment.unwrapped(index),
            |then, now| {
                (0..3).map(|axis| (now[axis] - then[axis]) * (now[axis] - then[axis])).sum()
            },
        );
    }

    pub fn findings(&self) -> Findings {
        let lags = self.lags.seen();
        let displacement = self
            .lags
            .tally
            .figures(lags.len(), "displacement", |sums, row| sums.mean(lags[row].channel));
        let total = self.lags.tally.total();
        // Between the lags before and behind.
        let point = |row: Option<usize>| {
            let lag = row.map(|row| &lags[row]);
            lag.map_or(Some([0.0; 2]), |lag| Some([lag.time, total.mean(lag.channel)?]))
        };
        let slope = |row: usize| {
            let [before, behind] = [row.checked_sub(1), Some((row + 1).min(lags.len() - 1))];
            let ([t0, d0], [t1, d1]) = (point(before)?, point(behind)?);
            Some((d1 - d0) / (t1 - t0) / 6.0)
        };
        let (displacement, error) = columns(&displacement);
        Findings {
            columns: vec![
                ("time", lags.iter().map(|lag| Some(lag.time)).collect()),
                ("displacement", displacement),
                ("error", error),
                ("diffusion", (0..lags.len()).map(slope).collect()),
            ],
            figures: self.lags.figure("diffusion", diffusion).into_iter().collect(),
            looks: self.lags.tally.looks(),
        }
    }
}

/// A sixth of the slope of the line, by least squares, through the longer half of the lags.
fn diffusion(sums: &Sums, lags: &[Lag]) -> Option<f64> {
    let half = 0.5 * lags.last()?.time;
    let mut points = Vec::new();
    for lag in lags.iter().filter(|lag| lag.time >= half) {
        points.push((lag.time, sums.mean(lag.channel)?));
    }
    let count = points.len() as f64;
    if points.len() < 3 {
        return None;
    }
    let middle = points.iter().map(|(time, _)| time).sum::<f64>() / count;
    let along: f64 = points.iter().map(|(time, _)| (time - middle) * (time - middle)).sum();
    let across: f64 = points.iter().map(|(time, value)| (time - middle) * value).sum();
    Some(across / along / 6.0)
}
