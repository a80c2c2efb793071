//! Turns: body after body in strict order of time.

use core::cmp::Ordering;
use core::hint::select_unpredictable;

use super::agenda::Next;
use super::calendar::Turn;
use super::clock::Clock;
use super::collide::{collide_pair, collide_with_feature};
use super::crossing::cross;
use super::key::{Keys, Rank};
use super::region::Region;
use super::report::{feature_event, pair_event};
use super::search::{Blocked, find, search};
use super::setting::Setting;
use crate::engine::Listener;
use crate::numbers::array::Each;
use crate::real::Real;

/// The next turn, left in the calendar.
#[inline(always)]
pub(super) fn next_turn<T: Real>(region: &mut Region<'_, T>) -> Option<Turn<T>> {
    let (keys, agendas, calendar) = region.in_order();
    let next = |slot: u32| agendas[slot as usize].next();
    let time_of = |slot: u32| agendas[slot as usize].next_time();
    calendar.next(time_of, |a, b| order(&keys, next, a, b))
}

/// Whether the next turn is at a time, and of a body that touches what removes it.
pub(super) fn is_removed_next<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    time: T,
) -> bool {
    let Some(turn) = next_turn(region).filter(|turn| turn.time == time) else { return false };
    let Next::Meets(expected) = region.agendas[turn.slot as usize].next() else { return false };
    let counter = expected.partner.decoded().err().and_then(|feature| setting.counter(feature));
    counter.is_some_and(|counter| counter.removes)
}

/// Enters a turn.
#[inline(always)]
pub(super) fn enter<T: Real>(region: &mut Region<'_, T>, turn: Turn<T>) {
    let (keys, agendas, calendar) = region.in_order();
    let next = |slot: u32| agendas[slot as usize].next();
    let time_of = |slot: u32| agendas[slot as usize].next_time();
    calendar.enter(turn, time_of, |a, b| order(&keys, next, a, b));
}

/// Takes a turn. Returns whether it was a collision. Blocked only where not all bodies
/// are held.
#[inline(always)]
pub(super) fn take_turn<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    turn: Turn<T>,
    on_event: &mut Listener<'_, T>,
) -> Result<bool, Blocked> {
    let Turn { time, slot } = turn;
    let cell = region.agendas[slot as usize].cell;
    match region.agendas[slot as usize].next() {
        Next::LeavesCell => cross(setting, region, slot, time, clock.period)?,
        Next::Searches => {
            let nearby = find(setting, region, 0, slot, cell)?;
            region.worker.account.effort.searches += 1;
            search(setting, region, slot, nearby, time, clock.period);
        }
        Next::Meets(expected) => {
            let when = (time, region.keys().generation(slot, &expected));
            match expected.partner.decoded() {
                Err(feature) => {
                    let nearby = find(setting, region, 0, slot, cell)?;
                    let contact = (slot, feature);
                    region.worker.calendar.forget(time, [slot; 2]);
                    let made = collide_with_feature(setting, region, clock, contact, nearby, when);
                    if let Some(on_event) = on_event {
                        let part = setting.features.shape_of(feature);
                        let bodies = (region.index[slot as usize], part);
                        on_event(&feature_event(setting, clock, bodies, &made, time));
                    }
                    return Ok(true);
                }
                Ok(other) if region.marks[other as usize].stamp == expected.stamp => {
                    let is_first = region.index[slot as usize] < region.index[other as usize];
                    let pair = select_unpredictable(is_first, [slot, other], [other, slot]);
                    let cells = pair.each(|slot| region.agendas[slot as usize].cell);
                    let nearby = [
                        find(setting, region, 0, pair[0], cells[0])?,
                        find(setting, region, 1, pair[1], cells[1])?,
                    ];
                    region.worker.calendar.forget(time, pair);
                    let made = collide_pair(setting, region, clock, pair, nearby, when);
                    if let Some(on_event) = on_event {
                        let bodies = pair.each(|slot| region.index[slot as usize]);
                        on_event(&pair_event(setting, clock, bodies, &made, time));
                    }
                    return Ok(true);
                }
                Ok(_) => region.agendas[slot as usize].drop_first(),
            }
        }
    }
    region.enter(slot);
    Ok(false)
}

/// The order of turns at equal times: what is no collision first, so that all
/// collisions of that time are known before one happens.
fn order<T: Real>(keys: &Keys<'_, T>, next: impl Fn(u32) -> Next<T>, a: u32, b: u32) -> Ordering {
    let of = |slot: u32| -> Option<(u32, Rank)> {
        match next(slot) {
            Next::Meets(expected) => {
                let key = keys.of(slot, &expected);
                Some((key.generation, key.rank))
            }
            _ => None,
        }
    };
    of(a).cmp(&of(b))
}
