//! Chain: a piece of the surface of something solid and round.

use std::sync::Arc;

use super::Clearance;
use super::axis::Axis;
use super::piece::Piece;
use super::pieced::Pieced;
use super::slant::Slant;
use super::solid::Obstacle;
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::Lane;
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// What a sphere touches of a closed [`Revolved`](super::Revolved): lines of its profile from
/// one corner that is concave, as the spheres see it, to the next one.
#[derive(Clone, Debug)]
pub struct Chain<T> {
    axis: Axis<T>,
    /// All lines of the profile, its own first, with the spheres on their right-hand side.
    profile: Arc<[Slant<T>]>,
    /// How many are its own.
    own: usize,
    /// Whether its last one leads to its first one.
    is_loop: bool,
    is_lining: bool,
}

impl<T: Real> Chain<T> {
    /// The chains of a profile about an axis, whose lines have the spheres on their
    /// right-hand side and lead from one to the next, but at the axis.
    pub(super) fn all(axis: Axis<T>, profile: &[Slant<T>], is_lining: bool) -> Vec<Self> {
        let len = profile.len();
        let breaks: Vec<usize> =
            (0..len).filter(|&k| is_break(&profile[(k + len - 1) % len], &profile[k])).collect();
        let is_loop = breaks.is_empty();
        let starts = if is_loop { vec![0] } else { breaks };
        let chain = |k: usize| {
            let start = starts[k];
            let next = starts.get(k + 1).copied().unwrap_or(starts[0] + len);
            let mut profile = profile.to_vec();
            profile.rotate_left(start);
            Self { axis, profile: profile.into(), own: next - start, is_loop, is_lining }
        };
        (0..starts.len()).map(chain).collect()
    }

    fn lines(&self) -> &[Slant<T>] {
        &self.profile[..self.own]
    }

    /// The distance from the chain, negative within the solid, and the unit normal.
    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> (L, Vec3<L>) {
        let place = self.axis.place(place);
        let (always, never) = (L::ZERO.le(L::ZERO), L::ZERO.lt(L::ZERO));
        // A ray out of the axis leaves the solid once more than it enters it.
        let mut is_inside = if self.is_lining { always } else { never };
        let mut best = None;
        for (k, slant) in self.profile.iter().enumerate() {
            if slant.along[1] != T::ZERO {
                let starts_above = L::splat(slant.start[1]).gt(place.height);
                let ends_above = L::splat(slant.end[1]).gt(place.height);
                let is_level = (starts_above & !ends_above) | (ends_above & !starts_above);
                let right = slant.rightward(place.distance, place.height);
                let is_left =
                    if slant.along[1] > T::ZERO { right.lt(L::ZERO) } else { right.gt(L::ZERO) };
                let crosses = is_level & is_left;
                is_inside = (is_inside & !crosses) | (crosses & !is_inside);
            }
            if k < self.own {
                let beside = slant.beside(place.distance, place.height);
                best = Some(best.map_or(beside, |best| beside.or_nearer(best)));
            }
        }
        best.map_or((L::ZERO, Vec3::ZERO), |best| best.about(&self.axis, &place, is_inside))
    }
}

/// Whether a sphere can touch two lines at once where the one leads to the other, or they
/// end at the axis.
fn is_break<T: Real>(before: &Slant<T>, after: &Slant<T>) -> bool {
    let is_on_axis = before.end[0] == T::ZERO || after.start[0] == T::ZERO;
    is_on_axis || turn(before, after) < -(T::whole(4) * T::EPSILON)
}

/// The sine of the angle by which the second line turns to the left.
fn turn<T: Real>(before: &Slant<T>, after: &Slant<T>) -> T {
    before.along[0] * after.along[1] - before.along[1] * after.along[0]
}

impl<T: Real> Obstacle<T> for Chain<T> {
    /// A centre inside is pushed out through the chain.
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        Clearance::off(self.nearest(center), radius)
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        let bounds = self.lines().iter().map(|slant| slant.bounds(&self.axis));
        bounds.reduce(joined).filter(|_| !self.is_lining)
    }

    fn farthest(&self) -> f64 {
        let corners = self.profile.iter().flat_map(|slant| slant.bounds(&self.axis));
        corners.map(|corner| greatest_component(corner.cast::<f64>())).fold(0.0, f64::max)
    }

    fn is_hollow(&self) -> bool {
        self.lines().iter().any(|slant| slant.along[1] < T::ZERO)
    }

    fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        self.long_hop(flight, wait)
    }
}

impl<T: Real> Pieced<T> for Chain<T> {
    /// One that leads from the axis to the axis, always out or up.
    fn is_convex(&self) -> bool {
        !self.is_lining && self.own == self.profile.len() && !self.is_loop && !self.is_hollow()
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        let (distance, normal) = self.nearest(place);
        normal * distance.greater(T::ZERO)
    }

    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        let axis = self.axis;
        let lines = self.lines();
        for (k, slant) in lines.iter().enumerate() {
            let [out, up] = slant.along;
            visit(if up > T::ZERO {
                Piece::Wall { axis, slant: *slant, is_hollow: false }
            } else if up < T::ZERO {
                Piece::Wall { axis, slant: slant.reversed(), is_hollow: true }
            } else {
                Piece::Face { point: axis.point(slant.start[1]), normal: -(axis.direction * out) }
            });
            let first = if self.is_loop { lines.first() } else { None };
            let next = lines.get(k + 1).or(first);
            if next.is_some_and(|next| turn(slant, next) > T::ZERO) {
                visit(Piece::at_end(axis, slant.end));
            }
            // A tip, but not a hollow one.
            for end in [slant.start, slant.end] {
                if end[0] == T::ZERO && up > T::ZERO {
                    visit(Piece::at_end(axis, end));
                }
            }
        }
    }
}
