//! Agenda: what is ahead of each body, as far as it is known.

use crate::real::Real;

/// Marks a partner that is a fixed feature, not a body.
const FIXED: u32 = 1 << 31;

/// What a body may meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PartnerCode(u32);

impl PartnerCode {
    /// Nothing yet.
    pub const NONE: Self = Self(u32::MAX);

    /// A body, by its slot or by its index.
    #[inline(always)]
    pub fn body(number: u32) -> Self {
        Self(number)
    }

    /// The number that stands for it in a snapshot.
    #[cfg(feature = "files")]
    pub fn code(self) -> u32 {
        self.0
    }

    /// What a number in a snapshot stands for.
    #[cfg(feature = "files")]
    pub fn from_code(code: u32) -> Self {
        Self(code)
    }

    /// A fixed feature.
    #[inline(always)]
    pub fn feature(number: u32) -> Self {
        Self(number | FIXED)
    }

    /// `Ok` the body's number, `Err` the feature's.
    #[inline(always)]
    pub fn decoded(self) -> Result<u32, u32> {
        if self.0 & FIXED == 0 { Ok(self.0) } else { Err(self.0 & !FIXED) }
    }
}

/// A contact that happens unless the partner's motion changes before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Expected<T> {
    /// When, since the period's start.
    pub time: T,
    /// The partner, by slot.
    pub partner: PartnerCode,
    /// The stamp of the partner's flight; 0 of a feature.
    pub stamp: u32,
}

/// The face of a cell that a body leaves it through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Exit {
    pub axis: u8,
    pub up: bool,
}

/// How many contacts a body keeps. With one, 0.06 searches a collision are made
/// again since the partner has met another body before; with two, 0.01.
const KEPT: usize = 2;

/// What is ahead of a body, on cache lines of its own.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Agenda<T: Real> {
    /// When it leaves its cell.
    pub leaves_cell: T,
    /// Up to when every contact that its own motion leads to is among the kept
    /// ones, or in the agenda of a partner that has changed later.
    complete_until: T,
    kept: [Expected<T>; KEPT],
    len: u16,
    /// Through which face it leaves its cell.
    pub exit: Exit,
    /// Its cell's coordinates in the unbounded grid.
    pub cell: [i32; 3],
    aligned: [T::Pack8; 0],
}

/// What a body does next.
#[derive(Clone, Copy, Debug)]
pub(super) enum Next<T> {
    /// It leaves its cell.
    LeavesCell,
    /// It meets a partner, if that has not changed since.
    Meets(Expected<T>),
    /// What comes after is not known.
    Searches,
}

impl<T: Real> Agenda<T> {
    /// A body of which nothing is known yet.
    pub fn new(cell: [i32; 3]) -> Self {
        let none = Expected { time: T::ZERO, partner: PartnerCode::NONE, stamp: 0 };
        Self {
            leaves_cell: T::ZERO,
            complete_until: T::ZERO,
            kept: [none; KEPT],
            len: 0,
            exit: Exit { axis: 0, up: false },
            cell,
            aligned: [],
        }
    }

    /// Forgets all contacts: those up to `until` are about to be found again.
    #[inline(always)]
    pub fn clear(&mut self, until: T) {
        self.len = 0;
        self.complete_until = until;
    }

    /// Up to when a contact is worth keeping.
    #[inline(always)]
    pub fn complete_until(&self) -> T {
        self.complete_until
    }

    /// Keeps a contact if it is among the first. `comes_first` orders contacts
    /// of equal times.
    #[inline(always)]
    pub fn keep(
        &mut self,
        found: Expected<T>,
        comes_first: impl Fn(&Expected<T>, &Expected<T>) -> bool,
    ) {
        if found.time.ge(self.complete_until) {
            return;
        }
        let len = self.len as usize;
        let mut at = len;
        while at > 0 {
            let kept = self.kept[at - 1];
            if kept == found {
                // Found before.
                return;
            }
            if kept.time < found.time || (kept.time == found.time && comes_first(&kept, &found)) {
                break;
            }
            at -= 1;
        }
        if len == KEPT {
            let dropped = if at == KEPT { found } else { self.kept[KEPT - 1] };
            self.complete_until = dropped.time;
            if at == KEPT {
                return;
            }
        } else {
            self.len += 1;
        }
        for k in (at + 1..self.len as usize).rev() {
            self.kept[k] = self.kept[k - 1];
        }
        self.kept[at] = found;
    }

    /// Drops the first of the kept contacts.
    #[inline(always)]
    pub fn drop_first(&mut self) {
        for k in 1..KEPT {
            self.kept[k - 1] = self.kept[k];
        }
        self.len -= 1;
    }

    /// Whether the first contact has the same time as the second one, or as one that is
    /// not kept.
    #[inline(always)]
    pub fn is_tied(&self) -> bool {
        let next = if self.len > 1 { self.kept[1].time } else { self.complete_until };
        self.len > 0 && self.kept[0].time == next
    }

    /// When the first contact is, or a search for one.
    #[inline(always)]
    fn contact_time(&self) -> T {
        if self.len > 0 { self.kept[0].time } else { self.complete_until }
    }

    /// When the body has to be looked at next.
    #[inline(always)]
    pub fn next_time(&self) -> T {
        self.leaves_cell.lesser(self.contact_time())
    }

    /// What the body does at [`next_time`](Agenda::next_time). It leaves a cell
    /// before it meets a body at the same time: the bodies of the next one must be
    /// known by then.
    #[inline(always)]
    pub fn next(&self) -> Next<T> {
        if self.leaves_cell <= self.contact_time() {
            Next::LeavesCell
        } else if self.len > 0 {
            Next::Meets(self.kept[0])
        } else {
            Next::Searches
        }
    }
}
