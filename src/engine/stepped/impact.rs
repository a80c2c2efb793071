//! Impact: the impulses of contacts that share no body.

use super::contacts::Contact;
use super::narrow::{WIDEST, gather, offset};
use super::path::Path;
use super::state::State;
use crate::bodies::PerBody;
use crate::contact::{Impulse, Laws, Party, collide, one_material};
use crate::lane::{Lane, Mask};
use crate::motion::flight::Wrap;
use crate::real::Real;
use crate::space::{OpenSpace, PeriodicBox, Space};
use crate::surroundings::{Clearance, FeatureRef};
use crate::vec3::Vec3;

/// The motion of a body just after a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<T> {
    pub velocity: Vec3<T>,
    pub spin: Vec3<T>,
}

/// What a contact did.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome<T> {
    /// Whether the bodies approached; nothing happened otherwise.
    pub collided: bool,
    /// From the second body's centre, or from the point of contact with
    /// something fixed, to the first body's centre.
    pub offset: Vec3<T>,
    /// Normal impulse on the first body.
    pub normal: Vec3<T>,
    /// Tangential impulse on the first body.
    pub tangential: Vec3<T>,
    pub a: Motion<T>,
    pub b: Motion<T>,
}

impl<T: Real> Outcome<T> {
    const STILL: Motion<T> = Motion { velocity: Vec3::ZERO, spin: Vec3::ZERO };

    /// Nothing has happened yet.
    pub const NONE: Self = Self {
        collided: false,
        offset: Vec3::ZERO,
        normal: Vec3::ZERO,
        tangential: Vec3::ZERO,
        a: Self::STILL,
        b: Self::STILL,
    };
}

/// How the contacts of a scene are worked out; chosen once by the plan. The space is
/// looked at once a pack, so that it has no kernels of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impacts<T, W> {
    pub periodic: Option<PeriodicBox<T>>,
    pub laws: W,
    /// Whether contacts take effect at their own time, not at the step's end.
    pub within_step: bool,
}

/// The slots of up to a pack's bodies, and their indices in the scene.
struct Slots {
    slots: [u32; WIDEST],
    indices: [u32; WIDEST],
}

impl Slots {
    #[inline(always)]
    fn new<T: Real>(state: &State<T>, width: usize, slot: impl Fn(usize) -> u32) -> Self {
        let mut these = Self { slots: [0; WIDEST], indices: [0; WIDEST] };
        for k in 0..width {
            these.slots[k] = slot(k);
            these.indices[k] = state.index[slot(k) as usize];
        }
        these
    }
}

impl<T: Real, W: Laws<T>> Impacts<T, W> {
    /// The impulses of contacts between bodies.
    pub fn pairs<L: Lane<Scalar = T>>(
        &self,
        state: &State<T>,
        contacts: &[Contact<T>],
        outcomes: &mut [Outcome<T>],
    ) {
        let whole = contacts.len() - contacts.len() % L::WIDTH;
        for start in (0..whole).step_by(L::WIDTH) {
            let range = start..start + L::WIDTH;
            let (now, after) = (&contacts[range.clone()], &mut outcomes[range]);
            self.pack_of_pairs::<L>(state, now, after);
        }
        for k in whole..contacts.len() {
            self.pack_of_pairs::<T>(state, &contacts[k..=k], &mut outcomes[k..=k]);
        }
    }

    #[inline(never)]
    fn pack_of_pairs<L: Lane<Scalar = T>>(
        &self,
        state: &State<T>,
        contacts: &[Contact<T>],
        outcomes: &mut [Outcome<T>],
    ) {
        let first = Slots::new(state, L::WIDTH, |k| contacts[k].a);
        let second = Slots::new(state, L::WIDTH, |k| contacts[k].b);
        let mut a = party::<L, T, W>(state, &first);
        let mut b = party::<L, T, W>(state, &second);
        let offset = if self.within_step {
            // Of all images only the nearest at the time of contact can touch.
            let offset = gather::<L>(&state.position, &first.slots)
                - gather::<L>(&state.position, &second.slots);
            let back = (a.velocity - b.velocity) * L::from_fn(|k| contacts[k].ago);
            let image = |space: PeriodicBox<T>| offset - space.shift(space.turns(offset - back));
            self.periodic.map_or(offset, image) - back
        } else {
            let offset = offset(state, OpenSpace, &first.slots, &second.slots);
            self.periodic.map_or(offset, |space| space.nearest(offset))
        };
        match &state.radius {
            PerBody::Same(_) => {
                a.share = L::ratio(1, 2);
                b.share = L::ratio(1, 2);
            }
            PerBody::Each(radius) => {
                let first = L::gather(radius, &first.slots);
                let second = L::gather(radius, &second.slots);
                let reach = first + second;
                a.share = first / reach;
                b.share = second / reach;
            }
        }
        let law = self.laws.between(one_material);
        let impulse = collide(law, offset, &mut a, &mut b);
        write(outcomes, offset, impulse, a, b);
    }

    /// The impulses of contacts of bodies with one fixed feature.
    pub fn surroundings<L: Lane<Scalar = T>>(
        &self,
        state: &State<T>,
        path: &Path<T>,
        feature: &FeatureRef<'_, T>,
        contacts: &[Contact<T>],
        outcomes: &mut [Outcome<T>],
    ) {
        let whole = contacts.len() - contacts.len() % L::WIDTH;
        for start in (0..whole).step_by(L::WIDTH) {
            let range = start..start + L::WIDTH;
            let (now, after) = (&contacts[range.clone()], &mut outcomes[range]);
            self.pack_at_feature::<L>(state, path, feature, now, after);
        }
        for k in whole..contacts.len() {
            let (now, after) = (&contacts[k..=k], &mut outcomes[k..=k]);
            self.pack_at_feature::<T>(state, path, feature, now, after);
        }
    }

    #[inline(never)]
    fn pack_at_feature<L: Lane<Scalar = T>>(
        &self,
        state: &State<T>,
        path: &Path<T>,
        feature: &FeatureRef<'_, T>,
        contacts: &[Contact<T>],
        outcomes: &mut [Outcome<T>],
    ) {
        let slots = Slots::new(state, L::WIDTH, |k| contacts[k].a);
        let mut a = party::<L, T, W>(state, &slots);
        a.share = L::ONE;
        let mut center = gather::<L>(&state.position, &slots.slots);
        let at_end = a.velocity;
        if self.within_step {
            let ago = L::from_fn(|k| contacts[k].ago);
            let velocity = path.end_velocity(at_end);
            center = path.center(center, velocity, ago);
            center = self.periodic.map_or(center, |space| space.wrap(center));
            a.velocity = path.velocity(velocity, ago);
        }
        let at_contact = a.velocity;
        let radius = match &state.radius {
            PerBody::Same(radius) => L::splat(*radius),
            PerBody::Each(radius) => L::gather(radius, &slots.slots),
        };
        let Clearance { gap, mut arm } = feature.clearance(center, radius);
        let is_beyond = gap.abs().gt(radius);
        if self.within_step && is_beyond.any() {
            // At the very edge of a periodic box rounding may have chosen the
            // image at its other side.
            let mut least = gap.abs();
            for image in self.periodic.map_or(Vec::new(), Space::images) {
                let other = feature.clearance(center + Vec3::splat(image), radius);
                let is_nearer = is_beyond & other.gap.abs().lt(least);
                least = L::select(is_nearer, other.gap.abs(), least);
                arm = Vec3::select(is_nearer, other.arm, arm);
            }
        }
        let law = self.laws.between(one_material);
        let impulse = collide(law, arm, &mut a, &mut Party::immovable());
        if self.within_step {
            // The rest of the step adds what the field does, as it did before.
            a.velocity =
                Vec3::select(impulse.approaching, at_end + (a.velocity - at_contact), at_end);
        }
        write(outcomes, arm, impulse, a, Party::immovable());
    }
}

/// The bodies at some slots, their shares of the offset still open.
#[inline(always)]
fn party<L, T, W>(state: &State<T>, slots: &Slots) -> Party<L>
where
    L: Lane<Scalar = T>,
    T: Real,
    W: Laws<T>,
{
    let cold = |figure: &PerBody<T>| match figure {
        PerBody::Same(value) => L::splat(*value),
        PerBody::Each(column) => L::gather(column, &slots.indices),
    };
    Party {
        velocity: gather(&state.velocity, &slots.slots),
        spin: if W::CHANGES_SPINS { gather(&state.spin, &slots.indices) } else { Vec3::ZERO },
        inverse_mass: cold(&state.inverse_mass),
        inverse_inertia: if W::CHANGES_SPINS { cold(&state.inverse_inertia) } else { L::ZERO },
        share: L::ZERO,
    }
}

/// Writes the lanes of a pack of contacts one by one.
#[inline(always)]
fn write<L: Lane>(
    outcomes: &mut [Outcome<L::Scalar>],
    offset: Vec3<L>,
    impulse: Impulse<L>,
    a: Party<L>,
    b: Party<L>,
) {
    let collided = impulse.approaching.bits();
    let offset = offset.to_arrays();
    let (normal, tangential) = (impulse.normal.to_arrays(), impulse.tangential.to_arrays());
    let (a_velocity, a_spin) = (a.velocity.to_arrays(), a.spin.to_arrays());
    let (b_velocity, b_spin) = (b.velocity.to_arrays(), b.spin.to_arrays());
    for (k, outcome) in outcomes.iter_mut().enumerate() {
        let lane =
            |v: &[L::Array; 3]| Vec3::new(v[0].as_ref()[k], v[1].as_ref()[k], v[2].as_ref()[k]);
        *outcome = Outcome {
            collided: collided >> k & 1 != 0,
            offset: lane(&offset),
            normal: lane(&normal),
            tangential: lane(&tangential),
            a: Motion { velocity: lane(&a_velocity), spin: lane(&a_spin) },
            b: Motion { velocity: lane(&b_velocity), spin: lane(&b_spin) },
        };
    }
}
