//! Region: what one worker writes.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use super::agenda::{Agenda, PartnerCode};
use super::calendar::{Calendar, Turn};
use super::coarse::Screening;
use super::flight::{Flight, Record};
use super::key::{Key, Keys};
use super::log::{EntryNumber, Log, Logs, Mark, Past};
use super::meeting::Meetings;
use super::setting::Setting;
use super::window::Window;
use crate::engine::account::Account;
use crate::mat3::Mat3;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::levels::Held;
use crate::space::pieces::Pieces;
use crate::vec3::Vec3;

/// The bodies and cells that one worker reads and writes, and nothing else that changes.
///
/// Bodies are sorted by cell; a body is named by its *slot* in that order.
#[derive(Debug)]
pub(super) struct Region<'a, T: Real> {
    /// Flights.
    pub records: Pieces<'a, Record<T>>,
    /// Flights in coarse precision, where that is of use.
    pub coarse: Pieces<'a, Record<T::Coarse>>,
    /// What is ahead of each body.
    pub agendas: Pieces<'a, Agenda<T>>,
    pub marks: Pieces<'a, Mark>,
    /// When each body has to be looked at next, in windows.
    pub next: Pieces<'a, T>,
    /// Angular velocities, rad per time, if collisions change them.
    pub spins: Pieces<'a, Vec3<T>>,
    /// Orientations and the times that they are those of, likewise.
    pub turned: Pieces<'a, (Mat3<T>, T)>,
    /// The scene's index of the body in each slot of all.
    pub index: &'a [u32],

    pub cells: Held<'a, T>,
    pub screening: &'a Screening<T::Coarse>,
    /// Flights that others have ended in this window.
    pub logs: &'a [Log<T>],
    pub worker: &'a mut Worker<T>,
    /// The window of time that is being worked off; `None` in strict order of time.
    pub window: Option<Window<T>>,
    /// Whether all bodies and cells are in it.
    pub is_whole: bool,
}

/// What a worker has for itself.
#[derive(Debug)]
pub(super) struct Worker<T: Real> {
    /// Whose turn comes when, in strict order.
    pub calendar: Calendar<T>,
    /// Turns of the present window.
    pub heap: Heap,
    /// Flights that it has ended in the present window.
    pub log: Log<T>,
    /// Cells in which bodies are registered that have left them in this window.
    pub ghosts: Vec<(u32, u32)>,
    /// Bodies whose turn has to wait for another worker.
    pub blocked: Vec<u32>,
    /// Bodies with several contacts at a time, which have been found again at that time.
    pub settled: Vec<(u32, T)>,
    /// The last stamp given, and by how much the next one is greater.
    pub stamp: u32,
    pub stamp_step: u32,
    pub account: Account,
    /// Turns taken in this window.
    pub turns: u64,
    /// Collisions of each body of the block that had the most in this window.
    pub busiest: f64,
    /// Whether the turns of this window come to no end.
    pub is_stuck: bool,
    /// Whether a body has become too fast for the period.
    pub is_too_fast: bool,
    /// Whether a body has touched a part that removes it.
    pub has_removed: bool,

    /// Slots of bodies that a body may meet, for each of two bodies that have collided, and
    /// those that screening has left over.
    pub found: [Vec<u32>; 3],
    /// Those found whose flights start later than now.
    pub later: Vec<u32>,
    pub meetings: Meetings<T>,
    /// Bodies whose flights are taken back, and from which collision on.
    pub undo: Vec<(u32, Key<T>)>,
}

impl<T: Real> Worker<T> {
    /// A worker with the log of a number.
    pub fn new(log: usize) -> Self {
        Self {
            calendar: Calendar::new(),
            heap: Heap::default(),
            log: Log::new(log),
            ghosts: Vec::new(),
            blocked: Vec::new(),
            settled: Vec::new(),
            stamp: 0,
            stamp_step: 1,
            account: Account::default(),
            turns: 0,
            busiest: 0.0,
            is_stuck: false,
            is_too_fast: false,
            has_removed: false,
            found: [Vec::new(), Vec::new(), Vec::new()],
            later: Vec::new(),
            meetings: Meetings::new(),
            undo: Vec::new(),
        }
    }

    /// A stamp that no flight of the period has.
    #[inline(always)]
    pub fn new_stamp(&mut self) -> u32 {
        self.stamp += self.stamp_step;
        self.stamp
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.calendar.bytes()
            + self.log.bytes()
            + self.heap.turns.capacity() * size_of::<u128>()
            + self.ghosts.capacity() * size_of::<(u32, u32)>()
    }
}

/// Turns, the earliest first but for the rounding of a finer precision than `f64`: the
/// order in which a window is worked off changes no bit, only how much is taken back.
#[derive(Debug, Default)]
pub(super) struct Heap {
    turns: BinaryHeap<Reverse<u128>>,
    /// Bodies that others wait for.
    first: Vec<u32>,
}

impl Heap {
    #[inline(always)]
    pub fn push<T: Real>(&mut self, Turn { time, slot }: Turn<T>) {
        // Digits of numbers that are not negative are in the order of the numbers.
        let time = u128::from(time.to_f64().to_bits());
        self.turns.push(Reverse(time << u32::BITS | u128::from(slot)));
    }

    /// Puts a body before all others: one waits for it, at the same time perhaps.
    pub fn push_first(&mut self, slot: u32) {
        self.first.push(slot);
    }

    /// Forgets all turns: of a window that came to no end.
    pub fn clear(&mut self) {
        self.turns.clear();
        self.first.clear();
    }

    /// The body whose turn is next, and the digits of its time, if it has one.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<(u32, Option<u64>)> {
        if let Some(slot) = self.first.pop() {
            return Some((slot, None));
        }
        let Reverse(turn) = self.turns.pop()?;
        Some((turn as u32, Some((turn >> u32::BITS) as u64)))
    }
}

impl<'a, T: Real> Region<'a, T> {
    /// What tells the order of contacts, as [`keys`](Region::keys), beside what is put in
    /// that order.
    #[inline(always)]
    pub fn in_order(&mut self) -> (Keys<'_, T>, &mut Pieces<'a, Agenda<T>>, &mut Calendar<T>) {
        let worker = &mut *self.worker;
        let keys = Keys {
            records: &self.records,
            marks: &self.marks,
            index: self.index,
            logs: Logs { own: &worker.log, others: self.logs },
            base: base(&self.window),
        };
        (keys, &mut self.agendas, &mut worker.calendar)
    }
}

impl<T: Real> Region<'_, T> {
    /// Centre and velocity of the body in a slot at a time.
    #[inline(always)]
    pub fn state_of(&self, setting: &Setting<T>, slot: usize, time: T) -> (Vec3<T>, Vec3<T>) {
        setting.state_of(&self.records[slot].flight(), time)
    }

    /// The level of cells of the body in a slot.
    #[inline(always)]
    pub fn level_of(&self, slot: usize) -> usize {
        if self.cells.len() == 1 {
            return 0;
        }
        self.cells.level_of(self.records[slot].radius())
    }

    /// Makes room for all that can be found around a body.
    #[inline(always)]
    pub fn make_room(&mut self) {
        let most = self.cells.most();
        for found in &mut self.worker.found {
            if found.len() < most {
                found.resize(most, 0);
            }
        }
    }

    /// Whether the bodies found are all held.
    #[inline(always)]
    pub fn holds_found(&self, which: usize, len: usize) -> bool {
        self.is_whole
            || self.worker.found[which][..len].iter().all(|&slot| self.records.holds(slot as usize))
    }

    /// Whether a flight with this mark has others before it in the log.
    #[inline(always)]
    pub fn has_past(&self, mark: &Mark) -> bool {
        self.window.as_ref().is_some_and(|window| mark.stamp > window.base)
    }

    /// Whether there may be flights in the log.
    #[inline(always)]
    pub fn has_pasts(&self) -> bool {
        self.window.as_ref().is_some_and(|window| window.is_open)
    }

    pub fn logs(&self) -> Logs<'_, T> {
        Logs { own: &self.worker.log, others: self.logs }
    }

    /// The flight of an entry.
    #[inline(always)]
    pub fn past(&self, entry: EntryNumber) -> &Past<T> {
        self.logs().past(entry)
    }

    /// What tells the order of contacts.
    #[inline(always)]
    pub fn keys(&self) -> Keys<'_, T> {
        Keys {
            records: &self.records,
            marks: &self.marks,
            index: self.index,
            logs: self.logs(),
            base: base(&self.window),
        }
    }

    /// Starts a flight of the body in a slot.
    #[inline(always)]
    pub fn put(&mut self, slot: usize, flight: &Flight<T>) {
        self.records[slot] = Record::new(*flight);
        if self.screening.is_useful {
            self.coarse[slot] = self.screening.record(flight);
        }
    }

    /// Whether some more bodies can enter a cell without room for them being made, which
    /// who holds all cells always can.
    #[inline(always)]
    pub fn can_enter(&self, cell: [i32; 3], bodies: usize) -> bool {
        let cells = &self.cells.finest;
        self.is_whole || {
            let number = cells.grid.number_of(cell);
            cells.holds(number) && cells.room_in(number) >= bodies
        }
    }

    /// Registers the body in a slot, of a level, in another cell than its own. In a
    /// window it is registered in the old one as well: others may yet look for it at a
    /// time at which it was there.
    #[inline(always)]
    pub fn move_to(&mut self, level: usize, slot: u32, cell: [i32; 3]) {
        let from = self.agendas[slot as usize].cell;
        if self.window.is_none() {
            self.cells.remove(level, from, slot);
            self.cells.insert(level, cell, slot);
        } else {
            let cells = &mut self.cells.finest;
            let [from, to] = [from, cell].each(|cell| cells.grid.number_of(cell));
            if from == to {
                return;
            }
            self.worker.ghosts.push((from, slot));
            if cells.has(to, slot) {
                return;
            }
            cells.insert(to, slot);
        }
        self.make_room();
    }

    /// Takes the body in a slot out: it meets nothing any longer, and is forgotten where the
    /// next period begins.
    pub fn take_out(&mut self, setting: &Setting<T>, slot: usize) {
        if setting.plan.has_pairs {
            let (level, cell) = (self.level_of(slot), self.agendas[slot].cell);
            self.cells.remove(level, cell, slot as u32);
        }
        self.agendas[slot].end();
        let stamp = self.worker.new_stamp();
        self.marks[slot] = Mark { stamp, last: PartnerCode::OUT, ..self.marks[slot] };
    }

    /// Enters the next turn of the body in a slot.
    #[inline(always)]
    pub fn enter(&mut self, slot: u32) {
        let turn = Turn { time: self.agendas[slot as usize].next_time(), slot };
        match &self.window {
            None => super::turns::enter(self, turn),
            Some(window) => {
                self.next[slot as usize] = turn.time;
                if window.is_due(turn.time) {
                    self.worker.heap.push(turn);
                }
            }
        }
    }
}

impl<T: Real> Region<'_, T> {
    /// Takes bodies out of the cells that they have left in this window, as far as all
    /// that takes is held.
    pub fn leave_ghosts(&mut self) {
        let mut ghosts = core::mem::take(&mut self.worker.ghosts);
        ghosts.retain(|&(number, slot)| {
            let cells = &mut self.cells.finest;
            let Some(agenda) = self.agendas.get(slot as usize) else { return true };
            if !cells.holds(number) {
                return true;
            }
            if cells.grid.number_of(agenda.cell) != number {
                cells.remove(number, slot);
            }
            false
        });
        self.worker.ghosts = ghosts;
    }

    /// Lets the turn of a body wait for the next phase.
    pub fn block(&mut self, slot: u32) {
        self.next[slot as usize] = T::from_f64(f64::INFINITY);
        self.worker.blocked.push(slot);
    }

    /// Lets the bodies that have waited take their turns in the next phase.
    pub fn unblock(&mut self) {
        while let Some(slot) = self.worker.blocked.pop() {
            let at = slot as usize;
            self.next[at] = self.agendas[at].next_time();
        }
    }
}

/// The last stamp before a window; in strict order no flight has others in the log.
#[inline(always)]
pub(super) fn base<T>(window: &Option<Window<T>>) -> u32 {
    window.as_ref().map_or(u32::MAX, |window| window.base)
}
