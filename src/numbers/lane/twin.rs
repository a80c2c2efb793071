//! Two lanes side by side: a width that the machine has no register for.

use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::pack::arrays;
use super::{Lane, Mask};

/// `2 × L::WIDTH` reals in two lanes of type `L`: sixteen `f64` are two
/// `wide::f64x8`.
///
/// ```
/// use carom::lane::{Lane, Twin};
/// use wide::f64x8;
///
/// let sixteen = Twin::<f64x8>::from_fn(|k| k as f64);
/// assert_eq!((sixteen * sixteen).to_array()[15], 225.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twin<L>(pub L, pub L);

/// The mask of a [`Twin`].
#[derive(Clone, Copy, Debug)]
pub struct TwinMask<L: Lane>(L::Mask, L::Mask);

macro_rules! by_halves {
    ($($trait:ident::$method:ident on $type:ident<$lane:ident: $bound:path>),*) => {$(
        impl<$lane: $bound> $trait for $type<$lane> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $type(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    )*};
}

by_halves!(
    Add::add on Twin<L: Lane>,
    Sub::sub on Twin<L: Lane>,
    Mul::mul on Twin<L: Lane>,
    Div::div on Twin<L: Lane>,
    BitAnd::bitand on TwinMask<L: Lane>,
    BitOr::bitor on TwinMask<L: Lane>
);

impl<L: Lane> Neg for Twin<L> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Twin(-self.0, -self.1)
    }
}

impl<L: Lane> Not for TwinMask<L> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        TwinMask(!self.0, !self.1)
    }
}

impl<L: Lane> Mask for TwinMask<L> {
    #[inline(always)]
    fn any(self) -> bool {
        (self.0 | self.1).any()
    }

    #[inline(always)]
    fn all(self) -> bool {
        (self.0 & self.1).all()
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.bits() | (self.1.bits() << L::WIDTH)
    }
}

impl Lane for Twin<wide::f64x8> {
    type Mask = TwinMask<wide::f64x8>;

    arrays!(f64, 16);

    const ZERO: Self = Twin(wide::f64x8::ZERO, wide::f64x8::ZERO);
    const ONE: Self = Twin(wide::f64x8::ONE, wide::f64x8::ONE);

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Twin(Lane::splat(value), Lane::splat(value))
    }

    #[inline(always)]
    fn from_array(values: [f64; 16]) -> Self {
        Twin(Lane::load(&values[..8]), Lane::load(&values[8..]))
    }

    #[inline(always)]
    fn to_array(self) -> [f64; 16] {
        let mut values = [0.0; 16];
        self.0.store(&mut values[..8]);
        self.1.store(&mut values[8..]);
        values
    }

    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> f64) -> Self {
        let low = Lane::from_fn(&mut value);
        Twin(low, Lane::from_fn(|k| value(8 + k)))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Twin(Lane::sqrt(self.0), Lane::sqrt(self.1))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Twin(Lane::abs(self.0), Lane::abs(self.1))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        TwinMask(self.0.lt(other.0), self.1.lt(other.1))
    }

    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        TwinMask(self.0.le(other.0), self.1.le(other.1))
    }

    #[inline(always)]
    fn same(self, other: Self) -> Self::Mask {
        TwinMask(self.0.same(other.0), self.1.same(other.1))
    }

    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Twin(Lane::select(mask.0, yes.0, no.0), Lane::select(mask.1, yes.1, no.1))
    }
}
