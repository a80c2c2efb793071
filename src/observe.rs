//! Observations: what a state amounts to.
//!
//! Every total is taken in `f64` from the bodies' own numbers, summed with
//! compensation in the order of the scene file, so that it has the same bits on
//! every path and its error is that of the terms, not of their number.
//!
//! ```
//! use carom::observe::{Energy, Momentum};
//! use carom::{Bodies, Vec3};
//!
//! let ball = Bodies::from_positions(&[[0.0, 0.0, 2.0]])
//!     .velocities(&[[3.0, 0.0, 0.0]])
//!     .radius(0.5)
//!     .mass(2.0)
//!     .build()?;
//! let energy = Energy::of(&ball, Vec3::new(0.0, 0.0, -10.0));
//! assert_eq!(energy.to_string(), "49 (9 translational, 0 rotational, 40 potential)");
//! assert_eq!(Momentum::of(&ball).to_string(), "(6, 0, 0)");
//! # Ok::<(), carom::bodies::BodiesError>(())
//! ```

mod analysis;
mod blocks;
mod energy;
mod fall;
mod finite;
mod gas;
mod images;
mod momentum;
mod of_batch;
mod of_world;
mod sample;
mod species;
mod standstill;
#[cfg(feature = "files")]
mod state_hash;
mod totals;

pub use analysis::{Analysis, Figure, Findings, Moment, Unfit};
pub use blocks::Statistic;
pub use energy::{Energy, energy_scale, integrator_drift};
pub use fall::fall_energy;
pub use finite::{NotFinite, Unresolved, not_finite, unresolved};
pub use gas::{Temperature, collision_rate, compressibility};
pub use images::Images;
pub use momentum::{AngularMomentum, Momentum};
pub use sample::Sample;
pub use species::species;
pub use standstill::{Standstill, Touched};
#[cfg(feature = "files")]
pub use state_hash::{StateHash, state_hash};
pub use totals::Totals;

use crate::bodies::{Bodies, PerBody};
use crate::compensated::CompensatedSum;
use crate::real::Real;

/// The mass of all bodies together.
///
/// ```
/// use carom::Bodies;
/// use carom::observe::total_mass;
/// let positions = [[0.0; 3], [2.0, 0.0, 0.0]];
/// let bodies = Bodies::from_positions(&positions).radius(0.5).masses(&[1.0, 3.0]).build()?;
/// assert_eq!(total_mass(&bodies), 4.0);
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[must_use]
pub fn total_mass<T: Real>(bodies: &Bodies<T>) -> f64 {
    match &bodies.mass {
        PerBody::Same(mass) => mass.to_f64() * bodies.len() as f64,
        PerBody::Each(masses) => {
            masses.iter().map(|mass| mass.to_f64()).collect::<CompensatedSum>().value()
        }
    }
}
