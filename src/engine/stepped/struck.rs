//! Struck: what contacts within a step have made of the paths.

use super::contacts::{Contact, Rank};
use crate::real::Real;

/// The same two bodies met twice in a row.
#[derive(Debug)]
pub(super) struct Again;

/// The last contact of each body within the present step. Before it, the
/// body's path is not the one that ends where the body now is.
#[derive(Debug)]
pub(super) struct Struck<T> {
    /// By slot: the time of the last contact before the end of the step, and
    /// its rank.
    last: Vec<Option<(T, Rank)>>,
    slots: Vec<u32>,
}

impl<T: Real> Struck<T> {
    pub fn new(len: usize) -> Self {
        Self { last: vec![None; len], slots: Vec::new() }
    }

    /// Forgets the step.
    pub fn clear(&mut self) {
        for slot in self.slots.drain(..) {
            self.last[slot as usize] = None;
        }
    }

    /// Notes that the bodies of a contact had it.
    pub fn strike(&mut self, contact: &Contact<T>) {
        self.strike_one(contact.a, contact);
        if contact.rank.is_pair() {
            self.strike_one(contact.b, contact);
        }
    }

    fn strike_one(&mut self, slot: u32, contact: &Contact<T>) {
        self.last[slot as usize] = Some((contact.ago, contact.rank));
        self.slots.push(slot);
    }

    /// The last contact of a contact's bodies, by its time before the end of the
    /// step, if any had one; `Err` if it is that one again, with nothing between.
    pub fn last_before(&self, contact: &Contact<T>) -> Result<Option<T>, Again> {
        let a = self.last[contact.a as usize];
        let b = if contact.rank.is_pair() { self.last[contact.b as usize] } else { a };
        let is_same = |last: Option<(T, Rank)>| last.is_some_and(|(_, rank)| rank == contact.rank);
        if is_same(a) && is_same(b) {
            return Err(Again);
        }
        let later = |(a, _): (T, Rank), (b, _): (T, Rank)| a.lesser(b);
        Ok(match (a, b) {
            (Some(a), Some(b)) => Some(later(a, b)),
            (last, None) | (None, last) => last.map(|(ago, _)| ago),
        })
    }

    /// The bytes of the marks.
    pub fn bytes(&self) -> usize {
        size_of_val(self.last.as_slice())
    }
}
