//! What can be observed of a scene in motion.

use super::Energy;
use crate::engine::{EventDriven, Stepped, World};
use crate::real::Real;

impl<T: Real> Stepped<T> {
    /// The energy of all bodies now.
    #[must_use]
    pub fn energy(&self) -> Energy {
        Energy::of(&self.bodies(), self.gravity())
    }
}

impl<T: Real> EventDriven<T> {
    /// The energy of all bodies now.
    #[must_use]
    pub fn energy(&self) -> Energy {
        Energy::of(&self.bodies(), self.gravity())
    }
}

impl<T: Real> World<T> {
    /// The energy of all bodies now.
    #[must_use]
    pub fn energy(&self) -> Energy {
        Energy::of(&self.bodies(), self.gravity())
    }
}
