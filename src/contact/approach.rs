//! Approach: when a centre in free flight comes to a given distance of a fixed
//! one.
//!
//! What touches a sphere, an edge or a corner. The distance squared along a
//! parabola is a quartic in time,
//!
//! ```text
//! f(t) = p·p − s²         p = x + v t + a t²/2
//! f'/2 = p·w              w = v + a t
//! f''/2 = w·w + p·a
//! ```
//!
//! It is never multiplied out: in powers of `t` the error of `f` is `ε x²` all
//! along, and a contact from a distance of `x` has an error of `ε x (x/s)`; from
//! the position at the time it is `ε x`. The zeros of `f''` have a closed form;
//! between them lie those of `f'`, and between these the falls of `f`.

use super::fall::{Start, crossing, first_fall, roots_within};
use super::time::contact_time;
use crate::real::Real;
use crate::vec3::Vec3;

/// A centre in free flight, seen from a fixed one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach<T> {
    /// From the fixed centre to the moving one, length.
    pub(crate) offset: Vec3<T>,
    /// Length per time.
    pub(crate) velocity: Vec3<T>,
    /// Length per time²; zero for straight flight.
    pub(crate) acceleration: Vec3<T>,
    /// Distance of the centres at contact, length.
    pub(crate) reach: T,
    /// Whether the moving centre is held inside that distance, not outside.
    pub(crate) is_hollow: bool,
}

impl<T: Real> Approach<T> {
    /// The first contact that `counts`; None if there is none ever.
    pub(crate) fn contact_time(&self, start: Start, counts: &dyn Fn(T) -> bool) -> Option<T> {
        match (self.horizon(), start) {
            (None, _) => self.straight(start).filter(|&time| counts(time)),
            (Some(horizon), Start::Apart) => self.fall(horizon, counts),
            (Some(horizon), _) => self.fall_from_contact(horizon, start, counts),
        }
    }

    /// `f(0)`, length²: what has the sign of the gap.
    pub(crate) fn gap_squared(&self) -> T {
        self.outward(self.offset.length_squared() - self.reach * self.reach)
    }

    /// What `f` is at a small gap, length²: `2 s` for each unit of length.
    pub(crate) fn squared(&self, gap: T) -> T {
        (self.reach + self.reach) * gap
    }

    /// Towards the side where the moving centre belongs.
    fn outward(&self, outside: T) -> T {
        if self.is_hollow { -outside } else { outside }
    }

    /// From contact, the time of a flight along the inside that stands for shorter ones:
    /// `wait` itself, unless that is too short to get on by.
    ///
    /// Where `κ = v·v + p·a > 0` presses the centre outwards, a flight that leaves the
    /// wall at an angle `φ` takes `2 φ s/√κ`. Rounding of the place alone makes angles of
    /// some `√ε`. One of `4 √ε` or less, or none, becomes `φ = ε^⅜`: on its way it is beyond the wall by up to `2 φ² s`, and all flights after
    /// it turn by `4 φ`. They go round slower than along the wall by `(2 φ)²/6`, which is
    /// what rounding would make of as many as there should be.
    pub(crate) fn hop(&self, wait: T) -> T {
        let pressing = self.velocity.length_squared() + self.offset.dot(self.acceleration);
        if pressing <= T::ZERO || !self.is_hollow {
            return wait;
        }
        hop_of(self.reach / pressing.sqrt(), wait)
    }

    /// A time after all zeros of `f`, `f'` and `f''`; None where the path is
    /// straight within the precision's range.
    ///
    /// With `t = 8 max(|v|/|a|, √((|x| + s)/|a|))` the highest power outweighs
    /// all others together, also with greatest components for lengths, which
    /// do not underflow.
    fn horizon(&self) -> Option<T> {
        let acceleration = greatest_component(self.acceleration);
        let by_velocity = greatest_component(self.velocity) / acceleration;
        let distance = greatest_component(self.offset) + self.reach;
        let by_distance = (distance / acceleration).sqrt();
        let horizon = T::whole(8) * by_velocity.greater(by_distance);
        (acceleration > T::ZERO && horizon.is_finite()).then_some(horizon)
    }

    /// On a straight path.
    fn straight(&self, start: Start) -> Option<T> {
        if self.is_hollow { self.straight_exit(start) } else { self.straight_entry(start) }
    }

    /// Straight to the outside of a sphere.
    fn straight_entry(&self, start: Start) -> Option<T> {
        let is_below = self.gap_squared() <= T::ZERO;
        if start == Start::Leaving || (start == Start::Apart && is_below) {
            // A straight path never comes back to what is convex.
            return None;
        }
        let contact = contact_time(self.offset, self.velocity, self.reach);
        contact.meets.then_some(contact.time)
    }

    /// Straight to the inside of a sphere: the greater root of
    /// `|x + vt|² = s²`. From contact it is the whole chord.
    fn straight_exit(&self, start: Start) -> Option<T> {
        let speed_squared = self.velocity.length_squared();
        if speed_squared == T::ZERO {
            return None;
        }
        let mut moving_out = self.offset.dot(self.velocity);
        if start == Start::Leaving {
            moving_out = -moving_out.abs();
        }
        let (gap, root) = if start == Start::Apart {
            // From inside both terms are positive. By the vector product the
            // root would be lost to rounding near the wall.
            let gap = self.gap_squared();
            (gap, (moving_out * moving_out + speed_squared * gap).sqrt())
        } else {
            (T::ZERO, moving_out.abs())
        };
        Some(if moving_out > T::ZERO {
            gap / (moving_out + root)
        } else {
            (root - moving_out) / speed_squared
        })
    }

    /// The first fall of `f`.
    fn fall(&self, horizon: T, counts: &dyn Fn(T) -> bool) -> Option<T> {
        let Self { offset, velocity, acceleration, reach, .. } = *self;
        let half = T::ratio(1, 2);
        let position = |time: T| offset + (velocity + acceleration * (half * time)) * time;
        let velocity_at = |time: T| velocity + acceleration * time;
        let gap = |time: T| {
            let position = position(time);
            let slope = position.dot(velocity_at(time));
            let gap = position.length_squared() - reach * reach;
            (self.outward(gap), self.outward(slope + slope))
        };
        let half_slope = |time: T| {
            let (position, velocity) = (position(time), velocity_at(time));
            (position.dot(velocity), velocity.length_squared() + position.dot(acceleration))
        };
        let three_halves = T::ratio(3, 2);
        let [first, second] = roots_within(
            velocity.length_squared() + offset.dot(acceleration),
            three_halves * velocity.dot(acceleration),
            three_halves * acceleration.length_squared(),
            horizon,
        );
        let ends = [
            T::ZERO,
            crossing(T::ZERO, first, half_slope),
            crossing(first, second, half_slope),
            crossing(second, horizon, half_slope),
            horizon,
        ];
        first_fall(&ends, gap(T::ZERO).0 > T::ZERO, gap, counts)
    }

    /// The first fall of `f` after contact, with `f(0) = 0`: of
    ///
    /// ```text
    /// f/t = 2 x·v + (x·a + u·u) t         u = v + a t/2
    /// ```
    ///
    /// Divided, so that the contact itself is not found again.
    fn fall_from_contact(&self, horizon: T, start: Start, counts: &dyn Fn(T) -> bool) -> Option<T> {
        let Self { offset, velocity, acceleration, .. } = *self;
        let half = T::ratio(1, 2);
        let moving_out = self.outward(offset.dot(velocity));
        let moving_out = if start == Start::Leaving { moving_out.abs() } else { moving_out };
        if moving_out < T::ZERO {
            return Some(T::ZERO);
        }
        let pull = offset.dot(acceleration);
        let divided = |time: T| {
            let mean_velocity = velocity + acceleration * (half * time);
            let curvature = pull + mean_velocity.length_squared();
            let value = moving_out + moving_out + self.outward(curvature * time);
            (value, self.outward(curvature + mean_velocity.dot(acceleration) * time))
        };
        let [first, second] = roots_within(
            velocity.length_squared() + pull,
            velocity.dot(acceleration),
            T::ratio(3, 4) * acceleration.length_squared(),
            horizon,
        );
        first_fall(&[T::ZERO, first, second, horizon], true, divided, counts)
    }
}

/// As [`Approach::hop`], by the time in which a flight along the inside turns by 1 rad.
pub(crate) fn hop_of<T: Real>(time: T, wait: T) -> T {
    let eighth = T::EPSILON.sqrt().sqrt().sqrt();
    // In precisions finer than a double there would be no end of them.
    let angle = (eighth * eighth * eighth).greater(T::ratio(1, 1 << 20));
    let least = T::EPSILON.sqrt() * T::whole(8);
    if wait <= least * time { (angle + angle) * time } else { wait }
}

/// The greatest absolute value of the components: between `1/√3` and 1 of the
/// length.
pub(crate) fn greatest_component<T: Real>(vector: Vec3<T>) -> T {
    vector.x.abs().greater(vector.y.abs()).greater(vector.z.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn approach<T: Real>(offset: [T; 3], velocity: [T; 3], acceleration: [T; 3]) -> Approach<T> {
        Approach {
            offset: offset.into(),
            velocity: velocity.into(),
            acceleration: acceleration.into(),
            reach: T::ONE,
            is_hollow: false,
        }
    }

    /// Parabolas against a unit sphere, in rationals.
    fn exact_parabolas<T: Real>() {
        let (zero, down) = (T::ZERO, [T::ZERO, T::whole(-10), T::ZERO]);
        let r = T::ratio;
        let cases = [
            ([zero, r(14, 5), zero], [zero; 3], r(3, 5)),
            ([r(8, 5), r(41, 20), r(-1, 2)], [r(-2, 1), zero, r(1, 1)], r(1, 2)),
            ([r(-1, 4), r(-29, 16), zero], [r(1, 1), r(9, 2), zero], r(1, 4)),
        ];
        for (offset, velocity, expected) in cases {
            let approach = approach(offset, velocity, down);
            let found = approach.contact_time(Start::Apart, &|_| true);
            let error = (found.unwrap() - expected).abs();
            assert!(error <= T::whole(2) * T::EPSILON, "{found:?} for {expected}");
        }
    }

    #[test]
    fn parabolas_meet_a_sphere_at_the_exact_time() {
        exact_parabolas::<f32>();
        exact_parabolas::<f64>();
    }

    #[test]
    fn what_is_thrown_up_from_the_top_comes_back() {
        for velocity in [1e-12, 1e-6, 1.0, 1e3, 1e6] {
            let start = [0.0, 1.0 - f64::EPSILON, 0.0];
            let up = approach(start, [0.0, velocity, 0.0], [0.0, -10.0, 0.0]);
            let found =
                up.contact_time(Start::at(up.gap_squared(), 0.0, false), &|_| true).unwrap();
            let error = (found / (velocity / 5.0) - 1.0).abs();
            assert!(error < 4.0 * f64::EPSILON, "{velocity}: {error:e}");
        }
    }

    #[test]
    fn at_rest_on_a_sphere_the_contact_is_now() {
        for is_leaving in [false, true] {
            let rest = approach([0.0, 1.0, 0.0], [0.0; 3], [0.0, -10.0, 0.0]);
            let start = Start::at(rest.gap_squared(), 1e-12, is_leaving);
            assert_eq!(rest.contact_time(start, &|_| true), Some(0.0));
            let hanging = approach([0.0, -1.0, 0.0], [0.0; 3], [0.0, -10.0, 0.0]);
            let start = Start::at(hanging.gap_squared(), 1e-12, is_leaving);
            assert_eq!(hanging.contact_time(start, &|_| true), None);
        }
    }

    #[test]
    fn inside_the_contact_after_a_bounce_is_the_chord() {
        let chord = Approach {
            is_hollow: true,
            ..approach([0.6, 0.8, 0.0], [-1.0_f64, 0.0, 0.0], [0.0; 3])
        };
        for start in [Start::Touching, Start::Leaving] {
            assert_eq!(chord.contact_time(start, &|_| true), Some(1.2));
        }
        // The same, seen a little off by rounding.
        let reversed = Approach { velocity: Vec3::new(1.0, 0.0, 0.0), ..chord };
        assert_eq!(reversed.contact_time(Start::Touching, &|_| true), Some(0.0));
        assert_eq!(reversed.contact_time(Start::Leaving, &|_| true), Some(1.2));
    }

    #[test]
    fn almost_no_field_is_straight_flight() {
        let straight = approach([3.0_f32, 0.6, 0.0], [-1.0, 0.0, 0.0], [0.0; 3]);
        let expected = straight.contact_time(Start::Apart, &|_| true).unwrap();
        for field in [1e-12, 1e-20, 1e-30, 1e-38, 1e-45] {
            for acceleration in [[0.0, -field, 0.0], [field, 0.0, 0.0], [-field, field, 0.0]] {
                let curved = Approach { acceleration: acceleration.into(), ..straight };
                let found = curved.contact_time(Start::Apart, &|_| true).unwrap();
                assert!((found - expected).abs() <= 4.0 * f32::EPSILON, "{found} {field}");
            }
        }
    }
}
