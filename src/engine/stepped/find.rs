//! Find: which candidates are in contact within the step.

use super::contacts::Contact;
use super::lanes::in_lanes;
use super::narrow::{AtEnd, Detection, Part, touching_pairs, touching_surroundings};
use super::region::{Nearby, Region};
use super::setting::Setting;
use super::state::State;
use crate::bodies::{Figure, PerBody, Same};
use crate::lane::Lane;
use crate::real::Real;
use crate::space::OpenSpace;
use crate::space::broadphase::{Candidates, Chunk};

/// Finds all contacts at the end of the step: those that may take effect at once, and in
/// their order those that wait.
pub(super) fn find_contacts<T: Real>(setting: &Setting<T>, region: &mut Region<T>) {
    let pending = &mut region.pending;
    find(setting, &region.state, &region.nearby, AtEnd, &mut pending.found);
    pending.rounds.begin(&pending.found, &mut pending.waiting, &mut pending.now);
}

/// Finds what is in contact among all candidates, chunk by chunk.
pub(super) fn find<T: Real>(
    setting: &Setting<T>,
    state: &State<T>,
    nearby: &Nearby<T>,
    detection: impl Detection<T>,
    found: &mut Vec<Vec<Contact<T>>>,
) {
    let candidates = &nearby.candidates.chunks;
    found.resize_with(candidates.len(), Vec::new);
    let mut chunks: Vec<_> = candidates.iter().zip(found).collect();
    setting.workers.each(&mut chunks, |(chunk, found)| {
        found.clear();
        search_chunk(setting, state, nearby, detection, chunk, found);
    });
}

/// Finds what is in contact among the candidates of a chunk, appended to `found`.
pub(super) fn search_chunk<T: Real>(
    setting: &Setting<T>,
    state: &State<T>,
    nearby: &Nearby<T>,
    detection: impl Detection<T>,
    chunk: &Chunk,
    found: &mut Vec<Contact<T>>,
) {
    let lanes = setting.plan.gather_lanes;
    in_lanes!(gather lanes, search::<T>(setting, state, nearby, detection, chunk, found));
}

fn search<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    state: &State<T>,
    nearby: &Nearby<T>,
    detection: impl Detection<T>,
    chunk: &Chunk,
    found: &mut Vec<Contact<T>>,
) {
    match &state.radius {
        PerBody::Same(radius) => {
            search_with::<L, T, _>(setting, state, nearby, detection, Same(*radius), chunk, found);
        }
        PerBody::Each(radius) => {
            search_with::<L, T, _>(
                setting,
                state,
                nearby,
                detection,
                radius.padded(),
                chunk,
                found,
            );
        }
    }
    let shells = shells(nearby);
    for (number, near) in chunk.at_parts(shells) {
        let (feature, surface) = (setting.features.at(number), setting.features.surface_of(number));
        let part = Part { number, surface, feature };
        touching_surroundings::<L, T>(state, detection, &part, near, found);
    }
}

/// How many shells of the skin bodies can have come through.
fn shells<T: Real>(nearby: &Nearby<T>) -> usize {
    Candidates::shells_within(nearby.travelled + nearby.travelled, nearby.skin)
}

fn search_with<L: Lane<Scalar = T>, T: Real, R: Figure<T>>(
    setting: &Setting<T>,
    state: &State<T>,
    nearby: &Nearby<T>,
    detection: impl Detection<T>,
    radius: R,
    chunk: &Chunk,
    found: &mut Vec<Contact<T>>,
) {
    for pairs in &chunk.pairs[..shells(nearby)] {
        match setting.periodic {
            None => {
                touching_pairs::<L, _, _, _, _>(state, detection, radius, OpenSpace, pairs, found);
            }
            Some(space) => {
                touching_pairs::<L, _, _, _, _>(state, detection, radius, space, pairs, found);
            }
        }
    }
}
