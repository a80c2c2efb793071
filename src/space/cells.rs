//! Cells: what is near what.
//!
//! Space is cut into cells no smaller than the greatest diameter, so that two
//! bodies can only touch if their cells are neighbours. Which bodies are in a cell
//! is kept up as they cross from one to the next.

mod axis;
mod members;
mod span;

pub(crate) use axis::Ends;
use axis::{Axis, BLOCK, Line, WIDE, count, number, numbers};
use members::Spilled;
pub(crate) use members::{CutCells, Members};
pub(crate) use span::Span;

use wide::u32x4;

use super::pieces::{Pieces, cut};
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

/// How far beyond a cell's face a body counts as inside, as a part of the
/// cell's side: one that stops at a face does not cross it to and fro.
const MARGIN: i32 = 128;

/// Where the mean distance of bodies is more than this number of diameters, they are
/// far apart: cells of their size would be empty, and crossed all the time.
const FAR_APART: f64 = 1.5;

/// Side of a cell in mean distances then.
const FAR_SIDE: f64 = 0.95;

/// The most cells, for each body or fixed part and besides: bodies in dense
/// order fill some four cells each.
const CELLS_EACH: u64 = 8;
const CELLS_BESIDES: u64 = 1 << 12;

/// As many cells have numbers that three parts add up to without overflow.
const MOST_NUMBERS: u64 = 1 << 30;

/// The most coordinates of cells along an axis, with some to spare in an `i32`.
const MOST_COORDINATES: i32 = 1 << 29;

/// Bodies that a block of a cell has room for.
const STRIDE: usize = 4;

/// The most blocks of a cell.
const MOST_BLOCKS: usize = 32;

/// The slots of bodies in a cell. A pack, so that it is copied at once and lies on one
/// cache line.
pub(crate) type Block = u32x4;

/// The cells, and how they are numbered.
#[derive(Debug)]
pub(crate) struct Grid<T> {
    axes: [Axis<T>; 3],
    margin: Vec3<T>,
}

/// The grid and who is in its cells.
#[derive(Debug)]
pub(crate) struct Cells<T> {
    grid: Grid<T>,
    /// Blocks of a cell.
    blocks: usize,
    /// The slots of a cell's bodies, in as many blocks as the fullest cell needs.
    slots: Vec<Block>,
    /// How many bodies a cell has.
    counts: Vec<u8>,
    /// The number of blocks up to which all cells grow with the fullest one.
    most_blocks: usize,
    spilled: Spilled,
}

impl<T: Real> Cells<T> {
    /// A grid of empty cells that suits `len` bodies among `parts` bounded fixed
    /// parts, which touch at distances of up to `reach`.
    pub fn fitting(span: Span<T>, reach: T, len: usize, parts: usize) -> Self {
        let distance = span.mean_distance(reach, len + parts);
        let is_far = distance > FAR_APART * reach.to_f64();
        let wanted = if is_far { T::from_f64(FAR_SIDE * distance) } else { reach };
        let most = CELLS_BESIDES + CELLS_EACH * (len + parts) as u64;
        Self::new(span, reach, wanted, most.min(MOST_NUMBERS))
    }

    /// One empty cell.
    pub fn whole(span: Span<T>) -> Self {
        Self::of_counts(span, [1; 3], CELLS_BESIDES)
    }

    /// A grid of at most `most` empty cells with sides of at least `reach`, of
    /// `wanted` if that is more.
    fn new(span: Span<T>, reach: T, wanted: T, most: u64) -> Self {
        let least = least_side(span, reach);
        let extent = span.part();
        let mut wanted = wanted.greater(least);
        let counts = loop {
            let counts = extent.each(|extent| count(extent, least, wanted, span.ends));
            // No extent has more than its few least cells once it is this wide.
            if numbers(counts) <= most || !wanted.is_finite() {
                break counts;
            }
            wanted = wanted * T::ratio(5, 4);
        };
        Self::of_counts(span, counts, most)
    }

    /// A grid of empty cells, `counts` of them in memory along each axis. It grows to
    /// at most four times `most` blocks.
    fn of_counts(span: Span<T>, counts: [i32; 3], most: u64) -> Self {
        let (lower, extent) = (span.lower.to_array(), span.part());
        let rounding = rounding(span);
        let mut axes = array::from_fn(|k| Axis {
            lower: lower[k],
            side: extent[k] / T::whole(counts[k]),
            count: counts[k].saturating_mul(span.folds[k]),
            kept: counts[k],
            ends: span.ends,
            lines: Vec::new(),
        });
        let numbers = number(&mut axes);
        let margins = axes.refs().each(|axis| axis.side * T::ratio(1, MARGIN) + rounding);
        Self {
            grid: Grid { axes, margin: Vec3::from(margins) },
            blocks: 1,
            slots: vec![Block::splat(0); numbers],
            counts: vec![0; numbers],
            most_blocks: 4 * most as usize,
            spilled: Spilled::default(),
        }
    }

    /// An empty grid of the same space with `counts` cells along each axis.
    pub fn divided(&self, span: Span<T>, counts: [i32; 3]) -> Self {
        Self::of_counts(span, counts, self.most_blocks as u64 / 4)
    }

    /// The grid.
    pub fn grid(&self) -> &Grid<T> {
        &self.grid
    }

    /// All cells, to be read and written.
    pub fn members(&mut self) -> Members<'_, T> {
        Members {
            grid: &self.grid,
            blocks: self.blocks,
            slots: Pieces::whole(&mut self.slots),
            counts: Pieces::whole(&mut self.counts),
            spilled: &mut self.spilled,
            is_whole: true,
        }
    }

    /// The cells cut at rising numbers, the last of them that of all cells, and what
    /// else a worker needs for [`Members::of`].
    pub fn cut(&mut self, ends: impl Iterator<Item = usize> + Clone) -> CutCells<'_, T> {
        let blocks = self.blocks;
        let slots = cut(&mut self.slots, ends.clone().map(|end| end * blocks));
        CutCells { grid: &self.grid, blocks, slots, counts: cut(&mut self.counts, ends) }
    }

    /// How many cells have numbers.
    pub fn numbers(&self) -> usize {
        self.counts.len()
    }

    /// Whether a cell has more bodies than its blocks have room for.
    pub fn has_spilled(&self) -> bool {
        !self.spilled.lists.is_empty()
    }

    /// Takes all bodies out.
    pub fn clear(&mut self) {
        self.counts.fill(0);
        self.spilled.lists.clear();
    }

    /// Doubles the room in each of the empty cells, unless that takes too much memory:
    /// what one cell needs, all get. Returns whether it did.
    pub fn grow(&mut self) -> bool {
        let blocks = self.slots.len() * 2;
        let fits = blocks <= self.most_blocks && self.blocks < MOST_BLOCKS;
        if fits {
            self.slots = vec![Block::splat(0); blocks];
            self.blocks *= 2;
        }
        fits
    }

    /// Lets each of the empty cells have room for a number of bodies, unless that takes too
    /// much memory.
    pub fn have_room(&mut self, bodies: usize) {
        while self.blocks * STRIDE < bodies && self.grow() {}
    }

    /// The bytes that the cells hold.
    pub fn bytes(&self) -> usize {
        self.slots.capacity() * size_of::<Block>() + self.counts.capacity()
    }
}

impl<T: Real> Grid<T> {
    /// Cells in memory along each axis.
    pub fn counts(&self) -> [i32; 3] {
        self.axes.refs().each(|axis| axis.kept)
    }

    /// Whether the last cell in memory along an axis is a neighbour of the first.
    pub fn closes(&self, axis: usize) -> bool {
        self.axes[axis].closes()
    }

    /// Whether cells far apart share their memory.
    pub fn is_folded(&self) -> bool {
        self.axes.iter().any(|axis| axis.ends == Ends::Open || axis.kept < axis.count)
    }

    /// The sides of a cell and how far beyond them a body counts as inside, length.
    pub fn sides(&self) -> [[f64; 2]; 3] {
        let margin = self.margin.to_array();
        array::from_fn(|k| [self.axes[k].side.to_f64(), margin[k].to_f64()])
    }

    /// Whether the box is so narrow along an axis that two images of a pair can
    /// be near at once.
    pub fn is_narrow(&self, axis: usize) -> bool {
        self.axes[axis].ends == Ends::Joined && self.axes[axis].count < WIDE
    }

    /// Whether every cell neighbours every other one along an axis.
    fn are_all_neighbours(&self, axis: usize) -> bool {
        self.axes[axis].closes() && self.axes[axis].kept < 4
    }

    /// Whether all cells of a span have coordinates, with some to spare.
    pub fn can_number(&self, span: &Span<T>) -> bool {
        let extent = (span.upper - span.lower).to_array();
        let most = T::whole(MOST_COORDINATES);
        (0..3).all(|k| extent[k] <= self.axes[k].side * most)
    }

    /// The cell's coordinates of a point.
    pub fn cell_of(&self, point: Vec3<T>) -> [i32; 3] {
        let point = point.to_array();
        array::from_fn(|k| {
            let axis = &self.axes[k];
            let cells = (point[k] - axis.lower) / axis.side;
            let whole = cells.whole_part().saturating_sub(i64::from(cells < T::ZERO));
            axis.held(whole.clamp(-(1 << 30), 1 << 30) as i32)
        })
    }

    /// The coordinates of a cell a number of whole boxes back.
    #[inline(always)]
    pub fn turned_back(&self, cell: [i32; 3], turns: Vec3<T>) -> [i32; 3] {
        let turns = turns.to_array();
        array::from_fn(|k| {
            if turns[k] == T::ZERO {
                return cell[k];
            }
            cell[k] - turns[k].whole_part() as i32 * self.axes[k].count
        })
    }

    /// How many whole boxes a cell is away from the first one.
    pub fn turns(&self, cell: [i32; 3]) -> Vec3<T> {
        let turns = |k: usize| T::whole(cell[k].div_euclid(self.axes[k].count));
        Vec3::new(turns(0), turns(1), turns(2))
    }

    /// Greatest distance of two bodies in neighbouring cells.
    pub fn neighbourhood(&self) -> f64 {
        let sides = self.axes.refs().each(|axis| axis.side.to_f64());
        2.1 * sides.iter().map(|side| side * side).sum::<f64>().sqrt()
    }

    /// The first and the last cell that a body of a radius can be in when it
    /// touches what lies within `bounds`.
    fn cells_at(&self, bounds: [Vec3<T>; 2], radius: T) -> [[i32; 3]; 2] {
        let reach = Vec3::new(radius, radius, radius) + self.margin + self.margin;
        [self.cell_of(bounds[0] - reach), self.cell_of(bounds[1] + reach)]
    }

    /// Every cell of the first box that is within a distance of something:
    /// `is_near` says whether a point's distance is at most a length. What is
    /// within `bounds` is near only to where a body of the radius touches them.
    pub fn each_near(
        &self,
        bounds: Option<[Vec3<T>; 2]>,
        radius: T,
        is_near: impl Fn(Vec3<T>, T) -> bool,
        mut visit: impl FnMut(u32),
    ) {
        let counts = self.axes.refs().each(|axis| axis.count);
        let [first, last] = match bounds {
            None => [[0; 3], counts],
            Some(bounds) => self.cells_at(bounds, radius),
        };
        // Block by block first: most are far from everything.
        let middle = |from: [i32; 3], sides: i32| -> (Vec3<T>, T) {
            let half = |axis: &Axis<T>| axis.side * T::ratio(sides, 2);
            let [x, y, z] = array::from_fn(|k| {
                let axis = &self.axes[k];
                axis.lower + axis.side * T::whole(from[k]) + half(axis)
            });
            let [a, b, c] = self.axes.refs().each(half);
            let reach = Vec3::new(a, b, c) + self.margin + self.margin;
            (Vec3::new(x, y, z), reach.length())
        };
        let near = |from, sides| {
            let (center, reach) = middle(from, sides);
            is_near(center, reach)
        };
        let within = |k: usize, cell: i32| cell >= first[k] && cell <= last[k] && cell < counts[k];
        let [across, along, up] = array::from_fn(|k| {
            let start = first[k].max(0) / BLOCK * BLOCK;
            (start..counts[k].min(last[k].saturating_add(1))).step_by(BLOCK as usize)
        });
        for z in up {
            for y in along.clone() {
                for x in across.clone() {
                    if !near([x, y, z], BLOCK) {
                        continue;
                    }
                    for k in 0..BLOCK * BLOCK * BLOCK {
                        let cell = [x + k % BLOCK, y + k / BLOCK % BLOCK, z + k / (BLOCK * BLOCK)];
                        if (0..3).all(|k| within(k, cell[k])) && near(cell, 1) {
                            visit(self.number_of(cell));
                        }
                    }
                }
            }
        }
    }

    /// The corners of a cell's inside, with the margin. No body leaves a span
    /// that is closed: there it ends farther away than any body flies in a period,
    /// and not so far that its product with an acceleration overflows.
    #[inline(always)]
    pub fn bounds(&self, cell: [i32; 3], axis: usize) -> [T; 2] {
        let Axis { lower, side, count, ends, .. } = &self.axes[axis];
        let margin = self.margin.to_array()[axis];
        let k = cell[axis];
        let low = *lower + *side * T::whole(k) - margin;
        let high = *lower + *side * T::whole(k + 1) + margin;
        if *ends == Ends::Closed {
            let far = *side * T::whole(1 << 20);
            [if k == 0 { low - far } else { low }, if k + 1 == *count { high + far } else { high }]
        } else {
            [low, high]
        }
    }

    /// Whether a point is in a cell, or beyond it by half a margin more than a body that
    /// is about to cross can be.
    #[inline(always)]
    pub fn is_about_in(&self, cell: [i32; 3], point: Vec3<T>) -> bool {
        let (point, margin) = (point.to_array(), (self.margin * T::ratio(1, 2)).to_array());
        (0..3).all(|k| {
            let [low, high] = self.bounds(cell, k);
            point[k] >= low - margin[k] && point[k] <= high + margin[k]
        })
    }

    /// The number of a cell.
    #[inline(always)]
    pub fn number_of(&self, cell: [i32; 3]) -> u32 {
        let [x, y, z] = self.lines(cell);
        x.cells[1] + y.cells[1] + z.cells[1]
    }

    /// Whether a cell is not beyond a closed end.
    fn has(&self, cell: [i32; 3]) -> bool {
        (0..3).all(|k| self.axes[k].held(cell[k]) == cell[k])
    }

    #[inline(always)]
    fn lines(&self, cell: [i32; 3]) -> [&Line; 3] {
        array::from_fn(|k| {
            let axis = &self.axes[k];
            &axis.lines[axis.folded(cell[k]) as usize]
        })
    }
}

/// The least side of a cell for bodies that touch at distances of up to `reach`.
fn least_side<T: Real>(span: Span<T>, reach: T) -> T {
    reach * T::ratio(MARGIN + 4, MARGIN) + rounding(span) * T::whole(4)
}

/// By how much positions far from the origin are rounded, for bodies that stop at a
/// face.
fn rounding<T: Real>(span: Span<T>) -> T {
    span.farthest() * T::EPSILON * T::whole(64)
}
