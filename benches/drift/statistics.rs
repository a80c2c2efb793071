//! What several runs say of the law that the energy's error grows by.

use core::fmt;

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;

/// A figure and its standard error.
pub struct Estimate {
    value: f64,
    error: f64,
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(f)?;
        f.write_str(" ± ")?;
        self.error.fmt(f)
    }
}

/// The law of growth.
pub struct Statistics {
    /// Root mean square over the runs at each point, ε of the energy.
    pub errors: Vec<f64>,
    /// The power of the number of collisions that it grows by.
    pub exponent: Estimate,
    /// The same of the deviations from the mean of all runs.
    pub spread_exponent: Estimate,
    /// Mean change of a particle's energy in each of its collisions, ε of that
    /// energy.
    pub drift: Estimate,
}

impl Statistics {
    /// Of the changes of the energy of each run at each number of collisions.
    pub fn new(points: &[u64], changes: &[Vec<f64>], bodies: u64) -> Self {
        let runs: Vec<&[f64]> = changes.iter().map(Vec::as_slice).collect();
        let collisions_a_body = |&point: &u64| 2.0 * point as f64 / bodies as f64;
        let last = points.last().map_or(f64::NAN, collisions_a_body);
        Self {
            errors: errors(&runs),
            exponent: jackknife(&runs, |runs| exponent(points, &errors(runs))),
            spread_exponent: jackknife(&runs, |runs| exponent(points, &spreads(runs))),
            drift: jackknife(&runs, |runs| means(runs).last().map_or(f64::NAN, |end| end / last)),
        }
    }
}

/// A figure of all runs, and its standard error from the figures of all runs
/// but one (Tukey 1958).
fn jackknife(runs: &[&[f64]], figure: impl Fn(&[&[f64]]) -> f64) -> Estimate {
    let without = |left_out| {
        let others: Vec<_> = (0..runs.len()).filter(|&k| k != left_out).map(|k| runs[k]).collect();
        figure(&others)
    };
    let figures: Vec<f64> = (0..runs.len()).map(without).collect();
    let mean = mean(figures.iter().copied());
    let error = mean_square(figures.iter().map(|figure| figure - mean)) * (runs.len() - 1) as f64;
    Estimate { value: figure(runs), error: error.sqrt() }
}

/// A figure of all runs at each point.
fn at_points(runs: &[&[f64]], figure: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let at = |point| figure(&runs.iter().map(|run| run[point]).collect::<Vec<f64>>());
    (0..runs.first().map_or(0, |run| run.len())).map(at).collect()
}

fn means(runs: &[&[f64]]) -> Vec<f64> {
    at_points(runs, |changes| mean(changes.iter().copied()))
}

fn errors(runs: &[&[f64]]) -> Vec<f64> {
    at_points(runs, |changes| mean_square(changes.iter().copied()).sqrt())
}

fn spreads(runs: &[&[f64]]) -> Vec<f64> {
    at_points(runs, |changes| {
        let mean = mean(changes.iter().copied());
        mean_square(changes.iter().map(|change| change - mean)).sqrt()
    })
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let len = values.len() as f64;
    values.sum::<f64>() / len
}

fn mean_square(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    mean(values.map(|value| value * value))
}

/// The slope of the line nearest to the logarithms, by least squares.
fn exponent(points: &[u64], errors: &[f64]) -> f64 {
    let lines = Mat::from_fn(points.len(), 2, |row, column| match column {
        0 => 1.0,
        _ => (points[row] as f64).ln(),
    });
    let logarithms = Mat::from_fn(points.len(), 1, |row, _| errors[row].ln());
    lines.qr().solve_lstsq(&logarithms)[(1, 0)]
}
