//! Turns: body after body, the earliest first.

use core::cmp::Ordering;

use super::agenda::{Agenda, Next};
use super::calendar::Turn;
use super::clock::Clock;
use super::collide::{collide_pair, collide_with_feature};
use super::crossing::cross;
use super::region::Region;
use super::search::{rank, search};
use super::setting::Setting;
use crate::engine::Listener;
use crate::engine::account::Account;
use crate::real::Real;

/// The next turn, left in the calendar.
#[inline(always)]
pub(super) fn next_turn<T: Real>(region: &mut Region<T>) -> Option<Turn<T>> {
    let (agendas, index) = (&region.agendas, &region.index);
    region
        .calendar
        .next(|slot| agendas[slot as usize].next_time(), |a, b| order(agendas, index, a, b))
}

/// Enters the next turn of the body in a slot.
#[inline(always)]
pub(super) fn enter<T: Real>(region: &mut Region<T>, slot: u32) {
    let time = region.agendas[slot as usize].next_time();
    let (agendas, index) = (&region.agendas, &region.index);
    region.calendar.enter(Turn { time, slot }, |a, b| order(agendas, index, a, b));
}

/// Takes a turn. Returns whether it was a collision.
#[inline(always)]
pub(super) fn take_turn<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock<T>,
    account: &mut Account,
    turn: Turn<T>,
    on_event: &mut Listener<'_, T>,
) -> bool {
    let Turn { time, slot } = turn;
    let effort = &mut account.effort;
    match region.agendas[slot as usize].next() {
        Next::LeavesCell => cross(setting, region, effort, slot, time, clock.period),
        Next::Searches => {
            effort.searches += 1;
            search(setting, region, effort, slot, time, clock.period);
        }
        Next::Meets(expected) => match expected.partner.decoded() {
            Err(feature) => {
                let contact = (slot, feature);
                collide_with_feature(setting, region, clock, account, contact, time, on_event);
                return true;
            }
            Ok(other) if region.marks[other as usize].changes == expected.changes => {
                let pair = [slot, other];
                collide_pair(setting, region, clock, account, pair, time, on_event);
                return true;
            }
            Ok(_) => region.agendas[slot as usize].drop_first(),
        },
    }
    enter(region, slot);
    false
}

/// The order of turns at equal times: what is no collision first, so that all
/// collisions of that time are known before one happens.
fn order<T: Real>(agendas: &[Agenda<T>], index: &[u32], a: u32, b: u32) -> Ordering {
    let of = |slot: u32| match agendas[slot as usize].next() {
        Next::Meets(expected) => Some(rank(index, slot, expected.partner)),
        _ => None,
    };
    of(a).cmp(&of(b))
}
