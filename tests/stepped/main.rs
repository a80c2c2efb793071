//! The stepped engine: equal bits on every path, the laws that it must keep,
//! exact cases, and its memory.

mod exact;
mod in_order;
mod laws;
mod reference;
mod same_bits;
mod sums;

#[path = "../common/mod.rs"]
mod common;

use carom::engine::{Compiled, Execution, Lanes, Stepped};
use carom::scene::Scene;

/// The scalar path on one thread.
pub const SCALAR: Execution = Execution::new().lanes(Lanes::Scalar).threads(1);

/// The fastest lanes on one thread.
pub const FAST: Execution = Execution::new().threads(1);

/// A scene at its start.
pub fn world<T: Compiled>(scene: Scene<T>, execution: Execution) -> Stepped<T> {
    Stepped::with_execution(scene, execution).unwrap()
}
