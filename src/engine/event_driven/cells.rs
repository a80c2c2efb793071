//! Cells: who is near whom.
//!
//! Space is cut into cells no smaller than the greatest diameter, so that two
//! bodies can only touch if their cells are neighbours. Who is in a cell is
//! kept up as bodies cross from one to the next.

use crate::real::Real;
use crate::vec3::Vec3;

/// How far beyond a cell's face a body counts as inside, as a part of the
/// cell's side: one that stops at a face does not cross it to and fro.
const MARGIN: i32 = 128;

/// Where the mean distance of bodies is more than so many diameters, they are
/// far apart: cells of their size would be empty, and crossed all the time.
const FAR_APART: f64 = 1.5;

/// Side of a cell in mean distances then.
const FAR_SIDE: f64 = 0.95;

/// The most cells along an axis.
const MOST_CELLS: i64 = 1 << 20;

/// No cell.
const NOWHERE: u32 = u32::MAX;

/// Bodies that a block of a cell has room for, and their count.
const STRIDE: usize = 8;

/// How space is bounded along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ends {
    /// The last cell is a neighbour of the first: a periodic box, or open
    /// space, in which cells far apart share a place in memory.
    Joined,
    /// Nothing is beyond the last cell.
    Closed,
}

/// The cells along one axis.
#[derive(Clone, Debug)]
struct Axis<T> {
    lower: T,
    side: T,
    count: i32,
    ends: Ends,
    /// For each cell what the one before it, it and the one after it add to
    /// the number of a cell.
    parts: Vec<[u32; 3]>,
}

/// The grid and who is in its cells.
#[derive(Debug)]
pub(super) struct Cells<T> {
    axes: [Axis<T>; 3],
    margin: Vec3<T>,
    /// Blocks of a cell.
    blocks: usize,
    /// The places of a cell's bodies, in as many blocks as the fullest cell
    /// needs; the last number of the first one is their count.
    places: Vec<[u32; STRIDE]>,
}

/// The region that the grid covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region<T> {
    pub lower: Vec3<T>,
    pub upper: Vec3<T>,
    pub ends: Ends,
}

impl<T: Real> Cells<T> {
    /// A grid of empty cells that suits `len` bodies which touch at distances of
    /// up to `reach`, and how far apart the bodies are on the average.
    pub fn fitting(region: Region<T>, reach: T, len: usize) -> (Self, T) {
        let extent = (region.upper - region.lower).to_array();
        let extent = extent.map(|side| side.greater(reach));
        let volume: f64 = extent.iter().map(|side| side.to_f64()).product();
        let mean = (volume / len.max(1) as f64).cbrt();
        let spacing = T::from_f64(if mean > 0.0 { mean } else { 1.0 }).greater(reach);
        let is_far = mean > FAR_APART * reach.to_f64();
        let wanted = if is_far { T::from_f64(FAR_SIDE * mean) } else { reach };
        (Self::new(region, reach, wanted), spacing)
    }

    /// A grid of empty cells with sides of at least `reach`, of `wanted` if that
    /// is more.
    fn new(region: Region<T>, reach: T, wanted: T) -> Self {
        let [lower, upper] = [region.lower, region.upper].map(Vec3::to_array);
        let farthest = lower.iter().chain(&upper).fold(T::ZERO, |most, c| most.greater(c.abs()));
        // Far from the origin places are rounded by more than a margin for
        // bodies that stop at a face.
        let rounding = farthest * T::EPSILON * T::whole(64);
        let least = reach * T::ratio(MARGIN + 4, MARGIN) + rounding * T::whole(4);
        let wanted = wanted.greater(least);
        let mut axes = core::array::from_fn(|k| {
            let extent = upper[k] - lower[k];
            let fits = |side: T| (extent / side).whole_part().clamp(1, MOST_CELLS) as i32;
            let mut count = fits(wanted);
            // Every cell of a narrow box neighbours every other one.
            if region.ends == Ends::Joined && count < 4 {
                count = fits(least).max(2);
            }
            let side = extent / T::whole(count);
            Axis { lower: lower[k], side, count, ends: region.ends, parts: Vec::new() }
        });
        let numbers = number(&mut axes);
        let margins = axes.each_ref().map(|axis| axis.side * T::ratio(1, MARGIN) + rounding);
        Self { axes, margin: Vec3::from(margins), blocks: 1, places: vec![[0; STRIDE]; numbers] }
    }

    /// Whether the box is so narrow along an axis that two images of a pair can
    /// be near at once.
    pub fn is_narrow(&self, axis: usize) -> bool {
        self.axes[axis].ends == Ends::Joined && self.axes[axis].count < 4
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

    /// How many numbers cells have.
    pub fn numbers(&self) -> usize {
        self.places.len() / self.blocks
    }

    /// Every cell that a body of a radius can be in when it touches what lies
    /// within `bounds`.
    pub fn each_in(&self, bounds: [Vec3<T>; 2], radius: T, mut visit: impl FnMut(u32)) {
        let reach = Vec3::new(radius, radius, radius) + self.margin + self.margin;
        let lower = self.cell_of(bounds[0] - reach);
        let upper = self.cell_of(bounds[1] + reach);
        let span = |k: usize| lower[k]..=upper[k].min(lower[k] + self.axes[k].count - 1);
        for z in span(2) {
            for y in span(1) {
                for x in span(0) {
                    visit(self.number_of([x, y, z]));
                }
            }
        }
    }

    /// Every cell that is within a distance of something: `is_near` says
    /// whether a point's distance is at most a length.
    pub fn each_near(&self, is_near: impl Fn(Vec3<T>, T) -> bool, mut visit: impl FnMut(u32)) {
        let counts = self.axes.each_ref().map(|axis| axis.count);
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
        let blocks = counts.map(|count| (0..count).step_by(BLOCK as usize));
        let [across, along, up] = blocks;
        for z in up {
            for y in along.clone() {
                for x in across.clone() {
                    if !near([x, y, z], BLOCK) {
                        continue;
                    }
                    for k in 0..BLOCK * BLOCK * BLOCK {
                        let cell = [x + k % BLOCK, y + k / BLOCK % BLOCK, z + k / (BLOCK * BLOCK)];
                        if (0..3).all(|k| cell[k] < counts[k]) && near(cell, 1) {
                            visit(self.number_of(cell));
                        }
                    }
                }
            }
        }
    }

    /// The corners of a cell's inside, with the margin. Nobody leaves a region
    /// that is closed: there it ends farther away than anybody flies in a period,
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
        if !self.is_narrow(axis) {
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

    #[inline(always)]
    fn read(&self, number: u32, found: &mut [u32], len: usize) -> usize {
        if self.blocks > 1 {
            return self.read_blocks(number, found, len);
        }
        // A whole block is copied faster than a few numbers are counted.
        let block = &self.places[number as usize];
        found[len..len + STRIDE].copy_from_slice(block);
        len + block[STRIDE - 1] as usize
    }

    #[inline(never)]
    fn read_blocks(&self, number: u32, found: &mut [u32], len: usize) -> usize {
        let start = number as usize * self.blocks;
        let places = self.places[start..start + self.blocks].as_flattened();
        let count = places[STRIDE - 1] as usize;
        let first = count.min(STRIDE - 1);
        found[len..len + first].copy_from_slice(&places[..first]);
        found[len + first..len + count].copy_from_slice(&places[STRIDE..STRIDE + count - first]);
        len + count
    }

    /// How many places a buffer for [`around`](Cells::around) must have.
    pub fn most(&self) -> usize {
        (27 * self.blocks * STRIDE).next_multiple_of(16) + 2 * STRIDE
    }

    /// The places of a cell's bodies and their count, as they lie in memory.
    fn places_in(&mut self, cell: [i32; 3]) -> &mut [u32] {
        let start = self.number_of(cell) as usize * self.blocks;
        self.places[start..start + self.blocks].as_flattened_mut()
    }

    /// Puts a body into a cell.
    pub fn insert(&mut self, cell: [i32; 3], place: u32) {
        if self.places_in(cell)[STRIDE - 1] as usize == self.blocks * STRIDE - 1 {
            self.grow();
        }
        let places = self.places_in(cell);
        let count = places[STRIDE - 1] as usize;
        places[slot(count)] = place;
        places[STRIDE - 1] += 1;
    }

    /// Takes a body out of a cell.
    pub fn remove(&mut self, cell: [i32; 3], place: u32) {
        let places = self.places_in(cell);
        let count = places[STRIDE - 1] as usize;
        if let Some(at) = (0..count).find(|&k| places[slot(k)] == place) {
            places[slot(at)] = places[slot(count - 1)];
            places[STRIDE - 1] -= 1;
        }
    }

    /// Takes all bodies out.
    pub fn clear(&mut self) {
        for block in self.places.iter_mut().step_by(self.blocks) {
            block[STRIDE - 1] = 0;
        }
    }

    /// Doubles the room in each cell.
    #[cold]
    fn grow(&mut self) {
        let blocks = self.blocks * 2;
        let mut places = vec![[0; STRIDE]; self.places.len() * 2];
        for (to, from) in places.chunks_mut(blocks).zip(self.places.chunks(self.blocks)) {
            to[..from.len()].copy_from_slice(from);
        }
        (self.places, self.blocks) = (places, blocks);
    }

    /// The bytes that the cells hold.
    pub fn bytes(&self) -> usize {
        self.places.capacity() * size_of::<[u32; STRIDE]>()
    }
}

impl<T: Real> Axis<T> {
    /// A coordinate that bodies can have: those beyond closed ends belong to
    /// the last cell.
    fn held(&self, cell: i32) -> i32 {
        match self.ends {
            Ends::Closed => cell.clamp(0, self.count - 1),
            Ends::Joined => cell,
        }
    }

    /// Where in memory a coordinate is.
    #[inline(always)]
    fn folded(&self, cell: i32) -> i32 {
        if (cell as u32) < self.count as u32 { cell } else { cell.rem_euclid(self.count) }
    }
}

/// Where the body of a number is among a cell's places.
fn slot(number: usize) -> usize {
    number + usize::from(number >= STRIDE - 1)
}

/// Cells along the side of a block that lies together in memory.
const BLOCK: i32 = 4;

/// Numbers the cells block by block, and returns how many numbers there are.
fn number<T>(axes: &mut [Axis<T>; 3]) -> usize {
    let counts = axes.each_ref().map(|axis| axis.count as u32);
    let sides = counts.map(|count| count.min(BLOCK as u32));
    let within = [1, sides[0], sides[0] * sides[1]];
    let whole = sides[0] * sides[1] * sides[2];
    let blocks: [u32; 3] = core::array::from_fn(|k| counts[k].div_ceil(sides[k]));
    let between = [whole, whole * blocks[0], whole * blocks[0] * blocks[1]];
    for (k, axis) in axes.iter_mut().enumerate() {
        let part = |cell: i32| {
            let (block, inside) = (cell as u32 / sides[k], cell as u32 % sides[k]);
            block * between[k] + inside * within[k]
        };
        let count = axis.count;
        let neighbour = |cell: i32| match axis.ends {
            _ if (0..count).contains(&cell) => part(cell),
            Ends::Joined if count > 2 => part(cell.rem_euclid(count)),
            // With two cells each is the other's only neighbour.
            _ => NOWHERE,
        };
        axis.parts =
            (0..count).map(|cell| [neighbour(cell - 1), part(cell), neighbour(cell + 1)]).collect();
    }
    (between[2] * blocks[2]) as usize
}
