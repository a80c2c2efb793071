//! One point of the study: all variants of one size in one precision.

use serde::{Deserialize, Serialize};

use super::settings::without_lanes;
use crate::engine::{Compiled, Execution, World};
use crate::observe::{Totals, state_hash};
use crate::real::Real;
use crate::scene::EngineKind;
use crate::scene::{Precision, SceneFile};
use crate::study::StudyError;
use crate::study::clock::{self, Timing, rounds, seconds};
use crate::study::memory::{forget_peak, peak_resident};
use crate::vec3::Vec3;

/// A run should take so long, seconds: the clock and the scheduler are then a
/// small part of it.
const RUN: f64 = 0.025;

/// The least steps of a run: the stepped engine searches again every ten or
/// twenty steps, which a run has to have its share of.
const LEAST_STEPS: u64 = 40;

/// Collisions of each body before the first run: a lattice has to melt.
const COLLISIONS_BEFORE: u64 = 4;

/// A variant as it was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// The precision's name.
    pub precision: String,
    /// How many bodies there are.
    pub bodies: u64,
    /// Worker threads.
    pub threads: usize,
    /// The name of the choice of lanes.
    pub lanes: String,
    /// Steps of a run, or collisions by the event-driven engine.
    pub work: u64,
    /// Wall time of a run, seconds.
    pub timing: Timing,
    /// Bytes that the engine holds.
    pub bytes: u64,
    /// The greatest resident size of the process with this world alone, the
    /// making of its scene included, bytes. Of the first variant of a size, where
    /// the system says.
    pub peak_resident: Option<u64>,
    /// Making the scene and its world, until the engine can move it, seconds. Of the
    /// first variant of a size.
    #[serde(default)]
    pub set_up: Option<f64>,
    /// The bits of the final state, in hexadecimal digits.
    pub state_hash: String,
}

/// The variants of a size in one precision.
pub(super) type Measured = Vec<Measurement>;

/// What is to be done at a size.
pub(super) struct Task<'a> {
    pub file: &'a SceneFile,
    pub bodies: u64,
    /// How long an event-driven world may go without any collision, time.
    pub longest: f64,
    pub variants: Vec<Execution>,
    pub runs: usize,
}

/// What a small size takes, from which the others are estimated.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Probe {
    /// Making a scene, seconds a body.
    build: f64,
    /// Seconds per body and step, or per collision.
    work: f64,
}

impl Task<'_> {
    /// A short look at this size.
    pub(super) fn probed(&self, precision: Precision) -> Result<Probe, StudyError> {
        match precision {
            Precision::F32 => self.probed_in::<f32>(),
            Precision::F64 => self.probed_in::<f64>(),
            Precision::DoubleDouble => Err(without_lanes()),
        }
    }

    fn probed_in<T: Compiled>(&self) -> Result<Probe, StudyError> {
        let (scene, build) = seconds(|| self.file.build::<T>());
        let mut world = World::new(scene?, self.variants[0])?;
        let bodies = world.plan().bodies as f64;
        let (_, work) = self.warm_up(&mut world, LEAST_STEPS)?;
        let work = if self.is_stepped() { work / bodies } else { work };
        Ok(Probe { build: build / bodies, work })
    }

    /// How long this should take, seconds.
    pub(super) fn seconds(&self, probe: &Probe) -> f64 {
        let bodies = self.bodies as f64;
        let (work, before) = match self.is_stepped() {
            true => (bodies * LEAST_STEPS as f64, 0.0),
            false => (0.0, bodies * COLLISIONS_BEFORE as f64 / 2.0),
        };
        let run = (probe.work * work).max(RUN);
        let variant = run * (self.runs + 1) as f64 + probe.work * before;
        2.0 * probe.build * bodies + variant * self.variants.len() as f64
    }

    fn is_stepped(&self) -> bool {
        self.file.engine == EngineKind::Stepped
    }

    /// Runs all variants.
    pub(super) fn measure<T: Compiled>(&self) -> Result<Measured, StudyError> {
        let knows_peak = forget_peak();
        let (first, set_up) = seconds(|| -> Result<_, StudyError> {
            Ok(World::new(self.file.build::<T>()?, self.variants[0])?)
        });
        let mut first = first?;
        let bodies = first.plan().bodies as u64;
        let before = match self.file.engine {
            EngineKind::Stepped => LEAST_STEPS,
            EngineKind::EventDriven => bodies * COLLISIONS_BEFORE / 2,
        };
        let (warm, mut quickest) = self.warm_up(&mut first, before)?;
        let peak = if knows_peak { peak_resident() } else { None };

        // All others begin again, with the scene made once more: a copy of it from
        // the beginning would have counted as memory of the first.
        let mut worlds = vec![first];
        if let [_, others @ ..] = &self.variants[..]
            && !others.is_empty()
        {
            let scene = self.file.build::<T>()?;
            for &variant in others {
                let mut world = World::new(scene.clone(), variant)?;
                let (done, time) = seconds(|| self.advance(&mut world, warm));
                done?;
                quickest = quickest.min(time / warm as f64);
                worlds.push(world);
            }
        }

        // The quickest variant takes as long as a run should.
        let least = if self.is_stepped() { LEAST_STEPS } else { 1 };
        let work = ((RUN / quickest.max(f64::MIN_POSITIVE)).ceil() as u64).max(least);
        let mut variants: Vec<clock::Variant<'_>> = worlds
            .iter_mut()
            .map(|world| -> clock::Variant<'_> {
                Box::new(move || {
                    let (done, time) = seconds(|| self.advance(world, work));
                    done.map(|()| time)
                })
            })
            .collect();
        let timings = rounds(&mut variants, self.runs)?;
        drop(variants);
        let end = worlds.first().map(|world| Totals::of(&world.bodies(), Vec3::ZERO));
        if end.is_some_and(|totals| !totals.is_finite()) {
            return Err(self.leaves_the_numbers(T::NAME));
        }
        let rows = self.variants.iter().zip(&worlds).zip(timings);
        let rows = rows.enumerate().map(|(k, ((variant, world), timing))| Measurement {
            precision: T::NAME.to_owned(),
            bodies,
            threads: variant.threads,
            lanes: variant.lanes.to_string(),
            work,
            timing,
            bytes: world.bytes() as u64,
            peak_resident: peak.filter(|_| k == 0),
            set_up: (k == 0).then_some(set_up),
            state_hash: state_hash(&world.bodies()).to_string(),
        });
        Ok(rows.collect())
    }

    /// Runs a world until it has done enough for a run and for its caches and
    /// lists to be as they stay. Gives the work done, and the seconds that a piece
    /// of it takes.
    fn warm_up<T: Real>(&self, world: &mut World<T>, least: u64) -> Result<(u64, f64), StudyError> {
        let mut done = 0;
        let mut stretch = 1;
        loop {
            let (result, time) = seconds(|| self.advance(world, stretch));
            result?;
            done += stretch;
            if time >= RUN / 2.0 && done >= least {
                return Ok((done, time / stretch as f64));
            }
            // Not far beyond what is needed: a step can take seconds.
            stretch = match time >= RUN / 2.0 {
                true => (least - done).min(stretch),
                false => stretch.saturating_mul(2),
            };
        }
    }

    /// A number of steps, or of collisions.
    fn advance<T: Real>(&self, world: &mut World<T>, work: u64) -> Result<(), StudyError> {
        match world {
            World::Stepped(world) => world.advance_steps(work),
            World::EventDriven(world) => {
                let mut left = work;
                while left > 0 {
                    match world.advance_until(left, self.longest)? {
                        0 => return Err(self.nothing_happens(world.time())),
                        done => left = left.saturating_sub(done),
                    }
                }
            }
        }
        Ok(())
    }

    fn leaves_the_numbers(&self, precision: &str) -> StudyError {
        StudyError::Asked(format!(
            "with {} bodies in {precision} the state is no longer finite: a smaller --dt, or units \
             in which lengths and speeds are nearer to 1, may keep it in range",
            self.bodies
        ))
    }

    fn nothing_happens(&self, time: f64) -> StudyError {
        StudyError::Asked(format!(
            "with {} bodies there is no collision in the time {} before {time}, and the \
             event-driven engine is measured by its collisions: give a longer --duration, or \
             study the scene with --engine stepped",
            self.bodies, self.longest
        ))
    }
}
