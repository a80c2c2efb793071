//! Candidates: when the broad phase is renewed.

use super::path::Stretch;
use super::region::Region;
use super::setting::Setting;
use super::state::State;
use crate::bodies::Columns3;
use crate::column::Column;
use crate::lane::Lane;
use crate::motion::flight::Wrap;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// Steps that a search for bodies near fixed features should be good for where
/// there are no pairs: few bodies are near, and a search is worth many steps.
const STEPS_ALONE: i32 = 64;

/// Searches again for all that can touch within the skin, when bodies move by
/// `travel` in a step at most. Where contacts have times, bodies are looked at
/// where they are at the beginning of a stretch of the step just taken.
pub(super) fn renew<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    travel: T,
    stretch: Option<Stretch<T>>,
) {
    let (state, nearby) = (&mut region.state, &mut region.nearby);
    let way = stretch.map_or(T::ZERO, |stretch| stretch.way());
    let swept = nearby.broadphase.swept(way);
    let pairs = setting.plan.has_pairs;
    let is_alone = !pairs && !nearby.broadphase.has_many_parts();
    let alone = if is_alone { travel * T::whole(STEPS_ALONE) } else { T::ZERO };
    let skin = nearby.broadphase.skin(travel, nearby.skin).greater(swept).greater(alone);
    nearby.skin = skin;
    let (periodic, features, workers) = (setting.periodic, &setting.features, &setting.workers);
    // Wherever contacts send it, a body is never farther than its way from where
    // it is at the beginning of the stretch.
    let from = stretch.map_or(T::ZERO, |stretch| stretch.from);
    let begun = stretch.map(|_| positions::<L, T>(setting, state, from));
    let mut surveyed = state.surveyed(periodic, features, pairs);
    surveyed.position = begun.as_ref().unwrap_or(surveyed.position);
    let order = nearby.broadphase.sort(&surveyed, skin, workers);
    state.reorder(order, workers);
    region.pending.struck.reorder(order);
    let begun = stretch.map(|_| positions::<L, T>(setting, state, from));
    let mut surveyed = state.surveyed(periodic, features, pairs);
    surveyed.position = begun.as_ref().unwrap_or(surveyed.position);
    nearby.broadphase.search::<L, _>(&surveyed, skin, &mut nearby.candidates, workers);
    nearby.neighbourhoods.clear();
    nearby.travelled = way;
}

/// Where all bodies are a time before the end of the step, on their present paths.
fn positions<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    state: &State<T>,
    ago: T,
) -> Columns3<T> {
    let mut moved = state.position.clone();
    let [x, y, z] = moved.muts().each(Column::padded_mut);
    let load = |columns: &Columns3<T>, slot: usize| {
        let [x, y, z] = columns.refs().each(|column| L::load(&column.padded()[slot..]));
        Vec3::new(x, y, z)
    };
    for slot in (0..state.index.len()).step_by(L::WIDTH) {
        let velocity = setting.path.end_velocity(load(&state.velocity, slot));
        let center = setting.path.center(load(&state.position, slot), velocity, L::splat(ago));
        let center = setting.periodic.map_or(center, |space| space.wrap(center));
        center.x.store(&mut x[slot..]);
        center.y.store(&mut y[slot..]);
        center.z.store(&mut z[slot..]);
    }
    moved
}
