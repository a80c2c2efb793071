//! Quantity: what the error can be of.

use core::fmt;

use serde::{Deserialize, Serialize};

use crate::study::deviation::Deviation;

/// What an error can be of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// Of centres, length.
    #[default]
    Position,
    /// Of velocities, length per time.
    Velocity,
    /// Of orientations, rad.
    Orientation,
    /// Of the energy, of its whole.
    Energy,
    /// Of the momentum, of the sum of all momenta.
    Momentum,
    /// Of the angular momentum, of the sum of all angular momenta.
    AngularMomentum,
}

impl Quantity {
    /// All of them, in the order of the tables.
    pub const ALL: [Self; 6] = [
        Self::Position,
        Self::Velocity,
        Self::Orientation,
        Self::Energy,
        Self::Momentum,
        Self::AngularMomentum,
    ];

    /// The size of the error.
    #[must_use]
    pub fn of(self, deviation: &Deviation) -> f64 {
        match self {
            Self::Position => deviation.position,
            Self::Velocity => deviation.velocity,
            Self::Orientation => deviation.orientation,
            Self::Energy => deviation.energy.abs(),
            Self::Momentum => deviation.momentum,
            Self::AngularMomentum => deviation.angular_momentum,
        }
    }

    /// What an axis of errors relative to the greatest radius or the speed is called.
    pub(super) fn axis(self) -> &'static str {
        match self {
            Self::Position => "RMS position error / greatest radius",
            Self::Velocity => "RMS velocity error / RMS speed",
            Self::Orientation => "RMS orientation error / rad",
            Self::Energy => "relative energy error",
            Self::Momentum => "momentum error / sum of momenta",
            Self::AngularMomentum => "angular momentum error / sum of angular momenta",
        }
    }

    /// Its unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Position => "length, root mean square",
            Self::Velocity => "length per time, root mean square",
            Self::Orientation => "rad, root mean square",
            Self::Energy | Self::Momentum | Self::AngularMomentum => "of the whole",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Orientation => "orientation",
            Self::Energy => "energy",
            Self::Momentum => "momentum",
            Self::AngularMomentum => "angular momentum",
        })
    }
}
