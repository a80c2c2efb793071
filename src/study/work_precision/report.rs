//! Report: what was measured, as a table, as files and as a picture.

use core::fmt;

use serde::Serialize;

use super::conclusions::{
    Found, Judged, Motion, Order, Theory, advice, orders, pareto_front, size,
};
use super::measure::{Moment, Outcome};
use super::method::Family;
use super::quantity::Quantity;
use super::reference::is_lost;
use super::sweep::Sweep;
use super::{Method, Scale};
use crate::engine::{EngineKind, Execution, Impact};
use crate::motion::Integrator;
use crate::output::table::{Table, counted, plain, seconds};
use crate::scene::{Precision, SceneFile};
use crate::study::chart::{Axis, Chart, Mark, Picture, Scale as Division, Series};
use crate::study::fit::quantile;
use crate::study::{Folder, Machine, StudyError, Subject};

/// What was measured of a scene's methods.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// On what.
    pub machine: Machine,
    /// Of what.
    pub subject: Subject,
    /// By what an error is judged.
    pub quantity: Quantity,
    /// The time that is judged.
    pub time: f64,
    /// What errors are small against.
    pub scale: Scale,
    /// What was compared.
    pub sweep: Sweep,
    /// What was measured of each of the sweep's methods.
    pub outcomes: Vec<Outcome>,
    /// The orders of convergence, for each quantity.
    pub orders: Vec<(Quantity, Vec<Order>)>,
    /// The methods that no other one beats in both time and error.
    pub front: Vec<Judged>,
    /// For an error of so much: the fastest method.
    pub advice: Vec<(f64, Judged)>,
    /// What there is to know about it.
    pub notes: Vec<String>,
    #[serde(skip)]
    judged: usize,
}

/// A row of the table of comma-separated values.
#[derive(Serialize)]
struct Row {
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

impl Report {
    pub(super) fn new(
        file: &SceneFile,
        sweep: &Sweep,
        scale: &Scale,
        motion: Motion,
        outcomes: Vec<Outcome>,
        quantity: Quantity,
    ) -> Self {
        let mut report = Self {
            machine: Machine::here(),
            subject: Subject::of(file),
            quantity,
            time: 0.0,
            scale: scale.clone(),
            sweep: sweep.clone(),
            outcomes,
            orders: Vec::new(),
            front: Vec::new(),
            advice: Vec::new(),
            notes: sweep.notes.clone(),
            judged: sweep.times.len().saturating_sub(1),
        };
        // The last time at which anything is to be told.
        while report.judged > 0 && report.results(report.judged, quantity).is_empty() {
            report.judged -= 1;
        }
        report.time = sweep.times.get(report.judged).copied().unwrap_or(0.0);
        report.orders = Quantity::ALL
            .into_iter()
            .map(|quantity| {
                let size = size(quantity, scale.length, scale.speed);
                let results = |time| report.results(time, quantity);
                let times: Vec<_> = (0..=report.judged).map(results).collect();
                (quantity, orders(&times, motion, quantity, size))
            })
            .collect();
        report.front = pareto_front(&report.results(report.judged, quantity));
        report.advice = advice(&report.front);
        report.take_notes(motion);
        report
    }

    fn take_notes(&mut self, motion: Motion) {
        let mut notes = Vec::new();
        if !motion.has_collisions {
            notes.push("Nothing collides: the error is only the integrator's.".to_owned());
        }
        let last = self.sweep.times.last().copied().unwrap_or(0.0);
        if let Some(lost) = self.scale.f32_lost {
            notes.push(format!(
                "Chaotic: event-driven f32 has lost the trajectories at time {lost:.3e}. Lost is \
                 what is off by a tenth of a radius; a number there would be noise."
            ));
            if self.subject.duration.is_some_and(|duration| last < duration) && last < lost {
                notes.push(format!(
                    "So methods are compared up to time {last:.3e}; --duration or --times take it \
                     further.",
                ));
            }
        }
        if self.judged + 1 < self.sweep.times.len() {
            notes.push(format!(
                "At time {last:.3e} every method has lost the trajectories: that is past what can \
                 be foretold. Judged is time {:.3e}.",
                self.time
            ));
        }
        if self.results(self.judged, self.quantity).is_empty() {
            notes.push(
                "Every trajectory is lost at every one of the times: only energy and averages \
                 are figures there. Give a shorter --duration."
                    .to_owned(),
            );
        }
        notes.push("All lanes and threads gave the same bits.".to_owned());
        self.notes.append(&mut notes);
    }

    /// Whether a trajectory is lost.
    fn is_lost(&self, moment: &Moment) -> bool {
        let far = |deviation| is_lost(&deviation, self.scale.length);
        self.scale.f32_lost.is_some() && moment.deviation.is_some_and(far)
    }

    /// The error of a quantity; `None` where it is lost or not finite.
    fn error(&self, moment: &Moment, quantity: Quantity) -> Option<f64> {
        let is_told = quantity == Quantity::Energy || !self.is_lost(moment);
        moment.deviation.filter(|_| is_told).map(|deviation| quantity.of(&deviation))
    }

    /// Times on the wall and errors of all methods that are not lost at one of
    /// the times.
    fn results(&self, time: usize, quantity: Quantity) -> Vec<Judged> {
        let methods = self.sweep.methods.iter().zip(&self.outcomes);
        methods
            .filter_map(|(method, outcome)| {
                let error = self.error(outcome.moments.get(time)?, quantity)?;
                Some(Judged { method: *method, seconds: outcome.timings.first()?.median, error })
            })
            .collect()
    }

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

    fn rows(&self) -> Vec<Row> {
        let methods = self.sweep.methods.iter().zip(&self.outcomes);
        let rows = methods.flat_map(|(method, outcome)| {
            let runs = self.sweep.executions.iter().zip(&outcome.timings);
            runs.flat_map(move |(execution, timing)| {
                outcome.moments.iter().map(move |moment| {
                    let figure = |quantity: Quantity| moment.deviation.map(|d| quantity.of(&d));
                    let stepping = method.stepping;
                    Row {
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
        let place = |result: &Judged| (result.seconds, result.error);
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
                    .map(place)
                    .collect(),
            })
            .collect();
        series.push(Series {
            name: "no other is faster and better".to_owned(),
            color: None,
            mark: Mark::Rings,
            points: self.front.iter().map(place).collect(),
        });
        Picture {
            charts: vec![Chart {
                title: format!("{}, up to time {:.4}", self.subject.name, self.time),
                x: Axis::new("time on the wall, s", Division::Logarithmic),
                y: Axis::new(
                    &format!("error of {}, {}", self.quantity, self.quantity.unit()),
                    Division::Logarithmic,
                ),
                series,
            }],
        }
    }

    /// All families, in the order of the methods.
    fn families(&self) -> Vec<Family> {
        let mut families = Vec::new();
        for family in self.sweep.methods.iter().map(Method::family) {
            if !families.contains(&family) {
                families.push(family);
            }
        }
        families
    }

    /// Quantities that tell something: without spins no body turns.
    fn told(&self) -> Vec<Quantity> {
        let any = |quantity: &Quantity| {
            let mut moments = self.outcomes.iter().flat_map(|outcome| &outcome.moments);
            moments.any(|moment| moment.deviation.is_some_and(|d| quantity.of(&d) != 0.0))
        };
        Quantity::ALL.into_iter().filter(any).collect()
    }

    fn errors(&self) -> Table {
        let told = self.told();
        let mut table = Table::default();
        let heads = told.iter().map(|quantity| match quantity {
            Quantity::AngularMomentum => "ang. mom.".to_owned(),
            quantity => quantity.to_string(),
        });
        table.row("", ["time", "±"].map(str::to_owned).into_iter().chain(heads));
        for family in self.families() {
            if family.stepping.is_some() {
                table.row(&family.to_string(), []);
            }
            let methods = self.sweep.methods.iter().zip(&self.outcomes);
            for (method, outcome) in methods.filter(|(method, _)| method.family() == family) {
                let (Some(moment), Some(timing)) =
                    (outcome.moments.get(self.judged), outcome.timings.first())
                else {
                    continue;
                };
                let label = match method.stepping {
                    None => family.to_string(),
                    Some(stepping) => format!("  Δt {:.3e}", stepping.dt),
                };
                let spread = (timing.upper_quartile - timing.lower_quartile) / 2.0 / timing.median;
                let errors = told.iter().map(|&quantity| match self.error(moment, quantity) {
                    Some(error) => size_of(error),
                    None if moment.deviation.is_none() => "not finite".to_owned(),
                    None => "lost".to_owned(),
                });
                let times = [seconds(timing.median), format!("{:.0} %", spread * 100.0)];
                table.row(&label, times.into_iter().chain(errors));
            }
        }
        table
    }

    fn orders_of_convergence(&self) -> Table {
        let mut table = Table::default();
        let told = self.told();
        // Those of momentum and angular momentum follow: the files have them.
        let first = &Quantity::ALL[..4];
        let told: Vec<_> = self
            .orders
            .iter()
            .filter(|(quantity, _)| first.contains(quantity) && told.contains(quantity))
            .collect();
        let heads = told.iter().map(|(quantity, _)| quantity.to_string());
        table.row("", ["theory".to_owned()].into_iter().chain(heads));
        let families = self.families();
        for family in families.iter().filter(|family| family.stepping.is_some()) {
            let of = |orders: &[Order]| orders.iter().find(|o| o.family == *family).copied();
            let theory = told.iter().find_map(|(_, orders)| of(orders)).map(|o| o.theory);
            let theory = match theory {
                Some(Theory::First) => "1",
                Some(Theory::Exact) => "exact",
                None => "",
            };
            let found = told.iter().map(|(_, orders)| match of(orders).map(|order| order.found) {
                Some(Found::Power(power)) => format!("{:.2} ± {:.2}", power.value, power.error),
                Some(Found::Rounding(_)) => "rounding".to_owned(),
                Some(Found::Nothing) | None => "–".to_owned(),
            });
            table.row(&format!("  {family}"), [theory.to_owned()].into_iter().chain(found));
        }
        table
    }

    /// How many times as long the other executions take.
    fn executions(&self) -> Table {
        let mut table = Table::default();
        let columns: Vec<(bool, Precision)> = [(false, Precision::F32), (false, Precision::F64)]
            .into_iter()
            .chain([(true, Precision::F32), (true, Precision::F64)])
            .filter(|(stepped, precision)| {
                self.sweep.methods.iter().any(|method| {
                    method.stepping.is_some() == *stepped && method.precision == *precision
                })
            })
            .collect();
        let heads = columns.iter().map(|(stepped, precision)| {
            format!("{}, {precision}", if *stepped { "stepped" } else { "event-driven" })
        });
        table.row("", heads);
        for (k, Execution { lanes, threads }) in self.sweep.executions.iter().enumerate().skip(1) {
            let ratio = |(stepped, precision): &(bool, Precision)| {
                let methods = self.sweep.methods.iter().zip(&self.outcomes);
                let ratios: Vec<f64> = methods
                    .filter(|(method, _)| {
                        method.stepping.is_some() == *stepped && method.precision == *precision
                    })
                    .filter_map(|(_, outcome)| {
                        Some(outcome.timings.get(k)?.ratio_to(outcome.timings.first()?).median)
                    })
                    .collect();
                format!("{:.2} ×", quantile(&ratios, 0.5))
            };
            let label = format!("  lanes {lanes}, {}", counted(*threads as u64, "thread"));
            table.row(&label, columns.iter().map(ratio));
        }
        table
    }

    /// Neighbouring bounds with the same method are one line.
    fn advice_lines(&self) -> Table {
        let mut table = Table::of_texts();
        let groups = self.advice.chunk_by(|(_, one), (_, other)| one.method == other.method);
        for group in groups {
            let Some((bound, result)) = group.last() else { continue };
            let label = match bound {
                0.0 => "  any".to_owned(),
                bound => format!("  down to {bound:.0e}"),
            };
            let found = format!("{}, error {}", seconds(result.seconds), size_of(result.error));
            table.row(&label, [result.method.to_string(), found]);
        }
        table
    }
}

/// The size of an error.
fn size_of(error: f64) -> String {
    if error == 0.0 { "0".to_owned() } else { format!("{error:.1e}") }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let moment = self.outcomes.first().and_then(|outcome| outcome.moments.get(self.judged));
        let collisions = moment.map_or(0.0, |moment| moment.true_collisions);
        writeln!(
            f,
            "{}: errors at time {}, {collisions:.1} collisions of a body, against double-double",
            self.subject.name,
            plain(self.time)
        )?;
        writeln!(f, "{}", self.machine)?;
        if let Some(Execution { lanes, threads }) = self.sweep.executions.first() {
            let threads = counted(*threads as u64, "thread");
            writeln!(f, "Times: median of {} runs, lanes {lanes}, {threads}.", self.sweep.runs)?;
        }
        writeln!(f, "\n{}", self.errors())?;
        writeln!(
            f,
            "Order of convergence, of all times up to there\n{}",
            self.orders_of_convergence()
        )?;
        if self.sweep.executions.len() > 1 {
            writeln!(f, "Time on other executions\n{}", self.executions())?;
        }
        if !self.advice.is_empty() {
            let Self { quantity, .. } = self;
            writeln!(f, "For an error of {quantity} ({}) of, use", quantity.unit())?;
            writeln!(f, "{}", self.advice_lines())?;
        }
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        Ok(())
    }
}
