//! Find: which candidates are in contact within the step.

use super::contacts::Contact;
use super::lanes::in_lanes;
use super::narrow::{AtEnd, Detection, WithinStep, touching_pairs, touching_surroundings};
use super::region::{Nearby, Region};
use super::setting::Setting;
use super::state::State;
use crate::bodies::{Figure, PerBody, Same, at};
use crate::lane::Lane;
use crate::real::Real;
use crate::scene::Impact;
use crate::space::broadphase::{Candidates, Chunk};
use crate::space::{OpenSpace, Space};

/// Finds all contacts of the step, in their order, when bodies move by `travel`
/// in it at most.
pub(super) fn find_contacts<T: Real>(setting: &Setting<T>, region: &mut Region<T>, travel: T) {
    let (state, nearby, pending) = (&region.state, &region.nearby, &mut region.pending);
    let candidates = &nearby.candidates.chunks;
    pending.found.resize_with(candidates.len(), Vec::new);
    let mut chunks: Vec<_> = candidates.iter().zip(&mut pending.found).collect();
    let lanes = setting.plan.gather_lanes;
    match setting.plan.impact {
        Impact::EndOfStep => setting.workers.each(&mut chunks, |(chunk, found)| {
            found.clear();
            in_lanes!(gather lanes, search::<T>(setting, state, nearby, AtEnd, chunk, found));
        }),
        Impact::SubStep => {
            let within = WithinStep { path: setting.path, sweep: travel + travel };
            setting.workers.each(&mut chunks, |(chunk, found)| {
                found.clear();
                in_lanes!(gather lanes, search::<T>(setting, state, nearby, within, chunk, found));
            });
        }
    }
    pending.waiting.clear();
    for found in &pending.found {
        pending.waiting.extend_from_slice(found);
    }
    pending.waiting.sort_unstable_by(Contact::order);
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
    let shells = Candidates::shells_within(nearby.travelled + nearby.travelled, nearby.skin);
    for pairs in &chunk.pairs[..shells] {
        match setting.periodic {
            None => {
                touching_pairs::<L, _, _, _, _>(state, detection, radius, OpenSpace, pairs, found);
            }
            Some(space) => {
                touching_pairs::<L, _, _, _, _>(state, detection, radius, space, pairs, found);
            }
        }
    }
    for (number, near) in chunk.at_parts() {
        let feature = (number, &setting.features[number as usize]);
        touching_surroundings::<L, _, _, _>(state, detection, radius, feature, near, found);
    }
}

/// After a round within a step: the contacts of the bodies that took part are
/// found again, on their new paths.
pub(super) fn find_again<T: Real>(setting: &Setting<T>, region: &mut Region<T>) {
    let (state, nearby, pending) = (&region.state, &region.nearby, &mut region.pending);
    let rounds = &pending.rounds;
    let is_struck = |contact: &Contact<T>| {
        rounds.is_struck(contact.a) || (contact.rank.is_pair() && rounds.is_struck(contact.b))
    };
    pending.waiting.retain(|contact| !is_struck(contact));
    if pending.now.is_empty() {
        return;
    }
    let within = WithinStep { path: setting.path, sweep: nearby.travelled + nearby.travelled };
    let mut found = Vec::new();
    for chunk in &nearby.candidates.chunks {
        let near = chunk.of(|body| rounds.is_struck(body));
        search::<T, T>(setting, state, nearby, within, &near, &mut found);
    }
    let found = found.into_iter().filter_map(|contact| on_new_path(setting, region, contact));
    let found: Vec<_> = found.collect();
    region.pending.waiting.extend(found);
    region.pending.waiting.sort_unstable_by(Contact::order);
}

/// A contact at the time when it takes effect on the new paths of its bodies:
/// where it seems to have come before they took them, at their beginning, if
/// the surfaces touch and approach there, as those of balls in a row do.
fn on_new_path<T: Real>(
    setting: &Setting<T>,
    region: &Region<T>,
    contact: Contact<T>,
) -> Option<Contact<T>> {
    match region.pending.struck.last_before(&contact).ok()? {
        Some(last) if contact.ago > last => {
            is_touching(setting, region, &contact, last).then_some(Contact { ago: last, ..contact })
        }
        _ => Some(contact),
    }
}

/// Whether the surfaces of a contact touch, to rounding, and approach a time
/// before the end of the step.
fn is_touching<T: Real>(
    setting: &Setting<T>,
    region: &Region<T>,
    contact: &Contact<T>,
    ago: T,
) -> bool {
    let rounding = region.nearby.broadphase.rounding() * T::whole(8);
    let (state, path) = (&region.state, &setting.path);
    let a = contact.a as usize;
    let (position, velocity) = (at(&state.position, a), at(&state.velocity, a));
    let radius = state.radius.of(a);
    if contact.rank.is_pair() {
        let b = contact.b as usize;
        let relative = velocity - at(&state.velocity, b);
        let offset = position - at(&state.position, b);
        let offset = setting.periodic.map_or(offset, |space| space.nearest(offset));
        let offset = offset - relative * ago;
        let reach = radius + state.radius.of(b) + rounding;
        offset.length_squared() <= reach * reach && relative.dot(offset) < T::ZERO
    } else {
        let end_velocity = path.end_velocity(velocity);
        let center = path.center(position, end_velocity, ago);
        let clearance = setting.features[contact.b as usize].clearance::<T>(center, radius);
        let approach = path.velocity(end_velocity, ago).dot(clearance.arm);
        clearance.gap <= rounding && approach < T::ZERO
    }
}
