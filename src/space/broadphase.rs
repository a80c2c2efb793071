//! Broad phase: which bodies can touch before the next search.
//!
//! A search sorts the bodies by the cells of a uniform grid, so that neighbours
//! in space become neighbours in memory, and remembers every pair nearer than
//! the *skin* and every body as near to a fixed feature. Until bodies have
//! moved through half the skin these candidates are all that can touch. Bodies
//! of very different sizes are sorted into one grid for each factor of two in
//! the radius; a pair is found from the smaller one. Cost and memory are linear
//! in the bodies, wherever they are.
//!
//! The contacts that the narrow phase finds among the candidates do not depend
//! on the skin, the grid or the order of the bodies.

mod at_parts;
mod candidates;
mod grid;
mod pair_search;
mod skin;

use at_parts::{FEW_PARTS, PartSearch};
use candidates::shell_ends;
pub use candidates::{Candidates, Chunk, Pair};
use grid::Grid;
use pair_search::{Search, SearchedGrid};
use skin::{best_skin, neighbours};

use crate::bodies::{Columns3, PerBody, Same};
use crate::lane::Lane;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::rows::{Hands, Rows};
use crate::space::sizes::{class, classes};
use crate::space::{FixedParts, OpenSpace, PeriodicBox, Space, Tree};
use crate::vec3::Vec3;
use crate::workers::Workers;

/// What the first search goes by: bodies in a diameter cubed, and the widest
/// skin in diameters.
const FIRST_DENSITY: f64 = 0.2;
const FIRST_SKIN: f64 = 0.5;

/// The widest skin for what may have met within a step: as many neighbours as a
/// body may have in it, but no less than this number of mean diameters; and how many
/// bodies do not need it: that few can all be candidates of each other.
const MOST_NEIGHBOURS: f64 = 128.0;
const LEAST_SWEPT: f64 = 4.0;
const FEW: usize = 256;

/// Bodies whose cells are found as one piece of work.
const RANKED: usize = 1 << 11;

/// What a search looks at.
#[derive(Debug)]
pub struct Surveyed<'a, T: Real, P: ?Sized> {
    /// Centres, length.
    pub position: &'a Columns3<T>,
    /// Radii, length.
    pub radius: &'a PerBody<T>,
    /// The periodic box, if there is one.
    pub periodic: Option<PeriodicBox<T>>,
    /// What is fixed: the parts that the broad phase was made for.
    pub parts: &'a P,
    /// Whether bodies meet each other.
    pub pairs: bool,
}

/// The search for candidates, with the memory that it works in.
#[derive(Debug)]
pub struct BroadPhase<T: Real> {
    /// The greatest radius of each grid, coarsest first.
    reaches: Vec<T>,
    grids: Vec<(Grid<T>, u32)>,
    ranks: Vec<u32>,
    /// The bodies in each cell, by their slots before they are put in order.
    order: Rows,
    /// The boxes of the fixed parts that have no hierarchy of their own.
    tree: Tree<T>,
    /// Whether there are others.
    has_more_parts: bool,
    /// The greatest coordinate at the last search, length.
    farthest: T,
    /// Bodies and fixed parts, if they are many, in a diameter cubed, seen at the
    /// last search.
    density: Option<f64>,
    mean_diameter: f64,
    len: usize,
}

impl<T: Real> BroadPhase<T> {
    /// A broad phase for bodies with these radii among what is fixed.
    #[must_use]
    pub fn new<P: FixedParts<T> + ?Sized>(radius: &PerBody<T>, len: usize, parts: &P) -> Self {
        let reaches = match radius {
            PerBody::Same(value) => vec![*value],
            PerBody::Each(column) => classes(column),
        };
        let sum: f64 = (0..len).map(|k| radius.of(k).to_f64()).sum();
        Self {
            reaches,
            grids: Vec::new(),
            ranks: Vec::new(),
            order: Rows::default(),
            tree: Tree::new((0..parts.alone()).map(|part| parts.bounds(part))),
            has_more_parts: parts.alone() < parts.count(),
            farthest: T::ZERO,
            density: None,
            mean_diameter: 2.0 * sum / len.max(1) as f64,
            len,
        }
    }

    /// The skin to search with when bodies move through `travel` in a step at
    /// most and the last search was done with the skin `last`, lengths.
    #[must_use]
    pub fn skin(&self, travel: T, last: T) -> T {
        let diameter = self.mean_diameter;
        let best = match self.density {
            None => best_skin(travel.to_f64() / diameter, FIRST_DENSITY).min(FIRST_SKIN),
            // The density is only known as far as the last search went.
            Some(density) => {
                let best = best_skin(travel.to_f64() / diameter, density);
                best.min(2.0 * last.to_f64() / diameter)
            }
        };
        T::from_f64(diameter * best)
    }

    /// Whether there are enough bounded fixed parts that a body with a wide skin
    /// is near to many.
    #[must_use]
    pub fn has_many_parts(&self) -> bool {
        self.has_more_parts || self.tree.len() > FEW_PARTS
    }

    /// By how much the rounding of a coordinate can move a body in a step, length.
    #[must_use]
    pub fn rounding(&self) -> T {
        self.farthest * T::EPSILON
    }

    /// The skin that finds all pairs that can have met while bodies moved this way
    /// at most, length; complete up to the [longest](Self::longest_way) one.
    #[must_use]
    pub fn swept(&self, way: T) -> T {
        let swept = way * T::ratio(9, 4);
        if self.len <= FEW { swept } else { swept.lesser(self.most_swept()) }
    }

    /// The longest way of bodies, length, for which one search can find all that
    /// they may have met; `None` if any.
    #[must_use]
    pub fn longest_way(&self, pairs: bool) -> Option<T> {
        let is_any = self.len <= FEW || !(pairs || self.has_many_parts());
        (!is_any).then(|| self.most_swept() * T::ratio(4, 9))
    }

    /// The widest skin for what may have met, length.
    fn most_swept(&self) -> T {
        let mut swept = LEAST_SWEPT;
        if let Some(density) = self.density {
            while neighbours(density, 1.25 * swept) < MOST_NEIGHBOURS && swept < 1e6 {
                swept *= 1.25;
            }
        }
        T::from_f64(self.mean_diameter * swept)
    }

    /// The greatest radius of all bodies, length.
    #[must_use]
    pub fn greatest_radius(&self) -> T {
        self.reaches.first().copied().unwrap_or(T::ZERO)
    }

    /// What the rounding of a coordinate may come to in distances, length.
    fn margin(&self) -> T {
        self.rounding() * T::whole(16)
    }

    /// Sorts the bodies into cells for a search with this skin. Body `k` of the
    /// order that is returned is the one to be put into slot `k`.
    pub fn sort<P: Sync + ?Sized>(
        &mut self,
        surveyed: &Surveyed<'_, T, P>,
        skin: T,
        workers: &Workers,
    ) -> &[u32] {
        let len = surveyed.position[0].len();
        let (lower, upper) = bounds(surveyed.position, workers);
        // A margin for the rounding of coordinates far from the origin.
        let farthest = lower
            .to_array()
            .into_iter()
            .chain(upper.to_array())
            .fold(T::ZERO, |most, c| Lane::abs(c).greater(most));
        self.farthest = farthest;
        let margin = self.margin();

        let mut class_counts = vec![0_usize; self.reaches.len()];
        match &mut class_counts[..] {
            [all] => *all = len,
            counts => {
                (0..len).for_each(|k| counts[class(&self.reaches, surveyed.radius.of(k))] += 1);
            }
        }
        self.grids.clear();
        let mut first = 0;
        for (&reach, &count) in self.reaches.iter().zip(&class_counts) {
            let side = (reach + reach + skin) * T::ratio(1025, 1024) + margin;
            let most = 2 * count + 27;
            let grid = match &surveyed.periodic {
                Some(space) => Grid::periodic(space, side, most),
                None => Grid::open(lower, upper, side, most),
            };
            self.grids.push((grid, first));
            first += grid.len() as u32;
        }

        let mut ranks = core::mem::take(&mut self.ranks);
        ranks.resize(len, 0);
        let mut chunks: Vec<_> = ranks.chunks_mut(RANKED).enumerate().collect();
        let (grids, reaches) = (&self.grids[..], &self.reaches[..]);
        let position = surveyed.position.refs().each(|column| &column[..]);
        workers.each(&mut chunks, |(chunk, ranks)| {
            let start = *chunk * RANKED;
            let [x, y, z] = position.each(|column| &column[start..start + ranks.len()]);
            for (k, rank) in ranks.iter_mut().enumerate() {
                let (grid, first) = &grids[class(reaches, surveyed.radius.of(start + k))];
                *rank = first + grid.rank(grid.cell(Vec3::new(x[k], y[k], z[k])));
            }
        });
        let sources: Vec<_> = (0..).step_by(RANKED).zip(ranks.chunks(RANKED)).collect();
        let deal = |&(first, ranks): &(u32, &[u32]), hands: &mut Hands| {
            (first..).zip(ranks).for_each(|(body, &rank)| hands.deal(rank, body));
        };
        self.order.fill(first as usize, &sources, deal, workers);
        self.ranks = ranks;
        &self.order.all
    }

    /// Finds the candidates of a skin among bodies that stand in the order of
    /// the last [`sort`](BroadPhase::sort).
    pub fn search<L: Lane<Scalar = T>, P: FixedParts<T> + ?Sized>(
        &mut self,
        surveyed: &Surveyed<'_, T, P>,
        skin: T,
        candidates: &mut Candidates,
        workers: &Workers,
    ) {
        let grids: Vec<_> =
            self.grids.iter().map(|&(grid, first)| SearchedGrid { grid, first }).collect();
        candidates.begin(&grids, &self.order.starts);
        let position = surveyed.position.refs().each(|column| column.padded());
        let search = Search {
            position,
            skin,
            shell_ends: shell_ends(skin),
            starts: &self.order.starts,
            grids: &grids,
        };
        let images = surveyed.periodic.map_or_else(|| OpenSpace.images(), Space::images);
        let part_search = PartSearch {
            position,
            radius: surveyed.radius,
            greatest_radius: self.greatest_radius(),
            margin: self.margin(),
            images: &images,
            skin,
            shell_ends: shell_ends(skin),
            parts: surveyed.parts,
            tree: &self.tree,
        };
        workers.each(&mut candidates.chunks, |chunk| {
            if surveyed.pairs {
                match (surveyed.radius, surveyed.periodic) {
                    (PerBody::Same(r), None) => search.pairs::<L, _, _>(Same(*r), OpenSpace, chunk),
                    (PerBody::Same(r), Some(space)) => {
                        search.pairs::<L, _, _>(Same(*r), space, chunk);
                    }
                    (PerBody::Each(r), None) => {
                        search.pairs::<L, _, _>(r.padded(), OpenSpace, chunk);
                    }
                    (PerBody::Each(r), Some(space)) => {
                        search.pairs::<L, _, _>(r.padded(), space, chunk);
                    }
                }
            }
            part_search.search::<L>(chunk.bodies.clone(), chunk);
        });
        let at_parts = if self.has_many_parts() { candidates.at_parts_count() } else { 0 };
        if surveyed.pairs || at_parts > 0 {
            let found = candidates.pair_count() + at_parts;
            let found = found as f64 / surveyed.position[0].len() as f64;
            let skin = skin.to_f64() / self.mean_diameter;
            self.density = Some(found / neighbours(1.0, skin));
        }
    }

    /// The bytes that the search works in.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.ranks.as_slice()) + self.order.bytes() + self.tree.bytes()
    }
}

/// The corners of the smallest box around all points.
fn bounds<T: Real>(position: &Columns3<T>, workers: &Workers) -> (Vec3<T>, Vec3<T>) {
    type Pack<T> = <T as Real>::Pack16;
    let bounds = position.refs().each(|column| {
        let first = column.first().copied().unwrap_or(T::ZERO);
        let mut chunks: Vec<_> = column.chunks(RANKED).map(|chunk| (chunk, [first; 2])).collect();
        workers.each(&mut chunks, |(chunk, ends)| {
            let (packs, tail) = Pack::<T>::arrays(chunk);
            let mut packed = [Pack::<T>::splat(first); 2];
            for &pack in packs {
                packed = widened(packed, Pack::<T>::from_array(pack));
            }
            let packed = packed.each(Lane::to_array);
            let each = packed.iter().flat_map(|ends| ends.as_ref()).chain(tail);
            *ends = each.fold([first; 2], |ends, &c| widened(ends, c));
        });
        let ends = chunks.iter().flat_map(|(_, ends)| ends);
        ends.fold([first; 2], |all, &c| widened(all, c))
    });
    let [x, y, z] = bounds;
    (Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1]))
}

/// The least and the greatest of what they are and another one.
#[inline(always)]
fn widened<L: Lane>([least, most]: [L; 2], other: L) -> [L; 2] {
    [other.lesser(least), other.greater(most)]
}
