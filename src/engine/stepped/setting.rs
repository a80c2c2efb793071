//! Setting: what all workers read and none writes.

use super::path::Path;
use crate::engine::parts::{Counted, Counter};
use crate::engine::plan::Plan;
use crate::engine::{EngineError, Execution};
use crate::motion::Integrator;
use crate::real::Real;
use crate::scene::{EngineKind, Impact, Scene};
use crate::space::PeriodicBox;
use crate::surroundings::Features;
use crate::vec3::Vec3;
use crate::workers::Workers;

/// The scene but for its bodies, and its plan. All of it follows from the scene:
/// a restart file keeps the scene instead.
#[derive(Debug)]
pub(super) struct Setting<T: Real> {
    pub plan: Plan,
    /// Length of a step, time.
    pub dt: T,
    /// The scene's own step, before it was rounded to the precision.
    pub exact_dt: f64,
    pub gravity: Vec3<T>,
    pub integrator: Integrator,
    /// The gravity, where there is any.
    pub acceleration: Option<Vec3<T>>,
    pub periodic: Option<PeriodicBox<T>>,
    /// The shape of the paths within a step.
    pub path: Path<T>,
    pub features: Features<T>,
    /// Which of them are counted apart.
    pub counted: Counted,
    pub workers: Workers,
}

impl<T: Real> Setting<T> {
    /// What a scene says and how it is run.
    ///
    /// # Errors
    /// If the scene has no `dt`, or the system no threads to give.
    pub fn new(scene: &Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        let exact_dt = scene.stepped.dt.ok_or(EngineError::NoStep)?;
        let dt = T::from_f64(exact_dt);
        let workers = Workers::new(execution.threads)?;
        let plan = Plan::new(scene, EngineKind::Stepped, execution, workers.threads());
        let met: &[_] = if plan.features > 0 { &scene.surroundings } else { &[] };
        let features = Features::new(met);
        let counted = Counted::of(scene);
        Ok(Self {
            dt,
            exact_dt,
            gravity: scene.gravity,
            integrator: plan.integrator,
            acceleration: plan.has_field.then_some(scene.gravity),
            periodic: scene.periodic,
            path: Path::new(plan.integrator, plan.impact, scene.gravity, dt),
            features,
            counted,
            workers,
            plan,
        })
    }

    /// The counter of a feature's part, if it has one.
    #[inline(always)]
    pub fn counter(&self, feature: u32) -> Option<Counter> {
        self.counted.counter(self.features.shape_of(feature))
    }

    /// Whether there is anything to collide with.
    pub fn has_contacts(&self) -> bool {
        self.plan.has_pairs || !self.features.is_empty()
    }

    /// Whether contacts take effect at their own time inside a step.
    pub fn is_within_step(&self) -> bool {
        self.plan.impact == Impact::SubStep
    }
}
