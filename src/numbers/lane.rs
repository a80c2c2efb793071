//! Lanes: `N` reals that go through the same formula at once.
//!
//! A formula of this crate is one function, generic over [`Lane`]. With a lane
//! type of one real (`f32`, `f64`) it is the scalar reference path; with a pack
//! of `wide` it works on 4 to 16 bodies at a time. Every operation of the trait
//! is exact or correctly rounded, and nothing fuses or reorders, so a pack
//! gives in each lane the bits that the scalar path gives.
//!
//! ```
//! use carom::lane::Lane;
//! use wide::f64x4;
//!
//! /// A formula, written once.
//! fn speed_squared<L: Lane>(x: L, y: L) -> L {
//!     x * x + y * y
//! }
//! assert_eq!(speed_squared(3.0, 4.0), 25.0);
//! assert_eq!(speed_squared(f64x4::splat(3.0), f64x4::splat(4.0)).to_array(), [25.0; 4]);
//! ```

mod pack;
mod twin;

use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use crate::numbers::array;
use crate::real::Real;

pub use twin::Twin;

/// One truth value for each lane.
///
/// ```
/// use carom::lane::{Lane, Mask};
/// use wide::f64x4;
///
/// let is_less = Lane::lt(f64x4::new([1.0, 5.0, 2.0, 9.0]), f64x4::splat(4.0));
/// assert_eq!(is_less.bits(), 0b0101);
/// assert!(is_less.any() && !is_less.all());
/// ```
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Whether any lane is true.
    fn any(self) -> bool;

    /// Whether all lanes are true.
    fn all(self) -> bool;

    /// The lanes as bits, lane 0 lowest; bits past the last lane are 0.
    fn bits(self) -> u32;
}

/// The numbers of the [bits](Mask::bits) that are set, the least first.
#[inline(always)]
pub(crate) fn ones(bits: impl Into<u64>) -> impl Iterator<Item = usize> {
    let mut bits = bits.into();
    core::iter::from_fn(move || {
        let first = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (first < u64::BITS).then_some(first as usize)
    })
}

/// `WIDTH` reals of type [`Lane::Scalar`], operated on together.
///
/// Comparisons are false where an operand is NaN, as they are for the
/// primitive types.
///
/// ```
/// use carom::lane::{Lane, Mask};
/// use wide::f64x4;
///
/// fn distance<L: Lane>(a: L, b: L) -> L {
///     (a - b).abs()
/// }
/// let far = distance(f64x4::from_fn(|k| k as f64), Lane::splat(2.0));
/// assert_eq!(far.to_array(), [2.0, 1.0, 0.0, 1.0]);
/// assert_eq!(f64x4::from_array([4.0, 9.0, 1.0, 0.0]).sqrt().to_array(), [2.0, 3.0, 1.0, 0.0]);
/// assert_eq!((far.lt(f64x4::ONE).bits(), far.le(f64x4::ONE).bits()), (0b0100, 0b1110));
/// assert!(!far.same(f64x4::ZERO).all());
/// assert_eq!((f64x4::WIDTH, <f64 as Lane>::WIDTH), (4, 1));
/// ```
pub trait Lane:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The precision.
    type Scalar: Real;
    /// What a comparison gives.
    type Mask: Mask;
    /// `[Scalar; WIDTH]`.
    type Array: Copy + Send + Sync + AsRef<[Self::Scalar]> + AsMut<[Self::Scalar]>;

    /// How many reals there are in a lane.
    const WIDTH: usize;

    /// 0 in every lane.
    const ZERO: Self;

    /// 1 in every lane.
    const ONE: Self;

    /// The same value in every lane.
    fn splat(value: Self::Scalar) -> Self;

    /// The lanes from an array.
    fn from_array(values: Self::Array) -> Self;

    /// The lanes as an array.
    fn to_array(self) -> Self::Array;

    /// Splits a column into whole arrays and the tail that fills none.
    ///
    /// ```
    /// use carom::lane::Lane;
    /// use wide::f64x4;
    ///
    /// let (arrays, tail) = f64x4::arrays(&[1.0, 2.0, 3.0, 4.0, 5.0]);
    /// assert_eq!((arrays, tail), ([[1.0, 2.0, 3.0, 4.0]].as_slice(), [5.0].as_slice()));
    /// ```
    fn arrays(column: &[Self::Scalar]) -> (&[Self::Array], &[Self::Scalar]);

    /// Splits a column into whole arrays and the tail that fills none.
    fn arrays_mut(column: &mut [Self::Scalar]) -> (&mut [Self::Array], &mut [Self::Scalar]);

    /// Lane `k` is `value(k)`.
    fn from_fn(value: impl FnMut(usize) -> Self::Scalar) -> Self;

    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;

    /// `self ≤ other`.
    fn le(self, other: Self) -> Self::Mask;

    /// `self = other`; zeros of either sign are equal.
    fn same(self, other: Self) -> Self::Mask;

    /// `yes` where the mask is true, `no` elsewhere.
    ///
    /// ```
    /// use carom::lane::Lane;
    /// use wide::f64x4;
    ///
    /// fn positive_part<L: Lane>(x: L) -> L {
    ///     L::select(x.gt(L::ZERO), x, L::ZERO)
    /// }
    /// let x = f64x4::new([-1.0, 2.0, 0.0, 3.0]);
    /// assert_eq!(positive_part(x).to_array(), [0.0, 2.0, 0.0, 3.0]);
    /// ```
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// `self > other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }

    /// `self ≥ other`.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }

    /// The constant `numerator/denominator`, rounded in the lane's own
    /// precision.
    ///
    /// ```
    /// use carom::lane::Lane;
    /// assert_eq!(f32::ratio(1, 10), 0.1);
    /// assert_eq!(f64::ratio(1, 10), 0.1);
    /// ```
    #[inline(always)]
    fn ratio(numerator: i32, denominator: i32) -> Self {
        Self::splat(Self::Scalar::whole(numerator) / Self::Scalar::whole(denominator))
    }

    /// The lesser one by comparison: `other` where either is NaN.
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// The greater one by comparison: `other` where either is NaN.
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        Self::select(self.gt(other), self, other)
    }

    /// The nearest whole number, ties to even; the value itself from
    /// [`Real::WHOLE_FROM`] up, where every number is whole.
    ///
    /// ```
    /// use carom::lane::Lane;
    /// assert_eq!([2.4, 2.5, -0.7, 1e300].map(f64::nearest_whole), [2.0, 2.0, -1.0, 1e300]);
    /// ```
    #[inline(always)]
    fn nearest_whole(self) -> Self {
        let is_small = self.abs().lt(Self::splat(Self::Scalar::WHOLE_FROM));
        Self::select(is_small, self.nearest_small_whole(), self)
    }

    /// The nearest whole number, ties to even, of a value less than half of
    /// [`Real::WHOLE_FROM`].
    #[inline(always)]
    fn nearest_small_whole(self) -> Self {
        // Adding 1.5·2^(digits−1) leaves no digit after the point.
        let magic = Self::splat(Self::Scalar::ROUNDING_MAGIC);
        (self + magic) - magic
    }

    /// The first `WIDTH` values of a column.
    ///
    /// # Panics
    /// If the column is shorter than `WIDTH`.
    #[inline(always)]
    fn load(column: &[Self::Scalar]) -> Self {
        Self::from_array(Self::arrays(&column[..Self::WIDTH]).0[0])
    }

    /// Writes the lanes to the first `WIDTH` elements of a column.
    ///
    /// ```
    /// use carom::lane::Lane;
    /// use wide::f64x4;
    ///
    /// let mut column = [1.0, 2.0, 3.0, 4.0, 5.0];
    /// let doubled = f64x4::load(&column) + f64x4::load(&column);
    /// doubled.store(&mut column);
    /// assert_eq!(column, [2.0, 4.0, 6.0, 8.0, 5.0]);
    /// ```
    ///
    /// # Panics
    /// If the column is shorter than `WIDTH`.
    #[inline(always)]
    fn store(self, column: &mut [Self::Scalar]) {
        // As an array: copied as a slice it would go real by real.
        Self::arrays_mut(&mut column[..Self::WIDTH]).0[0] = self.to_array();
    }

    /// Up to `WIDTH` values of a column; lanes past its end take `padding`.
    ///
    /// ```
    /// use carom::lane::Lane;
    /// use wide::f64x4;
    /// assert_eq!(f64x4::load_tail(&[1.0, 2.0], 0.0).to_array(), [1.0, 2.0, 0.0, 0.0]);
    /// ```
    #[inline(always)]
    fn load_tail(column: &[Self::Scalar], padding: Self::Scalar) -> Self {
        Self::from_fn(|k| column.get(k).copied().unwrap_or(padding))
    }

    /// Lane `k` is `column[indices[k]]`.
    ///
    /// ```
    /// use carom::lane::Lane;
    /// use wide::f64x4;
    ///
    /// let lanes = f64x4::gather(&[10.0, 20.0, 30.0], &[2, 0, 0, 1]);
    /// assert_eq!(lanes.to_array(), [30.0, 10.0, 10.0, 20.0]);
    /// ```
    ///
    /// # Panics
    /// If there are fewer than `WIDTH` indices, or one is past the column's end.
    #[inline(always)]
    fn gather(column: &[Self::Scalar], indices: &[u32]) -> Self {
        let indices = &indices[..Self::WIDTH];
        Self::from_fn(|k| column[indices[k] as usize])
    }

    /// Transposes records of eight reals: lane `k` of result `j` is
    /// `records[k][j]`.
    ///
    /// # Panics
    /// If there are fewer than `WIDTH` records.
    #[inline(always)]
    fn transpose(records: &[&[Self::Scalar; 8]]) -> [Self; 8] {
        let records = &records[..Self::WIDTH];
        array::from_fn(|j| Self::from_fn(|k| records[k][j]))
    }
}
