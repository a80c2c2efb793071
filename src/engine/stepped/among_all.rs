//! Among all: what one body touches within a step, of all bodies and features of a small scene
//! in open space.

use super::contacts::{Contact, Rank};
use super::narrow::{Part, WithinStep, in_order, met_since};
use super::path::Stretch;
use super::state::State;
use crate::bodies::{PerBody, at};
use crate::column::Column;
use crate::contact::PastContact;
use crate::lane::{Lane, Mask, ones};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::surroundings::Features;
use crate::vec3::Vec3;

impl<T: Real> WithinStep<'_, T> {
    /// All features that the body in a slot touches within the stretch, appended to
    /// `found`.
    pub fn touching_parts(
        &self,
        state: &State<T>,
        features: &Features<T>,
        slot: u32,
        found: &mut Vec<Contact<T>>,
    ) {
        let Self { path, stretch: Stretch { until, .. }, .. } = *self;
        let at_end = at(&state.position, slot as usize);
        let velocity = path.end_velocity(at(&state.velocity, slot as usize));
        let radius = state.radius.of(slot as usize);
        let (center, way) = (path.center(at_end, velocity, until), self.stretch.way());
        for number in 0..features.len() as u32 {
            let feature = features.at(number);
            if feature.clearance(center, radius).gap <= way {
                let part = Part { number, surface: features.surface_of(number), feature };
                let ago = self.contact_with(state, &part, slot);
                if let Some(ago) = ago.filter(|ago| *ago >= until) {
                    let rank = Rank::of_surroundings(state.index[slot as usize], part.surface);
                    found.push(Contact { rank, a: slot, b: number, ago });
                }
            }
        }
    }
}

/// All bodies that the one in a slot touches within a stretch, appended to `found`.
#[inline(never)]
pub(super) fn touching_any<L: Lane<Scalar = T>, T: Real>(
    within: &WithinStep<'_, T>,
    state: &State<T>,
    slot: u32,
    found: &mut Vec<Contact<T>>,
) {
    let Stretch { until, .. } = within.stretch;
    let [x, y, z] = state.position.refs().each(Column::padded);
    let [u, v, w] = state.velocity.refs().each(Column::padded);
    let since = within.struck.padded_since();
    let own_since = L::splat(since[slot as usize]);
    let center = Vec3::<L>::splat(at(&state.position, slot as usize));
    let velocity = Vec3::<L>::splat(at(&state.velocity, slot as usize));
    let own = L::splat(state.radius.of(slot as usize));
    let way = within.stretch.way();
    let own_and_way = own + L::splat(way + way);
    let len = state.index.len();
    for first in (0..len).step_by(L::WIDTH) {
        let load = |column: &[T]| L::load(&column[first..]);
        let radius = match &state.radius {
            PerBody::Same(radius) => L::splat(*radius),
            PerBody::Each(radii) => load(radii.padded()),
        };
        let offset = center - Vec3::new(load(x), load(y), load(z));
        let relative = velocity - Vec3::new(load(u), load(v), load(w));
        let swept = own_and_way + radius;
        let at_until = offset - relative * L::splat(until);
        let is_near = at_until.length_squared().le(swept * swept);
        let others = ones(is_near.bits()).any(|k| first + k != slot as usize && first + k < len);
        if !others {
            continue;
        }
        let since = own_since.lesser(load(since));
        let PastContact { met, ago } = met_since(offset, relative, own + radius, since);
        let met = met & is_near & ago.ge(L::splat(until));
        for k in ones(met.bits()).filter(|k| first + k < len) {
            let other = (first + k) as u32;
            if other != slot {
                let (a, b, rank) = in_order(state, slot, other);
                found.push(Contact { rank, a, b, ago: ago.to_array().as_ref()[k] });
            }
        }
    }
}
