//! Averages: what they lose with a precision, measured by how uncertain they
//! are anyway.

use serde::Serialize;

use super::run::{Sample, Track, finite};
use super::side_by_side::SideBySide;
use crate::numbers::array::Each;
use crate::observe::compressibility;
use crate::study::fit::{mean, mean_square};

/// Into how many blocks of time a run is divided.
const BLOCKS: usize = 8;

/// A figure that varies by less than this part of itself is conserved: it has no
/// statistical error.
const CONSERVED: f64 = 1e-6;

/// An average over the run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Average {
    /// Which one.
    pub name: &'static str,
    /// By the double-double.
    pub truth: f64,
    /// Its standard error, from blocks of time; `None` for what is conserved.
    pub error: Option<f64>,
    /// In `f32` and `f64`; `None` where the run stopped.
    pub others: [Option<OfPrecision>; 2],
}

/// An average in a precision.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OfPrecision {
    /// The figure.
    pub value: f64,
    /// Its difference from the double-double's.
    pub difference: f64,
    /// That in standard errors.
    pub in_errors: Option<f64>,
}

/// A figure of a stretch of time.
type Figure<'a> = (&'static str, Box<dyn Fn(&[Sample]) -> Option<f64> + 'a>);

/// The averages that a scene has.
#[must_use]
pub fn averages(side_by_side: &SideBySide) -> Vec<Average> {
    let figures = figures(side_by_side);
    let truth = &side_by_side.truth.samples;
    figures.iter().filter_map(|(name, figure)| average(name, figure, truth, side_by_side)).collect()
}

fn average(
    name: &'static str,
    figure: &dyn Fn(&[Sample]) -> Option<f64>,
    samples: &[Sample],
    side_by_side: &SideBySide,
) -> Option<Average> {
    let truth = figure(samples)?;
    let error = standard_error(figure, samples).filter(|error| *error > CONSERVED * truth.abs());
    let of = |track: &Track| {
        let value = figure(&track.samples).filter(|_| track.stopped.is_none())?;
        let difference = value - truth;
        let in_errors = error.map(|error| difference / error);
        Some(OfPrecision { value, difference, in_errors })
    };
    let others = side_by_side.others.refs().each(|other| of(&other.track));
    Some(Average { name, truth, error, others })
}

/// The figures of a scene, each of any stretch of time.
fn figures(side_by_side: &SideBySide) -> Vec<Figure<'_>> {
    let bodies = side_by_side.bodies;
    let ends = side_by_side.truth.samples.last().map_or(0, |sample| sample.ends);
    let mut figures: Vec<Figure<'_>> = Vec::new();
    let has_met = side_by_side.truth.samples.last().is_some_and(|sample| sample.virial > 0.0);
    if side_by_side.is_periodic && bodies > 1 && has_met {
        figures.push((
            "compressibility",
            Box::new(move |samples| {
                let (first, last) = (samples.first()?, samples.last()?);
                let temperature = mean_over(samples, |sample| sample.translational)?;
                let (virial, time) = (last.virial - first.virial, last.time - first.time);
                finite(compressibility(bodies, virial, temperature, time))
            }),
        ));
    }
    if ends > 0 {
        figures.push((
            "collisions per body and time",
            Box::new(move |samples| {
                let (first, last) = (samples.first()?, samples.last()?);
                let ends = (last.ends - first.ends) as f64;
                finite(ends / (bodies as f64 * (last.time - first.time)))
            }),
        ));
    }
    figures.push((
        "translational temperature",
        Box::new(|samples| mean_over(samples, |sample| sample.translational)),
    ));
    let spins = |sample: &Sample| sample.rotational.is_some_and(|kt| kt > 0.0);
    if side_by_side.truth.samples.iter().any(spins) {
        figures.push((
            "rotational temperature",
            Box::new(|samples| mean_over(samples, |sample| sample.rotational)),
        ));
    }
    figures.push((
        "mean free path",
        Box::new(|samples| {
            let (first, last) = (samples.first()?, samples.last()?);
            let path = last.path? - first.path.unwrap_or(0.0);
            finite(path / (last.ends - first.ends) as f64)
        }),
    ));
    figures
}

/// The mean over time, by the trapezoidal rule.
fn mean_over(samples: &[Sample], figure: impl Fn(&Sample) -> Option<f64>) -> Option<f64> {
    let (first, last) = (samples.first()?, samples.last()?);
    let parts = samples.windows(2).map(|pair| {
        let [before, after] = pair else { return Some(0.0) };
        Some(0.5 * (figure(before)? + figure(after)?) * (after.time - before.time))
    });
    finite(parts.sum::<Option<f64>>()? / (last.time - first.time))
}

/// The standard error of a mean, from those of blocks of time.
fn standard_error(figure: &dyn Fn(&[Sample]) -> Option<f64>, samples: &[Sample]) -> Option<f64> {
    let parts = samples.len().checked_sub(1)?;
    let blocks: Vec<f64> = (0..BLOCKS)
        .filter_map(|block| {
            let [start, end] = [block, block + 1].each(|k| k * parts / BLOCKS);
            figure(samples.get(start..=end)?)
        })
        .collect();
    let freedom = blocks.len().checked_sub(1).filter(|&freedom| freedom > 0)?;
    let middle = mean(&blocks);
    finite((mean_square(blocks.iter().map(|value| value - middle)) / freedom as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn means_and_their_errors() {
        let sample = |k: u32| Sample {
            time: f64::from(k),
            collisions: 0,
            ends: 0,
            drift: [None; 3],
            translational: Some(f64::from(k)),
            rotational: None,
            virial: 0.0,
            path: None,
        };
        let samples: Vec<Sample> = (0..=16).map(sample).collect();
        let figure = |samples: &[Sample]| mean_over(samples, |sample| sample.translational);
        assert_eq!(figure(&samples), Some(8.0));
        assert_eq!(figure(&samples[..1]), None);
        // Blocks 1, 3, …, 15: their mean square about 8 is 21.
        let error = standard_error(&figure, &samples).unwrap();
        assert_relative_eq!(error, (21.0_f64 / 7.0).sqrt(), max_relative = 1e-14);
    }
}
