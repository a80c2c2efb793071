//! Figures: radii, masses and moments of inertia of a group of spheres, in
//! `f64`.

use core::f64::consts::PI;

use super::random::{Purpose, Random, Seed};
use super::spheres::{Make, Spread};

/// A figure of each sphere of a group.
pub(super) enum Values {
    Same(f64),
    Each(Vec<f64>),
}

impl Values {
    pub(super) fn of(&self, index: usize) -> f64 {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => values[index],
        }
    }

    /// `count` values of a spread.
    pub(super) fn drawn(spread: Spread, count: usize, mut random: Random) -> Self {
        match spread {
            Spread::Same(value) => Self::Same(value),
            Spread::Uniform { least, greatest } => {
                Self::Each((0..count).map(|_| random.between(least, greatest)).collect())
            }
        }
    }

    /// A function of two figures.
    pub(super) fn combined(
        &self,
        other: &Self,
        count: usize,
        function: impl Fn(f64, f64) -> f64,
    ) -> Self {
        match (self, other) {
            (Self::Same(a), Self::Same(b)) => Self::Same(function(*a, *b)),
            _ => Self::Each((0..count).map(|k| function(self.of(k), other.of(k))).collect()),
        }
    }
}

/// Radii, masses and moments of inertia of a group.
pub(super) struct Figures {
    pub(super) radius: Values,
    pub(super) mass: Values,
    pub(super) inertia: Values,
}

impl Figures {
    pub(super) fn new(make: &Make, count: usize, seed: Seed) -> Self {
        let spread = make.radius.unwrap_or(Spread::Same(0.0));
        let mut radius = Values::drawn(spread, count, seed.random(Purpose::Radius));
        if let Values::Each(values) = &mut radius {
            // The largest find their places first, while there is room.
            values.sort_unstable_by(|a, b| b.total_cmp(a));
        }
        let mass = match make.density {
            None => {
                let mass = make.mass.unwrap_or(Spread::Same(1.0));
                Values::drawn(mass, count, seed.random(Purpose::Mass))
            }
            Some(density) => Values::drawn(density, count, seed.random(Purpose::Mass)).combined(
                &radius,
                count,
                |density, r| density * (4.0 / 3.0 * PI * (r * r * r)),
            ),
        };
        let inertia = mass.combined(&radius, count, |m, r| make.inertia_factor * m * (r * r));
        Self { radius, mass, inertia }
    }
}
