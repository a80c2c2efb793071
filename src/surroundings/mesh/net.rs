//! Net: which triangles of a mesh are neighbours.
//!
//! Triangles stand in the order of a curve that fills space, and vertices in the order in
//! which triangles come to them: so neighbours in space are neighbours in memory.

use std::collections::HashMap;

use super::MeshError;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::space::hierarchy::{MOST_PARTS, along_curve};
use crate::vec3::Vec3;

/// Whom a triangle has on the other side of a side: its number, or one of these.
pub(super) const OPEN: u32 = u32::MAX;
/// Several others.
pub(super) const SEVERAL: u32 = u32::MAX - 1;
/// Nobody, since the side is a point, or a side of a triangle with such a side.
pub(super) const POINT: u32 = u32::MAX - 2;

/// The least number that is no triangle.
const NO_TRIANGLE: u32 = MOST_PARTS;

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
        let middles: Vec<[f64; 3]> = triangles.iter().map(middle).collect();
        let order = along_curve(&middles);
        drop(middles);
        let mut vertices = Vec::new();
        let mut numbers: HashMap<[u64; 3], u32> = HashMap::with_capacity(points.len());
        let mut number = |corner: u32| {
            let place = places[corner as usize].each(f64::to_bits);
            *numbers.entry(place).or_insert_with(|| {
                vertices.push(points[corner as usize]);
                vertices.len() as u32 - 1
            })
        };
        let corners: Vec<[u32; 3]> =
            order.iter().map(|&k| triangles[k as usize].each(&mut number)).collect();
        let neighbours = neighbours(&corners);
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

/// The neighbours of all triangles.
fn neighbours(corners: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut neighbours = vec![[OPEN; 3]; corners.len()];
    // Of each side its ends, the lesser first, the triangle, and its number there.
    let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * corners.len());
    for (triangle, all) in (0..).zip(corners) {
        let [a, b, c] = *all;
        if a == b || b == c || c == a {
            neighbours[triangle as usize] = [POINT; 3];
            continue;
        }
        for (side, [from, to]) in (0..).zip([[a, b], [b, c], [c, a]]) {
            sides.push(([from.min(to), from.max(to)], triangle << 2 | side));
        }
    }
    sides.sort_unstable();
    for same in sides.chunk_by(|one, other| one.0 == other.0) {
        match *same {
            [_] => {}
            [(_, one), (_, other)] => {
                neighbours[(one >> 2) as usize][(one & 3) as usize] = other >> 2;
                neighbours[(other >> 2) as usize][(other & 3) as usize] = one >> 2;
            }
            _ => {
                for &(_, side) in same {
                    neighbours[(side >> 2) as usize][(side & 3) as usize] = SEVERAL;
                }
            }
        }
    }
    neighbours
}
