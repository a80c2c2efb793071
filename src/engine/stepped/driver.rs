//! Driver: step after step.

use super::candidates::renew;
use super::clock::Clock;
use super::find::find_contacts;
use super::fly::{fly, rotate};
use super::in_order::collide_in_order;
use super::lanes::in_lanes;
use super::record::Record;
use super::region::Region;
use super::resolve::resolve;
use super::setting::Setting;
#[cfg(feature = "files")]
use super::snapshot;
use crate::bodies::{Bodies, Columns3};
use crate::engine::account::{Account, Totals};
use crate::engine::interface::{Engine, StepEngine};
use crate::engine::plan::{Plan, Turning};
#[cfg(feature = "files")]
use crate::engine::snapshot::{Misfit, Snapshot, State};
use crate::engine::{EngineError, Execution, Listener, PartTotals};
use crate::real::Real;
use crate::scene::Scene;
use crate::vec3::Vec3;

/// A scene in motion, by steps of fixed length.
#[derive(Debug)]
pub(in crate::engine) struct Driver<T: Real> {
    setting: Setting<T>,
    region: Region<T>,
    clock: Clock,
    account: Account,
}

impl<T: Real> Driver<T> {
    /// A scene at its start.
    ///
    /// # Errors
    /// If the scene has no `dt`, or the system no threads to give.
    pub fn new(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        let setting = Setting::new(&scene, execution)?;
        let region = Region::new(&setting, scene.bodies);
        Ok(Self { setting, region, clock: Clock::default(), account: Account::default() })
    }
}

impl<T: Real> StepEngine<T> for Driver<T> {
    fn dt(&self) -> T {
        self.setting.dt
    }

    fn exact_dt(&self) -> f64 {
        self.setting.exact_dt
    }

    fn steps(&self) -> u64 {
        self.clock.steps
    }

    fn centers(&self) -> Columns3<T> {
        let state = &self.region.state;
        state.by_index(&state.position)
    }

    fn take_steps(&mut self, steps: u64, on_event: Listener<'_, T>) {
        let Self { setting, region, clock, account } = self;
        match on_event {
            // From inside the pool a step hands out its work at the least cost.
            None => setting.workers.run(|| {
                for _ in 0..steps {
                    take_step(setting, region, clock, account, None);
                }
            }),
            Some(on_event) => {
                for _ in 0..steps {
                    let mut record = Record::default();
                    take_step(setting, region, clock, account, Some(&mut record));
                    record.report(on_event);
                }
            }
        }
    }
}

/// Takes one step: flight, candidates, contacts.
fn take_step<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &mut Clock,
    account: &mut Account,
    record: Option<&mut Record<T>>,
) {
    let travel = fly(setting, &mut region.state);
    clock.steps += 1;
    if setting.plan.turning == Turning::EachStep {
        rotate(setting, &mut region.state);
    }
    region.state.keep_count(clock.steps, setting.dt);
    if !setting.has_contacts() {
        return;
    }
    let nearby = &mut region.nearby;
    nearby.travelled = nearby.travelled + travel + nearby.broadphase.rounding();
    if setting.is_within_step() {
        collide_in_order(setting, region, clock, account, record, travel);
        return;
    }
    if clock.steps == 1 || !nearby.is_complete() {
        in_lanes!(gather setting.plan.gather_lanes, renew::<T>(setting, region, travel, None));
    }
    find_contacts(setting, region);
    resolve(setting, region, clock, account, record);
}

impl<T: Real> Engine<T> for Driver<T> {
    fn plan(&self) -> &Plan {
        &self.setting.plan
    }

    fn gravity(&self) -> Vec3<T> {
        self.setting.gravity
    }

    fn time(&self) -> f64 {
        self.clock.time(self.setting.exact_dt)
    }

    fn totals(&self) -> Totals {
        self.account.totals()
    }

    fn parts(&self) -> Vec<PartTotals> {
        self.setting.counted.totals(self.account.parts())
    }

    fn bodies(&self) -> Bodies<T> {
        self.region.state.bodies(self.clock.steps, self.setting.dt)
    }

    #[cfg(feature = "files")]
    fn save(&self) -> Snapshot {
        let state = State::Stepped(snapshot::save(&self.region, &self.clock));
        Snapshot::of(&self.account, state)
    }

    #[cfg(feature = "files")]
    fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        let State::Stepped(state) = &saved.state else { return Err(Misfit("engine")) };
        let start = self.bodies();
        snapshot::restore(&self.setting, &mut self.region, &mut self.clock, start, state)?;
        self.account.clone_from(&saved.account);
        Ok(())
    }

    fn bytes(&self) -> usize {
        self.region.bytes() + self.setting.features.bytes()
    }
}
