//! Log: flights that have ended in the present window of time.
//!
//! Within a window bodies are worked off block by block, not in the order of time.
//! Where one finds that it meets another before that one's last collision, the flight
//! then is still here: the collision is taken back (`undo`).

use super::agenda::PartnerCode;
use super::flight::Flight;
use super::key::{Key, rank};
use super::tight;
use crate::real::Real;
use crate::vec3::Vec3;

/// The binary digits of an entry's number that say where in its log it is.
const DIGITS: u32 = 26;

/// The most entries of a log.
pub(super) const MOST_ENTRIES: usize = 1 << DIGITS;

/// What others ask about a body's flight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    /// A number that no other flight of the period has; the same again when the flight is
    /// restored.
    pub stamp: u32,
    /// What it met last, a body by its index in the scene.
    pub last: PartnerCode,
    /// The entry of the flight before, if this one has started in the present window.
    pub before: EntryNumber,
    /// The generation of a collision at the time at which the flight starts: how many
    /// collisions at this one time have led to it.
    pub follows: u32,
}

impl Mark {
    /// Of a body at the start.
    pub const NEW: Self =
        Self { stamp: 0, last: PartnerCode::NONE, before: EntryNumber(0), follows: 0 };
}

/// Where an entry is: the number of its log, and its place there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct EntryNumber(u32);

impl EntryNumber {
    /// The entry behind this one: the second body's of a collision.
    pub fn next(self) -> Self {
        Self(self.0 + 1)
    }
}

/// A flight that has ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Past<T> {
    position: Vec3<T>,
    velocity: Vec3<T>,
    pub since: T,
    pub mark: Mark,
    /// When it ended, and how many collisions at that time had led to the one that
    /// ended it.
    pub end: T,
    pub generation: u32,
    /// What that one was with, a body by its slot.
    pub partner: PartnerCode,
}

impl<T: Real> Past<T> {
    pub fn new(
        flight: &Flight<T>,
        mark: Mark,
        (end, generation): (T, u32),
        partner: PartnerCode,
    ) -> Self {
        let &Flight { position, velocity, since, .. } = flight;
        Self { position, velocity, since, mark, end, generation, partner }
    }

    /// Where the collision that ended the flight, of the body in a slot, is in the order
    /// of all.
    pub fn end_key(&self, index: &[u32], slot: u32) -> Key<T> {
        let rank = rank(index, slot, self.partner);
        Key { time: self.end, generation: self.generation, rank }
    }

    /// The flight of a body with a radius.
    pub fn flight(&self, radius: T) -> Flight<T> {
        Flight { position: self.position, velocity: self.velocity, since: self.since, radius }
    }
}

/// The flights that a worker has ended, and the spins that bodies had then, where
/// collisions change them.
#[derive(Debug)]
pub(super) struct Log<T> {
    number: u32,
    pasts: Vec<Past<T>>,
    spins: Vec<Vec3<T>>,
}

impl<T: Real> Log<T> {
    pub fn new(number: usize) -> Self {
        Self { number: number as u32, pasts: Vec::new(), spins: Vec::new() }
    }

    /// Puts a flight down, and the spin if there is one.
    pub fn put(&mut self, past: Past<T>, spin: Option<Vec3<T>>) -> EntryNumber {
        let number = EntryNumber(self.number << DIGITS | self.pasts.len() as u32);
        tight::push(&mut self.pasts, past);
        if let Some(spin) = spin {
            tight::push(&mut self.spins, spin);
        }
        number
    }

    /// Forgets all entries. Of room for many more than there were it keeps some.
    pub fn clear(&mut self) {
        let (pasts, spins) = (2 * self.pasts.len(), 2 * self.spins.len());
        self.pasts.clear();
        self.spins.clear();
        self.pasts.shrink_to(pasts);
        self.spins.shrink_to(spins);
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.pasts.capacity() * size_of::<Past<T>>() + self.spins.capacity() * size_of::<Vec3<T>>()
    }
}

/// The logs that a worker reads: its own and those of others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Logs<'a, T> {
    pub own: &'a Log<T>,
    pub others: &'a [Log<T>],
}

impl<'a, T: Real> Logs<'a, T> {
    #[inline(always)]
    fn log(self, entry: EntryNumber) -> (&'a Log<T>, usize) {
        let (log, place) = (entry.0 >> DIGITS, entry.0 as usize & (MOST_ENTRIES - 1));
        (if log == self.own.number { self.own } else { &self.others[log as usize] }, place)
    }

    /// The flight of an entry.
    #[inline(always)]
    pub fn past(self, entry: EntryNumber) -> &'a Past<T> {
        let (log, place) = self.log(entry);
        &log.pasts[place]
    }

    /// The spin of an entry, if collisions change spins.
    pub fn spin(self, entry: EntryNumber) -> Option<Vec3<T>> {
        let (log, place) = self.log(entry);
        log.spins.get(place).copied()
    }
}
