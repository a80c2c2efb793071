//! Territories: how workers share the bodies and cells of a window.
//!
//! The sorted bodies are cut, between cells, into twice as many pieces as there are
//! workers. In even phases each worker holds two pieces that adjoin; in odd phases the
//! second one of a pair and the first one of the next. What needs more than a worker
//! holds waits for the next phase, in which the border is inside a territory.

use core::ops::Range;

use super::log::Log;
use super::region::{Region, Worker};
use super::store::Store;
use super::window::Window;
use crate::numbers::array::Each;
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
            // Bodies of a run that is continued may have moved since they were sorted.
            let before = cuts.cells.last().map_or(0, |&cell| cell);
            cuts.cells.push(cell.max(before));
        }
        cuts.slots.push(len);
        cuts.cells.push(cells);
        cuts
    }

    /// Whether nothing has been cut yet.
    pub fn are_none(&self) -> bool {
        self.slots.is_empty()
    }

    /// The slots of a piece.
    fn slots_of(&self, piece: usize) -> Range<usize> {
        start(&self.slots, piece)..self.slots[piece]
    }
}

/// The workers, the threads that they are on, and their territories.
#[derive(Debug)]
pub(super) struct Team<T: Real> {
    /// The first one has everything where the others have nothing to do, and counts for
    /// all.
    pub workers: Vec<Worker<T>>,
    pool: Workers,
    pub cuts: Cuts,
}

impl<T: Real> Team<T> {
    /// One worker for each thread.
    pub fn new(pool: Workers) -> Self {
        let workers = (0..pool.threads()).map(|_| Worker::new(0)).collect();
        Self { workers, pool, cuts: Cuts::default() }
    }

    /// The logs of all workers: one for the first when it has everything, and for each
    /// one of even phases and one of odd ones.
    pub fn logs(&self) -> Vec<Log<T>> {
        (0..=2 * self.workers.len()).map(Log::new).collect()
    }

    /// The worker that counts for all.
    pub fn first(&mut self) -> &mut Worker<T> {
        &mut self.workers[0]
    }

    /// Adds what the workers have added up to what the first one has.
    pub fn merge_accounts(&mut self) {
        let [first, others @ ..] = &mut self.workers[..] else { return };
        for other in others {
            first.account.merge(&core::mem::take(&mut other.account));
        }
    }

    /// Lets the first worker do something with all of it.
    pub fn whole<R>(
        &mut self,
        store: &mut Store<T>,
        window: Option<Window<T>>,
        work: impl FnOnce(&mut Region<'_, T>) -> R,
    ) -> R {
        let worker = &mut self.workers[0];
        worker.log = core::mem::replace(&mut store.logs[0], Log::new(0));
        let result = work(&mut store.whole(worker, window));
        store.logs[0] = core::mem::replace(&mut worker.log, Log::new(0));
        result
    }

    /// Lets each worker do something with its territory, which is two pieces, in an even
    /// phase and then in an odd one; afterwards the first one with all of it, if `is_left`
    /// says that something is. With one worker this is all.
    pub fn share(
        &mut self,
        store: &mut Store<T>,
        window: Window<T>,
        most_phases: usize,
        is_left: impl Fn(&Store<T>) -> bool,
        work: impl Fn(&mut Region<'_, T>, Range<usize>) + Send + Sync,
    ) {
        let mut phases = 0;
        while self.workers.len() > 1 && phases < most_phases {
            self.phase(store, phases % 2 == 1, window, &work);
            phases += 1;
            if phases >= 2 && !is_left(store) {
                return;
            }
        }
        if self.workers.len() == 1 || is_left(store) {
            let slots = 0..store.records.len();
            self.whole(store, Some(window), |region| work(region, slots));
        }
    }

    fn phase(
        &mut self,
        store: &mut Store<T>,
        is_odd: bool,
        window: Window<T>,
        work: &(impl Fn(&mut Region<'_, T>, Range<usize>) + Send + Sync),
    ) {
        let Self { workers, pool, cuts } = self;
        let count = workers.len();
        // Two pieces that adjoin are dealt out as one run. In an odd phase the last worker
        // has the last piece and the first one, which adjoin in a periodic box.
        let pieces_of = |k: usize| match is_odd {
            false => [2 * k, 2 * k + 1],
            true => [2 * k + 1, (2 * k + 2) % (2 * count)],
        };
        let runs_of = |k: usize| match is_odd {
            false => [Some(k), None],
            true => [Some(k + 1), (k + 1 == count).then_some(0)],
        };
        let [slots, numbers] = [&cuts.slots, &cuts.cells].each(|ends| run_ends(ends, is_odd));
        let log_of = |k: usize| 1 + k + if is_odd { count } else { 0 };
        for (k, worker) in workers.iter_mut().enumerate() {
            worker.log = core::mem::replace(&mut store.logs[log_of(k)], Log::new(log_of(k)));
        }
        let mut spilled: Vec<_> = workers.iter().map(|_| Default::default()).collect();
        let Store { records, coarse, agendas, marks, next, spins, turned, index, .. } = store;
        let (screening, logs) = (&store.screening, &store.logs[..]);
        let mut records = Dealt::new(records, &slots);
        let mut coarse = Dealt::new(coarse, &slots);
        let mut agendas = Dealt::new(agendas, &slots);
        let mut marks = Dealt::new(marks, &slots);
        let mut next = Dealt::new(next, &slots);
        let mut spins = Dealt::new(spins, &slots);
        let mut turned = Dealt::new(turned, &slots);
        let cells = store.cells.only().cut(numbers.iter().copied());
        let CutCells { grid, blocks, slots: members, counts } = cells;
        let (mut members, mut counts) = (Dealt::of(members), Dealt::of(counts));
        let mut items: Vec<_> = workers
            .iter_mut()
            .zip(&mut spilled)
            .enumerate()
            .map(|(k, (worker, spilled))| {
                let held = runs_of(k);
                let starts = starts(&slots, held);
                let cell_starts = self::starts(&numbers, held);
                let region = Region {
                    records: Pieces::of(records.deal(held), starts),
                    coarse: Pieces::of(coarse.deal(held), starts),
                    agendas: Pieces::of(agendas.deal(held), starts),
                    marks: Pieces::of(marks.deal(held), starts),
                    next: Pieces::of(next.deal(held), starts),
                    spins: Pieces::of(spins.deal(held), starts),
                    turned: Pieces::of(turned.deal(held), starts),
                    index,
                    cells: Held::one(Members::of(
                        grid,
                        blocks,
                        (members.deal(held), counts.deal(held)),
                        cell_starts,
                        spilled,
                    )),
                    screening,
                    logs,
                    worker,
                    window: Some(window),
                    is_whole: false,
                };
                (region, pieces_of(k))
            })
            .collect();
        pool.each(&mut items, |(region, pieces)| {
            region.make_room();
            for piece in *pieces {
                work(region, cuts.slots_of(piece));
            }
            region.unblock();
        });
        drop(items);
        for (k, worker) in workers.iter_mut().enumerate() {
            store.logs[log_of(k)] = core::mem::replace(&mut worker.log, Log::new(0));
        }
    }
}

/// Where runs of a phase end, by where the pieces end.
fn run_ends(ends: &[usize], is_odd: bool) -> Vec<usize> {
    let pairs = ends.iter().skip(usize::from(!is_odd)).step_by(2);
    pairs.chain(ends.last().filter(|_| is_odd)).copied().collect()
}

/// Where runs start, by where all of them end.
fn starts(ends: &[usize], runs: [Option<usize>; 2]) -> [usize; 2] {
    runs.each(|run| run.map_or(0, |run| start(ends, run)))
}

/// Where a part starts, by where all of them end.
fn start(ends: &[usize], part: usize) -> usize {
    if part == 0 { 0 } else { ends[part - 1] }
}

/// A column in runs, each of which is dealt out once.
struct Dealt<'a, V> {
    runs: Vec<Option<&'a mut [V]>>,
}

impl<'a, V> Dealt<'a, V> {
    fn new(column: &'a mut [V], ends: &[usize]) -> Self {
        // A column that a scene has no use for is empty.
        let len = column.len();
        Self::of(cut(column, ends.iter().map(|&end| end.min(len))))
    }

    fn of(runs: Vec<&'a mut [V]>) -> Self {
        Self { runs: runs.into_iter().map(Some).collect() }
    }

    fn deal(&mut self, runs: [Option<usize>; 2]) -> [&'a mut [V]; 2] {
        runs.each(|run| run.and_then(|run| self.runs[run].take()).unwrap_or_default())
    }
}
