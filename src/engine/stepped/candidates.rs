//! Candidates: when the broad phase is renewed.

use super::region::Region;
use super::setting::Setting;
use crate::lane::Lane;
use crate::real::Real;

/// Steps that a search for bodies near fixed features should be good for where
/// there are no pairs: few bodies are near, and a search is worth many steps.
const STEPS_ALONE: i32 = 64;

/// Searches again for all that can touch within the skin, when bodies move by
/// `travel` in a step at most.
pub(super) fn renew<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    travel: T,
) {
    let (state, nearby) = (&mut region.state, &mut region.nearby);
    // Two bodies may have passed each other within the step just taken.
    let swept = match setting.is_within_step() {
        false => T::ZERO,
        true => nearby.broadphase.swept(travel),
    };
    let pairs = setting.plan.has_pairs;
    let is_alone = !pairs && !nearby.broadphase.has_many_parts();
    let alone = if is_alone { travel * T::whole(STEPS_ALONE) } else { T::ZERO };
    let skin = nearby.broadphase.skin(travel, nearby.skin).greater(swept).greater(alone);
    nearby.skin = skin;
    let (periodic, features, workers) = (setting.periodic, &setting.features, &setting.workers);
    let surveyed = state.surveyed(periodic, features, pairs);
    let order = nearby.broadphase.sort(&surveyed, skin, workers);
    state.reorder(order, workers);
    let surveyed = state.surveyed(periodic, features, pairs);
    nearby.broadphase.search::<L, _>(&surveyed, skin, &mut nearby.candidates, workers);
    // Within the step just taken bodies were further apart or nearer by as much.
    nearby.travelled = if setting.is_within_step() { travel } else { T::ZERO };
}
