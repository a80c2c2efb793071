//! Setting: what the scenes in lanes have in common, and which scenes lanes take.

use super::within::Meetings;
use crate::engine::frame::Frame;
use crate::engine::plan::{Plan, Turning, has_field, summation};
use crate::engine::stepped::in_lanes;
use crate::engine::{EngineError, Execution, Lanes};
use crate::lane::Lane;
use crate::real::Real;
use crate::scene::{EngineKind, Impact, OrientationUpdate, Scene};
use crate::surroundings::Features;

/// The most bodies of a scene in a lane. Every pair of them is tested in each step.
const MOST_BODIES: usize = 128;

/// The most contacts that a step of a scene in a lane can have: the engine alone puts off
/// to the next step what comes after that number of rounds.
const MOST_CONTACTS: usize = 10_000;

/// The shape of the scenes in lanes. All workers read it, none writes it.
#[derive(Debug)]
pub struct Setting<T: Real> {
    /// The plan of the first scene.
    pub plan: Plan,
    /// Scenes in a pack: one in each lane.
    pub width: usize,
    /// None of them is of a mesh.
    pub(in crate::engine) features: Features<T>,
    /// The first scene, without bodies.
    first: Scene<T>,
}

impl<T: Real> Setting<T> {
    /// Of scenes with the shape of the first one.
    pub fn new(first: &Scene<T>, execution: Execution, threads: usize) -> Self {
        let plan = Plan::new(first, first.engine, execution, threads);
        let met: &[_] = if plan.features > 0 { &first.surroundings } else { &[] };
        let features = Features::new(met);
        let lanes = lanes::<T>(execution.lanes);
        let width = in_lanes!(sweep lanes, width::<T>());
        Self { plan, width, features, first: first.without_bodies() }
    }

    /// What each worker needs for contacts that take effect within a step; `None` where they do
    /// at its end, or where there is nothing to touch. `first` has the shape of all scenes.
    pub fn meetings(&self, first: &Scene<T>) -> Result<Option<Meetings<T>>, EngineError> {
        let has_contacts = self.plan.has_pairs || !self.features.is_empty();
        let is_within = self.plan.impact == Impact::SubStep && has_contacts && self.has_lanes();
        is_within.then(|| Meetings::new(first, self.width)).transpose()
    }

    /// Whether any scene of this shape is in a lane.
    pub fn has_lanes(&self) -> bool {
        self.plan.alone_in_batch().is_none() && self.first.stepped.dt.is_some()
    }

    /// Whether a scene can be in a lane; if not, it runs alone.
    pub fn takes(&self, scene: &Scene<T>) -> bool {
        let (first, plan) = (&self.first, &self.plan);
        self.has_lanes()
            && scene.engine == first.engine
            && scene.bodies.len() == plan.bodies
            && scene.surface == first.surface
            && scene.encounters == first.encounters
            && scene.periodic.is_none()
            && scene.stepped.dt.is_some()
            && scene.stepped.impact == first.stepped.impact
            && scene.stepped.integrator == first.stepped.integrator
            && scene.stepped.orientation == OrientationUpdate::WhenAsked
            && scene.surroundings == first.surroundings
            && scene.removes == first.removes
            && scene.inlets.is_empty()
            && has_field(scene) == plan.has_field
            && summation(scene) == plan.summation
            && Frame::of(scene).is_none()
    }
}

impl Plan {
    /// Why scenes with this plan run one by one in a batch; `None` if each is in a lane.
    pub(in crate::engine) fn alone_in_batch(&self) -> Option<&'static str> {
        let pairs = self.bodies * self.bodies.saturating_sub(1) / 2;
        let contacts = self.bodies * self.features + if self.has_pairs { pairs } else { 0 };
        if self.engine == EngineKind::EventDriven {
            Some("collisions have times of their own")
        } else if self.inlets + self.drains > 0 {
            Some("spheres come and go")
        } else if self.sensors > 0 {
            Some("sensors look at each scene")
        } else if self.is_periodic {
            Some("space is periodic")
        } else if self.has_meshes {
            Some("bodies meet a mesh")
        } else if self.turning == Turning::EachStep {
            Some("orientations are turned in each step")
        } else if self.has_pairs && self.bodies > MOST_BODIES || contacts > MOST_CONTACTS {
            Some("there are more bodies than lanes test in all pairs")
        } else {
            None
        }
    }
}

/// The lanes for a batch.
fn lanes<T: Real>(lanes: Lanes) -> usize {
    match lanes {
        Lanes::Auto if size_of::<T>() <= 4 => 16,
        Lanes::Auto | Lanes::Eight => 8,
        Lanes::Scalar => 1,
        Lanes::Four => 4,
        Lanes::Sixteen => 16,
    }
}

fn width<L: Lane<Scalar = T>, T: Real>() -> usize {
    L::WIDTH
}
