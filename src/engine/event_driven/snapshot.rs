//! Snapshot: what the event-driven engine has to remember at a moment.
//!
//! A contact time is a function of two flights alone, so that all that is ahead of the
//! bodies is found again from their flights.

use serde::{Deserialize, Serialize};

use super::agenda::PartnerCode;
use super::clock::{Clock, ClockState};
use super::flight::{Flight, Record};
use super::log::Mark;
use super::setting::Setting;
use super::store::Store;
use crate::engine::snapshot::{Misfit, Reals, Reals3, columns3, reals3_of};
use crate::mat3::Mat3;
use crate::numbers::array;
use crate::real::Real;
use crate::vec3::Vec3;

/// The bodies by slot, as they were sorted where the period began.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::engine) struct EventState {
    clock: ClockState,
    pub is_too_fast: bool,
    index: Vec<u32>,
    /// Centres and velocities where flights started.
    position: Reals3,
    velocity: Reals3,
    /// When they started, since the period's start.
    since: Reals,
    /// What each body met last, and how many collisions at that time had led to that.
    last: Vec<u32>,
    follows: Vec<u32>,
    /// Where contacts change spins: those, orientations, and since when these are true.
    turning: Option<Turning>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Turning {
    spin: Reals3,
    orientation: [Reals; 9],
    since: Reals,
}

/// What is to be remembered.
pub(super) fn save<T: Real>(store: &Store<T>, clock: &Clock<T>, is_too_fast: bool) -> EventState {
    let flights = || store.slots().map(|slot| store.records[slot].flight());
    let marks = || store.slots().map(|slot| store.marks[slot]);
    let turned = || store.slots().map(|slot| store.turned[slot]);
    EventState {
        clock: clock.save(),
        is_too_fast,
        index: store.slots().map(|slot| store.index[slot]).collect(),
        position: reals3_of(flights().map(|flight| flight.position)),
        velocity: reals3_of(flights().map(|flight| flight.velocity)),
        since: Reals::of(flights().map(|flight| flight.since)),
        last: marks().map(|mark| mark.last.code()).collect(),
        follows: marks().map(|mark| mark.follows).collect(),
        turning: (!store.turned.is_empty()).then(|| Turning {
            spin: reals3_of(store.slots().map(|slot| store.spins[slot])),
            orientation: array::from_fn(|k| {
                Reals::of(turned().map(|(orientation, _)| orientation.rows()[k]))
            }),
            since: Reals::of(turned().map(|(_, since)| since)),
        }),
    }
}

/// Goes on from there, with a store of the scene at its start, some of whose bodies are `out`
/// by now: all but what is ahead.
pub(super) fn restore<T: Real>(
    setting: &Setting<T>,
    store: &mut Store<T>,
    saved: &EventState,
    out: &[u32],
) -> Result<Clock<T>, Misfit> {
    let mut has = vec![false; store.records.len()];
    let len = has.len().checked_sub(out.len()).ok_or(Misfit("bodies"))?;
    let three = |columns: &Reals3, what| -> Result<Vec<Vec3<T>>, Misfit> {
        let [x, y, z] = columns3(columns, len, what)?;
        Ok((0..len).map(|slot| Vec3::new(x[slot], y[slot], z[slot])).collect())
    };
    for &index in saved.index.iter().chain(out) {
        *has.get_mut(index as usize).ok_or(Misfit("bodies"))? = true;
    }
    let lengths = [saved.index.len(), saved.last.len(), saved.follows.len()];
    if lengths != [len; 3] || !has.iter().all(|has| *has) {
        return Err(Misfit("bodies"));
    }
    let restored = Clock::restored(&saved.clock)?;
    let (position, velocity) =
        (three(&saved.position, "positions")?, three(&saved.velocity, "velocities")?);
    let since: Vec<T> = saved.since.read(len, "flights")?;
    let turning = match &saved.turning {
        None if store.turned.is_empty() => None,
        Some(turning) if !store.turned.is_empty() => {
            let mut rows = Vec::with_capacity(9);
            for row in &turning.orientation {
                rows.push(row.read::<T>(len, "orientations")?);
            }
            let since: Vec<T> = turning.since.read(len, "orientations")?;
            let orientation = |slot: usize| Mat3::from_rows(array::from_fn(|k| rows[k][slot]));
            let turned = (0..len).map(|slot| (orientation(slot), since[slot])).collect();
            Some((three(&turning.spin, "spins")?, turned))
        }
        _ => return Err(Misfit("orientations")),
    };
    store.records = (0..len)
        .map(|slot| {
            let radius = setting.bodies.radius.of(saved.index[slot] as usize);
            let (position, velocity) = (position[slot], velocity[slot]);
            Record::new(Flight { position, velocity, since: since[slot], radius })
        })
        .collect();
    store.index.clone_from(&saved.index);
    let marks = saved.last.iter().zip(&saved.follows).map(|(&last, &follows)| {
        let last = PartnerCode::from_code(last);
        Mark { last, follows, ..Mark::NEW }
    });
    store.marks = marks.collect();
    if let Some((spins, turned)) = turning {
        (store.spins, store.turned) = (spins, turned);
    }
    Ok(restored)
}
