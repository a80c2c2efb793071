//! Space: open or periodic, and who is near what in it.

pub(crate) mod broadphase;
mod periodic;

pub use periodic::{OpenSpace, PeriodicBox, Space};
