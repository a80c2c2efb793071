//! Quantity: what the error can be of.

use core::fmt;

use serde::{Deserialize, Serialize};

use crate::study::Norm;
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
    pub(super) fn axis(self, norm: Norm) -> String {
        let of_bodies = |what: &str, scale: &str| {
            let body = match norm {
                Norm::Body(body) => format!(" of body {body}"),
                _ => String::new(),
            };
            format!("{}{what} error{body} / {scale}", norm.adjective())
        };
        match self {
            Self::Position => of_bodies("position", "greatest radius"),
            Self::Velocity => of_bodies("velocity", "RMS speed"),
            Self::Orientation => of_bodies("orientation", "rad"),
            Self::Energy => "relative energy error".to_owned(),
            Self::Momentum => "momentum error / sum of momenta".to_owned(),
            Self::AngularMomentum => "angular momentum error / sum of angular momenta".to_owned(),
        }
    }

    /// Its unit, and of bodies the norm.
    #[must_use]
    pub fn unit(self, norm: Norm) -> String {
        match self {
            Self::Position => format!("length, {norm}"),
            Self::Velocity => format!("length per time, {norm}"),
            Self::Orientation => format!("rad, {norm}"),
            Self::Energy | Self::Momentum | Self::AngularMomentum => "of the whole".to_owned(),
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
