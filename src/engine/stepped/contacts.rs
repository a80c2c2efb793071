//! Contacts: those found in a step, and the order in which they take effect.
//!
//! The order depends on nothing but the scene: by the time of contact, then by
//! the bodies' indices. At the end of a step, where all contacts have one time and
//! no body moves, a contact may take effect as soon as it is the first one left
//! for both of its bodies, so a round takes all that are; they share no body and
//! can be worked on side by side, and the result is that of the sequential order.

use core::cmp::Ordering;

use crate::real::Real;

/// Two surfaces that touch within the step.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) struct Contact<T> {
    /// Rank among the contacts of one time.
    pub rank: Rank,
    /// The slot of the first body.
    pub a: u32,
    /// The slot of the second body, or the feature.
    pub b: u32,
    /// Time from the contact to the end of the step; 0 at its end.
    pub ago: T,
}

/// The first body's index, then what it meets: fixed features before bodies,
/// each by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::engine) struct Rank(u64);

const IS_BODY: u64 = 1 << 31;

impl Rank {
    /// Of no contact at all.
    pub const NONE: Self = Self(u64::MAX);

    /// Of a contact between the bodies with two different indices.
    #[inline]
    pub fn of_pair(first: u32, second: u32) -> Self {
        let (less, greater) = (first.min(second), first.max(second));
        Self(u64::from(less) << 32 | IS_BODY | u64::from(greater))
    }

    /// Of a contact between a body and a feature.
    #[inline]
    pub fn of_surroundings(body: u32, feature: u32) -> Self {
        Self(u64::from(body) << 32 | u64::from(feature))
    }

    /// Whether this is a contact of two bodies.
    #[inline]
    pub fn is_pair(self) -> bool {
        self.0 & IS_BODY != 0
    }
}

impl<T: Real> Contact<T> {
    /// The slots of its bodies, one or two.
    #[inline]
    pub fn bodies(&self) -> impl Iterator<Item = u32> {
        let second = self.rank.is_pair().then_some(self.b);
        core::iter::once(self.a).chain(second)
    }

    /// Earlier contacts first, those of one time by rank.
    pub fn order(&self, other: &Self) -> Ordering {
        let later = other.ago.partial_cmp(&self.ago).unwrap_or(Ordering::Equal);
        // Neighbours in one plane have one rank.
        later.then(self.rank.cmp(&other.rank)).then(self.b.cmp(&other.b))
    }
}

/// Takes contacts out in rounds that share no body.
#[derive(Debug)]
pub(super) struct Rounds {
    /// The round in which a body, by slot, was last blocked.
    blocked: Vec<u32>,
    round: u32,
}

impl Rounds {
    pub fn new(len: usize) -> Self {
        Self { blocked: vec![0; len], round: 0 }
    }

    /// Begins with all contacts found: those that share no body with any other go to `now`,
    /// the others, in order, to `waiting`, but for those that come first for all their bodies.
    pub fn begin<T: Real>(
        &mut self,
        found: &[Vec<Contact<T>>],
        waiting: &mut Vec<Contact<T>>,
        now: &mut Vec<Contact<T>>,
    ) {
        if self.round >= u32::MAX - 2 {
            *self = Self::new(self.blocked.len());
        }
        let (once, again) = (self.round + 1, self.round + 2);
        self.round = again;
        for contact in found.iter().flatten() {
            for slot in contact.bodies() {
                let blocked = &mut self.blocked[slot as usize];
                *blocked = if *blocked < once { once } else { again };
            }
        }
        waiting.clear();
        now.clear();
        for contact in found.iter().flatten() {
            let is_alone = contact.bodies().all(|slot| self.blocked[slot as usize] == once);
            if is_alone { now.push(*contact) } else { waiting.push(*contact) }
        }
        waiting.sort_unstable_by(Contact::order);
        self.take_more(waiting, now);
    }

    /// Moves the contacts that come first for all their bodies from `waiting`,
    /// which is in order, to `now`.
    pub fn take<T: Real>(&mut self, waiting: &mut Vec<Contact<T>>, now: &mut Vec<Contact<T>>) {
        now.clear();
        self.take_more(waiting, now);
    }

    fn take_more<T: Real>(&mut self, waiting: &mut Vec<Contact<T>>, now: &mut Vec<Contact<T>>) {
        if self.round == u32::MAX {
            *self = Self::new(self.blocked.len());
        }
        self.round += 1;
        let round = self.round;
        waiting.retain(|contact| {
            let a = contact.a as usize;
            let b = if contact.rank.is_pair() { contact.b as usize } else { a };
            let is_first = self.blocked[a] != round && self.blocked[b] != round;
            self.blocked[a] = round;
            self.blocked[b] = round;
            if is_first {
                now.push(*contact);
            }
            !is_first
        });
    }

    /// The bytes of the marks.
    pub fn bytes(&self) -> usize {
        size_of_val(self.blocked.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(a: u32, b: u32, ago: f64) -> Contact<f64> {
        Contact { rank: Rank::of_pair(a, b), a, b, ago }
    }

    #[test]
    fn rounds_keep_each_bodys_order() {
        let mut rounds = Rounds::new(6);
        let found =
            [vec![pair(2, 3, 0.0), pair(4, 5, 0.0)], vec![pair(1, 2, 0.0), pair(0, 1, 0.0)]];
        let (mut waiting, mut now) = (Vec::new(), Vec::new());
        for _ in 0..2 {
            rounds.begin(&found, &mut waiting, &mut now);
            let mut taken = Vec::new();
            while !now.is_empty() {
                taken.push(now.iter().map(|contact| (contact.a, contact.b)).collect::<Vec<_>>());
                rounds.take(&mut waiting, &mut now);
            }
            assert_eq!(taken, [vec![(4, 5), (0, 1)], vec![(1, 2)], vec![(2, 3)]]);
        }
    }

    #[test]
    fn order_is_by_time_then_body_then_surroundings_first() {
        let wall = Contact { rank: Rank::of_surroundings(1, 7), a: 1, b: 7, ago: 0.5 };
        let mut contacts = [pair(2, 1, 0.5), pair(0, 3, 0.1), wall, pair(5, 0, 0.5)];
        contacts.sort_unstable_by(Contact::order);
        let ranks: Vec<_> = contacts.iter().map(|contact| contact.rank).collect();
        assert_eq!(
            ranks,
            [Rank::of_pair(0, 5), wall.rank, Rank::of_pair(1, 2), Rank::of_pair(0, 3)]
        );
        assert!(!wall.rank.is_pair() && Rank::of_pair(0, 3).is_pair());
    }
}
