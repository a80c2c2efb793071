//! Outcome: what a collision does, a function of the flights that lead to it.

use super::features::{Met, time_to_feature};
use super::flight::Flight;
use super::near::Image;
use super::setting::Setting;
use crate::bodies::PerBody;
use crate::contact::{Impulse, Laws, Party, collide_spread, one_material, with_law};
use crate::motion::flight::Wrap;
use crate::real::Real;
use crate::space::Space;
use crate::surroundings::Clearance;
use crate::vec3::Vec3;

/// A body that comes to a collision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival<T> {
    pub flight: Flight<T>,
    /// If collisions change it.
    pub spin: Vec3<T>,
    /// Its index in the scene.
    pub index: u32,
}

/// A body that leaves a collision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Departure<T> {
    pub flight: Flight<T>,
    /// If collisions change it.
    pub spin: Vec3<T>,
    /// By how many whole periodic boxes its position was set back.
    pub turns: Vec3<T>,
}

/// A collision of two bodies.
#[derive(Clone, Debug)]
pub(super) struct PairOutcome<T: Real> {
    pub departures: [Departure<T>; 2],
    /// On the first body.
    pub impulse: Impulse<T>,
    /// From the second centre to the first.
    pub offset: Vec3<T>,
    /// From the point of contact to the first centre.
    pub arm: Vec3<T>,
}

/// A collision of a body with a feature.
#[derive(Clone, Debug)]
pub(super) struct FeatureOutcome<T: Real> {
    pub departure: Departure<T>,
    pub impulse: Impulse<T>,
    /// From the point of contact to the centre.
    pub arm: Vec3<T>,
}

/// A flight up to a time, from where the next one starts, and the whole periodic boxes
/// by which it was set back.
#[inline(always)]
pub(super) fn ended<T: Real>(
    setting: &Setting<T>,
    flight: &Flight<T>,
    time: T,
) -> (Flight<T>, Vec3<T>) {
    let (position, velocity) = setting.state_of(flight, time);
    let mut next = Flight { position, velocity, since: time, radius: flight.radius };
    let Some(space) = setting.periodic else { return (next, Vec3::ZERO) };
    next.position = space.wrap(position);
    (next, space.turns(position - next.position))
}

/// Two bodies collide, the first of the scene first.
#[inline(always)]
pub(super) fn pair_outcome<T: Real>(
    setting: &Setting<T>,
    [a, b]: [&Arrival<T>; 2],
    time: T,
) -> PairOutcome<T> {
    let (flight_a, turns_a) = ended(setting, &a.flight, time);
    let (flight_b, turns_b) = ended(setting, &b.flight, time);
    let offset = flight_a.position - flight_b.position;
    let offset = setting.periodic.map_or(offset, |space| space.nearest(offset));
    let (share_a, share_b) = match setting.bodies.radius {
        PerBody::Same(_) => (T::ratio(1, 2), T::ratio(1, 2)),
        PerBody::Each(_) => {
            let reach = flight_a.radius + flight_b.radius;
            (flight_a.radius / reach, flight_b.radius / reach)
        }
    };
    let mut party_a = party(setting, a, &flight_a, share_a);
    let mut party_b = party(setting, b, &flight_b, share_b);
    let impulse = collide(setting, offset, &mut party_a, &mut party_b);
    let departures =
        [departure(flight_a, turns_a, &party_a), departure(flight_b, turns_b, &party_b)];
    PairOutcome { departures, impulse, offset, arm: offset * share_a }
}

/// A body collides with a feature.
pub(super) fn feature_outcome<T: Real>(
    setting: &Setting<T>,
    arrival: &Arrival<T>,
    met: &Met<T>,
    feature: u32,
    time: T,
) -> FeatureOutcome<T> {
    let (mut flight, turns) = ended(setting, &arrival.flight, time);
    if let Some(touching) = touching_hollow(setting, met, feature) {
        flight = Flight { since: time, ..touching };
    }
    let arm = clearance(setting, &flight, feature).arm;
    let mut own = party(setting, arrival, &flight, T::ONE);
    let impulse = collide(setting, arm, &mut own, &mut Party::immovable());
    let departure = departure(flight, turns, &own);
    FeatureOutcome { departure, impulse, arm }
}

/// The flight of a body where it touches a feature that is curved towards
/// it; `None` of other features. Along such a one flights are shorter than the rounding
/// of times and places allows: the time is taken from the flight's own start, and the
/// surfaces touch exactly.
fn touching_hollow<T: Real>(setting: &Setting<T>, met: &Met<T>, feature: u32) -> Option<Flight<T>> {
    let is_hollow = setting.features.at(feature).is_hollow();
    if !is_hollow || setting.periodic.is_some() {
        return None;
    }
    let wait = time_to_feature(setting, met, Image { feature, image: 0 })?;
    let flight = met.flight;
    let (position, velocity) = setting.state_of(&Flight { since: T::ZERO, ..flight }, wait);
    let clearance = setting.features.at(feature).clearance(position, flight.radius);
    Some(Flight { position: position + clearance.way_to_touch(), velocity, ..flight })
}

/// Where a body stands to a feature, of all its images the one that is touched.
fn clearance<T: Real>(setting: &Setting<T>, flight: &Flight<T>, feature: u32) -> Clearance<T> {
    let feature = setting.features.at(feature);
    let clearances = setting
        .images
        .iter()
        .map(|shift| feature.clearance(flight.position - *shift, flight.radius));
    let touched = clearances.reduce(|a, b| if b.gap.abs() < a.gap.abs() { b } else { a });
    touched.unwrap_or(Clearance { gap: T::ZERO, arm: Vec3::ZERO })
}

/// A body as a party of a collision.
#[inline(always)]
fn party<T: Real>(
    setting: &Setting<T>,
    arrival: &Arrival<T>,
    flight: &Flight<T>,
    share: T,
) -> Party<T> {
    let index = arrival.index as usize;
    Party {
        velocity: flight.velocity,
        spin: arrival.spin,
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

#[inline(always)]
fn departure<T: Real>(flight: Flight<T>, turns: Vec3<T>, party: &Party<T>) -> Departure<T> {
    let flight = Flight { velocity: party.velocity, ..flight };
    Departure { flight, spin: party.spin, turns }
}
