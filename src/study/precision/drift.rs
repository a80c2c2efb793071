//! Drift: how energy and momenta leave their values, against the number of
//! collisions.
//!
//! Roundings without a preferred side make an error that grows as the square
//! root of their number, those with one an error that grows as the number
//! (Brouwer, *The Astronomical Journal* 46, 149, 1937). One run is too few:
//! the laws are those of the root of the mean square over several.

use core::fmt;

use serde::{Deserialize, Serialize};

use super::run::{Sample, Track};
use super::side_by_side::SideBySide;
use crate::study::fit::{Estimate, jackknife, mean, mean_square, power};

/// By how much each point of the fit is before the next one: points that are
/// equally far apart in time would all be near the end.
const APART: f64 = 1.5;

/// Over how much of the way an exponent is fitted.
const SPAN: f64 = 64.0;

/// Exponents of different runs differ by more.
const SAME_RUNS: f64 = 1e-6;

/// The law by which a drift grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// As the square root of the number of collisions.
    Root,
    /// As the number.
    Linear,
    /// Neither, or too uncertain.
    Unclear,
    /// It stays below the distance from 1 to the next number.
    BelowEpsilon,
}

/// The drift of an invariant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drift {
    /// Which invariant.
    pub invariant: &'static str,
    /// The precision.
    pub precision: &'static str,
    /// How many runs it is of.
    pub runs: usize,
    /// Collisions of a run, and the root of the mean square over the runs of the
    /// relative error, at each time.
    pub points: Vec<(f64, f64)>,
    /// The error at the end.
    pub at_end: f64,
    /// The same in ε of the precision.
    pub in_epsilons: f64,
    /// The exponent of the number of collisions, with its jackknife error.
    pub exponent: Option<Estimate>,
    /// What that says.
    pub law: Law,
}

/// What a scene conserves: the names, and indices among the samples' figures.
/// The double-double shows whether the method conserves it: what is lost within
/// twenty digits there is not lost by the precision.
#[must_use]
pub fn invariants(side_by_side: &SideBySide) -> Vec<(usize, &'static str)> {
    const SAME: f64 = 1e-20;
    let of_truth = side_by_side.truth.samples.iter().map(|sample| sample.drift[0]);
    let is_conserved = of_truth.flatten().all(|drift| drift.abs() < SAME);
    let SideBySide { has_gravity, is_periodic, has_surroundings, .. } = *side_by_side;
    let momentum = match has_gravity || has_surroundings {
        true => "momentum balance",
        false => "momentum",
    };
    let invariants = [
        (is_conserved && !(is_periodic && has_gravity), (0, "energy")),
        (true, (1, momentum)),
        (!is_periodic && !has_gravity && !has_surroundings, (2, "angular momentum")),
    ];
    invariants.into_iter().filter(|(is, _)| *is).map(|(_, what)| what).collect()
}

impl Law {
    /// What an exponent says, within two standard errors.
    #[must_use]
    pub fn of(exponent: Option<Estimate>) -> Self {
        let Some(Estimate { value, error }) = exponent else { return Self::Unclear };
        let is_near = |law: f64| (value - law).abs() <= 2.0 * error;
        match (is_near(0.5), is_near(1.0)) {
            (true, false) => Self::Root,
            (false, true) => Self::Linear,
            _ => Self::Unclear,
        }
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Root => "√n",
            Self::Linear => "n",
            Self::Unclear => "unclear",
            Self::BelowEpsilon => "stays below ε",
        })
    }
}

impl Drift {
    /// Of runs in a precision with this ε, those that came to their end. `None`
    /// where there are none.
    #[must_use]
    pub fn of(
        invariant: (usize, &'static str),
        precision: &'static str,
        epsilon: f64,
        tracks: &[&Track],
    ) -> Option<Self> {
        let tracks: Vec<&[Sample]> = tracks
            .iter()
            .filter(|track| track.stopped.is_none())
            .map(|track| track.samples.as_slice())
            .collect();
        let len = tracks.iter().map(|samples| samples.len()).min()?;
        let drift = |sample: &Sample| sample.drift[invariant.0].unwrap_or(f64::NAN);
        let at = |tracks: &[&&[Sample]], k: usize| {
            let collisions: Vec<f64> =
                tracks.iter().map(|samples| samples[k].collisions as f64).collect();
            let drift = tracks.iter().map(|samples| drift(&samples[k]));
            (mean(&collisions), mean_square(drift).sqrt())
        };
        let all: Vec<&&[Sample]> = tracks.iter().collect();
        let points: Vec<(f64, f64)> = (0..len).map(|k| at(&all, k)).collect();
        let at_end = points.last()?.1;
        let fitted = fitted(len);
        let slope = |tracks: &[&&[Sample]]| {
            let points: Vec<_> = fitted.iter().map(|&k| at(tracks, k)).collect();
            power(&points).map_or(f64::NAN, |power| power.value)
        };
        let exponent = jackknife(&tracks, slope);
        // Runs that are all the same have no error, and say no more than one.
        let is_seen = exponent.value.is_finite() && exponent.error > SAME_RUNS;
        let exponent = is_seen.then_some(exponent);
        let law = match points.iter().all(|point| point.1 < epsilon) {
            true => Law::BelowEpsilon,
            false => Law::of(exponent),
        };
        Some(Self {
            invariant: invariant.1,
            precision,
            runs: tracks.len(),
            in_epsilons: at_end / epsilon,
            at_end,
            exponent,
            law,
            points,
        })
    }
}

/// Which of a number of points in time an exponent is fitted to.
fn fitted(len: usize) -> Vec<usize> {
    let last = len.saturating_sub(1) as f64;
    let indices = core::iter::successors(Some(last), |index| Some(index / APART));
    let mut indices: Vec<usize> = indices
        .take_while(|&index| index >= 1.0 && index * SPAN >= last)
        .map(|index| index.round() as usize)
        .collect();
    indices.dedup();
    indices
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs whose error after `n` collisions is that of steps of ±1, and of +1.
    fn tracks(bias: f64) -> Vec<Track> {
        let mut random = 1_u64;
        let mut step = || {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            if random >> 63 == 0 { 1.0 } else { -1.0 }
        };
        let sample = |n: u64, error: f64| Sample {
            time: n as f64,
            collisions: n,
            ends: 2 * n,
            drift: [Some(error * 1e-16), Some(0.0), None],
            translational: None,
            rotational: None,
            virial: 0.0,
            path: None,
        };
        let run = |_| {
            let mut error = 0.0;
            let samples = (0..=200).map(|point| {
                let now = sample(point * 50, error);
                (0..50).for_each(|_| error += step() + bias);
                now
            });
            Track { samples: samples.collect(), stopped: None }
        };
        (0..12).map(run).collect()
    }

    #[test]
    fn laws_of_synthetic_drifts() {
        for (bias, law) in [(0.0, Law::Root), (1.0, Law::Linear)] {
            let tracks = tracks(bias);
            let tracks: Vec<&Track> = tracks.iter().collect();
            let drift = Drift::of((0, "energy"), "f64", f64::EPSILON, &tracks).unwrap();
            println!("{:?}", drift.exponent);
            assert_eq!(drift.law, law, "{:?}", drift.exponent);
            let none = Drift::of((1, "momentum"), "f64", f64::EPSILON, &tracks).unwrap();
            assert_eq!((none.at_end, none.law), (0.0, Law::BelowEpsilon));
            let unknown = Drift::of((2, "angular momentum"), "f64", f64::EPSILON, &tracks);
            assert_eq!(unknown.unwrap().law, Law::Unclear);
        }
        assert_eq!(Drift::of((0, "energy"), "f64", f64::EPSILON, &[]), None);
    }
}
