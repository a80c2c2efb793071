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

/// A body's flight, and what it comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met<T> {
    pub flight: Flight<T>,
    /// What it met last.
    pub last: PartnerCode,
    /// How many whole periodic boxes it is away from the first one.
    pub turns: Vec3<T>,
}

impl<T: Real> Met<T> {
    /// Of the body in a slot.
    pub fn of(setting: &Setting<T>, region: &Region<'_, T>, slot: u32) -> Self {
        let at = slot as usize;
        let (flight, last) = (region.records[at].flight(), region.marks[at].last);
        let is_periodic = setting.periodic.is_some();
        let turns = || region.cells.finest.grid.turns(region.agendas[at].cell);
        Self { flight, last, turns: if is_periodic { turns() } else { Vec3::ZERO } }
    }
}

/// Looks for contacts of the body in a slot with all features near it.
pub(super) fn search_features<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
) {
    expect(setting, region, slot, setting.near.everywhere());
    search_features_of_cell(setting, region, slot);
}

/// Looks for contacts of the body in a slot with the features near its cell.
pub(super) fn search_features_of_cell<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
) {
    let cell = region.cells.finest.grid.number_of(region.agendas[slot as usize].cell);
    expect(setting, region, slot, setting.near.of(cell));
}

fn expect<T: Real>(setting: &Setting<T>, region: &mut Region<'_, T>, slot: u32, images: &[Image]) {
    if images.is_empty() {
        return;
    }
    let met = Met::of(setting, region, slot);
    for &image in images {
        if let Some(wait) = time_to_feature(setting, &met, image) {
            let time = met.flight.since + wait;
            let partner = PartnerCode::feature(image.feature);
            keep(region, slot, Expected { time, partner, stamp: 0 });
        }
    }
}

/// From the start of a flight to the body's contact with an image of a feature, time.
pub(super) fn time_to_feature<T: Real>(
    setting: &Setting<T>,
    &Met { flight, last, turns }: &Met<T>,
    Image { feature, image }: Image,
) -> Option<T> {
    let partner = PartnerCode::feature(feature);
    let mut center = flight.position;
    if let Some(space) = setting.periodic {
        // In one step: an image has the same bits from every cell.
        let image = space.turns(setting.images[image as usize]);
        center -= space.shift(turns + image);
    }
    let feature = &setting.features[feature as usize];
    // In a periodic box it has left one image only.
    // A flight that starts with the period may as well end there: one that
    // closes does not come from the contact, it comes back to it.
    let is_leaving = last == partner
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
