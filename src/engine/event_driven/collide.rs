//! Collide: bodies end their flights, and start new ones.

use super::agenda::PartnerCode;
use super::clock::Clock;
use super::crossing::plan_crossing;
use super::features::Met;
use super::key::Key;
use super::log::{EntryNumber, Mark, Past};
use super::outcome::{
    Arrival, Departure, FeatureOutcome, PairOutcome, feature_outcome, pair_outcome,
};
use super::period::turn;
use super::region::Region;
use super::search::{Nearby, search};
use super::setting::Setting;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// The bodies in two slots collide, the first of the scene first. Bodies near each have
/// been found.
#[inline(always)]
pub(super) fn collide_pair<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    slots: [u32; 2],
    nearby: [Nearby; 2],
    (time, generation): (T, u32),
) -> PairOutcome<T> {
    let arrivals = slots.each(|slot| arrival(setting, region, slot as usize));
    let outcome = pair_outcome(setting, arrivals.refs(), time);
    for k in [0, 1] {
        let partner = PartnerCode::body(slots[1 - k]);
        end_flight(setting, region, slots[k], &arrivals[k], partner, (time, generation));
    }
    for k in [0, 1] {
        let last = PartnerCode::body(arrivals[1 - k].index);
        let mark = next_mark(region, slots[k], last, generation);
        depart(setting, region, clock, slots[k], &outcome.departures[k], mark);
    }
    region.worker.account.pair(outcome.impulse.normal, outcome.offset);
    for k in [0, 1] {
        look_ahead(setting, region, slots[k], nearby[k], time, clock.period);
    }
    outcome
}

/// The body in a slot collides with a feature.
pub(super) fn collide_with_feature<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    (slot, feature): (u32, u32),
    nearby: Nearby,
    (time, generation): (T, u32),
) -> FeatureOutcome<T> {
    let met = Met::of(setting, region, slot);
    let arrival = arrival(setting, region, slot as usize);
    let outcome = feature_outcome(setting, &arrival, &met, feature, time);
    let partner = PartnerCode::feature(feature);
    end_flight(setting, region, slot, &arrival, partner, (time, generation));
    let mark = next_mark(region, slot, partner, generation);
    depart(setting, region, clock, slot, &outcome.departure, mark);
    let impulses = [outcome.impulse.normal, outcome.impulse.tangential];
    let counter = setting.counter(feature);
    region.worker.account.surroundings(impulses, counter);
    region.worker.has_removed |= counter.is_some_and(|counter| counter.removes);
    look_ahead(setting, region, slot, nearby, time, clock.period);
    outcome
}

/// The body in a slot as it comes to a collision.
#[inline(always)]
fn arrival<T: Real>(setting: &Setting<T>, region: &Region<'_, T>, slot: usize) -> Arrival<T> {
    let spin = if setting.plan.changes_spins { region.spins[slot] } else { Vec3::ZERO };
    Arrival { flight: region.records[slot].flight(), spin, index: region.index[slot] }
}

/// Ends the flight of the body in a slot: in a window it goes into the log; in strict
/// order the orientation is brought up to the time, which otherwise waits for the
/// window's end.
#[inline(always)]
fn end_flight<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    arrival: &Arrival<T>,
    partner: PartnerCode,
    end: (T, u32),
) {
    let at = slot as usize;
    let flight = &arrival.flight;
    region.worker.account.flight(flight.velocity.length() * (end.0 - flight.since));
    if region.window.is_some() {
        let spin = setting.plan.changes_spins.then_some(arrival.spin);
        let past = Past::new(flight, region.marks[at], end, partner);
        region.marks[at].before = region.worker.log.put(past, spin);
    } else {
        turn(region, at, end.0, end.0);
    }
}

/// The mark of the flight that the body in a slot starts.
#[inline(always)]
fn next_mark<T: Real>(
    region: &mut Region<'_, T>,
    slot: u32,
    last: PartnerCode,
    generation: u32,
) -> Mark {
    let before = region.marks[slot as usize].before;
    let stamp = region.worker.new_stamp();
    Mark { stamp, last, before, follows: generation.saturating_add(1) }
}

/// Starts the next flight of the body in a slot.
#[inline(always)]
fn depart<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    clock: &Clock<T>,
    slot: u32,
    departure: &Departure<T>,
    mark: Mark,
) {
    let at = slot as usize;
    let flight = &departure.flight;
    region.put(at, flight);
    if setting.plan.changes_spins {
        region.spins[at] = departure.spin;
    }
    if setting.periodic.is_some() {
        let cell = &mut region.agendas[at].cell;
        *cell = region.cells.finest.grid.turned_back(*cell, departure.turns);
    }
    region.marks[at] = mark;
    region.worker.is_too_fast |= flight.velocity.length_squared() > clock.too_fast;
}

/// Finds what is ahead of a body after a collision; bodies near it have been found.
#[inline(always)]
fn look_ahead<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    nearby: Nearby,
    time: T,
    period: T,
) {
    plan_crossing(setting, region, slot, time, period);
    search(setting, region, slot, nearby, time, period);
    region.enter(slot);
}

/// What the collision that ended the flight of an entry, of the body in a slot, was.
pub(super) enum Made<T: Real> {
    /// With another body, in this slot: the entry is the first body's.
    Pair(u32, PairOutcome<T>),
    /// The entry is the second body's.
    Other,
    /// With a feature, by its number.
    Feature(u32, FeatureOutcome<T>),
}

/// Works out again what the collision that ended a flight in the log did.
pub(super) fn made<T: Real>(
    setting: &Setting<T>,
    region: &Region<'_, T>,
    slot: u32,
    entry: EntryNumber,
) -> Made<T> {
    let arrival = |slot: u32, entry: EntryNumber| {
        let index = region.index[slot as usize];
        let radius = region.records[slot as usize].radius();
        let spin = region.logs().spin(entry);
        Arrival {
            flight: region.past(entry).flight(radius),
            spin: spin.unwrap_or(Vec3::ZERO),
            index,
        }
    };
    let past = region.past(entry);
    let own = arrival(slot, entry);
    match past.partner.decoded() {
        Ok(other) if own.index < region.index[other as usize] => {
            let pair = [&own, &arrival(other, entry.next())];
            Made::Pair(other, pair_outcome(setting, pair, past.end))
        }
        Ok(_) => Made::Other,
        Err(feature) => {
            // Where the box counts, the features are not hollow.
            let met = Met { flight: own.flight, last: past.mark.last, turns: Vec3::ZERO };
            Made::Feature(feature, feature_outcome(setting, &own, &met, feature, past.end))
        }
    }
}

/// Takes the collision that started the flight of the body in a slot back, as far as
/// this body goes.
pub(super) fn undo_start<T: Real>(setting: &Setting<T>, region: &mut Region<'_, T>, slot: u32) {
    let at = slot as usize;
    let entry = region.marks[at].before;
    let past = *region.past(entry);
    let made = made(setting, region, slot, entry);
    let account = &mut region.worker.account;
    match made {
        Made::Pair(_, made) => {
            account.undo_pair(made.impulse.normal, made.offset);
            account.effort.undone += 1;
        }
        Made::Other => {}
        Made::Feature(feature, made) => {
            let impulses = [made.impulse.normal, made.impulse.tangential];
            account.undo_surroundings(impulses, setting.counter(feature));
            account.effort.undone += 1;
        }
    }
    let flight = past.flight(region.records[at].radius());
    account.undo_flight(flight.velocity.length() * (past.end - flight.since));
    if let Some(spin) = region.logs().spin(entry) {
        region.spins[at] = spin;
    }
    region.put(at, &flight);
    region.marks[at] = past.mark;
}

/// The key of the collision that started the flight of the body in a slot, if it is in
/// this window.
pub(super) fn start_key<T: Real>(region: &Region<'_, T>, slot: u32) -> Option<Key<T>> {
    let mark = region.marks[slot as usize];
    region.has_past(&mark).then(|| region.past(mark.before).end_key(region.index, slot))
}
