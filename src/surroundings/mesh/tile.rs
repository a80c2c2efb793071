//! Tile: a triangle of a mesh, with what it shares with its neighbours.
//!
//! The distance of a mesh is that of its nearest triangle, so contacts at seams cannot come
//! from geometry, only from rounding. What follows keeps them out:
//!
//! - Above a face the contact is that with the face's plane, which triangles of one plane
//!   share bit by bit; a side is measured from the same end for both of its triangles.
//! - Where the plane goes on behind a side, that side is never touched.
//! - A sphere that touches a neighbour of a side does not touch the side: a contact there
//!   can only come when the sphere leaves what is above the neighbour.

use super::Mesh;
use super::seams::unit_normal;
use crate::contact::{FreeFlight, Start, fall_of_height, greatest_component};
use crate::lane::Lane;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::surroundings::facet::{Facet, LOOKED_FOR, Nearest, Side};
use crate::surroundings::pieced::Pieced;
use crate::surroundings::solid::Obstacle;
use crate::surroundings::{Clearance, Plane};
use crate::vec3::Vec3;

/// A triangle of a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tile<'a, T> {
    pub(super) mesh: &'a Mesh<T>,
    pub(super) number: u32,
}

impl<T: Real> Tile<'_, T> {
    fn corner_numbers(&self) -> [u32; 3] {
        self.mesh.net.corners[self.number as usize]
    }

    fn corners(&self) -> [Vec3<T>; 3] {
        self.mesh.corners(self.number)
    }

    /// Its plane.
    fn face(&self) -> Option<Plane<T>> {
        if self.mesh.seams.is_degenerate(self.number) {
            return None;
        }
        let corners = self.mesh.corners(self.mesh.seams.planes[self.number as usize]);
        Some(Plane { point: corners[0], normal: unit_normal(corners) })
    }

    /// The triangle without its neighbours.
    pub(super) fn alone(&self) -> Facet<T> {
        let corners = self.corners();
        let [a, b, c] = corners;
        let sides = [[a, b], [b, c], [c, a]].each(|ends| Side::new(ends, true, false));
        let is_line = self.mesh.seams.is_degenerate(self.number);
        let face = (!is_line).then(|| Plane { point: a, normal: unit_normal(corners) });
        Facet::with(corners, sides, face)
    }

    /// The triangle among its neighbours.
    fn facet(&self) -> Facet<T> {
        let (numbers, corners) = (self.corner_numbers(), self.corners());
        let [a, b, c] = corners;
        let face = self.face();
        let own = (b - a).cross(c - a);
        let is_left = face.is_none_or(|face| own.dot(face.normal) > T::ZERO);
        let sides = array::from_fn(|k| {
            let next = (k + 1) % 3;
            let is_seam = self.mesh.seams.is_seam(self.number, k);
            if numbers[k] < numbers[next] {
                Side::new([corners[k], corners[next]], is_left, is_seam)
            } else {
                Side::new([corners[next], corners[k]], !is_left, is_seam)
            }
        });
        Facet::with(corners, sides, face)
    }

    /// Where a sphere stands to the plane of the triangle.
    #[inline]
    pub(crate) fn clearance_of_plane(&self, center: Vec3<T>, radius: T) -> Clearance<T> {
        match self.facet().face_towards(center) {
            Some(face) => face.clearance(center, radius),
            None => self.clearance(center, radius),
        }
    }

    /// Whether what is nearest to a place is the triangle's own: its face, or a side or a
    /// corner that no neighbour is nearer than.
    #[inline(never)]
    pub(crate) fn is_own(&self, place: Vec3<T>) -> bool {
        let facet = self.facet();
        let nearest = facet.nearest_piece(place);
        !self.is_within_plane(nearest) && self.nearer(&facet, nearest, place).is_empty()
    }

    /// Whether the plane goes on around a side or a corner, as far as this triangle knows.
    fn is_within_plane(&self, nearest: Nearest) -> bool {
        let is_seam = |side: usize| self.mesh.seams.is_seam(self.number, side);
        match nearest {
            Nearest::Face => false,
            Nearest::Side(side) => is_seam(side),
            Nearest::Corner(corner) => is_seam(corner) && is_seam((corner + 2) % 3),
        }
    }

    /// The ways from a side or a corner to neighbours that are nearer to a place, each with
    /// its start.
    fn nearer(&self, facet: &Facet<T>, nearest: Nearest, place: Vec3<T>) -> Vec<Vec3<T>> {
        let (start, ways) = match nearest {
            Nearest::Face => return Vec::new(),
            Nearest::Side(side) => {
                let Side { from, way, .. } = facet.sides[side];
                let across = |other: Vec3<T>| {
                    let offset = other - from;
                    offset - way * (offset.dot(way) / way.length_squared())
                };
                (from, [self.opposite(side).map(across), None])
            }
            Nearest::Corner(corner) => {
                let start = facet.corners[corner];
                let ways = [corner, (corner + 2) % 3];
                (start, ways.each(|side| self.opposite(side).map(|other| other - start)))
            }
        };
        let offset = place - start;
        let is_nearer = |way: &Vec3<T>| {
            let size = greatest_component(place) + T::from_f64(facet.farthest());
            offset.dot(*way) > T::whole(LOOKED_FOR) * T::EPSILON * size * way.length()
        };
        ways.into_iter().flatten().filter(is_nearer).collect()
    }

    /// The corner that a neighbour has beyond a side.
    fn opposite(&self, side: usize) -> Option<Vec3<T>> {
        let (other, back) = self.mesh.net.behind(self.number, side)?;
        let is_line = self.mesh.seams.is_degenerate(other);
        (!is_line).then(|| self.mesh.corners(other)[(back + 2) % 3])
    }

    /// A contact with the sides and corners, at a time before which there is none.
    fn beside(&self, facet: &Facet<T>, flight: &FreeFlight<T>, from: T) -> Option<T> {
        if self.mesh.seams.is_inner(self.number) {
            return None;
        }
        let gap = facet.clearance(flight.center, flight.radius).gap;
        let time = if from > T::ZERO {
            facet.later(flight, Start::Apart, gap, from)
        } else {
            self.beside_now(facet, flight, gap)
        };
        // What a seam is touched by has touched the neighbour before.
        time.filter(|&time| !self.is_within_plane(facet.nearest_piece(flight.position(time))))
    }

    /// A contact with the sides and corners from now on.
    fn beside_now(&self, facet: &Facet<T>, flight: &FreeFlight<T>, gap: T) -> Option<T> {
        if gap > facet.slack(flight) {
            return facet.later(flight, Start::Apart, gap, T::ZERO);
        }
        let nearest = facet.nearest_piece(flight.center);
        let nearer = self.nearer(facet, nearest, flight.center);
        if nearer.is_empty() {
            return facet.collision_time(flight);
        }
        // A neighbour is what is touched. This changes when the centre leaves what is above
        // all of them, or comes above this triangle.
        let start = match nearest {
            Nearest::Side(side) => facet.sides[side].from,
            Nearest::Corner(corner) => facet.corners[corner],
            Nearest::Face => return facet.collision_time(flight),
        };
        let leaves = |way: Vec3<T>| {
            let along = |vector: Vec3<T>| vector.dot(way);
            let height = along(flight.center - start).greater(T::ZERO);
            let (speed, pull) = (along(flight.velocity), along(flight.pull()));
            fall_of_height(height, speed, pull, Start::Apart)
        };
        let own = |corner: usize| {
            let way = facet.corners[corner % 3] - start;
            match nearest {
                Nearest::Side(side) => {
                    let along = facet.sides[side].way;
                    way - along * (way.dot(along) / along.length_squared())
                }
                _ => way,
            }
        };
        let enters = match nearest {
            Nearest::Side(side) => [Some(own(side + 2)), None],
            Nearest::Corner(corner) => [Some(own(corner + 1)), Some(own(corner + 2))],
            Nearest::Face => [None; 2],
        };
        let enters = enters.into_iter().flatten().map(|way| leaves(-way));
        let times = nearer.into_iter().map(leaves).chain(enters);
        let from = times.flatten().reduce(T::lesser)?;
        facet.later(flight, Start::Apart, gap, from)
    }
}

impl<T: Real> Obstacle<T> for Tile<'_, T> {
    #[inline(always)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        self.facet().clearance(center, radius)
    }

    /// With the face, as with its plane; else with sides and corners, not before the plane
    /// is met.
    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        let facet = self.facet();
        let Some(face) = facet.face_towards(flight.center) else {
            return facet.collision_time(flight);
        };
        let gap = face.clearance(flight.center, flight.radius).gap;
        let is_through = gap < -flight.slack(face.point);
        if is_through && !facet.is_above(flight.center, LOOKED_FOR) {
            return self.beside(&facet, flight, T::ZERO);
        }
        let time = face.contact_time(flight)?;
        if facet.is_above(flight.position(time), LOOKED_FOR) {
            return Some(time);
        }
        self.beside(&facet, flight, time)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        Some(self.mesh.bounds_of(self.number))
    }

    fn farthest(&self) -> f64 {
        self.facet().farthest()
    }
}
