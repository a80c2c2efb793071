//! Key: the order of collisions, those at equal times as well.
//!
//! A collision at the time at which one of its flights starts follows the one that
//! started it. Its *generation* is how many at this one time have led to it. Of equal
//! times the lesser generation comes first, of equal generations the lesser rank. All
//! of it follows from the two flights alone: the order is the same however it was found.

use super::agenda::{Expected, PartnerCode};
use super::flight::Record;
use super::log::{Logs, Mark};
use crate::real::Real;
use crate::space::pieces::Pieces;

/// The order of collisions of one time and generation: by the first body of the
/// scene, the surroundings before other bodies.
pub(super) type Rank = (u32, bool, u32);

/// Where a collision is in the order of all.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Key<T> {
    pub time: T,
    pub generation: u32,
    pub rank: Rank,
}

/// What tells the order of contacts.
pub(super) struct Keys<'a, T: Real> {
    pub records: &'a Pieces<'a, Record<T>>,
    pub marks: &'a Pieces<'a, Mark>,
    pub index: &'a [u32],
    pub logs: Logs<'a, T>,
    /// The last stamp before the window of time: flights with greater ones have others
    /// before them in the log.
    pub base: u32,
}

impl<T: Real> Keys<'_, T> {
    /// The key of a contact that the body in a slot expects.
    pub fn of(&self, slot: u32, expected: &Expected<T>) -> Key<T> {
        Key {
            time: expected.time,
            generation: self.generation(slot, expected),
            rank: rank(self.index, slot, expected.partner),
        }
    }

    /// The generation of a contact; of one that is off, since the partner's flight is
    /// gone, a lower bound.
    #[inline(always)]
    pub fn generation(&self, slot: u32, expected: &Expected<T>) -> u32 {
        let time = expected.time;
        let follows = |since: T, mark: &Mark| if since == time { mark.follows } else { 0 };
        let of = |slot: usize| match (self.records.get(slot), self.marks.get(slot)) {
            (Some(record), Some(mark)) => Some((record.since(), *mark)),
            _ => None,
        };
        let own = of(slot as usize).map_or(0, |(since, mark)| follows(since, &mark));
        let Ok(Some((mut since, mut mark))) = expected.partner.decoded().map(|k| of(k as usize))
        else {
            return own;
        };
        while mark.stamp != expected.stamp {
            if mark.stamp <= self.base {
                return own;
            }
            let past = self.logs.past(mark.before);
            (since, mark) = (past.since, past.mark);
        }
        own.max(follows(since, &mark))
    }
}

/// The rank of a contact of the body in a slot.
pub(super) fn rank(index: &[u32], slot: u32, partner: PartnerCode) -> Rank {
    let own = index[slot as usize];
    match partner.decoded() {
        Ok(other) => {
            let other = index[other as usize];
            (own.min(other), true, own.max(other))
        }
        Err(feature) => (own, false, feature),
    }
}
