//! Order: a stretch of a period, window by window.

use core::cmp::Ordering;

use super::clock::Clock;
#[cfg(debug_assertions)]
use super::history::is_closed;
use super::history::{first_too_fast, history, tell, turn_all, undo_after};
use super::key::Key;
use super::log::{Log, MOST_ENTRIES};
use super::period::place;
use super::region::Region;
use super::setting::Setting;
use super::store::Store;
use super::territories::Team;
use super::window::{Window, work_off};
use crate::engine::Listener;
use crate::engine::account::Account;
use crate::real::Real;

/// Bodies that are worked off together: few enough for a processor's first cache.
const BLOCK: usize = 256;

/// Collisions of a body in a window, on average and in the block that has the most.
const WANTED: f64 = 0.5;
const WANTED_IN_BLOCK: f64 = 2.0;

/// Turns of a window, and for each body, from which on it is worked off in strict order:
/// time stands still, or many collisions have one time.
const MOST_TURNS: u64 = 1 << 16;
const MOST_TURNS_EACH: u64 = 64;

/// Phases after which one worker does what is left.
const MOST_PHASES: usize = 4;

/// Bodies up to which every pair of flights is tried again in a debug build.
#[cfg(debug_assertions)]
const CHECKED: usize = 100;

/// How a window ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// All of it is done.
    Whole,
    /// It was cut at a collision: the last one that is wanted, or that of a body that is
    /// too fast for the period.
    Cut,
    /// It is not done at all: it has to be worked off in strict order.
    Undone,
}

/// What works a window off.
pub(super) struct Shift<'a, T: Real> {
    pub setting: &'a Setting<T>,
    pub store: &'a mut Store<T>,
    pub team: &'a mut Team<T>,
    pub clock: &'a mut Clock<T>,
}

impl<T: Real> Shift<'_, T> {
    /// Works off the next window, which ends at `limit` at the latest, up to the given
    /// number of collisions of the run.
    pub fn next_window(
        &mut self,
        (limit, includes_limit): (T, bool),
        last: u64,
        on_event: &mut Listener<'_, T>,
    ) -> End {
        let start = self.clock.worked_off;
        let length = self.clock.window.unwrap_or(limit);
        let is_last = start + length >= limit;
        let end = if is_last { limit } else { start + length };
        let base = self.team.first().stamp;
        let includes_end = is_last && includes_limit;
        let window = Window { start, end, includes_end, base, is_open: true };
        let before = self.team.first().account.collisions.total();
        let busiest = self.work_off_all(window);
        let Some(busiest) = busiest else {
            self.finish(window, |setting, region| undo_after(setting, region, None));
            self.clock.window = None;
            self.place(start);
            return End::Undone;
        };
        #[cfg(debug_assertions)]
        self.whole(window, |setting, region, _| {
            let is_small = region.marks.len() <= CHECKED;
            debug_assert!(!is_small || is_closed(setting, region), "a contact was missed");
        });
        let made = self.team.first().account.collisions.total() - before;
        let cut = self.cut(window, last, on_event);
        self.finish(window, |setting, region| {
            if let Some(cut) = cut {
                undo_after(setting, region, Some(cut));
            }
            turn_all(region);
        });
        if let Some(cut) = cut {
            self.clock.worked_off = cut.time;
            self.place(cut.time);
            return End::Cut;
        }
        self.clock.worked_off = end;
        if !is_last {
            self.clock.window = Some(self.adapted(length, made, busiest));
        }
        End::Whole
    }

    /// The length of the next window, from the collisions of this one.
    fn adapted(&self, length: T, made: u64, busiest: f64) -> T {
        let bodies = self.store.records.len() as f64;
        let each = 2.0 * made as f64 / bodies;
        let most = (MOST_ENTRIES / 4) as f64 / bodies;
        let wanted = (WANTED.min(most) / each).min(WANTED_IN_BLOCK / busiest);
        // No collisions: no number.
        let factor = if wanted.is_finite() { wanted.clamp(0.25, 2.0) } else { 2.0 };
        (length * T::from_f64(factor)).lesser(self.clock.longest_window)
    }

    /// Works off all bodies. Returns how many collisions each body of the busiest block
    /// had; `None` if there is no end of turns.
    fn work_off_all(&mut self, window: Window<T>) -> Option<f64> {
        let most = MOST_TURNS + MOST_TURNS_EACH * self.store.records.len() as u64;
        let (setting, clock) = (self.setting, &*self.clock);
        let count = self.team.workers.len();
        for (k, worker) in self.team.workers.iter_mut().enumerate() {
            worker.turns = 0;
            worker.heap.clear();
            worker.busiest = 0.0;
            worker.is_stuck = false;
            (worker.stamp, worker.stamp_step) = (window.base + k as u32, count as u32);
        }
        let is_left = |store: &Store<T>| store.next.iter().any(|&time| window.is_due(time));
        self.team.share(self.store, window, MOST_PHASES, is_left, |region, slots| {
            work_off_blocks(setting, region, clock, slots, most);
        });
        let stamp = self.team.workers.iter().map(|worker| worker.stamp).max();
        self.team.merge_accounts();
        let (first, others) = self.team.workers.split_first_mut()?;
        first.stamp = stamp.unwrap_or(first.stamp);
        for other in others {
            first.turns += other.turns;
            first.busiest = first.busiest.max(other.busiest);
            first.is_stuck |= other.is_stuck;
            first.is_too_fast |= other.is_too_fast;
            other.is_too_fast = false;
        }
        self.clock.turns += first.turns;
        (!first.is_stuck).then_some(first.busiest)
    }

    /// The collision at which the window ends, if it is cut; reports those up to it.
    fn cut(
        &mut self,
        window: Window<T>,
        last: u64,
        on_event: &mut Listener<'_, T>,
    ) -> Option<Key<T>> {
        let total = self.team.first().account.collisions.total();
        let too_many = total.saturating_sub(last) as usize;
        let is_too_fast = core::mem::take(&mut self.team.first().is_too_fast);
        let reaches_last = total >= last;
        if !reaches_last && !is_too_fast && on_event.is_none() {
            return None;
        }
        let mut cut: Option<Key<T>> = None;
        let mut has_too_fast = false;
        self.whole(window, |setting, region, clock| {
            let mut history = history(region);
            let kept = history.len().saturating_sub(too_many);
            if reaches_last {
                cut = history.get(kept.wrapping_sub(1)).map(|happened| happened.key);
            }
            if let Some(key) = first_too_fast(region, clock).filter(|_| is_too_fast)
                && cut.is_none_or(|cut| key <= cut)
            {
                (cut, has_too_fast) = (Some(key), true);
            }
            let is_kept = |key: &Key<T>| {
                cut.is_none_or(|cut| key.partial_cmp(&cut) != Some(Ordering::Greater))
            };
            history.retain(|happened| is_kept(&happened.key));
            tell(setting, region, clock, &history, on_event);
        });
        self.team.first().is_too_fast = has_too_fast;
        cut
    }

    /// Ends the window: clears what is special to it.
    fn finish(&mut self, window: Window<T>, end: impl FnOnce(&Setting<T>, &mut Region<'_, T>)) {
        self.whole(window, |setting, region, _| end(setting, region));
        let is_left = |_: &Store<T>| true;
        self.team.share(self.store, window, 1, is_left, |region, _| region.leave_ghosts());
        let [first, others @ ..] = &mut self.team.workers[..] else { return };
        others.iter_mut().for_each(|other| first.ghosts.append(&mut other.ghosts));
        self.whole(window, |_, region, _| region.leave_ghosts());
        self.store.logs.iter_mut().for_each(Log::clear);
    }

    /// Does something with all of it as one region.
    fn whole(
        &mut self,
        window: Window<T>,
        work: impl FnOnce(&Setting<T>, &mut Region<'_, T>, &Clock<T>),
    ) {
        let (setting, clock) = (self.setting, &*self.clock);
        self.team.whole(self.store, Some(window), |region| work(setting, region, clock));
    }

    /// Finds all that is ahead at a time again.
    fn place(&mut self, now: T) {
        place(self.setting, self.store, self.team, self.clock, now);
    }
}

/// The longest that a window may be. Neighbours whose flights start later are followed
/// back to now: in a periodic box not so far that another image is nearer.
pub(super) fn longest_window<T: Real>(
    setting: &Setting<T>,
    store: &Store<T>,
    clock: &Clock<T>,
) -> T {
    if setting.periodic.is_none() {
        return clock.period;
    }
    let speed = clock.too_fast.sqrt() + setting.gravity.length() * clock.period;
    let grid = store.cells.finest();
    let ways = grid.sides().into_iter().zip(grid.counts());
    let ways = ways.map(|([side, _], count)| side * (f64::from(count) / 2.0 - 2.0) / 2.0);
    let way = ways.fold(f64::INFINITY, f64::min);
    (T::from_f64(way) / speed).lesser(clock.period)
}

/// Works off slots block by block.
fn work_off_blocks<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    slots: core::ops::Range<usize>,
    most: u64,
) {
    let total = |account: &Account| account.collisions.total();
    for start in slots.clone().step_by(BLOCK) {
        let end = (start + BLOCK).min(slots.end);
        let before = total(&region.worker.account);
        let is_done = work_off(setting, region, clock, start as u32..end as u32, most);
        let made = total(&region.worker.account).wrapping_sub(before) as i64;
        let each = 2.0 * made as f64 / (end - start) as f64;
        region.worker.busiest = region.worker.busiest.max(each);
        if !is_done {
            region.worker.is_stuck = true;
            return;
        }
    }
}
