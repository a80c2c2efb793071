//! Grid: a lattice of cells that closes upon itself.
//!
//! A cell's neighbours are found by its three indices, each taken modulo the
//! grid's size. In a small periodic box that is the geometry itself. In a large one,
//! and in open space, it lets a grid of about as many cells as bodies serve bodies
//! anywhere, crowded or not: those far apart only share a cell with strangers,
//! which the distance test turns away.

use core::ops::Range;

use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::vec3::Vec3;

/// Cells of at least a given side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid<T> {
    origin: Vec3<T>,
    cells_per_length: Vec3<T>,
    cells: [u32; 3],
}

/// Up to two runs of cells with consecutive indices.
pub(super) type Runs = [Range<u32>; 2];

impl<T: Real> Grid<T> {
    /// A grid over the points between `lower` and `upper` with cells of at
    /// least `side`, and no more than `most` of them. Unless there would be more, those at
    /// its faces are empty, so that all others have their neighbours beside them.
    pub fn open(lower: Vec3<T>, upper: Vec3<T>, side: T, most: usize) -> Self {
        let cells = few((upper - lower).to_array().each(|length| along(length, side) + 3), most);
        let per_length = T::ONE / side;
        Self {
            origin: lower - Vec3::new(side, side, side),
            cells_per_length: Vec3::new(per_length, per_length, per_length),
            cells: cells.each(|n| n as u32),
        }
    }

    /// A grid that divides a periodic box into cells of at least `side`. No more than
    /// `most` of them have indices of their own: the box is a whole number of grids wide.
    pub fn periodic(space: &PeriodicBox<T>, side: T, most: usize) -> Self {
        let sides = space.sides().to_array();
        let wanted = sides.each(|length| along(length, side).max(1));
        let cells = few(wanted, most);
        let per_length = array::from_fn(|k| {
            let grids = wanted[k] / cells[k];
            T::from_f64((grids * cells[k]) as f64) / sides[k]
        });
        Self {
            origin: space.lower,
            cells_per_length: per_length.into(),
            cells: cells.each(|n| n as u32),
        }
    }

    /// How many cells there are.
    pub fn len(&self) -> usize {
        self.cells.iter().map(|&n| n as usize).product()
    }

    /// The indices of the cell that a point is in.
    #[inline(always)]
    pub fn cell(&self, point: Vec3<T>) -> [u32; 3] {
        let scaled = point - self.origin;
        let along = |length: T, per_length: T, cells: u32| {
            let scaled = length * per_length;
            let index = scaled.whole_part();
            if scaled >= T::ZERO && index < i64::from(cells) {
                index as u32
            } else {
                let floor = if scaled < T::ZERO { index.saturating_sub(1) } else { index };
                floor.rem_euclid(i64::from(cells)) as u32
            }
        };
        [
            along(scaled.x, self.cells_per_length.x, self.cells[0]),
            along(scaled.y, self.cells_per_length.y, self.cells[1]),
            along(scaled.z, self.cells_per_length.z, self.cells[2]),
        ]
    }

    /// The rank of a cell, the first index running fastest.
    #[inline(always)]
    pub fn rank(&self, [x, y, z]: [u32; 3]) -> u32 {
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// The indices of the cell with a rank.
    #[inline(always)]
    pub fn cell_of_rank(&self, rank: u32) -> [u32; 3] {
        let row = rank / self.cells[0];
        [rank % self.cells[0], row % self.cells[1], row / self.cells[1]]
    }

    /// The indices of the cell that stands a number of cells after one in its row, or of the
    /// first one of the next row.
    #[inline(always)]
    pub fn cell_after(&self, [x, y, z]: [u32; 3], cells: u32) -> [u32; 3] {
        match [x + cells < self.cells[0], y + 1 < self.cells[1]] {
            [true, _] => [x + cells, y, z],
            [false, true] => [0, y + 1, z],
            [false, false] => [0, 0, z + 1],
        }
    }

    /// How many cells from this one on in its row have all their neighbours beside them in
    /// memory; 0 if it has not.
    #[inline(always)]
    pub fn inner_cells_from(&self, cell: [u32; 3]) -> u32 {
        let is_inner = (0..3).all(|k| cell[k] > 0 && cell[k] + 1 < self.cells[k]);
        if is_inner { self.cells[0] - 1 - cell[0] } else { 0 }
    }

    /// Calls `visit` with runs of some cells from `cell` on, at first, and those of their
    /// neighbours that have greater ranks, each cell once. More than one are inner cells.
    #[inline(always)]
    pub fn for_each_run_from(
        &self,
        ranks: Range<u32>,
        cell: [u32; 3],
        mut visit: impl FnMut(Range<u32>),
    ) {
        if self.inner_cells_from(cell) > 0 {
            let (row, layer) = (self.cells[0], self.cells[0] * self.cells[1]);
            visit(ranks.start..ranks.end + 1);
            for ahead in [row, layer - row, layer, layer + row] {
                visit(ranks.start + ahead - 1..ranks.end + ahead + 1);
            }
            return;
        }
        let rank = ranks.start;
        visit(ranks);
        let own = rank - cell[0];
        self.for_each_neighbour_row(cell, |row, runs| {
            if row >= own {
                for run in runs {
                    visit(run.start.max(rank + 1)..run.end);
                }
            }
        });
    }

    /// Calls `visit` with the ranks of the cell's neighbours and itself, row by
    /// row as runs, each cell once.
    #[inline(always)]
    pub fn for_each_neighbour_row(&self, [x, y, z]: [u32; 3], mut visit: impl FnMut(u32, Runs)) {
        let [first, second] = neighbours(x, self.cells[0]);
        for z in each(neighbours(z, self.cells[2])) {
            for y in each(neighbours(y, self.cells[1])) {
                let row = (z * self.cells[1] + y) * self.cells[0];
                visit(
                    row,
                    [row + first.start..row + first.end, row + second.start..row + second.end],
                );
            }
        }
    }
}

/// How many cells of a side fit in a length.
fn along<T: Real>(length: T, side: T) -> u64 {
    (length / side).whole_part().clamp(0, 1 << 40) as u64
}

/// Halves the longest row of cells until there are no more than `most` of them.
fn few(mut cells: [u64; 3], most: usize) -> [u64; 3] {
    while cells.iter().map(|&n| u128::from(n)).product::<u128>() > most.max(1) as u128 {
        let longest = (0..3).max_by_key(|&axis| cells[axis]).unwrap_or(0);
        if cells[longest] == 1 {
            break;
        }
        cells[longest] = cells[longest].div_ceil(2);
    }
    cells
}

/// `index − 1 … index + 1` modulo `count`, each once, as one run or two.
#[inline(always)]
fn neighbours(index: u32, count: u32) -> Runs {
    if count < 3 {
        [0..count, 0..0]
    } else if index == 0 {
        [0..2, count - 1..count]
    } else if index == count - 1 {
        [0..1, count - 2..count]
    } else {
        [index - 1..index + 2, 0..0]
    }
}

#[inline(always)]
fn each([first, second]: Runs) -> impl Iterator<Item = u32> {
    first.chain(second)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn neighbour_cells(grid: &Grid<f64>, cell: [u32; 3]) -> Vec<u32> {
        let mut found = Vec::new();
        grid.for_each_neighbour_row(cell, |_, runs| found.extend(each(runs)));
        found
    }

    #[test]
    fn each_neighbour_is_met_once_for_any_size() {
        for cells in [[1, 1, 1], [2, 1, 3], [3, 3, 3], [2, 2, 2], [5, 4, 6]] {
            let grid =
                Grid { origin: Vec3::ZERO, cells_per_length: Vec3::new(1.0, 1.0, 1.0), cells };
            for z in 0..cells[2] {
                for y in 0..cells[1] {
                    for x in 0..cells[0] {
                        let mut found = neighbour_cells(&grid, [x, y, z]);
                        let count = found.len();
                        found.sort_unstable();
                        found.dedup();
                        assert_eq!(found.len(), count, "a cell met twice in {cells:?}");
                        let expected: u32 = cells.iter().map(|&n| n.min(3)).product();
                        assert_eq!(count as u32, expected);
                    }
                }
            }
        }
    }

    #[test]
    fn runs_from_a_cell_are_itself_and_the_neighbours_with_greater_ranks() {
        for cells in [[1, 1, 1], [2, 1, 3], [3, 3, 3], [5, 4, 6]] {
            let grid =
                Grid { origin: Vec3::ZERO, cells_per_length: Vec3::new(1.0, 1.0, 1.0), cells };
            let mut cell = [0; 3];
            for rank in 0..grid.len() as u32 {
                assert_eq!(cell, grid.cell_of_rank(rank));
                for count in 1..=grid.inner_cells_from(cell).max(1) {
                    let mut from = Vec::new();
                    grid.for_each_run_from(rank..rank + count, cell, |run| from.extend(run));
                    assert_eq!(from[0], rank);
                    let around = |rank| neighbour_cells(&grid, grid.cell_of_rank(rank));
                    let mut expected: Vec<_> = (rank..rank + count).flat_map(around).collect();
                    expected.retain(|&other| other >= rank);
                    from.sort_unstable();
                    expected.sort_unstable();
                    expected.dedup();
                    assert_eq!(from, expected, "around {count} from {rank} of {cells:?}");
                }
                cell = grid.cell_after(cell, 1);
            }
        }
    }

    #[test]
    fn cells_are_few_and_take_any_point() {
        let upper = Vec3::new(1e12, 20.0, 20.0);
        let grid = Grid::open(Vec3::ZERO, upper, 1.0, 1000);
        assert!(grid.len() <= 1000 && grid.len() > 200, "{grid:?}");
        for x in [-1e300, -0.5, 0.0, 3.5, 1e12, 1e300] {
            let cell = grid.cell(Vec3::new(x, 1.0, -1.0));
            assert!((grid.rank(cell) as usize) < grid.len());
        }
    }
}
