//! Window: a stretch of time in which bodies are worked off block by block.
//!
//! In strict order of time the bodies of successive turns lie anywhere in memory. In a
//! window those of one block of neighbours come first, then those of the next. Where a
//! body meets another that is ahead of it, what the other one did after their contact is
//! taken back ([`undo`](super::undo)). When nothing is left to do, the history of the
//! window is the one of strict order, bit by bit: no two flights of it touch within
//! both, and each ends with a collision at the contact time of two of them, which is
//! true of one history only.

use super::agenda::Next;
use super::calendar::Turn;
use super::clock::Clock;
use super::collide::{collide_pair, collide_with_feature};
use super::crossing::cross;
use super::flight::Flight;
use super::key::Key;
use super::region::Region;
use super::search::{Blocked, Nearby, find, search};
use super::setting::Setting;
use super::undo::{can_look_again, look_again, plan_undo, undo};
use crate::numbers::array::Each;
use crate::real::Real;

/// A stretch of a period.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window<T> {
    pub start: T,
    pub end: T,
    /// Whether what happens at the end belongs to it.
    pub includes_end: bool,
    /// The last stamp given before it.
    pub base: u32,
    /// Whether it is being worked off.
    pub is_open: bool,
}

impl<T: Real> Window<T> {
    /// Between two windows.
    pub fn closed(base: u32) -> Self {
        Self { start: T::ZERO, end: T::ZERO, includes_end: false, base, is_open: false }
    }

    /// Whether a turn at a time is to be taken in it.
    #[inline(always)]
    pub fn is_due(&self, time: T) -> bool {
        self.is_open && (time < self.end || self.includes_end && time == self.end)
    }
}

/// Works off the bodies in some slots that a region holds, and whoever else has to go
/// before them. Returns whether it came to an end within `most` turns.
pub(super) fn work_off<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    slots: core::ops::Range<u32>,
    most: u64,
) -> bool {
    let Some(window) = region.window else { return true };
    for slot in slots {
        let time = region.next[slot as usize];
        if window.is_due(time) {
            region.worker.heap.push(Turn { time, slot });
        }
    }
    while let Some((slot, digits)) = region.worker.heap.pop() {
        let time = region.next[slot as usize];
        let is_its_turn = digits.is_none_or(|digits| time.to_f64().to_bits() == digits);
        if !window.is_due(time) || !is_its_turn {
            continue;
        }
        if region.worker.turns >= most {
            region.worker.heap.clear();
            return false;
        }
        region.worker.turns += 1;
        if let Err(Blocked) = take_turn(setting, region, clock, slot) {
            region.block(slot);
        }
    }
    true
}

/// Takes the turn of the body in a slot.
#[inline(always)]
fn take_turn<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    slot: u32,
) -> Result<(), Blocked> {
    let agenda = &region.agendas[slot as usize];
    let (time, cell) = (agenda.next_time(), agenda.cell);
    match agenda.next() {
        Next::LeavesCell => cross(setting, region, slot, time, clock.period)?,
        Next::Searches => {
            let nearby = find(setting, region, 0, slot, cell)?;
            region.worker.account.effort.searches += 1;
            search(setting, region, slot, nearby, time, clock.period);
        }
        Next::Meets(_) if is_unsettled(region, slot, time) => {
            if !region.is_whole {
                return Err(Blocked);
            }
            let nearby = find(setting, region, 0, slot, cell)?;
            search(setting, region, slot, nearby, time, clock.period);
            region.worker.settled.push((slot, time));
        }
        Next::Meets(expected) => {
            let other = match expected.partner.decoded() {
                Ok(other) => other,
                Err(feature) => {
                    let key = region.keys().of(slot, &expected);
                    return touch_feature(setting, region, clock, slot, feature, &key);
                }
            };
            if !region.records.holds(other as usize) {
                return Err(Blocked);
            }
            let is_present = region.marks[other as usize].stamp == expected.stamp;
            if !is_present && !region.has_past(&region.marks[other as usize]) {
                region.agendas[slot as usize].drop_first();
                region.enter(slot);
                return Ok(());
            }
            let key = region.keys().of(slot, &expected);
            if is_present {
                if !goes_first(region, other, &key) {
                    return collide_now(setting, region, clock, [slot, other], key);
                }
                let next = region.agendas[other as usize].next_time();
                if region.next[other as usize] != next {
                    return Err(Blocked);
                }
                region.worker.heap.push_first(other);
            } else if ended_after(region, other, expected.stamp, &key) {
                return collide_in_past(setting, region, clock, [slot, other], key);
            } else {
                region.agendas[slot as usize].drop_first();
            }
        }
    }
    region.enter(slot);
    Ok(())
}

/// Whether the next contact of the body in a slot is tied with others that were found
/// before its partners were what they are now: their order has to be found again.
#[inline(always)]
fn is_unsettled<T: Real>(region: &Region<'_, T>, slot: u32, time: T) -> bool {
    region.agendas[slot as usize].is_tied() && !region.worker.settled.contains(&(slot, time))
}

/// Whether a body has something to do before a collision that it is expected at.
#[inline(always)]
fn goes_first<T: Real>(region: &Region<'_, T>, slot: u32, key: &Key<T>) -> bool {
    let agenda = &region.agendas[slot as usize];
    let time = agenda.next_time();
    time < key.time
        || time == key.time
            && match agenda.next() {
                Next::Meets(expected) => {
                    is_unsettled(region, slot, time) || region.keys().of(slot, &expected) < *key
                }
                _ => true,
            }
}

/// Whether the flight with a stamp of the body in a slot has ended in this window, after
/// a collision that it is expected at.
fn ended_after<T: Real>(region: &Region<'_, T>, slot: u32, stamp: u32, key: &Key<T>) -> bool {
    let mut mark = region.marks[slot as usize];
    while region.has_past(&mark) {
        let past = region.past(mark.before);
        if past.mark.stamp == stamp {
            return *key < past.end_key(region.index, slot);
        }
        mark = past.mark;
    }
    false
}

/// The body in a slot meets a feature.
fn touch_feature<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    slot: u32,
    feature: u32,
    key: &Key<T>,
) -> Result<(), Blocked> {
    let cell = cell_at(setting, region, slot, key.time);
    let nearby = find(setting, region, 0, slot, cell)?;
    if !region.can_enter(cell, 1) {
        return Err(Blocked);
    }
    enter_cell(region, slot, cell);
    let when = (key.time, key.generation);
    collide_with_feature(setting, region, clock, (slot, feature), nearby, when);
    region.worker.settled.clear();
    Ok(())
}

/// The bodies in two slots collide on their present flights.
fn collide_now<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    pair: [u32; 2],
    key: Key<T>,
) -> Result<(), Blocked> {
    let cells = pair.each(|slot| cell_at(setting, region, slot, key.time));
    let nearby = find_both(setting, region, pair, cells, 2)?;
    collide(setting, region, clock, pair, cells, nearby, &key);
    Ok(())
}

/// The bodies in two slots collide, the second one on a flight that has ended since.
fn collide_in_past<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    pair: [u32; 2],
    key: Key<T>,
) -> Result<(), Blocked> {
    plan_undo(region, pair[1], key)?;
    can_look_again(setting, region)?;
    let flight = flight_before(region, pair[1], &key);
    let position = setting.state_of(&flight, key.time).0;
    let cells =
        [cell_at(setting, region, pair[0], key.time), region.cells.finest.grid.cell_of(position)];
    let bodies = 2 + region.worker.undo.len();
    let nearby = find_both(setting, region, pair, cells, bodies)?;
    undo(setting, region);
    collide(setting, region, clock, pair, cells, nearby, &key);
    look_again(setting, region, clock, pair);
    Ok(())
}

/// Finds the bodies near two that collide in cells, which some bodies may have to enter.
#[inline(always)]
fn find_both<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    pair: [u32; 2],
    cells: [[i32; 3]; 2],
    bodies: usize,
) -> Result<[Nearby; 2], Blocked> {
    let nearby = [
        find(setting, region, 0, pair[0], cells[0])?,
        find(setting, region, 1, pair[1], cells[1])?,
    ];
    let can_enter = cells.iter().all(|&cell| region.can_enter(cell, bodies));
    can_enter.then_some(nearby).ok_or(Blocked)
}

/// The collision itself, once all that it needs is known to be held.
#[inline(always)]
fn collide<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    pair: [u32; 2],
    cells: [[i32; 3]; 2],
    nearby: [Nearby; 2],
    key: &Key<T>,
) {
    for (slot, cell) in pair.into_iter().zip(cells) {
        enter_cell(region, slot, cell);
    }
    let is_swapped = region.index[pair[0] as usize] > region.index[pair[1] as usize];
    let ([one, other], [near_one, near_other]) = (pair, nearby);
    let (pair, nearby) =
        if is_swapped { ([other, one], [near_other, near_one]) } else { (pair, nearby) };
    collide_pair(setting, region, clock, pair, nearby, (key.time, key.generation));
    region.worker.settled.clear();
}

/// The flight of a body before a collision.
pub(super) fn flight_before<T: Real>(region: &Region<'_, T>, slot: u32, key: &Key<T>) -> Flight<T> {
    let mut mark = region.marks[slot as usize];
    let mut flight = region.records[slot as usize].flight();
    while region.has_past(&mark) {
        let past = region.past(mark.before);
        if past.end_key(region.index, slot) < *key {
            break;
        }
        flight = past.flight(flight.radius);
        mark = past.mark;
    }
    flight
}

/// The cell of a body at the time of a collision: it may have been worked off beyond
/// that time, and have crossed since.
#[inline(always)]
fn cell_at<T: Real>(setting: &Setting<T>, region: &Region<'_, T>, slot: u32, time: T) -> [i32; 3] {
    let (position, _) = region.state_of(setting, slot as usize, time);
    let (grid, cell) = (region.cells.finest.grid, region.agendas[slot as usize].cell);
    if grid.is_about_in(cell, position) { cell } else { grid.cell_of(position) }
}

/// Registers a body in a cell, if that is not its own.
#[inline(always)]
pub(super) fn enter_cell<T: Real>(region: &mut Region<'_, T>, slot: u32, cell: [i32; 3]) {
    if region.agendas[slot as usize].cell != cell {
        region.move_to(0, slot, cell);
        region.agendas[slot as usize].cell = cell;
    }
}
