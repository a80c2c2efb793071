//! Candidates: pairs of bodies, and bodies at fixed parts, that may touch.

use core::ops::Range;

use super::grid::Grid;
use crate::bodies::Figure;
use crate::lane::{Lane, Mask};
use crate::real::Real;
use crate::space::{Bounds, FixedParts, Space, Tree, joined};
use crate::vec3::Vec3;

/// Bodies searched as one piece of work.
const CHUNK: usize = 2048;

/// Into how many shells the skin is cut. A pair need not be tested before its
/// bodies can have come through the shells between them; 4 spare nearly half of
/// all tests, 8 a twentieth more.
const SHELLS: usize = 4;

/// So few fixed parts are each tested against all bodies; of more, the tree says
/// which are near.
pub(super) const FEW_PARTS: usize = 8;

/// A pack of bodies is looked at as one if its box is at most so much wider than
/// that of its first body. In a dilute system, where bodies far apart share
/// cells, few packs are.
const COMPACT: i32 = 4;

/// The slots of two bodies.
pub type Pair = [u32; 2];

/// What one piece of the search has found, for the bodies of one range.
#[derive(Debug, Default)]
pub struct Chunk {
    /// The grid that was searched, and its cells, by rank.
    grid: usize,
    cells: Range<u32>,
    /// The slots of the bodies in these cells.
    bodies: Range<usize>,
    /// Pairs whose surfaces were nearer than the skin, by the shell that their
    /// gap was in, innermost first.
    pub pairs: [Vec<Pair>; SHELLS],
    /// The bodies whose surfaces were nearer than the skin to fixed parts, part
    /// by part.
    at_parts: Vec<u32>,
    /// Each such part, and where its bodies end.
    parts: Vec<(u32, usize)>,
}

impl Chunk {
    /// Empties the lists.
    pub fn clear(&mut self) {
        self.pairs.iter_mut().for_each(Vec::clear);
        self.at_parts.clear();
        self.parts.clear();
    }

    /// The fixed parts that bodies may touch, and the slots of those bodies.
    pub fn at_parts(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let mut start = 0;
        self.parts.iter().map(move |&(part, end)| {
            let bodies = &self.at_parts[start..end];
            start = end;
            (part, bodies)
        })
    }

    /// Adds a pair that may touch at once.
    pub fn add_pair(&mut self, pair: Pair) {
        self.pairs[0].push(pair);
    }

    /// Adds a body that may touch a fixed part.
    pub fn add_at_part(&mut self, part: u32, body: u32) {
        self.at_parts.push(body);
        self.end_part(part);
    }

    /// Fills the pairs that may touch at once up to a multiple of `width`, with one
    /// that never does.
    pub fn fill_up(&mut self, width: usize, pair: Pair) {
        let whole = self.pairs[0].len().next_multiple_of(width);
        self.pairs[0].resize(whole, pair);
    }

    /// Ends the bodies of a part.
    fn end_part(&mut self, part: u32) {
        let start = self.parts.last().map_or(0, |last| last.1);
        if self.at_parts.len() > start {
            self.parts.push((part, self.at_parts.len()));
        }
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
        self.chunks.iter().map(|chunk| chunk.at_parts.len()).sum()
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
                pairs * size_of::<Pair>()
                    + chunk.at_parts.capacity() * size_of::<u32>()
                    + chunk.parts.capacity() * size_of::<(u32, usize)>()
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
pub(super) struct Search<'a, T, R, S> {
    pub position: [&'a [T]; 3],
    pub radius: R,
    pub space: S,
    pub skin: T,
    pub shell_ends: [T; SHELLS - 1],
    pub starts: &'a [u32],
    /// Coarsest first; the bodies of each stand behind those of the one before.
    pub grids: &'a [SearchedGrid<T>],
}

/// The greatest gaps of all shells of a skin but the last, lengths.
pub(super) fn shell_ends<T: Real>(skin: T) -> [T; SHELLS - 1] {
    let shell = skin / T::whole(SHELLS as i32);
    core::array::from_fn(|k| shell * T::whole(k as i32 + 1))
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

impl<T: Real, R: Figure<T>, S: Space<T>> Search<'_, T, R, S> {
    /// Finds the pairs of the bodies in the chunk's cells: with bodies of the
    /// same grid at later slots, and with bodies of the coarser grids.
    pub fn pairs<L: Lane<Scalar = T>>(&self, chunk: &mut Chunk) {
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
                    self.test::<L>(body, point, start..run.end, &mut chunk.pairs);
                }
                for coarser in &self.grids[..chunk.grid] {
                    let cell = coarser.grid.cell(point);
                    coarser.grid.for_each_neighbour_row(cell, |_, runs| {
                        for run in runs {
                            let run = self.slots(coarser, run);
                            self.test::<L>(body, point, run, &mut chunk.pairs);
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
    fn test<L: Lane<Scalar = T>>(
        &self,
        body: u32,
        point: Vec3<T>,
        run: Range<u32>,
        pairs: &mut [Vec<Pair>; SHELLS],
    ) {
        let own_radius = L::splat(self.radius.load::<T>(body as usize));
        let skin = L::splat(self.skin);
        let point = Vec3::<L>::splat(point);
        let mut start = run.start as usize;
        let end = run.end as usize;
        while start < end {
            let other = self.points(start);
            let contact = own_radius + self.radius.load_tail::<L>(start);
            let reach = contact + skin;
            let distance_squared = self.space.nearest(point - other).length_squared();
            let mut near = distance_squared.lt(reach * reach).bits();
            if end - start < L::WIDTH {
                near &= (1 << (end - start)) - 1;
            }
            if near != 0 {
                let gap = (distance_squared.sqrt() - contact).to_array();
                while near != 0 {
                    let k = near.trailing_zeros();
                    let gap = gap.as_ref()[k as usize];
                    let shell = self.shell_ends.iter().filter(|&&end| gap >= end).count();
                    pairs[shell].push([body, start as u32 + k]);
                    near &= near - 1;
                }
            }
            start += L::WIDTH;
        }
    }

    /// Finds the bodies of the chunk that are near to a fixed part, themselves or
    /// where the periodic box puts them when they leave it.
    pub fn at_parts<L, P>(&self, parts: &P, tree: &Tree<T>, chunk: &mut Chunk)
    where
        L: Lane<Scalar = T>,
        P: FixedParts<T> + ?Sized,
    {
        let images = self.space.images();
        if tree.len() <= FEW_PARTS {
            for part in 0..parts.count() as u32 {
                self.sweep::<L, P>(parts, part, &images, chunk);
            }
            return;
        }
        for &part in tree.endless() {
            self.sweep::<L, P>(parts, part, &images, chunk);
        }
        let mut found = Vec::new();
        for start in chunk.bodies.clone().step_by(L::WIDTH) {
            let bodies = start..chunk.bodies.end.min(start + L::WIDTH);
            let one = self.bounds(start..start + 1);
            let all = self.bounds(bodies.clone());
            let is_compact = is_within(all, one, T::whole(COMPACT));
            for &image in &images {
                if is_compact {
                    self.test_parts::<L, P>(parts, tree, all, bodies.clone(), image, &mut found);
                    continue;
                }
                for body in bodies.clone() {
                    let body = body..body + 1;
                    let bounds = self.bounds(body.clone());
                    self.test_parts::<T, P>(parts, tree, bounds, body, image, &mut found);
                }
            }
        }
        // Two images of a body may be near to a part.
        found.sort_unstable();
        found.dedup();
        for of_part in found.chunk_by(|a, b| a.0 == b.0) {
            chunk.at_parts.extend(of_part.iter().map(|&(_, body)| body));
            chunk.end_part(of_part[0].0);
        }
    }

    /// Tests all bodies of the chunk against one part.
    fn sweep<L, P>(&self, parts: &P, part: u32, images: &[Vec3<T>], chunk: &mut Chunk)
    where
        L: Lane<Scalar = T>,
        P: FixedParts<T> + ?Sized,
    {
        for start in chunk.bodies.clone().step_by(L::WIDTH) {
            let center = self.points::<L>(start);
            let radius = self.radius.load_tail::<L>(start);
            let is_near = |image: &Vec3<T>| {
                let gap = parts.gap(part as usize, center + Vec3::splat(*image), radius);
                gap.lt(L::splat(self.skin)).bits()
            };
            let mut bits = images.iter().map(is_near).fold(0, |all, bits| all | bits);
            while bits != 0 {
                let body = start as u32 + bits.trailing_zeros();
                if (body as usize) < chunk.bodies.end {
                    chunk.at_parts.push(body);
                }
                bits &= bits - 1;
            }
        }
        chunk.end_part(part);
    }

    /// Tests an image of up to a pack of bodies, which fill `bounds`, against the
    /// parts near to it.
    fn test_parts<L, P>(
        &self,
        parts: &P,
        tree: &Tree<T>,
        bounds: Bounds<T>,
        bodies: Range<usize>,
        image: Vec3<T>,
        found: &mut Vec<(u32, u32)>,
    ) where
        L: Lane<Scalar = T>,
        P: FixedParts<T> + ?Sized,
    {
        tree.for_each(bounds.map(|corner| corner + image), |part| {
            let mut bits = self.near_part::<L, P>(parts, part, &bodies, image);
            while bits != 0 {
                found.push((part, bodies.start as u32 + bits.trailing_zeros()));
                bits &= bits - 1;
            }
        });
    }

    /// Which of up to a pack of bodies are near to a part.
    #[inline(always)]
    fn near_part<L, P>(&self, parts: &P, part: u32, bodies: &Range<usize>, image: Vec3<T>) -> u32
    where
        L: Lane<Scalar = T>,
        P: FixedParts<T> + ?Sized,
    {
        let center = self.points::<L>(bodies.start) + Vec3::splat(image);
        let gap = parts.gap(part as usize, center, self.radius.load_tail::<L>(bodies.start));
        let near = gap.lt(L::splat(self.skin)).bits();
        if bodies.len() < L::WIDTH { near & ((1 << bodies.len()) - 1) } else { near }
    }

    /// The box that some bodies and their skin fill.
    fn bounds(&self, bodies: Range<usize>) -> Bounds<T> {
        let of = |body: usize| {
            let center = self.point(body);
            let reach = self.radius.load::<T>(body) + self.skin;
            let reach = Vec3::new(reach, reach, reach);
            [center - reach, center + reach]
        };
        let start = bodies.start;
        bodies.skip(1).map(of).fold(of(start), joined)
    }
}

/// Whether a box is at most `times` as wide as another one along each axis.
fn is_within<T: Real>(all: Bounds<T>, one: Bounds<T>, times: T) -> bool {
    let [all, one] = [all, one].map(|[lower, upper]| (upper - lower).to_array());
    (0..3).all(|k| all[k] <= one[k] * times)
}
