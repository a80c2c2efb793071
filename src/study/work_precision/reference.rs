//! Reference: what the bodies of a scene should do, and how long that can be
//! known.

use crate::engine::{Compiled, Execution, World};
use crate::numbers::array;
use crate::observe::fall_energy;
use crate::real::{DoubleDouble, Real};
use crate::scene::{Precision, Scene, SceneFile};
use crate::study::deviation::{Deviation, LOST, Truth};
use crate::study::{Course, StudyError};

use super::method::Method;

/// From collision to collision, the only error that of the precision.
const EXACT: Method = Method { precision: Precision::F64, stepping: None };

/// The states of a scene at some times, in double-double.
pub(super) struct Reference {
    states: Vec<State>,
}

/// The state at one time.
pub(super) struct State {
    pub(super) truth: Truth,
    /// Collisions of a body up to then, on the average; each of two that meet
    /// has one.
    pub(super) collisions: f64,
}

impl Reference {
    /// The states at these times, which ascend.
    pub(super) fn new(file: &SceneFile, times: &[f64]) -> Result<Self, StudyError> {
        let last = times.last().copied().unwrap_or(0.0);
        let mut run = Run::<DoubleDouble>::new(EXACT.scene(file, last)?)?;
        let states = times.iter().map(|&time| {
            let truth = run.truth_at(time)?;
            Ok(State { truth, collisions: run.collisions() })
        });
        Ok(Self { states: states.collect::<Result<_, StudyError>>()? })
    }

    /// The state at one of its times.
    pub(super) fn at(&self, time: f64) -> Option<&State> {
        self.states.iter().find(|state| state.truth.time == time)
    }
}

/// An event-driven run that is looked at now and then.
struct Run<T: Real> {
    world: World<T>,
    scene: Scene<T>,
}

impl<T: Compiled> Run<T> {
    fn new(scene: Scene<T>) -> Result<Self, StudyError> {
        Ok(Self { world: World::new(scene.clone(), Execution::default())?, scene })
    }

    fn truth_at(&mut self, time: f64) -> Result<Truth<T>, StudyError> {
        let course = Course::new(&self.world, time);
        course.finish(&mut self.world, course.length(), None)?;
        let fall = fall_energy(&self.scene);
        Ok(Truth::of(&self.world, self.scene.gravity, self.scene.periodic, fall))
    }

    fn collisions(&self) -> f64 {
        collisions_of_a_body(&self.world)
    }
}

/// Collisions of a body so far, on the average; each of two that meet has one.
pub(super) fn collisions_of_a_body<T: Real>(world: &World<T>) -> f64 {
    world.collisions().ends() as f64 / world.plan().bodies as f64
}

/// How far a scene can be predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Horizon {
    /// Up to where methods are compared, in the scene's unit of time.
    pub(super) end: f64,
    /// When `f32` has lost the trajectories, if it has.
    pub(super) f32_lost: Option<f64>,
    /// Collisions up to there, or up to the end of the scene.
    pub(super) collisions: u64,
    /// The greatest root mean square of the speeds that was seen, length per
    /// time.
    pub(super) speed: f64,
}

/// Looks at a scene this many times to find out how far it can be predicted.
const LOOKS: u32 = 32;

/// Methods with steps have errors ten thousand times as great as `f32` at its
/// exact times: they are lost in a part of the time that it takes to lose `f32`.
const PART: f64 = 0.25;

impl Horizon {
    /// Of a scene that is run up to a time.
    pub(super) fn of(file: &SceneFile, end: f64) -> Result<Self, StudyError> {
        let mut fine = Run::<f64>::new(EXACT.scene(file, end)?)?;
        // A scene may be beyond `f32`: its methods will say so.
        let mut coarse = EXACT.scene(file, end).ok().and_then(|scene| Run::<f32>::new(scene).ok());
        let mut horizon = Self { end, f32_lost: None, collisions: 0, speed: 0.0 };
        let length = length_scale(&fine.scene);
        for look in 0..=LOOKS {
            let time = end * f64::from(look) / f64::from(LOOKS);
            let truth = fine.truth_at(time)?;
            let bodies = &truth.bodies;
            let squares = (0..bodies.len()).map(|k| bodies.velocity_of(k).length_squared());
            let speed = (squares.sum::<f64>() / bodies.len() as f64).sqrt();
            horizon.speed = horizon.speed.max(speed);
            horizon.collisions = fine.world.collisions().total();
            let Some(run) = &mut coarse else { continue };
            let Ok(state) = run.truth_at(time) else {
                coarse = None;
                continue;
            };
            let deviation = truth.deviation(&state.bodies);
            if horizon.collisions > 0 && is_lost(&deviation, length) {
                horizon.f32_lost = Some(time);
                horizon.end = end.min(time * PART);
                break;
            }
        }
        Ok(horizon)
    }
}

/// The length that decides which bodies meet: the greatest radius; of points, the
/// greatest way from their middle.
pub(super) fn length_scale<T: Real>(scene: &Scene<T>) -> f64 {
    let bodies = &scene.bodies;
    let radius = bodies.radius.greatest().to_f64();
    if radius > 0.0 {
        return radius;
    }
    let positions = || (0..bodies.len()).map(|k| bodies.position_of(k).cast().to_array());
    let middle = positions().fold([0.0; 3], |sum, position| {
        array::from_fn(|k| sum[k] + position[k] / bodies.len() as f64)
    });
    let distance = |position: [f64; 3]| {
        position.iter().zip(middle).map(|(x, m)| (x - m).powi(2)).sum::<f64>().sqrt()
    };
    let greatest = positions().map(distance).fold(0.0, f64::max);
    if greatest > 0.0 { greatest } else { 1.0 }
}

/// Whether trajectories are lost.
pub(super) fn is_lost(deviation: &Deviation, length: f64) -> bool {
    deviation.position > LOST * length
}
