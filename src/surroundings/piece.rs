//! Pieces: the faces, edges, corners, walls and rims that a part is made of.
//!
//! Of each piece, gone on without end, the contacts are known in closed form or by the
//! Taylor march. A contact counts where the part as a whole is touched: so no piece has
//! to know where it ends, and none is missed where two meet.

use super::axis::Axis;
use super::slant::Slant;
use crate::contact::{
    Approach, Expansion, FreeFlight, Start, fall_of_height, first_fall_of, greatest_component,
    hop_of, product,
};
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

/// A piece.
#[derive(Clone, Copy, Debug)]
pub(super) enum Piece<T> {
    /// A face, by a point of its plane and the unit normal out of it.
    Face { point: Vec3<T>, normal: Vec3<T> },
    /// A corner, or a whole sphere of a radius; spheres are inside if it is hollow.
    Corner { center: Vec3<T>, radius: T, is_hollow: bool },
    /// An edge, or a whole cylinder of a radius; spheres are inside if it is hollow.
    Edge { axis: Axis<T>, radius: T, is_hollow: bool },
    /// A cone, which may be a cylinder: a profile that goes up. Spheres are on its outer
    /// side, or inside.
    Wall { axis: Axis<T>, slant: Slant<T>, is_hollow: bool },
    /// A rim, or a torus with a radius across: a circle at a height about the axis.
    /// Spheres are inside of the torus if it is hollow.
    Rim { axis: Axis<T>, height: T, distance: T, radius: T, is_hollow: bool },
}

impl<T: Real> Piece<T> {
    /// The rim where a profile ends, by its distance from the axis and its height; the tip
    /// if it ends on the axis.
    pub(super) fn at_end(axis: Axis<T>, [distance, height]: [T; 2]) -> Self {
        if distance == T::ZERO {
            let center = axis.point(height);
            return Self::Corner { center, radius: T::ZERO, is_hollow: false };
        }
        Self::Rim { axis, height, distance, radius: T::ZERO, is_hollow: false }
    }

    /// The gap between a sphere and the piece, as if that had no end.
    pub(super) fn gap(&self, center: Vec3<T>, radius: T) -> T {
        let sided = |gap: T, is_hollow: bool| if is_hollow { -gap - radius } else { gap - radius };
        match *self {
            Self::Face { point, normal } => (center - point).dot(normal) - radius,
            Self::Corner { center: own, radius: size, is_hollow } => {
                sided((center - own).length() - size, is_hollow)
            }
            Self::Edge { axis, radius: size, is_hollow } => {
                sided(axis.across(center - axis.center).length() - size, is_hollow)
            }
            Self::Wall { axis, slant, is_hollow } => {
                let place = axis.place(center);
                let [out, up] = slant.right();
                let [distance, height] = slant.start;
                let off = (place.distance - distance) * out + (place.height - height) * up;
                sided(off, is_hollow)
            }
            Self::Rim { axis, height, distance, radius: size, is_hollow } => {
                let place = axis.place(center);
                let (out, up) = (place.distance - distance, place.height - height);
                sided((out * out + up * up).sqrt() - size, is_hollow)
            }
        }
    }

    /// The first contact that `counts`.
    pub(super) fn contact_time(
        &self,
        flight: &FreeFlight<T>,
        start: Start,
        counts: &dyn Fn(T) -> bool,
    ) -> Option<T> {
        let lift = self.gap(flight.center, flight.radius).abs();
        match *self {
            Self::Face { point, normal } => {
                let height = (flight.center - point).dot(normal) - flight.radius;
                let pull = flight.pull().dot(normal);
                fall_of_height(height, flight.velocity.dot(normal), pull, start)
                    .filter(|&time| counts(time))
            }
            Self::Corner { .. } | Self::Edge { .. } => {
                self.approach(flight)?.contact_time(start, counts)
            }
            Self::Wall { .. } => first_fall_of(|time| self.wall(flight, time), start, lift, counts),
            Self::Rim { .. } if flight.acceleration.is_none() => {
                first_fall_of::<T, 5>(|time| self.rim(flight, time), start, lift, counts)
            }
            Self::Rim { .. } => {
                first_fall_of::<T, 9>(|time| self.rim(flight, time), start, lift, counts)
            }
        }
    }

    /// Of a corner or an edge: the flight past it.
    pub(super) fn approach(&self, flight: &FreeFlight<T>) -> Option<Approach<T>> {
        let offset = |center: Vec3<T>| flight.center - center;
        let [velocity, acceleration] = [flight.velocity, flight.pull()];
        let reach = |radius: T, is_hollow: bool| {
            if is_hollow { radius - flight.radius } else { radius + flight.radius }
        };
        match *self {
            Self::Corner { center, radius, is_hollow } => {
                let (offset, reach) = (offset(center), reach(radius, is_hollow));
                Some(Approach { offset, velocity, acceleration, reach, is_hollow })
            }
            Self::Edge { axis, radius, is_hollow } => Some(Approach {
                offset: axis.across(offset(axis.center)),
                velocity: axis.across(velocity),
                acceleration: axis.across(acceleration),
                reach: reach(radius, is_hollow),
                is_hollow,
            }),
            _ => None,
        }
    }

    /// Whether the sphere touches the piece or is beyond it, by what its contacts are
    /// found from.
    pub(super) fn is_closed(&self, flight: &FreeFlight<T>) -> bool {
        match self.approach(flight) {
            Some(approach) => approach.gap_squared() <= T::ZERO,
            None => self.gap(flight.center, flight.radius) <= T::ZERO,
        }
    }

    /// Of a wall, about a time: `ρ² cos² − K²`, with `K = cos ρ` where the surfaces touch,
    /// linear in the height.
    fn wall(&self, flight: &FreeFlight<T>, time: T) -> Expansion<T, 5> {
        let Self::Wall { axis, slant, is_hollow } = *self else { return Expansion::nothing() };
        let half = T::ratio(1, 2);
        let Parts { position, velocity, pull, period, rounding } =
            Parts::new(&axis, flight, time, slant.start[0].abs() + slant.start[1].abs());
        let heights = [position, velocity, pull * half].each(|part| part.dot(axis.direction));
        let [p, v, a] = [position, velocity, pull * half].each(|part| axis.across(part));
        let squares: [T; 5] = square([p, v, a]);
        let (cosine, sine) = (slant.along[1], slant.along[0]);
        let side = if is_hollow { -flight.radius } else { flight.radius };
        let line = [
            cosine * slant.start[0] + sine * (heights[0] - slant.start[1]) + side,
            sine * heights[1],
            sine * heights[2],
        ];
        let out = cosine * squares[0].sqrt();
        let line_squared: [T; 5] = product(&line, &line);
        let mut coefficients: [T; 5] =
            array::from_fn(|k| cosine * cosine * squares[k] - line_squared[k]);
        coefficients[0] = (out - line[0]) * (out + line[0]);
        if is_hollow {
            coefficients = coefficients.each(|coefficient| -coefficient);
        }
        let gap = if is_hollow { line[0] - out } else { out - line[0] };
        let gap = if out + line[0] < T::ZERO { -gap } else { gap };
        Expansion { coefficients, gap, rounding, period }
    }

    /// Of a rim of radius `R`, about a time: `(p·p + R² − s²)² − 4 R² ρ²`.
    fn rim<const N: usize>(&self, flight: &FreeFlight<T>, time: T) -> Expansion<T, N> {
        let Self::Rim { axis, height, distance, radius, is_hollow } = *self else {
            return Expansion::nothing();
        };
        let half = T::ratio(1, 2);
        let axis = Axis { center: axis.point(height), ..axis };
        let Parts { position, velocity, pull, period, rounding } =
            Parts::new(&axis, flight, time, distance + radius);
        let reach = if is_hollow { radius - flight.radius } else { radius + flight.radius };
        let mut sum: [T; 5] = square([position, velocity, pull * half]);
        let squares: [T; 5] =
            square([position, velocity, pull * half].each(|part| axis.across(part)));
        sum[0] = sum[0] + (distance - reach) * (distance + reach);
        let mut coefficients: [T; N] = product(&sum, &sum);
        let four = T::whole(4) * distance * distance;
        for (coefficient, square) in coefficients.iter_mut().zip(squares) {
            *coefficient = *coefficient - four * square;
        }
        // (d² − s²)(D² − s²), to the near and the far point of the circle.
        let away = squares[0].sqrt();
        let up = position.dot(axis.direction);
        let near = (away - distance) * (away - distance) + up * up;
        let gap = near.sqrt() - reach;
        let inner = gap * (near.sqrt() + reach);
        let outer = inner + T::whole(4) * distance * away;
        coefficients[0] = inner * outer;
        if away > T::ZERO {
            let moving = position.dot(velocity);
            let out = squares[1] * half / away;
            let two = T::whole(2);
            coefficients[1] =
                two * ((moving - distance * out) * outer + (moving + distance * out) * inner);
        }
        let gap = if outer < T::ZERO { -gap } else { gap };
        let expansion = Expansion { coefficients, gap, rounding, period };
        if is_hollow { expansion.negated() } else { expansion }
    }

    /// From contact, the time of a flight along the piece that stands for shorter ones:
    /// `wait` itself, unless that is too short to get on by. As [`Approach::hop`] has it.
    pub(super) fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        // Where the surfaces touch, f is the gap times this; and the gap's curvature.
        let (curve, factor, reach) = match *self {
            Self::Wall { axis, slant, is_hollow: true } => {
                let distance = axis.place(flight.center).distance;
                let factor = T::whole(2) * slant.along[1] * distance;
                (self.wall(flight, T::ZERO).coefficients[2], factor, distance)
            }
            Self::Rim { axis, distance, radius, is_hollow: true, .. } => {
                let reach = radius - flight.radius;
                let away = axis.place(flight.center).distance;
                let factor = T::whole(8) * reach * distance * away;
                (self.rim::<5>(flight, T::ZERO).coefficients[2], factor, reach)
            }
            _ => return self.approach(flight).map_or(wait, |approach| approach.hop(wait)),
        };
        let pressing = -(curve + curve) / factor;
        if pressing > T::ZERO { hop_of((reach / pressing).sqrt(), wait) } else { wait }
    }
}

/// A flight about a time, seen from a point.
struct Parts<T> {
    position: Vec3<T>,
    velocity: Vec3<T>,
    pull: Vec3<T>,
    /// A time in which much may change.
    period: T,
    /// Of the gap, length.
    rounding: T,
}

impl<T: Real> Parts<T> {
    fn new(axis: &Axis<T>, flight: &FreeFlight<T>, time: T, size: T) -> Self {
        let local = FreeFlight { center: flight.center - axis.center, ..*flight };
        let (position, velocity) = (local.position(time), local.velocity_at(time));
        let pull = flight.pull();
        let [place, speed, strength] = [position, velocity, pull].each(greatest_component);
        let way = place + size + flight.radius;
        let period = way / (speed + (strength * way).sqrt());
        let rounding = T::EPSILON * (way + speed * time);
        Self { position, velocity, pull, period, rounding }
    }
}

/// The coefficients of the square of a vector with these.
fn square<T: Real>([p, v, a]: [Vec3<T>; 3]) -> [T; 5] {
    let two = T::whole(2);
    [p.dot(p), two * p.dot(v), v.dot(v) + two * p.dot(a), two * v.dot(a), a.dot(a)]
}
