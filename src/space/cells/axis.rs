//! Axis: the cells along one axis, and how all cells are numbered.

use crate::numbers::array::{self, Each};
use crate::real::Real;

/// The most cells along an axis.
pub(super) const MOST_CELLS: i64 = 1 << 20;

/// No cell.
pub(super) const NOWHERE: u32 = u32::MAX;

/// From this number of cells on, the nearest image of a body in a neighbouring cell is
/// the only one that is near.
pub(super) const WIDE: i32 = 5;

/// How space is bounded along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// Space has no end: cells far apart share their memory.
    Open,
    /// The last cell is a neighbour of the first: a periodic box.
    Joined,
    /// Nothing is beyond the last cell.
    Closed,
}

/// The cells along one axis.
#[derive(Clone, Debug)]
pub(super) struct Axis<T> {
    pub(super) lower: T,
    pub(super) side: T,
    /// Cells from end to end; of open space, those with memory of their own.
    pub(super) count: i32,
    /// Cells with memory of their own; all others fold into them.
    pub(super) kept: i32,
    pub(super) ends: Ends,
    /// Each of these with its neighbours.
    pub(super) lines: Vec<Line>,
}

/// A cell along one axis with its neighbours: what each adds to the number of a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// The one before it, it and the one after it.
    pub(super) cells: [u32; 3],
    /// The least and the greatest of these; [`NOWHERE`] is the greatest of all.
    pub(super) ends: [u32; 2],
}

impl Line {
    fn new(cells: [u32; 3]) -> Self {
        let [a, b, c] = cells;
        Self { cells, ends: [a.min(b).min(c), a.max(b).max(c)] }
    }
}

impl<T: Real> Axis<T> {
    /// A coordinate that bodies can have: those beyond closed ends belong to
    /// the last cell.
    pub(super) fn held(&self, cell: i32) -> i32 {
        match self.ends {
            Ends::Closed => cell.clamp(0, self.count - 1),
            Ends::Open | Ends::Joined => cell,
        }
    }

    /// Where in memory a coordinate is.
    #[inline(always)]
    pub(super) fn folded(&self, cell: i32) -> i32 {
        if (cell as u32) < self.kept as u32 { cell } else { cell.rem_euclid(self.kept) }
    }

    /// Whether the last cell in memory is a neighbour of the first.
    pub(super) fn closes(&self) -> bool {
        self.ends != Ends::Closed || self.kept < self.count
    }
}

/// How many cells an axis has.
pub(super) fn count<T: Real>(extent: T, least: T, wanted: T, ends: Ends) -> i32 {
    let fits = |side: T| (extent / side).whole_part().clamp(1, MOST_CELLS) as i32;
    let count = fits(wanted);
    // A box of few cells has some more if they need not all be neighbours then.
    if ends != Ends::Closed && count < WIDE { fits(least).clamp(2, WIDE) } else { count }
}

/// Cells along the side of a block that lies together in memory.
pub(super) const BLOCK: i32 = 4;

/// How cells are numbered block by block: cells along the sides of a block, and
/// blocks along each axis.
pub(super) fn blocks(counts: [i32; 3]) -> [[u32; 3]; 2] {
    let counts = counts.each(|count| count as u32);
    let sides = counts.each(|count| count.min(BLOCK as u32));
    [sides, array::from_fn(|k| counts[k].div_ceil(sides[k]))]
}

/// How many numbers the cells have.
pub(super) fn numbers(counts: [i32; 3]) -> u64 {
    blocks(counts).into_iter().flatten().map(u64::from).product()
}

/// Numbers the cells in memory, and returns how many numbers there are.
pub(super) fn number<T: Real>(axes: &mut [Axis<T>; 3]) -> usize {
    let [sides, blocks] = blocks(axes.refs().each(|axis| axis.kept));
    let within = [1, sides[0], sides[0] * sides[1]];
    let whole = sides[0] * sides[1] * sides[2];
    let between = [whole, whole * blocks[0], whole * blocks[0] * blocks[1]];
    for (k, axis) in axes.iter_mut().enumerate() {
        let part = |cell: i32| {
            let (block, inside) = (cell as u32 / sides[k], cell as u32 % sides[k]);
            block * between[k] + inside * within[k]
        };
        let (kept, closes) = (axis.kept, axis.closes());
        let neighbour = |cell: i32| match cell {
            _ if (0..kept).contains(&cell) => part(cell),
            _ if closes && kept > 2 => part(cell.rem_euclid(kept)),
            // With two cells each is the other's only neighbour.
            _ => NOWHERE,
        };
        let around = |cell: i32| [neighbour(cell - 1), part(cell), neighbour(cell + 1)];
        axis.lines = (0..kept).map(|cell| Line::new(around(cell))).collect();
    }
    (between[2] * blocks[2]) as usize
}
