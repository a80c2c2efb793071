//! Fits: laws through measured points, by least squares.

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use serde::{Deserialize, Serialize};

/// A figure and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The figure.
    pub value: f64,
    /// Its standard error; 0 where it is not known.
    pub error: f64,
}

/// A straight line `y = intercept + slope x`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Where it crosses `x = 0`.
    pub intercept: f64,
    /// How steep it is.
    pub slope: Estimate,
}

impl Line {
    /// The line nearest to some points in the sense of least squares, by a QR
    /// decomposition; `None` for fewer than two different `x`, or where a point
    /// is not finite.
    ///
    /// The standard error of the slope is that of independent, equally spread
    /// deviations, as the points show them; 0 for two points.
    ///
    /// ```
    /// use carom::study::fit::Line;
    /// let line = Line::through(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]).ok_or("no line")?;
    /// assert!((line.intercept - 1.0).abs() < 1e-14 && (line.slope.value - 2.0).abs() < 1e-14);
    /// # Ok::<(), &str>(())
    /// ```
    #[must_use]
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let len = points.len() as f64;
        let center = points.iter().map(|point| point.0).sum::<f64>() / len;
        let spread = points.iter().map(|point| (point.0 - center).powi(2)).sum::<f64>();
        let is_finite = points.iter().all(|point| point.0.is_finite() && point.1.is_finite());
        if !is_finite || spread <= 0.0 || points.len() < 2 {
            return None;
        }
        // About the centre the two unknowns do not mix.
        let lines = Mat::from_fn(points.len(), 2, |row, column| match column {
            0 => 1.0,
            _ => points[row].0 - center,
        });
        let values = Mat::from_fn(points.len(), 1, |row, _| points[row].1);
        let solution = lines.qr().solve_lstsq(&values);
        let (middle, slope) = (solution[(0, 0)], solution[(1, 0)]);
        let residuals = points.iter().map(|&(x, y)| (y - middle - slope * (x - center)).powi(2));
        let freedom = len - 2.0;
        let error =
            if freedom > 0.0 { (residuals.sum::<f64>() / freedom / spread).sqrt() } else { 0.0 };
        Some(Self { intercept: middle - slope * center, slope: Estimate { value: slope, error } })
    }
}

/// The power `p` of the law `y ∝ xᵖ` through points whose two figures are
/// positive; others are left out. `None` for fewer than two points.
///
/// ```
/// use carom::study::fit::power;
/// let points = [(1.0, 3.0), (2.0, 12.0), (4.0, 48.0)];
/// let order = power(&points).ok_or("no law")?;
/// assert!((order.value - 2.0).abs() < 1e-14);
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn power(points: &[(f64, f64)]) -> Option<Estimate> {
    Line::through(&logarithms(points)).map(|line| line.slope)
}

/// The power `p` of laws `y ∝ xᵖ` that differ in the factor only, through groups
/// of points, by least squares over all of them. Points that are not positive
/// are left out; `None` where no group has two different `x`.
///
/// ```
/// use carom::study::fit::common_power;
/// let groups = [vec![(1.0, 3.0), (2.0, 12.0)], vec![(1.0, 5.0), (4.0, 80.0)]];
/// let order = common_power(&groups).ok_or("no law")?;
/// assert!((order.value - 2.0).abs() < 1e-14);
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn common_power(groups: &[Vec<(f64, f64)>]) -> Option<Estimate> {
    // About the centre of its group each point says something of the slope only.
    let mut centered = Vec::new();
    let mut factors = 0;
    for group in groups {
        let logarithms = logarithms(group);
        let center =
            |pick: fn(&(f64, f64)) -> f64| mean(&logarithms.iter().map(pick).collect::<Vec<f64>>());
        let (x, y) = (center(|point| point.0), center(|point| point.1));
        factors += usize::from(!logarithms.is_empty());
        centered.extend(logarithms.iter().map(|point| (point.0 - x, point.1 - y)));
    }
    let slope = Line::through(&centered)?.slope;
    // The line has allowed for one factor.
    let freedom = centered.len() as f64 - 2.0;
    let left = freedom + 1.0 - factors as f64;
    let error = if left > 0.0 { slope.error * (freedom / left).sqrt() } else { 0.0 };
    Some(Estimate { error, ..slope })
}

/// The logarithms of points whose two figures are positive.
fn logarithms(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let positive = points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0);
    positive.map(|(x, y)| (x.ln(), y.ln())).collect()
}

/// A figure of several runs, and its standard error from the figures of all
/// runs but one (the jackknife: Tukey 1958).
#[must_use]
pub fn jackknife<R>(runs: &[R], figure: impl Fn(&[&R]) -> f64) -> Estimate {
    let all: Vec<&R> = runs.iter().collect();
    let without: Vec<f64> = (0..runs.len())
        .map(|left_out| {
            let others = all.iter().enumerate().filter(|(run, _)| *run != left_out);
            figure(&others.map(|(_, run)| *run).collect::<Vec<_>>())
        })
        .collect();
    let mean = mean(&without);
    let variance = mean_square(without.iter().map(|figure| figure - mean));
    Estimate { value: figure(&all), error: (variance * (runs.len() as f64 - 1.0)).sqrt() }
}

/// The mean; NaN of nothing.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The mean of the squares; NaN of nothing.
#[must_use]
pub fn mean_square(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let len = values.len() as f64;
    values.map(|value| value * value).sum::<f64>() / len
}

/// The value that a share of all values is below, between two of them by
/// proportion; NaN of nothing.
///
/// ```
/// use carom::study::fit::quantile;
/// assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.5), 2.0);
/// assert_eq!(quantile(&[3.0, 1.0], 0.25), 1.5);
/// ```
#[must_use]
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let rank = share.clamp(0.0, 1.0) * last as f64;
    let below = rank.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (sorted[above] - sorted[below]) * (rank - below as f64)
}
