//! Pair search: which pairs of bodies may touch.
//!
//! The bodies around a few cells are put side by side once for all bodies in these, so that
//! packs are full. What is near is noted as bits, and read off for many bodies at once: where
//! bodies are decides about few branches.

use core::ops::Range;

use super::candidates::{Chunk, Pair, SHELLS, shell};
use super::grid::Grid;
use crate::bodies::Figure;
use crate::lane::{Lane, Mask};
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::space::Space;
use crate::vec3::Vec3;

/// Bodies put side by side before what is near is read off.
const BATCH: usize = 512;

/// Packs with something near that are kept before that, and tested at once, but for one body.
const MOST_HITS: usize = 4096;

/// Bodies of neighbouring cells from which on these are searched together.
const TOGETHER: u32 = 4;

/// The widest lane.
const WIDEST: usize = 16;

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

/// Which bodies of a pack are near another one.
#[derive(Clone, Copy, Default)]
struct Hit {
    body: u32,
    /// Where the pack begins.
    first: u32,
    /// A bit for each lane.
    near: u32,
}

/// The runs of slots around some cells: their own, and two of nine rows at most.
#[derive(Default)]
struct NearSlots {
    all: [Range<u32>; 19],
    count: usize,
}

impl NearSlots {
    #[inline(always)]
    fn push(&mut self, run: Range<u32>) {
        self.all[self.count] = run;
        self.count += 1;
    }

    #[inline(always)]
    fn runs(&self) -> &[Range<u32>] {
        &self.all[..self.count]
    }
}

/// Bodies side by side, and what has been found among them.
struct Around<T> {
    center: [Vec<T>; 3],
    radius: Vec<T>,
    slots: Vec<u32>,
    /// Where those begin that are tested now, and where they end.
    begun: usize,
    end: usize,
    hits: Vec<Hit>,
    hit_count: usize,
    /// The pairs, and their shells.
    found: Vec<Pair>,
    shells: Vec<u8>,
}

impl<T: Real> Around<T> {
    fn new() -> Self {
        Self {
            center: [(); 3].each(|()| Vec::new()),
            radius: Vec::new(),
            slots: Vec::new(),
            begun: 0,
            end: 0,
            hits: Vec::new(),
            hit_count: 0,
            found: Vec::new(),
            shells: Vec::new(),
        }
    }

    /// Makes room for another pack.
    #[inline(always)]
    fn grow(&mut self) {
        let end = self.end + WIDEST;
        if self.slots.len() < end {
            let len = 2 * end.max(BATCH);
            self.center.iter_mut().for_each(|column| column.resize(len, T::ZERO));
            self.radius.resize(len, T::ZERO);
            self.slots.resize(len, 0);
        }
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
        let grid = &searched.grid;
        let mut around = Around::new();
        let mut near = NearSlots::default();
        let mut cell = grid.cell_of_rank(chunk.cells.start);
        let mut rank = chunk.cells.start;
        while rank < chunk.cells.end {
            let start = self.starts[(searched.first + rank) as usize];
            let slot_after = |cells: u32| self.starts[(searched.first + rank + cells) as usize];
            // These cells, then those of their neighbours that stand later.
            let mut cells = 1;
            if slot_after(1) > start {
                let most = grid.inner_cells_from(cell).min(chunk.cells.end - rank);
                while cells < most && slot_after(cells) - start < TOGETHER {
                    cells += 1;
                }
                let bodies = start..slot_after(cells);
                near.count = 0;
                grid.for_each_run_from(rank..rank + cells, cell, |run| {
                    near.push(self.slots(searched, run));
                });
                self.gather::<L, _, _>(figures, &near, &mut around, &mut chunk.pairs);
                let found = &mut chunk.pairs;
                self.test::<L, _, _>(figures, bodies.clone(), 1, &mut around, found);
                for coarser in &self.grids[..chunk.grid] {
                    let mut last = None;
                    for body in bodies.clone() {
                        let found = &mut chunk.pairs;
                        let cell = coarser.grid.cell(self.point(body as usize));
                        // Most often that of the body before.
                        if last != Some(cell) {
                            last = Some(cell);
                            near.count = 0;
                            coarser.grid.for_each_neighbour_row(cell, |_, runs| {
                                for run in runs {
                                    near.push(self.slots(coarser, run));
                                }
                            });
                            self.gather::<L, _, _>(figures, &near, &mut around, found);
                        }
                        self.test::<L, _, _>(figures, body..body + 1, 0, &mut around, found);
                    }
                }
            }
            cell = grid.cell_after(cell, cells);
            rank += cells;
        }
        self.read_off(figures, &mut around, &mut chunk.pairs);
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

    /// Puts the bodies of some runs of slots side by side, whole packs at a time: what is
    /// beyond a run is overwritten by the next one, and in the end by what is near nothing.
    #[inline(always)]
    fn gather<L, R, S>(
        &self,
        (radius, space): (R, S),
        near: &NearSlots,
        around: &mut Around<T>,
        pairs: &mut [Vec<Pair>; SHELLS],
    ) where
        L: Lane<Scalar = T>,
        R: Figure<T>,
        S: Space<T>,
    {
        around.begun = around.end.next_multiple_of(L::WIDTH);
        if around.begun >= BATCH {
            self.read_off((radius, space), around, pairs);
            around.begun = 0;
        }
        around.end = around.begun;
        for run in near.runs() {
            let mut start = run.start;
            while start < run.end {
                around.grow();
                let at = around.end;
                let first = start as usize;
                // The columns are padded, but a run may start at any slot.
                if first + L::WIDTH <= self.position[0].len() {
                    let [x, y, z] = self.position.each(|column| L::load(&column[first..]));
                    put(Vec3::new(x, y, z), &mut around.center, at);
                } else {
                    self.put_last(first, &mut around.center, at);
                }
                if !R::IS_ONE {
                    radius.load_tail::<L>(first).store(&mut around.radius[at..]);
                }
                let slots = around.slots[at..].first_chunk_mut::<WIDEST>();
                if let Some(slots) = slots {
                    *slots = array::from_fn(|k| start + k as u32);
                }
                around.end = at + L::WIDTH.min((run.end - start) as usize);
                start += L::WIDTH as u32;
            }
        }
        around.grow();
        let beyond = L::ONE / L::ZERO;
        put(Vec3::new(beyond, beyond, beyond), &mut around.center, around.end);
    }

    /// Puts the last bodies side by side.
    #[cold]
    #[inline(never)]
    fn put_last(&self, first: usize, center: &mut [Vec<T>; 3], at: usize) {
        for (column, values) in center.iter_mut().zip(self.position) {
            for (element, &value) in column[at..].iter_mut().zip(&values[first..]) {
                *element = value;
            }
        }
    }

    /// Tests bodies against those side by side: the first one from the number `from` on,
    /// the others each from the next one on.
    #[inline(always)]
    fn test<L, R, S>(
        &self,
        figures: (R, S),
        mut bodies: Range<u32>,
        mut from: usize,
        around: &mut Around<T>,
        pairs: &mut [Vec<Pair>; SHELLS],
    ) where
        L: Lane<Scalar = T>,
        R: Figure<T>,
        S: Space<T>,
    {
        let packs = (around.end - around.begun).div_ceil(L::WIDTH);
        while !bodies.is_empty() {
            let mut now = bodies.clone();
            if packs * now.len() > MOST_HITS {
                now.end = now.end.min(now.start + (MOST_HITS / packs).max(1) as u32);
            }
            if around.hit_count > MOST_HITS {
                self.read_off(figures, around, pairs);
            }
            bodies.start = now.end;
            let count = now.len();
            self.test_some::<L, _, _>(figures, now, from, around);
            from += count;
        }
    }

    #[inline(always)]
    fn test_some<L, R, S>(
        &self,
        (radius, space): (R, S),
        bodies: Range<u32>,
        from: usize,
        around: &mut Around<T>,
    ) where
        L: Lane<Scalar = T>,
        R: Figure<T>,
        S: Space<T>,
    {
        let Around { center, radius: radii, begun, end, hits, hit_count, .. } = around;
        let packs = (*end - *begun).div_ceil(L::WIDTH);
        let most = *hit_count + packs * bodies.len();
        if hits.len() <= most {
            hits.resize(2 * most + 1, Hit::default());
        }
        let side_by_side = *begun..*begun + packs * L::WIDTH;
        let [x, y, z] =
            center.refs().each(|column| &L::arrays(&column[side_by_side.clone()]).0[..packs]);
        for (from, body) in (from..).zip(bodies) {
            let own = L::splat(radius.load::<T>(body as usize));
            let point = Vec3::<L>::splat(self.point(body as usize));
            let mut counted = u32::MAX << (from % L::WIDTH);
            for pack in from / L::WIDTH..packs {
                let first = *begun + pack * L::WIDTH;
                let other = if R::IS_ONE { radius.load(0) } else { L::load(&radii[first..]) };
                let reach = own + other + L::splat(self.skin);
                let offset = point - Vec3::from_arrays([x[pack], y[pack], z[pack]]);
                let distance_squared = space.nearest(offset).length_squared();
                let near = distance_squared.lt(reach * reach).bits() & counted;
                hits[*hit_count] = Hit { body, first: first as u32, near };
                // Kept if there is anything.
                *hit_count += usize::from(near != 0);
                counted = u32::MAX;
            }
        }
    }

    /// Adds the pairs that have been found. In three passes, so that no store has to wait for
    /// a distance.
    #[inline(never)]
    fn read_off<R, S>(
        &self,
        (radius, space): (R, S),
        around: &mut Around<T>,
        pairs: &mut [Vec<Pair>; SHELLS],
    ) where
        R: Figure<T>,
        S: Space<T>,
    {
        let Around { slots, hits, hit_count, found, shells, .. } = around;
        let hits = &mut hits[..*hit_count];
        found.clear();
        let mut at = 0;
        while let Some(hit) = hits.get_mut(at) {
            found.push([hit.body, slots[(hit.first + hit.near.trailing_zeros()) as usize]]);
            hit.near &= hit.near - 1;
            at += usize::from(hit.near == 0);
        }
        *hit_count = 0;
        shells.clear();
        shells.extend(found.iter().map(|pair| {
            let [one, another] = pair.each(|slot| slot as usize);
            let distance = space.nearest(self.point(one) - self.point(another)).length();
            let gap = distance - (radius.load::<T>(one) + radius.load::<T>(another));
            shell(&self.shell_ends, gap) as u8
        }));
        for (&pair, &shell) in found.iter().zip(shells.iter()) {
            pairs[shell as usize].push(pair);
        }
    }
}

/// Writes points from a place on.
#[inline(always)]
fn put<L: Lane>(points: Vec3<L>, columns: &mut [Vec<L::Scalar>; 3], at: usize) {
    let [x, y, z] = columns;
    points.x.store(&mut x[at..]);
    points.y.store(&mut y[at..]);
    points.z.store(&mut z[at..]);
}
