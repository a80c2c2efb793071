//! Neighbourhoods: the candidates of each body.
//!
//! A contact within a step changes the paths of two bodies: what these meet now
//! is looked for among their own candidates. They are put in order of the bodies
//! at the first contact after a search, so that steps without contacts do not pay
//! for it.

use crate::space::broadphase::{Candidates, Chunk};
use crate::space::rows::{Hands, Rows};
use crate::workers::Workers;

/// The candidates of the last search, by the slots of their bodies.
#[derive(Debug, Default)]
pub(super) struct Neighbourhoods {
    /// Both kinds in one row: whatever a contact reads is in no cache.
    rows: Rows,
    is_known: bool,
}

/// What a body can meet.
#[derive(Clone, Copy, Debug)]
pub(super) enum Neighbour {
    /// The body in a slot.
    Body(u32),
    /// A fixed feature.
    Part(u32),
}

/// In the rows, what is added to the number of a fixed feature.
const PART: u32 = 1 << 31;

impl Neighbourhoods {
    /// Forgets all: there is a new search.
    pub fn clear(&mut self) {
        self.is_known = false;
    }

    /// Knows the candidates of this many bodies.
    pub fn know(&mut self, candidates: &Candidates, len: usize, workers: &Workers) {
        if self.is_known {
            return;
        }
        self.is_known = true;
        let deal = |chunk: &Chunk, hands: &mut Hands| {
            for &[a, b] in chunk.pairs.iter().flatten() {
                hands.deal(a, b);
                hands.deal(b, a);
            }
            for (part, bodies) in chunk.at_all_parts() {
                bodies.iter().for_each(|&body| hands.deal(body, PART | part));
            }
        };
        self.rows.fill(len, &candidates.chunks, deal, workers);
    }

    /// What the body in a slot can meet.
    #[inline]
    pub fn of(&self, slot: u32) -> impl Iterator<Item = Neighbour> {
        self.rows.of(slot).iter().map(|&number| match number & PART {
            0 => Neighbour::Body(number),
            _ => Neighbour::Part(number & !PART),
        })
    }

    /// The bytes that the lists hold.
    pub fn bytes(&self) -> usize {
        self.rows.bytes()
    }
}
