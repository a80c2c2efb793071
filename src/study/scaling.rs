//! Scaling: time and memory of a scene against the number of its bodies, the
//! threads and the lanes.
//!
//! A [point](Point) is one size in one precision. Its variants, each number of
//! threads and at one size each width of the lanes, are worlds that go through
//! the same steps or collisions in [turn](super::clock): their ratios hold on a
//! machine that others use too, and their states have to end in the same bits.
//!
//! ```
//! use carom::scene::SceneFile;
//! use carom::study::Journal;
//! use carom::study::scaling::{Scaling, Settings};
//!
//! let file = SceneFile::builtin("hard-sphere-fluid").ok_or("no such scene")?;
//! let settings = Settings { bodies: vec![108, 500], runs: 1, ..Settings::default() };
//! let report = Scaling::new(&file, &settings)?.measure(&Journal::unwritten(), &())?;
//! println!("{report}");
//! assert!(report.verdict().is_ok());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod display;
mod files;
mod measure;
mod report;
mod settings;

use serde::Serialize;

use super::{Journal, Machine, Order, Point, StudyError, Subject, Watch};
use crate::scene::EngineKind;
use crate::scene::{Precision, SceneFile};

pub use measure::Measurement;
pub use report::{Power, ScalingReport, SpeedUp};
pub use settings::Settings;

use measure::{Measured, Task};

/// This number of bodies, or fewer, is looked at beforehand.
const SMALL: u64 = 1_000;

/// The study of a scene. What it serialises to is all that its results depend
/// on.
#[derive(Clone, Debug, Serialize)]
pub struct Scaling {
    subject: Subject,
    machine: Machine,
    engine: EngineKind,
    settings: Settings,
    #[serde(skip)]
    sizes: Vec<SceneFile>,
    /// What the time of all is estimated from, and how many bodies it has.
    #[serde(skip)]
    small: (SceneFile, u64),
    #[serde(skip)]
    longest: f64,
}

impl Scaling {
    /// Of a scene file, by the engine that it names.
    ///
    /// # Errors
    /// If the settings ask for nothing or too much, or the scene cannot be
    /// made larger or smaller, or the event-driven engine has no duration in
    /// which to look for collisions.
    pub fn new(file: &SceneFile, settings: &Settings) -> Result<Self, StudyError> {
        let settings = settings.checked(file.engine)?;
        let sizes = settings.bodies.iter().map(|&bodies| file.with_bodies(bodies));
        let least = settings.bodies[0];
        let small = match file.with_bodies(least.min(SMALL)) {
            Ok(small) => (small, least.min(SMALL)),
            // More single bodies than that.
            Err(_) => (file.with_bodies(least)?, least),
        };
        Ok(Self {
            subject: Subject::of(file),
            machine: Machine::here(),
            engine: file.engine,
            sizes: sizes.collect::<Result<_, _>>()?,
            small,
            longest: match file.engine {
                EngineKind::Stepped => f64::MAX,
                EngineKind::EventDriven => file.run_duration()?,
            },
            settings,
        })
    }

    /// Measures all points that the journal does not have.
    ///
    /// # Errors
    /// If a scene of some size cannot be built or run, its collisions run out, or
    /// the journal cannot be written.
    pub fn measure(
        &self,
        journal: &Journal,
        watch: &dyn Watch,
    ) -> Result<ScalingReport, StudyError> {
        let sizes = self.settings.bodies.len();
        // From the smallest to the largest: what earlier points leave in the
        // allocator's hands is little beside what a later one takes.
        let tasks = || {
            (0..sizes).flat_map(|size| {
                let precisions = self.settings.precisions.iter();
                precisions.map(move |&precision| (precision, self.task(size)))
            })
        };
        // What is known already needs no estimate.
        let probe = match journal.len() < tasks().count() {
            true => {
                let (file, bodies) = (&self.small.0, self.small.1);
                Task { file, bodies, ..self.task(0) }.probed(self.settings.precisions[0])?
            }
            false => measure::Probe::default(),
        };
        let points: Vec<Point<'_, Measured>> = tasks()
            .map(|(precision, task)| {
                let key = format!("{} {} bodies", precision.name(), task.bodies);
                Point::new(key, task.seconds(&probe), move || match precision {
                    Precision::F32 => task.measure::<f32>(),
                    Precision::F64 => task.measure::<f64>(),
                })
            })
            .collect();
        let measured = Point::all(&points, journal, Order::OneByOne, watch)?;
        Ok(ScalingReport::of(self, measured))
    }

    /// What is to be done at a size.
    fn task(&self, size: usize) -> Task<'_> {
        Task {
            file: &self.sizes[size],
            bodies: self.settings.bodies[size],
            longest: self.longest,
            variants: self.settings.variants(size),
            runs: self.settings.runs,
        }
    }
}
