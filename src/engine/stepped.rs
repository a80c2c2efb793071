//! The stepped engine: flight in steps of fixed length, contacts in between.
//!
//! A step is: fly (`fly`), renew the candidates if bodies have moved far enough
//! (`candidates`), find the contacts (`find`, `narrow`), let them take effect in
//! the scene's order (`impact`, `apply`): those at the end of the step round by
//! round (`resolve`), those inside it one after the other (`in_order`).

mod among_all;
mod apply;
mod candidates;
mod clock;
mod contacts;
mod driver;
mod find;
mod fly;
mod impact;
mod in_order;
mod lanes;
mod narrow;
mod neighbourhoods;
mod orientations;
mod path;
mod queue;
mod record;
mod region;
mod resolve;
mod setting;
#[cfg(feature = "files")]
mod snapshot;
mod stage;
mod state;
mod struck;

use super::change::{Apply, Base, KeptParts};
use super::flow::counted;
use super::handles::Names;
use super::interface::StepEngine;
use super::later::{Elapsed, Later};
#[cfg(feature = "files")]
use super::snapshot::{Misfit, Snapshot};
use super::{Collisions, Compiled, EngineError, Event, Execution, Listener, PartTotals, Plan};
use crate::bodies::Bodies;
use crate::real::Real;
use crate::scene::{MOST_STEPS, Scene};
use crate::vec3::Vec3;

pub(super) use contacts::{Contact as ContactInStep, Rank};
pub(super) use driver::Driver;
pub(super) use lanes::in_lanes;
pub(super) use narrow::met_since;
pub(super) use orientations::Orientations;
pub(super) use path::Path;
#[cfg(feature = "files")]
pub(super) use snapshot::StepState;
pub(super) use stage::{Stage, Steps};
pub(super) use state::State;

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
    engine: Box<dyn StepEngine<T>>,
    base: Base<T>,
    /// Lets a change of it take effect.
    pub(super) apply: Apply<T>,
}

impl<T: Compiled> Stepped<T> {
    /// A scene at its start, to be run on all cores with the fastest lanes.
    ///
    /// ```
    /// # use carom::{Scene, Sphere, Stepped};
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().dt(1e-3).sphere(ball).build()?;
    /// let world = Stepped::new(scene)?;
    /// assert_eq!(world.time(), 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the scene has no `dt`, or the system no threads to give.
    pub fn new(scene: Scene<T>) -> Result<Self, EngineError> {
        Self::with_execution(scene, Execution::default())
    }

    /// A scene at its start, to be run in the given lanes and threads. They
    /// change no bit of the result.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere, Stepped};
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().dt(1e-3).sphere(ball).build()?;
    /// let world = Stepped::with_execution(scene, Execution::new().threads(1))?;
    /// assert_eq!(world.time(), 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the scene has no `dt`, or the system no threads to give.
    pub fn with_execution(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        let base = Base::new(&scene, execution);
        Ok(Self { engine: T::stepped(scene, execution)?, base, apply: T::apply })
    }

    /// A scene that goes on from what has elapsed.
    pub(super) fn later(
        scene: Scene<T>,
        execution: Execution,
        elapsed: Elapsed,
        names: Names,
    ) -> Result<Self, EngineError> {
        let base = Base::later(&scene, execution, names);
        let engine = Later::new(scene, elapsed, |scene| T::stepped(scene, execution))?;
        Ok(Self { engine: Box::new(engine), base, apply: T::apply })
    }

    /// Goes on as the scene now is.
    pub(super) fn go_on(
        &mut self,
        scene: Scene<T>,
        names: Names,
        kept: Option<&KeptParts>,
    ) -> Result<(), EngineError> {
        let elapsed = Elapsed::of(&*self.engine, self.engine.steps()).keeping(kept);
        let mut later = Self::later(scene, self.base.execution, elapsed, names)?;
        later.base.take_over(&mut self.base, kept);
        *self = later;
        Ok(())
    }
}

impl<T: Real> Stepped<T> {
    /// Takes the whole number of steps that is nearest to `duration`, time.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// world.advance(0.25)?;
    /// world.advance(0.75)?;
    /// assert_eq!(world.time(), 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the duration is negative, not finite, or more than 2⁵³ steps long.
    pub fn advance(&mut self, duration: f64) -> Result<(), EngineError> {
        let steps = self.steps_in(duration)?;
        self.go(steps, None)
    }

    /// [`advance`](Stepped::advance), and reports the collisions of each step, in
    /// order of time, those of one time by body and then by partner, fixed parts
    /// before bodies.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// world.for_each_event(1.0, |event| assert_eq!(event.time, 0.5))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance`](Stepped::advance).
    pub fn for_each_event(
        &mut self,
        duration: f64,
        mut on_event: impl FnMut(&Event<T>),
    ) -> Result<(), EngineError> {
        let steps = self.steps_in(duration)?;
        self.go(steps, Some(&mut on_event))
    }

    /// The whole number of steps that is nearest to a duration.
    fn steps_in(&self, duration: f64) -> Result<u64, EngineError> {
        let dt = self.exact_dt();
        let steps = (duration / dt).round();
        if !(0.0..=MOST_STEPS).contains(&steps) {
            return Err(EngineError::Duration { duration, dt });
        }
        Ok(steps as u64)
    }

    /// Takes one step.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// world.step();
    /// assert_eq!(world.steps(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Where spheres that come or go by the scene are refused it ends, as the next two; what
    /// [`advance`](Stepped::advance) does next says why.
    pub fn step(&mut self) {
        self.take_steps(1, None);
    }

    /// Takes this many steps.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// world.advance_steps(8);
    /// assert_eq!(world.time(), 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn advance_steps(&mut self, steps: u64) {
        self.take_steps(steps, None);
    }

    /// Takes this many steps, and reports the collisions of each as
    /// [`for_each_event`](Stepped::for_each_event) does.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// let mut times = Vec::new();
    /// world.take_steps(8, Some(&mut |event| times.push(event.time)));
    /// assert_eq!(times, [0.5]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn take_steps(&mut self, steps: u64, on_event: Listener<'_, T>) {
        // What was refused is to be done still, and refused again.
        self.go(steps, on_event).ok();
    }

    /// Takes this many steps, between which spheres come and go.
    pub(crate) fn go(
        &mut self,
        steps: u64,
        mut on_event: Listener<'_, T>,
    ) -> Result<(), EngineError> {
        let last = self.steps() + steps;
        loop {
            let (now, dt) = (self.time(), self.exact_dt());
            let left = last - self.steps();
            let Self { engine, base: Base { flow, handles, .. }, .. } = self;
            let Some(flow) = flow else {
                engine.take_steps(left, on_event);
                return Ok(());
            };
            if flow.is_due(now) {
                self.exchange_due()?;
                continue;
            }
            if left == 0 {
                return Ok(());
            }
            // To the first step at whose end something comes, or may have gone.
            let ahead = ((flow.next() - now) / dt).ceil().max(1.0) as u64;
            let steps = if flow.has_drains() { 1 } else { ahead.min(left) };
            let mut listener = flow.listener(handles, &mut on_event);
            engine.take_steps(steps, Some(&mut listener));
        }
    }

    /// Length of a step, time.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// assert_eq!(world.dt(), 0.125);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn dt(&self) -> T {
        self.engine.dt()
    }

    /// Length of a step as the scene gives it, not as the precision rounds it.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// assert_eq!(world.exact_dt(), 0.125);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn exact_dt(&self) -> f64 {
        self.engine.exact_dt()
    }

    /// Steps taken.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.steps(), 8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.engine.steps()
    }

    /// What the scene needs.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// println!("{}", world.plan());
    /// assert_eq!(world.plan().bodies, 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn plan(&self) -> &Plan {
        self.engine.plan()
    }

    /// The uniform acceleration, length per time².
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// assert_eq!(world.gravity().to_array(), [0.0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn gravity(&self) -> Vec3<T> {
        self.engine.gravity()
    }

    /// Time since the start: steps times their length as the scene gives it,
    /// not as the precision rounds it.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.time(), 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn time(&self) -> f64 {
        self.steps() as f64 * self.exact_dt()
    }

    /// The bodies now, in the scene's order, orientations brought up to date.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// // They meet half-way and go back.
    /// world.advance(1.0)?;
    /// assert_eq!(world.bodies().position_of(0).x, 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn bodies(&self) -> Bodies<T> {
        self.engine.bodies()
    }

    /// The bodies in double precision, where their places have more digits in the
    /// engine's own frame than in the scene's coordinates.
    pub(crate) fn finer_bodies(&self) -> Option<Bodies<f64>> {
        self.engine.finer_bodies()
    }

    /// Collisions since the start.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.collisions().pairs, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn collisions(&self) -> Collisions {
        self.engine.totals().collisions
    }

    /// What the collisions with each part of the surroundings have added up to: with those
    /// that have a name, and with all where there are no more than 64.
    ///
    /// ```
    /// # use carom::{Plane, Scene, Sphere, Stepped};
    /// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
    /// let floor = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
    /// let scene = Scene::<f64>::builder().dt(0.125).surroundings(floor).sphere(ball).build()?;
    /// let mut world = Stepped::new(scene)?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.parts()[0].collisions, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn parts(&self) -> Vec<PartTotals> {
        counted(self.engine.parts(), self.base.flow.as_deref())
    }

    /// The sum of all impulses of the surroundings on the bodies since the
    /// start, mass × length per time.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.impulse_from_surroundings(), [0.0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn impulse_from_surroundings(&self) -> [f64; 3] {
        self.engine.totals().impulse
    }

    /// `Σ J_n·(c_a − c_b)` over all collisions of pairs since the start, mass ×
    /// length² per time: the collisions' part of the virial pressure.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// // Masses of 1 at a distance of 1 exchange an impulse of 2.
    /// world.advance(1.0)?;
    /// assert_eq!(world.virial(), 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn virial(&self) -> f64 {
        self.engine.totals().virial
    }

    pub(super) fn base(&self) -> &Base<T> {
        &self.base
    }

    pub(super) fn base_mut(&mut self) -> &mut Base<T> {
        &mut self.base
    }

    #[cfg(feature = "files")]
    pub(super) fn save(&self) -> Snapshot {
        let mut saved = self.engine.save();
        self.base.save(&mut saved);
        saved
    }

    #[cfg(feature = "files")]
    pub(super) fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        self.base.restore(saved)?;
        self.engine.restore(saved)
    }

    /// The bytes of memory that the engine holds.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// assert!(world.bytes() > 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.engine.bytes() + self.base.bytes()
    }
}
