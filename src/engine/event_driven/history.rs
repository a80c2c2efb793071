//! History: what has happened in a window, once it is worked off.

use super::clock::Clock;
use super::collide::{Made, made, start_key, undo_start};
use super::key::Key;
use super::log::EntryNumber;
use super::region::Region;
use super::report::{feature_event, pair_event};
use super::setting::Setting;
use crate::engine::Listener;
use crate::motion::rotation::turned;
use crate::real::Real;

/// A collision: when it was, and the entry of its first body's flight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Happened<T> {
    pub key: Key<T>,
    slot: u32,
    entry: EntryNumber,
}

/// All collisions of the window, in order.
pub(super) fn history<T: Real>(region: &Region<'_, T>) -> Vec<Happened<T>> {
    let mut history = Vec::new();
    for slot in 0..region.marks.len() as u32 {
        let own = region.index[slot as usize];
        let mut mark = region.marks[slot as usize];
        while region.has_past(&mark) {
            let (entry, past) = (mark.before, region.past(mark.before));
            let other = past.partner.decoded();
            if other.is_ok_and(|other| own > region.index[other as usize]) {
                mark = past.mark;
                continue;
            }
            history.push(Happened { key: past.end_key(region.index, slot), slot, entry });
            mark = past.mark;
        }
    }
    let order = |a: &Happened<T>, b: &Happened<T>| a.key.partial_cmp(&b.key);
    history.sort_unstable_by(|a, b| order(a, b).unwrap_or(core::cmp::Ordering::Equal));
    history
}

/// Reports collisions.
pub(super) fn tell<T: Real>(
    setting: &Setting<T>,
    region: &Region<'_, T>,
    clock: &Clock<T>,
    history: &[Happened<T>],
    on_event: &mut Listener<'_, T>,
) {
    let Some(on_event) = on_event else { return };
    for &Happened { key, slot, entry } in history {
        let own = region.index[slot as usize];
        on_event(&match made(setting, region, slot, entry) {
            Made::Pair(other, made) => {
                pair_event(setting, clock, [own, region.index[other as usize]], &made, key.time)
            }
            Made::Feature(feature, made) => feature_event(
                setting,
                clock,
                (own, setting.features.shape_of(feature)),
                &made,
                key.time,
            ),
            Made::Other => continue,
        });
    }
}

/// The first collision of the window from which on a body is too fast for the period.
pub(super) fn first_too_fast<T: Real>(region: &Region<'_, T>, clock: &Clock<T>) -> Option<Key<T>> {
    let mut first: Option<Key<T>> = None;
    for slot in 0..region.marks.len() as u32 {
        let mut mark = region.marks[slot as usize];
        let mut flight = region.records[slot as usize].flight();
        while region.has_past(&mark) {
            let past = region.past(mark.before);
            let start = past.end_key(region.index, slot);
            let is_too_fast = flight.velocity.length_squared() > clock.too_fast;
            if is_too_fast && first.is_none_or(|first| start < first) {
                first = Some(start);
            }
            flight = past.flight(flight.radius);
            mark = past.mark;
        }
    }
    first
}

/// Takes back all collisions of the window after one, or all.
pub(super) fn undo_after<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    last: Option<Key<T>>,
) {
    for slot in 0..region.marks.len() as u32 {
        let is_after = |start: Key<T>| last.is_none_or(|last| start > last);
        while start_key(region, slot).is_some_and(is_after) {
            undo_start(setting, region, slot);
        }
    }
}

/// Turns all bodies up to the start of their present flights.
pub(super) fn turn_all<T: Real>(region: &mut Region<'_, T>) {
    let mut chain = Vec::new();
    for slot in 0..region.turned.len() {
        let mut mark = region.marks[slot];
        while region.has_past(&mark) {
            chain.push(mark.before);
            mark = region.past(mark.before).mark;
        }
        while let Some(entry) = chain.pop() {
            let end = region.past(entry).end;
            let spin = region.logs().spin(entry).unwrap_or(region.spins[slot]);
            let (orientation, turned_at) = region.turned[slot];
            region.turned[slot] = (turned(orientation, spin, end - turned_at), end);
        }
    }
}

/// Whether no two flights of the window touch within both, every pair of them tried: the
/// history is the one of strict order then.
#[cfg(debug_assertions)]
pub(super) fn is_closed<T: Real>(setting: &Setting<T>, region: &Region<'_, T>) -> bool {
    use super::agenda::PartnerCode;
    use super::flight::Flight;
    use super::log::Mark;
    use super::meeting::meeting;
    use crate::motion::integrator::VelocityVerlet;
    use crate::space::{OpenSpace, PeriodicBox, Space};
    use crate::vec3::Vec3;

    type Segment<T> = (Flight<T>, Mark, Option<Key<T>>);
    let Some(window) = region.window else { return true };
    let segments = |slot: u32| -> Vec<Segment<T>> {
        let mut mark = region.marks[slot as usize];
        let mut flight = region.records[slot as usize].flight();
        let mut segments = vec![(flight, mark, None)];
        while region.has_past(&mark) {
            let past = region.past(mark.before);
            (flight, mark) = (past.flight(flight.radius), past.mark);
            segments.push((flight, mark, Some(past.end_key(region.index, slot))));
        }
        segments
    };
    fn contact<T: Real, S: Space<T>>(
        (a, b): (&Flight<T>, &Flight<T>),
        gravity: Vec3<T>,
        (space, now): (S, T),
    ) -> (bool, T, bool) {
        let still = Vec3::ZERO;
        let met = meeting::<T, VelocityVerlet, S, false>(a, b, gravity, space, still, now);
        let (meets, time) = met.contact();
        (meets, time, met.is_touching())
    }
    let all: Vec<_> = (0..region.marks.len() as u32).map(segments).collect();
    for (a, b) in (0..all.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
        for (one, other) in all[a].iter().flat_map(|one| all[b].iter().map(move |b| (one, b))) {
            let now = one.0.since.greater(other.0.since).greater(window.start);
            let flights = (&one.0, &other.0);
            let (meets, time, is_touching) = match setting.periodic {
                Some(space) => {
                    let space: PeriodicBox<T> = space;
                    contact(flights, setting.gravity, (space, now))
                }
                None => contact(flights, setting.gravity, (OpenSpace, now)),
            };
            let code = |slot: usize| PartnerCode::body(region.index[slot]);
            let have_met = one.1.last == code(b) && other.1.last == code(a);
            if !meets || have_met && is_touching || !window.is_due(time) {
                continue;
            }
            let follows = |(flight, mark, _): &Segment<T>| {
                if flight.since == time { mark.follows } else { 0 }
            };
            let generation = follows(one).max(follows(other));
            let rank = super::key::rank(region.index, a as u32, PartnerCode::body(b as u32));
            let key = Key { time, generation, rank };
            if [one, other].iter().all(|segment| segment.2.is_none_or(|end| key < end)) {
                eprintln!("missed: {key:?} of {one:?} and {other:?} in {window:?}");
                return false;
            }
        }
    }
    true
}
