//! A sum of many numbers without the rounding errors of many numbers.

use super::two_sum;

/// A running sum in `f64` that carries what each addition rounds off.
///
/// The error of the value is about one rounding of it, plus terms of second
/// order, for any number of terms (Neumaier, *Zeitschrift für Angewandte
/// Mathematik und Mechanik* 54, 1974).
///
/// ```
/// use carom::compensated::CompensatedSum;
/// let terms = [1.0, 1e100, 1.0, -1e100];
/// assert_eq!(terms.iter().sum::<f64>(), 0.0);
/// assert_eq!(terms.into_iter().collect::<CompensatedSum>().value(), 2.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct CompensatedSum {
    sum: f64,
    rounded_off: f64,
}

impl CompensatedSum {
    /// Adds a term.
    ///
    /// ```
    /// use carom::compensated::CompensatedSum;
    /// let mut sum = CompensatedSum::default();
    /// for _ in 0..10 {
    ///     sum.add(0.1);
    /// }
    /// assert_eq!(sum.value(), 1.0);
    /// ```
    #[inline]
    pub fn add(&mut self, term: f64) {
        let (sum, rounded_off) = two_sum(self.sum, term);
        self.sum = sum;
        self.rounded_off += rounded_off;
    }

    /// The sum of the terms so far.
    #[inline]
    #[must_use]
    pub fn value(&self) -> f64 {
        // A sum that has left the numbers has no remainder to give back.
        if self.sum.is_finite() { self.sum + self.rounded_off } else { self.sum }
    }

    /// What the value leaves out of the sum, as far as it is known.
    ///
    /// ```
    /// use carom::compensated::CompensatedSum;
    /// let sum: CompensatedSum = [1.0, 1e-20].into_iter().collect();
    /// assert_eq!((sum.value(), sum.remainder()), (1.0, 1e-20));
    /// ```
    #[inline]
    #[must_use]
    pub fn remainder(&self) -> f64 {
        if self.sum.is_finite() { (self.sum - self.value()) + self.rounded_off } else { 0.0 }
    }
}

impl FromIterator<f64> for CompensatedSum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::default();
        for term in terms {
            sum.add(term);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_tenths_are_right_to_one_rounding() {
        let terms = core::iter::repeat_n(0.1, 1_000_000);
        let plain: f64 = terms.clone().sum();
        assert!((plain - 100_000.0).abs() > 1e-7);
        assert_eq!(terms.collect::<CompensatedSum>().value(), 100_000.0);
    }

    #[test]
    fn infinity_stays() {
        let sum: CompensatedSum = [1.0, f64::INFINITY, 1.0].into_iter().collect();
        assert_eq!(sum.value(), f64::INFINITY);
    }
}
