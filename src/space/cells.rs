//! Cells: what is near what.
//!
//! Space is cut into cells no smaller than the greatest diameter, so that two
//! bodies can only touch if their cells are neighbours. Which bodies are in a cell
//! is kept up as they cross from one to the next.

mod axis;
mod span;

use std::collections::BTreeMap;

pub(crate) use axis::Ends;
use axis::{Axis, BLOCK, NOWHERE, WIDE, count, number, numbers};
pub(crate) use span::Span;

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

/// Bodies that a block of a cell has room for, and their count.
const STRIDE: usize = 8;

/// The grid and who is in its cells.
#[derive(Debug)]
pub(crate) struct Cells<T> {
    axes: [Axis<T>; 3],
    margin: Vec3<T>,
    /// Blocks of a cell.
    blocks: usize,
    /// The slots of a cell's bodies, in as many blocks as the fullest cell
    /// needs; the last number of the first one is their count.
    slots: Vec<[u32; STRIDE]>,
    /// The number of blocks up to which all cells grow with the fullest one.
    most_blocks: usize,
    /// The bodies that are more than a cell's blocks have room for.
    spilled: BTreeMap<u32, Vec<u32>>,
    /// The most bodies of a cell that has spilled.
    fullest: usize,
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
            let counts = extent.map(|extent| count(extent, least, wanted, span.ends));
            // No extent has more than its few least cells once it is this wide.
            if numbers(counts) <= most || !wanted.is_finite() {
                break counts;
            }
            wanted = wanted * T::ratio(5, 4);
        };
        Self::of_counts(span, counts, most)
    }

    /// A grid of empty cells, `counts` of them in memory along each axis. It grows to
    /// at most twice `most` blocks.
    fn of_counts(span: Span<T>, counts: [i32; 3], most: u64) -> Self {
        let (lower, extent) = (span.lower.to_array(), span.part());
        let rounding = rounding(span);
        let mut axes = core::array::from_fn(|k| Axis {
            lower: lower[k],
            side: extent[k] / T::whole(counts[k]),
            count: counts[k].saturating_mul(span.folds[k]),
            kept: counts[k],
            ends: span.ends,
            parts: Vec::new(),
        });
        let numbers = number(&mut axes);
        let margins = axes.each_ref().map(|axis| axis.side * T::ratio(1, MARGIN) + rounding);
        Self {
            axes,
            margin: Vec3::from(margins),
            blocks: 1,
            slots: vec![[0; STRIDE]; numbers],
            most_blocks: 2 * most as usize,
            spilled: BTreeMap::new(),
            fullest: 0,
        }
    }

    /// An empty grid of the same space with `counts` cells along each axis.
    pub fn divided(&self, span: Span<T>, counts: [i32; 3]) -> Self {
        Self::of_counts(span, counts, self.most_blocks as u64 / 2)
    }

    /// Cells in memory along each axis.
    pub fn counts(&self) -> [i32; 3] {
        self.axes.each_ref().map(|axis| axis.kept)
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
        core::array::from_fn(|k| [self.axes[k].side.to_f64(), margin[k].to_f64()])
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
        core::array::from_fn(|k| {
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
        core::array::from_fn(|k| {
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
        let sides = self.axes.each_ref().map(|axis| axis.side.to_f64());
        2.1 * sides.iter().map(|side| side * side).sum::<f64>().sqrt()
    }

    /// Every cell that a body of a radius can be in when it touches what lies
    /// within `bounds`.
    pub fn each_in(&self, bounds: [Vec3<T>; 2], radius: T, mut visit: impl FnMut(u32)) {
        let [lower, upper] = self.cells_at(bounds, radius);
        let span = |k: usize| lower[k]..=upper[k].min(lower[k] + self.axes[k].kept - 1);
        for z in span(2) {
            for y in span(1) {
                for x in span(0) {
                    visit(self.number_of([x, y, z]));
                }
            }
        }
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
        let counts = self.axes.each_ref().map(|axis| axis.count);
        let [first, last] = match bounds {
            None => [[0; 3], counts],
            Some(bounds) => self.cells_at(bounds, radius),
        };
        // Block by block first: most are far from everything.
        let middle = |from: [i32; 3], sides: i32| -> (Vec3<T>, T) {
            let half = |axis: &Axis<T>| axis.side * T::ratio(sides, 2);
            let [x, y, z] = core::array::from_fn(|k| {
                let axis = &self.axes[k];
                axis.lower + axis.side * T::whole(from[k]) + half(axis)
            });
            let [a, b, c] = self.axes.each_ref().map(half);
            let reach = Vec3::new(a, b, c) + self.margin + self.margin;
            (Vec3::new(x, y, z), reach.length())
        };
        let near = |from, sides| {
            let (center, reach) = middle(from, sides);
            is_near(center, reach)
        };
        let within = |k: usize, cell: i32| cell >= first[k] && cell <= last[k] && cell < counts[k];
        let [across, along, up] = core::array::from_fn(|k| {
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

    /// The number of a cell.
    #[inline(always)]
    pub fn number_of(&self, cell: [i32; 3]) -> u32 {
        let [x, y, z] = self.lines(cell);
        x[1] + y[1] + z[1]
    }

    #[inline(always)]
    fn lines(&self, cell: [i32; 3]) -> [[u32; 3]; 3] {
        core::array::from_fn(|k| {
            let axis = &self.axes[k];
            axis.parts[axis.folded(cell[k]) as usize]
        })
    }

    /// The bodies in a cell and in those around it, into `found`, which has
    /// room for [`most`](Cells::most) of them; returns how many.
    #[inline(always)]
    pub fn around(&self, cell: [i32; 3], found: &mut [u32]) -> usize {
        self.read_lines(self.lines(cell), found)
    }

    /// The bodies in the layer of cells around `cell` that has come near when
    /// it was entered along `axis`, from below if `up`.
    #[inline(always)]
    pub fn ahead(&self, cell: [i32; 3], axis: usize, up: bool, found: &mut [u32]) -> usize {
        let mut lines = self.lines(cell);
        if !self.are_all_neighbours(axis) {
            let part = lines[axis][if up { 2 } else { 0 }];
            lines[axis] = [part, NOWHERE, NOWHERE];
        }
        self.read_lines(lines, found)
    }

    #[inline(always)]
    fn read_lines(&self, [xs, ys, zs]: [[u32; 3]; 3], found: &mut [u32]) -> usize {
        let mut len = 0;
        for z in zs {
            for y in ys {
                if z == NOWHERE || y == NOWHERE {
                    continue;
                }
                for x in xs {
                    if x != NOWHERE {
                        len = self.read(x + y + z, found, len);
                    }
                }
            }
        }
        len
    }

    /// The bodies in a cell, into `found` behind the first `len`; returns how many
    /// there are then. There are none beyond closed ends.
    pub fn read_cell(&self, cell: [i32; 3], found: &mut [u32], len: usize) -> usize {
        if (0..3).any(|k| self.axes[k].held(cell[k]) != cell[k]) {
            return len;
        }
        self.read(self.number_of(cell), found, len)
    }

    #[inline(always)]
    fn read(&self, number: u32, found: &mut [u32], len: usize) -> usize {
        if self.blocks > 1 {
            return self.read_blocks(number, found, len);
        }
        // A whole block is copied faster than a few numbers are counted.
        let block = &self.slots[number as usize];
        found[len..len + STRIDE].copy_from_slice(block);
        len + block[STRIDE - 1] as usize
    }

    #[inline(never)]
    fn read_blocks(&self, number: u32, found: &mut [u32], len: usize) -> usize {
        let start = number as usize * self.blocks;
        let slots = self.slots[start..start + self.blocks].as_flattened();
        let count = slots[STRIDE - 1] as usize;
        let within = count.min(self.room());
        let first = within.min(STRIDE - 1);
        found[len..len + first].copy_from_slice(&slots[..first]);
        found[len + first..len + within].copy_from_slice(&slots[STRIDE..STRIDE + within - first]);
        if count > within
            && let Some(spilled) = self.spilled.get(&number)
        {
            found[len + within..len + count].copy_from_slice(spilled);
        }
        len + count
    }

    /// How many slots a buffer for [`around`](Cells::around) must have.
    pub fn most(&self) -> usize {
        (27 * self.most_in_cell()).next_multiple_of(16) + 2 * STRIDE
    }

    /// How many slots are written at most to read a cell.
    pub fn most_in_cell(&self) -> usize {
        (self.blocks * STRIDE).max(self.fullest)
    }

    /// How many bodies the blocks of a cell have room for.
    fn room(&self) -> usize {
        self.blocks * STRIDE - 1
    }

    /// The slots of a cell's bodies and their count, as they lie in memory.
    fn slots_in(&mut self, cell: [i32; 3]) -> &mut [u32] {
        let start = self.number_of(cell) as usize * self.blocks;
        self.slots[start..start + self.blocks].as_flattened_mut()
    }

    /// Puts a body into a cell.
    pub fn insert(&mut self, cell: [i32; 3], slot: u32) {
        let count = self.slots_in(cell)[STRIDE - 1] as usize;
        if count >= self.room() {
            self.grow();
        }
        if count < self.room() {
            self.slots_in(cell)[nth(count)] = slot;
        } else {
            self.spilled.entry(self.number_of(cell)).or_default().push(slot);
            self.fullest = self.fullest.max(count + 1);
        }
        self.slots_in(cell)[STRIDE - 1] += 1;
    }

    /// Takes a body out of a cell.
    pub fn remove(&mut self, cell: [i32; 3], slot: u32) {
        let room = self.room();
        let slots = self.slots_in(cell);
        let count = slots[STRIDE - 1] as usize;
        if count > room {
            self.remove_spilled(cell, slot);
        } else if let Some(at) = (0..count).find(|&k| slots[nth(k)] == slot) {
            slots[nth(at)] = slots[nth(count - 1)];
            slots[STRIDE - 1] -= 1;
        }
    }

    /// Takes a body out of a cell with more bodies than its blocks have room for.
    #[cold]
    fn remove_spilled(&mut self, cell: [i32; 3], slot: u32) {
        let (number, room) = (self.number_of(cell), self.room());
        let Some(spilled) = self.spilled.get_mut(&number) else { return };
        let last = if let Some(at) = spilled.iter().position(|&other| other == slot) {
            spilled.swap_remove(at);
            None
        } else {
            spilled.pop()
        };
        if spilled.is_empty() {
            self.spilled.remove(&number);
        }
        let slots = self.slots_in(cell);
        if let Some(last) = last
            && let Some(at) = (0..room).find(|&k| slots[nth(k)] == slot)
        {
            slots[nth(at)] = last;
        }
        slots[STRIDE - 1] -= 1;
    }

    /// Takes all bodies out.
    pub fn clear(&mut self) {
        for block in self.slots.iter_mut().step_by(self.blocks) {
            block[STRIDE - 1] = 0;
        }
        self.spilled.clear();
    }

    /// Doubles the room in each cell, unless that takes too much memory: what
    /// one cell needs, all get.
    #[cold]
    fn grow(&mut self) {
        let blocks = self.blocks * 2;
        if self.slots.len() * 2 > self.most_blocks {
            return;
        }
        let mut slots = vec![[0; STRIDE]; self.slots.len() * 2];
        for (to, from) in slots.chunks_mut(blocks).zip(self.slots.chunks(self.blocks)) {
            to[..from.len()].copy_from_slice(from);
        }
        (self.slots, self.blocks) = (slots, blocks);
    }

    /// The bytes that the cells hold.
    pub fn bytes(&self) -> usize {
        self.slots.capacity() * size_of::<[u32; STRIDE]>()
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

/// Where the body of a number is among a cell's slots.
fn nth(number: usize) -> usize {
    number + usize::from(number >= STRIDE - 1)
}
