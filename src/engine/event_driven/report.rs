//! Report: collisions as the listener receives them.

use super::clock::Clock;
use super::outcome::{FeatureOutcome, PairOutcome};
use super::setting::Setting;
use crate::engine::{Event, Partner};
use crate::real::Real;
use crate::vec3::Vec3;

/// The collision of two bodies of the scene at a time.
pub(super) fn pair_event<T: Real>(
    setting: &Setting<T>,
    clock: &Clock<T>,
    [a, b]: [u32; 2],
    made: &PairOutcome<T>,
    time: T,
) -> Event<T> {
    let [own, other] = &made.departures;
    let spin = setting.spin_of(b, other.spin);
    let partner = Partner::Body { index: b, velocity: other.flight.velocity, spin };
    Event {
        time: clock.not_before(time),
        a,
        partner,
        point: own.flight.position - made.arm,
        normal: unit(made.offset),
        normal_impulse: made.impulse.normal.length(),
        tangential_impulse: made.impulse.tangential,
        velocity: own.flight.velocity,
        spin: setting.spin_of(a, own.spin),
    }
}

/// The collision of a body of the scene with a part of the surroundings at a time.
pub(super) fn feature_event<T: Real>(
    setting: &Setting<T>,
    clock: &Clock<T>,
    (a, part): (u32, u32),
    made: &FeatureOutcome<T>,
    time: T,
) -> Event<T> {
    let own = &made.departure;
    Event {
        time: clock.not_before(time),
        a,
        partner: Partner::Surroundings(part),
        point: own.flight.position - made.arm,
        normal: unit(made.arm),
        normal_impulse: made.impulse.normal.length(),
        tangential_impulse: made.impulse.tangential,
        velocity: own.flight.velocity,
        spin: setting.spin_of(a, own.spin),
    }
}

fn unit<T: Real>(offset: Vec3<T>) -> Vec3<T> {
    offset * (T::ONE / offset.length())
}
