//! Region: what one worker writes.

use super::contacts::{Contact, Rounds};
use super::impact::Outcome;
use super::neighbourhoods::Neighbourhoods;
use super::queue::Queue;
use super::setting::Setting;
use super::state::State;
use super::struck::Struck;
use crate::bodies::Bodies;
use crate::real::Real;
use crate::space::broadphase::{BroadPhase, Candidates, Chunk};

/// The bodies, what is near what, and the contacts of the present step.
///
/// A restart file keeps the state; all else is found again.
#[derive(Debug)]
pub(super) struct Region<T: Real> {
    pub state: State<T>,
    pub nearby: Nearby<T>,
    pub pending: Pending<T>,
}

/// The pairs and features that can come into contact before the next search.
#[derive(Debug)]
pub(super) struct Nearby<T: Real> {
    pub broadphase: BroadPhase<T>,
    pub candidates: Candidates,
    /// The candidates of each body, where contacts have times.
    pub neighbourhoods: Neighbourhoods,
    /// Whether all bodies and features are candidates of each other, and in no list.
    pub are_all: bool,
    /// The gap up to which the candidates are complete, length.
    pub skin: T,
    /// How far any body can have moved since the last search, length.
    pub travelled: T,
}

/// The contacts of the present step.
#[derive(Debug)]
pub(super) struct Pending<T: Real> {
    /// As they are found, by chunk of candidates.
    pub found: Vec<Vec<Contact<T>>>,
    /// At the end of the step: those that have not taken effect, in order.
    pub waiting: Vec<Contact<T>>,
    /// Those that take effect now, and what they do.
    pub now: Vec<Contact<T>>,
    /// Those of them with something fixed.
    pub at_parts: Vec<Contact<T>>,
    pub outcomes: Vec<Outcome<T>>,
    pub rounds: Rounds,
    /// Within the step: those that have not taken effect.
    pub queue: Queue<T>,
    pub struck: Struck<T>,
    /// The candidates of the bodies that a contact has sent on new paths, and
    /// what these lead to.
    pub near: Chunk,
    pub ahead: Vec<Contact<T>>,
}

impl<T: Real> Nearby<T> {
    /// Whether the candidates are still all that can touch.
    pub fn is_complete(&self) -> bool {
        (self.travelled + self.travelled).lt(self.skin)
    }
}

impl<T: Real> Region<T> {
    /// The bodies of a scene at its start.
    pub fn new(setting: &Setting<T>, bodies: Bodies<T>) -> Self {
        let len = bodies.len();
        let state = State::new(bodies, &setting.plan);
        let slots = if setting.has_contacts() { len } else { 0 };
        let (at_end, within) = if setting.is_within_step() { (0, slots) } else { (slots, 0) };
        Self {
            nearby: Nearby {
                broadphase: BroadPhase::new(&state.radius, len, &setting.features),
                candidates: Candidates::default(),
                neighbourhoods: Neighbourhoods::default(),
                are_all: false,
                skin: T::ZERO,
                travelled: T::ZERO,
            },
            pending: Pending {
                found: Vec::new(),
                waiting: Vec::new(),
                now: Vec::new(),
                at_parts: Vec::new(),
                outcomes: Vec::new(),
                rounds: Rounds::new(at_end),
                queue: Queue::new(),
                struck: Struck::new(within, setting.dt),
                near: Chunk::default(),
                ahead: Vec::new(),
            },
            state,
        }
    }

    /// The bytes of memory that it holds.
    pub fn bytes(&self) -> usize {
        let Nearby { broadphase, candidates, neighbourhoods, .. } = &self.nearby;
        let Pending { found, waiting, now, outcomes, rounds, queue, struck, .. } = &self.pending;
        let found: usize = found.iter().map(Vec::capacity).sum();
        self.state.bytes()
            + broadphase.bytes()
            + candidates.bytes()
            + neighbourhoods.bytes()
            + rounds.bytes()
            + queue.bytes()
            + struck.bytes()
            + size_of::<Contact<T>>() * (found + waiting.capacity() + now.capacity())
            + size_of::<Outcome<T>>() * outcomes.capacity()
    }
}
