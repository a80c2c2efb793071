//! Later: an engine that goes on from where another one has stopped: a world after a
//! change. The engine is one of a new world, at its start; time, steps and what is added up
//! go on.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::account::{Effort, Totals};
use super::change::KeptParts;
#[cfg(feature = "files")]
use super::handles::Handles;
use super::interface::{Engine, EventEngine, StepEngine, Stretch};
#[cfg(feature = "files")]
use super::snapshot::{Misfit, SavedLater, SavedStart, Snapshot};
use super::{Collisions, EngineError, Event, Listener, PartTotals, Plan};
use crate::bodies::{Bodies, Columns3};
use crate::numbers::array;
use crate::real::Real;
use crate::scene::Scene;
use crate::vec3::Vec3;

/// What had passed and added up before.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub(super) struct Elapsed {
    pub time: f64,
    pub steps: u64,
    pub collisions: Collisions,
    pub virial: f64,
    pub impulse: [f64; 3],
    pub parts: Vec<PartTotals>,
}

impl Elapsed {
    /// Of an engine that has come so far.
    pub fn of<T: Real>(engine: &(impl Engine<T> + ?Sized), steps: u64) -> Self {
        let Totals { collisions, virial, impulse } = engine.totals();
        let parts = engine.parts();
        Self { time: engine.time(), steps, collisions, virial, impulse, parts }
    }

    /// The same of the parts that a change has left, under their indices now.
    pub fn keeping(self, kept: Option<&KeptParts>) -> Self {
        match kept {
            Some(kept) => Self { parts: kept.totals(self.parts), ..self },
            None => self,
        }
    }

    /// An event at its time since the start of the run, which is not after `last`.
    fn event<T: Real>(&self, event: &Event<T>, last: f64) -> Event<T> {
        Event { time: (event.time + self.time).min(last), ..*event }
    }

    fn error(&self, error: EngineError) -> EngineError {
        match error {
            EngineError::Stalled { time, events, body } => {
                EngineError::Stalled { time: time + self.time, events, body }
            }
            EngineError::TooFast { time } => EngineError::TooFast { time: time + self.time },
            EngineError::NoDuration(time) => EngineError::NoDuration(time + self.time),
            other => other,
        }
    }
}

/// An engine that goes on from there.
#[derive(Debug)]
pub(super) struct Later<T: Real, E: ?Sized> {
    elapsed: Elapsed,
    /// The time up to which all is done, as it was asked for: a sum would be rounded.
    asked: Option<f64>,
    /// The gravity and the bodies that the engine started with: a snapshot keeps them.
    #[cfg(feature = "files")]
    start: (Vec3<T>, Bodies<T>),
    engine: Box<E>,
    precision: core::marker::PhantomData<T>,
}

impl<T: Real, E: Engine<T> + ?Sized> Later<T, E> {
    /// The engine that `start` makes of a scene, after what has elapsed.
    pub fn new<Mistake>(
        scene: Scene<T>,
        elapsed: Elapsed,
        start: impl FnOnce(Scene<T>) -> Result<Box<E>, Mistake>,
    ) -> Result<Self, Mistake> {
        #[cfg(feature = "files")]
        let kept = (scene.gravity, scene.bodies.clone());
        Ok(Self {
            elapsed,
            asked: None,
            #[cfg(feature = "files")]
            start: kept,
            engine: start(scene)?,
            precision: core::marker::PhantomData,
        })
    }
}

impl<T: Real, E: Engine<T> + ?Sized> Engine<T> for Later<T, E> {
    fn plan(&self) -> &Plan {
        self.engine.plan()
    }

    fn gravity(&self) -> Vec3<T> {
        self.engine.gravity()
    }

    fn time(&self) -> f64 {
        self.asked.unwrap_or_else(|| self.elapsed.time + self.engine.time())
    }

    fn totals(&self) -> Totals {
        let Elapsed { collisions, virial, impulse, .. } = self.elapsed;
        let now = self.engine.totals();
        Totals {
            collisions: Collisions {
                pairs: collisions.pairs + now.collisions.pairs,
                surroundings: collisions.surroundings + now.collisions.surroundings,
            },
            virial: virial + now.virial,
            impulse: array::from_fn(|axis| impulse[axis] + now.impulse[axis]),
        }
    }

    fn parts(&self) -> Vec<PartTotals> {
        let before = &self.elapsed.parts;
        let sum = |now: PartTotals| match before.binary_search_by_key(&now.part, |it| it.part) {
            Ok(at) => now.after(&before[at]),
            Err(_) => now,
        };
        self.engine.parts().into_iter().map(sum).collect()
    }

    fn bodies(&self) -> Bodies<T> {
        self.engine.bodies()
    }

    #[cfg(feature = "files")]
    fn save(&self) -> Snapshot {
        let (gravity, bodies) = &self.start;
        let later = SavedLater {
            elapsed: self.elapsed.clone(),
            asked: self.asked,
            start: SavedStart::of(*gravity, bodies),
            // The world knows them.
            handles: Handles::default(),
            parts: None,
        };
        Snapshot { later: Some(Box::new(later)), ..self.engine.save() }
    }

    #[cfg(feature = "files")]
    fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        if let Some(later) = &saved.later {
            (self.elapsed, self.asked) = (later.elapsed.clone(), later.asked);
        }
        self.engine.restore(saved)
    }

    fn finer_bodies(&self) -> Option<Bodies<f64>> {
        self.engine.finer_bodies()
    }

    fn bytes(&self) -> usize {
        #[cfg(feature = "files")]
        let kept = self.start.1.bytes();
        #[cfg(not(feature = "files"))]
        let kept = 0;
        kept + self.engine.bytes()
    }
}

impl<T: Real, E: StepEngine<T> + ?Sized> StepEngine<T> for Later<T, E> {
    fn dt(&self) -> T {
        self.engine.dt()
    }

    fn exact_dt(&self) -> f64 {
        self.engine.exact_dt()
    }

    fn steps(&self) -> u64 {
        self.elapsed.steps + self.engine.steps()
    }

    fn centers(&self) -> Columns3<T> {
        self.engine.centers()
    }

    fn take_steps(&mut self, steps: u64, on_event: Listener<'_, T>) {
        let Self { elapsed, engine, .. } = self;
        match on_event {
            None => engine.take_steps(steps, None),
            Some(on_event) => {
                let mut listener =
                    |event: &Event<T>| on_event(&elapsed.event(event, f64::INFINITY));
                engine.take_steps(steps, Some(&mut listener));
            }
        }
    }
}

impl<T: Real, E: EventEngine<T> + ?Sized> EventEngine<T> for Later<T, E> {
    fn advance_to(
        &mut self,
        time: f64,
        stretch: Stretch,
        on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        let Self { elapsed, engine, .. } = self;
        // Not before now, below which it may have been rounded.
        let end = (time - elapsed.time).max(engine.time());
        let done = match on_event {
            None => engine.advance_to(end, stretch, None),
            Some(on_event) => {
                let mut listener = |event: &Event<T>| on_event(&elapsed.event(event, time));
                engine.advance_to(end, stretch, Some(&mut listener))
            }
        };
        let now = (elapsed.time + engine.time()).min(time);
        self.asked = Some(if matches!(done, Ok(true)) { time } else { now });
        done.map_err(|error| self.elapsed.error(error))
    }

    fn mean_free_path(&self) -> Option<f64> {
        self.engine.mean_free_path()
    }

    fn effort(&self) -> Effort {
        self.engine.effort()
    }

    fn take_out(&mut self, index: u32) -> Option<Bodies<T>> {
        self.engine.take_out(index)
    }
}
