//! Studies: what a method costs, and how far off it is.
//!
//! A study is made of [points](Point), whose results go into a
//! [journal](Journal) as soon as they are there.

pub mod chart;
mod error;
mod file;
pub mod fit;
mod journal;
mod point;
pub mod stability;

pub use error::StudyError;
pub use journal::Journal;
pub use point::{Order, Point, Watch};
