//! Convex hull: the triangles around some points.
//!
//! Points are added one by one: the triangles that one sees give way to those that join it
//! to their border. Which side of a plane a point is on is the sign of a determinant, exact
//! where rounding could change it: so triangles never overlap nor leave a hole.

use std::collections::HashSet;

use crate::compensated::{ExactSum, two_product};
use crate::contact::greatest_component;
use crate::numbers::array::Each;
use crate::vec3::Vec3;

/// The triangles of the hull, by the numbers of their corners, counterclockwise as seen from
/// outside; `None` if the points lie in one plane, or nearer to it than `rounding` of their
/// extent.
pub(super) fn hull_triangles(points: &[Vec3<f64>], rounding: f64) -> Option<Vec<[usize; 3]>> {
    let points = within_one(points);
    let first = first_triangles(&points, rounding)?;
    let mut triangles = first.to_vec();
    for (number, &point) in points.iter().enumerate() {
        let sees = |triangle: &[usize; 3]| is_above(triangle.each(|k| points[k]), point);
        let (seen, unseen): (Vec<_>, Vec<_>) = triangles.into_iter().partition(sees);
        triangles = unseen;
        let sides = || seen.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let inner: HashSet<[usize; 2]> = sides().collect();
        let border = sides().filter(|&[a, b]| !inner.contains(&[b, a]));
        triangles.extend(border.map(|[a, b]| [a, b, number]));
    }
    Some(triangles)
}

/// The points in a unit of length, a power of two, in which products of three coordinates
/// are in the range of numbers.
fn within_one(points: &[Vec3<f64>]) -> Vec<Vec3<f64>> {
    let greatest = points.iter().copied().map(greatest_component).fold(f64::MIN_POSITIVE, f64::max);
    let exponent = (greatest.to_bits() >> 52) as i32 - 1023;
    points.iter().map(|&point| point * 2_f64.powi(-exponent)).collect()
}

/// The four triangles about points that are far apart.
fn first_triangles(points: &[Vec3<f64>], rounding: f64) -> Option<[[usize; 3]; 4]> {
    let farthest = |distance: &dyn Fn(Vec3<f64>) -> f64| {
        let distances = points.iter().map(|point| distance(*point)).enumerate();
        distances.reduce(|a, b| if b.1 > a.1 { b } else { a })
    };
    let start = *points.first()?;
    let (a, _) = farthest(&|point| (point - start).length())?;
    let (b, extent) = farthest(&|point| (point - points[a]).length())?;
    let along = points[b] - points[a];
    let (c, area) = farthest(&|point| along.cross(point - points[a]).length())?;
    if extent.is_nan() || area <= rounding * extent * extent {
        return None;
    }
    let normal = along.cross(points[c] - points[a]);
    let (d, volume) = farthest(&|point| normal.dot(point - points[a]).abs())?;
    if volume <= rounding * extent * area {
        return None;
    }
    let [b, c] = if is_above([a, b, c].each(|k| points[k]), points[d]) { [c, b] } else { [b, c] };
    Some([[a, b, c], [a, c, d], [c, b, d], [b, a, d]])
}

/// Whether a point is on the side of a plane from which its three points are seen
/// counterclockwise: `(b − a)·((c − a) × (p − a)) > 0`.
///
/// The bound of the rounding error is that of J. R. Shewchuk, *Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates*, 1997.
fn is_above([a, b, c]: [Vec3<f64>; 3], point: Vec3<f64>) -> bool {
    let (u, v, w) = (b - a, c - a, point - a);
    let volume = u.dot(v.cross(w));
    let size = |x: f64, y: f64, z: f64| Vec3::new(x.abs(), y.abs(), z.abs());
    let [u, v, w] = [u, v, w].each(|Vec3 { x, y, z }| size(x, y, z));
    let permanent = u.x * (v.y * w.z + v.z * w.y)
        + u.y * (v.z * w.x + v.x * w.z)
        + u.z * (v.x * w.y + v.y * w.x);
    if volume.abs() > 4.0 * f64::EPSILON * permanent {
        return volume > 0.0;
    }
    let mut sum = ExactSum::default();
    add_volume(&mut sum, 1.0, [b, c, point]);
    add_volume(&mut sum, -1.0, [a, c, point]);
    add_volume(&mut sum, 1.0, [a, b, point]);
    add_volume(&mut sum, -1.0, [a, b, c]);
    sum.value() > 0.0
}

/// Adds `± u·(v × w)`, exactly.
fn add_volume(sum: &mut ExactSum, sign: f64, vectors: [Vec3<f64>; 3]) {
    let [u, v, w] = vectors.each(Vec3::to_array);
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        for (sign, j, k) in [(sign, j, k), (-sign, k, j)] {
            let (product, rest) = two_product(u[i], v[j]);
            for factor in [product, rest] {
                let (product, rest) = two_product(factor, w[k]);
                sum.add(sign * product);
                sum.add(sign * rest);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every side of a triangle is that of one other one, the other way round, no point is
    /// above a triangle, and Euler's formula holds.
    fn is_closed(points: &[Vec3<f64>], triangles: &[[usize; 3]]) -> bool {
        let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let sides: Vec<_> = sides.collect();
        let set: HashSet<_> = sides.iter().copied().collect();
        let corners: HashSet<_> = triangles.iter().flatten().collect();
        set.len() == sides.len()
            && sides.iter().all(|&[a, b]| set.contains(&[b, a]))
            && corners.len() + triangles.len() == sides.len() / 2 + 2
            && triangles.iter().all(|triangle| {
                points.iter().all(|&point| !is_above(triangle.map(|k| points[k]), point))
            })
    }

    /// Numbers between -1 and 1 with few digits, or with many.
    fn places(count: u64, digits: u32) -> Vec<Vec3<f64>> {
        let mut state = 7_u64;
        let mut number = || {
            state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
            ((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0) * f64::from(1 << digits)
        };
        let mut place = || Vec3::new(number().round(), number().round(), number().round());
        (0..count).map(|_| place() * (1.0 / f64::from(1 << digits))).collect()
    }

    #[test]
    fn the_hull_is_closed_and_holds_all_points() {
        // On a lattice of 3, 5, 17 places a side most points lie in planes with others.
        for (count, digits) in [(5, 20), (40, 20), (400, 20), (200, 1), (300, 2), (500, 4)] {
            let mut points = places(count, digits);
            let triangles = hull_triangles(&points, 1e-15).unwrap();
            assert!(is_closed(&points, &triangles), "{count} points of {digits} digits");
            // Turned, planes are planes to rounding only.
            for point in &mut points {
                *point = Vec3::new(
                    0.6 * point.x - 0.8 * point.y,
                    0.8 * point.x + 0.6 * point.y,
                    point.z,
                );
                *point = Vec3::new(
                    point.x,
                    0.28 * point.y - 0.96 * point.z,
                    0.96 * point.y + 0.28 * point.z,
                ) + Vec3::new(3.0, 0.1, 0.7);
            }
            let triangles = hull_triangles(&points, 1e-15).unwrap();
            assert!(is_closed(&points, &triangles), "{count} turned points of {digits} digits");
        }
    }

    #[test]
    fn points_of_a_plane_have_no_hull() {
        let flat: Vec<_> = places(50, 8).iter().map(|p| Vec3::new(p.x, p.y, p.x - p.y)).collect();
        assert_eq!(hull_triangles(&flat, 1e-15), None);
        let line: Vec<_> = places(50, 8).iter().map(|p| Vec3::new(p.x, p.x, p.x)).collect();
        assert_eq!(hull_triangles(&line, 1e-15), None);
        assert_eq!(hull_triangles(&[Vec3::ZERO; 8], 1e-15), None);
        assert_eq!(hull_triangles(&[], 1e-15), None);
    }
}
