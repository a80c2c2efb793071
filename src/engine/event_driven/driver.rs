//! Driver: turns and periods, up to the time that is asked for.

use super::clock::Clock;
use super::period::begin_period;
use super::region::Region;
use super::setting::Setting;
#[cfg(feature = "files")]
use super::snapshot;
use super::turns::{next_turn, take_turn};
use crate::bodies::Bodies;
use crate::column::Column;
use crate::compensated::CompensatedSum;
use crate::engine::account::{Account, Effort, Totals};
use crate::engine::interface::{Engine, EventEngine};
use crate::engine::plan::{Plan, Turning};
#[cfg(feature = "files")]
use crate::engine::snapshot::{Misfit, Snapshot, State};
use crate::engine::{EngineError, Execution, LONGEST_RUN, Listener};
use crate::mat3::Mat3;
use crate::motion::flight::Wrap;
use crate::motion::rotation::turned;
use crate::real::Real;
use crate::scene::{EngineKind, Scene};
use crate::vec3::Vec3;

/// A scene in motion, from collision to collision.
#[derive(Debug)]
pub(in crate::engine) struct Driver<T: Real> {
    setting: Setting<T>,
    region: Region<T>,
    clock: Clock<T>,
    account: Account,
}

impl<T: Real> Driver<T> {
    /// A scene at its start.
    pub fn new(scene: Scene<T>, execution: Execution) -> Self {
        let plan = Plan::new(&scene, EngineKind::EventDriven, execution, 1);
        let (mut setting, cells) = Setting::new(scene, plan);
        let region = Region::new(&setting, cells);
        setting.leave_to_region();
        let (clock, account) = (Clock::new(), Account::default());
        let mut driver = Self { setting, region, clock, account };
        driver.begin_period(T::ZERO);
        driver
    }

    fn begin_period(&mut self, end: T) {
        begin_period(&self.setting, &mut self.region, &mut self.clock, &mut self.account, end);
    }
}

impl<T: Real> EventEngine<T> for Driver<T> {
    fn advance_to(
        &mut self,
        time: f64,
        events: u64,
        mut on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        if time > LONGEST_RUN {
            return Err(EngineError::NoDuration(time));
        }
        let last = self.account.collisions.total().saturating_add(events);
        loop {
            let ahead = self.clock.in_period(time);
            let ends_here = ahead < self.clock.period;
            let limit = if ends_here { ahead } else { self.clock.period };
            while self.account.collisions.total() < last && !self.region.is_too_fast {
                let Some(turn) = next_turn(&mut self.region) else { break };
                if turn.time > limit {
                    break;
                }
                let progress = self.clock.check_progress(turn, self.region.records.len());
                if let Err(events) = progress {
                    self.clock.time = self.clock.since_start(turn.time);
                    let body = self.region.index[turn.slot as usize];
                    return Err(EngineError::Stalled { time: self.clock.time, events, body });
                }
                self.region.calendar.take();
                self.clock.count();
                let is_collision = take_turn(
                    &self.setting,
                    &mut self.region,
                    &self.clock,
                    &mut self.account,
                    turn,
                    &mut on_event,
                );
                if is_collision {
                    self.clock.last_collision = turn.time;
                }
            }
            if self.account.collisions.total() == last {
                let now = self.clock.not_before(self.clock.last_collision);
                // Not beyond the end, up to which it may have been rounded.
                self.clock.time = self.clock.time.max(now).min(time);
                return Ok(false);
            }
            if self.region.is_too_fast {
                self.begin_period(self.clock.last_collision);
            } else if ends_here {
                self.clock.time = time;
                return Ok(true);
            } else {
                self.begin_period(self.clock.period);
            }
            if !self.clock.too_fast.is_finite() {
                self.clock.time = self.clock.origin();
                return Err(EngineError::TooFast { time: self.clock.time });
            }
        }
    }

    fn mean_free_path(&self) -> Option<f64> {
        let ends = self.account.collisions.ends();
        let now = self.clock.now();
        let under_way: CompensatedSum = self
            .region
            .records
            .iter()
            .map(|record| {
                let flight = record.flight();
                (flight.velocity.length() * (now - flight.since)).to_f64()
            })
            .collect();
        (ends > 0).then(|| (self.account.path() + under_way.value()) / ends as f64)
    }

    fn effort(&self) -> Effort {
        self.account.effort
    }
}

impl<T: Real> Engine<T> for Driver<T> {
    fn plan(&self) -> &Plan {
        &self.setting.plan
    }

    fn gravity(&self) -> Vec3<T> {
        self.setting.gravity
    }

    fn time(&self) -> f64 {
        self.clock.time
    }

    fn totals(&self) -> Totals {
        self.account.totals()
    }

    fn bodies(&self) -> Bodies<T> {
        let Self { setting, region, .. } = self;
        let len = region.records.len();
        let now = self.clock.now();
        let columns = || core::array::from_fn(|_| Column::new(len, T::ZERO));
        let mut bodies = setting.bodies.clone();
        (bodies.position, bodies.velocity, bodies.spin) = (columns(), columns(), columns());
        if setting.plan.turning != Turning::Never {
            let rows = Mat3::<T>::IDENTITY.rows();
            bodies
                .orientation
                .get_or_insert_with(|| Box::new(rows.map(|element| Column::new(len, element))));
        }
        for slot in 0..len {
            let at = region.index[slot] as usize;
            let (position, velocity) = region.state_of(setting, slot, now);
            let position = setting.periodic.map_or(position, |space| space.wrap(position));
            let spin = region.spin_of(setting, slot);
            for k in 0..3 {
                bodies.position[k][at] = position.to_array()[k];
                bodies.velocity[k][at] = velocity.to_array()[k];
                bodies.spin[k][at] = spin.to_array()[k];
            }
            let orientation = match region.turned.get(slot) {
                Some(&(orientation, since)) => turned(orientation, spin, now - since),
                None => {
                    turned(setting.bodies.orientation_of(at), spin, T::from_f64(self.clock.time))
                }
            };
            if let Some(rows) = &mut bodies.orientation {
                for (column, element) in rows.iter_mut().zip(orientation.rows()) {
                    column[at] = element;
                }
            }
        }
        bodies
    }

    #[cfg(feature = "files")]
    fn save(&self) -> Snapshot {
        let state = State::EventDriven(snapshot::save(&self.region, &self.clock));
        Snapshot { account: self.account.clone(), state }
    }

    #[cfg(feature = "files")]
    fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        let State::EventDriven(state) = &saved.state else { return Err(Misfit("engine")) };
        snapshot::restore(&self.setting, &mut self.region, &mut self.clock, state)?;
        self.account.clone_from(&saved.account);
        Ok(())
    }

    fn bytes(&self) -> usize {
        self.setting.bytes() + self.region.bytes()
    }
}
