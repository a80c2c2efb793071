//! Run: a scene in one precision, looked at in equal parts of its time.

use serde::{Deserialize, Serialize};

use super::order::Seen;
use crate::bodies::Bodies;
use crate::engine::{Compiled, Event, Execution, Listener, World};
use crate::lane::Lane;
use crate::numbers::array::Each;
use crate::observe::{Temperature, fall_energy};
use crate::real::{DoubleDouble, Real};
use crate::scene::EngineKind;
use crate::scene::{Encounters, SceneFile};
use crate::space::PeriodicBox;
use crate::study::clock::outlook;
use crate::study::invariants::Invariants;
use crate::study::{Course, StudyError};
use crate::vec3::Vec3;

/// By how much the speeds of one run differ from those of the next.
const SPEEDS: i32 = 64;

/// What is seen of a run at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Time since the start.
    pub time: f64,
    /// Collisions so far.
    pub collisions: u64,
    /// Ends of flights so far: a collision of two bodies ends two.
    pub ends: u64,
    /// How far energy, momentum and angular momentum are from what they should
    /// be ([`Invariants::change_since`]); `None` where that is no number.
    pub drift: [Option<f64>; 3],
    /// `kT` of the centres' motion, energy.
    pub translational: Option<f64>,
    /// `kT` of the spins, energy.
    pub rotational: Option<f64>,
    /// `Σ σ|J_n|` over the pair collisions so far, mass × length² per time.
    pub virial: f64,
    /// Length of all flights so far, where the engine knows it.
    pub path: Option<f64>,
}

/// What was seen of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Track {
    /// From the start to the end, or to where it stopped.
    pub samples: Vec<Sample>,
    /// Why it stopped before its end.
    pub stopped: Option<String>,
}

/// A finite number; JSON has no other.
pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// A run under way.
pub(super) struct Run<T: Real> {
    world: World<T>,
    course: Course,
    samples: u32,
    start: Invariants,
    mass: DoubleDouble,
    /// The uniform field.
    pub(super) gravity: Vec3<DoubleDouble>,
    /// The periodic box, if there is one.
    pub(super) periodic: Option<PeriodicBox<T>>,
    /// The potential energy that bodies can fall through.
    pub(super) fall: f64,
    /// The greatest radius, length.
    pub(super) radius: f64,
    /// Whether a body can meet something fixed.
    pub(super) has_surroundings: bool,
}

impl<T: Compiled> Run<T> {
    /// At the start. All speeds of run `number` are `f = 1 + number/64` times
    /// those of the scene, and gravity `f²` times: the same paths at another
    /// pace, with other roundings.
    pub(super) fn new(
        file: &SceneFile,
        duration: f64,
        samples: u32,
        number: u32,
    ) -> Result<Self, StudyError> {
        let mut scene = file.build::<T>()?;
        let factor = T::ONE + T::whole(number as i32) / T::whole(SPEEDS);
        scene.bodies.scale_motion(factor);
        scene.gravity = scene.gravity * (factor * factor);
        let gravity = scene.gravity.cast::<DoubleDouble>();
        let (periodic, radius) = (scene.periodic, scene.bodies.radius.greatest().to_f64());
        let has_surroundings =
            scene.encounters != Encounters::None && !scene.surroundings.is_empty();
        let masses =
            (0..scene.bodies.len()).map(|index| scene.bodies.mass.of(index).cast::<DoubleDouble>());
        let mass = masses.fold(DoubleDouble::ZERO, |sum, mass| sum + mass);
        let start = Invariants::of(&scene.bodies, gravity);
        let fall = fall_energy(&scene);
        // Other runs are made at the same time.
        let world = World::new(scene, Execution { threads: 1, ..Execution::default() })?;
        let course = Course::new(&world, duration);
        Ok(Self {
            world,
            course,
            samples,
            start,
            mass,
            gravity,
            periodic,
            fall,
            radius,
            has_surroundings,
        })
    }

    /// The world as it is.
    pub(super) fn world(&self) -> &World<T> {
        &self.world
    }

    /// Goes on to a point in time, the last of which is the end, and notes the
    /// collisions on the way if they are read.
    pub(super) fn advance(
        &mut self,
        point: u32,
        seen: Option<&mut Vec<Seen>>,
    ) -> Result<(), StudyError> {
        let part = self.course.length() * f64::from(point) / f64::from(self.samples);
        let mark = match self.world.plan().engine {
            EngineKind::Stepped => part.round(),
            EngineKind::EventDriven => part,
        };
        let mut note;
        let on_event: Listener<'_, T> = match seen {
            None => None,
            Some(seen) => {
                note = |event: &Event<T>| seen.push(Seen::of(event));
                Some(&mut note)
            }
        };
        Ok(self.course.finish(&mut self.world, mark, on_event)?)
    }

    /// Looks at the bodies, which are those of the world now.
    pub(super) fn sample(&self, bodies: &Bodies<T>) -> Sample {
        let collisions = self.world.collisions();
        let ends = collisions.ends();
        let time = self.world.time();
        let mut now = Invariants::of(bodies, self.gravity);
        let given = self.world.impulse_from_surroundings();
        let fallen = self.gravity * (self.mass * DoubleDouble::from_f64(time));
        let given = Vec3::from(given.each(DoubleDouble::from_f64));
        now.momentum = now.momentum - given - fallen;
        // Bodies at the top of their paths have hardly any momentum themselves.
        let exchanged = given.length().high().max(fallen.length().high());
        now.momentum_scale = now.momentum_scale.max(exchanged);
        let temperature = Temperature::of(bodies);
        Sample {
            time,
            collisions: collisions.total(),
            ends,
            drift: now.change_since(&self.start, self.fall).each(finite),
            translational: temperature.and_then(|gas| finite(gas.translational)),
            rotational: temperature.and_then(|gas| finite(gas.rotational)),
            virial: finite(self.world.virial()).unwrap_or(0.0),
            path: self.world.mean_free_path().and_then(|mean| finite(mean * ends as f64)),
        }
    }

    /// Seconds that the whole way should take, from a number of seconds of its beginning.
    pub(super) fn probe(&mut self, longest: f64) -> Result<f64, StudyError> {
        Ok(outlook(&mut self.world, self.course, longest)?)
    }
}

impl Track {
    /// A whole run.
    pub(super) fn of<T: Compiled>(
        file: &SceneFile,
        duration: f64,
        samples: u32,
        number: u32,
    ) -> Self {
        let mut track = Self::default();
        let mut run = match Run::<T>::new(file, duration, samples, number) {
            Ok(run) => run,
            Err(error) => return Self { stopped: Some(error.to_string()), ..track },
        };
        for point in 0..=samples {
            if let Err(error) = run.advance(point, None) {
                track.stopped = Some(error.to_string());
                break;
            }
            track.samples.push(run.sample(&run.world().bodies()));
        }
        track
    }
}
