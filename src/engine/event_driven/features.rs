//! Features: when a body meets what is fixed.

use super::agenda::{Expected, PartnerCode};
use super::flight::Flight;
use super::near::Image;
use super::region::Region;
use super::search::keep;
use super::setting::Setting;
use crate::contact::greatest_component;
use crate::real::Real;
use crate::space::Space;
use crate::surroundings::Feature;
use crate::vec3::Vec3;

/// Looks for contacts of the body in a slot with all features near it.
pub(super) fn search_features<T: Real>(setting: &Setting<T>, region: &mut Region<T>, slot: u32) {
    for &image in setting.near.everywhere() {
        expect_feature(setting, region, slot, image);
    }
    search_features_of_cell(setting, region, slot);
}

/// Looks for contacts of the body in a slot with the features near its cell.
pub(super) fn search_features_of_cell<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    slot: u32,
) {
    let cell = region.cells.finest().number_of(region.agendas[slot as usize].cell);
    for &image in setting.near.of(cell) {
        expect_feature(setting, region, slot, image);
    }
}

fn expect_feature<T: Real>(setting: &Setting<T>, region: &mut Region<T>, slot: u32, image: Image) {
    if let Some(wait) = time_to_feature(setting, region, slot, image) {
        let time = region.records[slot as usize].flight().since + wait;
        let partner = PartnerCode::feature(image.feature);
        keep(region, slot, Expected { time, partner, changes: 0 });
    }
}

/// From the start of the flight of the body in a slot to its contact with an image of a
/// feature, time.
pub(super) fn time_to_feature<T: Real>(
    setting: &Setting<T>,
    region: &Region<T>,
    slot: u32,
    Image { feature, image }: Image,
) -> Option<T> {
    let at = slot as usize;
    let flight = region.records[at].flight();
    let partner = PartnerCode::feature(feature);
    let mut center = flight.position;
    if let Some(space) = setting.periodic {
        // In one step: an image has the same bits from every cell.
        let image = space.turns(setting.images[image as usize]);
        let turns = region.cells.finest().turns(region.agendas[at].cell);
        center -= space.shift(turns + image);
    }
    let feature = &setting.features[feature as usize];
    // In a periodic box it has left one image only.
    // A flight that starts with the period may as well end there: one that
    // closes does not come from the contact, it comes back to it.
    let is_leaving = region.marks[at].last == partner
        && (setting.periodic.is_none() || has_just_left(setting, feature, center, flight.radius))
        && (flight.since > T::ZERO || !is_closing(feature, &flight, center));
    let acceleration = setting.plan.has_field.then_some(setting.gravity);
    let (velocity, radius) = (flight.velocity, flight.radius);
    if is_leaving {
        feature.hop_time(center, velocity, acceleration, radius)
    } else {
        feature.contact_time(center, velocity, acceleration, radius, false)
    }
}

/// Whether a sphere that comes from a contact with some image of a feature
/// comes from this one: whether it is there, but for the rounding of positions.
fn has_just_left<T: Real>(
    setting: &Setting<T>,
    feature: &Feature<T>,
    center: Vec3<T>,
    radius: T,
) -> bool {
    let rounding = T::whole(64) * T::EPSILON * greatest_component(center);
    let near = (setting.spacing * T::ratio(1, 1024)).greater(rounding);
    feature.clearance(center, radius).gap.abs() < near
}

/// Whether a sphere approaches a feature.
fn is_closing<T: Real>(feature: &Feature<T>, flight: &Flight<T>, center: Vec3<T>) -> bool {
    feature.clearance(center, flight.radius).arm.dot(flight.velocity) < T::ZERO
}
