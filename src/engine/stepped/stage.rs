//! Stage: a small scene, one after another, for the contacts within a step.
//!
//! A batch flies its scenes in lanes, and finds there which bodies meet within a step. A scene
//! in which some do comes onto a stage: there its contacts take effect by the functions, and so
//! with the bits, of a scene alone.

use super::clock::Clock;
use super::contacts::Contact;
use super::in_order::collide_found;
use super::path::Path;
use super::record::Record;
use super::region::Region;
use super::setting::Setting;
use super::state::State;
use crate::engine::account::Account;
use crate::engine::{Collisions, EngineError, Execution, Listener};
use crate::real::Real;
use crate::scene::Scene;
use crate::vec3::Vec3;

/// A scene at the end of a step of flight, all of whose bodies are candidates of each other.
#[derive(Debug)]
pub(in crate::engine) struct Stage<T: Real> {
    setting: Setting<T>,
    region: Region<T>,
    clock: Clock,
    account: Account,
}

/// The steps of a scene.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct Steps<T> {
    pub taken: u64,
    /// The length of a step, as the scene has it and as the precision rounds it.
    pub exact_dt: f64,
    pub dt: T,
    pub gravity: Vec3<T>,
}

impl<T: Real> Stage<T> {
    /// For scenes of the shape of this one.
    ///
    /// # Errors
    /// If it has no `dt`.
    pub fn new(scene: &Scene<T>) -> Result<Self, EngineError> {
        let setting = Setting::new(scene, Execution::new().threads(1))?;
        let mut region = Region::new(&setting, scene.bodies.clone());
        let contacts = Self::room(scene);
        region.pending.ahead.reserve(contacts);
        region.pending.queue.reserve(contacts);
        region.pending.struck.reserve(contacts);
        region.nearby.are_all = true;
        region.nearby.skin = T::from_f64(f64::INFINITY);
        Ok(Self { setting, region, clock: Clock::default(), account: Account::default() })
    }

    /// Contacts of a step that there is room for from the start, so that steps allocate nothing:
    /// many of each body.
    pub fn room(scene: &Scene<T>) -> usize {
        16 * scene.bodies.len()
    }

    /// The bodies, for the next scene to take their places.
    pub fn state(&mut self) -> &mut State<T> {
        &mut self.region.state
    }

    /// Lets the contacts of a step take effect, of which these were found in flight, and gives
    /// how many collisions there were. No body is faster than `fastest` before them.
    pub fn collide(
        &mut self,
        steps: Steps<T>,
        found: &[Contact<T>],
        fastest: T,
        on_event: Listener<'_, T>,
    ) -> Collisions {
        let Self { setting, region, clock, account } = self;
        let Steps { taken, exact_dt, dt, gravity } = steps;
        setting.path = Path::new(setting.integrator, setting.plan.impact, gravity, dt);
        setting.acceleration = setting.plan.has_field.then_some(gravity);
        (setting.gravity, setting.dt, setting.exact_dt) = (gravity, dt, exact_dt);
        region.pending.struck.begin(dt);
        region.nearby.travelled = T::ZERO;
        clock.steps = taken;
        let mut record = on_event.is_some().then(Record::default);
        collide_found(setting, region, clock, account, record.as_mut(), found, fastest);
        if let (Some(record), Some(on_event)) = (record, on_event) {
            record.report(on_event);
        }
        core::mem::take(&mut account.collisions)
    }

    /// The slots of the bodies that have collided in the last step, some more than once, and
    /// all bodies after it.
    pub fn outcome(&mut self) -> (&[u32], &mut State<T>) {
        let Region { state, pending, .. } = &mut self.region;
        (pending.struck.slots(), state)
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.region.bytes() + self.setting.features.bytes()
    }
}
