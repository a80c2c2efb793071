//! Real: the precisions that every formula of this crate is written over.

#[cfg(feature = "study")]
mod double_double;

use core::fmt::{Display, LowerExp};

use num_traits::Num;

use crate::lane::{Lane, Twin};

#[cfg(feature = "study")]
pub use double_double::DoubleDouble;

/// A precision: `f32`, `f64`, or any other number with `+ − × ÷ √`, an order
/// and constants (the double-double of the studies is one).
///
/// A `Real` is a lane of one, so a formula over [`Lane`] takes it as it is:
/// that is the scalar reference path.
///
/// ```
/// use carom::real::Real;
///
/// /// The time of fall from a height, in any precision.
/// fn fall<T: Real>(height: T, gravity: T) -> T {
///     (T::whole(2) * height / gravity).sqrt()
/// }
/// assert_eq!(fall(5.0_f32, 10.0), 1.0);
/// assert_eq!(fall(5.0_f64, 10.0), 1.0);
/// assert_eq!((f32::NAME, f64::from_f64(0.5), 0.5_f32.to_f64()), ("f32", 0.5, 0.5));
/// ```
pub trait Real:
    Lane<Scalar = Self, Mask = bool, Array = [Self; 1]> + Num + PartialOrd + Display + LowerExp
{
    /// Four reals at once.
    type Pack4: Lane<Scalar = Self>;
    /// Eight reals at once.
    type Pack8: Lane<Scalar = Self>;
    /// Sixteen reals at once.
    type Pack16: Lane<Scalar = Self>;
    /// A cache line or more of reals: what a [`Column`](crate::column::Column)
    /// allocates, for its alignment and its padding.
    type Block: Copy + Send + Sync + core::fmt::Debug;

    /// A precision no finer than this one and faster, good enough to rule out
    /// contacts.
    type Coarse: Real;

    /// What the scene file and the summary call this precision.
    const NAME: &'static str;

    /// Distance from 1 to the next greater number.
    const EPSILON: Self;

    /// `1.5 · 2^(digits − 1)`: added and subtracted again, it rounds to a whole
    /// number.
    const ROUNDING_MAGIC: Self;

    /// From here up every number is whole: `2^(digits − 1)`.
    const WHOLE_FROM: Self;

    /// Multiplies a number to split it into two halves of its digits:
    /// `2^⌈digits/2⌉ + 1` (Dekker 1971). 1, which splits nothing, for a number
    /// that is a sum itself and whose products lose too little to matter.
    const SPLITTER: Self;

    /// The most quarter turns that one multiplication `x·2/π` can count to within
    /// 1/16 of one: `2^(digits − 6)`.
    const MOST_QUARTER_TURNS: Self;

    /// π/2 as a sum of three parts, greatest first: three times the digits of
    /// one number, which is what the worst cases of argument reduction need.
    /// Where [`SPLITTER`](Real::SPLITTER) splits nothing, the first two have so
    /// few digits that a product with a count of quarter turns is exact.
    const QUARTER_TURN: [Self; 3];

    /// `1/n!` for `n` from 0, as many as sine and cosine need up to 9/16 of a
    /// quarter turn for an error below a tenth of [`EPSILON`](Real::EPSILON).
    fn inverse_factorials() -> &'static [Self];

    /// A whole number.
    fn whole(value: i32) -> Self;

    /// The nearest number of this precision.
    fn from_f64(value: f64) -> Self;

    /// The nearest `f64`.
    fn to_f64(self) -> f64;

    /// The nearest `f64`, and what that leaves out: all bits of a number of any precision of
    /// this crate.
    ///
    /// ```
    /// use carom::real::Real;
    /// assert_eq!(0.5_f32.halves(), [0.5, 0.0]);
    /// ```
    #[inline(always)]
    fn halves(self) -> [f64; 2] {
        [self.to_f64(), 0.0]
    }

    /// The number of such [`halves`](Real::halves).
    #[inline(always)]
    fn from_halves([high, _]: [f64; 2]) -> Self {
        Self::from_f64(high)
    }

    /// The nearest number of another precision: the same number if that is no
    /// coarser.
    ///
    /// ```
    /// use carom::real::Real;
    /// let third = (1.0_f64 / 3.0).cast::<f32>();
    /// assert_eq!(third, 1.0 / 3.0);
    /// ```
    #[inline(always)]
    fn cast<B: Real>(self) -> B {
        B::from_f64(self.to_f64())
    }

    /// The whole part, towards zero; the nearest `i64` if it is out of range.
    fn whole_part(self) -> i64;

    /// The blocks' reals, one after another.
    fn flat(blocks: &[Self::Block]) -> &[Self];

    /// The blocks' reals, one after another.
    fn flat_mut(blocks: &mut [Self::Block]) -> &mut [Self];

    /// A block of equal reals.
    fn block(value: Self) -> Self::Block;

    /// Whether the number is neither infinite nor NaN.
    #[inline(always)]
    fn is_finite(self) -> bool {
        self * Self::ZERO == Self::ZERO
    }

    /// The bytes of the number, in the order that the state hash reads them.
    fn write_bits(self, bytes: &mut Vec<u8>);
}

/// `1/n!` for `n` from 0: exact factorials, one rounded division.
macro_rules! inverse_factorials {
    ($real:ident, $count:literal) => {{
        const TABLE: [$real; $count] = {
            let mut table = [1.0; $count];
            let mut factorial = 1.0_f64;
            let mut n = 1;
            while n < $count {
                factorial *= n as f64;
                table[n] = (1.0 / factorial) as $real;
                n += 1;
            }
            table
        };
        &TABLE
    }};
}

macro_rules! real {
    ($real:ident, $block:ident, $pack4:ty, $pack8:ty, $pack16:ty, $factorials:literal,
     $splitter:literal, $quarter_turn:expr) => {
        impl Real for $real {
            type Pack4 = $pack4;
            type Pack8 = $pack8;
            type Pack16 = $pack16;
            type Block = wide::$block;
            type Coarse = f32;

            const NAME: &'static str = stringify!($real);
            const EPSILON: Self = $real::EPSILON;
            const ROUNDING_MAGIC: Self = 1.5 / $real::EPSILON;
            const WHOLE_FROM: Self = 1.0 / $real::EPSILON;
            const SPLITTER: Self = $splitter;
            const MOST_QUARTER_TURNS: Self = 1.0 / (32.0 * $real::EPSILON);
            const QUARTER_TURN: [Self; 3] = $quarter_turn;

            #[inline(always)]
            fn inverse_factorials() -> &'static [Self] {
                inverse_factorials!($real, $factorials)
            }

            #[inline(always)]
            fn whole(value: i32) -> Self {
                value as $real
            }

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $real
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn whole_part(self) -> i64 {
                self as i64
            }

            #[inline(always)]
            fn flat(blocks: &[Self::Block]) -> &[Self] {
                wide::bytemuck::cast_slice(blocks)
            }

            #[inline(always)]
            fn flat_mut(blocks: &mut [Self::Block]) -> &mut [Self] {
                wide::bytemuck::cast_slice_mut(blocks)
            }

            #[inline(always)]
            fn block(value: Self) -> Self::Block {
                Lane::splat(value)
            }

            #[inline]
            fn write_bits(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    };
}

real!(
    f32,
    f32x16,
    wide::f32x4,
    wide::f32x8,
    wide::f32x16,
    11,
    4097.0,
    [1.570_796_4, -4.371_139e-8, -1.715_124_5e-15]
);

real!(
    f64,
    f64x8,
    wide::f64x4,
    wide::f64x8,
    Twin<wide::f64x8>,
    18,
    134217729.0,
    [core::f64::consts::FRAC_PI_2, 6.123233995736766e-17, -1.4973849048591698e-33]
);
