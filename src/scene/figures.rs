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
    /// A list of values, stored once if they are equal.
    #[cfg(feature = "files")]
    pub(super) fn listed(values: Vec<f64>) -> Self {
        match values.first() {
            Some(first) if values.iter().all(|value| value == first) => Self::Same(*first),
            _ => Self::Each(values),
        }
    }

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
        Self::beside(make, count, seed, None, None)
    }

    /// Those of a group that has radii, or masses, already.
    pub(super) fn beside(
        make: &Make,
        count: usize,
        seed: Seed,
        radius: Option<Values>,
        mass: Option<Values>,
    ) -> Self {
        let radius = radius.unwrap_or_else(|| {
            let spread = make.radius.unwrap_or(Spread::Same(0.0));
            let mut radius = Values::drawn(spread, count, seed.random(Purpose::Radius));
            if let Values::Each(values) = &mut radius {
                // The largest find their places first, while there is room.
                values.sort_unstable_by(|a, b| b.total_cmp(a));
            }
            radius
        });
        let drawn = |spread| Values::drawn(spread, count, seed.random(Purpose::Mass));
        let mass = mass.unwrap_or_else(|| match make.density {
            None => drawn(make.mass.unwrap_or(Spread::Same(1.0))),
            Some(density) => drawn(density)
                .combined(&radius, count, |density, r| density * (4.0 / 3.0 * PI * (r * r * r))),
        });
        let inertia = mass.combined(&radius, count, |m, r| make.inertia_factor * m * (r * r));
        Self { radius, mass, inertia }
    }
}
