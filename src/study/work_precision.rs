//! Run time against error: what each method costs in a scene, and how far off
//! it is.
//!
//! Every method moves the scene from the same start, which is rounded to its own
//! precision. The reference is the event-driven engine in double-double: its
//! times are exact and its rounding is 16 digits below that of `f64`. Time is
//! wall time from a scene in memory to its last state.
//!
//! Collisions make errors grow exponentially. Where a scene's own duration is
//! past what `f32` can predict at all, methods are compared over a quarter of
//! the time that it can; asked for more, it says from when on a
//! trajectory is lost, since a number there would be noise.

mod conclusions;
mod display;
mod files;
mod measure;
mod method;
mod quantity;
mod reference;
mod report;
mod sweep;

use std::sync::Arc;

use serde::Serialize;

use super::{Journal, Order as Turn, Point, Study, StudyError, Subject, Watch};
use crate::scene::{Precision, SceneFile};
use crate::vec3::Vec3;
use conclusions::Motion;
use measure::measure;
use reference::{Horizon, Reference, length_scale};

pub use conclusions::{Found, Judged, Order, Theory};
pub use measure::{Moment, Outcome};
pub use method::{Family, Method, Stepping};
pub use quantity::Quantity;
pub use report::WorkPrecisionReport;
pub use sweep::{Asked, Sweep};

/// The most numbers that reference states may have together: 4 GiB.
const MOST_NUMBERS: f64 = (4_u64 << 30) as f64 / 16.0;

/// What a scene's methods are compared by.
#[derive(Clone, Debug, Serialize)]
pub struct Scale {
    /// An error is small against this length: the greatest radius.
    pub length: f64,
    /// And against this speed: the greatest root mean square of all speeds.
    pub speed: f64,
    /// When event-driven `f32` is off by a tenth of a radius, if it is: the
    /// scene is chaotic.
    pub f32_lost: Option<f64>,
}

/// The study of a scene.
pub struct WorkPrecision {
    file: SceneFile,
    sweep: Sweep,
    scale: Scale,
    motion: Motion,
    quantity: Quantity,
}

impl WorkPrecision {
    /// Looks at a scene, and chooses what is not asked for.
    ///
    /// # Errors
    /// If the scene has a mistake or cannot be run from collision to collision,
    /// or if what is asked for is not possible.
    pub fn new(file: &SceneFile, asked: &Asked) -> Result<Self, StudyError> {
        let stated = asked.times.iter().copied().fold(None, |greatest: Option<f64>, time| {
            Some(greatest.map_or(time, |greatest| greatest.max(time)))
        });
        let duration = match stated.or(asked.duration) {
            Some(duration) => duration,
            None => file.run_duration()?,
        };
        let mut horizon = Horizon::of(file, duration)?;
        if stated.or(asked.duration).is_some() {
            horizon.end = duration;
        }
        let scene =
            Method { precision: Precision::F64, stepping: None }.scene::<f64>(file, horizon.end)?;
        let sweep = Sweep::new(file, asked, &horizon, &scene)?;
        let scale = Scale {
            length: length_scale(&scene),
            speed: horizon.speed,
            f32_lost: horizon.f32_lost,
        };
        let has_field = scene.gravity.to_array() != Vec3::<f64>::ZERO.to_array();
        let motion = Motion { has_field, has_collisions: horizon.collisions > 0 };
        let study = Self { file: file.clone(), sweep, scale, motion, quantity: asked.quantity };
        let numbers = study.times().len() as f64 * scene.bodies.len() as f64 * 19.0;
        if numbers > MOST_NUMBERS {
            return Err(StudyError::Asked(format!(
                "{} bodies at {} different times are too many to compare; give fewer times, or \
                 steps that divide them",
                scene.bodies.len(),
                study.times().len()
            )));
        }
        Ok(study)
    }

    /// What is compared.
    #[must_use]
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// All times at which any method is compared with the reference.
    fn times(&self) -> Vec<f64> {
        let Sweep { times, methods, .. } = &self.sweep;
        let mut all: Vec<f64> = methods
            .iter()
            .flat_map(|method| times.iter().map(|&time| method.time_near(time)))
            .collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}

impl Study for WorkPrecision {
    const NAME: &'static str = "error";
    const ORDER: Turn = Turn::OneByOne;
    type Outcome = Outcome;
    type Report = WorkPrecisionReport;

    fn subject(&self) -> Option<Subject> {
        Some(Subject::of(&self.file))
    }

    fn settings(&self) -> impl Serialize {
        &self.sweep
    }

    fn points(
        &self,
        journal: &Journal,
        watch: &dyn Watch,
    ) -> Result<Vec<Point<'_, Outcome>>, StudyError> {
        let Self { file, sweep, .. } = self;
        let end = sweep.times.last().copied().unwrap_or(0.0);
        let keys: Vec<String> = sweep.methods.iter().map(Method::key).collect();
        let is_ahead = keys.iter().any(|key| !journal.has(key));
        let mut seconds = vec![0.0; keys.len()];
        let mut reference = None;
        if is_ahead {
            watch.says("the reference, in double-double");
            reference = Some(Arc::new(Reference::new(file, &self.times())?));
            watch.says("how long each method takes");
            let runs = (sweep.executions.len() * (sweep.runs + 1) + 1) as f64;
            for (seconds, method) in seconds.iter_mut().zip(&sweep.methods) {
                *seconds = runs * measure::probe(file, method, end)?;
            }
        }
        let point = |((method, key), seconds): ((&Method, String), f64)| {
            let (method, reference) = (*method, reference.clone());
            Point::new(key, seconds, move || match &reference {
                Some(reference) => measure(file, &method, sweep, reference),
                None => Err(StudyError::Asked(format!("{method} has no reference"))),
            })
        };
        Ok(sweep.methods.iter().zip(keys).zip(seconds).map(point).collect())
    }

    fn report(
        &self,
        outcomes: Vec<Outcome>,
        others: Option<f64>,
    ) -> Result<WorkPrecisionReport, StudyError> {
        Ok(WorkPrecisionReport::new(self, outcomes, others))
    }
}
