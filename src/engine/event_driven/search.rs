//! Search: what a body will meet.

use super::EventDriven;
use super::agenda::{Expected, PartnerCode};
use super::cells::Cells;
use super::flight::Flight;
use super::meeting::{TOGETHER, meeting};
use crate::engine::plan::Plan;
use crate::lane::Lane;
use crate::motion::integrator::{Coasting, FlightStep, VelocityVerlet};
use crate::real::Real;
use crate::space::{OpenSpace, Space};
use crate::vec3::Vec3;

/// Looks for the contacts of the body at a place with the `len` bodies found.
pub(super) type Search<T> = fn(&mut EventDriven<T>, place: u32, len: usize, now: T);

impl<T: Real> EventDriven<T> {
    /// Finds anew what the body at a place will meet.
    pub(super) fn search(&mut self, place: u32, now: T) {
        let agenda = &mut self.agendas[place as usize];
        agenda.clear(self.period);
        let cell = agenda.cell;
        if self.plan.features > 0 {
            self.search_features(place);
        }
        if self.plan.has_pairs {
            let len = self.cells.around(cell, &mut self.found);
            (self.search_bodies)(self, place, len, now);
        }
    }

    pub(super) fn search_open<L, C, F>(&mut self, place: u32, len: usize, now: T)
    where
        L: Lane<Scalar = T>,
        C: Lane<Scalar = T::Coarse>,
        F: FlightStep,
    {
        self.search_found::<L, C, F, _, _>(place, len, now, OpenSpace, OpenSpace);
    }

    pub(super) fn search_periodic<L, C, F>(&mut self, place: u32, len: usize, now: T)
    where
        L: Lane<Scalar = T>,
        C: Lane<Scalar = T::Coarse>,
        F: FlightStep,
    {
        if let (Some(space), Some(coarse)) = (self.periodic, self.coarse.periodic) {
            self.search_found::<L, C, F, _, _>(place, len, now, space, coarse);
        }
    }

    /// Looks for contacts with the bodies found.
    #[inline(always)]
    fn search_found<L, C, F, S, R>(&mut self, place: u32, len: usize, now: T, space: S, coarse: R)
    where
        L: Lane<Scalar = T>,
        C: Lane<Scalar = T::Coarse>,
        F: FlightStep,
        S: Space<T>,
        R: Space<T::Coarse>,
    {
        self.effort.tried += len as u64;
        if self.records[place as usize].flight().since == now {
            let len = self.screened::<C, F, R, true>(place, len, now, coarse);
            self.search_packs::<L, F, S, true>(place, len, now, space);
        } else {
            let len = self.screened::<C, F, R, false>(place, len, now, coarse);
            self.search_packs::<L, F, S, false>(place, len, now, space);
        }
    }

    /// Passes over those of the bodies found that cannot be met. The last pack
    /// is filled up with the body itself, which never meets itself.
    #[inline(always)]
    fn screened<C, F, R, const STARTS: bool>(
        &mut self,
        place: u32,
        len: usize,
        now: T,
        space: R,
    ) -> usize
    where
        C: Lane<Scalar = T::Coarse>,
        F: FlightStep,
        R: Space<T::Coarse>,
    {
        if !self.coarse.is_useful {
            return len;
        }
        let whole = len.next_multiple_of(C::WIDTH);
        let Self { found, coarse, coarse_further, .. } = self;
        let found = &mut found[..whole];
        found[len..].fill(place);
        let now = T::Coarse::from_f64(now.to_f64());
        coarse.screen::<C, F, R, STARTS>(place, found, now, space, coarse_further)
    }

    /// Looks for contacts with the bodies found, in whole packs, the last one
    /// filled up with the body itself.
    #[inline(always)]
    fn search_packs<L, F, S, const STARTS: bool>(
        &mut self,
        place: u32,
        len: usize,
        now: T,
        space: S,
    ) where
        L: Lane<Scalar = T>,
        F: FlightStep,
        S: Space<T>,
    {
        let packs = len.div_ceil(L::WIDTH);
        self.found[len..packs * L::WIDTH].fill(place);
        self.effort.remaining += len as u64;
        let own = self.records[place as usize].flight();
        let (flight, gravity) = (Flight::<L>::splat(&own), Vec3::<L>::splat(self.gravity));
        let at = L::splat(now);
        for image in 0..self.further.len() {
            let further = Vec3::<L>::splat(self.further[image]);
            for start in (0..packs * L::WIDTH).step_by(TOGETHER) {
                let end = (packs * L::WIDTH).min(start + TOGETHER);
                let Self { found, records, meetings, .. } = self;
                for (pack, found) in found[start..end].chunks_exact(L::WIDTH).enumerate() {
                    let others = Flight::<L>::gather(records, found);
                    let met =
                        meeting::<L, F, S, STARTS>(&flight, &others, gravity, space, further, at);
                    meetings.put(pack * L::WIDTH, &met);
                }
                while let Some((k, time)) = self.meetings.take() {
                    let other = self.found[start + k];
                    if time.ge(self.agendas[place as usize].complete_until()) {
                        continue;
                    }
                    if self.met_last(place as usize, other as usize) {
                        // Rounding may tell that two bodies that have just met
                        // approach again. Through the other side of a periodic
                        // box they may well meet.
                        let other = self.records[other as usize].flight();
                        let (further, gravity) = (self.further[image], self.gravity);
                        let met =
                            meeting::<T, F, S, STARTS>(&own, &other, gravity, space, further, now);
                        if met.is_touching() {
                            continue;
                        }
                    }
                    self.expect(place, other, time);
                }
            }
        }
    }

    /// Keeps a contact with another body.
    #[inline(always)]
    fn expect(&mut self, place: u32, other: u32, time: T) {
        let changes = self.marks[other as usize].changes;
        let found = Expected { time, partner: PartnerCode::body(other), changes };
        self.keep(place, found);
    }

    /// Keeps a contact of the body at a place if it is among its first.
    #[inline(always)]
    pub(super) fn keep(&mut self, place: u32, found: Expected<T>) {
        let index = &self.index;
        let comes_first = |a, b| rank(index, place, a) < rank(index, place, b);
        self.agendas[place as usize].keep(found, comes_first);
    }

    /// Whether each of two bodies has met nobody since they met each other.
    #[inline(always)]
    fn met_last(&self, a: usize, b: usize) -> bool {
        let is_last = |a: usize, b: usize| self.marks[a].last == PartnerCode::body(self.index[b]);
        is_last(a, b) && is_last(b, a)
    }
}

/// The order of contacts at equal times: by the first body of the scene, the
/// surroundings before other bodies.
pub(super) fn rank(index: &[u32], place: u32, partner: PartnerCode) -> (u32, bool, u32) {
    let own = index[place as usize];
    match partner.decoded() {
        Ok(other) => {
            let other = index[other as usize];
            (own.min(other), true, own.max(other))
        }
        Err(feature) => (own, false, feature),
    }
}

/// The search of a plan.
pub(super) fn searcher<T: Real>(plan: &Plan, is_periodic: bool) -> Search<T> {
    type Pack4<T> = <<T as Real>::Coarse as Real>::Pack4;
    type Pack8<T> = <<T as Real>::Coarse as Real>::Pack8;
    type Pack16<T> = <<T as Real>::Coarse as Real>::Pack16;
    match (plan.gather_lanes, plan.sweep_lanes) {
        (1, _) => searcher_in::<T, T, T::Coarse>(plan, is_periodic),
        (4, 4) => searcher_in::<T, T::Pack4, Pack4<T>>(plan, is_periodic),
        (8, 8) => searcher_in::<T, T::Pack8, Pack8<T>>(plan, is_periodic),
        (4, _) => searcher_in::<T, T::Pack4, Pack16<T>>(plan, is_periodic),
        (_, _) => searcher_in::<T, T::Pack8, Pack16<T>>(plan, is_periodic),
    }
}

fn searcher_in<T, L, C>(plan: &Plan, is_periodic: bool) -> Search<T>
where
    T: Real,
    L: Lane<Scalar = T>,
    C: Lane<Scalar = T::Coarse>,
{
    match (plan.has_field, is_periodic) {
        (false, false) => EventDriven::search_open::<L, C, Coasting>,
        (false, true) => EventDriven::search_periodic::<L, C, Coasting>,
        (true, false) => EventDriven::search_open::<L, C, VelocityVerlet>,
        (true, true) => EventDriven::search_periodic::<L, C, VelocityVerlet>,
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
