//! Rough: surfaces that grip perfectly, and elastic.

use super::{Closing, Law, Laws, Sliding};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// Perfectly rough, `e = β = 1`: an impulse reverses the relative velocity of
/// the surfaces, the tangential part too.
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
