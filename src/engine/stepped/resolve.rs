//! Resolve: the contacts at the end of a step take effect, round by round.

use super::apply::apply;
use super::clock::Clock;
use super::contacts::Contact;
use super::impact::{Impacts, Outcome};
use super::lanes::in_lanes;
use super::record::Record;
use super::region::Region;
use super::setting::Setting;
use super::state::State;
use crate::contact::{Laws, with_law};
use crate::engine::account::Account;
use crate::lane::Lane;
use crate::real::Real;

/// Contacts worked out as one piece of work.
const IMPACTS: usize = 256;

/// Rounds in a step; contacts beyond wait for the next step.
const MOST_ROUNDS: usize = 10_000;

/// Lets the contacts at the end of a step take effect, round by round: those that stand
/// ready, then the waiting ones.
pub(super) fn resolve<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &Clock,
    account: &mut Account,
    mut record: Option<&mut Record<T>>,
) {
    for _ in 0..MOST_ROUNDS {
        let (state, pending) = (&mut region.state, &mut region.pending);
        if pending.now.is_empty() {
            break;
        }
        // Pairs first, then the surroundings, feature by feature: packs of
        // one kind. Contacts of a round share no body, so none waits.
        pending.at_parts.clear();
        let at_parts = pending.now.extract_if(.., |contact| !contact.rank.is_pair());
        pending.at_parts.extend(at_parts);
        pending.at_parts.sort_unstable_by_key(|contact| contact.b);
        pending.now.append(&mut pending.at_parts);
        pending.outcomes.resize(pending.now.len(), Outcome::NONE);
        impulses(setting, state, &pending.now, &mut pending.outcomes);
        for collision in pending.now.iter().zip(&pending.outcomes) {
            if collision.1.collided {
                apply(setting, state, clock, account, collision, record.as_deref_mut());
            }
        }
        pending.rounds.take(&mut pending.waiting, &mut pending.now);
    }
}

/// Works out the impulses of contacts that share no body.
fn impulses<T: Real>(
    setting: &Setting<T>,
    state: &State<T>,
    now: &[Contact<T>],
    outcomes: &mut [Outcome<T>],
) {
    let mut chunks: Vec<_> = now.chunks(IMPACTS).zip(outcomes.chunks_mut(IMPACTS)).collect();
    setting.workers.each(&mut chunks, |(contacts, outcomes)| {
        let kinds = contacts.chunk_by(|one, other| {
            one.rank.is_pair() == other.rank.is_pair() && (one.rank.is_pair() || one.b == other.b)
        });
        let mut done = 0;
        for contacts in kinds {
            let outcomes = &mut outcomes[done..done + contacts.len()];
            done += contacts.len();
            let lanes = setting.plan.gather_lanes;
            in_lanes!(gather lanes, impulses_of_kind::<T>(setting, state, contacts, outcomes));
        }
    });
}

/// Works out the impulses of contacts of one kind that share no body.
pub(super) fn impulses_of_kind<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    state: &State<T>,
    contacts: &[Contact<T>],
    outcomes: &mut [Outcome<T>],
) {
    with_law!(setting.plan.surface, law => {
        impulses_by::<L, T, _>(setting, state, law, contacts, outcomes);
    });
}

fn impulses_by<L: Lane<Scalar = T>, T: Real, W: Laws<T>>(
    setting: &Setting<T>,
    state: &State<T>,
    laws: W,
    contacts: &[Contact<T>],
    outcomes: &mut [Outcome<T>],
) {
    let (periodic, within_step) = (setting.periodic, setting.is_within_step());
    let impacts = Impacts { periodic, laws, within_step };
    let Some(first) = contacts.first() else { return };
    if first.rank.is_pair() {
        impacts.pairs::<L>(state, contacts, outcomes);
    } else {
        let feature = setting.features.at(first.b);
        impacts.surroundings::<L>(state, &setting.path, &feature, contacts, outcomes);
    }
}
