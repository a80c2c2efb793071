//! Measure: the errors of a method, and its time.

use serde::{Deserialize, Serialize};

use super::method::Method;
use super::reference::{Reference, collisions_of_a_body};
use super::sweep::Sweep;
use crate::engine::{Compiled, EngineError, Execution, World};
use crate::numbers::array::Each;
use crate::observe::{StateHash, state_hash};
use crate::real::{DoubleDouble, Real};
use crate::scene::{Precision, Scene, SceneFile};
use crate::study::clock::{Timing, Variant, outlook, rounds, seconds};
use crate::study::deviation::{Deviation, Errors};
use crate::study::{Course, Norm, Packed, StudyError};

/// What was measured of a method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The errors at each of the times.
    pub moments: Vec<Moment>,
    /// The wall time that it takes to the last of the times, on each
    /// execution.
    pub timings: Vec<Timing>,
    /// Of the last state.
    pub state_hash: String,
    /// Of each of the moments, the errors of each body's place, velocity and orientation, in
    /// a journal of points that are not too many.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<[Packed; 3]>,
}

impl Outcome {
    /// The same with the errors of bodies in another norm than the root of the mean square,
    /// and without those of each; `None` where they have not been kept.
    pub(super) fn in_norm(mut self, norm: Norm) -> Option<Self> {
        let bodies = core::mem::take(&mut self.bodies);
        if norm == Norm::RootMeanSquare {
            return Some(self);
        }
        if bodies.len() != self.moments.len() {
            return None;
        }
        for (moment, errors) in self.moments.iter_mut().zip(&bodies) {
            let Some(deviation) = &mut moment.deviation else { continue };
            let [position, velocity, orientation] =
                errors.refs().each(|errors| norm.of(&errors.errors()));
            *deviation = Deviation { position, velocity, orientation, ..*deviation };
        }
        Some(self)
    }
}

/// The error at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// When, in the scene's unit of time: the end of a step, for a method that
    /// has some.
    pub time: f64,
    /// Collisions of a body up to then, on the average.
    pub collisions: f64,
    /// The same of the reference.
    pub true_collisions: f64,
    /// How far the state is from the reference; `None` where it is no longer
    /// finite.
    pub deviation: Option<Deviation>,
}

/// Measures a method.
pub(super) fn measure(
    file: &SceneFile,
    method: &Method,
    sweep: &Sweep,
    reference: &Reference,
) -> Result<Outcome, StudyError> {
    match method.precision {
        Precision::F32 => measure_in::<f32>(file, method, sweep, reference),
        Precision::F64 => measure_in::<f64>(file, method, sweep, reference),
        Precision::DoubleDouble => measure_in::<DoubleDouble>(file, method, sweep, reference),
    }
}

fn measure_in<T: Compiled>(
    file: &SceneFile,
    method: &Method,
    sweep: &Sweep,
    reference: &Reference,
) -> Result<Outcome, StudyError> {
    let end = sweep.times.last().copied().unwrap_or(0.0);
    let scene = method.scene::<T>(file, end)?;
    let mut world = World::new(scene.clone(), Execution::default())?;
    let (mut moments, mut bodies) = (Vec::new(), Vec::new());
    for &stated in &sweep.times {
        advance(&mut world, stated)?;
        let time = method.time_near(stated);
        let Some(state) = reference.at(time) else { continue };
        let now = world.bodies();
        let errors = state.truth.errors(&now);
        let deviation = state.truth.deviation_of(&now, &errors);
        if sweep.keeps_bodies(now.len()) {
            let Errors { position, velocity, orientation } = &errors;
            bodies.push([position, velocity, orientation].each(|errors| Packed::new(errors)));
        }
        moments.push(Moment {
            time,
            collisions: collisions_of_a_body(&world),
            true_collisions: state.collisions,
            deviation: deviation.is_finite().then_some(deviation),
        });
    }
    let hash = state_hash(&world.bodies());
    let variant = |&execution: &Execution| -> Variant<'_> {
        let scene = &scene;
        Box::new(move || timed_run(scene, method, end, execution, hash))
    };
    let mut variants: Vec<_> = sweep.executions.iter().map(variant).collect();
    let timings = rounds(&mut variants, sweep.runs)?;
    Ok(Outcome { moments, timings, state_hash: hash.to_string(), bodies })
}

/// Advances a world to the time nearest to a stated one.
fn advance<T: Real>(world: &mut World<T>, stated: f64) -> Result<(), EngineError> {
    let course = Course::new(world, stated);
    course.finish(world, course.length(), None)
}

/// The seconds from a scene to its end, whose bits have to be these.
fn timed_run<T: Compiled>(
    scene: &Scene<T>,
    method: &Method,
    end: f64,
    execution: Execution,
    hash: StateHash,
) -> Result<f64, StudyError> {
    let scene = scene.clone();
    let (world, seconds) = seconds(|| {
        let mut world = World::new(scene, execution)?;
        advance(&mut world, end)?;
        Ok::<_, EngineError>(world)
    });
    let world = world?;
    let Execution { lanes, threads, .. } = execution;
    if state_hash(&world.bodies()) != hash {
        let what = format!("{method}: other bits in lanes {lanes} on {threads} threads");
        return Err(StudyError::DifferentBits(what));
    }
    Ok(seconds)
}

/// About how many seconds a run of a method to the end takes: those of a few
/// steps, times the number of steps. The least of three: others may have used the
/// machine meanwhile.
pub(super) fn probe(file: &SceneFile, method: &Method, end: f64) -> Result<f64, StudyError> {
    match method.precision {
        Precision::F32 => probe_in::<f32>(file, method, end),
        Precision::F64 => probe_in::<f64>(file, method, end),
        Precision::DoubleDouble => probe_in::<DoubleDouble>(file, method, end),
    }
}

fn probe_in<T: Compiled>(file: &SceneFile, method: &Method, end: f64) -> Result<f64, StudyError> {
    /// Seconds that are enough for an estimate.
    const ENOUGH: f64 = 0.002;
    let scene = method.scene::<T>(file, end)?;
    let alone = Execution { threads: 1, ..Execution::default() };
    (0..3).try_fold(f64::MAX, |least, _| {
        let mut world = World::new(scene.clone(), alone)?;
        let course = Course::new(&world, end);
        Ok(least.min(outlook(&mut world, course, ENOUGH)?))
    })
}
