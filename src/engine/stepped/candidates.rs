//! Candidates: when the broad phase is renewed.

use super::path::Stretch;
use super::region::Region;
use super::setting::Setting;
use super::state::{State, put};
use crate::bodies::{Columns3, at};
use crate::lane::Lane;
use crate::motion::flight::Wrap;
use crate::real::Real;
use crate::space::broadphase::Surveyed;

/// Steps that a search for bodies near fixed features should be good for where
/// there are no pairs: few bodies are near, and a search is worth many steps.
const STEPS_ALONE: i32 = 64;

/// Searches again for all that can touch within the skin, when bodies move by
/// `travel` in a step at most. Where contacts have times, bodies are looked at
/// where they are at the end of a stretch of the step just taken.
pub(super) fn renew<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    travel: T,
    stretch: Option<Stretch<T>>,
) {
    let (state, nearby) = (&mut region.state, &mut region.nearby);
    // Within the stretch bodies were further apart or nearer by as much.
    let way = stretch.map_or(T::ZERO, |stretch| stretch.way());
    let swept = nearby.broadphase.swept(way);
    let pairs = setting.plan.has_pairs;
    let is_alone = !pairs && !nearby.broadphase.has_many_parts();
    let alone = if is_alone { travel * T::whole(STEPS_ALONE) } else { T::ZERO };
    let skin = nearby.broadphase.skin(travel, nearby.skin).greater(swept).greater(alone);
    nearby.skin = skin;
    let (periodic, features, workers) = (setting.periodic, &setting.features, &setting.workers);
    let until = stretch.map_or(T::ZERO, |stretch| stretch.until);
    let moved = (until > T::ZERO).then(|| positions(setting, state, until));
    let mut surveyed = state.surveyed(periodic, features, pairs);
    if let Some(position) = &moved {
        surveyed = Surveyed { position, ..surveyed };
    }
    let order = nearby.broadphase.sort(&surveyed, skin, workers);
    state.reorder(order, workers);
    region.pending.struck.reorder(order);
    let moved = (until > T::ZERO).then(|| positions(setting, state, until));
    let mut surveyed = state.surveyed(periodic, features, pairs);
    if let Some(position) = &moved {
        surveyed = Surveyed { position, ..surveyed };
    }
    nearby.broadphase.search::<L, _>(&surveyed, skin, &mut nearby.candidates, workers);
    nearby.neighbourhoods.clear();
    nearby.travelled = way;
}

/// Where all bodies are a time before the end of the step, on their present paths.
fn positions<T: Real>(setting: &Setting<T>, state: &State<T>, ago: T) -> Columns3<T> {
    let mut moved = state.position.clone();
    for slot in 0..state.index.len() {
        let velocity = setting.path.end_velocity(at(&state.velocity, slot));
        let center = setting.path.center(at(&state.position, slot), velocity, ago);
        let center = setting.periodic.map_or(center, |space| space.wrap(center));
        put(&mut moved, slot, center);
    }
    moved
}
