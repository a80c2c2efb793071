//! Idle: an engine without bodies. A world that has lost all of them goes on, until others
//! come.

#[cfg(feature = "files")]
use super::account::Account;
use super::account::{Effort, Totals};
use super::interface::{Engine, EventEngine, StepEngine, Stretch};
use super::parts::Counted;
#[cfg(feature = "files")]
use super::snapshot::{Misfit, Snapshot, State};
use super::{Collisions, EngineError, Execution, LONGEST_RUN, Listener, PartTotals, Plan};
use crate::bodies::{Bodies, Columns3};
use crate::real::Real;
use crate::scene::{EngineKind, Scene};
use crate::vec3::Vec3;

/// Time alone.
#[derive(Debug)]
pub(super) struct Idle<T> {
    plan: Plan,
    gravity: Vec3<T>,
    counted: Counted,
    /// Length of a step; 0 without steps.
    dt: f64,
    time: f64,
    steps: u64,
}

impl<T: Real> Idle<T> {
    /// Of a scene without bodies.
    ///
    /// # Errors
    /// If the stepped engine has no step.
    pub fn new(
        scene: &Scene<T>,
        engine: EngineKind,
        execution: Execution,
    ) -> Result<Self, EngineError> {
        let dt = match engine {
            EngineKind::Stepped => scene.stepped.dt.ok_or(EngineError::NoStep)?,
            EngineKind::EventDriven => 0.0,
        };
        let plan = Plan::new(scene, engine, execution, 1);
        let (gravity, counted) = (scene.gravity, Counted::of(scene));
        Ok(Self { plan, gravity, counted, dt, time: 0.0, steps: 0 })
    }
}

impl<T: Real> Engine<T> for Idle<T> {
    fn plan(&self) -> &Plan {
        &self.plan
    }

    fn gravity(&self) -> Vec3<T> {
        self.gravity
    }

    fn time(&self) -> f64 {
        self.time + self.steps as f64 * self.dt
    }

    fn totals(&self) -> Totals {
        Totals { collisions: Collisions::default(), virial: 0.0, impulse: [0.0; 3] }
    }

    fn parts(&self) -> Vec<PartTotals> {
        self.counted.totals(&[])
    }

    fn bodies(&self) -> Bodies<T> {
        Bodies::none().left_by_world()
    }

    #[cfg(feature = "files")]
    fn save(&self) -> Snapshot {
        let state = State::Idle { time: self.time, steps: self.steps };
        Snapshot::of(&Account::default(), state)
    }

    #[cfg(feature = "files")]
    fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        let State::Idle { time, steps } = saved.state else { return Err(Misfit("bodies")) };
        (self.time, self.steps) = (time, steps);
        Ok(())
    }

    fn bytes(&self) -> usize {
        0
    }
}

impl<T: Real> StepEngine<T> for Idle<T> {
    fn dt(&self) -> T {
        T::from_f64(self.dt)
    }

    fn exact_dt(&self) -> f64 {
        self.dt
    }

    fn steps(&self) -> u64 {
        self.steps
    }

    fn centers(&self) -> Columns3<T> {
        Bodies::none().position
    }

    fn take_steps(&mut self, steps: u64, _on_event: Listener<'_, T>) {
        self.steps += steps;
    }
}

impl<T: Real> EventEngine<T> for Idle<T> {
    fn advance_to(
        &mut self,
        time: f64,
        _stretch: Stretch,
        _on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        if time > LONGEST_RUN {
            return Err(EngineError::NoDuration(time));
        }
        self.time = time;
        Ok(true)
    }

    fn mean_free_path(&self) -> Option<f64> {
        None
    }

    fn effort(&self) -> Effort {
        Effort::default()
    }

    fn take_out(&mut self, _index: u32) -> Option<Bodies<T>> {
        None
    }
}
