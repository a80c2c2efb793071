//! Pieced: when a sphere meets a part that is made of pieces.
//!
//! What is convex is asked for its nearest point only, by the tangent march. Where that
//! stalls, and where a flight in a field begins on an edge, and for all that is not
//! convex, the earliest of the contacts with its pieces is taken.

use super::piece::Piece;
use super::solid::Obstacle;
use crate::contact::{Approach, FreeFlight, March, Start, fall_of_height, tangent_march};
use crate::real::Real;
use crate::vec3::Vec3;

/// A part by its pieces.
pub(super) trait Pieced<T: Real>: Obstacle<T> {
    /// All pieces, in no order.
    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>));

    /// Whether spheres are outside of something convex.
    fn is_convex(&self) -> bool {
        false
    }

    /// Of something convex: whether it has no inside. A centre alone comes through it by
    /// rounding, and the march would see it go away.
    fn is_flat(&self) -> bool {
        false
    }

    /// Of something convex: from the nearest point of its core to a place outside.
    fn offset(&self, _place: Vec3<T>) -> Vec3<T> {
        Vec3::ZERO
    }

    /// Of something convex: how thick the skin around the core is, length.
    fn skin(&self) -> T {
        T::ZERO
    }

    /// When a sphere in free flight collides with it.
    fn collision_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        let (gap, normal) = self.gap_and_normal(flight.center, flight.radius);
        let start = Start::at(gap, self.slack(flight), flight.is_leaving);
        if start == Start::Apart {
            return self.later(flight, start, gap, T::ZERO);
        }
        let closing = normal.dot(flight.velocity);
        if start == Start::Touching && closing < T::ZERO {
            return Some(T::ZERO);
        }
        if !self.is_convex() {
            return self.by_pieces(flight, Start::Leaving, gap);
        }
        // A straight path never comes back to what is convex. Another one cannot before
        // it comes through the plane that it leaves.
        let pull = flight.acceleration?.dot(normal);
        let from = fall_of_height(T::ZERO, closing.abs(), pull, Start::Leaving)?;
        if from > T::ZERO {
            self.later(flight, Start::Leaving, gap, from)
        } else {
            self.by_pieces(flight, Start::Leaving, gap)
        }
    }

    /// The first contact after a time before which there is none.
    fn later(&self, flight: &FreeFlight<T>, start: Start, gap: T, from: T) -> Option<T> {
        if !self.is_convex() {
            return self.by_pieces(flight, start, gap);
        }
        let lift = if start == Start::Apart { T::ZERO } else { gap.abs() };
        let reach = self.skin() + flight.radius;
        if reach == T::ZERO && self.is_flat() {
            return self.by_pieces(flight, start, gap);
        }
        match tangent_march(flight, reach, from, lift, |place| self.offset(place)) {
            March::Contact(time) => Some(time),
            March::Never => None,
            March::Slow(_) if start != Start::Apart => self.by_pieces(flight, start, gap),
            March::Slow(time) => self.by_pieces_from(flight, time),
        }
    }

    /// The earliest contact with any of the pieces, at which the whole is touched. A flight
    /// from afar begins where it comes near, since polynomials have no digits from afar.
    fn by_pieces(&self, flight: &FreeFlight<T>, start: Start, gap: T) -> Option<T> {
        let Some([lower, upper]) = self.bounds().filter(|_| start == Start::Apart) else {
            return self.by_near_pieces(flight, start, gap);
        };
        let half = T::ratio(1, 2);
        let approach = Approach {
            offset: flight.center - (lower + upper) * half,
            velocity: flight.velocity,
            acceleration: flight.pull(),
            reach: T::whole(4) * ((upper - lower).length() * half + flight.radius),
            is_hollow: false,
        };
        if approach.gap_squared() <= T::ZERO {
            return self.by_near_pieces(flight, start, gap);
        }
        self.by_pieces_from(flight, approach.contact_time(Start::Apart, &|_| true)?)
    }

    /// The earliest contact after a time at which there is none, nor was before.
    fn by_pieces_from(&self, flight: &FreeFlight<T>, time: T) -> Option<T> {
        let center = flight.position(time);
        let near = FreeFlight { center, velocity: flight.velocity_at(time), ..*flight };
        let gap = self.clearance(center, flight.radius).gap;
        self.by_near_pieces(&near, Start::Apart, gap).map(|wait| time + wait)
    }

    fn by_near_pieces(&self, flight: &FreeFlight<T>, start: Start, gap: T) -> Option<T> {
        let size = T::from_f64(self.farthest());
        let near = T::whole(4) * flight.rounding(T::ZERO, size);
        let mut first: Option<T> = None;
        self.each_piece(&mut |piece| {
            let own = piece.gap(flight.center, flight.radius);
            // Of a piece behind another one, or beyond its ends, the gap says nothing; one
            // that is farther off than the whole is met later.
            let is_at = own <= gap + near && own >= gap - near;
            let is_touching = start == Start::Apart && piece.is_closed(flight);
            let start = match is_at {
                // Apart from the whole by less than rounding.
                true if is_touching => Start::Touching,
                true => start,
                false => Start::Apart,
            };
            let counts = |time: T| {
                if time < T::ZERO {
                    return false;
                }
                let rounding = T::whole(16) * flight.rounding(time, size);
                self.clearance(flight.position(time), flight.radius).gap <= rounding
            };
            let found = piece.contact_time(flight, start, &counts);
            first = match (first, found) {
                (Some(a), Some(b)) => Some(a.lesser(b)),
                (a, b) => a.or(b),
            };
        });
        first
    }

    /// As [`FreeFlight::slack`], for all of the part.
    fn slack(&self, flight: &FreeFlight<T>) -> T {
        flight.slack(Vec3::new(T::from_f64(self.farthest()), T::ZERO, T::ZERO))
    }

    /// The gap, and the unit normal, which a sphere without a radius has too.
    fn gap_and_normal(&self, center: Vec3<T>, radius: T) -> (T, Vec3<T>) {
        let clearance = self.clearance(center, radius);
        let size = if radius > T::ZERO { radius } else { T::ONE };
        let arm = if radius > T::ZERO { clearance.arm } else { self.clearance(center, size).arm };
        let length = arm.length();
        let scale = if length > T::ZERO { T::ONE / length } else { T::ZERO };
        (clearance.gap, arm * scale)
    }

    /// From contact, the time of a flight along the part that stands for shorter ones:
    /// `wait` itself, unless that is too short to get on by.
    fn long_hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        let (mut hop, mut nearest) = (wait, None);
        self.each_piece(&mut |piece| {
            let gap = piece.gap(flight.center, flight.radius).abs();
            if nearest.is_none_or(|nearest| gap < nearest) {
                (hop, nearest) = (piece.hop(flight, wait), Some(gap));
            }
        });
        hop
    }
}
