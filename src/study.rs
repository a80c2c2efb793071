//! Studies: what a method costs, and how far off it is.
//!
//! A study is made of [points](Point), whose results go into a
//! [journal](Journal) as soon as they are there.

pub mod chart;
mod error;
pub mod fit;
mod journal;
mod point;

pub use error::StudyError;
pub use journal::Journal;
pub use point::{Order, Point, Watch};
