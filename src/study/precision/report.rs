//! Report: all that the study found, for a person and for a program.

use core::fmt;

use serde::Serialize;

use super::averages::{Average, averages};
use super::divergence::{Divergence, RunPoint, Threshold, reference_lost};
use super::drift::{Drift, invariants};
use super::run::Track;
use super::side_by_side::SideBySide;
use super::{PRECISIONS, verdict};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::scene::EngineKind;
use crate::study::fit::Estimate;
use crate::study::table::{Table, counted, rounded, wrapped};
use crate::study::{Machine, Subject};

/// Columns of the terminal.
const WIDTH: usize = 100;

/// How many points in time the terminal is shown.
const SHOWN: usize = 12;

/// What the study found. Its `Display` is for a terminal of 100 columns.
#[derive(Clone, Debug, Serialize)]
pub struct PrecisionReport {
    /// On what it was made.
    pub machine: Machine,
    /// Which scene.
    pub subject: Subject,
    /// The engine of all runs.
    pub engine: EngineKind,
    /// How many bodies there are.
    pub bodies: usize,
    /// Runs of each precision.
    pub runs: usize,
    /// The end of the double-double's run.
    pub end: RunPoint,
    /// From where on trajectories are lost.
    pub threshold: Threshold,
    /// Of `f32` and `f64`.
    pub divergences: [Divergence; 2],
    /// Where even the double-double is lost, by the law of the others; behind it
    /// distances mean nothing.
    pub reference_lost: Option<RunPoint>,
    /// Of every invariant, in `f32` and `f64`.
    pub drifts: Vec<Drift>,
    /// What averages lose.
    pub averages: Vec<Average>,
    /// What follows, in sentences.
    pub verdict: Vec<String>,
    /// At each time.
    pub series: Vec<SeriesRow>,
}

/// The runs at a time.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SeriesRow {
    /// Time since the start.
    pub time: f64,
    /// Collisions per body so far.
    pub collisions_per_body: f64,
    /// Root of the mean square distance of the centres of `f32`, length.
    pub f32_distance: Option<f64>,
    /// The same of `f64`.
    pub f64_distance: Option<f64>,
    /// The greatest distance in `f32`, length.
    pub f32_greatest: Option<f64>,
    /// The same in `f64`.
    pub f64_greatest: Option<f64>,
    /// Relative error of the energy in `f32`.
    pub f32_energy: Option<f64>,
    /// The same in `f64`.
    pub f64_energy: Option<f64>,
    /// What no impulse gave of the momentum in `f32`, of the sum of all momenta.
    pub f32_momentum: Option<f64>,
    /// The same in `f64`.
    pub f64_momentum: Option<f64>,
}

impl PrecisionReport {
    /// From the runs side by side, and the further ones of `f32` and `f64`.
    pub(super) fn new(
        subject: Subject,
        engine: EngineKind,
        side_by_side: SideBySide,
        further: [Vec<Track>; 2],
    ) -> Self {
        let threshold = Threshold::of(&side_by_side);
        let divergences = [0, 1].each(|k| {
            Divergence::of(
                PRECISIONS[k],
                &side_by_side.others[k],
                &side_by_side,
                threshold.distance,
            )
        });
        let collisions = side_by_side.collisions_per_body();
        let end = RunPoint {
            time: side_by_side.truth.samples.last().map_or(0.0, |sample| sample.time),
            collisions_per_body: collisions.last().copied().unwrap_or(0.0),
        };
        let epsilons = [f32::EPSILON.to_f64(), f64::EPSILON];
        let tracks = [0, 1].each(|k| {
            let first = core::iter::once(&side_by_side.others[k].track);
            first.chain(&further[k]).collect::<Vec<&Track>>()
        });
        let mut drifts = Vec::new();
        for invariant in invariants(&side_by_side) {
            for k in 0..2 {
                drifts.extend(Drift::of(invariant, PRECISIONS[k], epsilons[k], &tracks[k]));
            }
        }
        let mut report = Self {
            machine: Machine::here(),
            subject,
            engine,
            bodies: side_by_side.bodies,
            runs: tracks[1].len(),
            end,
            threshold,
            reference_lost: reference_lost(&divergences, threshold.distance, end),
            divergences,
            drifts,
            averages: averages(&side_by_side),
            verdict: Vec::new(),
            series: series(&side_by_side, &collisions),
        };
        report.verdict = verdict::verdict(&report);
        report
    }

    /// Whether a point of the run is behind where even the double-double is lost.
    fn is_behind(&self, collisions_per_body: f64) -> bool {
        self.reference_lost.is_some_and(|lost| collisions_per_body > lost.collisions_per_body)
    }
}

fn series(side_by_side: &SideBySide, collisions: &[f64]) -> Vec<SeriesRow> {
    let row = |(k, &collisions_per_body): (usize, &f64)| {
        let time = side_by_side.truth.samples[k].time;
        let [single, double] = side_by_side.others.refs();
        let of = |values: &[Option<f64>]| values.get(k).copied().flatten();
        let drift = |track: &Track, which: usize| {
            track.samples.get(k).and_then(|sample| sample.drift[which])
        };
        SeriesRow {
            time,
            collisions_per_body,
            f32_distance: of(&single.distance),
            f64_distance: of(&double.distance),
            f32_greatest: of(&single.greatest),
            f64_greatest: of(&double.greatest),
            f32_energy: drift(&single.track, 0),
            f64_energy: drift(&double.track, 0),
            f32_momentum: drift(&single.track, 1),
            f64_momentum: drift(&double.track, 1),
        }
    };
    collisions.iter().enumerate().map(row).collect()
}

impl fmt::Display for PrecisionReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let engine = match self.engine {
            EngineKind::Stepped => "stepped",
            EngineKind::EventDriven => "event-driven",
        };
        let bodies = counted(self.bodies as u64, "sphere");
        writeln!(f, "Precision of {}: {bodies}, {engine} engine", self.subject.name)?;
        writeln!(
            f,
            "f32 and f64 beside double-double up to time {}, {} collisions per body",
            short(self.end.time),
            short(self.end.collisions_per_body)
        )?;
        self.show_trajectories(f)?;
        self.show_drifts(f)?;
        self.show_averages(f)?;
        writeln!(f)?;
        for sentence in &self.verdict {
            writeln!(f, "{}", wrapped(sentence, WIDTH - 2).join("\n  "))?;
        }
        Ok(())
    }
}

impl PrecisionReport {
    fn show_trajectories(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Threshold { distance, what } = self.threshold;
        writeln!(f, "\nDistance δ from the double-double, root mean square of all bodies")?;
        let mut table = Table::default();
        table.row("time", ["collisions/body", "f32", "f64"].each(str::to_owned));
        let last = self.series.len().saturating_sub(1);
        let parts = SHOWN.min(last.max(1));
        for k in 0..=parts {
            let Some(row) = self.series.get(k * last / parts) else { continue };
            let of = |value: Option<f64>| match value {
                Some(value) if value > distance => "lost".to_owned(),
                Some(_) if self.is_behind(row.collisions_per_body) => "lost".to_owned(),
                Some(value) => format!("{value:.1e}"),
                None => "-".to_owned(),
            };
            let cells = [of(row.f32_distance), of(row.f64_distance)];
            let collisions = short(row.collisions_per_body);
            table.row(&short(row.time), [collisions].into_iter().chain(cells));
        }
        write!(f, "{table}")?;
        writeln!(f, "lost: δ > {distance:.2e}, {what}\n")?;
        let mut table = Table::of_texts();
        table.row("", PRECISIONS.each(str::to_owned));
        let each = |text: &dyn Fn(&Divergence) -> String| self.divergences.refs().each(text);
        table.row("growth λ of δ ∝ e^(λc), c in collisions per body", each(&growth));
        if self.divergences.iter().any(|d| d.growth.is_some_and(|growth| growth.power.is_some())) {
            table.row("nearer to the points: p of δ ∝ c^p", each(&power));
        }
        table.row("lost at time", each(&|d| lost(d, |point| point.time)));
        table.row("  collisions per body", each(&|d| lost(d, |point| point.collisions_per_body)));
        table.row(
            "first collision out of order",
            each(&|d| {
                d.departures.order.map_or("none".to_owned(), |found| found.collision.to_string())
            }),
        );
        table.row("  time", each(&|d| shown(d.departures.order.map(|found| found.time))));
        table.row(
            "  collisions per body",
            each(&|d| shown(d.departures.order.map(|found| found.collisions_per_body))),
        );
        table.row(
            "first body that meets another one, time",
            each(&|d| shown(d.departures.partner.map(|found| found.time))),
        );
        table.row(
            "  collisions per body",
            each(&|d| shown(d.departures.partner.map(|found| found.collisions_per_body))),
        );
        write!(f, "{table}")?;
        for divergence in &self.divergences {
            if let Some(reason) = &divergence.stopped {
                writeln!(f, "{} stopped: {reason}", divergence.precision)?;
            }
        }
        Ok(())
    }

    fn show_drifts(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.drifts.is_empty() {
            return Ok(());
        }
        let runs = counted(self.runs as u64, "run");
        writeln!(f, "\nDrift of what is conserved, root mean square of {runs}, n collisions")?;
        let mut table = Table::of_texts();
        table.row("", ["", "at the end", "in ε", "exponent of n", "law"].each(str::to_owned));
        for drift in &self.drifts {
            let exponent = drift.exponent.map_or("-".to_owned(), with_error);
            let cells = [
                drift.precision.to_owned(),
                format!("{:.1e}", drift.at_end),
                rounded(drift.in_epsilons),
                exponent,
                drift.law.to_string(),
            ];
            table.row(drift.invariant, cells);
        }
        write!(f, "{table}")
    }

    fn show_averages(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.averages.is_empty() {
            return Ok(());
        }
        writeln!(f, "\nAverages, and what they lose, in statistical errors of the run")?;
        let mut table = Table::of_texts();
        table.row("", ["double-double", "f32", "", "f64", ""].each(str::to_owned));
        for average in &self.averages {
            let truth = match average.error {
                Some(error) => with_error(Estimate { value: average.truth, error }),
                None => format!("{:.6}", average.truth),
            };
            let mut cells = vec![truth];
            for other in average.others {
                let Some(other) = other else {
                    cells.extend(["-".to_owned(), String::new()]);
                    continue;
                };
                cells.push(format!("{:.6}", other.value));
                cells.push(match other.in_errors {
                    Some(errors) => format!("{errors:+.2}"),
                    None => format!("({:+.0e})", other.difference),
                });
            }
            table.row(average.name, cells);
        }
        write!(f, "{table}")
    }
}

/// A figure of a few digits.
pub(super) fn short(value: f64) -> String {
    if value < 0.0 { format!("-{}", rounded(-value)) } else { rounded(value) }
}

/// A figure that may be extrapolated far.
pub(super) fn far(value: f64) -> String {
    if value < 1e6 { short(value) } else { format!("{value:.0e}") }
}

fn shown(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), short)
}

/// A figure with as many digits as its error has two of.
pub(super) fn with_error(Estimate { value, error }: Estimate) -> String {
    if error <= 0.0 || !error.is_finite() {
        return format!("{value:.3}");
    }
    let decimals = (1.0 - error.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$} ± {error:.decimals$}")
}

fn growth(divergence: &Divergence) -> String {
    divergence.growth.map_or("unclear".to_owned(), |growth| with_error(growth.rate))
}

fn power(divergence: &Divergence) -> String {
    let power = divergence.growth.and_then(|growth| growth.power);
    power.map_or("-".to_owned(), with_error)
}

/// Where a trajectory is lost, or would be.
fn lost(divergence: &Divergence, figure: fn(RunPoint) -> f64) -> String {
    match (divergence.lost, divergence.would_be_lost) {
        (Some(point), _) => short(figure(point)),
        (None, Some(point)) => format!("{} by the law", far(figure(point))),
        (None, None) => "not seen".to_owned(),
    }
}
