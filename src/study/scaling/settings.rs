//! Settings: what a scaling study compares.

use std::thread::available_parallelism;

use serde::Serialize;

use crate::engine::{Execution, Lanes, MOST_THREADS};
use crate::scene::EngineKind;
use crate::scene::{MOST_BODIES, Precision};
use crate::study::StudyError;

/// The most runs of a variant.
const MOST_RUNS: usize = 10_000;

/// What is compared. Sizes and threads are swept with the first of the lanes,
/// lanes with the first number of threads, at the middle one of the sizes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Settings {
    /// Numbers of bodies; the scene may [miss](crate::scene::SceneFile::with_bodies)
    /// them a little.
    pub bodies: Vec<u64>,
    /// In which numbers.
    pub precisions: Vec<Precision>,
    /// Numbers of threads. The event-driven engine has one.
    pub threads: Vec<usize>,
    /// How many reals at once.
    pub lanes: Vec<Lanes>,
    /// How often each variant is run.
    pub runs: usize,
}

/// A thousand to a hundred thousand bodies, both precisions, one thread and one
/// for each core, all lanes.
impl Default for Settings {
    fn default() -> Self {
        let cores = available_parallelism().map_or(1, usize::from);
        Self {
            bodies: vec![1_000, 10_000, 100_000],
            precisions: vec![Precision::F32, Precision::F64],
            threads: vec![1, cores.min(MOST_THREADS)],
            lanes: vec![Lanes::Auto, Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen],
            runs: 5,
        }
    }
}

impl Settings {
    /// Settings that an engine can follow: sizes upwards, nothing twice.
    pub(super) fn checked(&self, engine: EngineKind) -> Result<Self, StudyError> {
        let refused = |reason: String| Err(StudyError::Asked(reason));
        let mut settings = self.clone();
        settings.bodies.sort_unstable();
        settings.bodies.dedup();
        for (what, is_empty) in [
            ("number of bodies", self.bodies.is_empty()),
            ("precision", self.precisions.is_empty()),
            ("number of threads", self.threads.is_empty()),
            ("choice of lanes", self.lanes.is_empty()),
        ] {
            if is_empty {
                return refused(format!("a scaling study needs at least one {what}"));
            }
        }
        if let Some(bodies) = self.bodies.iter().find(|n| !(1..=MOST_BODIES).contains(*n)) {
            return refused(format!("{bodies} bodies: give numbers from 1 to {MOST_BODIES}"));
        }
        if let Some(threads) = self.threads.iter().find(|n| !(1..=MOST_THREADS).contains(*n)) {
            return refused(format!("{threads} threads: give numbers from 1 to {MOST_THREADS}"));
        }
        if self.precisions.contains(&Precision::DoubleDouble) {
            return Err(without_lanes());
        }
        if !(1..=MOST_RUNS).contains(&self.runs) {
            return refused(format!("{} runs: give a number from 1 to {MOST_RUNS}", self.runs));
        }
        settings.precisions = once_each(&self.precisions);
        settings.lanes = once_each(&self.lanes);
        settings.threads = match engine {
            EngineKind::Stepped => once_each(&self.threads),
            EngineKind::EventDriven => vec![1],
        };
        Ok(settings)
    }

    /// What is compared at one of the sizes. The first one is what the others are
    /// compared with.
    pub(super) fn variants(&self, size: usize) -> Vec<Execution> {
        let (threads, lanes) = (self.threads[0], self.lanes[0]);
        let swept =
            self.threads.iter().map(|&threads| Execution::new().threads(threads).lanes(lanes));
        let others = match size == (self.bodies.len() - 1) / 2 {
            true => &self.lanes[1..],
            false => &[],
        };
        swept
            .chain(others.iter().map(|&lanes| Execution::new().threads(threads).lanes(lanes)))
            .collect()
    }
}

/// What a scaling study says to double-double.
pub(super) fn without_lanes() -> StudyError {
    let reason = "a scaling study is of f32 and f64: dd has no lanes, and takes some forty times as \
                  long";
    StudyError::Asked(reason.to_owned())
}

/// Without what was there before.
fn once_each<V: Copy + PartialEq>(values: &[V]) -> Vec<V> {
    let mut kept = Vec::new();
    for &value in values {
        if !kept.contains(&value) {
            kept.push(value);
        }
    }
    kept
}
