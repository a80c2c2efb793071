//! Files: a report as tables and as a picture.

use serde::Serialize;

use super::conclusions::{Judged, size};
use super::method::Family;
use super::quantity::Quantity;
use super::report::WorkPrecisionReport;
use crate::motion::Integrator;
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
}

impl Report for WorkPrecisionReport {
    const NAME: &'static str = "error";
    type Row<'a> = MethodRecord;

    fn subject(&self) -> Option<&Subject> {
        Some(&self.subject)
    }

    fn pictures(&self) -> Vec<(&'static str, Picture)> {
        vec![("work-precision", self.diagram().into())]
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
                    }
                })
            })
        });
        rows.collect()
    }
}

impl WorkPrecisionReport {
    /// The work–precision diagram.
    fn diagram(&self) -> Chart {
        let results = self.results(self.judged, self.quantity);
        let size = size(self.quantity, self.scale.length, self.scale.speed);
        let point = |result: &Judged| (result.seconds, result.error / size);
        let families = self.families();
        // A colour for each way to move, a shape for each precision.
        let (mut ways, mut precisions) = (Vec::<Family>::new(), Vec::new());
        for family in &families {
            if ways.iter().all(|way| way.stepping != family.stepping) {
                ways.push(*family);
            }
            if !precisions.contains(&family.precision) {
                precisions.push(family.precision);
            }
        }
        let color = |family: &Family| ways.iter().position(|way| way.stepping == family.stepping);
        let shape = |precision| match precision {
            Precision::F32 => Shape::Square,
            Precision::F64 => Shape::Disc,
        };
        let mut series = self.guides(&results.iter().map(point).collect::<Vec<_>>());
        series.extend(families.iter().map(|family| {
            let own = results.iter().filter(|result| result.method.family() == *family);
            let bar =
                |result: &Judged| result.interval.map(|seconds| (seconds, result.error / size));
            Series {
                color: color(family),
                shape: shape(family.precision),
                points: own.clone().map(point).collect(),
                bars: own.map(bar).collect(),
                ..Series::default()
            }
        }));
        // The legend.
        series.extend(
            ways.iter()
                .zip(0..)
                .map(|(way, color)| Series::new(way.way(), []).color(color).mark(Mark::Line)),
        );
        series.extend(precisions.into_iter().map(|precision| {
            let series = Series::new(precision.name(), []).mark(Mark::Markers);
            Series { shape: shape(precision), ..series }
        }));
        let front = self.front.iter().map(point);
        series.push(Series::new("no other is faster and better", front).mark(Mark::Rings));
        Chart {
            title: format!("{}, up to time {:.4}", self.subject.name, self.time),
            x: Axis::new("wall time / s", Scale::Logarithmic),
            y: Axis::new(self.quantity.axis(), Scale::Logarithmic),
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
        for (name, epsilon) in [("ε of f32", f64::from(f32::EPSILON)), ("ε of f64", f64::EPSILON)]
        {
            if end.1 <= epsilon && epsilon <= start.1 {
                guide(name, [(start.0, epsilon), (end.0, epsilon)]);
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
