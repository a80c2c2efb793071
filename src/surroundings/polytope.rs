//! Polytope: a solid with flat faces and no dents.

use std::collections::HashMap;
use std::sync::Arc;

use super::Clearance;
use super::axis::Axis;
use super::piece::Piece;
use super::pieced::Pieced;
use super::solid::Obstacle;
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::Lane;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// What a sphere touches of a [`Hull`](super::Hull).
#[derive(Clone, Debug)]
pub struct Polytope<T> {
    faces: Arc<[Face<T>]>,
    /// Of all faces, in their order.
    sides: Arc<[Side<T>]>,
    corners: Arc<[Vec3<T>]>,
    bounds: [Vec3<T>; 2],
}

/// A face.
#[derive(Clone, Copy, Debug)]
struct Face<T> {
    point: Vec3<T>,
    /// Unit vector, outwards.
    normal: Vec3<T>,
    /// Where its sides begin and end.
    sides: [usize; 2],
}

/// A side of a face.
#[derive(Clone, Copy, Debug)]
struct Side<T> {
    start: Vec3<T>,
    /// To its other end.
    along: Vec3<T>,
    length_squared: T,
    /// Across it, into the face.
    inward: Vec3<T>,
    /// Whether it stands for the edge that the face has in common with another one.
    is_first: bool,
}

/// Faces in one plane to this many ε of the coordinates are one face.
const LEVEL: i32 = 8;

impl<T: Real> Polytope<T> {
    /// Within triangles that are closed, each counterclockwise as seen from outside.
    pub(super) fn new(points: &[Vec3<T>], triangles: &[[usize; 3]]) -> Self {
        let (faces_of, planes) = level_faces(points, triangles);
        let sides = || {
            triangles
                .iter()
                .zip(&faces_of)
                .flat_map(|(&[a, b, c], &face)| [(a, b, face), (b, c, face), (c, a, face)])
        };
        let across: HashMap<(usize, usize), usize> =
            sides().map(|(a, b, face)| ((b, a), face)).collect();
        let beyond = |a: usize, b: usize| across.get(&(a, b)).copied();
        let (mut faces, mut all, mut corners) = (Vec::new(), Vec::new(), Vec::new());
        for (number, &(point, normal)) in planes.iter().enumerate() {
            let first = all.len();
            for (a, b, face) in sides() {
                let other = beyond(a, b).unwrap_or(face);
                if face != number || other == number {
                    continue;
                }
                let along = points[b] - points[a];
                all.push(Side {
                    start: points[a],
                    along,
                    length_squared: along.length_squared(),
                    inward: normal.cross(along),
                    is_first: face < other,
                });
                corners.push(a);
            }
            faces.push(Face { point, normal, sides: [first, all.len()] });
        }
        corners.sort_unstable();
        corners.dedup();
        let corners: Vec<Vec3<T>> = corners.into_iter().map(|corner| points[corner]).collect();
        let least = corners.iter().copied().reduce(Vec3::lesser).unwrap_or(Vec3::ZERO);
        let greatest = corners.iter().copied().reduce(Vec3::greater).unwrap_or(Vec3::ZERO);
        Self {
            faces: faces.into(),
            sides: all.into(),
            corners: corners.into(),
            bounds: [least, greatest],
        }
    }

    /// The distance from the surface, negative inside, and the unit normal.
    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> (L, Vec3<L>) {
        let never = L::ZERO.lt(L::ZERO);
        // Of the face that is least far below, of one that is straight below, of an edge.
        let (mut highest, mut level, mut edge) = (None, (L::ZERO, Vec3::ZERO, never), None);
        for face in self.faces.iter() {
            let normal = Vec3::<L>::splat(face.normal);
            let height = (place - Vec3::splat(face.point)).dot(normal);
            let mut is_above = height.ge(L::ZERO);
            for side in &self.sides[face.sides[0]..face.sides[1]] {
                let offset = place - Vec3::splat(side.start);
                is_above = is_above & offset.dot(Vec3::splat(side.inward)).ge(L::ZERO);
                if side.is_first {
                    let along = Vec3::<L>::splat(side.along);
                    let share = offset.dot(along) / L::splat(side.length_squared);
                    let offset = offset - along * share.greater(L::ZERO).lesser(L::ONE);
                    let squared = offset.length_squared();
                    let (least, to_least) = edge.unwrap_or((squared, offset));
                    let is_nearer = squared.lt(least);
                    edge = Some((
                        L::select(is_nearer, squared, least),
                        Vec3::select(is_nearer, offset, to_least),
                    ));
                }
            }
            level.0 = L::select(is_above, height, level.0);
            level.1 = Vec3::select(is_above, normal, level.1);
            level.2 = level.2 | is_above;
            let (most, out) = highest.unwrap_or((height, normal));
            let is_higher = height.gt(most);
            highest =
                Some((L::select(is_higher, height, most), Vec3::select(is_higher, normal, out)));
        }
        let nothing = (L::ZERO, Vec3::ZERO);
        let (height, face) = highest.unwrap_or(nothing);
        let (squared, offset) = edge.unwrap_or(nothing);
        let distance = squared.sqrt();
        let is_inside = height.le(L::ZERO) | !distance.gt(L::ZERO);
        let away = offset * (L::ONE / distance);
        let outside = L::select(level.2, level.0, distance);
        let normal = Vec3::select(level.2, level.1, away);
        (L::select(is_inside, height, outside), Vec3::select(is_inside, face, normal))
    }
}

/// A point of each plane, and its unit normal.
type Planes<T> = Vec<(Vec3<T>, Vec3<T>)>;

/// The number of the face that each triangle is of, and of every face a point and the
/// normal: that of its greatest triangle, for all that lie in one plane with it.
fn level_faces<T: Real>(points: &[Vec3<T>], triangles: &[[usize; 3]]) -> (Vec<usize>, Planes<T>) {
    let area = |[a, b, c]: [usize; 3]| (points[b] - points[a]).cross(points[c] - points[a]);
    let sides = |triangle: usize| {
        let [a, b, c] = triangles[triangle];
        [(a, b), (b, c), (c, a)]
    };
    let of_side: HashMap<(usize, usize), usize> =
        (0..triangles.len()).flat_map(|k| sides(k).each(|side| (side, k))).collect();
    let mut order: Vec<(T, usize)> =
        triangles.iter().enumerate().map(|(k, &all)| (area(all).length_squared(), k)).collect();
    order.sort_by(|a, b| b.0.partial_cmp(&a.0).unwrap_or(core::cmp::Ordering::Equal));
    let farthest = points.iter().copied().map(greatest_component).fold(T::ZERO, T::greater);
    let rounding = T::whole(LEVEL) * T::EPSILON * farthest;
    let (mut face_of, mut planes) = (vec![None; triangles.len()], Vec::new());
    for (_, greatest) in order {
        if face_of[greatest].is_some() {
            continue;
        }
        let (point, normal) = (points[triangles[greatest][0]], area(triangles[greatest]));
        let normal = normal * (T::ONE / normal.length());
        let mut waiting = vec![greatest];
        while let Some(triangle) = waiting.pop() {
            let mut heights =
                triangles[triangle].iter().map(|&k| (points[k] - point).dot(normal).abs());
            let is_new = face_of[triangle].is_none();
            if is_new && (triangle == greatest || heights.all(|height| height <= rounding)) {
                face_of[triangle] = Some(planes.len());
                waiting.extend(sides(triangle).iter().filter_map(|&(a, b)| of_side.get(&(b, a))));
            }
        }
        planes.push((point, normal));
    }
    (face_of.into_iter().flatten().collect(), planes)
}

impl<T: Real> Obstacle<T> for Polytope<T> {
    /// A centre inside is pushed out through the nearest face.
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        Clearance::off(self.nearest(center), radius)
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        Some(self.bounds)
    }

    fn farthest(&self) -> f64 {
        let [lower, upper] = self.bounds.each(|corner| greatest_component(corner.cast::<f64>()));
        lower.max(upper)
    }
}

impl<T: Real> Pieced<T> for Polytope<T> {
    fn is_convex(&self) -> bool {
        true
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        let (distance, normal) = self.nearest(place);
        normal * distance.greater(T::ZERO)
    }

    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        for &Face { point, normal, .. } in self.faces.iter() {
            visit(Piece::Face { point, normal });
        }
        for side in self.sides.iter().filter(|side| side.is_first) {
            let direction = side.along * (T::ONE / side.along.length());
            let axis = Axis { center: side.start, direction };
            visit(Piece::Edge { axis, radius: T::ZERO, is_hollow: false });
        }
        for &center in self.corners.iter() {
            visit(Piece::Corner { center, radius: T::ZERO, is_hollow: false });
        }
    }
}
