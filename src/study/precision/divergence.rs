//! Divergence: how the distance of a trajectory from the true one grows, and
//! when the trajectory is lost.

use serde::{Deserialize, Serialize};

use super::order::Departures;
use super::side_by_side::{Comparison, SideBySide};
use crate::numbers::array::Each;
use crate::real::{DoubleDouble, Real};
use crate::scene::Precision;
use crate::study::deviation::LOST;
use crate::study::fit::{Estimate, Line};

/// A point of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunPoint {
    /// Time since the start.
    pub time: f64,
    /// Collisions per body up to it.
    pub collisions_per_body: f64,
}

/// From how far apart two trajectories are different ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Threshold {
    /// Root of the mean square distance, length.
    pub distance: f64,
    /// What it is a part of.
    pub what: &'static str,
}

/// The law by which an error grows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Growth {
    /// `λ` of `δ ∝ e^(λ c)` over `c` collisions per body. Its error is that of
    /// the line's slope; deviations from the line go on from one time to the
    /// next, so that it is somewhat too small.
    pub rate: Estimate,
    /// `ln δ` at `c = 0` by that law.
    pub intercept: f64,
    /// `p` of `δ ∝ c^p`, if that law is nearer to the points than the other.
    pub power: Option<Estimate>,
    /// From where to where the points are, collisions per body.
    pub range: [f64; 2],
}

/// How a precision's trajectory leaves the true one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Divergence {
    /// The precision.
    pub precision: &'static str,
    /// How the distance grows; `None` where there are too few points.
    pub growth: Option<Growth>,
    /// Where it is lost, if it is seen to be.
    pub lost: Option<RunPoint>,
    /// Where it would be by the law of its growth, if it is not.
    pub would_be_lost: Option<RunPoint>,
    /// The distance at the end, length.
    pub at_end: Option<f64>,
    /// The first collisions that are others.
    pub departures: Departures,
    /// Why it stopped before its end.
    pub stopped: Option<String>,
}

/// The fewest points that show a law.
const FEWEST: usize = 4;

impl Threshold {
    /// For a scene: a tenth of the greatest radius, a collision from which
    /// goes elsewhere. Points have no radius: a hundredth of the room that they
    /// take.
    #[must_use]
    pub fn of(side_by_side: &SideBySide) -> Self {
        if side_by_side.radius > 0.0 {
            Self { distance: LOST * side_by_side.radius, what: "a tenth of the greatest radius" }
        } else {
            Self {
                distance: 0.01 * side_by_side.extent,
                what: "a hundredth of the diagonal of all places seen",
            }
        }
    }
}

impl Growth {
    /// Of distances against collisions per body: of those from the first
    /// collision of most bodies on, before which there are only roundings, up to
    /// the threshold. `None` for fewer than four. From the first collision with
    /// another partner on the distance leaps; the points must end before.
    #[must_use]
    pub fn of(points: &[(f64, f64)], threshold: f64) -> Option<Self> {
        let end = points.iter().position(|&(_, distance)| distance > threshold);
        let points = &points[..end.unwrap_or(points.len())];
        let points: Vec<(f64, f64)> = points
            .iter()
            .filter(|&&(collisions, distance)| collisions >= 1.0 && distance > 0.0)
            .map(|&(collisions, distance)| (collisions, distance.ln()))
            .collect();
        let (first, last) = (points.first()?, points.last()?);
        if points.len() < FEWEST {
            return None;
        }
        let line = Line::through(&points)?;
        let logarithms: Vec<_> = points.iter().map(|&(c, distance)| (c.ln(), distance)).collect();
        let curve = Line::through(&logarithms)?;
        let is_power = residue(&curve, &logarithms) < residue(&line, &points);
        Some(Self {
            rate: line.slope,
            intercept: line.intercept,
            power: is_power.then_some(curve.slope),
            range: [first.0, last.0],
        })
    }

    /// Collisions per body at which the distance is so great, from `last`, a
    /// point with its distance, on.
    #[must_use]
    pub fn reaches(&self, distance: f64, last: (f64, f64)) -> Option<f64> {
        let factor = (distance / last.1).ln();
        let found = match self.power {
            Some(power) => last.0 * (factor / power.value).exp(),
            None => (distance.ln() - self.intercept) / self.rate.value,
        };
        (found.is_finite() && found >= last.0).then_some(found)
    }
}

/// The sum of the squares of what a line leaves over.
fn residue(line: &Line, points: &[(f64, f64)]) -> f64 {
    let rest = |&(x, y): &(f64, f64)| (y - line.intercept - line.slope.value * x).powi(2);
    points.iter().map(rest).sum()
}

impl Divergence {
    /// Of one of the runs.
    #[must_use]
    pub fn of(
        precision: &'static str,
        comparison: &Comparison,
        side_by_side: &SideBySide,
        threshold: f64,
    ) -> Self {
        let collisions = side_by_side.collisions_per_body();
        let samples = &side_by_side.truth.samples;
        let reached = samples.iter().zip(&collisions).zip(&comparison.distance);
        let points: Vec<(RunPoint, f64)> = reached
            .map(|((sample, &collisions_per_body), distance)| {
                // What is no number is as far away as can be.
                let distance = distance.unwrap_or(f64::MAX);
                (RunPoint { time: sample.time, collisions_per_body }, distance)
            })
            .collect();
        let partner = comparison.departures.partner;
        let plain: Vec<(f64, f64)> = points
            .iter()
            .map(|(point, distance)| (point.collisions_per_body, *distance))
            .take_while(|point| partner.is_none_or(|other| point.0 < other.collisions_per_body))
            .collect();
        let growth = Growth::of(&plain, threshold);
        let lost = crossing(&points, threshold);
        let would_be_lost = match (lost, growth, points.last()) {
            (None, Some(growth), Some(&(end, distance))) => growth
                .reaches(threshold, (end.collisions_per_body, distance))
                .map(|collisions_per_body| {
                    let time = end.time * collisions_per_body / end.collisions_per_body;
                    RunPoint { time, collisions_per_body }
                }),
            _ => None,
        };
        Self {
            precision,
            growth,
            lost,
            would_be_lost,
            at_end: comparison.distance.last().copied().flatten(),
            departures: comparison.departures,
            stopped: comparison.track.stopped.clone(),
        }
    }
}

/// Where a distance first goes through the threshold; between two points it
/// grows by equal factors.
fn crossing(points: &[(RunPoint, f64)], threshold: f64) -> Option<RunPoint> {
    let after = points.iter().position(|&(_, distance)| distance > threshold)?;
    let (end, above) = points[after];
    let Some(&(start, below)) = after.checked_sub(1).and_then(|before| points.get(before)) else {
        return Some(end);
    };
    let share = (threshold / below).ln() / (above / below).ln();
    let share = if share.is_finite() { share } else { 1.0 };
    let between = |start: f64, end: f64| start + share * (end - start);
    Some(RunPoint {
        time: between(start.time, end.time),
        collisions_per_body: between(start.collisions_per_body, end.collisions_per_body),
    })
}

/// Where even the double-double is lost: an error that starts as many times
/// smaller than one in `f64` or `f32` as its ε is, and grows as that one does.
#[must_use]
pub fn reference_lost(
    divergences: &[Divergence; 2],
    threshold: f64,
    end: RunPoint,
) -> Option<RunPoint> {
    let epsilons = [Precision::F32, Precision::F64].each(Precision::epsilon);
    let mut found = divergences.iter().zip(epsilons).rev().filter_map(|(divergence, epsilon)| {
        let growth = divergence.growth.filter(|growth| growth.power.is_none())?;
        let smaller = (DoubleDouble::EPSILON.to_f64() / epsilon).ln();
        let collisions_per_body = (threshold.ln() - growth.intercept - smaller) / growth.rate.value;
        (growth.rate.value > 0.0 && collisions_per_body.is_finite()).then(|| {
            let time = end.time * collisions_per_body / end.collisions_per_body;
            RunPoint { time, collisions_per_body }
        })
    });
    found.next()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn laws_of_growth_are_told_apart() {
        let steps = || (0..100).map(|k| f64::from(k) * 0.2);
        let exponential: Vec<_> = steps().map(|c| (c, 1e-16 * (0.8 * c).exp())).collect();
        let growth = Growth::of(&exponential, 1e-3).unwrap();
        assert_relative_eq!(growth.rate.value, 0.8, max_relative = 1e-12);
        assert_eq!(growth.power, None);
        let end = *exponential.last().unwrap();
        let reached = growth.reaches(1e-3, end).unwrap();
        assert_relative_eq!(reached, 1e13_f64.ln() / 0.8, max_relative = 1e-9);
        let power: Vec<_> = steps().map(|c| (c, 1e-16 * c * c)).collect();
        let growth = Growth::of(&power, 1e-3).unwrap();
        assert_relative_eq!(growth.power.unwrap().value, 2.0, max_relative = 1e-12);
        let reached = growth.reaches(1e-12, *power.last().unwrap()).unwrap();
        assert_relative_eq!(reached, 100.0, max_relative = 1e-9);
        assert_eq!(Growth::of(&power[..4], 1e-3), None);
    }
}
