//! Studies: what a method costs, and how far off it is.
//!
//! | study | what it shows |
//! |---|---|
//! | [`work_precision`] | run time against error of engines, integrators, impacts, steps, precisions |
//! | [`precision`] | what a scene loses in `f32` and `f64`, beside double-double |
//! | [`stability`] | what holds under stress, each law judged |
//! | [`scaling`] | time and memory against size, threads and lanes |
//!
//! A [`Study`] is made of [points](Point), whose results go into the [`Journal`] of a
//! [`Folder`] as soon as they are there: an interrupted study goes on where it
//! was. What follows from them is its [`Report`]. A folder is not needed:
//!
//! ```
//! use carom::scene::SceneFile;
//! use carom::study::work_precision::{Asked, WorkPrecision};
//! use carom::study::{Journal, Study};
//!
//! let file = SceneFile::builtin("superball").ok_or("no such scene")?;
//! let asked = Asked { duration: Some(2.0), runs: Some(1), ..Asked::default() };
//! let study = WorkPrecision::new(&file, &asked)?;
//! let report = study.measure(&Journal::unwritten(), &())?;
//! let (_, best) = report.advice.last().ok_or("no method")?;
//! assert!(best.error < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod chart;
pub mod clock;
mod course;
pub mod deviation;
mod error;
pub mod fit;
mod folder;
pub mod invariants;
mod journal;
mod machine;
mod memory;
mod others;
mod point;
pub mod precision;
pub mod scaling;
mod schedule;
mod skeleton;
pub mod stability;
mod subject;
pub mod table;
pub mod work_precision;

pub use course::Course;
pub use error::StudyError;
pub use folder::Folder;
pub use journal::Journal;
pub use machine::Machine;
pub use point::{Order, Point, Watch};
pub use schedule::Schedule;
pub use skeleton::{Report, Study};
pub use subject::Subject;
