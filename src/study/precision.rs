//! Precision: the same scene in `f32`, `f64` and double-double, side by side in
//! time. How long trajectories hold, how invariants drift, and what averages
//! lose.
//!
//! ```
//! use carom::scene::SceneFile;
//! use carom::study::precision::PrecisionStudy;
//! use carom::study::{Journal, Study};
//!
//! let mut file = SceneFile::builtin("superball").ok_or("no such scene")?;
//! file.duration = Some(2.0);
//! let study = PrecisionStudy::new(&file, 2, 16)?;
//! let report = study.measure(&Journal::unwritten(), &())?;
//! println!("{report}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod averages;
pub mod divergence;
pub mod drift;
mod files;
pub mod order;
mod report;
pub mod run;
mod side_by_side;
mod verdict;

use serde::{Deserialize, Serialize};

pub use divergence::RunPoint;
pub use report::{PrecisionReport, SeriesRow};
pub use side_by_side::{Comparison, SideBySide};

use super::{Journal, Order, Point, Study, StudyError, Subject, Watch};
use crate::engine::Compiled;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::scene::SceneFile;
use run::{Run, Track};

/// The most runs of each precision: their speeds differ by less than twice.
pub const MOST_RUNS: u64 = 64;

/// The fewest points in time: fewer make no law.
pub const FEWEST_SAMPLES: u64 = 8;

/// The most points in time at which the runs are compared.
pub const MOST_SAMPLES: u64 = 10_000;

/// How many times as long as `f64` double-double takes, roughly.
const COST: f64 = 40.0;

/// Seconds of wall time that the probe before the study may take.
const PROBE: f64 = 0.1;

/// The two precisions that are studied, finest last.
pub const PRECISIONS: [&str; 2] = [<f32 as Real>::NAME, <f64 as Real>::NAME];

/// A study of what precision a scene needs.
#[derive(Clone, Debug)]
pub struct PrecisionStudy {
    file: SceneFile,
    duration: f64,
    runs: u32,
    samples: u32,
}

/// What a point gives.
#[derive(Debug, Serialize, Deserialize)]
pub enum Outcome {
    /// The three precisions at the same times.
    SideBySide(Box<SideBySide>),
    /// One of the further runs.
    Run(Track),
}

impl PrecisionStudy {
    /// A study of a scene by its own engine, with `runs` runs of each precision
    /// and `samples` points in time.
    ///
    /// # Errors
    /// If the scene has a mistake or no duration, or for numbers that make no
    /// study.
    pub fn new(file: &SceneFile, runs: u64, samples: u64) -> Result<Self, StudyError> {
        if !(1..=MOST_RUNS).contains(&runs) {
            return Err(StudyError::Asked(format!(
                "{runs} runs cannot be made; ask for 1 to {MOST_RUNS}"
            )));
        }
        if !(FEWEST_SAMPLES..=MOST_SAMPLES).contains(&samples) {
            return Err(StudyError::Asked(format!(
                "{samples} points in time are no good; ask for {FEWEST_SAMPLES} to {MOST_SAMPLES}"
            )));
        }
        let duration = file.run_duration()?;
        // Mistakes in the scene come before the folder is made.
        let scene = file.build::<f64>()?;
        if scene.bodies.is_empty() {
            return Err(StudyError::Asked("the scene has no spheres".to_owned()));
        }
        Ok(Self { file: file.clone(), duration, runs: runs as u32, samples: samples as u32 })
    }

    /// One of the further runs, from a start of its own.
    fn run<T: Compiled>(&self, number: u32) -> Result<Outcome, StudyError> {
        Ok(Outcome::Run(Track::of::<T>(&self.file, self.duration, self.samples, number)))
    }

    /// Seconds that a run in `f64` should take, from the beginning of one; a guess
    /// for one that stops.
    fn seconds(&self) -> f64 {
        let run = Run::<f64>::new(&self.file, self.duration, self.samples, 0);
        run.and_then(|mut run| run.probe(PROBE)).unwrap_or(1.0)
    }
}

impl Study for PrecisionStudy {
    const NAME: &'static str = "precision";
    const ORDER: Order = Order::AtOnce;
    type Outcome = Outcome;
    type Report = PrecisionReport;

    fn subject(&self) -> Option<Subject> {
        Some(Subject::of(&self.file))
    }

    /// More runs leave the others as they are.
    fn settings(&self) -> impl Serialize {
        (self.file.engine, self.samples)
    }

    fn points(&self, _: &Journal, _: &dyn Watch) -> Result<Vec<Point<'_, Outcome>>, StudyError> {
        let seconds = self.seconds();
        let mut points = vec![Point::new("side by side", seconds * COST, || {
            let side_by_side = SideBySide::measured(&self.file, self.duration, self.samples)?;
            Ok(Outcome::SideBySide(Box::new(side_by_side)))
        })];
        for run in 1..self.runs {
            let [single, double] = PRECISIONS.each(|name| format!("{name}, run {run}"));
            points.push(Point::new(single, seconds, move || self.run::<f32>(run)));
            points.push(Point::new(double, seconds, move || self.run::<f64>(run)));
        }
        Ok(points)
    }

    /// An engine that stops in a lower precision is a result.
    fn report(
        &self,
        outcomes: Vec<Outcome>,
        _: Option<f64>,
    ) -> Result<PrecisionReport, StudyError> {
        let (mut side_by_side, mut tracks) = (None, [Vec::new(), Vec::new()]);
        for (index, outcome) in outcomes.into_iter().enumerate() {
            match outcome {
                Outcome::SideBySide(found) => side_by_side = Some(*found),
                Outcome::Run(track) => tracks[(index + 1) % 2].push(track),
            }
        }
        let side_by_side = side_by_side
            .ok_or_else(|| StudyError::Asked("the journal lacks its first point".to_owned()))?;
        Ok(PrecisionReport::new(Subject::of(&self.file), self.file.engine, side_by_side, tracks))
    }
}
