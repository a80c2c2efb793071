//! Candidates: pairs of bodies, and bodies at fixed parts, that may touch.

use core::ops::Range;

use super::at_parts::AtParts;
use super::pair_search::SearchedGrid;
use crate::numbers::array;
use crate::real::Real;

/// Bodies searched as one piece of work.
const CHUNK: usize = 1024;

/// Into how many shells the skin is cut. A pair need not be tested before its
/// bodies can have come through the shells between them; 4 spare nearly half of
/// all tests, 8 a twentieth more.
pub(super) const SHELLS: usize = 4;

/// The slots of two bodies.
pub type Pair = [u32; 2];

/// What one piece of the search has found, for the bodies of one range.
#[derive(Debug, Default)]
pub struct Chunk {
    /// The grid that was searched, and its cells, by rank.
    pub(super) grid: usize,
    pub(super) cells: Range<u32>,
    /// The slots of the bodies in these cells.
    pub(super) bodies: Range<usize>,
    /// Pairs whose surfaces were nearer than the skin, by the shell that their
    /// gap was in, innermost first.
    pub pairs: [Vec<Pair>; SHELLS],
    /// The bodies whose surfaces were nearer than half the skin to fixed parts, by
    /// the shell that twice their gap was in.
    pub(super) at_parts: [AtParts; SHELLS],
}

impl Chunk {
    /// Empties the lists.
    pub fn clear(&mut self) {
        self.pairs.iter_mut().for_each(Vec::clear);
        self.at_parts.iter_mut().for_each(AtParts::clear);
    }

    /// The fixed parts that bodies in the first shells may touch, and the slots of
    /// those bodies.
    pub fn at_parts(&self, shells: usize) -> impl Iterator<Item = (u32, &[u32])> {
        self.at_parts[..shells].iter().flat_map(AtParts::each)
    }

    /// The fixed parts that bodies may touch before the next search.
    pub fn at_all_parts(&self) -> impl Iterator<Item = (u32, &[u32])> {
        self.at_parts(SHELLS)
    }

    /// Adds a pair that may touch at once.
    pub fn add_pair(&mut self, pair: Pair) {
        self.pairs[0].push(pair);
    }

    /// Adds a body that may touch a fixed part at once.
    pub fn add_at_part(&mut self, part: u32, body: u32) {
        self.at_parts[0].push(part, body);
    }

    /// Fills the pairs that may touch at once up to a multiple of `width`, with one
    /// that never does.
    pub fn fill_up(&mut self, width: usize, pair: Pair) {
        let whole = self.pairs[0].len().next_multiple_of(width);
        self.pairs[0].resize(whole, pair);
    }
}

/// All candidates, in chunks that do not depend on the number of threads.
#[derive(Debug, Default)]
pub struct Candidates {
    /// The chunks, by the slots of their first bodies.
    pub chunks: Vec<Chunk>,
}

impl Candidates {
    /// Empties the lists and cuts the cells into chunks.
    pub(super) fn begin<T: Real>(&mut self, grids: &[SearchedGrid<T>], starts: &[u32]) {
        let mut used = 0;
        for (number, searched) in grids.iter().enumerate() {
            let slot = |rank: u32| starts[(searched.first + rank) as usize] as usize;
            let all = searched.grid.len() as u32;
            let bodies = slot(all) - slot(0);
            let pieces = bodies.div_ceil(CHUNK) as u32;
            for piece in 0..pieces {
                let cut = |k: u32| (u64::from(all) * u64::from(k) / u64::from(pieces)) as u32;
                if used == self.chunks.len() {
                    self.chunks.push(Chunk::default());
                }
                let chunk = &mut self.chunks[used];
                chunk.grid = number;
                chunk.cells = cut(piece)..cut(piece + 1);
                chunk.bodies = slot(chunk.cells.start)..slot(chunk.cells.end);
                used += 1;
            }
        }
        self.chunks.truncate(used);
        self.chunks.iter_mut().for_each(Chunk::clear);
    }

    /// How many pairs are candidates.
    #[must_use]
    pub fn pair_count(&self) -> usize {
        self.chunks.iter().flat_map(|chunk| &chunk.pairs).map(Vec::len).sum()
    }

    /// How many candidates are bodies at fixed parts.
    #[must_use]
    pub fn at_parts_count(&self) -> usize {
        self.chunks.iter().flat_map(|chunk| &chunk.at_parts).map(AtParts::len).sum()
    }

    /// How many shells are to be tested when two bodies can have come `nearer`
    /// by this much since a search with this skin, lengths.
    pub fn shells_within<T: Real>(nearer: T, skin: T) -> usize {
        SHELLS - shell_ends(skin).iter().filter(|&&end| nearer < end).count()
    }

    /// The bytes that the lists hold in memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.chunks
            .iter()
            .map(|chunk| {
                let pairs: usize = chunk.pairs.iter().map(Vec::capacity).sum();
                let at_parts: usize = chunk.at_parts.iter().map(AtParts::bytes).sum();
                pairs * size_of::<Pair>() + at_parts
            })
            .sum()
    }
}

/// The greatest gaps of all shells of a skin but the last, lengths.
pub(super) fn shell_ends<T: Real>(skin: T) -> [T; SHELLS - 1] {
    let shell = skin / T::whole(SHELLS as i32);
    array::from_fn(|k| shell * T::whole(k as i32 + 1))
}

/// The shell that a gap is in.
#[inline(always)]
pub(super) fn shell<T: Real>(ends: &[T; SHELLS - 1], gap: T) -> usize {
    ends.iter().filter(|&&end| gap >= end).count()
}
