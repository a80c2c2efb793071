//! Invariants: energy, momentum and angular momentum of a state, to more digits
//! than the state has.

use crate::bodies::Bodies;
use crate::lane::Lane;
use crate::observe::energy_scale;
use crate::real::{DoubleDouble, Real};
use crate::vec3::Vec3;

/// What free motion and elastic collisions conserve, and how great the terms are
/// that it is made of.
#[derive(Clone, Copy, Debug)]
pub struct Invariants {
    /// `Σ ½ m v² + ½ I w² − m g·c`, mass × length² per time².
    pub energy: DoubleDouble,
    /// `Σ m v`, mass × length per time.
    pub momentum: Vec3<DoubleDouble>,
    /// `Σ c × m v + I w` about the origin, mass × length² per time.
    pub angular_momentum: Vec3<DoubleDouble>,
    /// `Σ ½ m v² + ½ I w²`.
    pub kinetic_energy: f64,
    /// `−Σ m g·c`.
    pub potential_energy: f64,
    /// `Σ m |v|`.
    pub momentum_scale: f64,
    /// `Σ |c × m v| + I |w|`.
    pub angular_momentum_scale: f64,
}

impl Invariants {
    /// Of bodies in a uniform field of acceleration `gravity`.
    #[must_use]
    pub fn of<T: Real>(bodies: &Bodies<T>, gravity: Vec3<DoubleDouble>) -> Self {
        let half = DoubleDouble::ratio(1, 2);
        let mut potential = DoubleDouble::ZERO;
        let mut totals = Self {
            energy: DoubleDouble::ZERO,
            momentum: Vec3::ZERO,
            angular_momentum: Vec3::ZERO,
            kinetic_energy: 0.0,
            potential_energy: 0.0,
            momentum_scale: 0.0,
            angular_momentum_scale: 0.0,
        };
        for index in 0..bodies.len() {
            let mass: DoubleDouble = bodies.mass.of(index).cast();
            let inertia: DoubleDouble = bodies.inertia.of(index).cast();
            let position = bodies.position_of(index).cast::<DoubleDouble>();
            let momentum = bodies.velocity_of(index).cast() * mass;
            let spin = bodies.spin_of(index).cast::<DoubleDouble>();
            let velocity = bodies.velocity_of(index).cast();
            let kinetic = (momentum.dot(velocity) + inertia * spin.dot(spin)) * half;
            let orbital = position.cross(momentum);
            totals.energy = totals.energy + kinetic - mass * gravity.dot(position);
            totals.momentum += momentum;
            totals.angular_momentum = totals.angular_momentum + orbital + spin * inertia;
            totals.kinetic_energy += kinetic.high();
            potential = potential - mass * gravity.dot(position);
            totals.momentum_scale += momentum.length().high();
            totals.angular_momentum_scale +=
                orbital.length().high() + (inertia * spin.length()).high();
        }
        totals.potential_energy = potential.high();
        totals
    }

    /// How far these are from others: of the energy, of the momentum, of the
    /// angular momentum.
    ///
    /// The energy is measured by what the motion can exchange
    /// ([`energy_scale`]), with the energy of a `fall` as the scene allows it; the
    /// momenta by the sums of their terms' lengths.
    #[must_use]
    pub fn change_since(&self, start: &Self, fall: f64) -> [f64; 3] {
        let energy = (self.energy - start.energy).high();
        let kinetic = [start.kinetic_energy, self.kinetic_energy];
        let potential = [start.potential_energy, self.potential_energy];
        let energy_scale = energy_scale(kinetic, potential, fall);
        let momentum = (self.momentum - start.momentum).length().high();
        let momentum_scale = start.momentum_scale.max(self.momentum_scale);
        let angular = (self.angular_momentum - start.angular_momentum).length().high();
        let angular_scale = start.angular_momentum_scale.max(self.angular_momentum_scale);
        [
            ratio(energy, energy_scale),
            ratio(momentum, momentum_scale),
            ratio(angular, angular_scale),
        ]
    }
}

/// Of nothing there is no part.
fn ratio(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

/// `E/E₀ − 1` of bodies in no field, without a rounding of the size of ε.
#[must_use]
pub fn energy_change<T: Real>(now: &Bodies<T>, start: &Bodies<T>) -> f64 {
    let energy = |bodies| Invariants::of(bodies, Vec3::ZERO).energy;
    let start = energy(start);
    ((energy(now) - start) / start).high()
}
