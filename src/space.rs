//! Space: open or periodic, and what is near what in it.

pub(crate) mod broadphase;
pub(crate) mod cells;
pub(crate) mod levels;
mod near_pairs;
pub(crate) mod neighbours;
#[cfg(test)]
mod noise;
mod parts;
mod periodic;
mod sizes;
mod tree;

pub use near_pairs::near_pairs;
pub use parts::FixedParts;
pub use periodic::{OpenSpace, PeriodicBox, Space};
pub(crate) use tree::joined;
pub use tree::{Bounds, Tree};
