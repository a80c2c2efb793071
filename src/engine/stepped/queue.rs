//! Queue: the contacts within a step that have not taken effect.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use super::contacts::Contact;
use crate::real::Real;

/// A contact that takes effect in its turn, unless one of its bodies has another
/// one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Due<T> {
    pub contact: Contact<T>,
    /// How many contacts its bodies had had when it was found.
    pub count: u32,
}

impl<T: Real> Ord for Due<T> {
    /// The first one is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.contact.order(&self.contact)
    }
}

impl<T: Real> PartialOrd for Due<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T: Real> Eq for Due<T> {}

impl<T: Real> PartialEq for Due<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

/// Contacts by time, then by rank.
///
/// Most are known before the first one takes effect. To sort these at once takes a
/// third of the time that a heap of all takes.
#[derive(Debug)]
pub(super) struct Queue<T: Real> {
    /// Those known from the beginning, the first one last.
    foreseen: Vec<Due<T>>,
    /// Those that others have led to.
    added: BinaryHeap<Due<T>>,
}

impl<T: Real> Queue<T> {
    pub fn new() -> Self {
        Self { foreseen: Vec::new(), added: BinaryHeap::new() }
    }

    /// Makes room for this many contacts of both kinds.
    pub fn reserve(&mut self, contacts: usize) {
        self.foreseen.reserve(contacts);
        self.added.reserve(contacts);
    }

    /// Begins with these contacts.
    pub fn begin(&mut self, all: impl Iterator<Item = Due<T>>) {
        self.added.clear();
        self.foreseen.clear();
        self.foreseen.extend(all);
        self.foreseen.sort_unstable();
    }

    pub fn add(&mut self, due: Due<T>) {
        self.added.push(due);
    }

    /// Takes the first one.
    pub fn take(&mut self) -> Option<Due<T>> {
        let is_added = match (self.foreseen.last(), self.added.peek()) {
            (Some(foreseen), Some(added)) => added > foreseen,
            (foreseen, _) => foreseen.is_none(),
        };
        if is_added { self.added.pop() } else { self.foreseen.pop() }
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        size_of::<Due<T>>() * (self.foreseen.capacity() + self.added.capacity())
    }
}

#[cfg(test)]
mod tests {
    use super::super::contacts::Rank;
    use super::*;

    #[test]
    fn what_is_due_first_is_taken_first() {
        let due = |ago: f64, b: u32| Due {
            contact: Contact { rank: Rank::of_pair(0, b), a: 0, b, ago },
            count: 0,
        };
        let mut queue = Queue::new();
        queue.begin([due(0.25, 1), due(0.5, 2), due(0.25, 3)].into_iter());
        queue.add(due(0.25, 2));
        queue.add(due(0.375, 4));
        let taken: Vec<_> = core::iter::from_fn(|| queue.take()).map(|due| due.contact.b).collect();
        assert_eq!(taken, [2, 4, 1, 2, 3]);
    }
}
