//! Motion: free flight between contacts.
//!
//! [`integrator`] has the formulas of a step of the centre and [`rotation`]
//! those of the orientation, as functions over lanes; [`flight`] and
//! [`turning`] sweep them over columns.

pub mod flight;
pub mod integrator;
pub mod rotation;
mod sweep;
pub mod turning;

pub use integrator::Integrator;
