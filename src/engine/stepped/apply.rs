//! Apply: the bodies of a collision receive their new motion.

use super::clock::Clock;
use super::contacts::Contact;
use super::impact::Outcome;
use super::record::Record;
use super::setting::Setting;
use super::state::{State, put};
use crate::bodies::at;
use crate::engine::account::Account;
use crate::engine::event::Struck;
use crate::engine::{Event, Partner};
use crate::motion::flight::Wrap;
use crate::real::Real;
use crate::vec3::Vec3;

/// Gives the bodies of a contact their new motion.
pub(super) fn apply<T: Real>(
    setting: &Setting<T>,
    state: &mut State<T>,
    clock: &Clock,
    account: &mut Account,
    (contact, outcome): (&Contact<T>, &Outcome<T>),
    record: Option<&mut Record<T>>,
) {
    let is_pair = contact.rank.is_pair();
    if is_pair {
        account.pair(outcome.normal, outcome.offset);
    } else {
        let impulses = [outcome.normal, outcome.tangential];
        account.surroundings(impulses, setting.counter(contact.b));
    }
    if let Some(record) = record {
        record.push(*contact, event(setting, state, clock, contact, outcome));
    }
    let (a, b) = (outcome.a, outcome.b);
    give(setting, state, clock, contact, contact.a, a.velocity, a.spin);
    if is_pair {
        give(setting, state, clock, contact, contact.b, b.velocity, b.spin);
    }
}

fn give<T: Real>(
    setting: &Setting<T>,
    state: &mut State<T>,
    clock: &Clock,
    contact: &Contact<T>,
    slot: u32,
    velocity: Vec3<T>,
    spin: Vec3<T>,
) {
    let slot = slot as usize;
    if setting.plan.changes_spins {
        let index = state.index[slot] as usize;
        state.catch_up(index, clock.steps, setting.dt, contact.ago);
        put(&mut state.spin, index, spin);
    }
    if setting.is_within_step() {
        // Forward again from the contact with the new velocity.
        let change = (velocity - at(&state.velocity, slot)) * contact.ago;
        state.shift(slot, change, setting.periodic);
    }
    state.set_velocity(slot, velocity);
}

/// The event of a contact, before the bodies receive their new motion.
fn event<T: Real>(
    setting: &Setting<T>,
    state: &State<T>,
    clock: &Clock,
    contact: &Contact<T>,
    outcome: &Outcome<T>,
) -> Event<T> {
    let slot = contact.a as usize;
    let path = &setting.path;
    let before = path.end_velocity(at(&state.velocity, slot));
    let center = path.center(at(&state.position, slot), before, contact.ago);
    let center = setting.periodic.map_or(center, |space| space.wrap(center));
    let at_contact = |velocity: Vec3<T>| path.velocity(path.end_velocity(velocity), contact.ago);
    // Collisions of smooth bodies do not read spins.
    let spin_after = |slot: u32, spin: Vec3<T>| match setting.plan.changes_spins {
        true => spin,
        false => at(&state.spin, state.index[slot as usize] as usize),
    };
    let (partner, share) = if contact.rank.is_pair() {
        let radius = |slot: u32| state.radius.of(slot as usize);
        let partner = Partner::Body {
            index: state.index[contact.b as usize],
            velocity: at_contact(outcome.b.velocity),
            spin: spin_after(contact.b, outcome.b.spin),
        };
        (partner, Some(radius(contact.a) / (radius(contact.a) + radius(contact.b))))
    } else {
        (Partner::Surroundings(setting.features.shape_of(contact.b)), None)
    };
    let struck = Struck {
        a: state.index[slot],
        center,
        offset: outcome.offset,
        share,
        normal: outcome.normal,
        tangential: outcome.tangential,
        velocity: at_contact(outcome.a.velocity),
        spin: spin_after(contact.a, outcome.a.spin),
    };
    struck.event(clock.time_before_end(setting.exact_dt, contact.ago.to_f64()), partner)
}
