//! Tangent march: when a sphere in free flight meets what is convex.
//!
//! ```text
//! loop  p = c(t); q = the nearest point; n = (p − q)/|p − q|; gap = |p − q| − r
//!       gap within rounding, n·w < 0  →  contact at t
//!       step = the fall of the height gap + n·w s + n·a s²/2; none: never
//!       t += step
//! ```
//!
//! What is convex lies behind its supporting plane at `q`: the distance is at least the
//! height above that plane, and along a free flight the height is a quadratic with a
//! known first fall. So a step never passes the first contact, and a plane that is
//! never met proves a miss. Above a face one step is exact; at a transversal contact the
//! march is Newton's method from one side; a graze halves what is left.
//!
//! Where gravity bends the path as an edge bends the gap, the gap falls as a cube and
//! the march would gain `1/k` in turn `k`. Then it gives up: its caller has another way.

use super::approach::greatest_component;
use super::fall::{Start, fall_of_height};
use super::free_flight::FreeFlight;
use crate::real::Real;
use crate::vec3::Vec3;

/// How a march ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum March<T> {
    /// At the first contact, after this time.
    Contact(T),
    /// There is none.
    Never,
    /// Not before this time, nor in a reasonable number of turns.
    Slow(T),
}

/// The most turns in a field, before another way is quicker.
const TURNS: usize = 16;
/// The same on a straight path, where a graze halves what is left.
const STRAIGHT_TURNS: usize = 200;

/// When a flight first comes within its radius of something convex.
///
/// `offset` is the vector from the nearest point to a place outside. Before `from` there
/// is no contact; at that time a gap up to `lift` counts as none, length.
pub(crate) fn tangent_march<T: Real>(
    flight: &FreeFlight<T>,
    reach: T,
    from: T,
    lift: T,
    offset: impl Fn(Vec3<T>) -> Vec3<T>,
) -> March<T> {
    let turns = if flight.acceleration.is_some() { TURNS } else { STRAIGHT_TURNS };
    let (mut time, mut before, mut lift) = (from, from, lift);
    for _ in 0..turns {
        let (position, velocity) = (flight.position(time), flight.velocity_at(time));
        let way = greatest_component(velocity) * time;
        let rounding = T::EPSILON * (greatest_component(position) + reach + way);
        let offset = offset(position);
        let distance = offset.length();
        if distance <= rounding {
            // The centre itself is at the surface: of a point, no radius.
            return March::Contact(time);
        }
        let gap = distance - reach;
        let closing = offset.dot(velocity) / distance;
        if gap <= rounding + lift && closing < T::ZERO {
            // A graze that is no deeper than rounding is for another way to judge.
            let depth = closing * closing * reach;
            let is_graze = depth < T::whole(16) * rounding * velocity.length_squared();
            let is_judged = reach > rounding && lift == T::ZERO;
            return if is_graze && is_judged { March::Slow(before) } else { March::Contact(time) };
        }
        lift = T::ZERO;
        let pull = flight.acceleration.map_or(T::ZERO, |pull| offset.dot(pull) / distance);
        let height = gap.greater(T::ZERO);
        let Some(step) = fall_of_height(height, closing, pull, Start::Apart) else {
            return March::Never;
        };
        let next = time + step;
        if !next.is_finite() {
            return March::Never;
        }
        if next == time {
            return if closing < T::ZERO { March::Contact(time) } else { March::Slow(before) };
        }
        (before, time) = (time, next);
    }
    March::Slow(before)
}
