//! Rough: surfaces that grip perfectly, and elastic.

use super::{Closing, Law, Laws, Sliding};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// Perfectly rough, `e = β = 1`: an impulse reverses the relative velocity of
/// the surfaces, the tangential part too.
///
/// ```
/// use carom::Vec3;
/// use carom::contact::{Party, Rough, collide};
///
/// // A shell of radius 1 and mass 1 comes down on the floor at an angle.
/// let mut shell = Party {
///     velocity: Vec3::new(5.0, 0.0, -1.0),
///     spin: Vec3::ZERO,
///     inverse_mass: 1.0,
///     inverse_inertia: 1.5,
///     share: 1.0,
/// };
/// let from_floor = Vec3::new(0.0, 0.0, 1.0);
/// collide(Rough, from_floor, &mut shell, &mut Party::immovable());
/// assert_eq!(shell.velocity.to_array(), [1.0, 0.0, 1.0]);
/// assert_eq!(shell.spin.y, 6.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rough;

impl<L: Lane> Law<L> for Rough {
    const CHANGES_SPINS: bool = true;

    #[inline(always)]
    fn normal_factor(&self, _: &Closing<L>) -> L {
        L::ratio(-2, 1)
    }

    #[inline(always)]
    fn tangential(&self, _: &Closing<L>, _: L, sliding: &Sliding<L>) -> Vec3<L> {
        sliding.slip * (L::ratio(-2, 1) / sliding.inverse_masses)
    }
}

impl<T: Real> Laws<T> for Rough {
    const CHANGES_SPINS: bool = true;

    type Of<L: Lane<Scalar = T>> = Self;

    #[inline(always)]
    fn between<L: Lane<Scalar = T>>(&self, _: impl Fn(usize) -> [u32; 2]) -> Self {
        *self
    }
}
