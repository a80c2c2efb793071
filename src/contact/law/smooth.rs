//! Smooth: frictionless and elastic.

use super::{Closing, Law, Laws, Sliding};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// Frictionless, `e = 1, β = −1`: an impulse is along the normal, and spins
/// never change.
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
