//! Double-double: a precision of 105 binary digits, for reference solutions.

mod decimal;

use core::cmp::Ordering;
use core::fmt;
use core::num::ParseFloatError;
use core::ops::{Add, Div, Mul, Neg, Rem, Sub};
use core::str::FromStr;
use std::sync::LazyLock;

use faer::fx128;
use num_traits::{FloatErrorKind, Num, One, Zero};

use super::Real;
use crate::lane::Lane;

/// The unevaluated sum of two `f64`, the second at most half a unit in the last
/// place of the first: 105 binary digits in the range of `f64` (Dekker 1971).
///
/// `+ − × ÷ √` are right to about 10⁻³² of the result, sine and cosine to
/// 1.3·10⁻³² absolutely (the worst of 349 hard and random arguments up to 10¹⁴, in
/// `tests/study`): enough to measure the error of `f64` by, at some forty times
/// its cost. All of
/// the crate's formulas take it, one at a time: its packs are lanes of one.
/// Numbers below 10⁻²⁹⁰ lose digits, as their second parts leave the range, and
/// square roots above 10³⁰⁰ are none. Infinity and what comes of it is as in `f64`.
///
/// ```
/// use carom::DoubleDouble;
/// use carom::lane::Lane;
///
/// let third = DoubleDouble::ratio(1, 3);
/// let rest = third + third + third - DoubleDouble::ONE;
/// assert!(rest.high().abs() < 1e-31);
/// assert!(third.to_string().starts_with("0.3333333333333333333333333333333"));
/// assert_eq!(third.to_string().parse(), Ok(third));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble(fx128);

impl DoubleDouble {
    /// `high + low`, where `low` is no more than half a unit in the last place
    /// of `high`.
    #[must_use]
    pub const fn new(high: f64, low: f64) -> Self {
        Self(fx128 { 0: high, 1: low })
    }

    /// The nearest `f64`.
    #[must_use]
    pub const fn high(self) -> f64 {
        self.0.0
    }

    /// What that leaves out.
    #[must_use]
    pub const fn low(self) -> f64 {
        self.0.1
    }
}

macro_rules! operations {
    ($($trait:ident::$method:ident = $apply:expr, $plain:expr),*) => {$(
        impl $trait for DoubleDouble {
            type Output = Self;

            // As calls: what runs in double-double was a third of the library's machine code.
            #[inline(never)]
            fn $method(self, other: Self) -> Self {
                let apply: fn(fx128, fx128) -> fx128 = $apply;
                let plain: fn(f64, f64) -> f64 = $plain;
                let plain = plain(self.high(), other.high());
                // What infinities leave over is no number: there the first
                // parts say it all, as 1/0 and 1/∞ in `f64`.
                if !plain.is_finite() || !other.high().is_finite() {
                    return Self::new(plain, 0.0);
                }
                Self(apply(self.0, other.0))
            }
        }
    )*};
}

// The operators of `fx128` add by an estimate that is no good for a difference
// of almost equal numbers.
operations!(
    Add::add = fx128::add_accurate,
    |a, b| a + b,
    Sub::sub = fx128::sub_accurate,
    |a, b| a - b,
    Mul::mul = fx128::mul,
    |a, b| a * b,
    Div::div = fx128::div,
    |a, b| a / b,
    Rem::rem = |a, b| a % b,
    |a, b| a % b
);

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(other.0)
    }
}

/// The decimal digits that read back as the same number: 32 or 33 of most, more where the
/// second half is 0 or small, such as that of `0.1_f64`. With a precision, those of the
/// nearest `f64`.
impl fmt::Display for DoubleDouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match f.precision() {
            Some(_) => self.high().fmt(f),
            None => f.pad(&decimal::text(self.halves())),
        }
    }
}

/// The nearest double-double, of any number of digits.
impl FromStr for DoubleDouble {
    type Err = ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        decimal::halves(text).map(Self::from_halves)
    }
}

impl fmt::LowerExp for DoubleDouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:e}{:+e}", self.0.0, self.0.1)
    }
}

impl Zero for DoubleDouble {
    fn zero() -> Self {
        Self::ZERO
    }

    fn is_zero(&self) -> bool {
        *self == Self::ZERO
    }
}

impl One for DoubleDouble {
    fn one() -> Self {
        Self::ONE
    }
}

impl Num for DoubleDouble {
    type FromStrRadixErr = num_traits::ParseFloatError;

    // Of ten digits only: nothing is written in any other.
    fn from_str_radix(text: &str, radix: u32) -> Result<Self, Self::FromStrRadixErr> {
        let invalid = || num_traits::ParseFloatError { kind: FloatErrorKind::Invalid };
        if radix != 10 {
            return Err(invalid());
        }
        text.parse().map_err(|_| invalid())
    }
}

impl Lane for DoubleDouble {
    type Scalar = Self;
    type Mask = bool;
    type Array = [Self; 1];

    const WIDTH: usize = 1;
    const ZERO: Self = Self::new(0.0, 0.0);
    const ONE: Self = Self::new(1.0, 0.0);

    fn splat(value: Self) -> Self {
        value
    }

    fn from_array([value]: [Self; 1]) -> Self {
        value
    }

    fn to_array(self) -> [Self; 1] {
        [self]
    }

    fn arrays(column: &[Self]) -> (&[[Self; 1]], &[Self]) {
        column.as_chunks()
    }

    fn arrays_mut(column: &mut [Self]) -> (&mut [[Self; 1]], &mut [Self]) {
        column.as_chunks_mut()
    }

    fn from_fn(mut value: impl FnMut(usize) -> Self) -> Self {
        value(0)
    }

    #[inline(never)]
    fn sqrt(self) -> Self {
        match self.high() {
            high if high > 0.0 && high < f64::INFINITY => Self(self.0.sqrt()),
            high => Self::new(high.sqrt(), 0.0),
        }
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn lt(self, other: Self) -> bool {
        self < other
    }

    fn le(self, other: Self) -> bool {
        self <= other
    }

    fn same(self, other: Self) -> bool {
        self == other
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    // The sum with a great number, which rounds other precisions, is exact here:
    // without this, bodies in a periodic box were parts of boxes away.
    fn nearest_small_whole(self) -> Self {
        self.nearest_whole()
    }

    // A great number added and taken off again leaves the fraction in the low
    // half.
    fn nearest_whole(self) -> Self {
        let fx128 { 0: high, 1: low } = self.0;
        let whole = high.round_ties_even();
        if whole == high {
            Self::new(high, 0.0) + Self::new(low.round_ties_even(), 0.0)
        } else if (high - whole).abs() == 0.5 && low != 0.0 {
            Self::new(high + 0.5_f64.copysign(low), 0.0)
        } else {
            Self::new(whole, 0.0)
        }
    }
}

impl Real for DoubleDouble {
    type Pack4 = Self;
    type Pack8 = Self;
    type Pack16 = Self;
    type Coarse = f64;
    type Block = Self;

    const NAME: &'static str = "dd";
    const EPSILON: Self = Self::new(f64::EPSILON * f64::EPSILON, 0.0);
    const ROUNDING_MAGIC: Self = Self::ZERO;
    const WHOLE_FROM: Self = Self::new(1.0 / (f64::EPSILON * f64::EPSILON), 0.0);
    const SPLITTER: Self = Self::ONE;
    const MOST_QUARTER_TURNS: Self = Self::new((1_u64 << 47) as f64, 0.0);
    const QUARTER_TURN: [Self; 3] = [
        Self::new(core::f64::consts::FRAC_PI_2, 0.0),
        Self::new(6.123233995736766e-17, 0.0),
        Self::new(-1.4973849048591698e-33, 5.562271104316826e-50),
    ];

    fn inverse_factorials() -> &'static [Self] {
        static TABLE: LazyLock<[DoubleDouble; 30]> = LazyLock::new(|| {
            let mut factorial = DoubleDouble::ONE;
            let mut table = [DoubleDouble::ONE; 30];
            for (inverse, n) in table[1..].iter_mut().zip(1..) {
                factorial = factorial * DoubleDouble::whole(n);
                *inverse = DoubleDouble::ONE / factorial;
            }
            table
        });
        &*TABLE
    }

    fn whole(value: i32) -> Self {
        Self::from_f64(f64::from(value))
    }

    fn from_f64(value: f64) -> Self {
        Self::new(value, 0.0)
    }

    fn to_f64(self) -> f64 {
        self.0.0
    }

    fn halves(self) -> [f64; 2] {
        [self.high(), self.low()]
    }

    fn from_halves([high, low]: [f64; 2]) -> Self {
        Self::new(high, low)
    }

    fn cast<B: Real>(self) -> B {
        let high = B::from_f64(self.high());
        // Nothing to add keeps the sign of −0, and infinity.
        if self.low() == 0.0 || self.low().is_nan() { high } else { high + B::from_f64(self.low()) }
    }

    fn whole_part(self) -> i64 {
        self.0.0 as i64
    }

    fn flat(blocks: &[Self]) -> &[Self] {
        blocks
    }

    fn flat_mut(blocks: &mut [Self]) -> &mut [Self] {
        blocks
    }

    fn block(value: Self) -> Self {
        value
    }

    fn write_bits(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.0.0.to_le_bytes());
        // Of a second half of 0 the sign says nothing: the bits are those of the number.
        bytes.extend_from_slice(&(self.0.1 + 0.0).to_le_bytes());
    }
}
