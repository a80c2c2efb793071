//! Search: what a body will meet.

use super::agenda::{Expected, PartnerCode};
use super::coarse::Screen;
use super::features::search_features;
use super::flight::{Flight, WIDEST};
use super::meeting::{TOGETHER, meeting};
use super::region::Region;
use super::setting::Setting;
use crate::engine::plan::{Plan, SCREENED};
use crate::lane::{Lane, Mask, ones};
use crate::motion::integrator::{Coasting, FlightStep, VelocityVerlet};
use crate::real::Real;
use crate::space::cells::Grid;
use crate::space::{OpenSpace, Space};
use crate::vec3::Vec3;

/// Some of the work has to wait: it needs what another worker holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blocked;

/// Bodies found near one: the number of the list they are in, and how many there are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearby {
    pub list: usize,
    pub len: usize,
}

/// Looks for the contacts of the body in a slot with bodies found near it.
pub(super) type Search<T> = fn(&Setting<T>, &mut Region<'_, T>, slot: u32, Nearby, now: T);

/// Finds the bodies of its own level near the body in a slot, which is in a cell or is
/// about to enter it. Before the first write: it may be blocked.
#[inline(always)]
pub(super) fn find<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    list: usize,
    slot: u32,
    cell: [i32; 3],
) -> Result<Nearby, Blocked> {
    if !setting.plan.has_pairs {
        return Ok(Nearby { list, len: 0 });
    }
    let level = region.level_of(slot as usize);
    let cell = region.cells.cell_at(level, cell);
    let len = region.cells.at(level).around(cell, &mut region.worker.found[list]).ok_or(Blocked)?;
    if region.holds_found(list, len) { Ok(Nearby { list, len }) } else { Err(Blocked) }
}

/// Finds again what the body in a slot will meet in a period of this length; bodies of
/// its own level have been found.
#[inline(always)]
pub(super) fn search<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    nearby: Nearby,
    now: T,
    period: T,
) {
    region.agendas[slot as usize].clear(period);
    if setting.plan.features > 0 {
        search_features(setting, region, slot, now);
    }
    if setting.plan.has_pairs {
        (setting.search_bodies)(setting, region, slot, nearby, now);
        if region.cells.len() > 1 {
            let level = region.level_of(slot as usize);
            search_greater(setting, region, slot, level, now);
            for finer in level + 1..region.cells.len() {
                search_shell(setting, region, slot, [level, finer], now);
            }
        }
    }
}

/// Looks for contacts of the body in a slot, of a level, with bodies of coarser
/// levels.
pub(super) fn search_greater<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    level: usize,
    now: T,
) {
    for coarser in 0..level {
        let cell = region.cells.cell_at(coarser, region.agendas[slot as usize].cell);
        let len = region.cells.at(coarser).around(cell, &mut region.worker.found[0]);
        if let Some(len) = len.filter(|&len| len > 0) {
            (setting.search_bodies)(setting, region, slot, Nearby { list: 0, len }, now);
        }
    }
}

/// Looks for contacts of the body in a slot, of the first of two levels, with bodies
/// of the second, finer one.
pub(super) fn search_shell<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    [level, finer]: [usize; 2],
    now: T,
) {
    let middle = region.cells.cell_at(finer, region.agendas[slot as usize].cell);
    // Room for one more cell, and to fill up the last pack.
    let most_in_cell = region.cells.at(finer).most_in_cell();
    let full = region.worker.found[0].len() - most_in_cell - WIDEST;
    let mut len = 0;
    for row in region.cells.shell(level, finer) {
        for cell in row.cells(middle) {
            len = region.cells.at(finer).read_cell(cell, &mut region.worker.found[0], len);
            if len > full {
                (setting.search_bodies)(setting, region, slot, Nearby { list: 0, len }, now);
                len = 0;
            }
        }
    }
    if len > 0 {
        (setting.search_bodies)(setting, region, slot, Nearby { list: 0, len }, now);
    }
}

fn search_open<T, L, C, F>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    nearby: Nearby,
    now: T,
) where
    T: Real,
    L: Lane<Scalar = T>,
    C: Lane<Scalar = T::Coarse>,
    F: FlightStep,
{
    let list = nearby.list;
    let search = Found { setting, slot, list, now, space: OpenSpace, coarse: OpenSpace };
    search.run::<L, C, F>(region, nearby.len);
}

fn search_periodic<T, L, C, F>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    nearby: Nearby,
    now: T,
) where
    T: Real,
    L: Lane<Scalar = T>,
    C: Lane<Scalar = T::Coarse>,
    F: FlightStep,
{
    if let (Some(space), Some(coarse)) = (setting.periodic, region.screening.periodic) {
        let search = Found { setting, slot, list: nearby.list, now, space, coarse };
        search.run::<L, C, F>(region, nearby.len);
    }
}

/// A search among the bodies found.
struct Found<'a, T: Real, S, R> {
    setting: &'a Setting<T>,
    slot: u32,
    /// The list of bodies found.
    list: usize,
    now: T,
    space: S,
    coarse: R,
}

/// The list of bodies that screening has left over.
const REMAINING: usize = 2;

impl<T: Real, S: Space<T>, R: Space<T::Coarse>> Found<'_, T, S, R> {
    #[inline(always)]
    fn run<L, C, F>(&self, region: &mut Region<'_, T>, len: usize)
    where
        L: Lane<Scalar = T>,
        C: Lane<Scalar = T::Coarse>,
        F: FlightStep,
    {
        region.worker.account.effort.tried += len as u64;
        // In a window others may start later than now.
        let has_pasts = region.has_pasts();
        region.worker.later.clear();
        let starts = region.records[self.slot as usize].since() == self.now;
        // One, but in narrow boxes.
        for image in 0..self.setting.further.len() {
            let nearby = if starts {
                self.screened::<C, F, true>(region, len, image, has_pasts)
            } else {
                self.screened::<C, F, false>(region, len, image, has_pasts)
            };
            region.worker.account.effort.remaining += nearby.len as u64;
            if starts && !has_pasts {
                self.search_packs::<L, F, true>(region, nearby, image, false);
            } else {
                self.search_packs::<L, F, false>(region, nearby, image, has_pasts);
            }
        }
        if has_pasts {
            self.search_pasts::<F>(region);
        }
    }

    /// Passes over those of the bodies found that cannot be met. The last pack
    /// is filled up with the body itself, which never meets itself.
    #[inline(always)]
    fn screened<C, F, const STARTS: bool>(
        &self,
        region: &mut Region<'_, T>,
        len: usize,
        image: usize,
        has_pasts: bool,
    ) -> Nearby
    where
        C: Lane<Scalar = T::Coarse>,
        F: FlightStep,
    {
        let &Self { setting, slot, list, now, coarse: space, .. } = self;
        // Otherwise the coarse precision is this one.
        if const { size_of::<T::Coarse>() == size_of::<T>() } || !region.screening.is_useful {
            return Nearby { list, len };
        }
        let [first, second, remaining] = &mut region.worker.found;
        let found = filled_up::<C>(if list == 0 { first } else { second }, len, slot);
        let now = T::Coarse::from_f64(now.to_f64());
        let further = setting.coarse_further[image];
        let later = has_pasts.then_some(&mut region.worker.later);
        let screen = Screen { records: &region.coarse, slot, now, space, further };
        let len = screen.run::<C, F, STARTS>(region.screening, found, remaining, later);
        Nearby { list: REMAINING, len }
    }

    /// Looks for contacts with an image of each of the bodies found, in whole packs, the
    /// last one filled up with the body itself.
    #[inline(always)]
    fn search_packs<L, F, const STARTS: bool>(
        &self,
        region: &mut Region<'_, T>,
        Nearby { list, len }: Nearby,
        image: usize,
        has_pasts: bool,
    ) where
        L: Lane<Scalar = T>,
        F: FlightStep,
    {
        let &Self { setting, slot, now, space, .. } = self;
        let image = setting.further[image];
        let whole = filled_up::<L>(&mut region.worker.found[list], len, slot).len();
        let own = region.records[slot as usize].flight();
        let (flight, gravity) = (Flight::<L>::splat(&own), Vec3::<L>::splat(setting.gravity));
        let (at, further) = (L::splat(now), Vec3::<L>::splat(image));
        let is_unscreened = has_pasts && !region.screening.is_useful;
        let mut start = 0;
        while start < whole {
            let end = whole.min(start + TOGETHER);
            let worker = &mut *region.worker;
            let together = &worker.found[list][start..end];
            let mut starts_later = 0;
            for (pack, found) in together.chunks_exact(L::WIDTH).enumerate() {
                let others = Flight::<L>::gather(&region.records, found);
                starts_later |= u64::from(others.since.ge(at).bits()) << (pack * L::WIDTH);
                let met = meeting::<L, F, S, STARTS>(&flight, &others, gravity, space, further, at);
                worker.meetings.put(pack * L::WIDTH, &met);
            }
            if is_unscreened {
                worker.later.extend(ones(starts_later).map(|k| together[k]));
            }
            while let Some((k, time)) = region.worker.meetings.take() {
                let other = region.worker.found[list][start + k];
                let is_touching = |region: &Region<'_, T>| {
                    let flight = region.records[other as usize].flight();
                    let gravity = setting.gravity;
                    meeting::<T, F, S, STARTS>(&own, &flight, gravity, space, image, now)
                        .is_touching()
                };
                self.expect(region, other, time, is_touching);
            }
            start = end;
        }
    }

    /// Expects a contact with the body in another slot.
    #[inline(always)]
    fn expect(
        &self,
        region: &mut Region<'_, T>,
        other: u32,
        time: T,
        is_touching: impl FnOnce(&Region<'_, T>) -> bool,
    ) {
        let has_met_last = |one: u32, another: u32| {
            let code = PartnerCode::body(region.index[another as usize]);
            region.marks[one as usize].last == code
        };
        // Rounding may tell that two bodies that have just met approach again. Through the
        // other side of a periodic box they may well meet.
        if has_met_last(self.slot, other) && has_met_last(other, self.slot) && is_touching(region) {
            return;
        }
        let stamp = region.marks[other as usize].stamp;
        let partner = PartnerCode::body(other);
        keep(region, self.slot, Expected { time, partner, stamp });
    }

    /// Looks for contacts with the flights that others have ended since now in this
    /// window. Such a contact is expected like any other: when its time comes, what the
    /// other has met afterwards is taken back.
    #[inline(never)]
    fn search_pasts<F: FlightStep>(&self, region: &mut Region<'_, T>) {
        while let Some(other) = region.worker.later.pop() {
            let mark = region.marks[other as usize];
            if other != self.slot && region.has_past(&mark) {
                self.search_pasts_of::<F>(region, other);
            }
        }
    }

    fn search_pasts_of<F: FlightStep>(&self, region: &mut Region<'_, T>, other: u32) {
        let &Self { setting, slot, now, space, .. } = self;
        let own = region.records[slot as usize].flight();
        let own_mark = region.marks[slot as usize];
        let radius = region.records[other as usize].radius();
        let mut mark = region.marks[other as usize];
        while region.has_past(&mark) {
            let past = region.past(mark.before);
            if past.end < now {
                return;
            }
            mark = past.mark;
            // What follows the own start comes after an end that does not.
            let is_after = past.end == own.since && past.generation < own_mark.follows;
            if is_after {
                continue;
            }
            let flight = past.flight(radius);
            let (gravity, still) = (setting.gravity, Vec3::ZERO);
            let met = meeting::<T, F, S, false>(&own, &flight, gravity, space, still, now);
            let (start, stamp) = (past.since, past.mark.stamp);
            if !met.meets() {
                if start < now {
                    return;
                }
                continue;
            }
            let (_, time) = met.contact();
            let expected = Expected { time, partner: PartnerCode::body(other), stamp };
            let is_before_end = || {
                time < past.end
                    || time == past.end
                        && region.keys().of(slot, &expected) < past.end_key(region.index, other)
            };
            let have_met = own_mark.last == PartnerCode::body(region.index[other as usize])
                && past.mark.last == PartnerCode::body(region.index[slot as usize]);
            if is_before_end() && !(have_met && met.is_touching()) {
                keep(region, slot, expected);
            }
            if start < now {
                return;
            }
        }
    }
}

/// The bodies found, in whole packs: the last one is filled up with the body in a slot.
#[inline(always)]
fn filled_up<L: Lane>(found: &mut [u32], len: usize, slot: u32) -> &mut [u32] {
    // All of a pack: a number of moves that is known beforehand.
    found[len..len + L::WIDTH].fill(slot);
    &mut found[..len.next_multiple_of(L::WIDTH)]
}

/// Keeps a contact of the body in a slot if it is among its first.
#[inline(always)]
pub(super) fn keep<T: Real>(region: &mut Region<'_, T>, slot: u32, found: Expected<T>) {
    let (keys, agendas, _) = region.in_order();
    let comes_first = |a: &Expected<T>, b: &Expected<T>| keys.of(slot, a) < keys.of(slot, b);
    agendas[slot as usize].keep(found, comes_first);
}

/// The search of a plan. Widths that the plan of a precision never chooses are
/// not compiled for it.
pub(super) fn searcher<T: Real>(plan: &Plan, is_periodic: bool) -> Search<T> {
    type Pack4<T> = <<T as Real>::Coarse as Real>::Pack4;
    type Pack8<T> = <<T as Real>::Coarse as Real>::Pack8;
    type Pack16<T> = <<T as Real>::Coarse as Real>::Pack16;
    if const { <T::Pack8 as Lane>::WIDTH == 1 } {
        return if const { SCREENED == 16 } {
            searcher_in::<T, T, Pack16<T>>(plan, is_periodic)
        } else {
            searcher_in::<T, T, Pack8<T>>(plan, is_periodic)
        };
    }
    if const { size_of::<T::Coarse>() < size_of::<T>() } && plan.sweep_lanes > plan.gather_lanes {
        return match plan.gather_lanes {
            4 if const { SCREENED == 16 } => {
                searcher_in::<T, T::Pack4, Pack16<T>>(plan, is_periodic)
            }
            4 => searcher_in::<T, T::Pack4, Pack8<T>>(plan, is_periodic),
            _ => searcher_in::<T, T::Pack8, Pack16<T>>(plan, is_periodic),
        };
    }
    match plan.gather_lanes {
        1 => searcher_in::<T, T, T::Coarse>(plan, is_periodic),
        4 => searcher_in::<T, T::Pack4, Pack4<T>>(plan, is_periodic),
        _ => searcher_in::<T, T::Pack8, Pack8<T>>(plan, is_periodic),
    }
}

fn searcher_in<T, L, C>(plan: &Plan, is_periodic: bool) -> Search<T>
where
    T: Real,
    L: Lane<Scalar = T>,
    C: Lane<Scalar = T::Coarse>,
{
    match (plan.has_field, is_periodic) {
        (false, false) => search_open::<T, L, C, Coasting>,
        (false, true) => search_periodic::<T, L, C, Coasting>,
        (true, false) => search_open::<T, L, C, VelocityVerlet>,
        (true, true) => search_periodic::<T, L, C, VelocityVerlet>,
    }
}

/// The images of a pair, besides the nearest, that can be near at once, and the
/// nearest, in whole boxes.
pub(super) fn further<T: Real, R: Real>(cells: &Grid<T>, is_periodic: bool) -> Vec<Vec3<R>> {
    let is_narrow = |axis: usize| is_periodic && cells.is_narrow(axis);
    let along = |axis: usize| if is_narrow(axis) { -1..=1 } else { 0..=0 };
    let mut further = Vec::new();
    for z in along(2).map(R::whole) {
        for y in along(1).map(R::whole) {
            further.extend(along(0).map(|x| Vec3::new(R::whole(x), y, z)));
        }
    }
    further
}
