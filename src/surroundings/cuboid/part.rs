//! Part: a face, an edge or a corner of a solid box.

use super::Cuboid;
use crate::contact::{Approach, Start, fall_of_height};
use crate::real::Real;
use crate::surroundings::free_flight::FreeFlight;
use crate::vec3::Vec3;

/// Where a part lies along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    Lower,
    Between,
    Upper,
}

/// A part and a sphere along one axis.
#[derive(Clone, Copy, Debug)]
struct Axis<T> {
    side: Side,
    lower: T,
    upper: T,
    center: T,
    velocity: T,
    acceleration: T,
}

/// One of the 26 parts of a box's surface, by its side along each axis, and a
/// sphere in flight. A face lies between the ends of the box along two axes, an
/// edge along one, a corner along none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part<T> {
    axes: [Axis<T>; 3],
    radius: T,
    /// The gap, length, up to which a sphere that has just bounced off is still
    /// in contact.
    slack: T,
    is_leaving: bool,
}

/// When a sphere's centre enters the box that is greater by the radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<T> {
    /// Time from now.
    pub(super) time: T,
    /// Whether this is a contact with a face, not just a time before one with
    /// an edge or a corner.
    pub(super) is_contact: bool,
}

impl<T: Real> Part<T> {
    /// The faces, the edges and the corners.
    pub(super) fn all(cuboid: &Cuboid<T>, flight: &FreeFlight<T>) -> impl Iterator<Item = Self> {
        (1..27).map(move |k| Self::new(k, cuboid, flight))
    }

    /// The faces.
    pub(super) fn faces(cuboid: &Cuboid<T>, flight: &FreeFlight<T>) -> [Self; 6] {
        [1, 2, 3, 6, 9, 18].map(|k| Self::new(k, cuboid, flight))
    }

    /// Part `k` of 1 to 26: its digits to the base of 3 are its sides.
    fn new(k: usize, cuboid: &Cuboid<T>, flight: &FreeFlight<T>) -> Self {
        const SIDES: [Side; 3] = [Side::Between, Side::Lower, Side::Upper];
        let sides = [SIDES[k % 3], SIDES[k / 3 % 3], SIDES[k / 9 % 3]];
        let [lower, upper] = [cuboid.lower.to_array(), cuboid.upper.to_array()];
        let [center, velocity] = [flight.center.to_array(), flight.velocity.to_array()];
        let acceleration = flight.acceleration.unwrap_or(Vec3::ZERO).to_array();
        let axes = core::array::from_fn(|k| Axis {
            side: sides[k],
            lower: lower[k],
            upper: upper[k],
            center: center[k],
            velocity: velocity[k],
            acceleration: acceleration[k],
        });
        let slack = cuboid.slack(flight);
        Self { axes, radius: flight.radius, slack, is_leaving: flight.is_leaving }
    }

    /// When the sphere collides with this part. A face counts as a plane, an
    /// edge as a cylinder and a corner as a sphere, of the moving one's radius;
    /// a contact counts where the centre is between the part's ends. That the
    /// cylinder goes on behind the faces does no harm: a path gets there only
    /// through the surface.
    pub(super) fn contact_time(&self) -> Option<T> {
        let counts = |time| self.is_between_ends(time, T::ZERO);
        match self.face_axis() {
            Some(axis) => self.fall_through_face(axis).filter(|&time| counts(time)),
            None => {
                let approach = self.approach();
                let start = self.start(approach.gap_squared(), approach.squared(self.slack));
                approach.contact_time(start, counts)
            }
        }
    }

    /// When the centre falls through the plane of this face, moved out by the
    /// radius; only where it is then no farther than that from the face. None
    /// for an edge and a corner.
    pub(super) fn entry(&self) -> Option<Entry<T>> {
        let time = self.fall_through_face(self.face_axis()?)?;
        let is_contact = self.is_between_ends(time, T::ZERO);
        self.is_between_ends(time, self.radius).then_some(Entry { time, is_contact })
    }

    /// Whether the centre is outside of this face's plane, moved out by the
    /// radius.
    pub(super) fn is_outside(&self) -> bool {
        self.face_axis().is_some_and(|axis| axis.height() > self.radius)
    }

    /// Of a face: the axis along which it looks.
    fn face_axis(&self) -> Option<&Axis<T>> {
        let mut across = self.axes.iter().filter(|axis| axis.side != Side::Between);
        across.next().filter(|_| across.next().is_none())
    }

    fn fall_through_face(&self, axis: &Axis<T>) -> Option<T> {
        let height = axis.height() - self.radius;
        let start = self.start(height, self.slack);
        let (velocity, acceleration) =
            (axis.outward(axis.velocity), axis.outward(axis.acceleration));
        fall_of_height(height, velocity, acceleration, start)
    }

    /// Of an edge or a corner: the motion across it.
    fn approach(&self) -> Approach<T> {
        let [x, y, z] = &self.axes;
        let across =
            |value: fn(&Axis<T>) -> T| Vec3::new(x.across(value), y.across(value), z.across(value));
        Approach {
            offset: across(Axis::offset),
            velocity: across(|axis| axis.velocity),
            acceleration: across(|axis| axis.acceleration),
            reach: self.radius,
            is_hollow: false,
        }
    }

    /// How the flight begins, from the gap to this part.
    ///
    /// Only the part that the sphere is at can be in contact; behind another
    /// one, beyond the ends of its own, it has to come out first. At the seam
    /// of two parts it is at both. There the second one's gap is 0 as well,
    /// so that a sphere that rises from the first by less than rounding does not
    /// sink in through the second.
    fn start(&self, gap: T, slack: T) -> Start {
        if gap > slack {
            Start::Apart
        } else if self.is_nearest() {
            Start::at(gap, slack, self.is_leaving)
        } else if gap >= -slack && (self.is_leaving || gap <= T::ZERO) && self.is_at_seam() {
            Start::Leaving
        } else {
            Start::Apart
        }
    }

    /// Whether the centre is so near to the part's ends that parts which meet
    /// there have the same gap, to rounding.
    fn is_at_seam(&self) -> bool {
        let slack = (self.radius + self.radius) * self.slack;
        self.is_between_ends(T::ZERO, slack.sqrt())
    }

    /// Whether no other part is nearer to the centre, to rounding.
    fn is_nearest(&self) -> bool {
        if self.axes.iter().all(Axis::is_within) {
            // Inside the solid: the face that a push goes through.
            let [x, y, z] = self.axes.each_ref().map(Axis::depth);
            let least = x.lesser(y).lesser(z);
            self.face_axis().is_some_and(|axis| -axis.height() <= least)
        } else {
            self.axes.iter().all(Axis::is_beside)
        }
    }

    /// Whether the centre will be between the part's ends, each moved out by
    /// `margin`.
    fn is_between_ends(&self, time: T, margin: T) -> bool {
        self.axes.iter().all(|axis| axis.side != Side::Between || axis.is_between(time, margin))
    }
}

impl<T: Real> Axis<T> {
    /// From the part to the centre.
    fn offset(&self) -> T {
        self.center - if self.side == Side::Lower { self.lower } else { self.upper }
    }

    /// Out of the solid through the part.
    fn outward(&self, value: T) -> T {
        if self.side == Side::Lower { -value } else { value }
    }

    /// The centre's, above the part.
    fn height(&self) -> T {
        self.outward(self.offset())
    }

    /// A value that is 0 along the part.
    fn across(&self, value: fn(&Self) -> T) -> T {
        if self.side == Side::Between { T::ZERO } else { value(self) }
    }

    fn is_within(&self) -> bool {
        self.lower <= self.center && self.center <= self.upper
    }

    /// Below the nearer face.
    fn depth(&self) -> T {
        (self.center - self.lower).lesser(self.upper - self.center)
    }

    /// Whether the centre is on the part's side, to rounding.
    fn is_beside(&self) -> bool {
        if self.side == Side::Between {
            self.is_between(T::ZERO, T::ZERO)
        } else {
            self.height() >= -self.rounding(T::ZERO)
        }
    }

    /// Whether the centre will be between the ends, each moved out by `margin`;
    /// also if rounding alone takes it out, so that no point slips in where two
    /// faces meet.
    fn is_between(&self, time: T, margin: T) -> bool {
        let margin = margin + self.rounding(time);
        let center = self.center + self.path(self.velocity, self.acceleration, time);
        self.lower - margin <= center && center <= self.upper + margin
    }

    fn path(&self, velocity: T, acceleration: T, time: T) -> T {
        (velocity + acceleration * (T::ratio(1, 2) * time)) * time
    }

    /// What rounding can make of the centre's distance from an end.
    fn rounding(&self, time: T) -> T {
        let ends = self.lower.abs().greater(self.upper.abs());
        let path = self.path(self.velocity.abs(), self.acceleration.abs(), time);
        T::whole(4) * T::EPSILON * (self.center.abs() + ends + path)
    }
}
