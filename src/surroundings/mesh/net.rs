//! Net: which triangles of a mesh are neighbours.
//!
//! Triangles stand in the order of a curve that fills space, and vertices in the order in
//! which triangles come to them: so neighbours in space are neighbours in memory.

use rayon::prelude::*;

use super::MeshError;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::space::curve::{along_curve, first_of_equal};
use crate::space::hierarchy::MOST_PARTS;
use crate::vec3::Vec3;

/// Behind a side stands the number of a triangle, or one of these: none.
pub(super) const OPEN: u32 = u32::MAX;
/// Several others.
pub(super) const SEVERAL: u32 = u32::MAX - 1;
/// None, since the side is a point, or a side of a triangle with such a side.
pub(super) const POINT: u32 = u32::MAX - 2;

/// The least number that is no triangle.
const NO_TRIANGLE: u32 = MOST_PARTS;

/// The number of a point that is no vertex yet.
const NO_VERTEX: u32 = u32::MAX;

/// The triangles of a mesh, by the numbers of their corners, and their neighbours.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Net {
    pub(super) corners: Vec<[u32; 3]>,
    /// Behind the sides from each corner to the next one.
    pub(super) neighbours: Vec<[u32; 3]>,
    /// The numbers that the triangles were given with.
    pub(super) given: Vec<u32>,
}

impl Net {
    /// Of vertices and triangles as they are given, and the vertices in the order of the
    /// net, equal ones once.
    ///
    /// # Errors
    /// If there are no triangles, or too many, or one names a vertex that there is not.
    pub(super) fn new<T: Real>(
        points: &[Vec3<T>],
        triangles: &[[u32; 3]],
    ) -> Result<(Self, Vec<Vec3<T>>), MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::NoTriangles);
        }
        if triangles.len() >= MOST_PARTS as usize {
            return Err(MeshError::TooMany { triangles: triangles.len() as u64 });
        }
        let outside = |&(_, corner): &(usize, &u32)| *corner as usize >= points.len();
        let corners = triangles.iter().enumerate();
        let corners = corners.flat_map(|(triangle, all)| all.iter().map(move |c| (triangle, c)));
        if let Some((triangle, &vertex)) = corners.clone().find(outside) {
            let vertices = points.len();
            return Err(MeshError::NoVertex { triangle, vertex: u64::from(vertex), vertices });
        }
        let finite = |vertex: &Vec3<T>| vertex.to_array().into_iter().all(T::is_finite);
        if let Some(vertex) = points.iter().position(|vertex| !finite(vertex)) {
            return Err(MeshError::NotFinite { vertex });
        }
        let places: Vec<[f64; 3]> =
            points.iter().map(|vertex| vertex.to_array().each(|c| c.to_f64() + 0.0)).collect();
        let middle = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.each(|corner| places[corner as usize]);
            array::from_fn(|k| a[k] / 3.0 + b[k] / 3.0 + c[k] / 3.0)
        };
        let middles: Vec<[f64; 3]> = triangles.par_iter().map(middle).collect();
        let order = along_curve(&middles);
        drop(middles);
        let first = first_of_equal(&places);
        drop(places);
        let mut vertices = Vec::new();
        let mut numbers = vec![NO_VERTEX; points.len()];
        let mut number = |corner: u32| {
            let number = &mut numbers[first[corner as usize] as usize];
            if *number == NO_VERTEX {
                *number = vertices.len() as u32;
                vertices.push(points[corner as usize]);
            }
            *number
        };
        let corners: Vec<[u32; 3]> =
            order.iter().map(|&k| triangles[k as usize].each(&mut number)).collect();
        let neighbours = neighbours(&corners, vertices.len());
        vertices.shrink_to_fit();
        Ok((Self { corners, neighbours, given: order }, vertices))
    }

    /// How many triangles there are.
    pub(super) fn len(&self) -> u32 {
        self.corners.len() as u32
    }

    /// The triangle behind a side, if it is one, and the number that the side has there.
    pub(super) fn behind(&self, triangle: u32, side: usize) -> Option<(u32, usize)> {
        let other = self.neighbours[triangle as usize][side];
        if other >= NO_TRIANGLE {
            return None;
        }
        let back = self.neighbours[other as usize];
        back.iter().position(|&neighbour| neighbour == triangle).map(|side| (other, side))
    }
}

/// The neighbours of all triangles between a number of vertices.
fn neighbours(corners: &[[u32; 3]], vertices: usize) -> Vec<[u32; 3]> {
    let mut neighbours = vec![[OPEN; 3]; corners.len()];
    let sides = Sides::new(corners, vertices, &mut neighbours);
    let mut set = |side: u32, neighbour| {
        neighbours[(side >> 2) as usize][(side & 3) as usize] = neighbour;
    };
    sides.for_each_common(|same| match *same {
        [_] => {}
        [(_, one), (_, other)] => {
            set(one, other >> 2);
            set(other, one >> 2);
        }
        _ => same.iter().for_each(|&(_, side)| set(side, SEVERAL)),
    });
    neighbours
}

/// The sides of triangles, by their lesser vertices: vertices stand in the order of the
/// triangles, so this is sorted in `O(n)`, with neighbours in memory.
struct Sides {
    /// Of each side its greater vertex; its triangle, and its number there.
    all: Vec<(u32, u32)>,
    /// Where those of each vertex end.
    ends: Vec<u32>,
}

impl Sides {
    /// Triangles with a side that is a point have no other, and are marked so.
    fn new(corners: &[[u32; 3]], vertices: usize, neighbours: &mut [[u32; 3]]) -> Self {
        let has_point = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
        let mut ends = vec![0_u32; vertices];
        for (all, behind) in corners.iter().zip(neighbours) {
            if has_point(*all) {
                *behind = [POINT; 3];
            } else {
                sides(*all).for_each(|([lesser, _], _)| ends[lesser as usize] += 1);
            }
        }
        let mut total = 0;
        for end in &mut ends {
            total += core::mem::replace(end, total);
        }
        let mut all = vec![(0, 0); total as usize];
        for (triangle, &corners) in (0..).zip(corners) {
            if !has_point(corners) {
                for ([lesser, greater], side) in sides(corners) {
                    let end = &mut ends[lesser as usize];
                    all[*end as usize] = (greater, triangle << 2 | side);
                    *end += 1;
                }
            }
        }
        Self { all, ends }
    }

    /// Visits those between the same two vertices together.
    fn for_each_common(mut self, mut visit: impl FnMut(&[(u32, u32)])) {
        let mut start = 0;
        for end in self.ends {
            let of_vertex = &mut self.all[start..end as usize];
            of_vertex.sort_unstable();
            of_vertex.chunk_by(|one, other| one.0 == other.0).for_each(&mut visit);
            start = end as usize;
        }
    }
}

/// The sides of a triangle from each corner to the next, as the lesser and the greater
/// vertex and their numbers.
fn sides([a, b, c]: [u32; 3]) -> impl Iterator<Item = ([u32; 2], u32)> {
    [[a, b], [b, c], [c, a]].into_iter().map(|[from, to]| [from.min(to), from.max(to)]).zip(0..)
}
