//! Batch: thousands of scenes in motion at once, one scene in each lane.
//!
//! Scenes of one shape stand in packs, the same body of all scenes side by side (`pack`),
//! and take their steps together (`step`, `meet`). What lanes do not take runs alone, each
//! scene in a world of its own (`setting` says which, `start` sorts them). `work` is what all
//! threads do.

mod fault;
mod meet;
mod moving;
mod pack;
mod seat;
mod setting;
mod start;
mod step;
mod view;
mod within;
mod work;

use std::collections::BTreeMap;

use super::{ChangeError, Collisions, Compiled, EngineError, Event, Execution, Plan, World};
use crate::bodies::Bodies;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::scene::{QuickCheck, Scene, SceneError};
use crate::vec3::Vec3;
use crate::workers::Workers;

pub use fault::{BatchError, Fault};
pub(super) use pack::Pack;
pub(super) use setting::Setting;
pub(super) use start::{Make, start};
pub(super) use step::{Events, advance};
pub use view::PackView;
pub(super) use within::Meetings;
pub(super) use work::Going;

use seat::Seat;
use work::{Alone, steps_in};

/// Steps after which the collisions of all scenes are reported.
const REPORTED: u64 = 256;

/// Where a scene is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Lane {
        pack: u32,
        lane: u32,
    },
    /// In a world of its own.
    Alone(u32),
    /// It was no scene from the start.
    Nowhere,
}

/// Many independent scenes in motion: one scene in each lane, packs of scenes on all
/// threads. Each has the bits that it has in a world of its own.
///
/// Lanes take scenes of one shape: the same number of bodies, fixed parts, surface and
/// integrator, in open space, by the stepped engine. They may differ in positions, velocities,
/// spins, radii, masses, gravity, step and duration.
/// All other scenes can be in a batch too, and run one by one on all threads; so do those of
/// more than 128 bodies, since lanes test every pair. `carom explain` says which way a scene
/// takes.
///
/// ```
/// use carom::scene::EngineKind;
/// use carom::{Batch, Execution, Impact, Scene, Sphere};
///
/// // A thousand pairs that meet at different speeds.
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5);
/// let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.015625);
/// let scene = scene.impact(Impact::EndOfStep).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
/// let mut batch = Batch::varied(&scene, 1000, Execution::new(), |k, scene| {
///     scene.bodies.velocity[0][0] = k as f64 / 1000.0;
/// })?;
/// batch.advance(2.0)?;
/// let collided = batch.collisions().filter(|collisions| collisions.pairs == 1).count();
/// assert_eq!(collided, 500);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Batch<T: Real> {
    setting: Setting<T>,
    workers: Workers,
    /// For contacts within steps, one for each worker.
    meetings: Vec<Option<Meetings<T>>>,
    packs: Vec<Pack<T>>,
    alone: Vec<Alone<T>>,
    places: Vec<Place>,
    /// How long each scene runs, time; not finite where that is left open.
    durations: Vec<f64>,
    execution: Execution,
    check: QuickCheck<T>,
    faults: BTreeMap<usize, Fault>,
    recorded: Vec<Events<T>>,
}

impl<T: Compiled> Batch<T> {
    /// `count` scenes: copies of one, each changed by `vary`, which is given its number. A
    /// copy that is no scene any more becomes a [fault](Batch::faults).
    ///
    /// `vary` may be called for several scenes at once and in any order.
    ///
    /// # Errors
    /// If there is no scene, or the system has no threads to give.
    pub fn varied(
        scene: &Scene<T>,
        count: usize,
        execution: Execution,
        vary: impl Fn(usize, &mut Scene<T>) + Sync,
    ) -> Result<Self, BatchError> {
        let check = QuickCheck::new(scene);
        T::start_batch(scene, count, execution, &|k| {
            let mut scene = scene.clone();
            vary(k, &mut scene);
            if check.accepts(&scene) { Ok(scene) } else { scene.checked_again() }
        })
    }

    /// `count` scenes, each as `make` gives it for its number; one that it cannot make
    /// becomes a [fault](Batch::faults). The shape is that of the first scene that it makes.
    ///
    /// ```
    /// use carom::scene::EngineKind;
    /// use carom::{Batch, Execution, Scene, Sphere};
    ///
    /// let batch = Batch::made(4, Execution::new(), |k| {
    ///     let ball = Sphere::new([0.0; 3]).radius(k as f64);
    ///     Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()
    /// })?;
    /// assert_eq!(batch.faults().map(|(k, _)| k).collect::<Vec<_>>(), [0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is no scene, or the system has no threads to give.
    pub fn made(
        count: usize,
        execution: Execution,
        make: impl Fn(usize) -> Result<Scene<T>, SceneError> + Sync,
    ) -> Result<Self, BatchError> {
        let mut first = None;
        for k in 0..count {
            match (make(k), first) {
                (Ok(scene), _) => return T::start_batch(&scene, count, execution, &make),
                (Err(error), None) => first = Some(error),
                (Err(_), kept) => first = kept,
            }
        }
        Err(first.map_or(BatchError::Empty, BatchError::Scene))
    }

    /// Takes one step in each scene.
    ///
    /// # Errors
    /// If a scene is run by the event-driven engine, which has no steps.
    pub fn step(&mut self) -> Result<(), EngineError> {
        self.advance_steps(1)
    }

    /// Takes this many steps in each scene.
    ///
    /// ```
    /// # use carom::scene::EngineKind;
    /// # use carom::{Batch, Execution, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()?;
    /// let mut batch = Batch::varied(&scene, 100, Execution::new(), |_, _| {})?;
    /// batch.advance_steps(8)?;
    /// assert_eq!(batch.time(99), Some(1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`step`](Batch::step).
    pub fn advance_steps(&mut self, steps: u64) -> Result<(), EngineError> {
        if self.alone.iter().any(|alone| matches!(alone.world, World::EventDriven(_))) {
            return Err(EngineError::NoStep);
        }
        self.set_goals(|seat| steps.saturating_add(seat.steps));
        T::go(self, &|_, world| {
            if let World::Stepped(world) = world {
                world.advance_steps(steps);
            }
            Ok(())
        });
        Ok(())
    }

    /// Lets this time pass in each scene; in those that have steps the whole number of them
    /// that is nearest to it.
    ///
    /// # Errors
    /// If the duration is negative, not finite, or more than 2⁵³ steps long.
    pub fn advance(&mut self, duration: f64) -> Result<(), EngineError> {
        self.check_duration(duration)?;
        self.set_goals(|seat| seat.steps.saturating_add(steps_in(duration, seat.exact_dt)));
        T::go(self, &|_, world| world.advance(duration));
        Ok(())
    }

    /// Lets each scene that has not moved yet run for its own duration, as `carom run` does:
    /// the whole number of steps that is nearest to it, at least one. Scenes that take about
    /// as many steps share a pack, so that no lane waits long for others. A scene without a
    /// duration rests.
    ///
    /// ```
    /// # use carom::scene::EngineKind;
    /// # use carom::{Batch, Execution, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()?;
    /// let mut batch = Batch::varied(&scene, 100, Execution::new(), |k, scene| {
    ///     scene.duration = Some(k as f64);
    /// })?;
    /// batch.run();
    /// assert_eq!(batch.time(99), Some(99.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn run(&mut self) {
        let Self { packs, durations, .. } = self;
        for seat in packs.iter_mut().flat_map(|pack| &mut pack.moving.seats) {
            let duration = seat.scene.map_or(f64::NAN, |scene| durations[scene]);
            let is_asked = duration.is_finite() && seat.steps == 0;
            seat.goal =
                if is_asked { steps_in(duration, seat.exact_dt).max(1) } else { seat.steps };
        }
        start::regroup(&self.setting, &mut self.packs, &mut self.places);
        let durations = core::mem::take(&mut self.durations);
        T::go(self, &|scene, world| match world {
            _ if !durations[scene].is_finite() || world.time() > 0.0 => Ok(()),
            World::Stepped(world) => {
                world.advance_steps(steps_in(durations[scene], world.exact_dt()).max(1));
                Ok(())
            }
            World::EventDriven(world) => world.advance(durations[scene]),
        });
        self.durations = durations;
    }

    /// [`advance`](Batch::advance), and reports the collisions with the numbers of their
    /// scenes. Those of a scene come in the order that they have in a world of its own; a
    /// scene's stretch of some hundred steps comes as a whole, and the scenes in the order of
    /// their packs.
    ///
    /// ```
    /// # use carom::scene::EngineKind;
    /// # use carom::{Batch, Execution, Impact, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125);
    /// # let scene = scene.impact(Impact::EndOfStep).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// let mut batch = Batch::varied(&scene, 100, Execution::new(), |_, _| {})?;
    /// let mut collisions = vec![0; 100];
    /// batch.for_each_event(1.0, |scene, _| collisions[scene] += 1)?;
    /// assert_eq!(collisions, [1; 100]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance`](Batch::advance).
    pub fn for_each_event(
        &mut self,
        duration: f64,
        mut on_event: impl FnMut(usize, &Event<T>),
    ) -> Result<(), EngineError> {
        self.check_duration(duration)?;
        T::tell_events(self, duration, &mut on_event);
        Ok(())
    }

    /// Gives a body an impulse, mass × length per time. The scene goes on as a world that is
    /// [changed](crate::engine::Change) so.
    ///
    /// ```
    /// # use carom::scene::EngineKind;
    /// # use carom::{Batch, Execution, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5).mass(2.0);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()?;
    /// let mut batch = Batch::varied(&scene, 100, Execution::new(), |_, _| {})?;
    /// batch.apply_impulse(7, 0, [4.0, 0.0, 0.0])?;
    /// batch.advance(1.0)?;
    /// assert_eq!(batch.position(7, 0).map(|place| place.x), Some(2.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is no such scene or body, or the change makes no scene. A scene that has gone
    /// wrong takes no impulse, which is no error.
    pub fn apply_impulse(
        &mut self,
        scene: usize,
        body: usize,
        impulse: impl Into<Vec3<T>>,
    ) -> Result<(), ChangeError> {
        let bodies = self.setting.plan.bodies;
        match self.place(scene)? {
            Place::Lane { .. } if body >= bodies => Err(ChangeError::Body { body, bodies }),
            Place::Lane { pack, lane } => {
                self.packs[pack as usize].push(lane as usize, body, impulse.into());
                Ok(())
            }
            Place::Alone(alone) => {
                let mut change = self.alone[alone as usize].world.change();
                change.apply_impulse(body, impulse);
                change.apply()
            }
            Place::Nowhere => Ok(()),
        }
    }

    /// Puts a scene of the batch to a start, at time 0: its fault, if it had one, is gone.
    ///
    /// ```
    /// # use carom::scene::EngineKind;
    /// # use carom::{Batch, Execution, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()?;
    /// let mut batch = Batch::varied(&scene, 100, Execution::new(), |_, _| {})?;
    /// batch.advance(1.0)?;
    /// batch.reset(7, &scene)?;
    /// assert_eq!((batch.time(7), batch.time(8)), (Some(0.0), Some(1.0)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is no such scene in the batch, or the start is no scene; the batch is then as
    /// it was.
    pub fn reset(&mut self, scene: usize, start: &Scene<T>) -> Result<(), ChangeError> {
        T::reset(self, scene, start)
    }
}

impl<T: Real> Batch<T> {
    fn place(&self, scene: usize) -> Result<Place, ChangeError> {
        let scenes = self.len();
        self.places.get(scene).copied().ok_or(ChangeError::NoScene { scene, scenes })
    }

    /// How many scenes there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The plan of the first scene.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.setting.plan
    }

    /// How many scenes are in lanes; the others run alone.
    ///
    /// ```
    /// # use carom::{Batch, Execution, Scene, Sphere};
    /// let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
    /// // The event-driven engine has its own way.
    /// let batch = Batch::varied(&scene, 100, Execution::new(), |_, _| {})?;
    /// assert_eq!((batch.len(), batch.in_lanes()), (100, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn in_lanes(&self) -> usize {
        self.places.iter().filter(|place| matches!(place, Place::Lane { .. })).count()
    }

    /// The scenes that do not go on, by number, and why.
    pub fn faults(&self) -> impl Iterator<Item = (usize, &Fault)> {
        self.faults.iter().map(|(scene, fault)| (*scene, fault))
    }

    /// Why a scene does not go on, if it does not.
    #[must_use]
    pub fn fault(&self, scene: usize) -> Option<&Fault> {
        self.faults.get(&scene)
    }

    /// The bodies of a scene now, as a world of its own would have them; `None` for one that
    /// was found [not finite](Fault::NotFinite) in a lane, or that was none.
    ///
    /// ```
    /// # use carom::scene::EngineKind;
    /// # use carom::{Batch, Execution, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()?;
    /// let mut batch = Batch::varied(&scene, 100, Execution::new(), |_, _| {})?;
    /// batch.advance(1.0)?;
    /// assert_eq!(batch.bodies(99).map(|bodies| bodies.position_of(0).x), Some(1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn bodies(&self, scene: usize) -> Option<Bodies<T>> {
        self.of(scene, |pack, lane| pack.bodies(&self.setting, lane), World::bodies)
    }

    /// The bodies in double precision, where they are known to more digits.
    pub(crate) fn finer_bodies(&self, scene: usize) -> Option<Bodies<f64>> {
        self.of(scene, |_, _| None, World::finer_bodies).flatten()
    }

    /// The uniform acceleration in a scene, length per time².
    #[must_use]
    pub fn gravity(&self, scene: usize) -> Option<Vec3<T>> {
        self.of(scene, |pack, lane| pack.gravity.refs().each(|g| g[lane]).into(), World::gravity)
    }

    /// The centre of a body of a scene, length.
    #[must_use]
    pub fn position(&self, scene: usize, body: usize) -> Option<Vec3<T>> {
        let is_there = body < self.setting.plan.bodies;
        let of_world = |world: &World<T>| {
            let bodies = world.bodies();
            (body < bodies.len()).then(|| bodies.position_of(body))
        };
        let of_lane = |pack: &Pack<T>, lane| is_there.then(|| pack.position_of(body, lane));
        self.of(scene, of_lane, of_world).flatten()
    }

    /// Time since the start of a scene.
    #[must_use]
    pub fn time(&self, scene: usize) -> Option<f64> {
        self.of(scene, |pack, lane| pack.moving.seats[lane].time(), World::time)
    }

    /// Steps that a scene has taken.
    #[must_use]
    pub fn steps(&self, scene: usize) -> Option<u64> {
        self.of(scene, |pack, lane| pack.moving.seats[lane].steps, World::steps)
    }

    /// Collisions in a scene since its start.
    #[must_use]
    pub fn collisions_of(&self, scene: usize) -> Option<Collisions> {
        self.of(scene, |pack, lane| pack.moving.seats[lane].collisions, World::collisions)
    }

    /// Collisions in all scenes since their starts; none of a scene that has gone wrong.
    pub fn collisions(&self) -> impl Iterator<Item = Collisions> {
        (0..self.len()).map(|scene| self.collisions_of(scene).unwrap_or_default())
    }

    /// What a function makes of the number and the bodies of each scene, in their order;
    /// `None` as [`bodies`](Batch::bodies) has it. Threads share the scenes.
    ///
    /// ```
    /// # use carom::scene::EngineKind;
    /// # use carom::{Batch, Execution, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()?;
    /// let mut batch = Batch::varied(&scene, 3, Execution::new(), |k, scene| {
    ///     scene.bodies.velocity[0][0] = k as f64;
    /// })?;
    /// batch.advance(1.0)?;
    /// let places = batch.observe(|_, bodies| bodies.position_of(0).x);
    /// assert_eq!(places, [Some(0.0), Some(1.0), Some(2.0)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn observe<R: Send>(&self, of: impl Fn(usize, &Bodies<T>) -> R + Sync) -> Vec<Option<R>> {
        let mut all: Vec<_> = (0..self.len()).map(|scene| (scene, None)).collect();
        self.workers.each(&mut all, |(scene, observed)| {
            *observed = self.bodies(*scene).map(|bodies| of(*scene, &bodies));
        });
        all.into_iter().map(|(_, observed)| observed).collect()
    }

    /// The scenes in lanes as slices, pack by pack.
    ///
    /// ```
    /// # use carom::scene::EngineKind;
    /// # use carom::{Batch, Execution, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()?;
    /// let batch = Batch::varied(&scene, 20, Execution::new(), |_, _| {})?;
    /// for pack in batch.packs() {
    ///     for (lane, scene) in pack.scenes() {
    ///         assert_eq!(pack.velocity[0][pack.index(0, lane)], 1.0, "{scene}");
    ///     }
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn packs(&self) -> impl Iterator<Item = PackView<'_, T>> {
        self.packs.iter().map(PackView::of)
    }

    /// The bytes that the scenes hold.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let alone = self.alone.iter().map(|alone| alone.world.bytes()).sum::<usize>();
        let index = size_of_val(self.places.as_slice()) + size_of_val(self.durations.as_slice());
        let meetings = self.meetings.iter().flatten().map(Meetings::bytes).sum::<usize>();
        self.packs.iter().map(Pack::bytes).sum::<usize>() + meetings + alone + index
    }

    /// What a scene has, by where it is.
    fn of<R>(
        &self,
        scene: usize,
        in_lane: impl FnOnce(&Pack<T>, usize) -> R,
        alone: impl FnOnce(&World<T>) -> R,
    ) -> Option<R> {
        match self.places.get(scene)? {
            Place::Lane { pack, lane } => {
                let (pack, lane) = (&self.packs[*pack as usize], *lane as usize);
                pack.moving.seats[lane].scene.map(|_| in_lane(pack, lane))
            }
            Place::Alone(index) => Some(alone(&self.alone[*index as usize].world)),
            Place::Nowhere => None,
        }
    }

    /// Sets after how many steps each scene in a lane rests.
    fn set_goals(&mut self, goal: impl Fn(&Seat<T>) -> u64) {
        let seats = self.packs.iter_mut().flat_map(|pack| &mut pack.moving.seats);
        seats.for_each(|seat| seat.goal = goal(seat));
    }

    /// Notes the scenes that have gone wrong.
    fn find_faults(&mut self) {
        for pack in self.packs.iter_mut().filter(|pack| pack.has_broken()) {
            for lane in pack.broken_lanes() {
                let seat = &pack.moving.seats[lane];
                if let Some(scene) = seat.scene {
                    self.faults.insert(scene, Fault::NotFinite { time: seat.time() });
                }
                pack.vacate(&self.setting, lane);
            }
        }
        for alone in self.alone.iter_mut() {
            if let Some(fault) = alone.fault.take() {
                self.faults.insert(alone.scene, fault);
            }
        }
    }
}
