//! Members: who is in the cells that a worker holds.

use std::collections::BTreeMap;

use wide::bytemuck::{cast_slice, cast_slice_mut};

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
    pub slots: Vec<&'a mut [Block]>,
    pub counts: Vec<&'a mut [u8]>,
}

/// The grid, and the cells that a worker holds with the slots of their bodies.
#[derive(Debug)]
pub(crate) struct Members<'a, T> {
    pub grid: &'a Grid<T>,
    pub(super) blocks: usize,
    pub(super) slots: Pieces<'a, Block>,
    /// How many bodies a cell has; one more than it has room for if it has spilled.
    pub(super) counts: Pieces<'a, u8>,
    pub(super) spilled: &'a mut Spilled,
    /// Whether it holds all cells.
    pub(super) is_whole: bool,
}

impl<'a, T: Real> Members<'a, T> {
    /// Two runs of cells and the numbers at which they start.
    pub fn of(
        grid: &'a Grid<T>,
        blocks: usize,
        (slots, counts): ([&'a mut [Block]; 2], [&'a mut [u8]; 2]),
        starts: [usize; 2],
        spilled: &'a mut Spilled,
    ) -> Self {
        let slots = Pieces::of(slots, starts.each(|start| start * blocks));
        let counts = Pieces::of(counts, starts);
        Self { grid, blocks, slots, counts, spilled, is_whole: false }
    }

    /// Whether the cell of a number is among those held, with all its bodies: those that
    /// are more than it has room for are held by who holds all cells.
    #[inline(always)]
    pub fn holds(&self, number: u32) -> bool {
        let count = self.counts.get(number as usize);
        self.is_whole || count.is_some_and(|&count| usize::from(count) <= self.room())
    }

    /// The bodies in a cell and in those around it, into `found`, which has
    /// room for [`most`](Members::most) of them; returns how many. `None` if some of
    /// these cells are not held.
    #[inline(always)]
    pub fn around(&self, cell: [i32; 3], found: &mut [u32]) -> Option<usize> {
        let [x, y, z] = self.grid.lines(cell);
        self.read_lines((x.cells, y.cells, z.cells), [x.ends, y.ends, z.ends], found)
    }

    /// The bodies in the layer of cells around `cell` that has come near when
    /// it was entered along `axis`, from below if `up`; as [`around`](Members::around).
    #[inline(always)]
    pub fn ahead(&self, cell: [i32; 3], axis: usize, up: bool, found: &mut [u32]) -> Option<usize> {
        let lines = self.grid.lines(cell);
        let mut ends = lines.each(|line| line.ends);
        let [x, y, z] = lines.each(|line| line.cells);
        if self.grid.are_all_neighbours(axis) {
            return self.read_lines((x, y, z), ends, found);
        }
        let ahead = |cells: [u32; 3]| [cells[if up { 2 } else { 0 }]];
        let [layer] = ahead(lines[axis].cells);
        ends[axis] = [layer; 2];
        match axis {
            0 => self.read_lines((ahead(x), y, z), ends, found),
            1 => self.read_lines((x, ahead(y), z), ends, found),
            _ => self.read_lines((x, y, ahead(z)), ends, found),
        }
    }

    /// The bodies in the cells along three axes, of which the least and the greatest are
    /// `ends`.
    fn read_lines<const X: usize, const Y: usize, const Z: usize>(
        &self,
        lines: ([u32; X], [u32; Y], [u32; Z]),
        ends: [[u32; 2]; 3],
        found: &mut [u32],
    ) -> Option<usize> {
        match self.blocks {
            1 => self.read_blocks_of::<X, Y, Z, 1>(lines, ends, found),
            2 => self.read_blocks_of::<X, Y, Z, 2>(lines, ends, found),
            _ => self.read_with_care([&lines.0, &lines.1, &lines.2], found),
        }
    }

    /// As [`read_lines`](Members::read_lines), where a cell has this number of blocks.
    #[inline(always)]
    fn read_blocks_of<const X: usize, const Y: usize, const Z: usize, const BLOCKS: usize>(
        &self,
        (xs, ys, zs): ([u32; X], [u32; Y], [u32; Z]),
        ends: [[u32; 2]; 3],
        found: &mut [u32],
    ) -> Option<usize> {
        // The last is beyond all numbers if one of them is nowhere.
        let bounds = array::from_fn(|k| ends.iter().map(|ends| ends[k] as usize).sum());
        let lines = [&xs[..], &ys, &zs];
        let len = self.copy_run::<BLOCKS>(lines, bounds, found);
        len.or_else(|| self.read_at_ends::<BLOCKS>(lines, found))
    }

    /// The bodies in cells between two numbers. `None` if these are not held in one run, or
    /// cells have more bodies than room.
    #[inline(always)]
    fn copy_run<const BLOCKS: usize>(
        &self,
        [xs, ys, zs]: [&[u32]; 3],
        [least, last]: [usize; 2],
        found: &mut [u32],
    ) -> Option<usize> {
        let slots = self.slots.run(least * BLOCKS..=last * BLOCKS + (BLOCKS - 1))?;
        let counts = self.counts.run(least..=last)?;
        // Of one length, as the compiler sees: an index into one is one into the other.
        let (slots, _) = slots.as_chunks::<BLOCKS>();
        let cells = slots.len().min(counts.len());
        let (slots, counts) = (&slots[..cells], &counts[..cells]);
        let room = found.len();
        let mut rest = &mut *found;
        for z in zs {
            for y in ys {
                let row = (y + z).wrapping_sub(least as u32);
                for x in xs {
                    let cell = row.wrapping_add(*x) as usize;
                    let count = usize::from(counts[cell]);
                    if count > BLOCKS * STRIDE {
                        return None;
                    }
                    // Whole blocks are copied faster than a few numbers are counted.
                    let Some(blocks) = rest.as_chunks_mut().0.first_chunk_mut::<BLOCKS>() else {
                        unreachable!("no room for a cell")
                    };
                    for k in 0..BLOCKS {
                        blocks[k] = slots[cell][k].to_array();
                    }
                    rest = &mut rest[count..];
                }
            }
        }
        Some(room - rest.len())
    }

    /// Where some of the cells may be nowhere: at the ends of the grid.
    #[inline(never)]
    fn read_at_ends<const BLOCKS: usize>(
        &self,
        lines: [&[u32]; 3],
        found: &mut [u32],
    ) -> Option<usize> {
        let mut kept = [[0; 3]; 3];
        let mut lens = [0; 3];
        let mut bounds = [0; 2];
        for axis in 0..3 {
            let mut ends = [NOWHERE, 0];
            for &cell in lines[axis].iter().filter(|&&cell| cell != NOWHERE) {
                kept[axis][lens[axis]] = cell;
                lens[axis] += 1;
                ends = [ends[0].min(cell), ends[1].max(cell)];
            }
            if lens[axis] == 0 {
                return Some(0);
            }
            bounds = [bounds[0] + ends[0] as usize, bounds[1] + ends[1] as usize];
        }
        let [xs, ys, zs] = &kept;
        let kept = [&xs[..lens[0]], &ys[..lens[1]], &zs[..lens[2]]];
        let len = self.copy_run::<BLOCKS>(kept, bounds, found);
        len.or_else(|| self.read_with_care(kept, found))
    }

    /// Where cells are nowhere, or not held in one run, or have more bodies than room.
    #[inline(never)]
    fn read_with_care(&self, [xs, ys, zs]: [&[u32]; 3], found: &mut [u32]) -> Option<usize> {
        let mut len = 0;
        for &z in zs.iter().filter(|&&z| z != NOWHERE) {
            for &y in ys.iter().filter(|&&y| y != NOWHERE) {
                for &x in xs.iter().filter(|&&x| x != NOWHERE) {
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
        let count = self.count(number);
        // Whole blocks are copied faster than a few numbers are counted.
        let (rooms, _) = found[len..].as_chunks_mut();
        let start = number as usize * self.blocks;
        for (k, room) in rooms[..self.blocks].iter_mut().enumerate() {
            *room = self.slots[start + k].to_array();
        }
        if count <= self.room() {
            return len + count;
        }
        self.read_spilled(number, found, len + self.room())
    }

    #[cold]
    fn read_spilled(&self, number: u32, found: &mut [u32], len: usize) -> usize {
        let Some(spilled) = self.spilled.lists.get(&number) else { return len };
        let end = len + spilled.len();
        found[len..end].copy_from_slice(spilled);
        end
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
        self.blocks * STRIDE
    }

    /// How many more bodies the blocks of a cell have room for.
    pub fn room_in(&self, number: u32) -> usize {
        self.room().saturating_sub(self.count(number))
    }

    /// How many bodies a cell has; one more than it has room for if it has spilled.
    #[inline(always)]
    fn count(&self, number: u32) -> usize {
        usize::from(self.counts[number as usize])
    }

    /// The slots of a cell's bodies, as they lie in memory.
    #[inline(always)]
    fn slots_of(&self, number: u32) -> &[u32] {
        let start = number as usize * self.blocks;
        cast_slice::<Block, u32>(&self.slots[start..start + self.blocks])
    }

    fn slots_of_mut(&mut self, number: u32) -> &mut [u32] {
        let start = number as usize * self.blocks;
        cast_slice_mut(&mut self.slots[start..start + self.blocks])
    }

    /// Puts a body into the cell of a number.
    pub fn insert(&mut self, number: u32, slot: u32) {
        let (room, count) = (self.room(), self.count(number));
        if count < room {
            self.slots_of_mut(number)[count] = slot;
            self.counts[number as usize] += 1;
        } else {
            self.counts[number as usize] = room as u8 + 1;
            let list = self.spilled.lists.entry(number).or_default();
            list.push(slot);
            self.spilled.fullest = self.spilled.fullest.max(room + list.len());
        }
    }

    /// Whether a body is in the cell of a number.
    pub fn has(&self, number: u32, slot: u32) -> bool {
        let (room, count) = (self.room(), self.count(number));
        self.slots_of(number)[..count.min(room)].contains(&slot)
            || count > room
                && self.spilled.lists.get(&number).is_some_and(|list| list.contains(&slot))
    }

    /// Takes a body out of the cell of a number, if it is there.
    pub fn remove(&mut self, number: u32, slot: u32) {
        let count = self.count(number);
        if count > self.room() {
            self.remove_spilled(number, slot);
            return;
        }
        let slots = &mut self.slots_of_mut(number)[..count];
        if let Some(at) = slots.iter().position(|&other| other == slot) {
            slots[at] = slots[count - 1];
            self.counts[number as usize] -= 1;
        }
    }

    /// Takes a body out of a cell with more bodies than its blocks have room for.
    #[cold]
    fn remove_spilled(&mut self, number: u32, slot: u32) {
        let within = self.slots_of(number).iter().position(|&other| other == slot);
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
            self.counts[number as usize] -= 1;
        }
        if let (Some(at), Some(moved)) = (within, moved) {
            self.slots_of_mut(number)[at] = moved;
        }
    }
}
