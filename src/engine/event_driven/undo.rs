//! Undo: flights of the present window are taken back, and what led on from them.

use super::clock::Clock;
use super::collide::{start_key, undo_start};
use super::crossing::plan_crossing;
use super::key::Key;
use super::region::Region;
use super::search::{Blocked, find, search};
use super::setting::Setting;
use super::window::{enter_cell, flight_before};
use crate::real::Real;

/// Puts down which bodies go back, and from which collision on, if the one in a slot
/// goes back to before `key`: with each collision both its bodies.
pub(super) fn plan_undo<T: Real>(
    region: &mut Region<'_, T>,
    slot: u32,
    key: Key<T>,
) -> Result<(), Blocked> {
    let mut plan = core::mem::take(&mut region.worker.undo);
    plan.clear();
    plan.push((slot, key));
    let mut at = 0;
    let mut is_held = true;
    while let Some(&(body, limit)) = plan.get(at) {
        at += 1;
        let mut mark = region.marks[body as usize];
        while region.has_past(&mark) {
            let past = region.past(mark.before);
            let end = past.end_key(region.index, body);
            if end < limit {
                break;
            }
            if let Ok(partner) = past.partner.decoded() {
                is_held &= region.records.holds(partner as usize);
                if is_held && !plan.iter().any(|&(body, limit)| body == partner && limit <= end) {
                    plan.push((partner, end));
                }
            }
            mark = past.mark;
        }
    }
    region.worker.undo = plan;
    if is_held { Ok(()) } else { Err(Blocked) }
}

/// Whether all that has to be looked at again after what is planned is held.
pub(super) fn can_look_again<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
) -> Result<(), Blocked> {
    if region.is_whole {
        return Ok(());
    }
    for k in 1..region.worker.undo.len() {
        let (body, limit) = region.worker.undo[k];
        let flight = flight_before(region, body, &limit);
        let now = region.not_before_window(flight.since);
        let cell = region.cells.finest.grid.cell_of(setting.state_of(&flight, now).0);
        find(setting, region, 0, body, cell)?;
        if !region.can_enter(cell, 2 + region.worker.undo.len()) {
            return Err(Blocked);
        }
    }
    Ok(())
}

/// Takes back what is planned.
pub(super) fn undo<T: Real>(setting: &Setting<T>, region: &mut Region<'_, T>) {
    for k in 0..region.worker.undo.len() {
        let (body, limit) = region.worker.undo[k];
        while start_key(region, body).is_some_and(|start| start >= limit) {
            undo_start(setting, region, body);
        }
    }
    region.worker.settled.clear();
}

/// Finds again what is ahead of all bodies that were taken back but two, which have
/// collided since.
pub(super) fn look_again<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    pair: [u32; 2],
) {
    let plan = core::mem::take(&mut region.worker.undo);
    for (k, &(body, _)) in plan.iter().enumerate() {
        let is_done = pair.contains(&body) || plan[..k].iter().any(|&(other, _)| other == body);
        if !is_done {
            look_again_at(setting, region, clock, body);
        }
    }
    region.worker.undo = plan;
}

fn look_again_at<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    slot: u32,
) {
    let at = slot as usize;
    let now = region.not_before_window(region.records[at].since());
    let cell = region.cells.finest.grid.cell_of(region.state_of(setting, at, now).0);
    enter_cell(region, slot, cell);
    plan_crossing(setting, region, slot, now, clock.period);
    match find(setting, region, 0, slot, cell) {
        Ok(nearby) => search(setting, region, slot, nearby, now, clock.period),
        // Its turn is to search, and has to wait.
        Err(Blocked) => region.agendas[at].clear(now),
    }
    region.enter(slot);
}

impl<T: Real> Region<'_, T> {
    /// A time, or the start of the window if that is later.
    fn not_before_window(&self, time: T) -> T {
        self.window.as_ref().map_or(time, |window| window.start.greater(time))
    }
}
