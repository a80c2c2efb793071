//! Widened: `f32` in memory, `f64` in the register.

use core::array;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::Lane;

/// `N` reals that are stored as `f32` and computed with as `f64`, in a lane `L`
/// of as many: mixed precision, by the same formulas. Only what is stored is
/// rounded to `f32`, once, where `f32` lanes round each operation.
///
/// A column has to be a whole number of lanes, as a
/// [`Column`](crate::column::Column) with its padding is: the tail of a sweep is
/// worked off in its scalar, which is `f32`.
///
/// ```
/// use carom::lane::{Lane, Widened};
/// use wide::f64x4;
///
/// fn thrice<L: Lane>(x: L) -> L {
///     L::ratio(1, 10) * x + L::ratio(1, 5) * x
/// }
/// let mixed = thrice(Widened::<f64x4, 4>::splat(3.0)).to_array();
/// assert_eq!(mixed, [0.9_f32; 4]);
/// assert_ne!(thrice(3.0_f32), 0.9);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Widened<L, const N: usize>(pub L);

macro_rules! operations {
    ($($trait:ident::$method:ident),*) => {$(
        impl<L: Lane, const N: usize> $trait for Widened<L, N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )*};
}

operations!(Add::add, Sub::sub, Mul::mul, Div::div);

impl<L: Lane, const N: usize> Neg for Widened<L, N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<L: Lane<Scalar = f64, Array = [f64; N]>, const N: usize> Lane for Widened<L, N> {
    type Scalar = f32;
    type Mask = L::Mask;
    type Array = [f32; N];

    const WIDTH: usize = N;
    const ZERO: Self = Self(L::ZERO);
    const ONE: Self = Self(L::ONE);

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(L::splat(f64::from(value)))
    }

    #[inline(always)]
    fn from_array(values: [f32; N]) -> Self {
        Self(L::from_array(values.map(f64::from)))
    }

    #[inline(always)]
    fn to_array(self) -> [f32; N] {
        self.0.to_array().map(|value| value as f32)
    }

    #[inline(always)]
    fn arrays(column: &[f32]) -> (&[[f32; N]], &[f32]) {
        column.as_chunks()
    }

    #[inline(always)]
    fn arrays_mut(column: &mut [f32]) -> (&mut [[f32; N]], &mut [f32]) {
        column.as_chunks_mut()
    }

    #[inline(always)]
    fn from_fn(value: impl FnMut(usize) -> f32) -> Self {
        Self::from_array(array::from_fn(value))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn lt(self, other: Self) -> L::Mask {
        self.0.lt(other.0)
    }

    #[inline(always)]
    fn le(self, other: Self) -> L::Mask {
        self.0.le(other.0)
    }

    #[inline(always)]
    fn same(self, other: Self) -> L::Mask {
        self.0.same(other.0)
    }

    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self(L::select(mask, yes.0, no.0))
    }

    // Constants and whole numbers are those of the register.
    #[inline(always)]
    fn ratio(numerator: i32, denominator: i32) -> Self {
        Self(L::ratio(numerator, denominator))
    }

    #[inline(always)]
    fn nearest_whole(self) -> Self {
        Self(self.0.nearest_whole())
    }

    #[inline(always)]
    fn nearest_small_whole(self) -> Self {
        Self(self.0.nearest_small_whole())
    }
}
