//! Narrow phase: which candidates touch within the step.

use super::contacts::{Contact, Rank};
use super::path::Path;
use super::state::State;
use crate::bodies::Figure;
use crate::contact::past_contact;
use crate::lane::{Lane, Mask};
use crate::real::Real;
use crate::space::Space;
use crate::space::broadphase::Pair;
use crate::surroundings::Feature;
use crate::vec3::Vec3;

/// The widest lane.
pub(super) const WIDEST: usize = 16;

/// How contacts are found at the end of a step of flight.
pub(super) trait Detection<T: Real>: Copy + Send + Sync {
    /// Which of the pairs at slots `a` and `b` touch, and how long ago.
    fn pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        state: &State<T>,
        radius: R,
        space: S,
        a: &[u32],
        b: &[u32],
    ) -> (L::Mask, L);

    /// Which of the bodies at these slots touch the feature, and how long ago.
    fn surroundings<L: Lane<Scalar = T>, R: Figure<T>>(
        self,
        state: &State<T>,
        radius: R,
        feature: &Feature<T>,
        bodies: &[u32],
    ) -> (L::Mask, L);
}

/// At the end of the step: whatever overlaps then, whether it approaches or
/// not, since an earlier impulse of the step may turn it round.
#[derive(Clone, Copy, Debug)]
pub(super) struct AtEnd;

impl<T: Real> Detection<T> for AtEnd {
    #[inline(always)]
    fn pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        state: &State<T>,
        radius: R,
        space: S,
        a: &[u32],
        b: &[u32],
    ) -> (L::Mask, L) {
        let offset = offset::<L, _, _>(state, space, a, b);
        let reach = radius.gather::<L>(a) + radius.gather::<L>(b);
        (offset.length_squared().le(reach * reach), L::ZERO)
    }

    #[inline(always)]
    fn surroundings<L: Lane<Scalar = T>, R: Figure<T>>(
        self,
        state: &State<T>,
        radius: R,
        feature: &Feature<T>,
        bodies: &[u32],
    ) -> (L::Mask, L) {
        let center = gather::<L>(&state.position, bodies);
        (feature.clearance(center, radius.gather::<L>(bodies)).gap.le(L::ZERO), L::ZERO)
    }
}

/// At the time of impact inside the step, also where the bodies have passed
/// through each other by its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct WithinStep<T> {
    /// The shape of the paths within the step.
    pub path: Path<T>,
    /// How much nearer two bodies may have been during the step, length.
    pub sweep: T,
}

impl<T: Real> Detection<T> for WithinStep<T> {
    #[inline(always)]
    fn pairs<L: Lane<Scalar = T>, R: Figure<T>, S: Space<T>>(
        self,
        state: &State<T>,
        radius: R,
        space: S,
        a: &[u32],
        b: &[u32],
    ) -> (L::Mask, L) {
        let offset = offset::<L, _, _>(state, space, a, b);
        let distance_squared = offset.length_squared();
        let reach = radius.gather::<L>(a) + radius.gather::<L>(b);
        let swept = reach + L::splat(self.sweep);
        let is_near = distance_squared.le(swept * swept);
        if !is_near.any() {
            return (is_near, L::ZERO);
        }
        let relative = gather::<L>(&state.velocity, a) - gather::<L>(&state.velocity, b);
        let contact = past_contact(offset, relative, reach);
        let duration = L::splat(self.path.duration);
        let met_within = contact.met & contact.ago.ge(L::ZERO) & contact.ago.le(duration);
        // What an earlier step has left overlapping, or touching to rounding,
        // collides at the beginning of this one if it still approaches.
        let is_left_over = distance_squared.le(reach * reach) & relative.dot(offset).lt(L::ZERO);
        (met_within | is_left_over, L::select(met_within, contact.ago, duration))
    }

    #[inline(always)]
    fn surroundings<L: Lane<Scalar = T>, R: Figure<T>>(
        self,
        state: &State<T>,
        radius: R,
        feature: &Feature<T>,
        bodies: &[u32],
    ) -> (L::Mask, L) {
        let center = gather::<L>(&state.position, bodies);
        let radius = radius.gather::<L>(bodies);
        let clearance = feature.clearance(center, radius);
        let is_inside = clearance.gap.le(L::ZERO);
        if !is_inside.any() {
            return (is_inside, L::ZERO);
        }
        let velocity = self.path.end_velocity(gather::<L>(&state.velocity, bodies));
        let is_approaching = velocity.dot(clearance.arm).lt(L::ZERO);
        let ago = self.path.touch(feature, center, velocity, radius);
        (is_inside & is_approaching, ago)
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
    for pairs in pairs.chunks_exact(L::WIDTH) {
        let (mut a, mut b) = ([0; WIDEST], [0; WIDEST]);
        for (k, pair) in pairs.iter().enumerate() {
            [a[k], b[k]] = *pair;
        }
        let (touching, ago) = detection.pairs::<L, R, S>(state, radius, space, &a, &b);
        push(touching, ago, found, |k| in_order(state, a[k], b[k]));
    }
}

/// The bodies near a feature that touch it, appended to `found`.
pub(super) fn touching_surroundings<L, T, D, R>(
    state: &State<T>,
    detection: D,
    radius: R,
    (number, feature): (u32, &Feature<T>),
    bodies: &[u32],
    found: &mut Vec<Contact<T>>,
) where
    L: Lane<Scalar = T>,
    T: Real,
    D: Detection<T>,
    R: Figure<T>,
{
    let (whole, tail) = bodies.split_at(bodies.len() - bodies.len() % L::WIDTH);
    sweep_surroundings::<L, _, _, _>(state, detection, radius, (number, feature), whole, found);
    sweep_surroundings::<T, _, _, _>(state, detection, radius, (number, feature), tail, found);
}

#[inline(never)]
fn sweep_surroundings<L, T, D, R>(
    state: &State<T>,
    detection: D,
    radius: R,
    (number, feature): (u32, &Feature<T>),
    bodies: &[u32],
    found: &mut Vec<Contact<T>>,
) where
    L: Lane<Scalar = T>,
    T: Real,
    D: Detection<T>,
    R: Figure<T>,
{
    for bodies in bodies.chunks_exact(L::WIDTH) {
        let (touching, ago) = detection.surroundings::<L, R>(state, radius, feature, bodies);
        push(touching, ago, found, |k| {
            (bodies[k], number, Rank::of_surroundings(state.index[bodies[k] as usize], number))
        });
    }
}

/// The slots of two bodies, the one with the lesser index first, and the rank
/// of their contact.
#[inline]
fn in_order<T: Real>(state: &State<T>, a: u32, b: u32) -> (u32, u32, Rank) {
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
    let mut bits = touching.bits();
    while bits != 0 {
        let k = bits.trailing_zeros() as usize;
        let (a, b, rank) = contact(k);
        found.push(Contact { rank, a, b, ago: ago.to_array().as_ref()[k] });
        bits &= bits - 1;
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

/// Three columns' elements at some slots.
#[inline(always)]
pub(super) fn gather<L: Lane>(
    columns: &crate::bodies::Columns3<L::Scalar>,
    slots: &[u32],
) -> Vec3<L> {
    Vec3::gather([&columns[0], &columns[1], &columns[2]], slots)
}
