//! Neighbourhoods: the candidates of each body.
//!
//! A contact within a step changes the paths of two bodies: what these meet now
//! is looked for among their own candidates. They are put in order of the bodies
//! at the first contact after a search, so that steps without contacts do not pay
//! for it.

use crate::space::broadphase::{Candidates, Chunk, Pair};

/// The candidates of the last search, by the slots of their bodies.
#[derive(Debug, Default)]
pub(super) struct Neighbourhoods {
    bodies: Rows,
    parts: Rows,
    is_known: bool,
}

/// What each body has, one after the other.
#[derive(Debug, Default)]
struct Rows {
    /// Where each body's begin, and one more.
    starts: Vec<u32>,
    all: Vec<u32>,
}

impl Neighbourhoods {
    /// Forgets all: there is a new search.
    pub fn clear(&mut self) {
        self.is_known = false;
    }

    /// Knows the candidates of this many bodies.
    pub fn know<'a>(&mut self, candidates: &'a Candidates, len: usize) {
        if self.is_known {
            return;
        }
        self.is_known = true;
        let chunks = &candidates.chunks;
        let pairs = || chunks.iter().flat_map(|chunk| &chunk.pairs).flatten();
        self.bodies.fill(len, || pairs().flat_map(|&[a, b]| [[a, b], [b, a]]));
        let at_part =
            |(part, bodies): (u32, &'a [u32])| bodies.iter().map(move |&body| [body, part]);
        self.parts.fill(len, || chunks.iter().flat_map(Chunk::at_all_parts).flat_map(at_part));
    }

    /// The bodies that the body in a slot can meet.
    pub fn bodies(&self, slot: u32) -> &[u32] {
        self.bodies.of(slot)
    }

    /// The fixed features that it can meet.
    pub fn parts(&self, slot: u32) -> &[u32] {
        self.parts.of(slot)
    }

    /// The bytes that the lists hold.
    pub fn bytes(&self) -> usize {
        let rows = |rows: &Rows| rows.starts.capacity() + rows.all.capacity();
        size_of::<u32>() * (rows(&self.bodies) + rows(&self.parts))
    }
}

impl Rows {
    /// Sorts entries, each a body and what it has, by body: a counting sort.
    fn fill<I: Iterator<Item = Pair>>(&mut self, len: usize, entries: impl Fn() -> I) {
        // Shifted by one, so that the counts turn into the first places and
        // then, as entries are placed, into the last ones.
        self.starts.clear();
        self.starts.resize(len + 2, 0);
        entries().for_each(|[slot, _]| self.starts[slot as usize + 2] += 1);
        let mut sum = 0;
        for start in &mut self.starts[2..] {
            sum += *start;
            *start = sum;
        }
        self.all.resize(sum as usize, 0);
        entries().for_each(|[slot, partner]| {
            let place = &mut self.starts[slot as usize + 1];
            self.all[*place as usize] = partner;
            *place += 1;
        });
        self.starts.pop();
    }

    fn of(&self, slot: u32) -> &[u32] {
        let slot = slot as usize;
        &self.all[self.starts[slot] as usize..self.starts[slot + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_hold_what_each_body_has() {
        let mut rows = Rows::default();
        rows.fill(4, || [[2, 7], [0, 5], [2, 1], [3, 9]].into_iter());
        let all: Vec<_> = (0..4).map(|slot| rows.of(slot).to_vec()).collect();
        assert_eq!(all, [vec![5], vec![], vec![7, 1], vec![9]]);
    }
}
