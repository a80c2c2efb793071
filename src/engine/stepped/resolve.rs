//! Resolve: the contacts of a step are found and take effect.

use super::contacts::Contact;
use super::impact::{Impacts, Outcome};
use super::narrow::{AtEnd, Detection, WithinStep, touching_pairs, touching_surroundings};
use super::record::Record;
use super::state::put;
use super::{Stepped, in_lanes};
use crate::bodies::{Figure, PerBody, Same, at};
use crate::engine::{Event, Partner};
use crate::lane::Lane;
use crate::motion::flight::Wrap;
use crate::real::Real;
use crate::scene::Impact;
use crate::space::broadphase::{Candidates, Chunk};
use crate::space::{OpenSpace, Space};
use crate::vec3::Vec3;
use crate::workers::Workers;

/// Contacts worked out as one piece of work.
const IMPACTS: usize = 1024;

/// Rounds in a step; contacts beyond wait for the next step.
const MOST_ROUNDS: usize = 10_000;

impl<T: Real> Stepped<T> {
    /// Finds all contacts of the step, in their order.
    pub(super) fn find_contacts(&mut self, workers: &Workers, travel: T) {
        let mut found = core::mem::take(&mut self.found);
        found.resize_with(self.candidates.chunks.len(), Vec::new);
        let mut chunks: Vec<_> = self.candidates.chunks.iter().zip(&mut found).collect();
        let path = self.path;
        match self.plan.impact {
            Impact::EndOfStep => workers.each(&mut chunks, |(chunk, found)| {
                found.clear();
                in_lanes!(plan.gather_lanes, self.search_chunk::<T>(AtEnd, chunk, found));
            }),
            Impact::SubStep => {
                let within = WithinStep { path, sweep: travel + travel };
                workers.each(&mut chunks, |(chunk, found)| {
                    found.clear();
                    in_lanes!(plan.gather_lanes, self.search_chunk::<T>(within, chunk, found));
                });
            }
        }
        self.waiting.clear();
        for found in &found {
            self.waiting.extend_from_slice(found);
        }
        self.found = found;
        self.waiting.sort_unstable_by(Contact::order);
    }

    fn search_chunk<L: Lane<Scalar = T>>(
        &self,
        detection: impl Detection<T>,
        chunk: &Chunk,
        found: &mut Vec<Contact<T>>,
    ) {
        match &self.state.radius {
            PerBody::Same(r) => self.search_with::<L, _>(detection, Same(*r), chunk, found),
            PerBody::Each(r) => self.search_with::<L, _>(detection, r.padded(), chunk, found),
        }
    }

    fn search_with<L: Lane<Scalar = T>, R: Figure<T>>(
        &self,
        detection: impl Detection<T>,
        radius: R,
        chunk: &Chunk,
        found: &mut Vec<Contact<T>>,
    ) {
        let state = &self.state;
        let shells = Candidates::shells_within(self.travelled + self.travelled, self.skin);
        for pairs in &chunk.pairs[..shells] {
            match self.periodic {
                None => {
                    touching_pairs::<L, _, _, _, _>(
                        state, detection, radius, OpenSpace, pairs, found,
                    );
                }
                Some(space) => {
                    touching_pairs::<L, _, _, _, _>(state, detection, radius, space, pairs, found);
                }
            }
        }
        for (number, near) in chunk.at_parts() {
            let feature = (number, &self.features[number as usize]);
            touching_surroundings::<L, _, _, _>(state, detection, radius, feature, near, found);
        }
    }

    /// Lets the waiting contacts take effect, round by round.
    pub(super) fn resolve(&mut self, workers: &Workers, mut record: Option<&mut Record<T>>) {
        let is_within = self.plan.impact == Impact::SubStep;
        let mut waiting = core::mem::take(&mut self.waiting);
        let mut now = core::mem::take(&mut self.now);
        let mut outcomes = core::mem::take(&mut self.outcomes);
        for _ in 0..MOST_ROUNDS {
            if waiting.is_empty() {
                break;
            }
            self.rounds.take(&mut waiting, &mut now);
            // Pairs first, then the surroundings, feature by feature: packs of
            // one kind. Contacts of a round share no body, so none waits.
            now.sort_by_key(|contact| {
                (!contact.rank.is_pair(), if contact.rank.is_pair() { 0 } else { contact.b })
            });
            outcomes.clear();
            outcomes.resize(now.len(), Outcome::NONE);
            self.impulses(workers, &now, &mut outcomes);
            let mut jump = T::ZERO;
            for (contact, outcome) in now.iter().zip(&outcomes) {
                if outcome.collided {
                    jump = self.apply(contact, outcome, record.as_deref_mut()).greater(jump);
                } else if is_within {
                    // A graze that rounding turned away must not be found again.
                    self.strike(contact);
                }
            }
            self.travelled = self.travelled + jump;
            if is_within {
                self.find_again(&mut waiting, &now);
            }
        }
        self.struck.clear();
        (self.waiting, self.now, self.outcomes) = (waiting, now, outcomes);
    }

    /// Works out the impulses of contacts that share no body.
    fn impulses(&self, workers: &Workers, now: &[Contact<T>], outcomes: &mut [Outcome<T>]) {
        let mut chunks: Vec<_> = now.chunks(IMPACTS).zip(outcomes.chunks_mut(IMPACTS)).collect();
        workers.each(&mut chunks, |(contacts, outcomes)| {
            let kinds = contacts.chunk_by(|one, other| {
                one.rank.is_pair() == other.rank.is_pair()
                    && (one.rank.is_pair() || one.b == other.b)
            });
            let mut rest = &mut **outcomes;
            for contacts in kinds {
                let (outcomes, others) = core::mem::take(&mut rest).split_at_mut(contacts.len());
                rest = others;
                in_lanes!(plan.gather_lanes, self.impulses_of_kind::<T>(contacts, outcomes));
            }
        });
    }

    fn impulses_of_kind<L: Lane<Scalar = T>>(
        &self,
        contacts: &[Contact<T>],
        outcomes: &mut [Outcome<T>],
    ) {
        match (self.periodic, self.plan.is_rough) {
            (None, false) => self.impulses_in::<L, _, false>(OpenSpace, contacts, outcomes),
            (None, true) => self.impulses_in::<L, _, true>(OpenSpace, contacts, outcomes),
            (Some(space), false) => self.impulses_in::<L, _, false>(space, contacts, outcomes),
            (Some(space), true) => self.impulses_in::<L, _, true>(space, contacts, outcomes),
        }
    }

    fn impulses_in<L: Lane<Scalar = T>, S: Space<T>, const ROUGH: bool>(
        &self,
        space: S,
        contacts: &[Contact<T>],
        outcomes: &mut [Outcome<T>],
    ) {
        let within_step = self.plan.impact == Impact::SubStep;
        let impacts = Impacts { space, within_step };
        let Some(first) = contacts.first() else { return };
        if first.rank.is_pair() {
            impacts.pairs::<L, T, ROUGH>(&self.state, contacts, outcomes);
        } else {
            let feature = &self.features[first.b as usize];
            impacts.surroundings::<L, T, ROUGH>(
                &self.state,
                &self.path,
                feature,
                contacts,
                outcomes,
            );
        }
    }

    /// Gives the bodies of a contact their new motion; returns by how much a
    /// body was moved within the step.
    fn apply(
        &mut self,
        contact: &Contact<T>,
        outcome: &Outcome<T>,
        record: Option<&mut Record<T>>,
    ) -> T {
        let is_pair = contact.rank.is_pair();
        if is_pair {
            self.collisions.pairs += 1;
            self.tallies.pair(outcome.normal, outcome.offset);
        } else {
            self.collisions.surroundings += 1;
            self.tallies.surroundings(outcome.normal + outcome.tangential);
        }
        if let Some(record) = record {
            record.push(*contact, self.event(contact, outcome));
        }
        if self.plan.impact == Impact::SubStep {
            self.strike(contact);
        }
        let mut jump = self.give(contact, contact.a, outcome.a.velocity, outcome.a.spin);
        if is_pair {
            let moved = self.give(contact, contact.b, outcome.b.velocity, outcome.b.spin);
            jump = moved.greater(jump);
        }
        jump
    }

    /// Notes for the rest of the step that the bodies of a contact had it.
    fn strike(&mut self, contact: &Contact<T>) {
        self.struck.strike(contact.a, contact);
        if contact.rank.is_pair() {
            self.struck.strike(contact.b, contact);
        }
    }

    fn give(&mut self, contact: &Contact<T>, place: u32, velocity: Vec3<T>, spin: Vec3<T>) -> T {
        let at_place = place as usize;
        if self.plan.is_rough {
            let index = self.state.index[at_place] as usize;
            let (steps, dt) = (self.steps, self.dt);
            self.orientations.catch_up(&mut self.state, index, steps, dt, contact.ago);
            put(&mut self.state.spin, index, spin);
        }
        let mut jump = T::ZERO;
        if self.plan.impact == Impact::SubStep {
            // Forward again from the contact with the new velocity.
            let change = (velocity - at(&self.state.velocity, at_place)) * contact.ago;
            let position = at(&self.state.position, at_place) + change;
            let position = match self.periodic {
                None => position,
                Some(space) => space.wrap(position),
            };
            put(&mut self.state.position, at_place, position);
            jump = change.length() * T::ratio(65, 64);
        }
        put(&mut self.state.velocity, at_place, velocity);
        jump
    }

    /// The event of a contact, before the bodies receive their new motion.
    fn event(&self, contact: &Contact<T>, outcome: &Outcome<T>) -> Event<T> {
        let place = contact.a as usize;
        let path = &self.path;
        let before = path.end_velocity(at(&self.state.velocity, place));
        let center = path.center(at(&self.state.position, place), before, contact.ago);
        let length = outcome.offset.length();
        let normal = outcome.offset * (T::ONE / length);
        let at_contact =
            |velocity: Vec3<T>| path.velocity(path.end_velocity(velocity), contact.ago);
        let (partner, arm) = if contact.rank.is_pair() {
            let radius = |place: u32| self.state.radius.of(place as usize);
            let share = radius(contact.a) / (radius(contact.a) + radius(contact.b));
            let partner = Partner::Body {
                index: self.state.index[contact.b as usize],
                velocity: at_contact(outcome.b.velocity),
                spin: self.spin_after(contact.b, outcome.b.spin),
            };
            (partner, outcome.offset * share)
        } else {
            (Partner::Surroundings(self.parts[contact.b as usize]), outcome.offset)
        };
        Event {
            time: self.time() - contact.ago.to_f64(),
            a: self.state.index[place],
            partner,
            point: center - arm,
            normal,
            normal_impulse: outcome.normal.length(),
            tangential_impulse: outcome.tangential,
            velocity: at_contact(outcome.a.velocity),
            spin: self.spin_after(contact.a, outcome.a.spin),
        }
    }

    /// The spin of the body at a place after a contact that may not have read it.
    fn spin_after(&self, place: u32, spin: Vec3<T>) -> Vec3<T> {
        if self.plan.is_rough {
            spin
        } else {
            at(&self.state.spin, self.state.index[place as usize] as usize)
        }
    }

    /// After a round within a step: the contacts of the bodies that took part
    /// are found anew, on their new paths.
    fn find_again(&mut self, waiting: &mut Vec<Contact<T>>, now: &[Contact<T>]) {
        let rounds = &self.rounds;
        let is_struck = |contact: &Contact<T>| {
            rounds.is_struck(contact.a) || (contact.rank.is_pair() && rounds.is_struck(contact.b))
        };
        waiting.retain(|contact| !is_struck(contact));
        if now.is_empty() {
            return;
        }
        let within = WithinStep { path: self.path, sweep: self.travelled + self.travelled };
        let mut found = Vec::new();
        for chunk in &self.candidates.chunks {
            let near = chunk.of(|body| rounds.is_struck(body));
            self.search_chunk::<T>(within, &near, &mut found);
        }
        waiting.extend(found.into_iter().filter_map(|contact| self.on_new_path(contact)));
        waiting.sort_unstable_by(Contact::order);
    }

    /// A contact at the time when it takes effect on the new paths of its bodies:
    /// where it seems to have come before they took them, at their beginning, if
    /// the surfaces touch and approach there, as those of balls in a row do.
    fn on_new_path(&self, contact: Contact<T>) -> Option<Contact<T>> {
        match self.struck.last_before(&contact).ok()? {
            Some(last) if contact.ago > last => {
                self.is_touching(&contact, last).then_some(Contact { ago: last, ..contact })
            }
            _ => Some(contact),
        }
    }

    /// Whether the surfaces of a contact touch, to rounding, and approach a time
    /// before the end of the step.
    fn is_touching(&self, contact: &Contact<T>, ago: T) -> bool {
        let rounding = self.broadphase.rounding() * T::whole(8);
        let (state, path) = (&self.state, &self.path);
        let a = contact.a as usize;
        let (position, velocity) = (at(&state.position, a), at(&state.velocity, a));
        let radius = state.radius.of(a);
        if contact.rank.is_pair() {
            let b = contact.b as usize;
            let relative = velocity - at(&state.velocity, b);
            let offset = position - at(&state.position, b);
            let offset = self.periodic.map_or(offset, |space| space.nearest(offset));
            let offset = offset - relative * ago;
            let reach = radius + state.radius.of(b) + rounding;
            offset.length_squared() <= reach * reach && relative.dot(offset) < T::ZERO
        } else {
            let end_velocity = path.end_velocity(velocity);
            let center = path.center(position, end_velocity, ago);
            let clearance = self.features[contact.b as usize].clearance::<T>(center, radius);
            let approach = path.velocity(end_velocity, ago).dot(clearance.arm);
            clearance.gap <= rounding && approach < T::ZERO
        }
    }
}
