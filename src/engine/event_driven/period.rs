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
use super::region::Region;
use super::search::search;
use super::setting::Setting;
use super::turns::enter;
use crate::engine::account::Account;
use crate::motion::flight::Wrap;
use crate::motion::rotation::turned;
use crate::real::Real;
use crate::space::Space;
use crate::space::cells::Cells;

/// How far bodies fly in a period, in mean distances, at the mean speed.
const FLIGHT: f64 = 8.0;

/// How much faster than the mean the fastest body may be before it is the one
/// that a period is measured by.
const FAST: f64 = 8.0;

/// Turns for which a span of the calendar is made.
const TOGETHER: f64 = 24.0;

/// Turns for each body in the first period, before any were counted.
const TURNS: f64 = 64.0;

/// Binary exponents of the longest period, for bodies that meet nothing or stand still:
/// of a precision with the range of a double, and of a single.
const LONGEST: [i32; 2] = [900, 100];

/// Ends the present period at a time of it, and begins the next one.
pub(super) fn begin_period<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &mut Clock<T>,
    account: &mut Account,
    end: T,
) {
    for slot in 0..region.records.len() {
        if follows_hollow(setting, region, slot) {
            let flight = region.records[slot].flight();
            let since = flight.since - end;
            region.records[slot] = Record::new(Flight { since, ..flight });
            turn(region, slot, end, T::ZERO);
        } else {
            end_flight(setting, region, account, slot, end, T::ZERO);
        }
    }
    let longer = clock.idle_exponent();
    let counted = clock.end_period(end);
    region.is_too_fast = false;
    (clock.period, clock.too_fast) = chosen_period(setting, region, longer);
    sort(setting, region);
    look_ahead_of_all(setting, region, clock, account, counted, T::ZERO);
}

/// Finds all that is ahead of the bodies at a time of the present period, where they
/// have met all that they meet before it. `counted` are turns in a time, if any were
/// counted.
pub(super) fn look_ahead_of_all<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock<T>,
    account: &mut Account,
    counted: Option<f64>,
    now: T,
) {
    let turns =
        counted.unwrap_or_else(|| TURNS * region.records.len() as f64 / clock.period.to_f64());
    region.calendar.begin(clock.period, turns, TOGETHER);
    fill_cells(setting, region, now);
    let scales = scales(setting, region, clock);
    region.coarse.begin(&region.records, &scales);
    for slot in 0..region.records.len() as u32 {
        plan_crossing(setting, region, slot, now, clock.period);
        search(setting, region, &mut account.effort, slot, now, clock.period);
        enter(region, slot);
    }
}

/// Ends the flight of the body in a slot at a time. The next one starts at
/// `since`, which is that time or, in the next period, its start.
#[inline(always)]
pub(super) fn end_flight<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    account: &mut Account,
    slot: usize,
    time: T,
    since: T,
) {
    let (position, velocity) = region.state_of(setting, slot, time);
    let before = region.records[slot].flight();
    account.flight(before.velocity.length() * (time - before.since));
    let mut flight = Flight { position, velocity, since, radius: before.radius };
    if let Some(space) = setting.periodic {
        flight.position = space.wrap(position);
        let turns = space.turns(position - flight.position);
        let cell = &mut region.agendas[slot].cell;
        *cell = region.cells.finest().turned_back(*cell, turns);
    }
    region.records[slot] = Record::new(flight);
    turn(region, slot, time, since);
}

/// Brings the orientation of the body in a slot up to a time, which is `since` in the
/// next period.
#[inline(always)]
fn turn<T: Real>(region: &mut Region<T>, slot: usize, time: T, since: T) {
    if let Some((orientation, turned_at)) = region.turned.get_mut(slot) {
        *orientation = turned(*orientation, region.spins[slot], time - *turned_at);
        *turned_at = since;
    }
}

/// Whether the body in a slot has just left a feature that is curved towards it. In
/// flat flights along such a one its height is less than the rounding of its place, so
/// the flight goes on from the contact. Screening in a coarser precision counts on
/// flights that start within the period; where there is it, digits are enough.
fn follows_hollow<T: Real>(setting: &Setting<T>, region: &Region<T>, slot: usize) -> bool {
    let is_hollow = |feature: u32| {
        setting.features.get(feature as usize).is_some_and(|feature| feature.is_hollow())
    };
    !setting.plan.has_screening
        && setting.periodic.is_none()
        && region.records[slot].flight().since > T::ZERO
        && region.marks[slot].last.decoded().is_err_and(is_hollow)
}

/// The power of two nearest below the time that bodies take for a few mean
/// distances: multiples of it are added up without rounding. And the square of
/// the speed from which that is too long.
fn chosen_period<T: Real>(setting: &Setting<T>, region: &Region<T>, longer: u32) -> (T, T) {
    if !setting.plan.has_pairs && setting.features.is_empty() {
        return (T::from_f64(longest::<T>()), T::from_f64(longest::<T>()));
    }
    let len = region.records.len();
    let mut squares = vec![0.0; len];
    for (record, &index) in region.records.iter().zip(&region.index) {
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
    let [double, single] = LONGEST.map(|exponent| 2.0_f64.powi(exponent));
    if T::from_f64(double).is_finite() { double } else { single }
}

/// What the errors of the coarse precision are measured by.
fn scales<T: Real>(setting: &Setting<T>, region: &Region<T>, clock: &Clock<T>) -> Scales {
    let greatest = |most: f64, value: T| most.max(value.to_f64().abs());
    let extent = region.records.iter().fold(0.0, |most, record| {
        record.flight().position.to_array().into_iter().fold(most, greatest)
    });
    let least = region
        .records
        .iter()
        .fold(f64::INFINITY, |least: f64, record| least.min(record.flight().radius.to_f64()));
    let fallen = setting.gravity.length().to_f64() * clock.period.to_f64();
    Scales {
        extent,
        neighbourhood: region.cells.coarsest().neighbourhood(),
        reach: 2.0 * least,
        speed: clock.too_fast.to_f64().sqrt() + fallen,
        period: clock.period.to_f64(),
    }
}

/// Sorts the bodies by cell: neighbours in space become neighbours in memory.
fn sort<T: Real>(setting: &Setting<T>, region: &mut Region<T>) {
    let cells = region.cells.finest();
    let mut order: Vec<(u32, u32, u32)> = Vec::with_capacity(region.records.len());
    for (slot, record) in region.records.iter().enumerate() {
        let cell = cell_of(setting, cells, record, T::ZERO);
        order.push((cells.number_of(cell), region.index[slot], slot as u32));
    }
    order.sort_unstable();
    region.records = reordered(&region.records, &order);
    region.index = order.iter().map(|slot| slot.1).collect();
    if !region.turned.is_empty() {
        region.spins = reordered(&region.spins, &order);
        region.turned = reordered(&region.turned, &order);
    }
    region.marks = reordered(&region.marks, &order);
}

/// The cell that a body is in at a time. A flight may have started before the period.
fn cell_of<T: Real>(
    setting: &Setting<T>,
    cells: &Cells<T>,
    record: &Record<T>,
    time: T,
) -> [i32; 3] {
    cells.cell_of(setting.state_of(&record.flight(), time).0)
}

/// Puts the bodies into the cells that they are in at a time, with nothing ahead of them.
fn fill_cells<T: Real>(setting: &Setting<T>, region: &mut Region<T>, time: T) {
    region.cells.clear();
    let cells = region.cells.finest();
    let agenda = |record: &Record<T>| Agenda::new(cell_of(setting, cells, record, time));
    region.agendas = region.records.iter().map(agenda).collect();
    if setting.plan.has_pairs {
        for (slot, agenda) in region.agendas.iter().enumerate() {
            let level = region.level_of(slot);
            region.cells.insert(level, agenda.cell, slot as u32);
        }
        region.make_room();
    }
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
