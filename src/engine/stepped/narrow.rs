//! Narrow phase: which candidates touch within the step.

use super::contacts::{Contact, Rank};
use super::path::{Path, Stretch};
use super::state::State;
use super::struck::Struck;
use crate::bodies::{Figure, at};
use crate::contact::{PastContact, past_contact};
use crate::lane::{Lane, Mask, ones};
use crate::motion::flight::Wrap;
use crate::real::Real;
use crate::space::broadphase::Pair;
use crate::space::{PeriodicBox, Space};
use crate::surroundings::FeatureRef;
use crate::vec3::Vec3;

/// The widest lane.
pub(super) const WIDEST: usize = 16;

/// A fixed feature that bodies may touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part<'a, T> {
    pub number: u32,
    /// The feature that stands for the surface that it is a part of.
    pub surface: u32,
    pub feature: FeatureRef<'a, T>,
}

/// How contacts are found at the end of a step of flight.
pub(super) trait Detection<T: Real>: Copy + Send + Sync {
    /// Which of the pairs at slots `a` and `b` are near enough to be asked about.
    fn near_pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        state: &State<T>,
        radius: R,
        space: S,
        a: &[u32],
        b: &[u32],
    ) -> L::Mask;

    /// Which of the near pairs at slots `a` and `b` touch, and how long ago.
    fn pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        state: &State<T>,
        radius: R,
        space: S,
        a: &[u32],
        b: &[u32],
    ) -> (L::Mask, L);

    /// Which of the bodies at these slots touch the numbered feature, and how long
    /// ago.
    fn surroundings<L: Lane<Scalar = T>>(
        self,
        state: &State<T>,
        part: &Part<'_, T>,
        bodies: &[u32],
    ) -> (L::Mask, L);
}

/// At the end of the step: whatever overlaps then, whether it approaches or
/// not, since an earlier impulse of the step may turn it round.
#[derive(Clone, Copy, Debug)]
pub(super) struct AtEnd;

impl<T: Real> Detection<T> for AtEnd {
    #[inline(always)]
    fn near_pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        state: &State<T>,
        radius: R,
        space: S,
        a: &[u32],
        b: &[u32],
    ) -> L::Mask {
        let offset = offset::<L, _, _>(state, space, a, b);
        let reach = radius.gather::<L>(a) + radius.gather::<L>(b);
        offset.length_squared().le(reach * reach)
    }

    /// Those near touch.
    #[inline(always)]
    fn pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        _: &State<T>,
        _: R,
        _: S,
        _: &[u32],
        _: &[u32],
    ) -> (L::Mask, L) {
        (L::ZERO.le(L::ZERO), L::ZERO)
    }

    #[inline(always)]
    fn surroundings<L: Lane<Scalar = T>>(
        self,
        state: &State<T>,
        part: &Part<'_, T>,
        bodies: &[u32],
    ) -> (L::Mask, L) {
        let center = gather::<L>(&state.position, bodies);
        let overlaps = part.feature.clearance(center, state.radius.gather(bodies)).gap.le(L::ZERO);
        (part.feature.stops(overlaps, center), L::ZERO)
    }
}

/// At the time of impact inside a stretch of the step, also where the bodies have
/// passed through each other by its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct WithinStep<'a, T: Real> {
    /// The shape of the paths within the step.
    pub path: &'a Path<T>,
    /// The contacts that bodies have had in the step.
    pub struck: &'a Struck<T>,
    /// The part of the step that is looked at.
    pub stretch: Stretch<T>,
    pub periodic: Option<&'a PeriodicBox<T>>,
    /// Which images of a pair can be near, besides the nearest at the end of the
    /// stretch, in whole boxes from there.
    pub further: &'a [Vec3<T>],
    /// Whether to pass over the image of a pair that touches at the beginning.
    pub is_again: bool,
}

/// By reference: it is handed on for every list of candidates.
impl<T: Real> Detection<T> for &WithinStep<'_, T> {
    #[inline(always)]
    fn near_pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        state: &State<T>,
        radius: R,
        space: S,
        a: &[u32],
        b: &[u32],
    ) -> L::Mask {
        let way = self.stretch.way();
        let swept = radius.gather::<L>(a) + radius.gather::<L>(b) + L::splat(way + way);
        let (offset, back) = self.offset_and_back(state, a, b);
        let mut is_near = L::ZERO.lt(L::ZERO);
        self.each_image(space, offset, back, |offset: Vec3<L>| {
            is_near = is_near | (offset - back).length_squared().le(swept * swept);
        });
        is_near
    }

    #[inline(always)]
    fn pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        state: &State<T>,
        radius: R,
        space: S,
        a: &[u32],
        b: &[u32],
    ) -> (L::Mask, L) {
        let until = L::splat(self.stretch.until);
        let reach = radius.gather::<L>(a) + radius.gather::<L>(b);
        let (offset, back) = self.offset_and_back(state, a, b);
        let relative = relative::<L, _>(state, a, b);
        let since = self.since::<L>(a, b);
        let mut touching = L::ZERO.lt(L::ZERO);
        let mut first = L::ZERO;
        self.each_image(space, offset, back, |offset: Vec3<L>| {
            let PastContact { mut met, ago } = met_since(offset, relative, reach, since);
            if self.is_again {
                let start = offset - relative * since;
                let gap = start.length_squared() - reach * reach;
                met = met & gap.gt(reach * reach * L::ratio(1, 1024));
            }
            met = met & ago.ge(until) & (!touching | ago.gt(first));
            first = L::select(met, ago, first);
            touching = touching | met;
        });
        (touching, first)
    }

    #[inline(always)]
    fn surroundings<L: Lane<Scalar = T>>(
        self,
        state: &State<T>,
        part: &Part<'_, T>,
        bodies: &[u32],
    ) -> (L::Mask, L) {
        let Stretch { until, .. } = self.stretch;
        let way = L::splat(self.stretch.way());
        let mut center = gather::<L>(&state.position, bodies);
        if until > T::ZERO {
            let velocity = self.path.end_velocity(gather::<L>(&state.velocity, bodies));
            center = self.path.center(center, velocity, L::splat(until));
        }
        let mut is_near = L::ZERO.lt(L::ZERO);
        if let Some(space) = self.periodic {
            // From beyond a face of the box it may meet another image.
            center = space.wrap(center);
            is_near = !space.is_inner(center, way);
        }
        let feature = &part.feature;
        is_near = is_near | feature.clearance(center, state.radius.gather(bodies)).gap.le(way);
        if !is_near.any() {
            return (is_near, L::ZERO);
        }
        let near = is_near.bits();
        let ago = L::from_fn(|k| {
            let is_near = near >> k & 1 != 0;
            let contact = is_near.then(|| self.contact_with(state, part, bodies[k]));
            contact.flatten().unwrap_or(-T::ONE)
        });
        (ago.ge(L::splat(until)), ago)
    }
}

/// Which pairs meet on the paths that they have had `since` before the end of the step, and
/// how long before it. What touches at the beginning of its path, by whatever rounding or an
/// earlier step has left, collides then if it approaches.
#[inline(always)]
pub(in crate::engine) fn met_since<L: Lane>(
    offset: Vec3<L>,
    relative: Vec3<L>,
    reach: L,
    since: L,
) -> PastContact<L> {
    let PastContact { met, ago } = past_contact(offset, relative, reach);
    let is_before = ago.gt(since);
    let start = offset - relative * since;
    let met = met & (!is_before | relative.dot(start).lt(L::ZERO));
    PastContact { met, ago: L::select(is_before, since, ago) }
}

impl<T: Real> WithinStep<'_, T> {
    /// From the second to the first bodies' centres at the end of the step, and what is to
    /// be taken from that for the end of the stretch.
    #[inline(always)]
    fn offset_and_back<L: Lane<Scalar = T>>(
        &self,
        state: &State<T>,
        a: &[u32],
        b: &[u32],
    ) -> (Vec3<L>, Vec3<L>) {
        let Stretch { until, .. } = self.stretch;
        let offset = gather::<L>(&state.position, a) - gather::<L>(&state.position, b);
        let is_cut = until > T::ZERO;
        let back =
            if is_cut { relative::<L, _>(state, a, b) * L::splat(until) } else { Vec3::ZERO };
        (offset, back)
    }

    /// Calls `visit` with the offsets to all images that can be near.
    #[inline(always)]
    fn each_image<L: Lane<Scalar = T>, S: Space<T>>(
        &self,
        space: S,
        offset: Vec3<L>,
        back: Vec3<L>,
        mut visit: impl FnMut(Vec3<L>),
    ) {
        let turns = space.turns(offset - back);
        for further in core::iter::once(Vec3::ZERO).chain(self.further.iter().copied()) {
            visit(offset - space.shift(turns + Vec3::splat(further)));
        }
    }

    /// Since when the bodies of pairs have had both of their paths.
    #[inline(always)]
    fn since<L: Lane<Scalar = T>>(&self, a: &[u32], b: &[u32]) -> L {
        if self.struck.is_empty() {
            return L::splat(self.path.duration);
        }
        L::gather(self.struck.since(), a).lesser(L::gather(self.struck.since(), b))
    }

    /// How long before the end of the step the body in a slot touches a feature.
    #[inline(never)]
    pub fn contact_with(&self, state: &State<T>, part: &Part<'_, T>, slot: u32) -> Option<T> {
        let Self { path, stretch: Stretch { until, .. }, .. } = *self;
        let radius = state.radius.of(slot as usize);
        let end = at(&state.position, slot as usize);
        let velocity = path.end_velocity(at(&state.velocity, slot as usize));
        let since = self.struck.since()[slot as usize];
        let Part { surface, feature, .. } = part;
        let rank = Rank::of_surroundings(state.index[slot as usize], *surface);
        let is_last = self.struck.is_last(slot, rank);
        let Some(space) = self.periodic else {
            return path.contact(feature, (end, velocity), radius, since, is_last);
        };
        let center = path.center(end, velocity, until);
        let turns = space.turns(center - space.wrap(center));
        let way = self.stretch.way();
        let through = |image: Vec3<T>| {
            let end = end - space.shift(turns - space.turns(image));
            let gap = |ago: T| feature.clearance(path.center(end, velocity, ago), radius).gap;
            if gap(until) > way {
                return None;
            }
            let start = path.center(end, velocity, since);
            // It has left one image only.
            let rounding = T::whole(64) * T::EPSILON * end.length();
            let is_leaving = is_last
                && feature.clearance_of_surface(start, radius).gap.abs()
                    <= rounding.greater(radius / T::whole(1024));
            path.contact(feature, (end, velocity), radius, since, is_leaving)
        };
        space.images().into_iter().filter_map(through).reduce(Lane::greater)
    }
}

/// The candidates of a chunk that touch, appended to `found`.
pub(super) fn touching_pairs<L, T, D, R, S>(
    state: &State<T>,
    detection: D,
    radius: R,
    space: S,
    pairs: &[Pair],
    found: &mut Vec<Contact<T>>,
) where
    L: Lane<Scalar = T>,
    T: Real,
    D: Detection<T>,
    R: Figure<T>,
    S: Space<T>,
{
    let (whole, tail) = pairs.split_at(pairs.len() - pairs.len() % L::WIDTH);
    sweep_pairs::<L, _, _, _, _>(state, detection, radius, space, whole, found);
    sweep_pairs::<T, _, _, _, _>(state, detection, radius, space, tail, found);
}

/// Whole packs of pairs; not inlined, since every width has the same tail.
#[inline(never)]
fn sweep_pairs<L, T, D, R, S>(
    state: &State<T>,
    detection: D,
    radius: R,
    space: S,
    pairs: &[Pair],
    found: &mut Vec<Contact<T>>,
) where
    L: Lane<Scalar = T>,
    T: Real,
    D: Detection<T>,
    R: Figure<T>,
    S: Space<T>,
{
    // Near ones are few: they are put together until they fill a pack.
    let (mut near, mut count) = ([[0; 2]; 2 * WIDEST], 0);
    for pairs in pairs.chunks_exact(L::WIDTH) {
        let [a, b] = columns(pairs);
        let is_near = detection.near_pairs::<L, R, S>(state, radius, space, &a, &b);
        for k in ones(is_near.bits()) {
            near[count] = pairs[k];
            count += 1;
        }
        if count >= L::WIDTH {
            let (now, later) = near.split_at_mut(L::WIDTH);
            near_pairs::<L, _, _, _, _>(state, detection, radius, space, now, found);
            count -= L::WIDTH;
            now[..count].copy_from_slice(&later[..count]);
        }
    }
    for pair in near[..count].chunks_exact(1) {
        near_pairs::<T, _, _, _, _>(state, detection, radius, space, pair, found);
    }
}

/// A pack of near pairs.
#[inline(never)]
fn near_pairs<L, T, D, R, S>(
    state: &State<T>,
    detection: D,
    radius: R,
    space: S,
    pairs: &[Pair],
    found: &mut Vec<Contact<T>>,
) where
    L: Lane<Scalar = T>,
    T: Real,
    D: Detection<T>,
    R: Figure<T>,
    S: Space<T>,
{
    let [a, b] = columns(pairs);
    let (touching, ago) = detection.pairs::<L, R, S>(state, radius, space, &a, &b);
    push(touching, ago, found, |k| in_order(state, a[k], b[k]));
}

/// The first and the second slots of up to a pack's pairs.
#[inline(always)]
fn columns(pairs: &[Pair]) -> [[u32; WIDEST]; 2] {
    let mut columns = [[0; WIDEST]; 2];
    for (k, pair) in pairs.iter().enumerate() {
        [columns[0][k], columns[1][k]] = *pair;
    }
    columns
}

/// The bodies near a feature that touch it, appended to `found`.
pub(super) fn touching_surroundings<L: Lane<Scalar = T>, T: Real>(
    state: &State<T>,
    detection: impl Detection<T>,
    part: &Part<'_, T>,
    bodies: &[u32],
    found: &mut Vec<Contact<T>>,
) {
    let (whole, tail) = bodies.split_at(bodies.len() - bodies.len() % L::WIDTH);
    // Of many parts most have few bodies.
    if !whole.is_empty() {
        sweep_surroundings::<L, _>(state, detection, part, whole, found);
    }
    if !tail.is_empty() {
        sweep_surroundings::<T, _>(state, detection, part, tail, found);
    }
}

/// Whole packs of bodies, whose radii are looked at once a pack, so that equal ones
/// have no kernel of their own.
#[inline(never)]
fn sweep_surroundings<L: Lane<Scalar = T>, T: Real>(
    state: &State<T>,
    detection: impl Detection<T>,
    part: &Part<'_, T>,
    bodies: &[u32],
    found: &mut Vec<Contact<T>>,
) {
    for bodies in bodies.chunks_exact(L::WIDTH) {
        let (touching, ago) = detection.surroundings::<L>(state, part, bodies);
        push(touching, ago, found, |k| {
            let rank = Rank::of_surroundings(state.index[bodies[k] as usize], part.surface);
            (bodies[k], part.number, rank)
        });
    }
}

/// The slots of two bodies, the one with the lesser index first, and the rank
/// of their contact.
#[inline]
pub(super) fn in_order<T: Real>(state: &State<T>, a: u32, b: u32) -> (u32, u32, Rank) {
    let (first, second) = (state.index[a as usize], state.index[b as usize]);
    let rank = Rank::of_pair(first, second);
    if first < second { (a, b, rank) } else { (b, a, rank) }
}

/// Appends a contact for each lane of a mask.
#[inline(always)]
fn push<L: Lane>(
    touching: L::Mask,
    ago: L,
    found: &mut Vec<Contact<L::Scalar>>,
    contact: impl Fn(usize) -> (u32, u32, Rank),
) {
    for k in ones(touching.bits()) {
        let (a, b, rank) = contact(k);
        found.push(Contact { rank, a, b, ago: ago.to_array().as_ref()[k] });
    }
}

/// From the second to the first bodies' centres, to their nearest images.
#[inline(always)]
pub(super) fn offset<L, T, S>(state: &State<T>, space: S, a: &[u32], b: &[u32]) -> Vec3<L>
where
    L: Lane<Scalar = T>,
    T: Real,
    S: Space<T>,
{
    space.nearest(gather::<L>(&state.position, a) - gather::<L>(&state.position, b))
}

/// The velocities of the first bodies relative to the second ones.
#[inline(always)]
fn relative<L, T>(state: &State<T>, a: &[u32], b: &[u32]) -> Vec3<L>
where
    L: Lane<Scalar = T>,
    T: Real,
{
    gather::<L>(&state.velocity, a) - gather::<L>(&state.velocity, b)
}

/// Three columns' elements at some slots.
#[inline(always)]
pub(super) fn gather<L: Lane>(
    columns: &crate::bodies::Columns3<L::Scalar>,
    slots: &[u32],
) -> Vec3<L> {
    Vec3::gather([&columns[0], &columns[1], &columns[2]], slots)
}
