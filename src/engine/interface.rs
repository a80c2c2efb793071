//! Interface: what both engines can do, whatever they are inside.
//!
//! A world holds its engine behind one of these traits. It is entered once a
//! call, not once a collision, and no crate but this one compiles an engine.

use core::fmt::Debug;

use super::account::{Effort, Totals};
#[cfg(feature = "files")]
use super::snapshot::{Misfit, Snapshot};
use super::{EngineError, Listener, PartTotals, Plan};
use crate::bodies::{Bodies, Columns3};
use crate::real::Real;
use crate::vec3::Vec3;

/// A scene in motion.
pub trait Engine<T: Real>: Debug + Send + Sync {
    /// What the scene needs.
    fn plan(&self) -> &Plan;

    /// The uniform acceleration, length per time².
    fn gravity(&self) -> Vec3<T>;

    /// Time since the start.
    fn time(&self) -> f64;

    /// What is added up over the collisions so far.
    fn totals(&self) -> Totals;

    /// What is added up over the collisions with each part of the surroundings that is
    /// counted apart.
    fn parts(&self) -> Vec<PartTotals>;

    /// The bodies now, in the scene's order.
    fn bodies(&self) -> Bodies<T>;

    /// All that it has to remember.
    #[cfg(feature = "files")]
    fn save(&self) -> Snapshot;

    /// Goes on, at its start, from what another engine of the same scene remembered.
    #[cfg(feature = "files")]
    fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit>;

    /// The same in double precision, where the engine knows places to more digits than
    /// the scene's precision has from the scene's origin.
    fn finer_bodies(&self) -> Option<Bodies<f64>> {
        None
    }

    /// The bytes of memory that it holds.
    fn bytes(&self) -> usize;
}

/// A scene in motion by steps.
pub trait StepEngine<T: Real>: Engine<T> {
    /// Length of a step, time.
    fn dt(&self) -> T;

    /// Length of a step as the scene gives it, not as the precision rounds it.
    fn exact_dt(&self) -> f64;

    /// Steps taken.
    fn steps(&self) -> u64;

    /// Where the bodies are, in the scene's order.
    fn centers(&self) -> Columns3<T>;

    /// Takes steps, and reports the collisions of each in their order.
    fn take_steps(&mut self, steps: u64, on_event: Listener<'_, T>);
}

/// How many collisions an advance takes at most.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    pub collisions: u64,
    /// Whether it ends with the last of them, or where it suits the engine after it.
    pub is_exact: bool,
}

/// A scene in motion from collision to collision.
pub trait EventEngine<T: Real>: Engine<T> {
    /// Lets time pass up to `time`, which is not past, or for a stretch. Returns whether
    /// all up to that time is done.
    fn advance_to(
        &mut self,
        time: f64,
        stretch: Stretch,
        on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError>;

    /// The sum of all ways over the number of their ends.
    fn mean_free_path(&self) -> Option<f64>;

    /// What it took to find the collisions so far.
    fn effort(&self) -> Effort;

    /// Takes the body of an index out, and gives it as it was after its last collision. The
    /// others keep their indices in events, but [`bodies`](Engine::bodies) are those left.
    fn take_out(&mut self, index: u32) -> Option<Bodies<T>>;
}
