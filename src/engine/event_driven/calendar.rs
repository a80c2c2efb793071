//! Calendar: which body is next, at a cost that does not grow with the bodies.
//!
//! The period is cut into spans of equal length. A body is put down in the span
//! of its turn as it comes, unsorted, and without its time, which is in its
//! agenda; a span is sorted when its time has come, and bodies that are due no
//! longer in it are thrown out then (a calendar queue, Brown 1988, without
//! removal).

use core::cmp::Ordering;

use super::tight;
use crate::real::Real;

/// A body's turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn<T> {
    /// Time since the period's start.
    pub time: T,
    /// The body's slot.
    pub slot: u32,
}

/// Places that lie together in memory, on one cache line: few enough to waste
/// little at the end of a span, many enough that reading a span is no chase of
/// pointers.
const CHUNK: usize = 14;

const NO_CHUNK: u32 = u32::MAX;

/// The most spans: beyond, each has more entries.
const MOST_SPANS: usize = 1 << 24;

#[derive(Clone, Copy, Debug)]
struct Chunk {
    slots: [u32; CHUNK],
    len: u32,
    /// The chunk before, of the same span or of the free ones.
    before: u32,
}

/// The turns of all bodies in a period.
#[derive(Debug)]
pub(super) struct Calendar<T> {
    end: T,
    spans_per_time: T,
    /// The last chunk of each span.
    last: Vec<u32>,
    chunks: Vec<Chunk>,
    free: u32,
    /// The span that is being worked off.
    span: usize,
    /// Its turns, the last one first.
    now: Vec<Turn<T>>,
}

impl<T: Real> Calendar<T> {
    pub fn new() -> Self {
        Self {
            end: T::ZERO,
            spans_per_time: T::ZERO,
            last: Vec::new(),
            chunks: Vec::new(),
            free: NO_CHUNK,
            span: 0,
            now: Vec::new(),
        }
    }

    /// An empty calendar for a period of this length, with about `together` of
    /// its turns in a span if there are as many in a time as were counted.
    pub fn begin(&mut self, period: T, turns_per_time: f64, together: f64) {
        let spans = (turns_per_time * period.to_f64() / together) as usize;
        let spans = spans.clamp(1, MOST_SPANS);
        self.end = period;
        self.spans_per_time = T::from_f64(spans as f64) / period;
        self.last.clear();
        self.last.resize(spans, NO_CHUNK);
        self.chunks.clear();
        self.free = NO_CHUNK;
        self.span = 0;
        self.now.clear();
    }

    /// Enters a turn, if it is in this period. `time_of` says when the turn of the body
    /// at a slot is now, `order` is that of slots whose turns have equal times.
    #[inline(always)]
    pub fn enter(
        &mut self,
        turn: Turn<T>,
        time_of: impl Fn(u32) -> T,
        order: impl Fn(u32, u32) -> Ordering,
    ) {
        if !turn.time.lt(self.end) {
            return;
        }
        let span = self.span_of(turn.time);
        if span > self.span {
            self.append(span, turn.slot);
            return;
        }
        // Among the present ones, which are few.
        let mut at = self.now.len();
        while at > 0 {
            let other = self.now[at - 1];
            if other == turn || time_of(other.slot) != other.time {
                // Its turn has the same time as before and another rank, or it is one
                // of before, whose rank says nothing.
                self.now.remove(at - 1);
            } else if compared(self.now[at - 1], turn, &order) != Ordering::Less {
                break;
            }
            at -= 1;
        }
        self.now.insert(at, turn);
    }

    #[inline(always)]
    fn span_of(&self, time: T) -> usize {
        ((time * self.spans_per_time).whole_part() as usize).min(self.last.len() - 1)
    }

    #[inline(always)]
    fn append(&mut self, span: usize, slot: u32) {
        let mut last = self.last[span];
        if last == NO_CHUNK || self.chunks[last as usize].len as usize == CHUNK {
            let before = last;
            if self.free == NO_CHUNK {
                last = self.chunks.len() as u32;
                tight::push(&mut self.chunks, Chunk { slots: [slot; CHUNK], len: 0, before });
            } else {
                last = self.free;
                let chunk = &mut self.chunks[last as usize];
                self.free = chunk.before;
                chunk.len = 0;
                chunk.before = before;
            }
            self.last[span] = last;
        }
        let chunk = &mut self.chunks[last as usize];
        chunk.slots[chunk.len as usize % CHUNK] = slot;
        chunk.len += 1;
    }

    /// The next turn, left in the calendar. `time_of` says when the turn of the
    /// body at a slot is now; others are dropped.
    #[inline(always)]
    pub fn next(
        &mut self,
        time_of: impl Fn(u32) -> T,
        order: impl Fn(u32, u32) -> Ordering,
    ) -> Option<Turn<T>> {
        loop {
            while let Some(&turn) = self.now.last() {
                if time_of(turn.slot) == turn.time {
                    return Some(turn);
                }
                self.now.pop();
            }
            if !self.open_next(&time_of, &order) {
                return None;
            }
        }
    }

    /// Takes the present turn off.
    #[inline(always)]
    pub fn take(&mut self) {
        self.now.pop();
    }

    /// Takes the turns of two bodies off that come next, at a time: they are about to start
    /// flights, and what follows from those at this time has another place in the order.
    #[inline(always)]
    pub fn forget(&mut self, time: T, slots: [u32; 2]) {
        let mut at = self.now.len();
        while at > 0 && self.now[at - 1].time == time {
            at -= 1;
            if slots.contains(&self.now[at].slot) {
                self.now.remove(at);
            }
        }
    }

    /// Opens the next span; false after the last.
    fn open_next(
        &mut self,
        time_of: &impl Fn(u32) -> T,
        order: &impl Fn(u32, u32) -> Ordering,
    ) -> bool {
        if self.span + 1 >= self.last.len() {
            return false;
        }
        self.span += 1;
        let mut last = core::mem::replace(&mut self.last[self.span], NO_CHUNK);
        while last != NO_CHUNK {
            let chunk = self.chunks[last as usize];
            for &slot in &chunk.slots[..chunk.len as usize] {
                let time = time_of(slot);
                if time < self.end && self.span_of(time) == self.span {
                    self.now.push(Turn { time, slot });
                }
            }
            let chunk = &mut self.chunks[last as usize];
            let before = core::mem::replace(&mut chunk.before, self.free);
            self.free = last;
            last = before;
        }
        self.now.sort_unstable_by(|a, b| compared(*b, *a, order));
        true
    }

    /// The bytes that the calendar holds.
    pub fn bytes(&self) -> usize {
        self.last.capacity() * size_of::<u32>()
            + self.chunks.capacity() * size_of::<Chunk>()
            + self.now.capacity() * size_of::<Turn<T>>()
    }
}

#[inline(always)]
fn compared<T: Real>(a: Turn<T>, b: Turn<T>, order: &impl Fn(u32, u32) -> Ordering) -> Ordering {
    let times = a.time.partial_cmp(&b.time).unwrap_or(Ordering::Equal);
    times.then_with(|| order(a.slot, b.slot))
}
