//! Sums and products whose rounding error is kept.
//!
//! Exact in round-to-nearest as long as nothing overflows and no error term
//! underflows. A fused multiply-add would give the error of a product in one
//! operation and the same bits, but machines without it would take a hundred.

mod exact;
mod sum;

pub use exact::ExactSum;
pub use sum::CompensatedSum;

use crate::lane::Lane;
use crate::real::Real;

/// `a + b` rounded, and what the rounding left out (Knuth, *The Art of Computer
/// Programming* 2, 4.2.2, theorem B).
///
/// ```
/// use carom::compensated::two_sum;
/// assert_eq!(two_sum(1e20, 1.0), (1e20, 1.0));
/// ```
#[inline(always)]
pub fn two_sum<L: Lane>(a: L, b: L) -> (L, L) {
    let sum = a + b;
    let from_b = sum - a;
    (sum, (a - (sum - from_b)) + (b - from_b))
}

/// `a·b` rounded, and what the rounding left out (Dekker, *Numerische
/// Mathematik* 18, 1971). For factors up to the greatest number over
/// [`Real::SPLITTER`].
///
/// ```
/// use carom::compensated::two_product;
/// let next = 1.0 + f64::EPSILON;
/// assert_eq!(two_product(next, next), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
/// ```
#[inline(always)]
pub fn two_product<L: Lane>(a: L, b: L) -> (L, L) {
    let product = a * b;
    let ((a, a_low), (b, b_low)) = (split(a), split(b));
    (product, (((a * b - product) + a * b_low) + a_low * b) + a_low * b_low)
}

/// A number as a sum of two with half the digits.
#[inline(always)]
fn split<L: Lane>(a: L) -> (L, L) {
    let scaled = a * L::splat(L::Scalar::SPLITTER);
    let high = scaled - (scaled - a);
    (high, a - high)
}
