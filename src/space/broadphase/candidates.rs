//! Candidates: pairs of bodies, and bodies at fixed features, that may touch.

use core::ops::Range;

use super::grid::Grid;
use crate::bodies::Figure;
use crate::lane::{Lane, Mask};
use crate::real::Real;
use crate::space::Space;
use crate::surroundings::Feature;
use crate::vec3::Vec3;

/// Bodies searched as one piece of work.
const CHUNK: usize = 2048;

/// Into how many shells the skin is cut. A pair need not be tested before its
/// bodies can have come through the shells between them; 4 spare nearly half of
/// all tests, 8 a twentieth more.
const SHELLS: usize = 4;

/// The places of two bodies.
pub type Pair = [u32; 2];

/// What one piece of the search has found, for the bodies of one range.
#[derive(Debug, Default)]
pub struct Chunk {
    /// The grid that was searched, and its cells, by rank.
    grid: usize,
    cells: Range<u32>,
    /// The places of the bodies in these cells.
    bodies: Range<usize>,
    /// Pairs whose surfaces were nearer than the skin, by the shell that their
    /// gap was in, innermost first.
    pub pairs: [Vec<Pair>; SHELLS],
    /// For each feature, the bodies whose surfaces were nearer than the skin.
    pub at_feature: Vec<Vec<u32>>,
}

/// All candidates, in chunks that do not depend on the number of threads.
#[derive(Debug, Default)]
pub struct Candidates {
    /// The chunks, by the places of their first bodies.
    pub chunks: Vec<Chunk>,
}

impl Candidates {
    /// Empties the lists and cuts the cells into chunks.
    pub(super) fn begin<T: Real>(
        &mut self,
        grids: &[SearchedGrid<T>],
        starts: &[u32],
        features: usize,
    ) {
        let mut used = 0;
        for (number, searched) in grids.iter().enumerate() {
            let place = |rank: u32| starts[(searched.first + rank) as usize] as usize;
            let all = searched.grid.len() as u32;
            let bodies = place(all) - place(0);
            let pieces = bodies.div_ceil(CHUNK) as u32;
            for piece in 0..pieces {
                let cut = |k: u32| (u64::from(all) * u64::from(k) / u64::from(pieces)) as u32;
                if used == self.chunks.len() {
                    self.chunks.push(Chunk::default());
                }
                let chunk = &mut self.chunks[used];
                chunk.grid = number;
                chunk.cells = cut(piece)..cut(piece + 1);
                chunk.bodies = place(chunk.cells.start)..place(chunk.cells.end);
                used += 1;
            }
        }
        self.chunks.truncate(used);
        for chunk in &mut self.chunks {
            chunk.pairs.iter_mut().for_each(Vec::clear);
            chunk.at_feature.resize_with(features, Vec::new);
            chunk.at_feature.iter_mut().for_each(Vec::clear);
        }
    }

    /// How many pairs are candidates.
    #[must_use]
    pub fn pair_count(&self) -> usize {
        self.chunks.iter().flat_map(|chunk| &chunk.pairs).map(Vec::len).sum()
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
                let near: usize = chunk.at_feature.iter().map(Vec::capacity).sum();
                pairs * size_of::<Pair>() + near * size_of::<u32>()
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

/// The runs of places around a cell: its own, and two of nine rows at most.
#[derive(Default)]
struct NearPlaces {
    all: [Range<u32>; 19],
    count: usize,
}

impl NearPlaces {
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
    /// same grid at later places, and with bodies of the coarser grids.
    pub fn pairs<L: Lane<Scalar = T>>(&self, chunk: &mut Chunk) {
        let searched = &self.grids[chunk.grid];
        let mut places = NearPlaces::default();
        for rank in chunk.cells.clone() {
            let bodies = self.places(searched, rank..rank + 1);
            if bodies.is_empty() {
                continue;
            }
            // The cell itself, then those of its neighbours that stand later.
            places.count = 0;
            places.push(bodies.clone());
            searched.grid.for_each_later_run(rank, |run| places.push(self.places(searched, run)));
            for body in bodies {
                let point = self.point(body as usize);
                for run in places.runs() {
                    let start = run.start.max(body + 1);
                    self.test::<L>(body, point, start..run.end, &mut chunk.pairs);
                }
                for coarser in &self.grids[..chunk.grid] {
                    let cell = coarser.grid.cell(point);
                    coarser.grid.for_each_neighbour_row(cell, |_, runs| {
                        for run in runs {
                            let run = self.places(coarser, run);
                            self.test::<L>(body, point, run, &mut chunk.pairs);
                        }
                    });
                }
            }
        }
    }

    /// The places of the bodies in a run of cells.
    #[inline(always)]
    fn places(&self, searched: &SearchedGrid<T>, run: Range<u32>) -> Range<u32> {
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

    /// The centres of the bodies from a place on, zeros past the end.
    #[inline(always)]
    fn points<L: Lane<Scalar = T>>(&self, start: usize) -> Vec3<L> {
        // The columns are padded, but a run may start at any place.
        let [x, y, z] = self.position;
        if start + L::WIDTH <= x.len() {
            Vec3::new(L::load(&x[start..]), L::load(&y[start..]), L::load(&z[start..]))
        } else {
            let tail = |column: &[T]| L::load_tail(&column[start..], T::ZERO);
            Vec3::new(tail(x), tail(y), tail(z))
        }
    }

    /// Tests one body against the bodies of a run of places.
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

    /// Finds the bodies of the chunk that are near to a feature, themselves or
    /// where the periodic box puts them when they leave it.
    pub fn surroundings<L: Lane<Scalar = T>>(&self, features: &[Feature<T>], chunk: &mut Chunk) {
        let images = self.space.images();
        for (feature, near) in features.iter().zip(&mut chunk.at_feature) {
            for start in chunk.bodies.clone().step_by(L::WIDTH) {
                let center = self.points(start);
                let radius = self.radius.load_tail::<L>(start);
                let is_near = |image: &Vec3<T>| {
                    let gap = feature.clearance(center + Vec3::splat(*image), radius).gap;
                    gap.lt(L::splat(self.skin)).bits()
                };
                let mut bits = images.iter().map(is_near).fold(0, |all, bits| all | bits);
                while bits != 0 {
                    let body = start as u32 + bits.trailing_zeros();
                    if (body as usize) < chunk.bodies.end {
                        near.push(body);
                    }
                    bits &= bits - 1;
                }
            }
        }
    }
}
