//! Period: a stretch of time with an origin of its own.
//!
//! Times are counted from the period's start, so that a long run has times as
//! exact as a short one. Where a period begins, every flight starts again, bodies
//! are sorted by cell and all that is ahead is looked for again.

use super::agenda::Agenda;
use super::clock::Clock;
use super::coarse::Scales;
use super::crossing::plan_crossing;
use super::flight::{Flight, Record};
use super::log::Mark;
use super::outcome::ended;
use super::region::Region;
use super::search::{find, search};
use super::setting::Setting;
use super::store::Store;
use super::territories::{Cuts, Team};
use super::window::Window;
use crate::motion::rotation::turned;
use crate::numbers::array::Each;
use crate::real::Real;

/// How far bodies fly in a period, in mean distances, at the mean speed.
const FLIGHT: f64 = 8.0;

/// How much faster than the mean the fastest body may be before it is the one
/// that a period is measured by.
const FAST: f64 = 8.0;

/// Turns for which a span of the calendar is made.
const TOGETHER: f64 = 24.0;

/// Bodies that a cell has room for where a window keeps those that have left it.
const ROOM_IN_WINDOWS: usize = 8;

/// Turns for each body in the first period, before any were counted.
const TURNS: f64 = 64.0;

/// Binary exponents of the longest period, for bodies that meet nothing or stand still:
/// of a precision with the range of a double, and of a single.
const LONGEST: [i32; 2] = [900, 100];

/// Ends the present period at a time of it, and begins the next one.
pub(super) fn begin_period<T: Real>(
    setting: &Setting<T>,
    store: &mut Store<T>,
    team: &mut Team<T>,
    clock: &mut Clock<T>,
    end: T,
) {
    store.forget_out();
    let worker = team.first();
    let mut region = store.whole(worker, None);
    for slot in 0..region.records.len() {
        let flight = region.records[slot].flight();
        let next = if follows_hollow(setting, &region, slot) {
            Flight { since: flight.since - end, ..flight }
        } else {
            region.worker.account.flight(flight.velocity.length() * (end - flight.since));
            Flight { since: T::ZERO, ..ended(setting, &flight, end).0 }
        };
        region.records[slot] = Record::new(next);
        turn(&mut region, slot, end, T::ZERO);
        let Mark { last, before, .. } = region.marks[slot];
        region.marks[slot] = Mark { stamp: 0, last, before, follows: 0 };
    }
    worker.stamp = 0;
    worker.is_too_fast = false;
    let longer = clock.idle_exponent();
    clock.end_period(end);
    (clock.period, clock.too_fast) = chosen_period(setting, store, longer);
    sort(setting, store);
    place(setting, store, team, clock, T::ZERO);
}

/// Puts the bodies into cells where they are at a time of the period, all flights being
/// those of that time, and finds all that is ahead.
pub(super) fn place<T: Real>(
    setting: &Setting<T>,
    store: &mut Store<T>,
    team: &mut Team<T>,
    clock: &mut Clock<T>,
    now: T,
) {
    let grid = store.cells.finest();
    let cell_of = |record: &Record<T>| {
        let (position, _) = setting.state_of(&record.flight(), now);
        grid.cell_of(position)
    };
    store.agendas.clear();
    store.agendas.extend(store.records.iter().map(|record| Agenda::new(cell_of(record))));
    store.coarse.clear();
    let scales = scales(setting, store, clock);
    store.screening.begin::<T>(&scales);
    if store.screening.is_useful {
        let coarse = |record: &Record<T>| store.screening.record(&record.flight());
        store.coarse.extend(store.records.iter().map(coarse));
    }
    if setting.plan.has_pairs {
        // In a window bodies stay in the cells that they have left; a worker leaves a body
        // that finds no room to another phase.
        if clock.window.is_some() {
            store.cells.only().have_room(ROOM_IN_WINDOWS);
        }
        loop {
            store.cells.clear();
            let mut region = store.whole(team.first(), None);
            for slot in 0..region.agendas.len() {
                let level = region.level_of(slot);
                let cell = region.agendas[slot].cell;
                region.cells.insert(level, cell, slot as u32);
            }
            region.make_room();
            if !store.cells.grow() {
                break;
            }
        }
    }
    let len = store.records.len();
    let worker = team.first();
    let Some(window) = clock.window.map(|_| Window::closed(worker.stamp)) else {
        let turns = clock.turns_per_time();
        let turns = turns.unwrap_or_else(|| TURNS * len as f64 / clock.period.to_f64());
        worker.calendar.begin(clock.period, turns, TOGETHER);
        store.next.clear();
        let mut region = store.whole(worker, None);
        for slot in 0..len as u32 {
            look_ahead(setting, &mut region, slot, now, clock.period);
        }
        return;
    };
    let period = clock.period;
    let unknown = T::from_f64(f64::INFINITY);
    store.next.clear();
    store.next.resize(len, unknown);
    // Later in a period bodies are no longer sorted.
    if now == T::ZERO || team.cuts.are_none() {
        let cells = store.cells.only().numbers();
        let (grid, agendas) = (store.cells.finest(), &store.agendas);
        let cell_of = |slot: usize| grid.number_of(agendas[slot].cell);
        team.cuts = Cuts::new(2 * team.workers.len(), len, cells, cell_of);
    }
    let is_left = |store: &Store<T>| store.next.contains(&unknown);
    team.share(store, window, 2, is_left, |region, slots| {
        for slot in slots {
            if region.next[slot] == unknown {
                look_ahead(setting, region, slot as u32, now, period);
            }
        }
    });
    team.merge_accounts();
}

/// Finds what is ahead of the body in a slot, unless it has to wait.
fn look_ahead<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    now: T,
    period: T,
) {
    let cell = region.agendas[slot as usize].cell;
    if let Ok(nearby) = find(setting, region, 0, slot, cell) {
        plan_crossing(setting, region, slot, now, period);
        search(setting, region, slot, nearby, now, period);
        region.enter(slot);
    }
}

/// Brings the orientation of the body in a slot up to a time, which is `since` in the
/// next period.
#[inline(always)]
pub(super) fn turn<T: Real>(region: &mut Region<'_, T>, slot: usize, time: T, since: T) {
    if let Some((orientation, turned_at)) = region.turned.get_mut(slot) {
        *orientation = turned(*orientation, region.spins[slot], time - *turned_at);
        *turned_at = since;
    }
}

/// Whether the body in a slot has just left a feature that is curved towards it. In
/// flat flights along such a one its height is less than the rounding of its place, so
/// the flight goes on from the contact. Screening in a coarser precision counts on
/// flights that start within the period; where there is it, digits are enough.
fn follows_hollow<T: Real>(setting: &Setting<T>, region: &Region<'_, T>, slot: usize) -> bool {
    let is_hollow = |feature: u32| {
        (feature as usize) < setting.features.len() && setting.features.at(feature).is_hollow()
    };
    !setting.plan.has_screening
        && setting.periodic.is_none()
        && region.records[slot].since() > T::ZERO
        && region.marks[slot].last.decoded().is_err_and(is_hollow)
}

/// The power of two nearest below the time that bodies take for a few mean
/// distances: multiples of it are added up without rounding. And the square of
/// the speed from which that is too long.
fn chosen_period<T: Real>(setting: &Setting<T>, store: &Store<T>, longer: u32) -> (T, T) {
    if !setting.plan.has_pairs && setting.features.is_empty() {
        return (T::from_f64(longest::<T>()), T::from_f64(longest::<T>()));
    }
    let len = store.records.len();
    let mut squares = vec![0.0; setting.plan.bodies];
    for (record, &index) in store.records.iter().zip(&store.index) {
        squares[index as usize] = record.flight().velocity.length_squared().to_f64();
    }
    // In the scene's order: the sum must not depend on slots.
    let mean = squares.iter().sum::<f64>() / len as f64;
    let most = squares.iter().fold(0.0, |most: f64, &square| most.max(square));
    let spacing = setting.spacing.to_f64();
    let fallen = setting.gravity.length().to_f64() * spacing;
    let speed = mean.max(most / (FAST * FAST)).max(fallen).sqrt();
    let longer = 2.0_f64.powi(longer.min(1 << 8) as i32);
    let flight = ((FLIGHT * spacing / speed).max(1e-25) * longer).min(longest::<T>());
    let limit = 2.0 * FAST * speed;
    (T::from_f64(power_of_two_below(flight)), T::from_f64((limit * limit).max(1e-30)))
}

fn longest<T: Real>() -> f64 {
    let [double, single] = LONGEST.each(|exponent| 2.0_f64.powi(exponent));
    if T::from_f64(double).is_finite() { double } else { single }
}

/// What the errors of the coarse precision are measured by.
fn scales<T: Real>(setting: &Setting<T>, store: &Store<T>, clock: &Clock<T>) -> Scales {
    let greatest = |most: f64, value: T| most.max(value.to_f64().abs());
    let extent = store.records.iter().fold(0.0, |most, record| {
        record.flight().position.to_array().into_iter().fold(most, greatest)
    });
    let least = store
        .records
        .iter()
        .fold(f64::INFINITY, |least: f64, record| least.min(record.flight().radius.to_f64()));
    let fallen = setting.gravity.length().to_f64() * clock.period.to_f64();
    Scales {
        extent,
        neighbourhood: store.cells.coarsest().neighbourhood(),
        reach: 2.0 * least,
        speed: clock.too_fast.to_f64().sqrt() + fallen,
        period: clock.period.to_f64(),
    }
}

/// Sorts the bodies by cell: neighbours in space become neighbours in memory.
fn sort<T: Real>(setting: &Setting<T>, store: &mut Store<T>) {
    let cells = store.cells.finest();
    let mut order: Vec<(u32, u32, u32)> = Vec::with_capacity(store.records.len());
    for (slot, record) in store.records.iter().enumerate() {
        // A flight may have started before the period.
        let (position, _) = setting.state_of(&record.flight(), T::ZERO);
        let cell = cells.number_of(cells.cell_of(position));
        order.push((cell, store.index[slot], slot as u32));
    }
    order.sort_unstable();
    store.records = reordered(&store.records, &order);
    store.index = order.iter().map(|slot| slot.1).collect();
    if !store.turned.is_empty() {
        store.spins = reordered(&store.spins, &order);
        store.turned = reordered(&store.turned, &order);
    }
    store.marks = reordered(&store.marks, &order);
}

/// What each slot of an order, its third number, holds.
fn reordered<V: Copy>(values: &[V], order: &[(u32, u32, u32)]) -> Vec<V> {
    order.iter().map(|slot| values[slot.2 as usize]).collect()
}

/// The greatest power of two that is not above a positive number. By its bits: a
/// platform's logarithm may round across one.
fn power_of_two_below(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & f64::INFINITY.to_bits())
}
