//! Column: one component of all bodies, aligned and padded for the lanes.

use core::fmt;
use core::ops::{Deref, DerefMut};

use crate::real::Real;

/// `len` reals, aligned to 64 bytes and padded to a multiple of
/// [`WIDEST`](Column::WIDEST), so that a sweep in any lane width needs no tail.
///
/// It dereferences to the `len` reals; the padding holds the value that the
/// column was made with and is only seen through [`padded`](Column::padded).
///
/// ```
/// use carom::column::Column;
///
/// let mut heights = Column::from([1.0, 2.0, 4.0].as_slice());
/// heights[1] = 3.0;
/// assert_eq!(heights.iter().sum::<f64>(), 8.0);
/// ```
#[derive(Clone)]
pub struct Column<T: Real> {
    blocks: Vec<T::Block>,
    len: usize,
}

impl<T: Real> Column<T> {
    /// The widest lane, to a multiple of which a column is padded.
    ///
    /// ```
    /// use carom::column::Column;
    /// assert_eq!(Column::<f64>::new(1, 0.0).padded().len(), Column::<f64>::WIDEST);
    /// ```
    pub const WIDEST: usize = 16;

    /// A column of `len` equal values, the padding included.
    ///
    /// ```
    /// use carom::column::Column;
    /// let column = Column::new(10, 1.5_f32);
    /// assert_eq!(column.len(), 10);
    /// assert_eq!(column.padded().len(), 16);
    /// ```
    #[must_use]
    pub fn new(len: usize, value: T) -> Self {
        let block_len = T::flat(&[T::block(value)]).len();
        let blocks = len.next_multiple_of(Self::WIDEST).div_ceil(block_len);
        Self { blocks: vec![T::block(value); blocks], len }
    }

    /// A column of the given values, padded with `padding`.
    ///
    /// ```
    /// use carom::column::Column;
    /// let squares = Column::from_values((0..10).map(|k| f64::from(k * k)), 0.0);
    /// assert_eq!(squares[3], 9.0);
    /// ```
    #[must_use]
    pub fn from_values(values: impl ExactSizeIterator<Item = T>, padding: T) -> Self {
        let mut column = Self::new(values.len(), padding);
        for (slot, value) in column.iter_mut().zip(values) {
            *slot = value;
        }
        column
    }

    /// Puts values behind the others; what pads a new end is 0.
    pub(crate) fn extend(&mut self, values: &[T]) {
        let (own, len) = (self.len, self.len + values.len());
        let block = T::block(T::ZERO);
        let blocks = len.next_multiple_of(Self::WIDEST).div_ceil(T::flat(&[block]).len());
        self.blocks.resize(blocks, block);
        self.len = len;
        self[own..].copy_from_slice(values);
    }

    /// The values with the padding behind them.
    ///
    /// ```
    /// use carom::column::Column;
    /// let column = Column::from_values([1.0, 2.0].into_iter(), 7.0);
    /// assert_eq!(column.padded()[..3], [1.0, 2.0, 7.0]);
    /// ```
    #[inline]
    #[must_use]
    pub fn padded(&self) -> &[T] {
        T::flat(&self.blocks)
    }

    /// The values with the padding behind them.
    ///
    /// ```
    /// use carom::column::Column;
    /// let mut column = Column::new(2, 0.0_f32);
    /// column.padded_mut().fill(1.0);
    /// assert_eq!((column[1], column.padded()[15]), (1.0, 1.0));
    /// ```
    #[inline]
    #[must_use]
    pub fn padded_mut(&mut self) -> &mut [T] {
        T::flat_mut(&mut self.blocks)
    }

    /// The bytes that the column holds in memory.
    ///
    /// ```
    /// use carom::column::Column;
    /// assert_eq!(Column::new(10, 0.0_f64).bytes(), 16 * 8);
    /// ```
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.blocks.as_slice())
    }
}

/// A copy of the values, padded with 0.
impl<T: Real> From<&[T]> for Column<T> {
    fn from(values: &[T]) -> Self {
        Self::from_values(values.iter().copied(), T::ZERO)
    }
}

/// No values.
impl<T: Real> Default for Column<T> {
    fn default() -> Self {
        Self::new(0, T::ZERO)
    }
}

/// The padding does not count.
impl<T: Real> PartialEq for Column<T> {
    fn eq(&self, other: &Self) -> bool {
        self[..] == other[..]
    }
}

impl<T: Real> Deref for Column<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &T::flat(&self.blocks)[..self.len]
    }
}

impl<T: Real> DerefMut for Column<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut T::flat_mut(&mut self.blocks)[..self.len]
    }
}

impl<T: Real> fmt::Debug for Column<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}
