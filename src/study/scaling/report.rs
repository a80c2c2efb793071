//! Report: what follows from the measured variants.

use serde::Serialize;

use super::measure::{Measured, Measurement};
use super::{Scaling, Settings};
use crate::scene::EngineKind;
use crate::study::clock::Timing;
use crate::study::fit::{Estimate, power};
use crate::study::{Machine, Subject};

/// What a scaling study found.
#[derive(Clone, Debug, Serialize)]
pub struct ScalingReport {
    /// The scene.
    pub subject: Subject,
    /// On what it was measured.
    pub machine: Machine,
    /// The engine that moved it.
    pub engine: EngineKind,
    /// What was compared.
    pub settings: Settings,
    /// The variants of each precision and size.
    pub points: Vec<Vec<Measurement>>,
    /// How the time grows.
    pub powers: Vec<Power>,
    /// What threads and lanes give.
    pub speed_ups: Vec<SpeedUp>,
    /// Variants that do not end in the same bits as the first one of their size,
    /// in words. There should be none.
    pub differing: Vec<String>,
}

/// The law that time follows in one precision on a number of threads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Power {
    /// The precision's name.
    pub precision: String,
    /// Worker threads.
    pub threads: usize,
    /// `p` of the time of a step of all bodies, or of a collision, `∝ Nᵖ`.
    pub power: Estimate,
}

/// How many times as fast a variant is as another one of the same size.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedUp {
    /// The precision's name.
    pub precision: String,
    /// How many bodies there are.
    pub bodies: u64,
    /// Of the variant.
    pub threads: usize,
    /// Of the variant.
    pub lanes: String,
    /// Of the one it is compared with.
    pub threads_before: usize,
    /// Of the one it is compared with.
    pub lanes_before: String,
    /// Median of the ratios in one round.
    pub median: f64,
    /// A quarter of the ratios is less.
    pub lower_quartile: f64,
    /// A quarter of the ratios is more.
    pub upper_quartile: f64,
}

impl ScalingReport {
    pub(super) fn of(study: &Scaling, points: Vec<Measured>) -> Self {
        let Scaling { subject, machine, engine, settings, .. } = study.clone();
        let powers = powers(&settings, &points);
        let speed_ups = points.iter().flat_map(|rows| speed_ups(&settings, rows)).collect();
        let differing = points.iter().flat_map(|rows| differing(rows)).collect();
        Self { subject, machine, engine, settings, points, powers, speed_ups, differing }
    }

    /// All variants that threads are compared by.
    pub(super) fn sweep<'a>(
        &'a self,
        precision: &'a str,
        threads: usize,
    ) -> impl Iterator<Item = &'a Measurement> {
        sweep(&self.settings, &self.points, precision, threads)
    }

    /// What the times are per: of one variant, nanoseconds per second of a run.
    pub(super) fn nanoseconds(&self, row: &Measurement) -> Timing {
        let per = match self.engine {
            EngineKind::Stepped => row.work as f64 * row.bodies as f64,
            EngineKind::EventDriven => row.work as f64,
        };
        Timing::of(row.timing.runs.iter().map(|seconds| seconds * 1e9 / per).collect())
    }
}

/// The variants of all sizes in a precision on a number of threads.
fn sweep<'a>(
    settings: &'a Settings,
    points: &'a [Measured],
    precision: &'a str,
    threads: usize,
) -> impl Iterator<Item = &'a Measurement> {
    let lanes = settings.lanes[0].name();
    points.iter().flatten().filter(move |row| {
        row.precision == precision && row.threads == threads && row.lanes == lanes
    })
}

fn powers(settings: &Settings, points: &[Measured]) -> Vec<Power> {
    let mut powers = Vec::new();
    for &precision in &settings.precisions {
        let precision = precision.name();
        for &threads in &settings.threads {
            let rows = sweep(settings, points, precision, threads);
            // Work is a step or a collision.
            let times = rows.map(|row| (row.bodies as f64, row.timing.median / row.work as f64));
            if let Some(power) = power(&times.collect::<Vec<_>>()) {
                powers.push(Power { precision: precision.to_owned(), threads, power });
            }
        }
    }
    powers
}

/// Threads against the first number of them, lanes against the scalar path.
fn speed_ups(settings: &Settings, rows: &[Measurement]) -> Vec<SpeedUp> {
    let Some(first) = rows.first() else { return Vec::new() };
    let base = settings.lanes[0].name();
    let scalar = rows.iter().find(|row| row.lanes == "scalar").unwrap_or(first);
    let by_threads = rows.iter().filter(|row| row.lanes == base && row.threads != first.threads);
    let has_lanes = rows.iter().any(|row| row.lanes != base);
    let by_lanes = rows
        .iter()
        .filter(|row| has_lanes && row.threads == first.threads && row.lanes != scalar.lanes);
    let pairs = by_threads.map(|row| (row, first)).chain(by_lanes.map(|row| (row, scalar)));
    let speed_up = |(row, before): (&Measurement, &Measurement)| {
        let ratio = before.timing.ratio_to(&row.timing);
        SpeedUp {
            precision: row.precision.clone(),
            bodies: row.bodies,
            threads: row.threads,
            lanes: row.lanes.clone(),
            threads_before: before.threads,
            lanes_before: before.lanes.clone(),
            median: ratio.median,
            lower_quartile: ratio.lower_quartile,
            upper_quartile: ratio.upper_quartile,
        }
    };
    pairs.map(speed_up).collect()
}

/// The variants that end in other bits than the first one, in words.
fn differing(rows: &[Measurement]) -> Vec<String> {
    let Some(first) = rows.first() else { return Vec::new() };
    let other = rows.iter().filter(|row| row.state_hash != first.state_hash);
    let words = |row: &Measurement| {
        format!(
            "{} with {} bodies: threads {}, lanes {} give {}, and threads {}, lanes {} give {}",
            row.precision,
            row.bodies,
            row.threads,
            row.lanes,
            row.state_hash,
            first.threads,
            first.lanes,
            first.state_hash
        )
    };
    other.map(words).collect()
}
