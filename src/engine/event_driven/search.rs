//! Search: what a body will meet.

use super::agenda::{Expected, PartnerCode};
use super::features::search_features;
use super::flight::{Flight, WIDEST};
use super::meeting::{TOGETHER, meeting};
use super::region::Region;
use super::setting::Setting;
use crate::engine::account::Effort;
use crate::engine::plan::Plan;
use crate::lane::Lane;
use crate::motion::integrator::{Coasting, FlightStep, VelocityVerlet};
use crate::real::Real;
use crate::space::cells::Cells;
use crate::space::{OpenSpace, Space};
use crate::vec3::Vec3;

/// Looks for the contacts of the body in a slot with the `len` bodies found.
pub(super) type Search<T> =
    fn(&Setting<T>, &mut Region<T>, &mut Effort, slot: u32, len: usize, now: T);

/// Finds again what the body in a slot will meet in a period of this length.
pub(super) fn search<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    effort: &mut Effort,
    slot: u32,
    now: T,
    period: T,
) {
    let agenda = &mut region.agendas[slot as usize];
    agenda.clear(period);
    let cell = agenda.cell;
    if setting.plan.features > 0 {
        search_features(setting, region, slot);
    }
    if setting.plan.has_pairs {
        if region.cells.len() == 1 {
            let len = region.cells.finest().around(cell, &mut region.found);
            (setting.search_bodies)(setting, region, effort, slot, len, now);
            return;
        }
        let level = region.level_of(slot as usize);
        let own = region.cells.cell_at(level, cell);
        let len = region.cells.at(level).around(own, &mut region.found);
        (setting.search_bodies)(setting, region, effort, slot, len, now);
        search_greater(setting, region, effort, slot, level, now);
        for finer in level + 1..region.cells.len() {
            search_shell(setting, region, effort, slot, [level, finer], now);
        }
    }
}

/// Looks for contacts of the body in a slot, of a level, with bodies of coarser
/// levels.
pub(super) fn search_greater<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    effort: &mut Effort,
    slot: u32,
    level: usize,
    now: T,
) {
    for coarser in 0..level {
        let cell = region.cells.cell_at(coarser, region.agendas[slot as usize].cell);
        let len = region.cells.at(coarser).around(cell, &mut region.found);
        if len > 0 {
            (setting.search_bodies)(setting, region, effort, slot, len, now);
        }
    }
}

/// Looks for contacts of the body in a slot, of the first of two levels, with bodies
/// of the second, finer one.
pub(super) fn search_shell<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    effort: &mut Effort,
    slot: u32,
    [level, finer]: [usize; 2],
    now: T,
) {
    let middle = region.cells.cell_at(finer, region.agendas[slot as usize].cell);
    let cells = region.cells.at(finer);
    // Room for one more cell, and to fill up the last pack.
    let full = region.found.len() - cells.most_in_cell() - WIDEST;
    let mut len = 0;
    for row in 0..region.cells.shell(level, finer).len() {
        for cell in region.cells.shell(level, finer)[row].cells(middle) {
            len = region.cells.at(finer).read_cell(cell, &mut region.found, len);
            if len > full {
                (setting.search_bodies)(setting, region, effort, slot, len, now);
                len = 0;
            }
        }
    }
    if len > 0 {
        (setting.search_bodies)(setting, region, effort, slot, len, now);
    }
}

fn search_open<T, L, C, F>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    effort: &mut Effort,
    slot: u32,
    len: usize,
    now: T,
) where
    T: Real,
    L: Lane<Scalar = T>,
    C: Lane<Scalar = T::Coarse>,
    F: FlightStep,
{
    let search = Found { setting, slot, now, space: OpenSpace, coarse: OpenSpace };
    search.run::<L, C, F>(region, effort, len);
}

fn search_periodic<T, L, C, F>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    effort: &mut Effort,
    slot: u32,
    len: usize,
    now: T,
) where
    T: Real,
    L: Lane<Scalar = T>,
    C: Lane<Scalar = T::Coarse>,
    F: FlightStep,
{
    if let (Some(space), Some(coarse)) = (setting.periodic, region.coarse.periodic) {
        let search = Found { setting, slot, now, space, coarse };
        search.run::<L, C, F>(region, effort, len);
    }
}

/// A search among the bodies found.
struct Found<'a, T: Real, S, R> {
    setting: &'a Setting<T>,
    slot: u32,
    now: T,
    space: S,
    coarse: R,
}

impl<T: Real, S: Space<T>, R: Space<T::Coarse>> Found<'_, T, S, R> {
    #[inline(always)]
    fn run<L, C, F>(&self, region: &mut Region<T>, effort: &mut Effort, len: usize)
    where
        L: Lane<Scalar = T>,
        C: Lane<Scalar = T::Coarse>,
        F: FlightStep,
    {
        effort.tried += len as u64;
        if region.records[self.slot as usize].flight().since == self.now {
            let len = self.screened::<C, F, true>(region, len);
            effort.remaining += len as u64;
            self.search_packs::<L, F, true>(region, len);
        } else {
            let len = self.screened::<C, F, false>(region, len);
            effort.remaining += len as u64;
            self.search_packs::<L, F, false>(region, len);
        }
    }

    /// Passes over those of the bodies found that cannot be met. The last pack
    /// is filled up with the body itself, which never meets itself.
    #[inline(always)]
    fn screened<C, F, const STARTS: bool>(&self, region: &mut Region<T>, len: usize) -> usize
    where
        C: Lane<Scalar = T::Coarse>,
        F: FlightStep,
    {
        // Otherwise the coarse precision is this one.
        if const { size_of::<T::Coarse>() == size_of::<T>() } || !region.coarse.is_useful {
            return len;
        }
        let whole = len.next_multiple_of(C::WIDTH);
        let found = &mut region.found[..whole];
        found[len..].fill(self.slot);
        let now = T::Coarse::from_f64(self.now.to_f64());
        let further = &self.setting.coarse_further;
        region.coarse.screen::<C, F, R, STARTS>(self.slot, found, now, self.coarse, further)
    }

    /// Looks for contacts with the bodies found, in whole packs, the last one
    /// filled up with the body itself.
    #[inline(always)]
    fn search_packs<L, F, const STARTS: bool>(&self, region: &mut Region<T>, len: usize)
    where
        L: Lane<Scalar = T>,
        F: FlightStep,
    {
        let &Self { setting, slot, now, space, .. } = self;
        let end = len.next_multiple_of(L::WIDTH);
        region.found[len..end].fill(slot);
        let own = region.records[slot as usize].flight();
        let (flight, gravity) = (Flight::<L>::splat(&own), Vec3::<L>::splat(setting.gravity));
        let at = L::splat(now);
        for &image in &setting.further {
            let further = Vec3::<L>::splat(image);
            for start in (0..end).step_by(TOGETHER) {
                let end = end.min(start + TOGETHER);
                for (pack, found) in region.found[start..end].chunks_exact(L::WIDTH).enumerate() {
                    let others = Flight::<L>::gather(&region.records, found);
                    let met =
                        meeting::<L, F, S, STARTS>(&flight, &others, gravity, space, further, at);
                    region.meetings.put(pack * L::WIDTH, &met);
                }
                while let Some((k, time)) = region.meetings.take() {
                    let other = region.found[start + k];
                    if time.ge(region.agendas[slot as usize].complete_until()) {
                        continue;
                    }
                    if met_last(region, slot as usize, other as usize) {
                        // Rounding may tell that two bodies that have just met
                        // approach again. Through the other side of a periodic
                        // box they may well meet.
                        let other = region.records[other as usize].flight();
                        let gravity = setting.gravity;
                        let met =
                            meeting::<T, F, S, STARTS>(&own, &other, gravity, space, image, now);
                        if met.is_touching() {
                            continue;
                        }
                    }
                    let changes = region.marks[other as usize].changes;
                    let partner = PartnerCode::body(other);
                    keep(region, slot, Expected { time, partner, changes });
                }
            }
        }
    }
}

/// Keeps a contact of the body in a slot if it is among its first.
#[inline(always)]
pub(super) fn keep<T: Real>(region: &mut Region<T>, slot: u32, found: Expected<T>) {
    let index = &region.index;
    let comes_first = |a, b| rank(index, slot, a) < rank(index, slot, b);
    region.agendas[slot as usize].keep(found, comes_first);
}

/// Whether each of two bodies has met no other since they met each other.
#[inline(always)]
fn met_last<T: Real>(region: &Region<T>, a: usize, b: usize) -> bool {
    let is_last = |a: usize, b: usize| region.marks[a].last == PartnerCode::body(region.index[b]);
    is_last(a, b) && is_last(b, a)
}

/// The order of contacts at equal times: by the first body of the scene, the
/// surroundings before other bodies.
pub(super) fn rank(index: &[u32], slot: u32, partner: PartnerCode) -> (u32, bool, u32) {
    let own = index[slot as usize];
    match partner.decoded() {
        Ok(other) => {
            let other = index[other as usize];
            (own.min(other), true, own.max(other))
        }
        Err(feature) => (own, false, feature),
    }
}

/// The search of a plan. Widths that the plan of a precision never chooses are
/// not compiled for it.
pub(super) fn searcher<T: Real>(plan: &Plan, is_periodic: bool) -> Search<T> {
    type Pack4<T> = <<T as Real>::Coarse as Real>::Pack4;
    type Pack8<T> = <<T as Real>::Coarse as Real>::Pack8;
    type Pack16<T> = <<T as Real>::Coarse as Real>::Pack16;
    if const { <T::Pack8 as Lane>::WIDTH == 1 } {
        return searcher_in::<T, T, Pack16<T>>(plan, is_periodic);
    }
    if const { size_of::<T::Coarse>() < size_of::<T>() } && plan.sweep_lanes > plan.gather_lanes {
        return match plan.gather_lanes {
            4 => searcher_in::<T, T::Pack4, Pack16<T>>(plan, is_periodic),
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
pub(super) fn further<T: Real, R: Real>(cells: &Cells<T>, is_periodic: bool) -> Vec<Vec3<R>> {
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
