//! Outline: the edges of a surface of triangles.

use std::collections::HashMap;

use carom::Vec3;
use carom::surroundings::{Plane, Shape};

use super::shown::Bounds;

/// Three corners.
pub type Triangle = [Vec3<f64>; 3];

/// Corners of a circle.
pub const AROUND: usize = 72;

/// The most triangles of a part that are drawn with their edges.
pub const MOST_WITH_EDGES: usize = 40_000;

/// The cosine of the angle by which two faces differ at an edge that is seen.
const CREASE: f64 = 0.84;

/// An edge, and the numbers of the triangles that it is of.
pub struct Edge {
    pub ends: [Vec3<f64>; 2],
    pub of: Vec<usize>,
}

impl Edge {
    /// Whether it is seen from everywhere: the surface ends there, or has an edge, by the unit
    /// normals of its triangles.
    pub fn is_sharp(&self, normals: &[Vec3<f64>]) -> bool {
        match self.of[..] {
            [a, b] => normals[a].dot(normals[b]) < CREASE,
            _ => true,
        }
    }
}

/// All edges of triangles, those of one place once, in an order that is always the same.
pub fn edges(triangles: &[Triangle]) -> Vec<Edge> {
    let mut edges: Vec<Edge> = Vec::new();
    let mut known: HashMap<[[u64; 3]; 2], usize> = HashMap::new();
    for (index, [a, b, c]) in triangles.iter().enumerate() {
        for ends in [[*a, *b], [*b, *c], [*c, *a]] {
            // Without a sign of zero.
            let mut key = ends.map(|end| (end + Vec3::ZERO).to_array().map(f64::to_bits));
            key.sort_unstable();
            if key[0] == key[1] {
                continue;
            }
            let number = *known.entry(key).or_insert(edges.len());
            match edges.get_mut(number) {
                Some(edge) => edge.of.push(index),
                None => edges.push(Edge { ends, of: vec![index] }),
            }
        }
    }
    edges
}

/// The unit normal of a triangle, to where its corners go counter-clockwise.
pub fn normal([a, b, c]: &Triangle) -> Vec3<f64> {
    let normal = (*b - *a).cross(*c - *a);
    let length = normal.length();
    if length > 0.0 { normal * (1.0 / length) } else { normal }
}

/// The area of a triangle.
pub fn area([a, b, c]: &Triangle) -> f64 {
    (*b - *a).cross(*c - *a).length() * 0.5
}

/// The triangles of all parts; what has no end fills a box. Of a plane nothing is left that is
/// behind another one.
pub fn surfaces(shapes: &[Shape<f64>], within: Bounds) -> Vec<(&Shape<f64>, Vec<Triangle>)> {
    let planes = || {
        shapes.iter().filter_map(|shape| match shape {
            Shape::Plane(plane) => Some(plane),
            _ => None,
        })
    };
    let surface = |shape: &Shape<f64>| {
        let triangles = shape.triangles(within, AROUND);
        let Shape::Plane(own) = shape else { return triangles };
        let first = triangles.first().into_iter().flatten().copied();
        let others = triangles.iter().skip(1).map(|corners| corners[2]);
        let polygon: Vec<Vec3<f64>> = first.chain(others).collect();
        let polygon = planes().filter(|plane| *plane != own).fold(polygon, in_front);
        polygon
            .get(1..)
            .unwrap_or_default()
            .windows(2)
            .map(|ends| [polygon[0], ends[0], ends[1]])
            .collect()
    };
    shapes.iter().map(|shape| (shape, surface(shape))).collect()
}

/// The part of a polygon that is in front of a plane.
fn in_front(polygon: Vec<Vec3<f64>>, plane: &Plane<f64>) -> Vec<Vec3<f64>> {
    let height = |point: Vec3<f64>| (point - plane.point).dot(plane.normal);
    let mut kept = Vec::new();
    for (&a, &b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let [from, to] = [height(a), height(b)];
        if from >= 0.0 {
            kept.push(a);
        }
        if (from < 0.0) != (to < 0.0) {
            kept.push(a + (b - a) * (from / (from - to)));
        }
    }
    kept
}

/// Whether a part is a wall about spheres, or among them.
pub fn is_wall(shape: &Shape<f64>) -> bool {
    matches!(shape, Shape::Plane(_)) || shape.interior().is_some()
}

#[cfg(test)]
mod tests {
    use carom::surroundings::Cuboid;

    use super::*;

    #[test]
    fn planes_end_where_they_meet() {
        let [up, over] = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
        let shapes = [up, over].map(|normal| Shape::from(Plane::new([0.0; 3], normal)));
        let within = [Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 1.0)];
        for (_, triangles) in surfaces(&shapes, within) {
            assert_eq!(triangles.iter().map(area).sum::<f64>(), 2.0);
        }
        let far = [Vec3::new(1.0, 1.0, 1.0), Vec3::new(2.0, 2.0, 2.0)];
        assert!(surfaces(&shapes, far).iter().all(|(_, triangles)| triangles.is_empty()));
    }

    #[test]
    fn a_box_has_twelve_edges() {
        let shape = Shape::from(Cuboid::solid([-1.0; 3], [0.0, 1.0, 2.0]));
        let triangles = shape.triangles([Vec3::ZERO; 2], AROUND);
        let normals: Vec<Vec3<f64>> = triangles.iter().map(normal).collect();
        let edges = edges(&triangles);
        // Six of them are the diagonals of faces.
        assert_eq!(edges.len(), 18);
        assert_eq!(edges.iter().filter(|edge| edge.is_sharp(&normals)).count(), 12);
        let area: f64 = triangles.iter().map(area).sum();
        assert_eq!(area, 2.0 * (2.0 + 3.0 + 6.0));
    }
}
