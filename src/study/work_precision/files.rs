//! Files: a report as tables and as a picture.

use serde::Serialize;

use super::conclusions::{Judged, size};
use super::method::Family;
use super::quantity::Quantity;
use super::report::WorkPrecisionReport;
use crate::motion::Integrator;
use crate::numbers::array::Each;
use crate::scene::Precision;
use crate::scene::{EngineKind, Impact};
use crate::study::chart::{Axis, Chart, Mark, Picture, Scale, Series, Shape};
use crate::study::{Report, Subject};

/// A row of the table of comma-separated values.
#[derive(Debug, Serialize)]
pub struct MethodRecord {
    engine: EngineKind,
    integrator: Option<Integrator>,
    impact: Option<Impact>,
    dt: Option<f64>,
    precision: Precision,
    lanes: String,
    threads: usize,
    seconds: f64,
    seconds_lower_quartile: f64,
    seconds_upper_quartile: f64,
    seconds_low: f64,
    seconds_high: f64,
    samples: usize,
    time: f64,
    collisions_per_body: f64,
    reference_collisions_per_body: f64,
    is_lost: bool,
    position: Option<f64>,
    position_worst: Option<f64>,
    velocity: Option<f64>,
    orientation: Option<f64>,
    energy: Option<f64>,
    momentum: Option<f64>,
    angular_momentum: Option<f64>,
    state_hash: String,
    norm: String,
}

impl Report for WorkPrecisionReport {
    const NAME: &'static str = "error";
    type Row<'a> = MethodRecord;

    fn subject(&self) -> Option<&Subject> {
        Some(&self.subject)
    }

    fn pictures(&self) -> Vec<(&'static str, Picture)> {
        vec![("work-precision", self.diagram())]
    }

    fn rows(&self) -> Vec<MethodRecord> {
        let methods = self.sweep.methods.iter().zip(&self.outcomes);
        let rows = methods.flat_map(|(method, outcome)| {
            let runs = self.sweep.executions.iter().zip(&outcome.timings);
            runs.flat_map(move |(execution, timing)| {
                let [seconds_low, seconds_high] = timing.interval();
                outcome.moments.iter().map(move |moment| {
                    let figure = |quantity: Quantity| moment.deviation.map(|d| quantity.of(&d));
                    let stepping = method.stepping;
                    MethodRecord {
                        engine: match stepping {
                            None => EngineKind::EventDriven,
                            Some(_) => EngineKind::Stepped,
                        },
                        integrator: stepping.map(|stepping| stepping.integrator),
                        impact: stepping.map(|stepping| stepping.impact),
                        dt: stepping.map(|stepping| stepping.dt),
                        precision: method.precision,
                        lanes: execution.lanes.to_string(),
                        threads: execution.threads,
                        seconds: timing.median,
                        seconds_lower_quartile: timing.lower_quartile,
                        seconds_upper_quartile: timing.upper_quartile,
                        seconds_low,
                        seconds_high,
                        samples: timing.runs.len(),
                        time: moment.time,
                        collisions_per_body: moment.collisions,
                        reference_collisions_per_body: moment.true_collisions,
                        is_lost: self.is_lost(moment),
                        position: figure(Quantity::Position),
                        position_worst: moment.deviation.map(|d| d.position_worst),
                        velocity: figure(Quantity::Velocity),
                        orientation: figure(Quantity::Orientation),
                        energy: moment.deviation.map(|d| d.energy),
                        momentum: figure(Quantity::Momentum),
                        angular_momentum: figure(Quantity::AngularMomentum),
                        state_hash: outcome.state_hash.clone(),
                        norm: self.norm.to_string(),
                    }
                })
            })
        });
        rows.collect()
    }
}

impl WorkPrecisionReport {
    /// The work–precision diagram: of all precisions, or of each one where too many methods
    /// would lie on each other.
    fn diagram(&self) -> Picture {
        let results = self.results(self.judged, self.quantity);
        let mut precisions = Vec::new();
        for family in self.families() {
            if !precisions.contains(&family.precision) {
                precisions.push(family.precision);
            }
        }
        let points: Vec<_> =
            results.iter().map(|it| (it.method.family(), self.point(it))).collect();
        if precisions.len() > 1 && covered(&points) > MOST_COVERED {
            let panel = |precision: &Precision| self.panel(&results, &[*precision]);
            Picture { charts: precisions.iter().map(panel).collect() }
        } else {
            self.panel(&results, &precisions).into()
        }
    }

    /// Where a result is: seconds, and the error relative to what it is small against.
    fn point(&self, result: &Judged) -> (f64, f64) {
        let size = size(self.quantity, self.scale.length, self.scale.speed);
        (result.seconds, result.error / size)
    }

    /// Some precisions, on the axes of all.
    fn panel(&self, all: &[Judged], precisions: &[Precision]) -> Chart {
        let is_shown = |family: &Family| precisions.contains(&family.precision);
        let all_points = || all.iter().map(|result| self.point(result));
        let families = self.families();
        // A colour for each way to move, a shape for each precision.
        let mut ways = Vec::<Family>::new();
        for family in &families {
            if ways.iter().all(|way| way.stepping != family.stepping) {
                ways.push(*family);
            }
        }
        let shape = |precision| match precision {
            Precision::F32 => Shape::Square,
            Precision::F64 => Shape::Disc,
            Precision::DoubleDouble => Shape::Triangle,
        };
        let mut series = self.guides(&all_points().collect::<Vec<_>>());
        series.extend(families.iter().filter(|family| is_shown(family)).map(|family| {
            let own = || all.iter().filter(|result| result.method.family() == *family);
            let error = |result: &Judged| self.point(result).1;
            let bar = |result: &Judged| result.interval.each(|seconds| (seconds, error(result)));
            Series {
                color: ways.iter().position(|way| way.stepping == family.stepping),
                shape: shape(family.precision),
                bars: own().map(bar).collect(),
                ..Series::new("", own().map(|result| self.point(result)))
            }
        }));
        // The legend.
        series.extend(
            ways.iter()
                .zip(0..)
                .map(|(way, color)| Series::new(way.way(), []).color(color).mark(Mark::Line)),
        );
        if precisions.len() > 1 {
            series.extend(precisions.iter().map(|&precision| {
                let series = Series::new(precision.name(), []).mark(Mark::Markers);
                Series { shape: shape(precision), ..series }
            }));
        }
        let front = self.front.iter().filter(|best| is_shown(&best.method.family()));
        let front = front.map(|result| self.point(result));
        series.push(Series::new("no other is faster and better", front).mark(Mark::Rings));
        let name = &self.subject.name;
        let of = match precisions {
            [one] => format!("{name}, {one}"),
            _ => name.clone(),
        };
        Chart {
            title: format!("{of}, up to time {:.4}", self.time),
            x: Axis::new("wall time / s", Scale::Logarithmic).reaching(all_points().map(|p| p.0)),
            y: Axis::new(&self.quantity.axis(self.norm), Scale::Logarithmic)
                .reaching(all_points().map(|p| p.1)),
            series,
        }
    }

    /// What errors are seen against: the rounding of the precisions, and lines along which
    /// the error is in proportion to the step or its square, if the time is to their number.
    fn guides(&self, points: &[(f64, f64)]) -> Vec<Series> {
        let mut guides = Vec::new();
        let mut guide = |name: &str, ends: [(f64, f64); 2]| {
            guides.push(Series::new(name, ends).mark(Mark::Guide));
        };
        let positive = points.iter().filter(|(_, error)| *error > 0.0);
        let Some(start) = positive.clone().copied().reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        else {
            return guides;
        };
        let end = positive.copied().fold(start, |a, b| (a.0.max(b.0), a.1.min(b.1)));
        for precision in [Precision::F32, Precision::F64, Precision::DoubleDouble] {
            let (name, epsilon) = (format!("ε of {precision}"), precision.epsilon());
            if end.1 <= epsilon && epsilon <= start.1 {
                guide(&name, [(start.0, epsilon), (end.0, epsilon)]);
            }
        }
        if self.families().iter().any(|family| family.stepping.is_some()) {
            for (name, order) in [("order 1", 1.0), ("order 2", 2.0)] {
                // From the upper left corner down to where the points end.
                let ratio = (end.0 / start.0).min((start.1 / end.1).powf(1.0 / order));
                guide(name, [start, (start.0 * ratio, start.1 / ratio.powf(order))]);
            }
        }
        guides
    }
}

/// A share of the points that may lie on others of another family before each precision has
/// a panel of its own.
const MOST_COVERED: f64 = 0.2;

/// Two points this near to each other lie on each other, of the span of an axis.
const NEAR: f64 = 0.02;

/// The share of the points that lie on one of another family, on axes of logarithms.
fn covered(points: &[(Family, (f64, f64))]) -> f64 {
    let logarithms: Vec<_> = points
        .iter()
        .filter(|(_, (x, y))| *x > 0.0 && *y > 0.0)
        .map(|(family, (x, y))| (family, [x.ln(), y.ln()]))
        .collect();
    let span = |k: usize| {
        let values = || logarithms.iter().map(|(_, place)| place[k]);
        values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
    };
    let spans = [span(0), span(1)];
    let is_covered = |(family, place): &&(&Family, [f64; 2])| {
        logarithms.iter().any(|(other, at)| {
            other != family && (0..2).all(|k| (at[k] - place[k]).abs() <= NEAR * spans[k])
        })
    };
    let count = logarithms.iter().filter(is_covered).count();
    count as f64 / logarithms.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_each_other_are_seen() {
        let family = |precision| Family { precision, stepping: None };
        let [single, double] = [Precision::F32, Precision::F64].map(family);
        let apart = [(single, (1.0, 1e-3)), (double, (1.0, 1e-9)), (double, (2.0, 0.0))];
        assert_eq!(covered(&apart), 0.0);
        let near = [(single, (1.0, 1e-3)), (double, (1.001, 1.01e-3)), (double, (9.0, 1e-9))];
        assert_eq!(covered(&near), 2.0 / 3.0);
        assert_eq!(covered(&[]), 0.0);
    }
}
