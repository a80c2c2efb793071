//! Span: the part of space that a grid covers.

use super::{Ends, MOST_COORDINATES};
use crate::bodies::Columns3;
use crate::column::Column;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

/// From this number of bodies on, a span is cut down to where they are.
const CROWD: usize = 64;

/// Bodies in the cell of a body, on average, from which a grid over the whole span
/// is too coarse for them, and those that a finer one should have.
const CROWDED: u64 = 32;
const FEW: u64 = 4;

/// The most times that the side of a cell is halved to get there.
const MOST_HALVINGS: usize = 40;

/// An odd number whose binary digits follow no rule: 2⁶⁴ over the golden ratio.
const HASH: u64 = 0x9E37_79B9_7F4A_7C15;

/// The most folds of a span along an axis.
const MOST_FOLDS: i64 = 1 << 26;

/// The part of space that a grid covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span<T> {
    pub lower: Vec3<T>,
    pub upper: Vec3<T>,
    pub ends: Ends,
    /// How many times the span is as wide along each axis as the part of it that
    /// has cells of its own in memory: the others fold into these.
    pub folds: [i32; 3],
    /// The greatest coordinate of what may be in the cells, length.
    farthest: T,
}

impl<T: Real> Span<T> {
    /// The span between two corners.
    pub fn new(lower: Vec3<T>, upper: Vec3<T>, ends: Ends) -> Self {
        let corners = [lower, upper].each(Vec3::to_array);
        let farthest = corners.iter().flatten().fold(T::ZERO, |most, c| most.greater(c.abs()));
        Self { lower, upper, ends, folds: [1; 3], farthest }
    }

    /// The span, folded if its bodies are crowded together in parts of it, so that
    /// cells as small as these ask for are few. A side has at least `least`; bodies
    /// touch at distances of up to `reach`.
    pub fn folded(&self, least: T, reach: T, position: &Columns3<T>) -> Self {
        let len = position[0].len();
        if len < CROWD {
            return *self;
        }
        let Some(widths) = self.widths_of_crowd(least, reach, position) else { return *self };
        let mut folded = *self;
        let (lower, extent) = (self.lower.to_array(), self.part());
        let mut upper = self.upper.to_array();
        for k in 0..3 {
            let folds = (extent[k] / widths[k]).whole_part();
            match self.ends {
                _ if folds < 2 => {}
                Ends::Open => upper[k] = lower[k] + widths[k],
                _ if folds > MOST_FOLDS => return *self,
                _ => folded.folds[k] = folds as i32,
            }
        }
        folded.upper = upper.into();
        folded
    }

    /// How wide bodies are along each axis that are crowded together, whichever parts
    /// of the span they are in; `None` if they fill it.
    fn widths_of_crowd(&self, least: T, reach: T, position: &Columns3<T>) -> Option<[T; 3]> {
        let len = position[0].len();
        let mut side = self.spacing(reach, len);
        if self.bodies_in_cell(side, position) <= CROWDED {
            return None;
        }
        let extent = self.part().into_iter().fold(T::ZERO, |most, side| side.greater(most));
        let least_side = reach.greater(extent / T::whole(MOST_COORDINATES / 4));
        for _ in 0..MOST_HALVINGS {
            let is_fine = side * T::ratio(1, 2) < least_side;
            if is_fine || self.bodies_in_cell(side, position) <= FEW {
                break;
            }
            side = side * T::ratio(1, 2);
        }
        let mut cells: [usize; 3] = array::from_fn(|k| {
            let mut cells: Vec<i64> = self.cells_along(k, side, &position[k]).collect();
            cells.sort_unstable();
            cells.dedup();
            cells.len() + 2
        });
        // Bodies along a line that is oblique would ask for the cells of a cube.
        while cells.iter().map(|&count| count as u128).product::<u128>() > 8 * len as u128 {
            let most = (0..3).max_by_key(|&k| cells[k]).unwrap_or(0);
            if cells[most] <= 4 {
                break;
            }
            cells[most] = cells[most] * 3 / 4;
        }
        Some(cells.each(|count| (side * T::from_f64(count as f64)).greater(least)))
    }

    /// The coordinate along an axis of the cell of each body, for cells of a side.
    fn cells_along(&self, axis: usize, side: T, column: &Column<T>) -> impl Iterator<Item = i64> {
        let lower = self.lower.to_array()[axis];
        column.iter().map(move |&at| ((at - lower) / side).whole_part())
    }

    /// How many bodies are in the cell of a body, on average, for cells of a side, and
    /// a few more: cells are counted by a hash of their coordinates.
    fn bodies_in_cell(&self, side: T, position: &Columns3<T>) -> u64 {
        let len = position[0].len();
        let mut hashes = vec![0_u64; len];
        for (axis, column) in position.iter().enumerate() {
            for (hash, cell) in hashes.iter_mut().zip(self.cells_along(axis, side, column)) {
                *hash = (*hash ^ cell as u64).wrapping_mul(HASH).rotate_left(29);
            }
        }
        let mut counts = vec![0_u32; (2 * len).next_power_of_two()];
        let mask = counts.len() as u64 - 1;
        hashes.iter().for_each(|hash| counts[(hash & mask) as usize] += 1);
        counts.iter().map(|&count| u64::from(count).pow(2)).sum::<u64>() / len as u64
    }

    /// The greatest coordinate of what may be in the cells, length.
    pub fn farthest(&self) -> T {
        self.farthest
    }

    /// The sides of the part that has cells of its own in memory, length.
    pub fn part(&self) -> [T; 3] {
        let extent = (self.upper - self.lower).to_array();
        array::from_fn(|k| extent[k] / T::whole(self.folds[k]))
    }

    /// The mean distance of `len` bodies, or the greatest at which two touch if
    /// that is more.
    pub fn spacing(&self, reach: T, len: usize) -> T {
        let mean = self.mean_distance(reach, len);
        T::from_f64(if mean > 0.0 { mean } else { 1.0 }).greater(reach)
    }

    /// The mean distance of `len` bodies, each side counted with `least` at least.
    pub fn mean_distance(&self, least: T, len: usize) -> f64 {
        let extent = self.part();
        let volume: f64 = extent.iter().map(|side| side.greater(least).to_f64()).product();
        (volume / len.max(1) as f64).cbrt()
    }
}
