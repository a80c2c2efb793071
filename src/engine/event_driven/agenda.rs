//! Agenda: what is ahead of each body, as far as it is known.

use core::hint::select_unpredictable;

use crate::real::Real;

/// Marks a partner that is a fixed feature, not a body.
const FIXED: u32 = 1 << 31;

/// What a body may meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PartnerCode(u32);

impl PartnerCode {
    /// Nothing yet.
    pub const NONE: Self = Self(u32::MAX);

    /// What nothing meets any longer: it was taken out.
    pub const OUT: Self = Self(u32::MAX - 1);

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

impl<T: Real> Expected<T> {
    /// No contact: one that never comes.
    fn none() -> Self {
        let never = T::from_f64(f64::INFINITY);
        Self { time: never, partner: PartnerCode::NONE, stamp: 0 }
    }

    #[inline(always)]
    fn select(is_one: bool, one: Self, other: Self) -> Self {
        Self {
            time: select_unpredictable(is_one, one.time, other.time),
            partner: select_unpredictable(is_one, one.partner, other.partner),
            stamp: select_unpredictable(is_one, one.stamp, other.stamp),
        }
    }
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
    /// The first contacts, in their order; none of them at the end.
    kept: [Expected<T>; KEPT],
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
        Self {
            leaves_cell: T::ZERO,
            complete_until: T::ZERO,
            kept: [Expected::none(); KEPT],
            exit: Exit { axis: 0, up: false },
            cell,
            aligned: [],
        }
    }

    /// Nothing is ahead of it any longer.
    pub fn end(&mut self) {
        let never = T::from_f64(f64::INFINITY);
        *self = Self { leaves_cell: never, complete_until: never, ..Self::new(self.cell) };
    }

    /// Forgets all contacts: those up to `until` are about to be found again.
    #[inline(always)]
    pub fn clear(&mut self, until: T) {
        self.kept = [Expected::none(); KEPT];
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
        let [first, second] = self.kept;
        if found.time == first.time || found.time == second.time {
            self.keep_tied(found, comes_first);
            return;
        }
        // Without branches: which of them it is cannot be predicted.
        let (is_first, is_second) = (found.time.lt(first.time), found.time.lt(second.time));
        let dropped = select_unpredictable(is_second, second.time, found.time);
        self.complete_until = self.complete_until.lesser(dropped);
        let second = Expected::select(is_second, found, second);
        self.kept =
            [Expected::select(is_first, found, first), Expected::select(is_first, first, second)];
    }

    /// Keeps a contact that has the time of one of those that are kept.
    #[cold]
    fn keep_tied(
        &mut self,
        found: Expected<T>,
        comes_first: impl Fn(&Expected<T>, &Expected<T>) -> bool,
    ) {
        if self.kept.contains(&found) {
            return;
        }
        let is_after = |kept: &Expected<T>| {
            found.time < kept.time || found.time == kept.time && !comes_first(kept, &found)
        };
        let at = self.kept.iter().position(is_after).unwrap_or(KEPT);
        let dropped = if at == KEPT { found } else { self.kept[KEPT - 1] };
        self.complete_until = self.complete_until.lesser(dropped.time);
        if at < KEPT {
            self.kept.copy_within(at..KEPT - 1, at + 1);
            self.kept[at] = found;
        }
    }

    /// Drops the first of the kept contacts.
    #[inline(always)]
    pub fn drop_first(&mut self) {
        self.kept = [self.kept[1], Expected::none()];
    }

    /// Whether the first contact has the same time as the second one, or as one that is
    /// not kept.
    #[inline(always)]
    pub fn is_tied(&self) -> bool {
        self.kept[0].time == self.kept[1].time.lesser(self.complete_until)
    }

    /// When the first contact is, or a search for one.
    #[inline(always)]
    fn contact_time(&self) -> T {
        self.kept[0].time.lesser(self.complete_until)
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
        } else if self.kept[0].partner != PartnerCode::NONE {
            Next::Meets(self.kept[0])
        } else {
            Next::Searches
        }
    }
}
