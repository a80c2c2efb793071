//! Meeting: when two bodies in flight come into contact.

use super::flight::Flight;
use crate::contact::{ContactEquation, ContactTime};
use crate::lane::{Lane, Mask};
use crate::motion::integrator::FlightStep;
use crate::real::Real;
use crate::space::Space;
use crate::vec3::Vec3;

/// How two bodies in flight come near each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting<L> {
    /// The start of the later flight.
    from: L,
    reach: L,
    /// From then on.
    equation: ContactEquation<L>,
}

/// Whether two bodies in flight meet, and when.
///
/// A function of the two flights and the pair's image alone: the same bits at
/// whatever time it is worked out, and for `a` and `b` exchanged. `now` only
/// chooses the image: the nearest one at that time, moved on by `further`
/// whole boxes. `STARTS` says that the flight of `a` starts now, which takes a
/// fifth of the work off.
#[inline(always)]
pub(super) fn meeting<L: Lane, F: FlightStep, S: Space<L::Scalar>, const STARTS: bool>(
    a: &Flight<L>,
    b: &Flight<L>,
    gravity: Vec3<L>,
    space: S,
    further: Vec3<L>,
    now: L,
) -> Meeting<L> {
    let from = if STARTS { now } else { a.since.greater(b.since) };
    let (position_a, velocity_a) =
        if STARTS { (a.position, a.velocity) } else { a.at::<F>(from, gravity) };
    let (position_b, velocity_b) = b.at::<F>(from, gravity);
    let relative = velocity_a - velocity_b;
    let offset = position_a - position_b;
    let nearby = if STARTS { offset } else { offset + relative * (now - from) };
    let offset = offset - space.shift(space.turns(nearby) + further);

    let reach = a.radius + b.radius;
    Meeting { from, reach, equation: ContactEquation::new(offset, relative, reach) }
}

impl<L: Lane> Meeting<L> {
    /// Whether the two would meet if their velocities were a little different: see
    /// [`ContactEquation::may_meet`].
    #[inline(always)]
    pub fn may_meet(&self, slack: L, stray: L) -> L::Mask {
        self.equation.may_meet(slack, stray)
    }

    /// Whether the two meet.
    #[inline(always)]
    pub fn meets(&self) -> L::Mask {
        self.equation.meets()
    }

    /// Whether the two meet, and when.
    #[inline(always)]
    pub fn contact(&self) -> (L::Mask, L) {
        let ContactTime { meets, time } = self.equation.contact_time();
        (meets, self.from + time)
    }

    /// Whether the two are in contact at the start of the later flight, or all
    /// but in contact.
    #[inline(always)]
    pub fn is_touching(&self) -> L::Mask {
        self.equation.is_touching(self.reach)
    }
}

/// How many meetings are worked out before any is looked at.
pub(super) const TOGETHER: usize = 64;

/// The meetings of a body with up to [`TOGETHER`] others. One that is not met is
/// passed over without a branch, which would be mispredicted once in two packs.
#[derive(Clone, Debug)]
pub(super) struct Meetings<T> {
    met: u64,
    times: [T; TOGETHER],
}

impl<T: Real> Meetings<T> {
    pub fn new() -> Self {
        Self { met: 0, times: [T::ZERO; TOGETHER] }
    }

    /// Puts a pack of meetings down as those from number `first` on.
    #[inline(always)]
    pub fn put<L: Lane<Scalar = T>>(&mut self, first: usize, meeting: &Meeting<L>) {
        let (meets, time) = meeting.contact();
        time.store(&mut self.times[first..]);
        self.met |= u64::from(meets.bits()) << first;
    }

    /// Takes the number of one who is met, and the time of contact.
    #[inline(always)]
    pub fn take(&mut self) -> Option<(usize, T)> {
        if self.met == 0 {
            return None;
        }
        let number = self.met.trailing_zeros() as usize % TOGETHER;
        self.met &= self.met - 1;
        Some((number, self.times[number]))
    }
}
