//! Collide: what happens when the time of a contact has come.

use super::EventDriven;
use super::agenda::{Mark, PartnerCode};
use super::flight::{Flight, Record};
use crate::bodies::PerBody;
use crate::contact::{Impulse, Party, Rough, Smooth, collide_spread};
use crate::engine::{Event, Listener, Partner};
use crate::real::Real;
use crate::space::Space;
use crate::vec3::Vec3;

impl<T: Real> EventDriven<T> {
    /// The bodies at two places collide.
    pub(super) fn collide_pair(
        &mut self,
        one: u32,
        other: u32,
        time: T,
        on_event: &mut Listener<'_, T>,
    ) {
        // The first body of the scene comes first, whoever's turn it is.
        let swapped = self.index[one as usize] > self.index[other as usize];
        let (one, other) = if swapped { (other, one) } else { (one, other) };
        let (a, b) = (one as usize, other as usize);
        self.end_flight(a, time, time);
        self.end_flight(b, time, time);
        let (flight_a, flight_b) = (self.records[a].flight(), self.records[b].flight());
        let offset = flight_a.position - flight_b.position;
        let offset = self.periodic.map_or(offset, |space| space.nearest(offset));
        let (share_a, share_b) = match self.bodies.radius {
            PerBody::Same(_) => (T::ratio(1, 2), T::ratio(1, 2)),
            PerBody::Each(_) => {
                let reach = flight_a.radius + flight_b.radius;
                (flight_a.radius / reach, flight_b.radius / reach)
            }
        };
        let mut party_a = self.party(a, share_a);
        let mut party_b = self.party(b, share_b);
        let impulse = self.impulse(offset, &mut party_a, &mut party_b);
        self.depart(a, &party_a, PartnerCode::body(self.index[b]));
        self.depart(b, &party_b, PartnerCode::body(self.index[a]));
        self.collisions.pairs += 1;
        self.tallies.pair(impulse.normal, offset);
        self.last_time = time;

        if let Some(on_event) = on_event {
            let partner = Partner::Body {
                index: self.index[b],
                velocity: party_b.velocity,
                spin: self.spin_of(b),
            };
            on_event(&self.event(a, time, partner, offset * share_a, offset, &impulse));
        }
        for place in [one, other] {
            self.look_ahead(place, time);
        }
    }

    /// The body at a place collides with a feature.
    pub(super) fn collide_with_feature(
        &mut self,
        place: u32,
        feature: u32,
        time: T,
        on_event: &mut Listener<'_, T>,
    ) {
        let at = place as usize;
        self.end_flight(at, time, time);
        let arm = self.arm(at, feature);
        let mut party = self.party(at, T::ONE);
        let impulse = self.impulse(arm, &mut party, &mut Party::immovable());
        self.depart(at, &party, PartnerCode::feature(feature));
        self.collisions.surroundings += 1;
        self.tallies.surroundings(impulse.normal + impulse.tangential);
        self.last_time = time;
        if let Some(on_event) = on_event {
            let partner = Partner::Surroundings(self.parts[feature as usize]);
            on_event(&self.event(at, time, partner, arm, arm, &impulse));
        }
        self.look_ahead(place, time);
    }

    /// From the point of contact with a feature, of all its images the one that
    /// is touched, to the centre of the body at a place.
    fn arm(&self, place: usize, feature: u32) -> Vec3<T> {
        let flight = self.records[place].flight();
        let feature = &self.features[feature as usize];
        let clearances = self
            .images
            .iter()
            .map(|shift| feature.clearance(flight.position - *shift, flight.radius));
        let touched = clearances.reduce(|a, b| if b.gap.abs() < a.gap.abs() { b } else { a });
        touched.map_or(Vec3::ZERO, |clearance| clearance.arm)
    }

    /// The body at a place as a party of a contact.
    #[inline(always)]
    fn party(&self, place: usize, share: T) -> Party<T> {
        let index = self.index[place] as usize;
        Party {
            velocity: self.records[place].flight().velocity,
            spin: if self.plan.is_rough { self.spins[place] } else { Vec3::ZERO },
            inverse_mass: self.inverse_mass.of(index),
            inverse_inertia: self.inverse_inertia.of(index),
            share,
        }
    }

    #[inline(always)]
    fn impulse(&self, offset: Vec3<T>, a: &mut Party<T>, b: &mut Party<T>) -> Impulse<T> {
        if self.plan.is_rough {
            collide_spread(Rough, offset, a, b)
        } else {
            collide_spread(Smooth, offset, a, b)
        }
    }

    /// Starts the next flight of the body at a place.
    #[inline(always)]
    fn depart(&mut self, place: usize, party: &Party<T>, last: PartnerCode) {
        let flight = self.records[place].flight();
        let flight = Flight { velocity: party.velocity, ..flight };
        self.records[place] = Record::new(flight);
        self.coarse.put(place, &flight);
        if self.plan.is_rough {
            self.spins[place] = party.spin;
        }
        let changes = self.marks[place].changes.wrapping_add(1);
        self.marks[place] = Mark { changes, last };
        self.is_too_fast |= party.velocity.length_squared() > self.too_fast;
    }

    /// Finds what is ahead of a body after a collision.
    #[inline(always)]
    fn look_ahead(&mut self, place: u32, time: T) {
        self.plan_crossing(place, time);
        self.search(place, time);
        self.enter(place);
    }

    fn event(
        &self,
        place: usize,
        time: T,
        partner: Partner<T>,
        arm: Vec3<T>,
        offset: Vec3<T>,
        impulse: &Impulse<T>,
    ) -> Event<T> {
        let flight = self.records[place].flight();
        Event {
            time: self.origin.value() + time.to_f64(),
            a: self.index[place],
            partner,
            point: flight.position - arm,
            normal: offset * (T::ONE / offset.length()),
            normal_impulse: impulse.normal.length(),
            tangential_impulse: impulse.tangential,
            velocity: flight.velocity,
            spin: self.spin_of(place),
        }
    }
}
