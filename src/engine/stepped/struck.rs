//! Struck: what contacts within a step have made of the paths.

use super::contacts::{Contact, Rank};
use crate::column::Column;
use crate::real::Real;

/// Contacts of a body in one step; those beyond wait for the next one. What is
/// wedged in under gravity has contacts without end.
const MOST_CONTACTS: u32 = 10_000;

/// The contacts that bodies have had within the present step. A path that ends
/// where a body now is has been the body's since the last of them.
#[derive(Debug)]
pub(super) struct Struck<T: Real> {
    duration: T,
    /// By slot: since when a body has had its path, before the end of the step.
    since: Column<T>,
    /// By slot: the last contact.
    last: Vec<Rank>,
    /// By slot: how many.
    count: Vec<u32>,
    /// Those that had any, more than once.
    slots: Vec<u32>,
}

impl<T: Real> Struck<T> {
    /// No contacts yet, in steps of a length.
    pub fn new(len: usize, duration: T) -> Self {
        Self {
            duration,
            since: Column::new(len, duration),
            last: vec![Rank::NONE; len],
            count: vec![0; len],
            slots: Vec::new(),
        }
    }

    /// Whether no body has had a contact.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// Makes room for this many contacts.
    pub fn reserve(&mut self, contacts: usize) {
        self.slots.reserve(2 * contacts);
    }

    /// No contacts yet, from now on in steps of another length.
    pub fn begin(&mut self, duration: T) {
        self.clear();
        if duration != self.duration {
            self.duration = duration;
            self.since.fill(duration);
        }
    }

    /// The slots of the bodies that have had contacts, some more than once.
    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    /// Forgets the step.
    pub fn clear(&mut self) {
        for slot in self.slots.drain(..) {
            let slot = slot as usize;
            self.since[slot] = self.duration;
            self.last[slot] = Rank::NONE;
            self.count[slot] = 0;
        }
    }

    /// Notes that the bodies of a contact had it.
    pub fn strike(&mut self, contact: &Contact<T>) {
        for slot in contact.bodies() {
            self.slots.push(slot);
            let slot = slot as usize;
            self.since[slot] = contact.ago;
            self.last[slot] = contact.rank;
            self.count[slot] += 1;
        }
    }

    /// Since when the bodies have had their paths, by slot.
    #[inline(always)]
    pub fn since(&self) -> &[T] {
        &self.since
    }

    /// The same, with what a column ends with.
    pub fn padded_since(&self) -> &[T] {
        self.since.padded()
    }

    /// Whether the last contact of the body in a slot has this rank.
    #[inline]
    pub fn is_last(&self, slot: u32, rank: Rank) -> bool {
        self.last[slot as usize] == rank
    }

    /// Whether a contact is the last one of all its bodies, once more.
    pub fn is_again(&self, contact: &Contact<T>) -> bool {
        contact.bodies().all(|slot| self.is_last(slot, contact.rank))
    }

    /// How many contacts a contact's bodies have had: another number, another path.
    pub fn count(&self, contact: &Contact<T>) -> u32 {
        contact.bodies().map(|slot| self.count[slot as usize]).sum()
    }

    /// Whether the body in a slot has had all contacts of a step.
    pub fn is_spent(&self, slot: u32) -> bool {
        self.count[slot as usize] >= MOST_CONTACTS
    }

    /// Puts what is known of the body at slot `order[k]` to slot `k`.
    pub fn reorder(&mut self, order: &[u32]) {
        if self.is_empty() {
            return;
        }
        let (since, last, count) = (self.since.clone(), self.last.clone(), self.count.clone());
        self.slots.clear();
        for (slot, &from) in order.iter().enumerate() {
            let from = from as usize;
            self.since[slot] = since[from];
            self.last[slot] = last[from];
            self.count[slot] = count[from];
            if self.count[slot] > 0 {
                self.slots.push(slot as u32);
            }
        }
    }

    /// The bytes of the marks.
    pub fn bytes(&self) -> usize {
        self.since.bytes()
            + size_of_val(self.last.as_slice())
            + size_of_val(self.count.as_slice())
            + self.slots.capacity() * size_of::<u32>()
    }
}
