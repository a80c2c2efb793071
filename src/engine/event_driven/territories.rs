//! Territories: how workers share the bodies and cells of a window.
//!
//! The sorted bodies are cut, between cells, into twice as many pieces as there are
//! workers. In even phases each worker holds two pieces that adjoin; in odd phases the
//! second one of a pair and the first one of the next. What needs more than a worker
//! holds waits for the next phase, in which the border is inside a territory.

use super::log::Log;
use super::region::{Region, Worker};
use super::store::Store;
use super::window::Window;
use crate::real::Real;
use crate::space::cells::{CutCells, Members};
use crate::space::levels::Held;
use crate::space::pieces::{Pieces, cut};
use crate::workers::Workers;

/// Where the bodies and cells are cut.
#[derive(Clone, Debug, Default)]
pub(super) struct Cuts {
    /// Slots at which pieces end.
    slots: Vec<usize>,
    /// Numbers of cells at which they end.
    cells: Vec<usize>,
}

impl Cuts {
    /// Cuts sorted bodies into pieces of about equal numbers. `cell_of` is the number of
    /// the cell of the body in a slot, of `cells` in all.
    pub fn new(pieces: usize, len: usize, cells: usize, cell_of: impl Fn(usize) -> u32) -> Self {
        let mut cuts = Self::default();
        let mut slot = 0;
        for piece in 1..pieces {
            slot = slot.max(piece * len / pieces);
            while slot > 0 && slot < len && cell_of(slot) == cell_of(slot - 1) {
                slot += 1;
            }
            cuts.slots.push(slot);
            let is_inside = slot > 0 && slot < len;
            let cell = if is_inside {
                cell_of(slot) as usize
            } else if slot == 0 {
                0
            } else {
                cells
            };
            cuts.cells.push(cell);
        }
        cuts.slots.push(len);
        cuts.cells.push(cells);
        cuts
    }

    /// The slots of a piece.
    pub fn slots_of(&self, piece: usize) -> core::ops::Range<usize> {
        let start = if piece == 0 { 0 } else { self.slots[piece - 1] };
        start..self.slots[piece]
    }

    fn starts(&self, ends: &[usize], pieces: [usize; 2]) -> [usize; 2] {
        pieces.map(|piece| if piece == 0 { 0 } else { ends[piece - 1] })
    }
}

/// Lets each worker do something with its territory of a phase.
pub(super) fn phase<T: Real>(
    store: &mut Store<T>,
    workers: &mut [Worker<T>],
    pool: &Workers,
    (cuts, is_odd): (&Cuts, bool),
    window: Window<T>,
    work: impl Fn(&mut Region<'_, T>, [usize; 2]) + Send + Sync,
) {
    let count = workers.len();
    let pieces_of = |k: usize| match is_odd {
        false => [2 * k, 2 * k + 1],
        true => [2 * k + 1, (2 * k + 2) % (2 * count)],
    };
    let log_of = |k: usize| 1 + k + if is_odd { count } else { 0 };
    for (k, worker) in workers.iter_mut().enumerate() {
        worker.log = core::mem::replace(&mut store.logs[log_of(k)], Log::new(log_of(k)));
    }
    let mut spilled: Vec<_> = workers.iter().map(|_| Default::default()).collect();
    let Store { records, coarse, agendas, marks, next, spins, turned, index, .. } = store;
    let (screening, logs) = (&store.screening, &store.logs[..]);
    let mut records = Dealt::new(records, cuts);
    let mut coarse = Dealt::new(coarse, cuts);
    let mut agendas = Dealt::new(agendas, cuts);
    let mut marks = Dealt::new(marks, cuts);
    let mut next = Dealt::new(next, cuts);
    let mut spins = Dealt::new(spins, cuts);
    let mut turned = Dealt::new(turned, cuts);
    let CutCells { grid, blocks, runs } = store.cells.only().cut(cuts.cells.iter().copied());
    let mut cells = Dealt { runs: runs.into_iter().map(Some).collect() };
    let mut items: Vec<_> = workers
        .iter_mut()
        .zip(&mut spilled)
        .enumerate()
        .map(|(k, (worker, spilled))| {
            let pieces = pieces_of(k);
            let starts = cuts.starts(&cuts.slots, pieces);
            let held = cells.deal(pieces);
            let cell_starts = cuts.starts(&cuts.cells, pieces);
            let region = Region {
                records: Pieces::of(records.deal(pieces), starts),
                coarse: Pieces::of(coarse.deal(pieces), starts),
                agendas: Pieces::of(agendas.deal(pieces), starts),
                marks: Pieces::of(marks.deal(pieces), starts),
                next: Pieces::of(next.deal(pieces), starts),
                spins: Pieces::of(spins.deal(pieces), starts),
                turned: Pieces::of(turned.deal(pieces), starts),
                index,
                cells: Held::one(Members::of(grid, blocks, held, cell_starts, spilled)),
                screening,
                logs,
                worker,
                window: Some(window),
                is_whole: false,
            };
            (region, pieces)
        })
        .collect();
    pool.each(&mut items, |(region, pieces)| {
        region.make_room();
        work(region, *pieces);
    });
    drop(items);
    for (k, worker) in workers.iter_mut().enumerate() {
        store.logs[log_of(k)] = core::mem::replace(&mut worker.log, Log::new(0));
    }
}

/// A column in pieces, each of which is dealt out once.
struct Dealt<'a, V> {
    runs: Vec<Option<&'a mut [V]>>,
}

impl<'a, V> Dealt<'a, V> {
    fn new(column: &'a mut [V], cuts: &Cuts) -> Self {
        // A column that a scene has no use for is empty.
        let len = column.len();
        let runs = cut(column, cuts.slots.iter().map(|&end| end.min(len)));
        Self { runs: runs.into_iter().map(Some).collect() }
    }

    fn deal(&mut self, pieces: [usize; 2]) -> [&'a mut [V]; 2] {
        pieces.map(|piece| self.runs[piece].take().unwrap_or_default())
    }
}
