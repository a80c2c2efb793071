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

use core::cmp::Ordering;

use super::apply::apply;
use super::candidates::renew;
use super::clock::Clock;
use super::contacts::Contact;
use super::find::{find, search_chunk};
use super::impact::Outcome;
use super::lanes::in_lanes;
use super::narrow::WithinStep;
use super::path::Stretch;
use super::record::Record;
use super::region::Region;
use super::resolve::impulses_of_kind;
use super::setting::Setting;
use crate::engine::account::Account;
use crate::real::Real;
use crate::space::broadphase::Chunk;
use crate::vec3::Vec3;

/// Into how many stretches a step is cut at most for bodies that move far in it.
const MOST_STRETCHES: i32 = 1024;

/// A contact that takes effect in its turn, unless a body has another one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Due<T> {
    contact: Contact<T>,
    /// How many contacts its bodies had had when it was found.
    count: u32,
}

impl<T: Real> Ord for Due<T> {
    /// The first one is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.contact.order(&self.contact)
    }
}

impl<T: Real> PartialOrd for Due<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T: Real> Eq for Due<T> {}

impl<T: Real> PartialEq for Due<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

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
        find_due(setting, region, stretch);
        if let Err(broken_off) =
            take_due(setting, region, clock, account, record.as_deref_mut(), stretch)
        {
            stretch = next_stretch(setting, region, broken_off);
        } else if stretch.until > T::ZERO {
            let from = stretch.until;
            stretch = next_stretch(setting, region, Stretch { from, ..stretch });
        } else {
            break;
        }
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

/// Finds the first contacts of all candidates in a stretch.
fn find_due<T: Real>(setting: &Setting<T>, region: &mut Region<T>, stretch: Stretch<T>) {
    let further = further(setting, region, stretch);
    let (state, nearby, pending) = (&region.state, &region.nearby, &mut region.pending);
    let detection = WithinStep {
        path: &setting.path,
        struck: &pending.struck,
        stretch,
        periodic: setting.periodic,
        further: &further,
        is_again: false,
    };
    find(setting, state, nearby, detection, &mut pending.found);
    pending.ahead.clear();
    for found in &pending.found {
        pending.ahead.extend_from_slice(found);
    }
    pending.due.clear();
    expect(setting, region, stretch, &further);
}

/// Takes the contacts of a stretch in their order. `Err` if one has made a body so
/// fast that the candidates are no longer complete: the rest of the stretch.
fn take_due<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock,
    account: &mut Account,
    mut record: Option<&mut Record<T>>,
    mut stretch: Stretch<T>,
) -> Result<(), Stretch<T>> {
    let mut images = further(setting, region, stretch);
    let field = setting.acceleration.map_or(T::ZERO, Vec3::length) * setting.dt;
    while let Some(Due { contact, count }) = region.pending.due.pop() {
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
                    return Err(stretch);
                }
                images = further(setting, region, stretch);
            }
        }
        look_ahead(setting, region, &contact, stretch, &images);
    }
    Ok(())
}

/// Finds what the bodies of a contact meet on their new paths.
fn look_ahead<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    contact: &Contact<T>,
    stretch: Stretch<T>,
    further: &[Vec3<T>],
) {
    let (state, nearby, pending) = (&region.state, &mut region.nearby, &mut region.pending);
    nearby.neighbourhoods.know(&nearby.candidates, state.index.len());
    let near = &mut pending.near;
    near.clear();
    for slot in contact.bodies() {
        for &other in nearby.neighbourhoods.bodies(slot) {
            near.add_pair([slot, other]);
        }
        for &part in nearby.neighbourhoods.parts(slot) {
            near.add_at_part(part, slot);
        }
    }
    // Whole packs: no body meets itself.
    near.fill_up(setting.plan.gather_lanes, [contact.a; 2]);
    let detection = WithinStep {
        path: &setting.path,
        struck: &pending.struck,
        stretch,
        periodic: setting.periodic,
        further,
        is_again: false,
    };
    pending.ahead.clear();
    search_chunk(setting, state, nearby, detection, near, &mut pending.ahead);
    expect(setting, region, stretch, further);
}

/// Puts the contacts found into the queue, but those of a pair that has just met,
/// with nothing between; through the other side of a periodic box it may well meet.
fn expect<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    stretch: Stretch<T>,
    further: &[Vec3<T>],
) {
    let (state, nearby, pending) = (&region.state, &region.nearby, &mut region.pending);
    let struck = &pending.struck;
    let mut met_again = Vec::new();
    for &contact in &pending.ahead {
        if contact.bodies().any(|slot| struck.is_spent(slot)) {
            continue;
        }
        if contact.rank.is_pair() && struck.is_again(&contact) {
            if setting.periodic.is_some() {
                met_again.push([contact.a, contact.b]);
            }
            continue;
        }
        pending.due.push(Due { contact, count: struck.count(&contact) });
    }
    if met_again.is_empty() {
        return;
    }
    let mut near = Chunk::default();
    met_again.into_iter().for_each(|pair| near.add_pair(pair));
    let detection = WithinStep {
        path: &setting.path,
        struck,
        stretch,
        periodic: setting.periodic,
        further,
        is_again: true,
    };
    let mut found = Vec::new();
    search_chunk(setting, state, nearby, detection, &near, &mut found);
    for contact in found {
        pending.due.push(Due { contact, count: struck.count(&contact) });
    }
}

/// The images of a pair that can touch in a stretch, in whole boxes from the
/// nearest one at its end.
fn further<T: Real>(setting: &Setting<T>, region: &Region<T>, stretch: Stretch<T>) -> Vec<Vec3<T>> {
    let Some(space) = setting.periodic else { return vec![Vec3::ZERO] };
    let way = stretch.way();
    let greatest = region.nearby.broadphase.greatest_radius();
    let reach = greatest + greatest + way + way;
    let along = |side: T| if reach + reach < side { 0..=0 } else { -1..=1 };
    let [x, y, z] = space.sides().to_array();
    let mut further = Vec::new();
    for z in along(z).map(T::whole) {
        for y in along(y).map(T::whole) {
            further.extend(along(x).map(|x| Vec3::new(T::whole(x), y, z)));
        }
    }
    further
}
