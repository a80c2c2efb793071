//! Members: who is in the cells that a worker holds.

use std::collections::BTreeMap;

use wide::bytemuck::{cast, cast_slice, cast_slice_mut};

use super::axis::NOWHERE;
use super::{Block, Grid, STRIDE};
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::space::pieces::Pieces;

/// The bodies that are more than a cell's blocks have room for.
#[derive(Debug, Default)]
pub(crate) struct Spilled {
    pub(super) lists: BTreeMap<u32, Vec<u32>>,
    /// The most bodies of a cell that has spilled.
    fullest: usize,
}

/// Cells cut into runs, to be dealt out.
#[derive(Debug)]
pub(crate) struct CutCells<'a, T> {
    pub grid: &'a Grid<T>,
    pub blocks: usize,
    pub runs: Vec<&'a mut [Block]>,
}

/// The grid, and the cells that a worker holds with the slots of their bodies.
#[derive(Debug)]
pub(crate) struct Members<'a, T> {
    pub grid: &'a Grid<T>,
    pub(super) blocks: usize,
    pub(super) slots: Pieces<'a, Block>,
    pub(super) spilled: &'a mut Spilled,
    /// Whether it holds all cells.
    pub(super) is_whole: bool,
}

impl<'a, T: Real> Members<'a, T> {
    /// Two runs of cells and the numbers at which they start.
    pub fn of(
        grid: &'a Grid<T>,
        blocks: usize,
        runs: [&'a mut [Block]; 2],
        starts: [usize; 2],
        spilled: &'a mut Spilled,
    ) -> Self {
        let slots = Pieces::of(runs, starts.each(|start| start * blocks));
        Self { grid, blocks, slots, spilled, is_whole: false }
    }

    /// Whether the cell of a number is among those held, with all its bodies: those that
    /// are more than it has room for are held by who holds all cells.
    #[inline(always)]
    pub fn holds(&self, number: u32) -> bool {
        self.is_whole
            || self
                .slots
                .get(number as usize * self.blocks)
                .is_some_and(|block| count(block) <= self.room())
    }

    /// The bodies in a cell and in those around it, into `found`, which has
    /// room for [`most`](Members::most) of them; returns how many. `None` if some of
    /// these cells are not held.
    #[inline(always)]
    pub fn around(&self, cell: [i32; 3], found: &mut [u32]) -> Option<usize> {
        let [x, y, z] = self.grid.lines(cell);
        self.read_lines(x.cells, y.cells, z.cells, [x.ends, y.ends, z.ends], found)
    }

    /// The bodies in the layer of cells around `cell` that has come near when
    /// it was entered along `axis`, from below if `up`; as [`around`](Members::around).
    #[inline(always)]
    pub fn ahead(&self, cell: [i32; 3], axis: usize, up: bool, found: &mut [u32]) -> Option<usize> {
        let lines = self.grid.lines(cell);
        let mut ends = lines.each(|line| line.ends);
        let [x, y, z] = lines.each(|line| line.cells);
        if self.grid.are_all_neighbours(axis) {
            return self.read_lines(x, y, z, ends, found);
        }
        let ahead = |cells: [u32; 3]| [cells[if up { 2 } else { 0 }]];
        let [layer] = ahead(lines[axis].cells);
        ends[axis] = [layer; 2];
        match axis {
            0 => self.read_lines(ahead(x), y, z, ends, found),
            1 => self.read_lines(x, ahead(y), z, ends, found),
            _ => self.read_lines(x, y, ahead(z), ends, found),
        }
    }

    /// The bodies in the cells along three axes, of which the least and the greatest are
    /// `ends`.
    fn read_lines<const X: usize, const Y: usize, const Z: usize>(
        &self,
        xs: [u32; X],
        ys: [u32; Y],
        zs: [u32; Z],
        ends: [[u32; 2]; 3],
        found: &mut [u32],
    ) -> Option<usize> {
        let [least, last] = array::from_fn(|k| ends.iter().map(|ends| ends[k] as usize).sum());
        // The last is beyond all numbers if one of them is nowhere.
        let run = self.slots.run(least..=last).filter(|_| self.blocks == 1);
        let Some(run) = run else { return self.read_lines_with_care([&xs, &ys, &zs], found) };
        let room = found.len();
        let mut rest = &mut *found;
        for z in zs {
            for y in ys {
                let row = (y + z).wrapping_sub(least as u32);
                for x in xs {
                    // A whole block is copied faster than a few numbers are counted.
                    let block = &run[row.wrapping_add(x) as usize];
                    let count = put(block, rest);
                    if count >= STRIDE {
                        return self.read_lines_with_care([&xs, &ys, &zs], found);
                    }
                    rest = &mut rest[count..];
                }
            }
        }
        Some(room - rest.len())
    }

    /// Where cells are nowhere, or not held in one run, or have more bodies than a block.
    #[inline(never)]
    fn read_lines_with_care(&self, [xs, ys, zs]: [&[u32]; 3], found: &mut [u32]) -> Option<usize> {
        let mut len = 0;
        for &z in zs {
            for &y in ys {
                for &x in xs {
                    if [x, y, z].contains(&NOWHERE) {
                        continue;
                    }
                    if !self.holds(x + y + z) {
                        return None;
                    }
                    len = self.read(x + y + z, found, len);
                }
            }
        }
        Some(len)
    }

    /// The bodies in a cell, into `found` behind the first `len`; returns how many
    /// there are then. There are none beyond closed ends.
    pub fn read_cell(&self, cell: [i32; 3], found: &mut [u32], len: usize) -> usize {
        if !self.grid.has(cell) {
            return len;
        }
        self.read(self.grid.number_of(cell), found, len)
    }

    #[inline(always)]
    fn read(&self, number: u32, found: &mut [u32], len: usize) -> usize {
        if self.blocks > 1 {
            return self.read_blocks(number, found, len);
        }
        let count = put(&self.slots[number as usize], &mut found[len..]);
        if count < STRIDE { len + count } else { self.read_blocks(number, found, len) }
    }

    #[inline(never)]
    fn read_blocks(&self, number: u32, found: &mut [u32], len: usize) -> usize {
        let start = number as usize * self.blocks;
        let slots = cast_slice::<Block, u32>(&self.slots[start..start + self.blocks]);
        let count = slots[STRIDE - 1] as usize;
        let within = count.min(self.room());
        let first = within.min(STRIDE - 1);
        found[len..len + first].copy_from_slice(&slots[..first]);
        found[len + first..len + within].copy_from_slice(&slots[STRIDE..STRIDE + within - first]);
        if count > within
            && let Some(spilled) = self.spilled.lists.get(&number)
        {
            found[len + within..len + count].copy_from_slice(spilled);
        }
        len + count
    }

    /// How many slots a buffer for [`around`](Members::around) must have.
    pub fn most(&self) -> usize {
        (27 * self.most_in_cell()).next_multiple_of(16) + 2 * STRIDE
    }

    /// How many slots are written at most to read a cell.
    pub fn most_in_cell(&self) -> usize {
        (self.blocks * STRIDE).max(self.spilled.fullest)
    }

    /// How many bodies the blocks of a cell have room for.
    fn room(&self) -> usize {
        self.blocks * STRIDE - 1
    }

    /// How many more bodies the blocks of a cell have room for.
    pub fn room_in(&self, number: u32) -> usize {
        let start = number as usize * self.blocks;
        self.room().saturating_sub(count(&self.slots[start]))
    }

    /// The slots of a cell's bodies and their count, as they lie in memory.
    fn slots_in(&mut self, number: u32) -> &mut [u32] {
        let start = number as usize * self.blocks;
        cast_slice_mut(&mut self.slots[start..start + self.blocks])
    }

    /// Puts a body into the cell of a number.
    pub fn insert(&mut self, number: u32, slot: u32) {
        let room = self.room();
        let slots = self.slots_in(number);
        let count = slots[STRIDE - 1] as usize;
        slots[STRIDE - 1] += 1;
        if count < room {
            slots[nth(count)] = slot;
        } else {
            self.spilled.lists.entry(number).or_default().push(slot);
            self.spilled.fullest = self.spilled.fullest.max(count + 1);
        }
    }

    /// Whether a body is in the cell of a number.
    pub fn has(&self, number: u32, slot: u32) -> bool {
        let start = number as usize * self.blocks;
        let slots = cast_slice::<Block, u32>(&self.slots[start..start + self.blocks]);
        let count = slots[STRIDE - 1] as usize;
        (0..count.min(self.room())).any(|k| slots[nth(k)] == slot)
            || count > self.room()
                && self.spilled.lists.get(&number).is_some_and(|list| list.contains(&slot))
    }

    /// Takes a body out of the cell of a number, if it is there.
    pub fn remove(&mut self, number: u32, slot: u32) {
        let room = self.room();
        let slots = self.slots_in(number);
        let count = slots[STRIDE - 1] as usize;
        if count > room {
            self.remove_spilled(number, slot);
        } else if let Some(at) = (0..count).find(|&k| slots[nth(k)] == slot) {
            slots[nth(at)] = slots[nth(count - 1)];
            slots[STRIDE - 1] -= 1;
        }
    }

    /// Takes a body out of a cell with more bodies than its blocks have room for.
    #[cold]
    fn remove_spilled(&mut self, number: u32, slot: u32) {
        let room = self.room();
        let within = (0..room).find(|&k| self.slots_in(number)[nth(k)] == slot);
        let Some(spilled) = self.spilled.lists.get_mut(&number) else { return };
        let moved = match (within, spilled.iter().position(|&other| other == slot)) {
            (_, Some(at)) => {
                spilled.swap_remove(at);
                None
            }
            (Some(_), None) => spilled.pop(),
            (None, None) => return,
        };
        if spilled.is_empty() {
            self.spilled.lists.remove(&number);
        }
        let slots = self.slots_in(number);
        slots[STRIDE - 1] -= 1;
        if let (Some(at), Some(moved)) = (within, moved) {
            slots[nth(at)] = moved;
        }
    }
}

/// Where the body of a number is among a cell's slots.
fn nth(number: usize) -> usize {
    number + usize::from(number >= STRIDE - 1)
}

/// How many bodies a cell has, by its first block.
#[inline(always)]
fn count(block: &Block) -> usize {
    block.to_array()[STRIDE - 1] as usize
}

/// A block to the start of `found`. Returns how many bodies the cell has.
#[inline(always)]
fn put(block: &Block, found: &mut [u32]) -> usize {
    let Some(room) = found.first_chunk_mut() else { unreachable!("no room for a block") };
    // Taken by two numbers at once: what is read as one of eight is copied one by one.
    let [.., last]: [u64; STRIDE / 2] = cast(*block);
    *room = block.to_array();
    (last >> u32::BITS) as usize
}
