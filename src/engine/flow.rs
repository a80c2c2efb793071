//! Flow: spheres that come into a world and go out of it by its scene.
//!
//! The event-driven engine takes spheres out as it goes. Every other exchange is a change of
//! the world ([`Change`]): it goes on as a new one that is built in that state, and it costs as
//! much as to start a world, whatever is exchanged: all that go in one step go at once.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::change::{Apply, Change, ChangeError, KeptParts};
use super::handles::Handles;
use super::interface::EventEngine;
#[cfg(feature = "files")]
use super::snapshot::Misfit;
use super::{EngineError, Event, EventDriven, Listener, PartTotals, Partner, Stepped, World};
use crate::bodies::Bodies;
use crate::real::Real;
use crate::scene::{Inlet, Scene};
use crate::vec3::Vec3;

/// Spheres that came into a world, or went out of it, as they were then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Exchanged {
    /// How many.
    pub spheres: u64,
    /// Their mass together.
    pub mass: f64,
    /// Their momentum, mass × length per time.
    pub momentum: [f64; 3],
    /// Their energy of motion and in the field, mass × length² per time².
    pub energy: f64,
}

impl Exchanged {
    fn add<T: Real>(&mut self, bodies: &Bodies<T>, body: usize, gravity: Vec3<f64>) {
        self.spheres += 1;
        self.mass += bodies.mass.of(body).to_f64();
        let momentum = bodies.momentum_of(body).to_array();
        for (sum, component) in self.momentum.iter_mut().zip(momentum) {
            *sum += component;
        }
        self.energy += bodies.energy_of(body, gravity).into_iter().sum::<f64>();
    }
}

/// What came into a world and went out of it by its scene.
///
/// ```
/// use carom::engine::World;
/// use carom::{Execution, Plane, Scene, Sphere};
///
/// let ball = Sphere::new([0.0, 0.0, 2.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
/// let drain = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
/// let scene = Scene::<f64>::builder().removing_surroundings("drain", drain).sphere(ball);
/// let mut world = World::new(scene.build()?, Execution::default())?;
/// world.advance(2.0)?;
/// assert!(world.bodies().is_empty());
/// // It has bounced off before it is gone.
/// assert_eq!(world.exchange().removed.momentum, [0.0, 0.0, 1.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Exchange {
    /// What inlets brought in.
    pub came: Exchanged,
    /// How often one found no room, and had to wait.
    pub waits: u64,
    /// What parts took out.
    pub removed: Exchanged,
    /// The sum of mass × time of all spheres up to the last exchange, and when that was.
    pub mass_time: (f64, f64),
}

/// What comes and goes by a scene.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    /// Which parts take spheres out.
    removes: Vec<bool>,
    inlets: Vec<Inlet>,
    pub state: FlowState,
}

/// What has to be remembered.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub(super) struct FlowState {
    exchange: Exchange,
    /// Of each inlet.
    sources: Vec<Source>,
    /// Spheres that each part took out.
    removed_by: Vec<u64>,
    /// Bodies that are to go, by their indices in the engine, each with the part that takes it.
    gone: Vec<(u32, u32)>,
    /// The mass of all spheres, once it was summed since others came.
    mass: Option<f64>,
    /// In a snapshot, as [`Handles::out`] has it.
    #[cfg(feature = "files")]
    out: Vec<u32>,
}

impl FlowState {
    /// For a snapshot.
    #[cfg(feature = "files")]
    pub fn with_out(&self, out: &[u32]) -> Self {
        Self { out: out.to_vec(), ..self.clone() }
    }

    /// Bodies that were taken out, by their indices in the engine, in a snapshot.
    #[cfg(feature = "files")]
    pub fn out(&self) -> &[u32] {
        &self.out
    }

    /// Adds up the mass of all spheres up to a time.
    fn pass<T: Real>(&mut self, time: f64, bodies: impl FnOnce() -> Bodies<T>) {
        let sum = || {
            let bodies = bodies();
            (0..bodies.len()).map(|body| bodies.mass.of(body).to_f64()).sum()
        };
        let mass = *self.mass.get_or_insert_with(sum);
        let (sum, since) = self.exchange.mass_time;
        self.exchange.mass_time = (sum + mass * (time - since), time);
    }

    /// Notes that a part takes a sphere out, which is a body of some.
    fn note_removed<T: Real>(
        &mut self,
        (bodies, body): (&Bodies<T>, usize),
        part: u32,
        gravity: Vec3<f64>,
    ) {
        self.exchange.removed.add(bodies, body, gravity);
        self.removed_by[part as usize] += 1;
        self.mass = self.mass.map(|mass| mass - bodies.mass.of(body).to_f64());
    }
}

/// How far an inlet has come.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
struct Source {
    /// How often a sphere was due.
    due: u64,
    /// How many have come.
    came: u64,
    /// How often a place was tried.
    attempts: u64,
}

impl Flow {
    /// Of a scene where spheres come or go; otherwise `None`.
    pub fn of<T: Real>(scene: &Scene<T>) -> Option<Self> {
        if !scene.removes.contains(&true) && scene.inlets.is_empty() {
            return None;
        }
        let state = FlowState {
            removed_by: vec![0; scene.removes.len()],
            sources: vec![Source::default(); scene.inlets.len()],
            ..FlowState::default()
        };
        Some(Self { removes: scene.removes.clone(), inlets: scene.inlets.clone(), state })
    }

    /// Of a scene where nothing comes or goes any longer.
    #[cfg(feature = "files")]
    pub fn spent<T: Real>(scene: &Scene<T>) -> Self {
        let removes = scene.removes.clone();
        let state = FlowState { removed_by: vec![0; removes.len()], ..FlowState::default() };
        Self { removes, inlets: Vec::new(), state }
    }

    /// The spheres are others from now on.
    pub fn forget_mass(&mut self) {
        self.state.mass = None;
    }

    /// Goes on among other parts: which of them take spheres out.
    pub fn keep_parts(&mut self, kept: &KeptParts, removes: &[bool]) {
        removes.clone_into(&mut self.removes);
        let mut removed_by = vec![0; removes.len()];
        for (part, count) in (0..).zip(&self.state.removed_by) {
            if let Some(index) = kept.index_of(part) {
                removed_by[index as usize] = *count;
            }
        }
        self.state.removed_by = removed_by;
        let gone = core::mem::take(&mut self.state.gone).into_iter();
        let now = |(body, part)| Some((body, kept.index_of(part)?));
        self.state.gone = gone.filter_map(now).collect();
    }

    /// Goes on from what another one of the same scene remembered.
    #[cfg(feature = "files")]
    pub fn restore(&mut self, state: &FlowState) -> Result<(), Misfit> {
        let own = &self.state;
        if state.removed_by.len() != own.removed_by.len()
            || state.sources.len() != own.sources.len()
        {
            return Err(Misfit("spheres that come and go"));
        }
        self.state.clone_from(state);
        Ok(())
    }

    /// Whether any part takes spheres out.
    pub fn has_drains(&self) -> bool {
        self.removes.contains(&true)
    }

    /// Takes note of a collision, and gives it as the listener has it: bodies by the numbers of
    /// their handles.
    fn hear<T: Real>(&mut self, event: &Event<T>, handles: &Handles) -> Event<T> {
        if let Partner::Surroundings(part) = event.partner
            && self.removes.get(part as usize) == Some(&true)
            && !self.state.gone.iter().any(|(body, _)| *body == event.a)
        {
            self.state.gone.push((event.a, part));
        }
        let mut named = *event;
        named.a = handles.number_of(event.a);
        if let Partner::Body { index, .. } = &mut named.partner {
            *index = handles.number_of(*index);
        }
        named
    }

    /// What an engine tells of collisions, for it and for a listener.
    pub fn listener<'a, T: Real>(
        &'a mut self,
        handles: &'a Handles,
        on_event: &'a mut Listener<'_, T>,
    ) -> impl FnMut(&Event<T>) {
        move |event| {
            let event = self.hear(event, handles);
            if let Some(on_event) = on_event {
                on_event(&event);
            }
        }
    }

    /// Whether something is to be exchanged at a time.
    pub fn is_due(&self, time: f64) -> bool {
        !self.state.gone.is_empty() || self.next() <= time
    }

    /// When something comes next.
    pub fn next(&self) -> f64 {
        let sources = self.inlets.iter().zip(&self.state.sources);
        let ahead = sources.filter(|(inlet, source)| source.came < inlet.most());
        ahead.map(|(inlet, source)| inlet.time(source.due)).fold(f64::INFINITY, f64::min)
    }

    /// Takes those out of an engine that are to go now.
    pub fn take_out<T: Real>(
        &mut self,
        engine: &mut dyn EventEngine<T>,
        handles: &mut Handles,
        time: f64,
    ) {
        let gravity = engine.gravity().cast::<f64>();
        self.state.pass(time, || engine.bodies());
        for (body, part) in core::mem::take(&mut self.state.gone) {
            if let Some(taken) = engine.take_out(body) {
                self.state.note_removed((&taken, 0), part, gravity);
                handles.take_out(body);
            }
        }
    }

    /// Exchanges what is due at a time. What cannot be stays to be done.
    fn exchange<T: Real>(
        &mut self,
        apply: Apply<T>,
        mut change: Change<'_, T>,
        time: f64,
    ) -> Result<(), EngineError> {
        let mut state = self.state.clone();
        let gravity = change.gravity().cast::<f64>();
        state.pass(time, || change.bodies().clone());
        for (body, part) in core::mem::take(&mut state.gone) {
            state.note_removed((change.bodies(), body as usize), part, gravity);
            change.remove(body as usize);
        }
        if self.next() <= time {
            self.bring_in(&mut change, &mut state, time);
            state.mass = None;
        }
        apply(change).map_err(|error| match error {
            ChangeError::Engine(error) => error,
            other => EngineError::Exchange { time, reason: other.to_string() },
        })?;
        self.state = state;
        Ok(())
    }

    /// Brings in what is due at a time, as far as there is room.
    fn bring_in<T: Real>(&self, change: &mut Change<'_, T>, state: &mut FlowState, time: f64) {
        let room = change.room();
        let gravity = change.gravity().cast::<f64>();
        for (index, (inlet, source)) in self.inlets.iter().zip(&mut state.sources).enumerate() {
            source.due = inlet.due(source.due, time);
            while source.came < source.due.min(inlet.most()) {
                let sphere = inlet.sphere::<T>(index, source.came, source.attempts);
                source.attempts += 1;
                if !room.takes(&sphere, change.bodies(), |body| !change.is_removed(body)) {
                    state.exchange.waits += 1;
                    break;
                }
                source.came += 1;
                state.exchange.came.add(&sphere, 0, gravity);
                change.add(&sphere);
            }
        }
    }

    /// Fills in what parts took out.
    fn count(&self, parts: &mut [PartTotals]) {
        for part in parts {
            part.removed = self.state.removed_by.get(part.part as usize).copied().unwrap_or(0);
        }
    }
}

impl<T: Real> EventDriven<T> {
    /// Exchanges what is due now.
    pub(super) fn exchange_due(&mut self) -> Result<(), EngineError> {
        let time = self.time();
        self.take_out_due();
        if self.base().flow.as_ref().is_none_or(|flow| flow.next() > time) {
            return Ok(());
        }
        let Some(mut flow) = self.base_mut().flow.take() else { return Ok(()) };
        let done = flow.exchange(self.apply, self.change(), time);
        self.base_mut().flow = Some(flow);
        done
    }
}

impl<T: Real> Stepped<T> {
    /// Exchanges what is due now.
    pub(super) fn exchange_due(&mut self) -> Result<(), EngineError> {
        let time = self.time();
        let Some(mut flow) = self.base_mut().flow.take() else { return Ok(()) };
        let done = flow.exchange(self.apply, self.change(), time);
        self.base_mut().flow = Some(flow);
        done
    }
}

impl<T: Real> World<T> {
    /// Whether spheres come or go by its scene.
    #[must_use]
    pub fn has_flow(&self) -> bool {
        self.base().flow.is_some()
    }

    /// The numbers of the [handles](crate::engine::BodyHandle) of its bodies.
    #[must_use]
    pub fn numbers(&self) -> Vec<u64> {
        let handles = &self.base().handles;
        let numbers = (0..handles.count()).filter_map(|index| handles.of(index));
        numbers.map(|handle| handle.number()).collect()
    }

    /// What came into the world and went out of it by its scene since the start.
    #[must_use]
    pub fn exchange(&self) -> Exchange {
        self.base().flow.as_ref().map_or_else(Exchange::default, |flow| flow.state.exchange)
    }
}

/// What parts have done, with what they took out.
pub(super) fn counted(mut parts: Vec<PartTotals>, flow: Option<&Flow>) -> Vec<PartTotals> {
    if let Some(flow) = flow {
        flow.count(&mut parts);
    }
    parts
}
