//! Sine and cosine by polynomial, for every lane and precision.
//!
//! The standard library's functions belong to the platform and `wide`'s give
//! other bits with and without fused multiply-add. Here there are only
//! `+ − × ÷`, comparisons and selections, so a result has the same bits in
//! every lane, on every machine.

use crate::compensated::{two_product, two_sum};
use crate::lane::{Lane, Mask};
use crate::numbers::array::Each;
use crate::real::Real;

/// Sine and cosine of an angle in rad.
///
/// With `ε` the distance from 1 to the next number, `q` =
/// [`Real::MOST_QUARTER_TURNS`] (2¹⁸ for `f32`, 2⁴⁷ for `f64`) and `d` = 1/ε
/// (2²³, 2⁵²):
///
/// | angle up to | error |
/// |---|---|
/// | `q·π/2` (4·10⁵, 2·10¹⁴) | below 0.81 units in the last place, also next to a multiple of π/2 |
/// | `q·d/8` (2·10¹¹, 7·10²⁸) | absolute, below ε |
/// | the greatest number | taken for the angle 0: numbers are whole turns apart |
///
/// NaN and infinity give NaN; the sine of −0 is −0.
///
/// ```
/// use carom::trigonometry::sin_cos;
/// let (sine, cosine) = sin_cos(core::f64::consts::PI);
/// assert_eq!(sine, 1.2246467991473532e-16); // what the f64 nearest to π leaves out of π
/// assert_eq!(cosine, -1.0);
/// ```
#[inline(always)]
pub fn sin_cos<L: Lane>(x: L) -> (L, L) {
    let (sine, cosine) = sin_cos_of_sum(x, L::ZERO);
    (L::select(x.same(L::ZERO), x, sine), cosine)
}

/// Sine and cosine of `head + tail`, an angle known to twice the digits, in
/// rad.
///
/// `tail` is what rounding left out of `head`, a unit or two of its last place.
/// The bounds are those of [`sin_cos`]; the sine of −0 is 0.
///
/// ```
/// use carom::trigonometry::sin_cos_of_sum;
/// let tail_of_pi = 1.2246467991473532e-16;
/// let (sine, _) = sin_cos_of_sum(core::f64::consts::PI, tail_of_pi);
/// assert!(sine.abs() < 1e-32);
/// ```
#[inline(always)]
pub fn sin_cos_of_sum<L: Lane>(head: L, tail: L) -> (L, L) {
    let [quarter_turn, ..] = L::Scalar::QUARTER_TURN;
    let is_far = head.abs().gt(L::splat(L::Scalar::MOST_QUARTER_TURNS * quarter_turn));
    let (head, tail) = if is_far.any() {
        let (near_head, near_tail) = without_whole_turns(head, tail);
        (L::select(is_far, near_head, head), L::select(is_far, near_tail, tail))
    } else {
        (head, tail)
    };

    let quarters = (head * L::splat(L::Scalar::ONE / quarter_turn)).nearest_whole();
    let (head, tail) = without_quarter_turns(head, tail, quarters);
    let (sine, cosine) = near_zero(head, tail);

    // −2, −1, 0, 1 or 2 quarter turns.
    let quarters = quarters - (quarters * L::ratio(1, 4)).nearest_whole() * L::ratio(4, 1);
    let is_odd = quarters.abs().same(L::ONE);
    let above = |bound| quarters.gt(L::ratio(bound, 2));
    let below = |bound| quarters.lt(L::ratio(bound, 2));
    let (s, c) = (L::select(is_odd, cosine, sine), L::select(is_odd, sine, cosine));
    (L::select(above(3) | below(-1), -s, s), L::select(above(1) | below(-3), -c, c))
}

/// Sine and cosine of `head + tail` up to 9/16 of a quarter turn: the leading
/// terms added last and with the error of their own sum, after `__kernel_sin`
/// and `__kernel_cos` of fdlibm (Sun Microsystems, 1993).
#[inline(always)]
fn near_zero<L: Lane>(head: L, tail: L) -> (L, L) {
    let square = head * head;
    let half_square = square * L::ratio(1, 2);
    let rough_cosine = L::ONE - half_square;
    let sine = head + (tail * rough_cosine - head * (square * alternating_series(square, 3)));
    let cosine = rough_cosine
        + (((L::ONE - rough_cosine) - half_square)
            + (square * (square * alternating_series(square, 4)) - head * tail));
    (sine, cosine)
}

/// An angle as head and tail, less a whole number of quarter turns that leaves
/// little of it: the first difference is exact (Sterbenz).
#[inline(always)]
fn without_quarter_turns<L: Lane>(head: L, tail: L, quarters: L) -> (L, L) {
    let [first, second, third] = L::Scalar::QUARTER_TURN.each(L::splat);
    let (product, error) = two_product(quarters, first);
    let (head, tail) = two_sum(head - product, tail - error);
    let (product, error) = two_product(quarters, second);
    let (head, lost) = two_sum(head, -product);
    two_sum(head, tail + ((lost - error) - quarters * third))
}

/// An angle of more quarter turns than can be counted, less whole turns: few
/// enough quarter turns are left, or none where the angle is too great to count
/// even turns.
#[cold]
fn without_whole_turns<L: Lane>(head: L, tail: L) -> (L, L) {
    let [quarter_turn, ..] = L::Scalar::QUARTER_TURN;
    let four = L::ratio(4, 1);
    let turns = (head * L::splat(L::Scalar::ratio(1, 4) / quarter_turn)).nearest_whole();
    let (near, rest) = without_quarter_turns(head, tail, turns * four);
    let most = L::Scalar::MOST_QUARTER_TURNS * L::Scalar::WHOLE_FROM * L::Scalar::ratio(1, 8);
    let is_lost = head.abs().gt(L::splat(most));
    // Infinity times 0 is NaN.
    (L::select(is_lost, head * L::ZERO, near), L::select(is_lost, L::ZERO, rest))
}

/// `1 − sin(h)/h` from `h²`, for `|h|` up to π/4. Relative error a few ε.
///
/// ```
/// use carom::trigonometry::sine_ratio_deficit;
/// let deficit: f64 = sine_ratio_deficit(6e-20);
/// assert!((deficit - 1e-20).abs() < 1e-35);
/// ```
#[inline(always)]
pub fn sine_ratio_deficit<L: Lane>(square: L) -> L {
    square * alternating_series(square, 3)
}

/// `1 − cos(h)` from `h²`, for `|h|` up to π/4. Relative error a few ε.
///
/// ```
/// use carom::trigonometry::cosine_deficit;
/// assert_eq!(cosine_deficit(2e-20), 1e-20); // 1 − 1.0 would be 0
/// ```
#[inline(always)]
pub fn cosine_deficit<L: Lane>(square: L) -> L {
    square * alternating_series(square, 2)
}

/// `1/n! − z/(n+2)! + z²/(n+4)! − …`: cosine (`n` = 0) and sine (1) of `√z`,
/// and what is left of them after their leading terms.
#[inline(always)]
fn alternating_series<L: Lane>(z: L, n: usize) -> L {
    let terms = L::Scalar::inverse_factorials();
    let mut k = terms.len() - 1 - (terms.len() - 1 - n) % 2;
    let mut sum = L::splat(terms[k]);
    while k > n {
        k -= 2;
        sum = L::splat(terms[k]) - z * sum;
    }
    sum
}
