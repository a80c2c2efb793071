//! The event-driven engine: every collision at its exact time, in order.
//!
//! Between two collisions a body's path is known in closed form, so nothing is
//! computed until something happens (Alder and Wainwright 1959). Of what is
//! ahead each body keeps its first contacts ([`agenda`]); the calendar says
//! which body is next ([`calendar`]); cells say what is near
//! what ([`levels`](crate::space::levels)).
//!
//! A contact time is a function of the two flights that lead to it, and of
//! nothing else: not of when it was found, from which side, or in which lanes. Flights
//! start again at collisions and where a period of time begins; to look at the
//! bodies in between changes no bit of them.

mod agenda;
mod calendar;
mod clock;
mod coarse;
mod collide;
mod crossing;
mod driver;
mod features;
mod flight;
mod history;
mod key;
mod log;
mod meeting;
mod near;
mod order;
mod outcome;
mod period;
mod region;
mod report;
mod search;
mod setting;
#[cfg(feature = "files")]
mod snapshot;
mod store;
mod territories;
mod tight;
mod turns;
mod undo;
mod window;

use super::account::Effort;
use super::change::{Apply, Base, KeptParts};
use super::flow::counted;
use super::handles::Names;
use super::interface::{EventEngine, Stretch};
use super::later::{Elapsed, Later};
#[cfg(feature = "files")]
use super::snapshot::{Misfit, Snapshot};
use super::{Collisions, Compiled, EngineError, Event, Execution, Listener, PartTotals, Plan};
use crate::bodies::Bodies;
use crate::real::Real;
use crate::scene::Scene;
use crate::vec3::Vec3;

pub(super) use driver::Driver;
#[cfg(feature = "files")]
pub(super) use snapshot::EventState;

/// A scene in motion, from collision to collision.
///
/// ```
/// use carom::engine::EventDriven;
/// use carom::scene::{Scene, Sphere};
///
/// let scene = Scene::<f64>::builder()
///     .sphere(Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
///     .sphere(Sphere::new([2.0, 0.0, 0.0]).radius(0.5))
///     .build()?;
/// let mut world = EventDriven::new(scene)?;
/// world.for_each_event(3.0, |event| assert_eq!(event.time, 1.0))?;
/// assert_eq!(world.bodies().position_of(0).x, 1.0);
/// assert_eq!(world.bodies().position_of(1).x, 4.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct EventDriven<T: Real> {
    engine: Box<dyn EventEngine<T>>,
    base: Base<T>,
    /// Lets a change of it take effect.
    pub(super) apply: Apply<T>,
}

impl<T: Compiled> EventDriven<T> {
    /// A scene at its start, to be run with the fastest lanes.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
    /// let world = EventDriven::new(scene)?;
    /// assert_eq!(world.time(), 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// None yet for a checked scene.
    pub fn new(scene: Scene<T>) -> Result<Self, EngineError> {
        Self::with_execution(scene, Execution::default())
    }

    /// A scene at its start, to be run in the given lanes, which change no bit
    /// of the result. Events are handled on one thread.
    ///
    /// ```
    /// # use carom::{EventDriven, Execution, Lanes, Scene, Sphere};
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
    /// let world = EventDriven::with_execution(scene, Execution::new().lanes(Lanes::Scalar))?;
    /// assert_eq!(world.time(), 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// None yet for a checked scene.
    pub fn with_execution(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        let base = Base::new(&scene, execution);
        Ok(Self { engine: T::event_driven(scene, execution)?, base, apply: T::apply })
    }

    /// A scene that goes on from what has elapsed.
    pub(super) fn later(
        scene: Scene<T>,
        execution: Execution,
        elapsed: Elapsed,
        names: Names,
    ) -> Result<Self, EngineError> {
        let base = Base::later(&scene, execution, names);
        let engine = Later::new(scene, elapsed, |scene| T::event_driven(scene, execution))?;
        Ok(Self { engine: Box::new(engine), base, apply: T::apply })
    }

    /// Goes on as the scene now is.
    pub(super) fn go_on(
        &mut self,
        scene: Scene<T>,
        names: Names,
        kept: Option<&KeptParts>,
    ) -> Result<(), EngineError> {
        let elapsed = Elapsed::of(&*self.engine, 0).keeping(kept);
        let mut later = Self::later(scene, self.base.execution, elapsed, names)?;
        later.base.take_over(&mut self.base, kept);
        *self = later;
        Ok(())
    }
}

impl<T: Real> EventDriven<T> {
    /// Lets time pass, and handles all events up to its end, which is included.
    ///
    /// Two advances are one, bit by bit: to stop in between changes nothing.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// world.advance(0.25)?;
    /// world.advance(0.75)?;
    /// assert_eq!(world.time(), 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the duration is negative or no number, if time no longer advances from
    /// event to event, or if the motion leaves the range of numbers; the world
    /// is then where it stopped.
    pub fn advance(&mut self, duration: f64) -> Result<(), EngineError> {
        self.advance_to(self.after(duration)?, u64::MAX, None).map(|_| ())
    }

    /// Lets time pass up to the given number of collisions from now, at most
    /// `longest`, and returns how many there were.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// assert_eq!(world.advance_until(1, 10.0)?, 1);
    /// assert_eq!(world.time(), 0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance`](EventDriven::advance).
    pub fn advance_until(&mut self, events: u64, longest: f64) -> Result<u64, EngineError> {
        let before = self.collisions().total();
        self.advance_to(self.after(longest)?, events, None)?;
        Ok(self.collisions().total() - before)
    }

    /// [`advance`](EventDriven::advance), and reports every collision on the
    /// way, in order of time, those of equal times by the bodies' indices.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// world.for_each_event(1.0, |event| assert_eq!(event.time, 0.5))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance`](EventDriven::advance).
    pub fn for_each_event(
        &mut self,
        duration: f64,
        mut on_event: impl FnMut(&Event<T>),
    ) -> Result<(), EngineError> {
        self.advance_to(self.after(duration)?, u64::MAX, Some(&mut on_event)).map(|_| ())
    }

    /// The time that is a duration away.
    fn after(&self, duration: f64) -> Result<f64, EngineError> {
        if duration >= 0.0 && duration.is_finite() {
            return Ok(self.time() + duration);
        }
        Err(EngineError::NoDuration(duration))
    }

    /// Lets time pass up to `time`, counted from the start, or up to the given
    /// number of collisions from now if that comes first, and reports every
    /// collision on the way. Returns whether all up to that time is done.
    ///
    /// The other ways to advance are this one. Stretches to given times end
    /// there exactly; a sum of durations would be rounded.
    ///
    /// ```
    /// # use carom::engine::EventDriven;
    /// # use carom::scene::{Scene, Sphere};
    /// # use carom::surroundings::Cuboid;
    /// # let scene = Scene::<f64>::builder()
    /// #     .surroundings(Cuboid::container([0.0; 3], [2.0; 3]))
    /// #     .sphere(Sphere::new([1.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
    /// #     .build()?;
    /// let mut world = EventDriven::new(scene)?;
    /// while !world.advance_to(10.0, 3, None)? {
    ///     println!("{} collisions up to {}", world.collisions().total(), world.time());
    /// }
    /// assert_eq!(world.collisions().surroundings, 10);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the time is past or no number, otherwise as
    /// [`advance`](EventDriven::advance).
    pub fn advance_to(
        &mut self,
        time: f64,
        events: u64,
        on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        self.after(time - self.time())?;
        self.go_to(time, Stretch { collisions: events, is_exact: true }, on_event)
    }

    /// [`advance_to`](EventDriven::advance_to), but comes back where it suits the engine
    /// after about the given number of collisions, not exactly there: to show progress,
    /// say. A large scene is worked off in windows of time, which need not be cut.
    ///
    /// ```
    /// # use carom::{Cuboid, EventDriven, Scene, Sphere};
    /// # let scene = Scene::<f64>::builder()
    /// #     .surroundings(Cuboid::container([0.0; 3], [2.0; 3]))
    /// #     .sphere(Sphere::new([1.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
    /// #     .build()?;
    /// let mut world = EventDriven::new(scene)?;
    /// while !world.advance_about(10.0, 3, None)? {
    ///     println!("{} %", 10.0 * world.time());
    /// }
    /// assert_eq!(world.time(), 10.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance_to`](EventDriven::advance_to).
    pub fn advance_about(
        &mut self,
        time: f64,
        events: u64,
        on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        self.after(time - self.time())?;
        self.go_to(time, Stretch { collisions: events, is_exact: false }, on_event)
    }

    /// Lets time pass, and spheres come and go on the way.
    fn go_to(
        &mut self,
        time: f64,
        stretch: Stretch,
        mut on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        let mut last = None;
        loop {
            let Self { engine, base: Base { flow, handles, .. }, .. } = self;
            let Some(flow) = flow else {
                return engine.advance_to(time, stretch, on_event);
            };
            if flow.is_due(engine.time()) {
                self.exchange_due()?;
                continue;
            }
            let made = engine.totals().collisions.total();
            let last = *last.get_or_insert(made.saturating_add(stretch.collisions));
            let end = time.min(flow.next());
            let stretch = Stretch { collisions: last.saturating_sub(made), ..stretch };
            let is_there = engine.advance_to(
                end,
                stretch,
                Some(&mut flow.listener(handles, &mut on_event)),
            )?;
            if !flow.is_due(engine.time()) {
                return Ok(is_there);
            }
        }
    }

    /// Takes those out that are to go now.
    pub(super) fn take_out_due(&mut self) {
        let time = self.time();
        let Self { engine, base: Base { flow, handles, .. }, .. } = self;
        if let Some(flow) = flow {
            flow.take_out(&mut **engine, handles, time);
        }
    }

    /// What the scene needs.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
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
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// assert_eq!(world.gravity().to_array(), [0.0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn gravity(&self) -> Vec3<T> {
        self.engine.gravity()
    }

    /// Time since the start.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.time(), 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn time(&self) -> f64 {
        self.engine.time()
    }

    /// The bodies now, in the scene's order.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
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
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
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
    /// # use carom::{EventDriven, Plane, Scene, Sphere};
    /// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
    /// let floor = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
    /// let scene = Scene::<f64>::builder().surroundings(floor).sphere(ball).build()?;
    /// let mut world = EventDriven::new(scene)?;
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
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
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
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// // Masses of 1 at a distance of 1 exchange an impulse of 2.
    /// world.advance(1.0)?;
    /// assert_eq!(world.virial(), 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn virial(&self) -> f64 {
        self.engine.totals().virial
    }

    /// Mean length of the flights between collisions, those under way counted
    /// up to now: the sum of all ways over the number of their ends. `None`
    /// before the first collision. In a field the ways are taken as straight.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// // Two ways of ½ that ended, two of ½ under way.
    /// world.advance(1.0)?;
    /// assert_eq!(world.mean_free_path(), Some(1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn mean_free_path(&self) -> Option<f64> {
        self.engine.mean_free_path()
    }

    /// What it took to find the collisions so far.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// world.advance(1.0)?;
    /// assert!(world.effort().tried >= 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn effort(&self) -> Effort {
        self.engine.effort()
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
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// assert!(world.bytes() > 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.engine.bytes() + self.base.bytes()
    }
}
