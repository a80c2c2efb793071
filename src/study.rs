//! Studies: what a method costs, and how far off it is.
//!
//! A study is made of [points](Point), whose results go into a
//! [journal](Journal) as soon as they are there.

pub mod chart;
pub mod clock;
pub mod deviation;
mod error;
pub mod fit;
mod folder;
pub mod invariants;
mod journal;
mod machine;
mod memory;
mod point;
pub mod precision;
pub mod scaling;
pub mod stability;
mod subject;
pub mod work_precision;

pub use error::StudyError;
pub use folder::Folder;
pub use journal::Journal;
pub use machine::Machine;
pub use point::{Order, Point, Watch};
pub use subject::Subject;
