//! Taylor march: when a polynomial in time first falls through zero.
//!
//! For what is curved the other way than a convex part, where no plane supports. The gap
//! has the sign of a polynomial `f` of the place, so of degree up to 8 in the time, and
//!
//! ```text
//! loop  f(t + s) = f₀ + f₁ s + … about the place at t, never from afar
//!       gap within rounding, f₁ < 0  →  t
//!       no coefficient but f₀ is negative  →  never
//!       N(h) = Σ max(0, −fₖ) hᵏ, k ≥ 3, for some h
//!       s = first root of f₀ + f₁ s + (f₂ − N(h)/h²) s², at most h
//!       t += s
//! ```
//!
//! For `0 ≤ s ≤ h` is `N(s) ≤ N(h) s²/h²`, and without its positive high terms `f` is
//! less: the quadratic lies below `f` on `0…h`, and its first root does not come after
//! that of `f`. At simple roots the march is of third order, and it steps over near
//! misses at once, since `f₂` keeps its sign.
//!
//! From a zero of `f` the march is that of `f/s`, so that the zero is not found again.

use super::fall::{Start, fall_of_height};
use crate::real::Real;

/// A polynomial in powers of the time since some time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expansion<T, const N: usize> {
    /// Of each power. The first one is the gap by something positive.
    pub(crate) coefficients: [T; N],
    /// What has the sign of the polynomial, length.
    pub(crate) gap: T,
    /// What rounding makes of the gap, length.
    pub(crate) rounding: T,
    /// A time in which much may change.
    pub(crate) period: T,
}

/// A guard against no end by rounding.
const TURNS: usize = 400;

/// The first time at which a polynomial falls through zero and that `counts`; `expand`
/// gives it about any time. From contact, where it is zero now, a gap up to `lift` that
/// rounding has left is none, length.
pub(crate) fn first_fall_of<T: Real, const N: usize>(
    expand: impl Fn(T) -> Expansion<T, N>,
    start: Start,
    lift: T,
    counts: &dyn Fn(T) -> bool,
) -> Option<T> {
    let now = expand(T::ZERO);
    let mut is_at_zero = start != Start::Apart;
    let mut lift = if is_at_zero { lift } else { T::ZERO };
    let mut is_above = is_at_zero || now.coefficients[0] > T::ZERO;
    if !is_above && now.gap.abs() <= now.rounding * T::whole(4) {
        // The gap is above zero, as far as rounding can tell.
        (is_at_zero, is_above) = (true, true);
    }
    if is_at_zero && start != Start::Leaving && now.coefficients[1] < T::ZERO {
        if counts(T::ZERO) {
            return Some(T::ZERO);
        }
        is_above = false;
    }
    let mut time = T::ZERO;
    // There are no more roots than the degree.
    for _ in 0..N + 2 {
        let sided = |time: T| {
            let expansion = expand(time);
            if is_above { expansion } else { expansion.negated() }
        };
        time = next_root(sided, time, is_at_zero, lift)?;
        if is_above && counts(time) {
            return Some(time);
        }
        is_above = !is_above;
        (is_at_zero, lift) = (true, T::ZERO);
    }
    None
}

/// The first time after which what is above zero, or rises from it, falls below.
fn next_root<T: Real, const N: usize>(
    expand: impl Fn(T) -> Expansion<T, N>,
    time: T,
    is_at_zero: bool,
    lift: T,
) -> Option<T> {
    let (mut time, mut guess, mut corrections) = (time, None, 4);
    if is_at_zero {
        let (left, is_root) = away_from_zero(&expand, time, lift)?;
        if is_root {
            return Some(left);
        }
        time = left;
    }
    for _ in 0..TURNS {
        let Expansion { mut coefficients, gap, rounding, period } = expand(time);
        let (constant, linear) = (coefficients[0], coefficients[1]);
        if gap < -rounding && linear < T::ZERO && corrections > 0 {
            // Rounding has led too far.
            corrections -= 1;
            time = time - constant / linear;
            continue;
        }
        coefficients[0] = constant.greater(T::ZERO);
        if gap <= rounding && linear < T::ZERO {
            return Some(time);
        }
        let step = free_step(&coefficients, guess, period)?;
        let next = time + step;
        if !next.is_finite() {
            return None;
        }
        if next == time {
            return Some(time);
        }
        (time, guess) = (next, Some(step * T::whole(64)));
    }
    Some(time)
}

/// From a zero to a time at which the polynomial is still above zero, to more than
/// rounding; or to the next zero, and true, if it does not come so far.
fn away_from_zero<T: Real, const N: usize>(
    expand: impl Fn(T) -> Expansion<T, N>,
    time: T,
    lift: T,
) -> Option<(T, bool)> {
    let Expansion { coefficients, period, .. } = expand(time);
    let mut divided = [T::ZERO; N];
    divided[..N - 1].copy_from_slice(&coefficients[1..]);
    // It rises, whatever rounding says.
    divided[0] = divided[0].abs();
    let mut since = T::ZERO;
    for _ in 0..TURNS {
        let step = free_step(&divided, None, period)?;
        let before = since;
        since = since + step;
        if !(time + since).is_finite() {
            return None;
        }
        let Expansion { gap, rounding, .. } = expand(time + since);
        if since - before <= T::EPSILON * T::whole(4) * since {
            // What rounding of the powers has left is seen from there, if it can be seen.
            return Some((time + since, gap.abs() <= rounding + rounding + lift));
        }
        if gap > rounding + rounding + lift {
            return Some((time + since, false));
        }
        shift(&mut divided, step);
        divided[0] = divided[0].greater(T::ZERO);
    }
    Some((time + since, true))
}

/// A step on which a polynomial that starts above zero stays above it; as near to its first
/// root as a quadratic below it tells. None if there is no root.
fn free_step<T: Real, const N: usize>(f: &[T; N], guess: Option<T>, period: T) -> Option<T> {
    if f[1..].iter().all(|coefficient| *coefficient >= T::ZERO) {
        return if f[0] > T::ZERO { None } else { (f[1] < T::ZERO).then_some(T::ZERO) };
    }
    let (constant, linear, square) = (f[0], f[1], f[2]);
    let fall = |square: T| fall_of_height(constant, linear, square + square, Start::Apart);
    let mut reach = guess.or_else(|| fall(square)).unwrap_or(period);
    let mut free = T::ZERO;
    for _ in 0..6 {
        let negative = |coefficient: &T| (-*coefficient).greater(T::ZERO);
        // N(h)/h².
        let lowered = f[3..].iter().rev().fold(T::ZERO, |sum, c| sum * reach + negative(c)) * reach;
        match fall(square - lowered) {
            Some(step) if lowered == T::ZERO => return Some(step),
            None if lowered == T::ZERO => return None,
            Some(step) if step < reach => {
                free = free.greater(step);
                if step + step > reach {
                    break;
                }
                reach = (step * reach).sqrt();
            }
            _ => {
                free = free.greater(reach);
                break;
            }
        }
    }
    Some(free)
}

/// The coefficients about a later time.
fn shift<T: Real, const N: usize>(f: &mut [T; N], step: T) {
    for from in 0..N {
        for k in (from..N - 1).rev() {
            f[k] = f[k] + f[k + 1] * step;
        }
    }
}

impl<T: Real, const N: usize> Expansion<T, N> {
    /// Of what is never met.
    pub(crate) fn nothing() -> Self {
        let mut coefficients = [T::ZERO; N];
        coefficients[0] = T::ONE;
        Self { coefficients, gap: T::ONE, rounding: T::ZERO, period: T::ONE }
    }

    pub(crate) fn negated(mut self) -> Self {
        for coefficient in &mut self.coefficients {
            *coefficient = -*coefficient;
        }
        self.gap = -self.gap;
        self
    }
}

/// The coefficients of a product, as far as the result goes.
pub(crate) fn product<T: Real, const A: usize, const B: usize, const N: usize>(
    a: &[T; A],
    b: &[T; B],
) -> [T; N] {
    let mut result = [T::ZERO; N];
    for (i, &left) in a.iter().enumerate() {
        for (k, &right) in b.iter().enumerate() {
            if i + k < N {
                result[i + k] = result[i + k] + left * right;
            }
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With these roots, and a leading coefficient.
    fn polynomial(time: f64, roots: &[f64], leading: f64) -> Expansion<f64, 9> {
        let mut coefficients = [0.0; 9];
        coefficients[0] = leading;
        for root in roots {
            coefficients = product::<f64, 9, 2, 9>(&coefficients, &[time - root, 1.0]);
        }
        let gap = coefficients[0];
        Expansion { coefficients, gap, rounding: 1e-16, period: 1.0 }
    }

    #[test]
    fn every_fall_is_found_in_its_order() {
        let roots = [0.5, 0.75, 1.0, 1.125, 3.0, 3.5, 8.0, 9.0];
        for degree in [2, 4, 6, 8] {
            let expand = |time: f64| polynomial(time, &roots[..degree], 1.0);
            for (k, fall) in roots[..degree].iter().enumerate().step_by(2) {
                let since = if k == 0 { 0.0 } else { roots[k - 1] + 0.01 };
                let found = first_fall_of(expand, Start::Apart, 0.0, &|time| time > since);
                let error = (found.unwrap() - fall).abs();
                assert!(error < 1e-12, "{found:?} for {fall}, degree {degree}");
            }
            let last = first_fall_of(expand, Start::Apart, 0.0, &|_| false);
            assert_eq!(last, None);
        }
    }

    #[test]
    fn near_misses_are_passed_and_grazes_are_not() {
        for depth in [1e-2_f64, 1e-6, 1e-10, 1e-13] {
            // (t − 1)² ∓ depth, times what is positive.
            let expand = |sign: f64| {
                move |time: f64| {
                    let graze =
                        [(time - 1.0) * (time - 1.0) - sign * depth, 2.0 * (time - 1.0), 1.0];
                    let other = [time * time + 1.0, 2.0 * time, 1.0];
                    let coefficients = product::<f64, 3, 3, 9>(&graze, &other);
                    let gap = coefficients[0];
                    Expansion { coefficients, gap, rounding: 1e-16, period: 1.0 }
                }
            };
            assert_eq!(first_fall_of(expand(-1.0), Start::Apart, 0.0, &|_| true), None);
            let found = first_fall_of(expand(1.0), Start::Apart, 0.0, &|_| true);
            let error = (found.unwrap() - (1.0 - depth.sqrt())).abs();
            assert!(error < 1e-15 / depth.sqrt().min(0.1), "{depth:e}: {error:e}");
        }
    }

    #[test]
    fn from_a_zero_the_next_fall_is_found_however_near() {
        for next in [1e-12, 1e-6, 1.0, 100.0] {
            // t (next − t) (t² + 1)
            let expand = |time: f64| {
                let hop = [time * (next - time), next - 2.0 * time, -1.0];
                let other = [time * time + 1.0, 2.0 * time, 1.0];
                let coefficients = product::<f64, 3, 3, 9>(&hop, &other);
                let gap = coefficients[0];
                Expansion { coefficients, gap, rounding: 1e-16 * (1.0 + gap.abs()), period: 1.0 }
            };
            for start in [Start::Touching, Start::Leaving] {
                let found = first_fall_of(expand, start, 0.0, &|_| true);
                assert!((found.unwrap() / next - 1.0).abs() < 1e-14, "{found:?} for {next}");
            }
        }
    }
}
