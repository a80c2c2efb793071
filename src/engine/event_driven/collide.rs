//! Collide: what happens when the time of a contact has come.

use super::agenda::{Mark, PartnerCode};
use super::clock::Clock;
use super::crossing::plan_crossing;
use super::features::time_to_feature;
use super::flight::{Flight, Record};
use super::near::Image;
use super::period::end_flight;
use super::region::Region;
use super::search::search;
use super::setting::Setting;
use super::turns::enter;
use crate::bodies::PerBody;
use crate::contact::{Impulse, Laws, Party, collide_spread, one_material, with_law};
use crate::engine::account::Account;
use crate::engine::{Event, Listener, Partner};
use crate::real::Real;
use crate::space::Space;
use crate::surroundings::Clearance;
use crate::vec3::Vec3;

/// The bodies in two slots collide.
pub(super) fn collide_pair<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock<T>,
    account: &mut Account,
    [one, other]: [u32; 2],
    time: T,
    on_event: &mut Listener<'_, T>,
) {
    // The first body of the scene comes first, whichever of the two is due.
    let swapped = region.index[one as usize] > region.index[other as usize];
    let (one, other) = if swapped { (other, one) } else { (one, other) };
    let (a, b) = (one as usize, other as usize);
    end_flight(setting, region, account, a, time, time);
    end_flight(setting, region, account, b, time, time);
    let (flight_a, flight_b) = (region.records[a].flight(), region.records[b].flight());
    let offset = flight_a.position - flight_b.position;
    let offset = setting.periodic.map_or(offset, |space| space.nearest(offset));
    let (share_a, share_b) = match setting.bodies.radius {
        PerBody::Same(_) => (T::ratio(1, 2), T::ratio(1, 2)),
        PerBody::Each(_) => {
            let reach = flight_a.radius + flight_b.radius;
            (flight_a.radius / reach, flight_b.radius / reach)
        }
    };
    let mut party_a = party(setting, region, a, share_a);
    let mut party_b = party(setting, region, b, share_b);
    let impulse = collide(setting, offset, &mut party_a, &mut party_b);
    let (index_a, index_b) = (region.index[a], region.index[b]);
    depart(setting, region, a, &party_a, PartnerCode::body(index_b), clock.too_fast);
    depart(setting, region, b, &party_b, PartnerCode::body(index_a), clock.too_fast);
    account.pair(impulse.normal, offset);

    if let Some(on_event) = on_event {
        let partner = Partner::Body {
            index: index_b,
            velocity: party_b.velocity,
            spin: region.spin_of(setting, b),
        };
        let contact = Contact { slot: a, time, arm: offset * share_a, offset };
        on_event(&event(setting, region, clock, contact, partner, &impulse));
    }
    for slot in [one, other] {
        look_ahead(setting, region, account, slot, time, clock.period);
    }
}

/// The body in a slot collides with a feature.
pub(super) fn collide_with_feature<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock<T>,
    account: &mut Account,
    (slot, feature): (u32, u32),
    time: T,
    on_event: &mut Listener<'_, T>,
) {
    let at = slot as usize;
    let touching = touching_hollow(setting, region, slot, feature);
    end_flight(setting, region, account, at, time, time);
    if let Some(flight) = touching {
        region.records[at] = Record::new(Flight { since: time, ..flight });
    }
    let arm = clearance(setting, region, at, feature).arm;
    let mut own = party(setting, region, at, T::ONE);
    let impulse = collide(setting, arm, &mut own, &mut Party::immovable());
    depart(setting, region, at, &own, PartnerCode::feature(feature), clock.too_fast);
    account.surroundings(impulse.normal + impulse.tangential);
    if let Some(on_event) = on_event {
        let partner = Partner::Surroundings(setting.parts[feature as usize]);
        let contact = Contact { slot: at, time, arm, offset: arm };
        on_event(&event(setting, region, clock, contact, partner, &impulse));
    }
    look_ahead(setting, region, account, slot, time, clock.period);
}

/// The flight of the body in a slot where it touches a feature that is curved towards
/// it; `None` of other features. Along such a one flights are shorter than the rounding
/// of times and places allows: the time is taken from the flight's own start, and the
/// surfaces touch exactly.
fn touching_hollow<T: Real>(
    setting: &Setting<T>,
    region: &Region<T>,
    slot: u32,
    feature: u32,
) -> Option<Flight<T>> {
    let is_hollow = setting.features[feature as usize].is_hollow();
    if !is_hollow || setting.periodic.is_some() {
        return None;
    }
    let wait = time_to_feature(setting, region, slot, Image { feature, image: 0 })?;
    let flight = region.records[slot as usize].flight();
    let (position, velocity) = setting.state_of(&Flight { since: T::ZERO, ..flight }, wait);
    let clearance = setting.features[feature as usize].clearance(position, flight.radius);
    Some(Flight { position: position + clearance.way_to_touch(), velocity, ..flight })
}

/// Where the body in a slot stands to a feature, of all its images the one that is
/// touched.
fn clearance<T: Real>(
    setting: &Setting<T>,
    region: &Region<T>,
    slot: usize,
    feature: u32,
) -> Clearance<T> {
    let flight = region.records[slot].flight();
    let feature = &setting.features[feature as usize];
    let clearances = setting
        .images
        .iter()
        .map(|shift| feature.clearance(flight.position - *shift, flight.radius));
    let touched = clearances.reduce(|a, b| if b.gap.abs() < a.gap.abs() { b } else { a });
    touched.unwrap_or(Clearance { gap: T::ZERO, arm: Vec3::ZERO })
}

/// The body in a slot as a party of a collision.
#[inline(always)]
fn party<T: Real>(setting: &Setting<T>, region: &Region<T>, slot: usize, share: T) -> Party<T> {
    let index = region.index[slot] as usize;
    Party {
        velocity: region.records[slot].flight().velocity,
        spin: if setting.plan.changes_spins { region.spins[slot] } else { Vec3::ZERO },
        inverse_mass: setting.inverse_mass.of(index),
        inverse_inertia: setting.inverse_inertia.of(index),
        share,
    }
}

#[inline(always)]
fn collide<T: Real>(
    setting: &Setting<T>,
    offset: Vec3<T>,
    a: &mut Party<T>,
    b: &mut Party<T>,
) -> Impulse<T> {
    with_law!(setting.plan.surface, law => {
        collide_spread(Laws::<T>::between::<T>(&law, one_material), offset, a, b)
    })
}

/// Starts the next flight of the body in a slot.
#[inline(always)]
fn depart<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    slot: usize,
    party: &Party<T>,
    last: PartnerCode,
    too_fast: T,
) {
    let flight = region.records[slot].flight();
    let flight = Flight { velocity: party.velocity, ..flight };
    region.records[slot] = Record::new(flight);
    region.coarse.put(slot, &flight);
    if setting.plan.changes_spins {
        region.spins[slot] = party.spin;
    }
    let changes = region.marks[slot].changes.wrapping_add(1);
    region.marks[slot] = Mark { changes, last };
    region.is_too_fast |= party.velocity.length_squared() > too_fast;
}

/// Finds what is ahead of a body after a collision.
#[inline(always)]
fn look_ahead<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    account: &mut Account,
    slot: u32,
    time: T,
    period: T,
) {
    plan_crossing(setting, region, slot, time, period);
    search(setting, region, &mut account.effort, slot, time, period);
    enter(region, slot);
}

/// Where and when a body is in contact.
struct Contact<T> {
    slot: usize,
    time: T,
    /// From the point of contact to the body's centre.
    arm: Vec3<T>,
    /// From the partner's centre, or from the point of contact, to the body's.
    offset: Vec3<T>,
}

fn event<T: Real>(
    setting: &Setting<T>,
    region: &Region<T>,
    clock: &Clock<T>,
    contact: Contact<T>,
    partner: Partner<T>,
    impulse: &Impulse<T>,
) -> Event<T> {
    let Contact { slot, time, arm, offset } = contact;
    let flight = region.records[slot].flight();
    Event {
        time: clock.not_before(time),
        a: region.index[slot],
        partner,
        point: flight.position - arm,
        normal: offset * (T::ONE / offset.length()),
        normal_impulse: impulse.normal.length(),
        tangential_impulse: impulse.tangential,
        velocity: flight.velocity,
        spin: region.spin_of(setting, slot),
    }
}
