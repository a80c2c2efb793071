//! Energy of a state.

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use crate::bodies::Bodies;
use crate::compensated::CompensatedSum;
use crate::motion::Integrator;
use crate::real::Real;
use crate::vec3::Vec3;

/// Energy of all bodies, mass × length² per time².
///
/// ```
/// use carom::Energy;
/// let energy = Energy { translational: 3.0, rotational: 1.0, potential: -2.0 };
/// assert_eq!((energy.kinetic(), energy.total()), (4.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Energy {
    /// Of the centres' motion: `Σ ½ m v²`.
    pub translational: f64,
    /// Of the spins: `Σ ½ I w²`.
    pub rotational: f64,
    /// In the uniform field, zero at the origin: `−Σ m g·c`.
    pub potential: f64,
}

impl Energy {
    /// The energy of bodies in a uniform field of acceleration `gravity`.
    ///
    /// ```
    /// use carom::{Bodies, Energy, Vec3};
    /// let ball = Bodies::from_positions(&[[0.0, 0.0, 2.0]]).spins(&[[0.0, 0.0, 10.0]]);
    /// let energy = Energy::of(&ball.radius(0.5).build()?, Vec3::new(0.0, 0.0, -10.0));
    /// assert_eq!((energy.potential, energy.rotational), (20.0, 5.0));
    /// assert_eq!((energy.kinetic(), energy.total()), (5.0, 25.0));
    /// # Ok::<(), carom::bodies::BodiesError>(())
    /// ```
    #[must_use]
    pub fn of<T: Real>(bodies: &Bodies<T>, gravity: Vec3<T>) -> Self {
        let gravity = gravity.cast::<f64>();
        let mut sums = [CompensatedSum::default(); 3];
        for index in 0..bodies.len() {
            for (sum, energy) in sums.iter_mut().zip(bodies.energy_of(index, gravity)) {
                sum.add(energy);
            }
        }
        let [translational, rotational, potential] = sums;
        Self {
            translational: translational.value(),
            rotational: rotational.value(),
            // Without a field every term is −0.
            potential: potential.value() + 0.0,
        }
    }

    /// Translational and rotational energy.
    #[must_use]
    pub fn kinetic(&self) -> f64 {
        self.translational + self.rotational
    }

    /// All of it.
    #[must_use]
    pub fn total(&self) -> f64 {
        [self.translational, self.rotational, self.potential]
            .into_iter()
            .collect::<CompensatedSum>()
            .value()
    }

    /// How far the total is from an earlier one, as a fraction of what the motion
    /// can exchange ([`energy_scale`]).
    ///
    /// The zero of the potential is a convention: it changes neither.
    ///
    /// ```
    /// use carom::observe::Energy;
    /// let before = Energy { translational: 4.0, rotational: 0.0, potential: 1e9 };
    /// let after = Energy { translational: 2.0, rotational: 1.0, potential: 1e9 };
    /// assert_eq!(after.relative_change(&before, 0.0), -0.25);
    /// assert_eq!(after.relative_change(&before, 6.0), -0.1);
    /// ```
    #[must_use]
    pub fn relative_change(&self, earlier: &Self, fall: f64) -> f64 {
        let parts = [
            self.translational,
            self.rotational,
            self.potential,
            -earlier.translational,
            -earlier.rotational,
            -earlier.potential,
        ];
        let change = parts.into_iter().collect::<CompensatedSum>().value();
        let kinetic = [earlier.kinetic(), self.kinetic()];
        let scale = energy_scale(kinetic, [earlier.potential, self.potential], fall);
        if change == 0.0 { 0.0 } else { change / scale }
    }
}

/// What a change of the energy between two states is measured by: the greater
/// kinetic energy, the change of the potential one, and the energy `fall` that the
/// scene lets bodies fall through ([`fall_energy`](super::fall_energy)). It is the
/// energy that the motion can exchange: not the potential about a far origin, and
/// never a total that cancels.
///
/// ```
/// use carom::observe::energy_scale;
/// assert_eq!(energy_scale([4.0, 3.0], [1e6, 1e6 + 1.0], 10.0), 15.0);
/// ```
#[must_use]
pub fn energy_scale(kinetic: [f64; 2], potential: [f64; 2], fall: f64) -> f64 {
    kinetic[0].max(kinetic[1]) + (potential[1] - potential[0]).abs() + fall
}

/// The energy that an integrator adds to bodies of total mass `mass` in a
/// uniform field of strength `|a| = acceleration` over `steps` steps of length
/// `dt`: `∓n Δt² |a|² M / 2`.
///
/// It is exact, whatever elastic collisions happen on the way, as long as they
/// change velocities only, at the ends of steps.
///
/// ```
/// use carom::motion::Integrator;
/// use carom::observe::integrator_drift;
/// assert_eq!(integrator_drift(Integrator::SemiImplicitEuler, 8, 0.5, 2.0, 3.0), -12.0);
/// assert_eq!(integrator_drift(Integrator::VelocityVerlet, 8, 0.5, 2.0, 3.0), 0.0);
/// ```
#[must_use]
pub fn integrator_drift(
    integrator: Integrator,
    steps: u64,
    dt: f64,
    acceleration: f64,
    mass: f64,
) -> f64 {
    let sign = match integrator {
        Integrator::SemiImplicitEuler => -1.0,
        Integrator::ExplicitEuler => 1.0,
        Integrator::VelocityVerlet => 0.0,
    };
    let speed_gained = acceleration * dt;
    // Adding 0 takes the sign off a drift of −0.
    sign * steps as f64 * (speed_gained * speed_gained) * mass / 2.0 + 0.0
}

impl fmt::Display for Energy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} ({} translational, {} rotational, {} potential)",
            self.total(),
            self.translational,
            self.rotational,
            self.potential
        )
    }
}
