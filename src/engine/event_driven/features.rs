//! Features: when a body meets what is fixed.

use super::agenda::{Expected, PartnerCode};
use super::flight::Flight;
use super::near::Image;
use super::region::Region;
use super::search::keep;
use super::setting::Setting;
use crate::contact::{FreeFlight, greatest_component};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::{Bounds, Space};
use crate::surroundings::FeatureRef;
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
    now: T,
) {
    expect(setting, region, slot, setting.near.everywhere());
    search_features_of_cell(setting, region, slot, now);
}

/// Looks for contacts of the body in a slot with the features near its cell, and near its
/// way through it.
pub(super) fn search_features_of_cell<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    now: T,
) {
    let cell = region.cells.finest.grid.number_of(region.agendas[slot as usize].cell);
    expect(setting, region, slot, setting.near.of(cell));
    if setting.features.has_meshes() || setting.near.has_tree() {
        search_on_way(setting, region, slot, now);
    }
}

/// Looks for contacts of the body in a slot with features that are found by their boxes,
/// before it leaves its cell.
fn search_on_way<T: Real>(setting: &Setting<T>, region: &mut Region<'_, T>, slot: u32, now: T) {
    let met = Met::of(setting, region, slot);
    let agenda = &region.agendas[slot as usize];
    let until = agenda.leaves_cell.lesser(agenda.complete_until());
    let swept = swept(setting, &met.flight, [now, until]);
    for image in 0..setting.images.len() as u32 {
        let shift = shift(setting, &met, image);
        let near = swept.each(|corner| corner - shift);
        let mut visit = |feature| expect_one(setting, region, slot, &met, Image { feature, image });
        setting.near.for_each_in(near, &mut visit);
        setting.features.for_each_tile(near, |_, feature| visit(feature));
    }
}

/// The box that a body fills on its flight between two times, with the room that rounding
/// takes.
fn swept<T: Real>(setting: &Setting<T>, flight: &Flight<T>, [from, until]: [T; 2]) -> Bounds<T> {
    let (start, velocity) = setting.state_of(flight, from);
    let (end, _) = setting.state_of(flight, until);
    let (mut lower, mut upper) = (start.lesser(end), start.greater(end));
    if setting.plan.has_field {
        // Where it turns along an axis.
        let turn = |velocity: T, pull: T| {
            let time = -(velocity / pull);
            if T::ZERO < time && time < until - from {
                T::ratio(1, 2) * velocity * time
            } else {
                T::ZERO
            }
        };
        let turns = Vec3::new(
            turn(velocity.x, setting.gravity.x),
            turn(velocity.y, setting.gravity.y),
            turn(velocity.z, setting.gravity.z),
        );
        (lower, upper) = (lower.lesser(start + turns), upper.greater(start + turns));
    }
    let farthest = greatest_component(lower).greater(greatest_component(upper));
    let margin = flight.radius + T::whole(64) * T::EPSILON * (farthest + flight.radius);
    let margin = Vec3::new(margin, margin, margin);
    [lower - margin, upper + margin]
}

/// By how much a body is off where an image of what is fixed sees it.
fn shift<T: Real>(setting: &Setting<T>, met: &Met<T>, image: u32) -> Vec3<T> {
    // In one step: an image has the same bits from every cell.
    setting.periodic.map_or(Vec3::ZERO, |space| {
        space.shift(met.turns + space.turns(setting.images[image as usize]))
    })
}

fn expect<T: Real>(setting: &Setting<T>, region: &mut Region<'_, T>, slot: u32, images: &[Image]) {
    if images.is_empty() {
        return;
    }
    let met = Met::of(setting, region, slot);
    for &image in images {
        expect_one(setting, region, slot, &met, image);
    }
}

fn expect_one<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    met: &Met<T>,
    image: Image,
) {
    if let Some(wait) = time_to_feature(setting, met, image) {
        let time = met.flight.since + wait;
        let partner = PartnerCode::feature(image.feature);
        keep(region, slot, Expected { time, partner, stamp: 0 });
    }
}

/// From the start of a flight to the body's contact with an image of a feature, time.
pub(super) fn time_to_feature<T: Real>(
    setting: &Setting<T>,
    met: &Met<T>,
    Image { feature, image }: Image,
) -> Option<T> {
    let Met { flight, last, .. } = *met;
    let center = flight.position - shift(setting, met, image);
    let features = &setting.features;
    let has_left = last.decoded().is_err_and(|last| {
        // No partner yet has no number of a feature.
        last == feature
            || (last as usize) < features.len()
                && features.surface_of(last) == features.surface_of(feature)
    });
    let feature = features.at(feature);
    // In a periodic box it has left one image only.
    // A flight that starts with the period may as well end there: one that
    // closes does not come from the contact, it comes back to it.
    let is_leaving = has_left
        && (setting.periodic.is_none() || has_just_left(setting, &feature, center, flight.radius))
        && (flight.since > T::ZERO || !is_closing(&feature, &flight, center));
    let acceleration = setting.plan.has_field.then_some(setting.gravity);
    let Flight { velocity, radius, .. } = flight;
    let flight = FreeFlight { center, velocity, acceleration, radius, is_leaving };
    if is_leaving { feature.hop_time(&flight) } else { feature.contact_time(&flight) }
}

/// Whether a sphere that comes from a contact with some image of a feature
/// comes from this one: whether it is there, but for the rounding of positions.
fn has_just_left<T: Real>(
    setting: &Setting<T>,
    feature: &FeatureRef<'_, T>,
    center: Vec3<T>,
    radius: T,
) -> bool {
    let rounding = T::whole(64) * T::EPSILON * greatest_component(center);
    let near = (setting.spacing * T::ratio(1, 1024)).greater(rounding);
    feature.clearance_of_surface(center, radius).gap.abs() < near
}

/// Whether a sphere approaches a feature.
fn is_closing<T: Real>(feature: &FeatureRef<'_, T>, flight: &Flight<T>, center: Vec3<T>) -> bool {
    feature.clearance_of_surface(center, flight.radius).arm.dot(flight.velocity) < T::ZERO
}
