//! Features: when a body meets what is fixed.

use super::EventDriven;
use super::agenda::{Expected, PartnerCode};
use super::flight::Flight;
use super::near::Image;
use crate::contact::greatest_component;
use crate::real::Real;
use crate::space::Space;
use crate::surroundings::Feature;
use crate::vec3::Vec3;

impl<T: Real> EventDriven<T> {
    /// Looks for contacts of the body at a place with all features near it.
    pub(super) fn search_features(&mut self, place: u32) {
        for k in 0..self.near.everywhere().len() {
            self.expect_feature(place, self.near.everywhere()[k]);
        }
        self.search_features_of_cell(place);
    }

    /// Looks for contacts of the body at a place with the features near its
    /// cell.
    pub(super) fn search_features_of_cell(&mut self, place: u32) {
        let cell = self.cells.number_of(self.agendas[place as usize].cell);
        for k in 0..self.near.of(cell).len() {
            self.expect_feature(place, self.near.of(cell)[k]);
        }
    }

    fn expect_feature(&mut self, place: u32, Image { feature, image }: Image) {
        let at = place as usize;
        let flight = self.records[at].flight();
        let partner = PartnerCode::feature(feature);
        let mut center = flight.position;
        if let Some(space) = self.periodic {
            // In one step: an image has the same bits from every cell.
            let image = space.turns(self.images[image as usize]);
            let turns = self.cells.turns(self.agendas[at].cell);
            center -= space.shift(turns + image);
        }
        let feature = &self.features[feature as usize];
        // In a periodic box it has left one image only.
        // A flight that starts with the period may as well end there: one that
        // closes does not come from the contact, it comes back to it.
        let is_leaving = self.marks[at].last == partner
            && (self.periodic.is_none() || self.has_just_left(feature, center, flight.radius))
            && (flight.since > T::ZERO || !is_closing(feature, &flight, center));
        let acceleration = self.plan.has_field.then_some(self.gravity);
        let wait =
            feature.contact_time(center, flight.velocity, acceleration, flight.radius, is_leaving);
        if let Some(wait) = wait {
            self.keep(place, Expected { time: flight.since + wait, partner, changes: 0 });
        }
    }

    /// Whether a sphere that comes from a contact with some image of a feature
    /// comes from this one: whether it is there, but for the rounding of places.
    fn has_just_left(&self, feature: &Feature<T>, center: Vec3<T>, radius: T) -> bool {
        let rounding = T::whole(64) * T::EPSILON * greatest_component(center);
        let near = (self.spacing * T::ratio(1, 1024)).greater(rounding);
        feature.clearance(center, radius).gap.abs() < near
    }
}

/// Whether a sphere approaches a feature.
fn is_closing<T: Real>(feature: &Feature<T>, flight: &Flight<T>, center: Vec3<T>) -> bool {
    feature.clearance(center, flight.radius).arm.dot(flight.velocity) < T::ZERO
}
