//! Motion: free flight between contacts.

mod integrator;

pub use integrator::Integrator;
