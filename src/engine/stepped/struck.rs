//! Struck: what contacts within a step have made of the paths.

use super::contacts::{Contact, Rank};
use crate::real::Real;

/// The last contact of each body within the present step. Before it, the
/// body's path is not the one that ends where the body now is.
#[derive(Debug)]
pub(super) struct Struck<T> {
    /// By place: the time of the last contact before the end of the step, and
    /// its rank.
    last: Vec<Option<(T, Rank)>>,
    places: Vec<u32>,
}

impl<T: Real> Struck<T> {
    pub fn new(len: usize) -> Self {
        Self { last: vec![None; len], places: Vec::new() }
    }

    /// Forgets the step.
    pub fn clear(&mut self) {
        for place in self.places.drain(..) {
            self.last[place as usize] = None;
        }
    }

    /// Notes that a body had a contact.
    pub fn strike(&mut self, place: u32, contact: &Contact<T>) {
        self.last[place as usize] = Some((contact.ago, contact.rank));
        self.places.push(place);
    }

    /// Whether a contact came after the last one of its bodies, and is not
    /// that one again with nothing between.
    pub fn allows(&self, contact: &Contact<T>) -> bool {
        let last = |place: u32| self.last[place as usize];
        let is_later = |last: Option<(T, Rank)>| last.is_none_or(|(ago, _)| contact.ago <= ago);
        let is_same = |last: Option<(T, Rank)>| last.is_some_and(|(_, rank)| rank == contact.rank);
        let a = last(contact.a);
        let b = if contact.rank.is_pair() { last(contact.b) } else { a };
        is_later(a) && is_later(b) && !(is_same(a) && is_same(b))
    }

    /// The bytes of the marks.
    pub fn bytes(&self) -> usize {
        size_of_val(self.last.as_slice())
    }
}
