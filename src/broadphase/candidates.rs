//! Candidates: pairs of bodies, and bodies at fixed features, that may touch.

use core::ops::Range;

use super::grid::{Grid, Runs};
use crate::bodies::Figure;
use crate::lane::{Lane, Mask};
use crate::real::Real;
use crate::surroundings::{Feature, Space};
use crate::vec3::Vec3;

/// Bodies searched as one piece of work.
const CHUNK: usize = 2048;

/// Into how many shells the skin is cut. A pair need not be tested before its
/// bodies can have come through the shells between them; 8 spare about half of
/// all tests, more shells hardly another.
const SHELLS: usize = 8;

/// The places of two bodies.
pub type Pair = [u32; 2];

/// What one piece of the search has found, for the bodies of one range.
#[derive(Debug, Default)]
pub struct Chunk {
    /// The places of the bodies that were searched for.
    pub bodies: Range<usize>,
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
    /// Empties the lists and cuts `len` bodies into chunks.
    pub(super) fn begin(&mut self, len: usize, features: usize) {
        self.chunks.resize_with(len.div_ceil(CHUNK), Chunk::default);
        for (k, chunk) in self.chunks.iter_mut().enumerate() {
            chunk.bodies = k * CHUNK..((k + 1) * CHUNK).min(len);
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
        let shell = skin / T::whole(SHELLS as i32);
        (1..SHELLS).find(|&k| nearer < shell * T::whole(k as i32)).unwrap_or(SHELLS)
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
    pub shells_per_length: T,
    pub starts: &'a [u32],
    /// Coarsest first; the bodies of each stand behind those of the one before.
    pub grids: &'a [SearchedGrid<T>],
}

/// Shells in a length when the skin is cut into all of them.
pub(super) fn shells_per_length<T: Real>(skin: T) -> T {
    T::whole(SHELLS as i32) / skin
}

impl<T: Real, R: Figure<T>, S: Space<T>> Search<'_, T, R, S> {
    /// Finds the pairs of the chunk's bodies: with bodies of the same grid at
    /// later places, and with bodies of the coarser grids.
    pub fn pairs<L: Lane<Scalar = T>>(&self, chunk: &mut Chunk) {
        let mut places: Vec<Range<u32>> = Vec::new();
        for (level, searched) in self.grids.iter().enumerate() {
            let first = self.starts[searched.first as usize] as usize;
            let last = self.starts[searched.first as usize + searched.grid.len()] as usize;
            let mut current = None;
            for body in chunk.bodies.start.max(first)..chunk.bodies.end.min(last) {
                let point = self.point(body);
                let cell = searched.grid.cell(point);
                if current != Some(cell) {
                    current = Some(cell);
                    places.clear();
                    self.places_from(searched, cell, &mut places);
                }
                for run in &places {
                    let start = run.start.max(body as u32 + 1);
                    self.test::<L>(body, point, start..run.end, &mut chunk.pairs);
                }
                for coarser in &self.grids[..level] {
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

    /// The places in a cell and its neighbours that are not all before it.
    fn places_from(
        &self,
        searched: &SearchedGrid<T>,
        cell: [u32; 3],
        places: &mut Vec<Range<u32>>,
    ) {
        let own = searched.grid.rank(cell) - cell[0];
        searched.grid.for_each_neighbour_row(cell, |row, runs: Runs| {
            if row >= own {
                for run in runs {
                    let run = self.places(searched, run);
                    if !run.is_empty() {
                        places.push(run);
                    }
                }
            }
        });
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

    /// Tests one body against the bodies of a run of places.
    #[inline]
    fn test<L: Lane<Scalar = T>>(
        &self,
        body: usize,
        point: Vec3<T>,
        run: Range<u32>,
        pairs: &mut [Vec<Pair>; SHELLS],
    ) {
        let own_radius = L::splat(self.radius.load::<T>(body));
        let skin = L::splat(self.skin);
        let point = Vec3::<L>::splat(point);
        let mut start = run.start as usize;
        let end = run.end as usize;
        while start < end {
            // The columns are padded, but a run may start at any place.
            let [x, y, z] = self.position;
            let other = if start + L::WIDTH <= x.len() {
                Vec3::new(L::load(&x[start..]), L::load(&y[start..]), L::load(&z[start..]))
            } else {
                let tail = |column: &[T]| L::load_tail(&column[start..], T::ZERO);
                Vec3::new(tail(x), tail(y), tail(z))
            };
            let contact = own_radius + self.radius.load_tail::<L>(start);
            let reach = contact + skin;
            let distance_squared = self.space.nearest(point - other).length_squared();
            let mut near = distance_squared.lt(reach * reach).bits();
            if end - start < L::WIDTH {
                near &= (1 << (end - start)) - 1;
            }
            if near != 0 {
                let gap = distance_squared.sqrt() - contact;
                let shell = (gap * L::splat(self.shells_per_length)).to_array();
                while near != 0 {
                    let k = near.trailing_zeros();
                    let shell = shell.as_ref()[k as usize].whole_part().clamp(0, SHELLS as i64 - 1);
                    pairs[shell as usize].push([body as u32, start as u32 + k]);
                    near &= near - 1;
                }
            }
            start += L::WIDTH;
        }
    }

    /// Finds the bodies of the chunk that are near to a feature.
    pub fn surroundings<L: Lane<Scalar = T>>(&self, features: &[Feature<T>], chunk: &mut Chunk) {
        for (feature, near) in features.iter().zip(&mut chunk.at_feature) {
            // Chunks start at multiples of every width.
            for start in chunk.bodies.clone().step_by(L::WIDTH) {
                let [x, y, z] = self.position;
                let center =
                    Vec3::new(L::load(&x[start..]), L::load(&y[start..]), L::load(&z[start..]));
                let radius = self.radius.load::<L>(start);
                let gap = feature.clearance(center, radius).gap;
                let mut bits = gap.lt(L::splat(self.skin)).bits();
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
