//! Fall: when a function of time first falls through zero.
//!
//! What a gap does at a contact. Between neighbouring turning points a function
//! is monotone, so that each of its zeros is bracketed: none is missed, and one
//! where it rises is never taken for one where it falls.

use crate::real::Real;

/// How a sphere begins its flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Start {
    /// Not in contact: the gap is what it is.
    Apart,
    /// In contact, the gap is 0. What it overlaps is left by rounding.
    Touching,
    /// Just bounced off: the gap is 0 and not closing, whatever rounding says.
    Leaving,
}

impl Start {
    /// From the gap, or what has its sign, and the gap up to which a sphere
    /// that has just bounced off is still there.
    pub(crate) fn at<T: Real>(gap: T, slack: T, is_leaving: bool) -> Self {
        if is_leaving && gap <= slack {
            Self::Leaving
        } else if gap <= T::ZERO {
            Self::Touching
        } else {
            Self::Apart
        }
    }
}

/// When the height `h + u t + a t²/2` falls through 0, at `t ≥ 0`: the root at
/// which it falls, in the form that does not cancel.
///
/// Thrown up from 0 it is back at `2u/−a`; at rest on 0 and pulled down it
/// falls now.
pub(crate) fn fall_of_height<T: Real>(
    height: T,
    velocity: T,
    acceleration: T,
    start: Start,
) -> Option<T> {
    let (height, velocity) = match start {
        Start::Apart => (height, velocity),
        Start::Touching => (T::ZERO, velocity),
        Start::Leaving => (T::ZERO, velocity.abs()),
    };
    let is_below = height < T::ZERO;
    let gain = (acceleration + acceleration) * height;
    let discriminant = velocity * velocity - gain;
    // √u² would underflow before u does.
    let root = if gain == T::ZERO {
        velocity.abs()
    } else if discriminant > T::ZERO {
        discriminant.sqrt()
    } else {
        // It turns before it reaches 0.
        return None;
    };
    if velocity < T::ZERO {
        (!is_below).then(|| (height + height) / (root - velocity))
    } else if acceleration < T::ZERO {
        Some((velocity + root) / -acceleration)
    } else {
        None
    }
}

/// The first time at which a function falls through zero and that `counts`.
///
/// `function` gives value and slope; it is monotone between neighbours of
/// `ends`, which ascend. `is_above` says whether it comes from above zero: a
/// function that begins below has to rise first. It may begin at zero.
///
/// `counts` is asked for each zero only, so a call of its own is cheap, and there is one
/// instance of the search and not one for each shape.
pub(crate) fn first_fall<T: Real>(
    ends: &[T],
    mut is_above: bool,
    function: impl Fn(T) -> (T, T),
    counts: &dyn Fn(T) -> bool,
) -> Option<T> {
    for (&low, &high) in ends.iter().zip(ends.iter().skip(1)) {
        let (value, _) = function(high);
        if is_above && value < T::ZERO {
            let time = crossing(low, high, &function);
            if counts(time) {
                return Some(time);
            }
        }
        // At a zero it has touched, and may go on to either side.
        if value != T::ZERO {
            is_above = value > T::ZERO;
        }
    }
    None
}

/// Where a function, monotone between `low` and `high`, crosses zero; `high`
/// if it does not.
///
/// Newton's method inside a bracket, from `low` on; a step that leaves the
/// bracket or is not half as long as the last one becomes a bisection. Every
/// turn narrows the bracket, so it ends in every precision.
pub(crate) fn crossing<T: Real>(low: T, high: T, function: impl Fn(T) -> (T, T)) -> T {
    let half = T::ratio(1, 2);
    let (mut low, mut high) = (low, high);
    let (mut value, mut slope) = function(low);
    let begins_below = value < T::ZERO;
    if value == T::ZERO {
        return low;
    }
    if begins_below == (function(high).0 < T::ZERO) {
        return high;
    }
    let mut time = low;
    let mut last_step = high - low;
    loop {
        let newton = time - value / slope;
        if (newton - time).abs() <= half * T::EPSILON * time.abs() {
            return time;
        }
        let is_inside = low < newton && newton < high;
        let is_quick = (newton - time).abs() < half * last_step;
        let next = if is_inside && is_quick { newton } else { half * (low + high) };
        if !(low < next && next < high) {
            return high;
        }
        last_step = (next - time).abs();
        time = next;
        (value, slope) = function(time);
        if value == T::ZERO {
            return time;
        }
        if (value < T::ZERO) == begins_below {
            low = time;
        } else {
            high = time;
        }
    }
}

/// The real roots of `constant + 2 half_linear t + square t²`, ascending, each
/// moved to the nearer end if it lies outside of `0…end`; ends also where there
/// are none.
pub(crate) fn roots_within<T: Real>(constant: T, half_linear: T, square: T, end: T) -> [T; 2] {
    // As ratios, which are times: the products would overflow much sooner.
    let middle = -(half_linear / square);
    let product = constant / square;
    let discriminant = middle * middle - product;
    if discriminant < T::ZERO {
        return [end, end];
    }
    let root = discriminant.sqrt();
    let greater = if middle < T::ZERO { middle - root } else { middle + root };
    let within = |time: T| {
        // What is no number counts as no root.
        if time > T::ZERO { time.lesser(end) } else { T::ZERO }
    };
    let [a, b] = [within(greater), within(product / greater)];
    if a < b { [a, b] } else { [b, a] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heights<T: Real>() {
        let w = T::whole;
        let half = T::ratio(1, 2);
        let cases = [
            // Dropped, thrown down, thrown up, straight.
            ([w(5), w(0), w(-10)], Start::Apart, Some(w(1))),
            ([w(6), w(-1), w(-10)], Start::Apart, Some(w(1))),
            ([w(10), w(5), w(-10)], Start::Apart, Some(w(2))),
            ([w(3), w(-2), w(0)], Start::Apart, Some(w(3) * half)),
            // Pushed away: turns before, at, and after 0; the first root of two.
            ([w(2), w(-1), w(1)], Start::Apart, None),
            ([half, w(-1), w(1)], Start::Apart, None),
            ([w(4), w(-5), w(2)], Start::Apart, Some(w(1))),
            ([w(1), w(1), w(1)], Start::Apart, None),
            ([w(1), w(0), w(0)], Start::Apart, None),
            // From below only after a rise.
            ([w(-3), w(-1), w(-1)], Start::Apart, None),
            ([w(-3), w(1), w(-1)], Start::Apart, None),
            ([w(-4), w(5), w(-2)], Start::Apart, Some(w(4))),
            ([w(-3), w(1), w(0)], Start::Apart, None),
            // In contact.
            ([w(-1), w(-1), w(5)], Start::Touching, Some(w(0))),
            ([w(-1), w(3), w(-2)], Start::Touching, Some(w(3))),
            ([w(0), w(0), w(-2)], Start::Touching, Some(w(0))),
            ([w(0), w(0), w(0)], Start::Touching, None),
            ([w(0), w(3), w(0)], Start::Touching, None),
            ([w(1), w(-3), w(-2)], Start::Leaving, Some(w(3))),
            ([w(-1), w(-3), w(2)], Start::Leaving, None),
        ];
        for ([height, velocity, acceleration], start, time) in cases {
            let found = fall_of_height(height, velocity, acceleration, start);
            assert_eq!(found, time, "{height} {velocity} {acceleration} {start:?}");
        }
    }

    #[test]
    fn heights_fall_once() {
        heights::<f32>();
        heights::<f64>();
    }

    #[test]
    fn a_throw_returns_however_slow() {
        let slow = 1e-200;
        let back = fall_of_height(-1e-17, slow, -10.0, Start::Touching);
        assert_eq!(back, Some(2.0 * slow / 10.0));
    }

    #[test]
    fn falls_are_told_from_rises_and_grazes() {
        // (t − 1)²(t − 2)(t − 3)(…): touches at 1, falls at 2, rises at 3.
        let function = |t: f64| {
            let value = (t - 1.0) * (t - 1.0) * (t - 2.0) * (t - 3.0);
            (value, 4.0 * t * t * t - 21.0 * t * t + 34.0 * t - 17.0)
        };
        // Exactly where it turns matters for the touch alone.
        let ends = [0.0, 1.0, 1.610, 2.64, 9.0];
        assert_eq!(first_fall(&ends, true, function, &|_| true), Some(2.0));
        assert_eq!(first_fall(&ends, true, function, &|time| time > 2.5), None);
        // Through zero at a turning point of rank three.
        let cube = |t: f64| (-(t - 1.0) * (t - 1.0) * (t - 1.0), -3.0 * (t - 1.0) * (t - 1.0));
        assert_eq!(first_fall(&[0.0, 1.0, 2.0], true, cube, &|_| true), Some(1.0));
    }

    #[test]
    fn crossings_end_at_the_last_bit() {
        let square = |t: f64| (t * t - 2.0, 2.0 * t);
        for high in [2.0, 1e6, 1e300] {
            let root = crossing(0.0, high, square);
            assert!((root - 2.0_f64.sqrt()).abs() <= f64::EPSILON, "{root} below {high}");
        }
        // A slope that leads nowhere for long.
        let cube = |t: f32| (t * t * t - 1e-30, 3.0 * t * t);
        let root = crossing(0.0, 1e9, cube);
        assert!((root - 1e-10).abs() <= 1e-16, "{root}");
        assert_eq!(crossing(3.0, 4.0, square), 4.0);
    }

    #[test]
    fn quadratics_without_roots_or_square_are_harmless() {
        assert_eq!(roots_within(2.0, -1.5, 1.0, 9.0), [1.0, 2.0]);
        assert_eq!(roots_within(2.0, -1.5, 1.0, 1.5), [1.0, 1.5]);
        assert_eq!(roots_within(2.0, 1.5, 1.0, 9.0), [0.0, 0.0]);
        assert_eq!(roots_within(2.0, 1.0, 1.0, 9.0), [9.0, 9.0]);
        for constant in [-1.0, 0.0, 1.0] {
            let [a, b] = roots_within(constant, 0.0, 0.0, 9.0);
            assert!(0.0 <= a && a <= b && b <= 9.0);
        }
    }
}
