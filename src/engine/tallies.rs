//! Tallies: sums over all collisions.

use crate::compensated::CompensatedSum;
use crate::real::Real;
use crate::vec3::Vec3;

/// Sums that observations are made of, in the order in which contacts took
/// effect.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct Tallies {
    virial: CompensatedSum,
    impulse: [CompensatedSum; 3],
    path: CompensatedSum,
}

impl Tallies {
    /// Counts a collision of two bodies.
    pub fn pair<T: Real>(&mut self, normal: Vec3<T>, offset: Vec3<T>) {
        for (j, x) in normal.to_array().into_iter().zip(offset.to_array()) {
            self.virial.add(j.to_f64() * x.to_f64());
        }
    }

    /// Counts a collision with something fixed.
    pub fn surroundings<T: Real>(&mut self, impulse: Vec3<T>) {
        for (sum, j) in self.impulse.iter_mut().zip(impulse.to_array()) {
            sum.add(j.to_f64());
        }
    }

    /// Counts the length of a flight.
    pub fn flight<T: Real>(&mut self, length: T) {
        self.path.add(length.to_f64());
    }

    /// The sum of the lengths of all flights.
    pub fn path(&self) -> f64 {
        self.path.value()
    }

    /// `Σ J_n·x` over pairs.
    pub fn virial(&self) -> f64 {
        self.virial.value()
    }

    /// `Σ J` over the surroundings.
    pub fn impulse(&self) -> [f64; 3] {
        self.impulse.each_ref().map(CompensatedSum::value)
    }
}
