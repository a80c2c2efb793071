//! Summary: what a run was and what came of it.

mod all_digits;
mod display;

use std::collections::BTreeMap;

use serde::Serialize;

use carom::contact::Surface;
use carom::engine::{Collisions, Exchange, PartTotals, World};
use carom::motion::Integrator;
use carom::observe::{
    AngularMomentum, Energy, Momentum, StateHash, Statistic, Temperature, Totals, collision_rate,
    compressibility, energy_scale, integrator_drift, total_mass,
};
use carom::real::Real;
use carom::scene::{EngineKind, Impact, Scene};
use carom::surroundings::Passages;
use carom::vec3::Vec3;

use super::analyses::Found;
use super::measured::Reading;

pub use all_digits::AllDigits;

/// The corners of a box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Corners {
    /// That with the least coordinates.
    pub lower: [f64; 3],
    /// That with the greatest.
    pub upper: [f64; 3],
}

/// What was run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Setup {
    /// Name of the scene.
    pub scene: String,
    /// In which numbers.
    pub precision: &'static str,
    /// How many numbers a sweep over the bodies works on at once.
    pub lanes: usize,
    /// Threads that worked.
    pub threads: usize,
    /// What moved the scene through time.
    pub engine: EngineKind,
    /// How a step of free flight was taken; `None` without steps.
    pub integrator: Option<Integrator>,
    /// Where inside a step a contact took effect; `None` without steps.
    pub impact: Option<Impact>,
    /// The surfaces of all bodies.
    pub surface: Surface,
    /// The uniform acceleration, length per time².
    #[serde(skip)]
    pub gravity: [f64; 3],
    /// How many fixed parts there are.
    pub fixed_parts: usize,
    /// What they are called.
    #[serde(skip)]
    pub part_names: Vec<Option<String>>,
    /// Which of them take spheres out.
    #[serde(skip)]
    pub removes: Vec<bool>,
    /// Whether space is periodic.
    pub periodic: bool,
    /// The box of a periodic space, length.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub space: Option<Corners>,
    /// Length of a step, time; `None` without steps.
    pub dt: Option<f64>,
    /// How many bodies.
    pub bodies: usize,
    /// Their mass together.
    pub total_mass: f64,
}

impl Setup {
    /// A run of a scene by the engine that it names, in one lane on one thread.
    #[must_use]
    pub fn of<T: Real>(scene: &Scene<T>) -> Self {
        let stepped = (scene.engine == EngineKind::Stepped).then_some(scene.stepped);
        Self {
            scene: scene.name.clone(),
            precision: T::NAME,
            lanes: 1,
            threads: 1,
            engine: scene.engine,
            integrator: stepped.map(|settings| settings.integrator),
            impact: stepped.map(|settings| settings.impact),
            surface: scene.surface,
            gravity: scene.gravity.cast().to_array(),
            fixed_parts: scene.surroundings.len(),
            part_names: scene.part_names.clone(),
            removes: scene.removes.clone(),
            periodic: scene.periodic.is_some(),
            space: scene.periodic.map(|space| Corners {
                lower: space.lower.to_array().map(shortest),
                upper: space.upper.to_array().map(shortest),
            }),
            dt: stepped.and_then(|settings| settings.dt).map(|dt| shortest(T::from_f64(dt))),
            bodies: scene.bodies.len(),
            total_mass: total_mass(&scene.bodies),
        }
    }
}

/// What an engine did.
#[derive(Clone, Debug)]
pub struct Work {
    /// Simulated time.
    pub time: f64,
    /// Steps taken; 0 by the event-driven engine.
    pub steps: u64,
    /// Collisions counted, all of them.
    pub collisions: Collisions,
    /// Those of the first part of a run that goes on.
    pub earlier: Collisions,
    /// Its steps.
    pub earlier_steps: u64,
    /// The impulse of the surroundings on the bodies, mass × length per time.
    pub impulse_from_surroundings: [f64; 3],
    /// Time before anything was measured.
    pub equilibration: f64,
    /// What has added up since then.
    pub measured: Reading,
    /// The same of each part that is counted apart.
    pub parts: Vec<PartTotals>,
    /// What has come and gone, and how many bodies there are, where some may have.
    pub flow: Option<(Exchange, usize)>,
    /// Means with their errors.
    pub statistics: BTreeMap<&'static str, Statistic>,
    /// Mean translational temperature of what was measured; `None` for fewer than two
    /// bodies.
    pub mean_temperature: Option<f64>,
    /// What the analyses have found.
    pub found: Vec<Found>,
    /// The potential energy that bodies can fall through.
    pub fall: f64,
    /// Wall time before the engine ran, seconds.
    pub setup_seconds: f64,
    /// Wall time while it ran, seconds.
    pub engine_seconds: f64,
}

/// What a part of the surroundings did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartSummary {
    /// Its index in the scene.
    pub index: u32,
    /// What it is called.
    pub name: Option<String>,
    /// Collisions counted.
    pub collisions: u64,
    /// Its impulse on the bodies, mass × length per time.
    pub impulse: [f64; 3],
    /// How many spheres it took out, of one that removes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub removed: Option<u64>,
    /// How often centres passed through it, of a sensor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub passages: Option<Passages>,
}

impl PartSummary {
    fn new(totals: &PartTotals, setup: &Setup) -> Self {
        let PartTotals { part, collisions, impulse, passages, .. } = *totals;
        let name = setup.part_names.get(part as usize).cloned().flatten();
        let removes = setup.removes.get(part as usize) == Some(&true);
        let removed = removes.then_some(totals.removed);
        Self { index: part, name, collisions, impulse, removed, passages }
    }
}

/// The spheres of a scene where some come or go.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpheresSummary {
    /// How many there were at the start.
    pub start: usize,
    /// How many came in.
    pub came: u64,
    /// How often one found no room and had to wait.
    pub waits: u64,
    /// How many were removed.
    pub removed: u64,
    /// How many there are at the end.
    pub end: usize,
    /// What those that came had, less what those that are gone had: mass, energy, momentum.
    pub mass: f64,
    pub energy: f64,
    pub momentum: [f64; 3],
}

impl SpheresSummary {
    fn new(setup: &Setup, (exchange, end): (Exchange, usize)) -> Self {
        let Exchange { came, removed, waits, .. } = exchange;
        Self {
            start: setup.bodies,
            came: came.spheres,
            waits,
            removed: removed.spheres,
            end,
            mass: came.mass - removed.mass,
            energy: came.energy - removed.energy,
            momentum: core::array::from_fn(|k| came.momentum[k] - removed.momentum[k]),
        }
    }
}

/// The three kinds of energy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EnergyParts {
    /// Of the centres' motion.
    pub translational: f64,
    /// Of the spins.
    pub rotational: f64,
    /// In the uniform field, zero at the origin.
    pub potential: f64,
}

/// Energy before and after.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EnergySummary {
    /// All of it at the start.
    pub initial: f64,
    /// All of it at the end.
    #[serde(rename = "final")]
    pub end: f64,
    /// `final − initial` over what the motion can exchange, see
    /// [`Energy::relative_change`].
    pub relative_change: f64,
    /// The parts at the end.
    #[serde(flatten)]
    pub parts: EnergyParts,
    /// The parts at the start.
    pub initial_parts: EnergyParts,
    /// The part of the change that belongs to the integrator, where an exact
    /// law gives it ([`integrator_drift`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integrator_drift: Option<f64>,
}

/// Momentum before and after, and what gave it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MomentumSummary {
    /// At the start.
    pub initial: [f64; 3],
    /// At the end.
    #[serde(rename = "final")]
    pub end: [f64; 3],
    /// Given by what is fixed.
    pub from_surroundings: [f64; 3],
    /// Given by gravity: mass × acceleration × time.
    pub from_gravity: [f64; 3],
    /// What neither gave: final − initial − the two above.
    pub balance_error: [f64; 3],
}

/// Angular momentum about the origin before and after.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AngularMomentumSummary {
    /// At the start.
    pub initial: [f64; 3],
    /// At the end.
    #[serde(rename = "final")]
    pub end: [f64; 3],
}

/// The summary of a run, in the scene's own units. Its `Display` is for a
/// person; serialised it is the one object of the program's `--json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// What was run.
    #[serde(flatten)]
    pub setup: Setup,
    /// Simulated time.
    pub time: f64,
    /// Steps taken; 0 by the event-driven engine.
    pub steps: u64,
    /// Time that passed before collisions were counted and figures of the gas taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub equilibrate: Option<f64>,
    /// Collisions counted.
    pub collisions: Collisions,
    /// What each part did that is counted apart.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<PartSummary>,
    /// How many spheres came and went, where any may.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spheres: Option<SpheresSummary>,
    /// Energy, mass × length² per time².
    pub energy: EnergySummary,
    /// Momentum, mass × length per time.
    pub momentum: MomentumSummary,
    /// Angular momentum about the origin, mass × length² per time.
    pub angular_momentum: AngularMomentumSummary,
    /// Temperature at the end, energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Temperature>,
    /// `Z = pV / NkT`, in a periodic box ([`compressibility`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compressibility: Option<f64>,
    /// Collisions with others per body and time, in a periodic box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collision_rate: Option<f64>,
    /// Mean length of the flights between collisions, of an event-driven run
    /// with any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_free_path: Option<f64>,
    /// Means of the gas, each with its statistical error.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub statistics: BTreeMap<&'static str, Statistic>,
    /// What was found of the bodies, in the order of the scene file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub analyses: Vec<Found>,
    /// What is conserved, to more digits than a number of JSON has, of a run in double-double.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub all_digits: Option<AllDigits>,
    /// Hash of the bits of the final state.
    pub state_hash: StateHash,
    /// Wall time, seconds: set-up, the engine, and writing events.
    pub wall_seconds: f64,
    /// The set-up in it, seconds.
    pub setup_seconds: f64,
    /// Collisions of both kinds per second of the engine.
    pub collisions_per_second: f64,
    /// Bodies × steps per second of the engine; 0 without steps.
    pub body_steps_per_second: f64,
}

impl Work {
    /// What an engine has done so far, but for what only the run knows.
    #[must_use]
    pub fn of<T: Real>(world: &World<T>) -> Self {
        Self {
            time: world.time(),
            steps: world.steps(),
            collisions: world.collisions(),
            impulse_from_surroundings: world.impulse_from_surroundings(),
            earlier: Collisions::default(),
            earlier_steps: 0,
            equilibration: 0.0,
            measured: Reading::default(),
            parts: world.parts(),
            flow: world.has_flow().then(|| (world.exchange(), world.bodies().len())),
            statistics: BTreeMap::new(),
            mean_temperature: None,
            found: Vec::new(),
            fall: 0.0,
            setup_seconds: 0.0,
            engine_seconds: 0.0,
        }
    }
}

impl Summary {
    /// Puts together what was run, the totals before and after, and what the
    /// engine did on the way.
    #[must_use]
    pub fn new(
        setup: Setup,
        before: &Totals,
        after: &Totals,
        temperature: Option<Temperature>,
        state_hash: StateHash,
        work: &Work,
    ) -> Self {
        let Work { time, steps, setup_seconds, engine_seconds, measured, .. } = *work;
        let collisions = measured.collisions;
        let is_timed = engine_seconds > 0.0;
        let per_second = |count: f64| if is_timed { count / engine_seconds } else { 0.0 };
        let spheres = work.flow.map(|flow| SpheresSummary::new(&setup, flow));
        let in_box = |figure: &dyn Fn() -> f64| setup.periodic.then(figure);
        Self {
            time,
            steps,
            collisions,
            parts: work.parts.iter().map(|totals| PartSummary::new(totals, &setup)).collect(),
            spheres,
            energy: EnergySummary::new(&setup, &before.energy, &after.energy, work),
            momentum: MomentumSummary::new(&setup, before.momentum, after.momentum, work),
            angular_momentum: AngularMomentumSummary::new(
                before.angular_momentum,
                after.angular_momentum,
            ),
            temperature,
            compressibility: in_box(&|| {
                let mean = work.mean_temperature.unwrap_or(0.0);
                compressibility(setup.bodies, measured.virial, mean, measured.time)
            }),
            collision_rate: in_box(&|| {
                collision_rate(setup.bodies, collisions.pairs, measured.time)
            }),
            mean_free_path: measured.mean_free_path(),
            equilibrate: (work.equilibration > 0.0).then_some(work.equilibration),
            statistics: work.statistics.clone(),
            analyses: work.found.clone(),
            all_digits: None,
            state_hash,
            wall_seconds: setup_seconds + engine_seconds,
            setup_seconds,
            collisions_per_second: per_second(work.collisions.since(work.earlier).total() as f64),
            body_steps_per_second: per_second(
                if spheres.is_some() { 0.0 } else { setup.bodies as f64 }
                    * (steps - work.earlier_steps) as f64,
            ),
            setup,
        }
    }
}

impl Summary {
    /// A figure that is no finite number, by its name.
    #[must_use]
    pub fn not_finite(&self) -> Option<&'static str> {
        let energy = &self.energy;
        let parts = |parts: &EnergyParts| [parts.translational, parts.rotational, parts.potential];
        let all = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let momentum = &self.momentum;
        let shares = [momentum.from_surroundings, momentum.from_gravity, momentum.balance_error];
        let gas = self.temperature.map(|gas| [gas.translational, gas.rotational]);
        let is_whole = |part: &PartSummary| all(&part.impulse);
        let figures = [
            ("impulse of a part", self.parts.iter().all(is_whole)),
            ("time", self.time.is_finite()),
            ("energy", all(&[energy.initial, energy.end])),
            ("energy", all(&parts(&energy.parts)) && all(&parts(&energy.initial_parts))),
            ("change of the energy", energy.relative_change.is_finite()),
            ("drift of the integrator", energy.integrator_drift.is_none_or(f64::is_finite)),
            ("momentum", all(&momentum.initial) && all(&momentum.end)),
            ("balance of the momentum", all(shares.as_flattened())),
            ("angular momentum", all(&self.angular_momentum.initial)),
            ("angular momentum", all(&self.angular_momentum.end)),
            ("temperature", gas.is_none_or(|gas| all(&gas))),
            ("compressibility", self.compressibility.is_none_or(f64::is_finite)),
            ("collision rate", self.collision_rate.is_none_or(f64::is_finite)),
            ("statistics", self.statistics.values().all(|s| all(&[s.mean, s.error]))),
            ("mean free path", self.mean_free_path.is_none_or(f64::is_finite)),
        ];
        figures.into_iter().find(|(_, is_finite)| !is_finite).map(|(name, _)| name)
    }
}

impl EnergySummary {
    fn new(setup: &Setup, before: &Energy, after: &Energy, work: &Work) -> Self {
        let parts = |energy: &Energy| EnergyParts {
            translational: energy.translational,
            rotational: energy.rotational,
            potential: energy.potential,
        };
        let collisions = work.collisions.total();
        // Where space wraps, so does the potential; an impact within a step
        // moves bodies too.
        let is_at_end = setup.impact == Some(Impact::EndOfStep);
        let has_law = !setup.periodic && (is_at_end || collisions == 0);
        let law = setup.integrator.zip(setup.dt).filter(|_| has_law && work.flow.is_none());
        let drift = |(integrator, dt)| {
            let acceleration = Vec3::from(setup.gravity).length();
            integrator_drift(integrator, work.steps, dt, acceleration, setup.total_mass)
        };
        Self {
            initial: before.total(),
            end: after.total(),
            relative_change: match work.flow {
                None => after.relative_change(before, work.fall),
                Some((Exchange { came, removed, .. }, _)) => {
                    // But for what came with spheres, and went with them.
                    let change = (after.total() - before.total()) - (came.energy - removed.energy);
                    let kinetic = [before.kinetic(), after.kinetic()];
                    let potential = [before.potential, after.potential];
                    let scale = energy_scale(kinetic, potential, work.fall);
                    if change == 0.0 { 0.0 } else { change / (scale + removed.energy.abs()) }
                }
            },
            parts: parts(after),
            initial_parts: parts(before),
            integrator_drift: law.map(drift),
        }
    }
}

impl MomentumSummary {
    fn new(setup: &Setup, before: Momentum, after: Momentum, work: &Work) -> Self {
        let (initial, end) = (before.0.to_array(), after.0.to_array());
        let from_surroundings = work.impulse_from_surroundings;
        let (mass_time, moved) = match work.flow {
            None => (0.0, [0.0; 3]),
            Some((Exchange { came, removed, mass_time: (sum, since), .. }, _)) => {
                let mass = setup.total_mass + came.mass - removed.mass;
                let moved = core::array::from_fn(|k| came.momentum[k] - removed.momentum[k]);
                (sum + mass * (work.time - since), moved)
            }
        };
        // A component without gravity gets 0, not −0.
        let from_gravity = setup.gravity.map(|g| match work.flow {
            None => setup.total_mass * g * work.time + 0.0,
            Some(_) => mass_time * g + 0.0,
        });
        let balance_error = core::array::from_fn(|k| {
            (((end[k] - initial[k]) - from_surroundings[k]) - from_gravity[k]) - moved[k]
        });
        Self { initial, end, from_surroundings, from_gravity, balance_error }
    }
}

impl AngularMomentumSummary {
    fn new(before: AngularMomentum, after: AngularMomentum) -> Self {
        Self { initial: before.0.to_array(), end: after.0.to_array() }
    }
}

/// The `f64` with the digits that a number of any precision is known by: `0.1`
/// for the `f32` nearest to it, not `0.10000000149011612`.
#[must_use]
pub fn shortest<T: Real>(value: T) -> f64 {
    format!("{value:?}").parse().unwrap_or_else(|_| value.to_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digits_are_those_of_the_precision() {
        assert_eq!(shortest(0.1_f32), 0.1);
        assert_eq!(shortest(0.1_f64), 0.1);
    }
}
