//! Files: a report as tables and as a picture.

use serde::Serialize;

use super::conclusions::Judged;
use super::method::Family;
use super::quantity::Quantity;
use super::report::WorkPrecisionReport;
use crate::motion::Integrator;
use crate::scene::Precision;
use crate::scene::{EngineKind, Impact};
use crate::study::chart::{Axis, Chart, Mark, Picture, Scale, Series};
use crate::study::{Folder, StudyError};

/// A row of the table of comma-separated values.
#[derive(Serialize)]
struct MethodRecord {
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

impl WorkPrecisionReport {
    /// Writes tables, pictures, the scene and the machine into a folder.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, folder: &Folder) -> Result<(), StudyError> {
        self.subject.write(folder)?;
        folder.write("report.txt", self.to_string().as_bytes())?;
        folder.write_csv("error.csv", &self.rows())?;
        folder.write_json("error.json", self)?;
        self.picture().write(folder, "work-precision")
    }

    fn rows(&self) -> Vec<MethodRecord> {
        let methods = self.sweep.methods.iter().zip(&self.outcomes);
        let rows = methods.flat_map(|(method, outcome)| {
            let runs = self.sweep.executions.iter().zip(&outcome.timings);
            runs.flat_map(move |(execution, timing)| {
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

    /// The work–precision diagram.
    fn picture(&self) -> Picture {
        let results = self.results(self.judged, self.quantity);
        let point = |result: &Judged| (result.seconds, result.error);
        let families = self.families();
        // A colour for each engine, whatever the precision.
        let mut steppings: Vec<_> = families.iter().map(|family| family.stepping).collect();
        steppings.dedup();
        let color = |family: &Family| steppings.iter().position(|s| *s == family.stepping);
        let mut series: Vec<Series> = families
            .iter()
            .map(|family| Series {
                name: family.to_string(),
                color: color(family),
                mark: match family.precision {
                    Precision::F32 => Mark::DashesAndDiscs,
                    Precision::F64 => Mark::LineAndDiscs,
                },
                points: results
                    .iter()
                    .filter(|result| result.method.family() == *family)
                    .map(point)
                    .collect(),
            })
            .collect();
        series.push(Series {
            name: "no other is faster and better".to_owned(),
            color: None,
            mark: Mark::Rings,
            points: self.front.iter().map(point).collect(),
        });
        Picture {
            charts: vec![Chart {
                title: format!("{}, up to time {:.4}", self.subject.name, self.time),
                x: Axis::new("wall time, s", Scale::Logarithmic),
                y: Axis::new(
                    &format!("error of {}, {}", self.quantity, self.quantity.unit()),
                    Scale::Logarithmic,
                ),
                series,
            }],
        }
    }
}
