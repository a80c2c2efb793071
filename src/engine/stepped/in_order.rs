//! In order: the contacts within a step take effect one after the other.
//!
//! What bodies meet until the end of the step stands in a queue, by time and then
//! by rank. The first contact takes effect, its bodies fly on along new paths, and
//! what these lead to is looked for among the candidates of the two. So a contact
//! takes effect only when no earlier one can reach its bodies, whatever the step.
//!
//! A step is taken in one stretch if the candidates are complete for it. They are
//! not where a body moves too far for one search, or where a contact has made one
//! so fast that it can leave its neighbourhood: then there is another search, and
//! the rest of the step is another stretch. A contact time is a function of two
//! paths, and so stretches change no bit.
//!
//! In rounds of all contacts that are first for their bodies, one in 3,000 came too
//! late at 0.13 diameters a step, as its body should have met a third one before.

use super::among_all::touching_any;
use super::apply::apply;
use super::candidates::renew;
use super::clock::Clock;
use super::contacts::Contact;
use super::find::{find, search_chunk};
use super::impact::Outcome;
use super::lanes::in_lanes;
use super::narrow::WithinStep;
use super::neighbourhoods::Neighbour;
use super::path::Stretch;
use super::queue::Due;
use super::record::Record;
use super::region::{Pending, Region};
use super::resolve::impulses_of_kind;
use super::setting::Setting;
use super::struck::Struck;
use crate::engine::account::Account;
use crate::real::Real;
use crate::space::broadphase::Chunk;
use crate::vec3::Vec3;

/// Into how many stretches a step is cut at most for bodies that move far in it.
const MOST_STRETCHES: i32 = 1024;

/// Lets all contacts within a step take effect, when bodies move by `travel` in it
/// at most before the first one.
pub(super) fn collide_in_order<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock,
    account: &mut Account,
    mut record: Option<&mut Record<T>>,
    travel: T,
) {
    let fastest = travel / setting.dt;
    let mut stretch = Stretch { from: setting.dt, until: T::ZERO, fastest };
    if !region.nearby.is_complete() || !is_within_box(setting, travel) {
        stretch = next_stretch(setting, region, stretch);
    }
    loop {
        let images = further(setting, region, stretch);
        find_due(setting, region, stretch, &images);
        let record = record.as_deref_mut();
        let is_whole = take_due(setting, region, clock, account, record, &mut stretch, images);
        if is_whole && stretch.until == T::ZERO {
            break;
        }
        if is_whole {
            stretch.from = stretch.until;
        }
        stretch = next_stretch(setting, region, stretch);
    }
    region.pending.struck.clear();
}

/// How far a body may move in a stretch for the images of another one that it can
/// meet to be the nearest one at its end and the neighbours of that; `None` in open
/// space.
fn longest_in_box<T: Real>(setting: &Setting<T>) -> Option<T> {
    let space = setting.periodic?;
    let [x, y, z] = space.sides().to_array();
    Some(x.lesser(y).lesser(z) * T::ratio(1, 4))
}

fn is_within_box<T: Real>(setting: &Setting<T>, way: T) -> bool {
    longest_in_box(setting).is_none_or(|longest| way <= longest)
}

/// The stretch from a time on, with candidates that are complete for it.
fn next_stretch<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    rest: Stretch<T>,
) -> Stretch<T> {
    let rest = Stretch { until: T::ZERO, ..rest };
    let by_search = region.nearby.broadphase.longest_way(setting.plan.has_pairs);
    let longest = [by_search, longest_in_box(setting)].into_iter().flatten().reduce(T::lesser);
    let until = match longest {
        Some(longest) if rest.way() > longest && rest.way().is_finite() => {
            let part = (longest / rest.fastest).greater(setting.dt / T::whole(MOST_STRETCHES));
            (rest.from - part).greater(T::ZERO)
        }
        _ => T::ZERO,
    };
    let stretch = Stretch { until, ..rest };
    let (lanes, travel) = (setting.plan.gather_lanes, rest.fastest * setting.dt);
    in_lanes!(gather lanes, renew::<T>(setting, region, travel, Some(stretch)));
    stretch
}

/// What is looked for in a stretch.
fn within<'a, T: Real>(
    setting: &'a Setting<T>,
    struck: &'a Struck<T>,
    stretch: Stretch<T>,
    further: &'a [Vec3<T>],
) -> WithinStep<'a, T> {
    let (path, periodic) = (&setting.path, setting.periodic.as_ref());
    WithinStep { path, struck, stretch, periodic, further, is_again: false }
}

/// Finds the first contacts of all candidates in a stretch.
fn find_due<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    stretch: Stretch<T>,
    further: &[Vec3<T>],
) {
    let (state, nearby, pending) = (&region.state, &region.nearby, &mut region.pending);
    let detection = within(setting, &pending.struck, stretch, further);
    find(setting, state, nearby, &detection, &mut pending.found);
    pending.ahead.clear();
    for found in &pending.found {
        pending.ahead.extend_from_slice(found);
    }
    pass_over_repeats(setting, region, stretch, further);
    let Pending { queue, ahead, struck, .. } = &mut region.pending;
    queue.begin(ahead.iter().map(|&contact| Due { contact, count: struck.count(&contact) }));
}

/// Lets the contacts within a step take effect whose first ones are `found`, when all that can
/// touch in it are candidates, in open space.
pub(super) fn collide_found<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock,
    account: &mut Account,
    record: Option<&mut Record<T>>,
    found: &[Contact<T>],
    fastest: T,
) {
    let mut stretch = Stretch { from: setting.dt, until: T::ZERO, fastest };
    region.pending.queue.begin(found.iter().map(|&contact| Due { contact, count: 0 }));
    // It ends before all are taken if a speed is no number.
    take_due(setting, region, clock, account, record, &mut stretch, Vec::new());
}

/// Takes the contacts of a stretch in their order. False if one has made a body so
/// fast that the candidates are no longer complete: then the rest of the stretch is
/// left.
fn take_due<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock,
    account: &mut Account,
    mut record: Option<&mut Record<T>>,
    stretch: &mut Stretch<T>,
    mut images: Vec<Vec3<T>>,
) -> bool {
    let field = setting.acceleration.map_or(T::ZERO, Vec3::length) * setting.dt;
    while let Some(Due { contact, count }) = region.pending.queue.take() {
        if count != region.pending.struck.count(&contact) {
            continue;
        }
        let mut outcome = [Outcome::NONE];
        impulses_of_kind::<T, T>(setting, &region.state, &[contact], &mut outcome);
        let [outcome] = outcome;
        // A graze that rounding turned away must not be found again either.
        region.pending.struck.strike(&contact);
        stretch.from = contact.ago;
        if outcome.collided {
            let collision = (&contact, &outcome);
            apply(setting, &mut region.state, clock, account, collision, record.as_deref_mut());
            let speed = outcome.a.velocity.length().greater(outcome.b.velocity.length());
            let speed = (speed + field) * T::ratio(65, 64);
            if speed > stretch.fastest {
                let nearby = &mut region.nearby;
                nearby.travelled = nearby.travelled + (speed - stretch.fastest) * setting.dt;
                stretch.fastest = speed;
                if !nearby.is_complete() || !is_within_box(setting, stretch.way()) {
                    return false;
                }
                images = further(setting, region, *stretch);
            }
        }
        look_ahead(setting, region, &contact, *stretch, &images);
    }
    true
}

/// Finds what the bodies of a contact meet on their new paths.
fn look_ahead<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    contact: &Contact<T>,
    stretch: Stretch<T>,
    further: &[Vec3<T>],
) {
    region.pending.ahead.clear();
    if region.nearby.are_all {
        look_at_all(setting, region, contact, stretch);
    } else {
        look_at_neighbours(setting, region, contact, stretch, further);
    }
    pass_over_repeats(setting, region, stretch, further);
    let Pending { queue, ahead, struck, .. } = &mut region.pending;
    for &contact in &*ahead {
        queue.add(Due { contact, count: struck.count(&contact) });
    }
}

/// Finds what the bodies of a contact meet of what is near them.
fn look_at_neighbours<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    contact: &Contact<T>,
    stretch: Stretch<T>,
    further: &[Vec3<T>],
) {
    let (state, nearby, pending) = (&region.state, &mut region.nearby, &mut region.pending);
    nearby.neighbourhoods.know(&nearby.candidates, state.index.len(), &setting.workers);
    let near = &mut pending.near;
    near.clear();
    for slot in contact.bodies() {
        for neighbour in nearby.neighbourhoods.of(slot) {
            match neighbour {
                Neighbour::Body(other) => near.add_pair([slot, other]),
                Neighbour::Part(part) => near.add_at_part(part, slot),
            }
        }
    }
    // Whole packs: no body meets itself.
    near.fill_up(setting.plan.gather_lanes, [contact.a; 2]);
    let detection = within(setting, &pending.struck, stretch, further);
    search_chunk(setting, state, nearby, &detection, near, &mut pending.ahead);
}

/// Finds what the bodies of a contact meet of all bodies and features, in open space.
fn look_at_all<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    contact: &Contact<T>,
    stretch: Stretch<T>,
) {
    let (state, pending) = (&region.state, &mut region.pending);
    let detection = within(setting, &pending.struck, stretch, &[]);
    for slot in contact.bodies() {
        if setting.plan.has_pairs {
            let (lanes, found) = (setting.plan.gather_lanes, &mut pending.ahead);
            in_lanes!(gather lanes, touching_any::<T>(&detection, state, slot, found));
        }
        detection.touching_parts(state, &setting.features, slot, &mut pending.ahead);
    }
}

/// Leaves out of the contacts found those of a pair that has just met, with nothing
/// between, and those of bodies that have had all contacts of a step.
fn pass_over_repeats<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    stretch: Stretch<T>,
    further: &[Vec3<T>],
) {
    let (state, nearby) = (&region.state, &region.nearby);
    let Pending { ahead, struck, .. } = &mut region.pending;
    if struck.is_empty() {
        return;
    }
    // Through the other side of a box they may well meet.
    let mut again = setting.periodic.map(|_| Chunk::default());
    ahead.retain(|contact| {
        let is_again = contact.rank.is_pair() && struck.is_again(contact);
        if let (true, Some(again)) = (is_again, &mut again) {
            again.add_pair([contact.a, contact.b]);
        }
        !is_again && !contact.bodies().any(|slot| struck.is_spent(slot))
    });
    if let Some(again) = again.filter(|again| !again.pairs[0].is_empty()) {
        let detection = within(setting, struck, stretch, further);
        let detection = WithinStep { is_again: true, ..detection };
        search_chunk(setting, state, nearby, &detection, &again, ahead);
        ahead.retain(|contact| !contact.bodies().any(|slot| struck.is_spent(slot)));
    }
}

/// The images of a pair that can touch in a stretch besides the nearest one at its
/// end, in whole boxes from there: none but in a narrow box.
fn further<T: Real>(setting: &Setting<T>, region: &Region<T>, stretch: Stretch<T>) -> Vec<Vec3<T>> {
    let Some(space) = setting.periodic else { return Vec::new() };
    let way = stretch.way();
    let greatest = region.nearby.broadphase.greatest_radius();
    let reach = greatest + greatest + way + way;
    let along = |side: T| if reach + reach < side { 0..=0 } else { -1..=1 };
    let [x, y, z] = space.sides().to_array();
    let mut further = Vec::new();
    for z in along(z) {
        for y in along(y) {
            let row = along(x).filter(|&x| [x, y, z] != [0; 3]);
            further.extend(row.map(|x| Vec3::new(T::whole(x), T::whole(y), T::whole(z))));
        }
    }
    further
}
