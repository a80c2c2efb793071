//! Sweep: which methods are compared, at which times, on what.

use std::thread;

use serde::{Deserialize, Serialize};

use super::method::{Method, Stepping};
use super::quantity::Quantity;
use super::reference::{Horizon, length_scale};
use crate::engine::{Execution, Lanes, Plan};
use crate::motion::Integrator;
use crate::scene::EngineKind;
use crate::scene::Impact;
use crate::scene::{Precision, Scene, SceneFile};
use crate::study::{Norm, StudyError};

/// What a person asks for; what is left out is chosen to suit the scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    /// Up to when, whatever can be predicted, in the scene's unit of time.
    pub duration: Option<f64>,
    /// Times of comparison, in the scene's unit of time; the last one is judged.
    pub times: Vec<f64>,
    /// Engines.
    pub engines: Vec<EngineKind>,
    /// Integrators of the stepped engine.
    pub integrators: Vec<Integrator>,
    /// Impacts of the stepped engine.
    pub impacts: Vec<Impact>,
    /// Lengths of a step, in the scene's unit of time.
    pub steps: Vec<f64>,
    /// Precisions.
    pub precisions: Vec<Precision>,
    /// Lane widths.
    pub lanes: Vec<Lanes>,
    /// Numbers of threads.
    pub threads: Vec<usize>,
    /// Timed runs of each method.
    pub runs: Option<usize>,
    /// By what an error is judged; what is measured does not depend on it.
    pub quantity: Quantity,
    /// And by which norm of all bodies.
    pub norm: Norm,
}

/// What is compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Times of comparison, ascending; the last one is judged.
    pub times: Vec<f64>,
    /// All methods, those with steps from the longest to the shortest.
    pub methods: Vec<Method>,
    /// On what each is run. The first is the one whose time stands for the
    /// method's.
    pub executions: Vec<Execution>,
    /// Timed runs of each method on each.
    pub runs: usize,
    /// What was left out of it, and why.
    pub notes: Vec<String>,
}

/// The most lengths of a step, times or runs.
const MOST: usize = 1000;

/// The number of longer and of shorter steps than the scene's own.
const LADDER: i32 = 3;

/// The ratio of each to the next. Halved steps would share their ends:
/// an impact that falls right behind one would do so again and again.
const RATIO: f64 = 1.9;

/// The number of steps must differ from one more.
const MOST_STEPS: f64 = 1e12;

impl Sweep {
    /// What suits a scene that can be predicted so far.
    pub(super) fn new(
        file: &SceneFile,
        asked: &Asked,
        horizon: &Horizon,
        scene: &Scene<f64>,
    ) -> Result<Self, StudyError> {
        let mut notes = Vec::new();
        let times = times(asked, horizon.end)?;
        let end = times.last().copied().unwrap_or(horizon.end);
        let plan = Plan::new(scene, EngineKind::Stepped, Execution::default(), 1);
        let meets = plan.has_pairs || plan.features > 0;

        let integrators = match asked.integrators.as_slice() {
            [] if plan.has_field => vec![
                Integrator::SemiImplicitEuler,
                Integrator::ExplicitEuler,
                Integrator::VelocityVerlet,
            ],
            [] => {
                notes.push(
                    "Without gravity the integrators are one: free flight is a straight line."
                        .to_owned(),
                );
                vec![scene.stepped.integrator]
            }
            asked => asked.to_vec(),
        };
        let impacts = match asked.impacts.as_slice() {
            [] if meets => vec![Impact::EndOfStep, Impact::SubStep],
            [] => vec![scene.stepped.impact],
            asked => asked.to_vec(),
        };
        let precisions = or(&asked.precisions, &[Precision::F32, Precision::F64]);
        let engines = or(&asked.engines, &[EngineKind::EventDriven, EngineKind::Stepped]);
        let steps = match asked.steps.as_slice() {
            [] => ladder(file, scene, horizon, end),
            asked => {
                let mut steps = checked("steps", asked)?;
                steps.reverse();
                steps
            }
        };
        let mut methods = Vec::new();
        for &precision in &precisions {
            if engines.contains(&EngineKind::EventDriven) {
                let exact = Method { precision, stepping: None };
                if exact.is_reference() {
                    notes.push(THE_REFERENCE.to_owned());
                } else {
                    methods.push(exact);
                }
            }
            if !engines.contains(&EngineKind::Stepped) {
                continue;
            }
            for &integrator in &integrators {
                for &impact in &impacts {
                    methods.extend(steps.iter().map(|&dt| {
                        let is_finest = precision == Precision::DoubleDouble;
                        let dt = if is_finest { short(dt) } else { dt };
                        Method { precision, stepping: Some(Stepping { integrator, impact, dt }) }
                    }));
                }
            }
        }
        if methods.is_empty() {
            return Err(StudyError::Asked(format!(
                "nothing is left to compare: {}",
                THE_REFERENCE.replacen('E', "e", 1)
            )));
        }
        let runs = asked.runs.unwrap_or(5);
        if runs == 0 || runs > MOST {
            return Err(StudyError::Asked(format!("{runs} runs: from 1 to {MOST} can be made")));
        }
        Ok(Self { times, methods, executions: executions(asked), runs, notes })
    }
}

/// A step of 26 binary digits, whose multiples up to 2²⁷ are exact: times are `f64`, and a
/// rounded end of a step would be an error of 10⁻¹⁶ in itself.
fn short(dt: f64) -> f64 {
    const LEFT_OUT: u64 = 27;
    let half = 1 << (LEFT_OUT - 1);
    f64::from_bits((dt.to_bits() + half) >> LEFT_OUT << LEFT_OUT)
}

/// Why a method is left out.
const THE_REFERENCE: &str = "Event-driven dd is the reference itself, and has no error to show: dd \
                             is compared in steps only, whose errors are those of the steps down to \
                             some 1e-30. Its steps are rounded to 26 binary digits, so that they \
                             end at times of f64.";

/// The most errors of single bodies that a journal keeps: 160 MB of its text.
const MOST_KEPT: usize = 20_000_000;

impl Sweep {
    /// Whether the errors of each body are kept, of this number of them.
    pub(super) fn keeps_bodies(&self, bodies: usize) -> bool {
        let moments = self.methods.len() * self.times.len();
        bodies.saturating_mul(moments) <= MOST_KEPT
    }
}

/// What was asked for, or else the usual.
fn or<V: Clone>(asked: &[V], usual: &[V]) -> Vec<V> {
    if asked.is_empty() { usual.to_vec() } else { asked.to_vec() }
}

/// Positive, ascending, and not too many.
fn checked(what: &str, asked: &[f64]) -> Result<Vec<f64>, StudyError> {
    let mut values = asked.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() > MOST {
        return Err(StudyError::Asked(format!("{} {what}: give at most {MOST}", values.len())));
    }
    match values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
        Some(value) => Err(StudyError::Asked(format!(
            "{what}: {value} is not possible; give finite numbers greater than 0"
        ))),
        None => Ok(values),
    }
}

/// The times asked for, or the ends of each eighth of the way.
fn times(asked: &Asked, end: f64) -> Result<Vec<f64>, StudyError> {
    match asked.times.as_slice() {
        [] => Ok((1..=8).map(|eighth| end * f64::from(eighth) / 8.0).collect()),
        asked => checked("times", asked),
    }
}

/// Lengths of a step around the scene's own, from the longest to the shortest.
/// All divide an eighth of the way into whole numbers of steps.
fn ladder(file: &SceneFile, scene: &Scene<f64>, horizon: &Horizon, end: f64) -> Vec<f64> {
    let dt = file.dt.unwrap_or_else(|| {
        // Without one, in which a body flies 0.02 diameters.
        let way = 0.04 * length_scale(scene);
        let falls = scene.gravity.length() * end;
        way / horizon.speed.max(falls / 2.0).max(f64::MIN_POSITIVE)
    });
    let eighths = (end / dt / 8.0).clamp(RATIO.powi(LADDER), MOST_STEPS);
    let mut steps: Vec<f64> =
        (-LADDER..=LADDER).map(|rung| end / (8.0 * (eighths * RATIO.powi(rung)).round())).collect();
    steps.dedup();
    steps
}

/// The fastest lanes on one thread and on all, and one lane on one thread.
fn executions(asked: &Asked) -> Vec<Execution> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let of = |lanes, threads| Execution::new().lanes(lanes).threads(threads);
    if asked.lanes.is_empty() && asked.threads.is_empty() {
        let mut usual = vec![of(Lanes::Auto, 1), of(Lanes::Scalar, 1)];
        if cores > 1 {
            usual.push(of(Lanes::Auto, cores));
        }
        return usual;
    }
    let lanes = or(&asked.lanes, &[Lanes::Auto]);
    let threads = or(&asked.threads, &[1]);
    lanes.iter().flat_map(|&lanes| threads.iter().map(move |&threads| of(lanes, threads))).collect()
}
