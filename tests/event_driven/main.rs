//! The event-driven engine: known trajectories event by event, exact cases, the
//! laws that it must keep, a program of a page that finds the same events, and
//! equal bits on every path.

mod agreement;
mod exact;
mod fluid;
mod interruptions;
mod laws;
mod lines;
mod reference;
mod same_bits;
mod standstill;
mod trajectories;
mod units;

#[path = "../common/mod.rs"]
mod common;

use carom::engine::{Compiled, Event, EventDriven, Execution, Lanes};
use carom::real::Real;
use carom::scene::EngineKind;
use carom::scene::{Scene, SceneBuilder};
use carom::surroundings::Plane;

/// The scalar path.
pub const SCALAR: Execution = Execution::new().lanes(Lanes::Scalar).threads(1);

/// The fastest lanes.
pub const FAST: Execution = Execution::new().threads(1);

/// A scene in the making that needs no step.
pub fn builder<T: Real>() -> SceneBuilder<T> {
    Scene::<T>::builder().engine(EngineKind::EventDriven)
}

/// A scene at its start.
pub fn world<T: Compiled>(scene: Scene<T>) -> EventDriven<T> {
    EventDriven::with_execution(scene, FAST).unwrap()
}

/// What happens in the next so much time.
pub fn events<T: Real>(world: &mut EventDriven<T>, duration: f64) -> Vec<Event<T>> {
    let mut events = Vec::new();
    world.for_each_event(duration, |event| events.push(*event)).unwrap();
    events
}

/// A vector in the scene's precision.
pub fn t3<T: Real>(vector: [f64; 3]) -> [T; 3] {
    vector.map(T::from_f64)
}

/// The half space below `z = 0`.
pub fn floor<T: Real>() -> Plane<T> {
    Plane::new(t3([0.0; 3]), t3([0.0, 0.0, 1.0]))
}
