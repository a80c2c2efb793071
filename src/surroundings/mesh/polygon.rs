//! Polygon: a face of many corners cut into triangles.
//!
//! An ear is a corner whose triangle lies inside of the polygon and has no other corner in
//! it. A polygon without holes always has two, so that cutting them off one by one ends
//! (G. H. Meisters, *Polygons have ears*, 1975).

use crate::numbers::array::Each;
use crate::vec3::Vec3;

/// Adds the triangles of a polygon, by its corners among the vertices. One that is not flat
/// is seen along its mean normal; one that crosses itself is cut as it comes.
pub(super) fn triangulated(corners: &[u32], vertices: &[[f64; 3]], triangles: &mut Vec<[u32; 3]>) {
    let place = |corner: u32| Vec3::from(vertices[corner as usize]);
    let mut left = corners.to_vec();
    let normal = mean_normal(&left.iter().map(|&corner| place(corner)).collect::<Vec<_>>());
    while left.len() > 3 {
        let count = left.len();
        let triangle = |k: usize| [left[(k + count - 1) % count], left[k], left[(k + 1) % count]];
        let is_ear = |&k: &usize| {
            let [a, b, c] = triangle(k).each(place);
            let turns = |a: Vec3<f64>, b: Vec3<f64>, c: Vec3<f64>| (b - a).cross(c - a).dot(normal);
            let is_inside = |p: Vec3<f64>| {
                turns(a, b, p) >= 0.0 && turns(b, c, p) >= 0.0 && turns(c, a, p) >= 0.0
            };
            let own = triangle(k);
            let mut others = left.iter().filter(|corner| !own.contains(corner));
            turns(a, b, c) > 0.0 && !others.any(|&other| is_inside(place(other)))
        };
        let ear = (0..count).find(is_ear).unwrap_or(1);
        triangles.push(triangle(ear));
        left.remove(ear);
    }
    if let [a, b, c] = left[..] {
        triangles.push([a, b, c]);
    }
}

/// The sum of the normals of the triangles to a corner (Newell's method).
fn mean_normal(places: &[Vec3<f64>]) -> Vec3<f64> {
    let Some(&start) = places.first() else { return Vec3::ZERO };
    let pairs = places.windows(2);
    pairs.fold(Vec3::ZERO, |sum, pair| sum + (pair[0] - start).cross(pair[1] - start))
}
