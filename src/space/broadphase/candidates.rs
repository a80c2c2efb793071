//! Candidates: pairs of bodies, and bodies at fixed parts, that may touch; and the
//! search for the pairs.

use core::ops::Range;

use super::at_parts::AtParts;
use super::grid::Grid;
use crate::bodies::Figure;
use crate::lane::{Lane, Mask};
use crate::numbers::array;
use crate::real::Real;
use crate::space::Space;
use crate::vec3::Vec3;

/// Bodies searched as one piece of work.
const CHUNK: usize = 2048;

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
    grid: usize,
    cells: Range<u32>,
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

/// A grid and the rank of its first cell among all grids' cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct SearchedGrid<T> {
    pub grid: Grid<T>,
    pub first: u32,
}

/// A search in progress: bodies in the order of their cells.
pub(super) struct Search<'a, T> {
    pub position: [&'a [T]; 3],
    pub skin: T,
    pub shell_ends: [T; SHELLS - 1],
    pub starts: &'a [u32],
    /// Coarsest first; the bodies of each stand behind those of the one before.
    pub grids: &'a [SearchedGrid<T>],
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

/// The runs of slots around a cell: its own, and two of nine rows at most.
#[derive(Default)]
struct NearSlots {
    all: [Range<u32>; 19],
    count: usize,
}

impl NearSlots {
    #[inline(always)]
    fn push(&mut self, run: Range<u32>) {
        if !run.is_empty() {
            self.all[self.count] = run;
            self.count += 1;
        }
    }

    #[inline(always)]
    fn runs(&self) -> &[Range<u32>] {
        &self.all[..self.count]
    }
}

impl<T: Real> Search<'_, T> {
    /// Finds the pairs of the bodies in the chunk's cells: with bodies of the
    /// same grid at later slots, and with bodies of the coarser grids.
    pub fn pairs<L, R, S>(&self, radius: R, space: S, chunk: &mut Chunk)
    where
        L: Lane<Scalar = T>,
        R: Figure<T>,
        S: Space<T>,
    {
        let figures = (radius, space);
        let searched = &self.grids[chunk.grid];
        let mut slots = NearSlots::default();
        for rank in chunk.cells.clone() {
            let bodies = self.slots(searched, rank..rank + 1);
            if bodies.is_empty() {
                continue;
            }
            // The cell itself, then those of its neighbours that stand later.
            slots.count = 0;
            slots.push(bodies.clone());
            searched.grid.for_each_later_run(rank, |run| slots.push(self.slots(searched, run)));
            for body in bodies {
                let point = self.point(body as usize);
                for run in slots.runs() {
                    let start = run.start.max(body + 1);
                    self.test::<L, _, _>(figures, body, point, start..run.end, &mut chunk.pairs);
                }
                for coarser in &self.grids[..chunk.grid] {
                    let cell = coarser.grid.cell(point);
                    coarser.grid.for_each_neighbour_row(cell, |_, runs| {
                        for run in runs {
                            let run = self.slots(coarser, run);
                            self.test::<L, _, _>(figures, body, point, run, &mut chunk.pairs);
                        }
                    });
                }
            }
        }
    }

    /// The slots of the bodies in a run of cells.
    #[inline(always)]
    fn slots(&self, searched: &SearchedGrid<T>, run: Range<u32>) -> Range<u32> {
        if run.is_empty() {
            return 0..0;
        }
        let start = self.starts[(searched.first + run.start) as usize];
        start..self.starts[(searched.first + run.end) as usize]
    }

    #[inline(always)]
    fn point(&self, body: usize) -> Vec3<T> {
        Vec3::new(self.position[0][body], self.position[1][body], self.position[2][body])
    }

    /// The centres of the bodies from a slot on, zeros past the end.
    #[inline(always)]
    fn points<L: Lane<Scalar = T>>(&self, start: usize) -> Vec3<L> {
        // The columns are padded, but a run may start at any slot.
        let [x, y, z] = self.position;
        if start + L::WIDTH <= x.len() {
            Vec3::new(L::load(&x[start..]), L::load(&y[start..]), L::load(&z[start..]))
        } else {
            let tail = |column: &[T]| L::load_tail(&column[start..], T::ZERO);
            Vec3::new(tail(x), tail(y), tail(z))
        }
    }

    /// Tests one body against the bodies of a run of slots.
    #[inline(always)]
    fn test<L, R, S>(
        &self,
        (radius, space): (R, S),
        body: u32,
        point: Vec3<T>,
        run: Range<u32>,
        pairs: &mut [Vec<Pair>; SHELLS],
    ) where
        L: Lane<Scalar = T>,
        R: Figure<T>,
        S: Space<T>,
    {
        let own_radius = L::splat(radius.load::<T>(body as usize));
        let skin = L::splat(self.skin);
        let point = Vec3::<L>::splat(point);
        let mut start = run.start as usize;
        let end = run.end as usize;
        while start < end {
            let other = self.points(start);
            let contact = own_radius + radius.load_tail::<L>(start);
            let reach = contact + skin;
            let distance_squared = space.nearest(point - other).length_squared();
            let mut near = distance_squared.lt(reach * reach).bits();
            if end - start < L::WIDTH {
                near &= (1 << (end - start)) - 1;
            }
            if near != 0 {
                let gap = (distance_squared.sqrt() - contact).to_array();
                while near != 0 {
                    let k = near.trailing_zeros();
                    let gap = gap.as_ref()[k as usize];
                    let shell = shell(&self.shell_ends, gap);
                    pairs[shell].push([body, start as u32 + k]);
                    near &= near - 1;
                }
            }
            start += L::WIDTH;
        }
    }
}
