//! What a gas of many spheres shows: temperature, pressure, collision rate.

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use crate::bodies::Bodies;
use crate::observe::{Energy, Momentum, total_mass};
use crate::real::Real;
use crate::vec3::Vec3;

/// Temperature of the two kinds of motion, in units of energy (`k = 1`).
///
/// ```
/// use carom::{Bodies, Temperature};
/// let positions = [[0.0; 3], [2.0, 0.0, 0.0]];
/// let bodies = Bodies::from_positions(&positions)
///     .velocities(&[[0.0, 3.0, 0.0], [0.0, -3.0, 0.0]])
///     .radius(0.5)
///     .build()?;
/// let temperature = Temperature::of(&bodies).unwrap();
/// assert_eq!((temperature.translational, temperature.rotational), (6.0, 0.0));
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Temperature {
    /// Of the centres, `kT = (2 E_trans − P²/M) / 3(N − 1)`: of their motion
    /// relative to the mean velocity. Without total momentum this is
    /// `2 E_trans / 3(N − 1)`.
    pub translational: f64,
    /// Of the spins, `2 E_rot / 3N`.
    pub rotational: f64,
}

impl Temperature {
    /// The temperature of bodies; `None` for fewer than two.
    ///
    /// ```
    /// use carom::{Bodies, Temperature};
    /// let ball = Bodies::from_positions(&[[0.0; 3]]).radius(0.5).build()?;
    /// assert_eq!(Temperature::of(&ball), None);
    /// # Ok::<(), carom::bodies::BodiesError>(())
    /// ```
    #[must_use]
    pub fn of<T: Real>(bodies: &Bodies<T>) -> Option<Self> {
        if bodies.len() < 2 {
            return None;
        }
        let count = bodies.len() as f64;
        let energy = Energy::of(bodies, Vec3::ZERO);
        let drift = Momentum::of(bodies).0.length_squared() / total_mass(bodies);
        Some(Self {
            translational: (2.0 * energy.translational - drift).max(0.0) / (3.0 * (count - 1.0)),
            rotational: 2.0 * energy.rotational / (3.0 * count),
        })
    }
}

impl fmt::Display for Temperature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} translational, {} rotational", self.translational, self.rotational)
    }
}

/// Compressibility factor `Z = pV / NkT` of spheres in a periodic box,
/// `Z = 1 − 1/N + W / (3 N kT t)`.
///
/// `virial` is `W = Σ σ|J_n|` over the pair collisions of a run of length
/// `time`, `temperature` the translational `kT`, a mean over the run. The
/// `−1/N` belongs to a conserved momentum of zero, which leaves `N − 1` bodies'
/// worth of motion.
///
/// ```
/// use carom::observe::compressibility;
/// // No collision: an ideal gas, but for the fixed momentum.
/// assert_eq!(compressibility(1000, 0.0, 1.0, 10.0), 0.999);
/// assert_eq!(compressibility(1000, 30_000.0, 1.0, 10.0), 1.999);
/// ```
#[must_use]
pub fn compressibility(bodies: usize, virial: f64, temperature: f64, time: f64) -> f64 {
    let count = bodies as f64;
    // Bodies at rest have no temperature and do not collide.
    let excess = if virial == 0.0 { 0.0 } else { virial / (3.0 * count * temperature * time) };
    1.0 - 1.0 / count + excess
}

/// Collisions with others per body and time, `Γ = 2 n / (N t)` for `n` pair
/// collisions. In units of σ = m = kT = 1, `Γ = (6/√π)(Z − 1)` in the limit of
/// many bodies.
///
/// ```
/// use carom::observe::collision_rate;
/// assert_eq!(collision_rate(1000, 5_000, 10.0), 1.0);
/// ```
#[must_use]
pub fn collision_rate(bodies: usize, pairs: u64, time: f64) -> f64 {
    2.0 * pairs as f64 / (bodies as f64 * time)
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;

    /// The published Z of the hard-sphere fluid and the Γ of an independent program
    /// belong together: the mean |J_n| of a pair collision ties the two functions.
    #[test]
    fn rate_and_compressibility_agree_with_the_table() {
        let table = [(1.23937, 0.81126), (1.55317, 1.87376), (3.26870, 7.68082)];
        for (z, gamma) in table {
            let (bodies, time) = (4000, 1000.0);
            let pairs = (gamma * bodies as f64 * time / 2.0) as u64;
            // ⟨σ|J_n|⟩ = √(π m kT) σ, the mean of a relative velocity's normal
            // part, weighted by itself, for m = kT = σ = 1.
            let virial = pairs as f64 * core::f64::consts::PI.sqrt();
            let rate = collision_rate(bodies, pairs, time);
            assert_abs_diff_eq!(rate, gamma, epsilon = 1e-6);
            let measured = compressibility(bodies, virial, 1.0, time);
            assert_abs_diff_eq!(measured, z, epsilon = 4e-4);
        }
    }
}
