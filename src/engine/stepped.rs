//! The stepped engine: flight in steps of fixed length, contacts in between.
//!
//! A step is: fly ([`motion`](crate::motion)), renew the candidates if bodies
//! have moved far enough ([`broadphase`](crate::space::broadphase)), find the contacts
//! (`narrow`), let them take effect in the scene's order (`contacts`, `impact`).

mod contacts;
mod impact;
mod narrow;
mod orientations;
mod path;
mod record;
mod resolve;
mod state;
mod struck;

use super::plan::{Plan, Turning};
use super::tallies::Tallies;
use super::{Collisions, EngineError, Event, Execution};
use crate::bodies::Bodies;
use crate::lane::Lane;
use crate::motion::Integrator;
use crate::motion::turning::turn;
use crate::real::Real;
use crate::scene::{EngineKind, Impact, MOST_STEPS, Scene};
use crate::space::broadphase::{BroadPhase, Candidates};
use crate::space::{OpenSpace, PeriodicBox};
use crate::surroundings::{Feature, features_of};
use crate::vec3::Vec3;
use crate::workers::Workers;
use contacts::{Contact, Rounds};
use impact::Outcome;
use orientations::Orientations;
use path::Path;
use record::Record;
use state::State;
use struck::Struck;

/// Bodies flown as one piece of work.
const FLOWN: usize = 1 << 14;

/// Calls a method in the lanes of a width for sweeps or for gathers.
macro_rules! in_lanes {
    ($plan:ident.sweep_lanes, $self:ident.$method:ident::<$real:ident>($($argument:expr),*)) => {
        match $self.$plan.sweep_lanes {
            1 => $self.$method::<$real>($($argument),*),
            4 => $self.$method::<$real::Pack4>($($argument),*),
            8 => $self.$method::<$real::Pack8>($($argument),*),
            _ => $self.$method::<$real::Pack16>($($argument),*),
        }
    };
    ($plan:ident.gather_lanes, $self:ident.$method:ident::<$real:ident>($($argument:expr),*)) => {
        match $self.$plan.gather_lanes {
            1 => $self.$method::<$real>($($argument),*),
            4 => $self.$method::<$real::Pack4>($($argument),*),
            _ => $self.$method::<$real::Pack8>($($argument),*),
        }
    };
}
use in_lanes;

/// A scene in motion, by steps of fixed length.
///
/// ```
/// use carom::engine::Stepped;
/// use carom::scene::{Scene, Sphere};
///
/// let scene = Scene::<f64>::builder()
///     .sphere(Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
///     .sphere(Sphere::new([2.0, 0.0, 0.0]).radius(0.5))
///     .dt(0.125)
///     .build()?;
/// let mut world = Stepped::new(scene)?;
/// world.advance(2.0)?;
/// assert_eq!(world.collisions().pairs, 1);
/// assert_eq!(world.bodies().velocity_of(1).x, 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Stepped<T: Real> {
    plan: Plan,
    dt: T,
    /// The scene's own step, before it was rounded to the precision.
    exact_dt: f64,
    gravity: Vec3<T>,
    integrator: Integrator,
    acceleration: Option<Vec3<T>>,
    periodic: Option<PeriodicBox<T>>,
    path: Path<T>,
    features: Vec<Feature<T>>,
    /// The part of the surroundings that each feature belongs to.
    parts: Vec<u32>,
    workers: Workers,

    state: State<T>,
    orientations: Orientations<T>,
    steps: u64,
    collisions: Collisions,
    tallies: Tallies,

    broadphase: BroadPhase<T>,
    candidates: Candidates,
    skin: T,
    /// How far any body can have moved since the last search.
    travelled: T,

    found: Vec<Vec<Contact<T>>>,
    waiting: Vec<Contact<T>>,
    now: Vec<Contact<T>>,
    outcomes: Vec<Outcome<T>>,
    rounds: Rounds,
    struck: Struck<T>,
}

impl<T: Real> Stepped<T> {
    /// A scene at its start, to be run on all cores with the fastest lanes.
    ///
    /// # Errors
    /// If the scene has no `dt`, or the system no threads to give.
    pub fn new(scene: Scene<T>) -> Result<Self, EngineError> {
        Self::with_execution(scene, Execution::default())
    }

    /// A scene at its start, to be run in the given lanes and threads. They
    /// change no bit of the result.
    ///
    /// # Errors
    /// If the scene has no `dt`, or the system no threads to give.
    pub fn with_execution(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        let exact_dt = scene.stepped.dt.ok_or(EngineError::NoStep)?;
        let dt = T::from_f64(exact_dt);
        let workers = Workers::new(execution.threads)?;
        let plan = Plan::new(&scene, EngineKind::Stepped, execution, workers.threads());
        let len = scene.bodies.len();
        let met: &[_] = if plan.features > 0 { &scene.surroundings } else { &[] };
        let (features, parts) = features_of(met);
        let mut state = State::new(scene.bodies);
        if matches!(plan.turning, Turning::FromLastContact | Turning::EachStep) {
            state.own_orientations();
        }
        let has_contacts = plan.has_pairs || plan.features > 0;
        let places = if has_contacts { len } else { 0 };
        let is_within = plan.impact == Impact::SubStep;
        let broadphase = BroadPhase::new(&state.radius, len, features.as_slice());
        Ok(Self {
            dt,
            exact_dt,
            gravity: scene.gravity,
            integrator: plan.integrator,
            acceleration: plan.has_field.then_some(scene.gravity),
            periodic: scene.periodic,
            path: Path::new(plan.integrator, plan.impact, scene.gravity, dt),
            features,
            parts,
            workers,
            orientations: Orientations::new(plan.turning, len, is_within),
            steps: 0,
            collisions: Collisions::default(),
            tallies: Tallies::default(),
            broadphase,
            candidates: Candidates::default(),
            skin: T::ZERO,
            travelled: T::ZERO,
            found: Vec::new(),
            waiting: Vec::new(),
            now: Vec::new(),
            outcomes: Vec::new(),
            rounds: Rounds::new(places),
            struck: Struck::new(if is_within { places } else { 0 }),
            state,
            plan,
        })
    }

    /// What the scene needs.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Length of a step, time.
    #[must_use]
    pub fn dt(&self) -> T {
        self.dt
    }

    /// Length of a step as the scene gives it, not as the precision rounds it.
    #[must_use]
    pub fn exact_dt(&self) -> f64 {
        self.exact_dt
    }

    /// Steps taken.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Time since the start: steps times their length as the scene gives it,
    /// not as the precision rounds it.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.exact_dt
    }

    /// The uniform acceleration, length per time².
    #[must_use]
    pub fn gravity(&self) -> Vec3<T> {
        self.gravity
    }

    /// Collisions since the start.
    #[must_use]
    pub fn collisions(&self) -> Collisions {
        self.collisions
    }

    /// The sum of all impulses of the surroundings on the bodies since the
    /// start, mass × length per time.
    #[must_use]
    pub fn impulse_from_surroundings(&self) -> [f64; 3] {
        self.tallies.impulse()
    }

    /// `Σ J_n·(c_a − c_b)` over all collisions of pairs since the start, mass ×
    /// length² per time: the collisions' part of the virial pressure.
    #[must_use]
    pub fn virial(&self) -> f64 {
        self.tallies.virial()
    }

    /// The bodies now, in the scene's order, orientations brought up to date.
    #[must_use]
    pub fn bodies(&self) -> Bodies<T> {
        self.state.bodies(|index| self.orientations.since(index, self.steps, self.dt, T::ZERO))
    }

    /// The bytes of memory that the engine holds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let contact = size_of::<Contact<T>>();
        let contacts: usize = self.found.iter().map(Vec::capacity).sum();
        self.state.bytes()
            + self.orientations.bytes()
            + self.broadphase.bytes()
            + self.candidates.bytes()
            + self.rounds.bytes()
            + self.struck.bytes()
            + contact * (contacts + self.waiting.capacity() + self.now.capacity())
            + size_of::<Outcome<T>>() * self.outcomes.capacity()
    }

    /// Takes one step.
    pub fn step(&mut self) {
        self.take_step(None);
    }

    /// Takes one step and reports its collisions, in order of time, those of
    /// one time by body and then by partner, fixed parts before bodies.
    pub fn step_with(&mut self, on_event: &mut dyn FnMut(&Event<T>)) {
        let mut record = Record::default();
        self.take_step(Some(&mut record));
        record.report(on_event);
    }

    /// Takes the whole number of steps that is nearest to `duration`, time.
    ///
    /// # Errors
    /// If the duration is negative, not finite, or more than 2⁵³ steps long.
    pub fn advance(&mut self, duration: f64) -> Result<(), EngineError> {
        let steps = (duration / self.exact_dt).round();
        if !(0.0..=MOST_STEPS).contains(&steps) {
            return Err(EngineError::Duration { duration, dt: self.exact_dt });
        }
        self.advance_steps(steps as u64);
        Ok(())
    }

    /// Takes this many steps.
    pub fn advance_steps(&mut self, steps: u64) {
        // From inside the pool a step hands out its work at the least cost.
        let workers = core::mem::take(&mut self.workers);
        workers.run(|| {
            for _ in 0..steps {
                self.take_step_on(&workers, None);
            }
        });
        self.workers = workers;
    }

    fn take_step(&mut self, record: Option<&mut Record<T>>) {
        let workers = core::mem::take(&mut self.workers);
        self.take_step_on(&workers, record);
        self.workers = workers;
    }

    fn take_step_on(&mut self, workers: &Workers, record: Option<&mut Record<T>>) {
        let travel = in_lanes!(plan.sweep_lanes, self.fly::<T>(workers));
        self.steps += 1;
        if self.plan.turning == Turning::EachStep {
            in_lanes!(plan.sweep_lanes, self.rotate::<T>(workers));
        }
        self.orientations.keep_count(&mut self.state, self.steps, self.dt);
        if !self.plan.has_pairs && self.features.is_empty() {
            return;
        }
        self.travelled = self.travelled + travel + self.broadphase.rounding();
        let is_valid = (self.travelled + self.travelled).lt(self.skin);
        if self.steps == 1 || !is_valid {
            in_lanes!(plan.gather_lanes, self.renew_candidates::<T>(workers, travel));
        }
        self.find_contacts(workers, travel);
        if !self.waiting.is_empty() {
            self.resolve(workers, record);
        }
    }

    /// Flies all bodies through one step and returns how far any has moved at
    /// most, with a margin for the rounding.
    fn fly<L: Lane<Scalar = T>>(&mut self, workers: &Workers) -> T {
        let (dt, acceleration, integrator) = (self.dt, self.acceleration, self.integrator);
        let periodic = self.periodic;
        let [x, y, z] = self.state.position.each_mut().map(|column| column.chunks_mut(FLOWN));
        let [u, v, w] = self.state.velocity.each_mut().map(|column| column.chunks_mut(FLOWN));
        let mut chunks: Vec<_> = x
            .zip(y)
            .zip(z)
            .zip(u.zip(v).zip(w))
            .map(|(((x, y), z), ((u, v), w))| ([x, y, z], [u, v, w], T::ZERO))
            .collect();
        workers.each(&mut chunks, |(position, velocity, fastest)| {
            let position = position.each_mut().map(|column| &mut **column);
            let velocity = velocity.each_mut().map(|column| &mut **column);
            *fastest = match periodic {
                None => integrator.flight_and_fastest::<L, _>(
                    position,
                    velocity,
                    acceleration,
                    dt,
                    OpenSpace,
                ),
                Some(space) => integrator.flight_and_fastest::<L, _>(
                    position,
                    velocity,
                    acceleration,
                    dt,
                    space,
                ),
            };
        });
        let fastest = chunks.iter().fold(T::ZERO, |most, chunk| chunk.2.greater(most));
        let field = acceleration.map_or(T::ZERO, Vec3::length) * dt;
        (Lane::sqrt(fastest) + field) * dt * T::ratio(65, 64)
    }

    /// `M ← R M` for every body.
    fn rotate<L: Lane<Scalar = T>>(&mut self, workers: &Workers) {
        let Some(rows) = &mut self.state.orientation else { return };
        let mut rows = rows.each_mut().map(|row| row.chunks_mut(FLOWN));
        let mut spins = self.state.spin.each_ref().map(|column| column.chunks(FLOWN));
        let mut chunks: Vec<_> = (0..self.plan.bodies.div_ceil(FLOWN))
            .map(|_| {
                let rows = rows.each_mut().map(|row| row.next().unwrap_or_default());
                (rows, spins.each_mut().map(|column| column.next().unwrap_or_default()))
            })
            .collect();
        let dt = self.dt;
        workers.each(&mut chunks, |(rows, spin)| {
            turn::<L>(rows.each_mut().map(|row| &mut **row), *spin, dt);
        });
    }

    /// Searches anew for all that can touch within the skin.
    fn renew_candidates<L: Lane<Scalar = T>>(&mut self, workers: &Workers, travel: T) {
        // Two bodies may have passed each other within the step just taken.
        let swept = match self.plan.impact {
            Impact::EndOfStep => T::ZERO,
            Impact::SubStep => self.broadphase.swept(travel),
        };
        // Without pairs a candidate is a body near a fixed feature: there are few,
        // and a search is worth many steps.
        let is_alone = !self.plan.has_pairs && !self.broadphase.has_many_parts();
        let alone = if is_alone { travel * T::whole(64) } else { T::ZERO };
        self.skin = self.broadphase.skin(travel, self.skin).greater(swept).greater(alone);
        let (periodic, pairs) = (self.periodic, self.plan.has_pairs);
        let surveyed = self.state.surveyed(periodic, &self.features, pairs);
        let order = self.broadphase.sort(&surveyed, self.skin, workers);
        self.state.reorder(order, workers);
        let surveyed = self.state.surveyed(periodic, &self.features, pairs);
        self.broadphase.search::<L, _>(&surveyed, self.skin, &mut self.candidates, workers);
        // Within the step just taken bodies were further apart or nearer by as much.
        self.travelled = match self.plan.impact {
            Impact::EndOfStep => T::ZERO,
            Impact::SubStep => travel,
        };
    }
}
