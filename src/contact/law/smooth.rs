//! Smooth: frictionless and elastic.

use super::{Closing, Law, Laws, Sliding};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// Frictionless, `e = 1, β = −1`: an impulse is along the normal, and spins
/// never change.
///
/// ```
/// use carom::Vec3;
/// use carom::contact::{Party, Smooth, collide};
///
/// let at = |speed: f64| Party {
///     velocity: Vec3::new(speed, 0.0, 0.0),
///     spin: Vec3::ZERO,
///     inverse_mass: 1.0,
///     inverse_inertia: 10.0,
///     share: 0.5,
/// };
/// let (mut a, mut b) = (at(1.0), at(-3.0));
/// collide(Smooth, Vec3::new(-1.0, 0.0, 0.0), &mut a, &mut b);
/// assert_eq!((a.velocity.x, b.velocity.x), (-3.0, 1.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Smooth;

impl<L: Lane> Law<L> for Smooth {
    const CHANGES_SPINS: bool = false;

    #[inline(always)]
    fn normal_factor(&self, _: &Closing<L>) -> L {
        L::ratio(-2, 1)
    }

    #[inline(always)]
    fn tangential(&self, _: &Closing<L>, _: L, _: &Sliding<L>) -> Vec3<L> {
        Vec3::ZERO
    }
}

impl<T: Real> Laws<T> for Smooth {
    const CHANGES_SPINS: bool = false;

    type Of<L: Lane<Scalar = T>> = Self;

    #[inline(always)]
    fn between<L: Lane<Scalar = T>>(&self, _: impl Fn(usize) -> [u32; 2]) -> Self {
        *self
    }
}
