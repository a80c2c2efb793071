//! Exact sum: the sum of doubles, whatever their order.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use crate::numbers::array::Each;

/// Binary digits of a limb.
const DIGITS: u32 = 32;

/// Limbs for all digits of all doubles, and for the carries beyond.
const LIMBS: usize = 69;

/// Terms after which carries are passed on: each adds less than 2³² to a limb of 63
/// digits.
const MOST_PENDING: u32 = 1 << 30;

/// A sum of doubles without any rounding, so that it does not depend on their order: a
/// term can be taken back by adding its negative, and sums of parts can be merged (a
/// small superaccumulator: R. M. Neal, *Fast exact summation using small and large
/// superaccumulators*, 2015). Terms that are not finite add up to what is not finite.
///
/// ```
/// use carom::compensated::ExactSum;
/// let mut sum = ExactSum::default();
/// [1e300, 1.0, 1e-300, -1e300, -1e-300].into_iter().for_each(|term| sum.add(term));
/// assert_eq!(sum.value(), 1.0);
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(into = "Digits", try_from = "Digits"))]
pub struct ExactSum {
    /// Digits from that of 2⁻¹⁰⁷⁴ on, each limb with those that it has to pass on.
    limbs: [i64; LIMBS],
    pending: u32,
    /// The sum of the terms that are not finite.
    boundless: f64,
}

impl Default for ExactSum {
    fn default() -> Self {
        Self { limbs: [0; LIMBS], pending: 0, boundless: 0.0 }
    }
}

impl ExactSum {
    /// Adds a term.
    #[inline]
    pub fn add(&mut self, term: f64) {
        let bits = term.to_bits();
        let exponent = (bits >> 52) as usize & 0x7FF;
        if exponent == 0x7FF {
            self.boundless += term;
            return;
        }
        let hidden = u64::from(exponent != 0) << 52;
        let mantissa = bits & ((1 << 52) - 1) | hidden;
        let place = exponent.saturating_sub(1);
        let shifted = u128::from(mantissa) << (place % DIGITS as usize);
        let first = place / DIGITS as usize;
        for (k, limb) in self.limbs[first..first + 3].iter_mut().enumerate() {
            let digits = i64::from((shifted >> (DIGITS * k as u32)) as u32);
            *limb += if bits >> 63 == 0 { digits } else { -digits };
        }
        self.pending += 1;
        if self.pending == MOST_PENDING {
            self.carry();
        }
    }

    /// Adds all terms of another sum.
    pub fn merge(&mut self, other: &Self) {
        let mut other = other.clone();
        other.carry();
        self.carry();
        for (limb, more) in self.limbs.iter_mut().zip(other.limbs) {
            *limb += more;
        }
        self.pending = 1;
        self.boundless += other.boundless;
    }

    /// Passes on what limbs have beyond their digits.
    fn carry(&mut self) {
        let mut carried = 0;
        let (last, others) = self.limbs.split_last_mut().unwrap_or((&mut carried, &mut []));
        let mut carry = 0;
        for limb in others {
            let whole = *limb + carry;
            carry = whole >> DIGITS;
            *limb = whole & ((1 << DIGITS) - 1);
        }
        *last += carry;
        self.pending = 0;
    }

    /// Whether the sum is negative, and the limbs of its magnitude, of [`DIGITS`] each.
    fn magnitude(&self) -> (bool, [i64; LIMBS]) {
        let mut sum = self.clone();
        sum.carry();
        let is_negative = sum.limbs[LIMBS - 1] < 0;
        if is_negative {
            sum.limbs.iter_mut().for_each(|limb| *limb = -*limb);
            sum.carry();
        }
        (is_negative, sum.limbs)
    }

    /// The sum, rounded once, to nearest.
    #[must_use]
    pub fn value(&self) -> f64 {
        if self.boundless != 0.0 || self.boundless.is_nan() {
            return self.boundless;
        }
        let (is_negative, limbs) = self.magnitude();
        let Some(top) = limbs.iter().rposition(|&limb| limb != 0) else { return 0.0 };
        // Three limbs hold more digits than a double; one digit stands for the rest.
        let lowest = top.saturating_sub(2);
        let mut digits = 0_u128;
        for &limb in limbs[lowest..=top].iter().rev() {
            digits = digits << DIGITS | limb as u128;
        }
        digits |= u128::from(limbs[..lowest].iter().any(|&limb| limb != 0));
        let exponent = (DIGITS as usize * lowest) as i32 - 1074;
        // In two steps: one power of two may be out of range.
        let [one, other] = [exponent / 2, exponent - exponent / 2].each(|k| 2.0_f64.powi(k));
        let magnitude = digits as f64 * one * other;
        if is_negative { -magnitude } else { magnitude }
    }
}

/// What files keep of a sum: its sign, the number of its first limb that is not 0, the
/// limbs from there on, and the sum of the terms that are not finite.
#[cfg(feature = "files")]
#[derive(Serialize, Deserialize)]
struct Digits(bool, u8, Vec<u32>, f64);

#[cfg(feature = "files")]
impl From<ExactSum> for Digits {
    fn from(sum: ExactSum) -> Self {
        let (is_negative, limbs) = sum.magnitude();
        let is_used = |limb: &i64| *limb != 0;
        let first = limbs.iter().position(is_used).unwrap_or(0);
        let end = limbs.iter().rposition(is_used).map_or(first, |last| last + 1);
        let used = limbs[first..end].iter().map(|&limb| limb as u32).collect();
        Self(is_negative, first as u8, used, sum.boundless)
    }
}

#[cfg(feature = "files")]
impl TryFrom<Digits> for ExactSum {
    type Error = &'static str;

    fn try_from(Digits(is_negative, first, used, boundless): Digits) -> Result<Self, Self::Error> {
        let mut sum = Self { boundless, pending: 1, ..Self::default() };
        let first = usize::from(first);
        let limbs = sum.limbs.get_mut(first..first.saturating_add(used.len()));
        let limbs = limbs.ok_or("a sum that has more digits than sums have")?;
        for (limb, digits) in limbs.iter_mut().zip(used) {
            *limb = if is_negative { -i64::from(digits) } else { i64::from(digits) };
        }
        Ok(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn of(terms: impl IntoIterator<Item = f64>) -> ExactSum {
        let mut sum = ExactSum::default();
        terms.into_iter().for_each(|term| sum.add(term));
        sum
    }

    #[test]
    fn one_term_is_itself() {
        let edges = [0.0, 1.0, 0.1, f64::MIN_POSITIVE, 5e-324, f64::MAX, 1e-310, 3e200];
        for term in edges.into_iter().flat_map(|term| [term, -term]) {
            assert_eq!(of([term]).value(), term);
        }
    }

    /// In any order, in any parts, with terms that are taken back.
    #[test]
    fn order_and_parts_change_nothing() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for _ in 0..300 {
            let mut terms: Vec<f64> = (0..100)
                .map(|_| {
                    random.random_range(-1.0..1.0) * 2.0_f64.powi(random.random_range(-90..90))
                })
                .collect();
            let expected = of(terms.iter().copied()).value();
            let added: i128 = terms.iter().map(|term| (term * 2.0_f64.powi(30)) as i128).sum();
            let error = expected - added as f64 / 2.0_f64.powi(30);
            assert!(error.abs() <= 1e-7 + expected.abs() * f64::EPSILON, "{error:e}");
            terms.reverse();
            terms.rotate_left(37);
            let mut sum = of(terms[..40].iter().copied());
            sum.merge(&of(terms[40..].iter().copied()));
            assert_eq!(sum.value(), expected);
            terms[1..].iter().for_each(|term| sum.add(-term));
            assert_eq!(sum.value(), terms[0]);
        }
    }

    /// A sum that was in a file goes on as if it had not been.
    #[cfg(feature = "files")]
    #[test]
    fn files_keep_every_digit() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        for terms in 0..200 {
            let mut draw =
                || random.random_range(-1.0..1.0) * 2.0_f64.powi(random.random_range(-1100..1000));
            let (sum, more) = (of((0..terms).map(|_| draw())), draw());
            let bytes = postcard::to_stdvec(&sum).unwrap();
            let mut read: ExactSum = postcard::from_bytes(&bytes).unwrap();
            assert_eq!(read.value().to_bits(), sum.value().to_bits());
            let mut sum = sum;
            [&mut read, &mut sum].into_iter().for_each(|sum| sum.add(more));
            assert_eq!(read.value().to_bits(), sum.value().to_bits());
        }
        let infinite = postcard::to_stdvec(&of([f64::INFINITY])).unwrap();
        assert_eq!(postcard::from_bytes::<ExactSum>(&infinite).unwrap().value(), f64::INFINITY);
        let too_many = postcard::to_stdvec(&(false, 60_u8, vec![1_u32; 60], 0.0)).unwrap();
        assert!(postcard::from_bytes::<ExactSum>(&too_many).is_err());
    }

    #[test]
    fn rounds_once() {
        let next = 1.0 + f64::EPSILON;
        assert_eq!(of([1.0, f64::EPSILON / 2.0]).value(), 1.0);
        assert_eq!(of([1.0, f64::EPSILON / 2.0, 1e-300]).value(), next);
        assert_eq!(of([f64::MAX, f64::MAX, -f64::MAX]).value(), f64::MAX);
        assert_eq!(of([f64::INFINITY, 1.0]).value(), f64::INFINITY);
        assert!(of([f64::INFINITY, f64::NEG_INFINITY]).value().is_nan());
    }
}
