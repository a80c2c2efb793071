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
//! use carom::study::scaling::{Scaling, Settings};
//! use carom::study::{Journal, Report, Study};
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

use super::{Journal, Machine, Order, Point, Study, StudyError, Subject, Watch};
use crate::scene::EngineKind;
use crate::scene::{Precision, SceneFile};

pub use measure::Measurement;
pub use report::{Power, ScalingReport, SpeedUp};
pub use settings::Settings;
use settings::without_lanes;

use measure::{Measured, Task};

/// This number of bodies, or fewer, is looked at beforehand.
const SMALL: u64 = 1_000;

/// The study of a scene.
#[derive(Clone, Debug)]
pub struct Scaling {
    subject: Subject,
    machine: Machine,
    engine: EngineKind,
    settings: Settings,
    sizes: Vec<SceneFile>,
    /// What the time of all is estimated from, and how many bodies it has.
    small: (SceneFile, u64),
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

impl Study for Scaling {
    const NAME: &'static str = "scaling";
    const ORDER: Order = Order::OneByOne;
    type Outcome = Measured;
    type Report = ScalingReport;

    fn subject(&self) -> Option<Subject> {
        Some(self.subject.clone())
    }

    fn settings(&self) -> impl Serialize {
        (&self.machine, self.engine, &self.settings)
    }

    fn points(
        &self,
        journal: &Journal,
        _: &dyn Watch,
    ) -> Result<Vec<Point<'_, Measured>>, StudyError> {
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
        let points = tasks().map(|(precision, task)| {
            let key = format!("{} {} bodies", precision.name(), task.bodies);
            Point::new(key, task.seconds(&probe), move || match precision {
                Precision::F32 => task.measure::<f32>(),
                Precision::F64 => task.measure::<f64>(),
                Precision::DoubleDouble => Err(without_lanes()),
            })
        });
        Ok(points.collect())
    }

    fn report(&self, measured: Vec<Measured>, _: Option<f64>) -> Result<ScalingReport, StudyError> {
        Ok(ScalingReport::of(self, measured))
    }
}
