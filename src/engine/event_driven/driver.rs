//! Driver: turns, windows and periods, up to the time that is asked for.

use super::clock::Clock;
use super::order::{End, Shift, longest_window};
use super::period::{begin_period, place};
use super::region::Worker;
use super::setting::Setting;
#[cfg(feature = "files")]
use super::snapshot;
use super::store::Store;
use super::territories::Team;
use super::turns::{is_removed_next, next_turn, take_turn};
use crate::bodies::Bodies;
use crate::column::Column;
use crate::compensated::CompensatedSum;
use crate::engine::account::{Account, Effort, Totals};
use crate::engine::interface::{Engine, EventEngine, Stretch};
use crate::engine::plan::{Plan, Turning};
#[cfg(feature = "files")]
use crate::engine::snapshot::{Misfit, Snapshot, State};
use crate::engine::{EngineError, Execution, LONGEST_RUN, Listener, Order, PartTotals};
use crate::mat3::Mat3;
use crate::motion::flight::Wrap;
use crate::motion::rotation::turned;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::scene::{EngineKind, Scene};
use crate::vec3::Vec3;
use crate::workers::Workers;

/// Windows in a period before any collisions were counted: in dense matter each body has
/// hundreds in a period.
const FIRST_WINDOWS: i32 = 512;

/// The event-driven engine of a precision.
#[derive(Debug)]
pub(in crate::engine) struct Driver<T: Real> {
    setting: Setting<T>,
    store: Store<T>,
    clock: Clock<T>,
    team: Team<T>,
}

impl<T: Real> Driver<T> {
    /// A scene at its start.
    pub fn new(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        let plan = Plan::new(&scene, EngineKind::EventDriven, execution, 1);
        let removes = scene.removes.contains(&true);
        let (mut setting, cells) = Setting::new(scene, plan, execution);
        if removes {
            // A window is not cut where a body is removed.
            setting.plan.order = Order::Strict;
        }
        let pool = match setting.plan.order {
            Order::Windows => Workers::new(setting.plan.threads)?,
            _ => Workers::default(),
        };
        let team = Team::new(pool);
        let mut store = Store::new(&setting, cells);
        store.logs = team.logs();
        setting.leave_to_region();
        let mut driver = Self { setting, store, clock: Clock::new(), team };
        driver.begin_period(T::ZERO);
        Ok(driver)
    }

    fn begin_period(&mut self, end: T) {
        let Self { setting, store, clock, team } = self;
        let was_strict = clock.window.is_none();
        if setting.plan.order == Order::Windows && was_strict {
            clock.window = Some(T::ZERO);
        }
        begin_period(setting, store, team, clock, end);
        if let Some(window) = clock.window {
            let first = clock.period * T::ratio(1, FIRST_WINDOWS);
            self.begin_windows(if was_strict { first } else { window });
        }
    }

    /// Goes on in windows of a length, or of the longest that is possible.
    fn begin_windows(&mut self, length: T) {
        let Self { setting, store, clock, .. } = self;
        clock.longest_window = longest_window(setting, store, clock);
        clock.window = Some(length.lesser(clock.longest_window));
    }

    /// Goes on in strict order of time, or in windows.
    fn choose_order(&mut self, is_strict: bool) {
        if is_strict == self.clock.window.is_none() || self.setting.plan.order == Order::Strict {
            return;
        }
        let Self { setting, store, clock, team } = self;
        clock.window = (!is_strict).then_some(clock.period * T::ratio(1, FIRST_WINDOWS));
        let now = clock.worked_off;
        place(setting, store, team, clock, now);
    }

    /// Takes turns in order of time up to `limit`, which is included, or up to the given
    /// number of collisions of the run, or until a body is too fast for the period, or has
    /// touched what removes it; then those that do so at the same time come too.
    fn advance_strictly(
        &mut self,
        limit: T,
        last: u64,
        on_event: &mut Listener<'_, T>,
    ) -> Result<(), EngineError> {
        let Self { setting, store, clock, team } = self;
        let mut region = store.whole(team.first(), None);
        while region.worker.account.collisions.total() < last && !region.worker.is_too_fast {
            let Some(turn) = next_turn(&mut region) else { break };
            if turn.time > limit {
                break;
            }
            if let Err(events) = clock.check_progress(turn, region.records.len()) {
                clock.time = clock.since_start(turn.time);
                let body = region.index[turn.slot as usize];
                return Err(EngineError::Stalled { time: clock.time, events, body });
            }
            region.worker.calendar.take();
            clock.count();
            if take_turn(setting, &mut region, clock, turn, on_event).unwrap_or(false) {
                clock.last_collision = turn.time;
                if region.worker.has_removed && !is_removed_next(setting, &mut region, turn.time) {
                    break;
                }
            }
        }
        let is_past = region.worker.account.collisions.total() >= last;
        let is_stopped = is_past || region.worker.has_removed;
        clock.worked_off = if is_stopped { clock.last_collision } else { limit };
        Ok(())
    }

    /// As [`advance_strictly`](Driver::advance_strictly), in windows, and up to the limit
    /// if it is included, otherwise to before it. Comes back early where windows are of
    /// no use.
    fn advance_in_windows(
        &mut self,
        limit: (T, bool),
        (last, is_exact): (u64, bool),
        on_event: &mut Listener<'_, T>,
    ) -> End {
        let Self { setting, store, clock, team } = self;
        let mut shift = Shift { setting, store, team, clock };
        let end = loop {
            let end = shift.next_window(limit, if is_exact { last } else { u64::MAX }, on_event);
            let is_past = shift.team.first().account.collisions.total() >= last;
            if end != End::Whole || is_past || shift.clock.worked_off >= limit.0 {
                break end;
            }
        };
        // All flights of the period started with it, or with a collision.
        let starts = self.store.records.iter().map(|record| record.since());
        self.clock.last_collision = starts.fold(T::ZERO, T::greater);
        end
    }

    fn account(&self) -> &Account {
        &self.team.workers[0].account
    }
}

impl<T: Real> EventEngine<T> for Driver<T> {
    fn advance_to(
        &mut self,
        time: f64,
        Stretch { collisions, is_exact }: Stretch,
        mut on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        if time > LONGEST_RUN {
            return Err(EngineError::NoDuration(time));
        }
        let last = self.account().collisions.total().saturating_add(collisions);
        // A window of which a few collisions are wanted would be thrown away.
        self.choose_order(is_exact && collisions < self.store.records.len() as u64);
        loop {
            let ahead = self.clock.in_period(time);
            let ends_here = ahead < self.clock.period;
            let limit = if ends_here { ahead } else { self.clock.period };
            if self.clock.window.is_some() && !self.team.first().is_too_fast {
                let end =
                    self.advance_in_windows((limit, ends_here), (last, is_exact), &mut on_event);
                let is_past = self.account().collisions.total() >= last;
                if end == End::Undone {
                    continue;
                } else if !is_exact && is_past && self.clock.worked_off < limit {
                    let now = self.clock.not_before(self.clock.worked_off);
                    self.clock.time = self.clock.time.max(now).min(time);
                    return Ok(false);
                }
            } else {
                self.advance_strictly(limit, last, &mut on_event)?;
            }
            let is_stopped = is_exact || self.clock.window.is_none();
            let has_removed = core::mem::take(&mut self.team.first().has_removed);
            if has_removed || is_stopped && self.account().collisions.total() == last {
                let now = self.clock.not_before(self.clock.last_collision);
                // Not beyond the end, up to which it may have been rounded.
                self.clock.time = self.clock.time.max(now).min(time);
                return Ok(false);
            }
            if self.team.first().is_too_fast {
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
        let ends = self.account().collisions.ends();
        let now = self.clock.now();
        let records = self.store.slots().map(|slot| &self.store.records[slot]);
        let under_way: CompensatedSum = records
            .map(|record| {
                let flight = record.flight();
                (flight.velocity.length() * (now - flight.since)).to_f64()
            })
            .collect();
        (ends > 0).then(|| (self.account().path() + under_way.value()) / ends as f64)
    }

    fn effort(&self) -> Effort {
        self.account().effort
    }

    fn take_out(&mut self, index: u32) -> Option<Bodies<T>> {
        let Self { setting, store, team, .. } = self;
        let slot = store.index.iter().position(|&own| own == index)?;
        if store.is_out(slot) {
            return None;
        }
        let flight = store.records[slot].flight();
        let motion = [flight.position, flight.velocity, store.spin_of(setting, slot)];
        let taken = setting.bodies.one_moving(index as usize, motion);
        store.whole(team.first(), None).take_out(setting, slot);
        Some(taken)
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
        self.account().totals()
    }

    fn parts(&self) -> Vec<PartTotals> {
        self.setting.counted.totals(self.account().parts())
    }

    fn bodies(&self) -> Bodies<T> {
        let Self { setting, store, .. } = self;
        let len = setting.plan.bodies;
        let now = self.clock.now();
        let columns = || array::from_fn(|_| Column::new(len, T::ZERO));
        let mut bodies = setting.bodies.clone();
        (bodies.position, bodies.velocity, bodies.spin) = (columns(), columns(), columns());
        if setting.plan.turning != Turning::Never {
            let rows = Mat3::<T>::IDENTITY.rows();
            bodies
                .orientation
                .get_or_insert_with(|| Box::new(rows.each(|element| Column::new(len, element))));
        }
        for slot in store.slots() {
            let at = store.index[slot] as usize;
            let (position, velocity) = setting.state_of(&store.records[slot].flight(), now);
            let position = setting.periodic.map_or(position, |space| space.wrap(position));
            let spin = store.spin_of(setting, slot);
            for k in 0..3 {
                bodies.position[k][at] = position.to_array()[k];
                bodies.velocity[k][at] = velocity.to_array()[k];
                bodies.spin[k][at] = spin.to_array()[k];
            }
            let orientation = match store.turned.get(slot) {
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
        if store.slots().count() < len {
            let mut left: Vec<_> = store.slots().map(|slot| store.index[slot] as usize).collect();
            left.sort_unstable();
            bodies = bodies.only(&left);
        }
        bodies.left_by_world()
    }

    #[cfg(feature = "files")]
    fn save(&self) -> Snapshot {
        let is_too_fast = self.team.workers[0].is_too_fast;
        let state = snapshot::save(&self.store, &self.clock, is_too_fast);
        Snapshot::of(self.account(), State::EventDriven(state))
    }

    #[cfg(feature = "files")]
    fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        let State::EventDriven(state) = &saved.state else { return Err(Misfit("engine")) };
        let out = saved.flow.as_ref().map_or(&[][..], |flow| flow.out());
        self.clock = snapshot::restore(&self.setting, &mut self.store, state, out)?;
        if self.setting.plan.order == Order::Windows {
            self.begin_windows(self.clock.period * T::ratio(1, FIRST_WINDOWS));
        }
        let Self { setting, store, clock, team } = self;
        // The bodies have met all that they meet before this time, and nothing since.
        place(setting, store, team, clock, clock.last_collision);
        let worker = team.first();
        worker.is_too_fast = state.is_too_fast;
        worker.account.clone_from(&saved.account);
        Ok(())
    }

    fn bytes(&self) -> usize {
        let workers = self.team.workers.iter().map(Worker::bytes).sum::<usize>();
        self.setting.bytes() + self.store.bytes() + workers
    }
}
