//! Account: what is added up over all collisions.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::Collisions;
use crate::compensated::CompensatedSum;
use crate::real::Real;
use crate::vec3::Vec3;

/// What it took to find collisions.
///
/// ```
/// use carom::{EventDriven, Scene, Sphere};
///
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
/// let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
/// let mut world = EventDriven::new(scene)?;
/// world.advance(1.0)?;
/// assert!(world.effort().remaining <= world.effort().tried);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Effort {
    /// Pairs whose contact was looked for.
    pub tried: u64,
    /// Those of them that the coarse precision left to the full one.
    pub remaining: u64,
    /// How often bodies crossed from one cell to the next.
    pub crossings: u64,
    /// How often a body's contacts were looked for again, since all that it
    /// knew of had been overtaken.
    pub searches: u64,
}

/// What collisions have added up to.
#[derive(Clone, Copy, Debug)]
pub struct Totals {
    pub collisions: Collisions,
    /// `Σ J_n·x` over pairs, mass × length² per time.
    pub virial: f64,
    /// `Σ J` over the surroundings, mass × length per time.
    pub impulse: [f64; 3],
}

/// Counts and sums over the collisions so far, in the order in which they took
/// effect, which no worker decides. A restart file keeps all of it.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Account {
    pub collisions: Collisions,
    pub effort: Effort,
    virial: CompensatedSum,
    impulse: [CompensatedSum; 3],
    path: CompensatedSum,
}

impl Account {
    /// Counts a collision of two bodies: its normal impulse on the first, and
    /// the offset from the second centre to the first.
    #[inline(always)]
    pub fn pair<T: Real>(&mut self, normal: Vec3<T>, offset: Vec3<T>) {
        self.collisions.pairs += 1;
        for (j, x) in normal.to_array().into_iter().zip(offset.to_array()) {
            self.virial.add(j.to_f64() * x.to_f64());
        }
    }

    /// Counts a collision with something fixed, by the impulse on the body.
    #[inline(always)]
    pub fn surroundings<T: Real>(&mut self, impulse: Vec3<T>) {
        self.collisions.surroundings += 1;
        for (sum, j) in self.impulse.iter_mut().zip(impulse.to_array()) {
            sum.add(j.to_f64());
        }
    }

    /// Adds the length of a flight that has ended.
    #[inline(always)]
    pub fn flight<T: Real>(&mut self, length: T) {
        self.path.add(length.to_f64());
    }

    /// The sum of the lengths of all flights that have ended.
    pub fn path(&self) -> f64 {
        self.path.value()
    }

    /// What is added up so far.
    pub fn totals(&self) -> Totals {
        Totals {
            collisions: self.collisions,
            virial: self.virial.value(),
            impulse: self.impulse.each_ref().map(CompensatedSum::value),
        }
    }
}
