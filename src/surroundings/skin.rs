//! Skin: the surface of a shape as triangles, for pictures of it.

use super::axis::{Axis, pi};
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::space::Bounds;
use crate::trigonometry::sin_cos;
use crate::vec3::Vec3;

/// Three corners, counter-clockwise as seen from where spheres are.
pub(super) type Corners<T> = [Vec3<T>; 3];

/// How finely a surface is cut into triangles, and how far one without end goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Detail<T> {
    /// The corners of a box that is to be filled, length.
    pub(crate) within: Bounds<T>,
    /// How many corners a circle has.
    pub(crate) around: usize,
}

impl<T: Real> Detail<T> {
    /// From where to where the box goes along an axis.
    pub(super) fn heights(&self, axis: &Axis<T>) -> [T; 2] {
        let heights = self.corners().each(|corner| (corner - axis.center).dot(axis.direction));
        let [first, ..] = heights;
        heights
            .into_iter()
            .fold([first; 2], |[low, high], height| [low.lesser(height), high.greater(height)])
    }

    fn corners(&self) -> [Vec3<T>; 8] {
        let [lower, upper] = self.within;
        array::from_fn(|k| {
            let pick = |bit: usize, low: T, high: T| if k >> bit & 1 == 0 { low } else { high };
            Vec3::new(
                pick(0, lower.x, upper.x),
                pick(1, lower.y, upper.y),
                pick(2, lower.z, upper.z),
            )
        })
    }

    /// A plane as far as the box goes.
    pub(super) fn plane(&self, point: Vec3<T>, normal: Vec3<T>) -> Vec<Corners<T>> {
        let corners = self.corners();
        let heights = corners.each(|corner| (corner - point).dot(normal));
        let mut places = Vec::new();
        for from in 0..8_usize {
            for to in [1, 2, 4].map(|bit| from | bit).into_iter().filter(|to| *to != from) {
                let (a, b) = (heights[from], heights[to]);
                if (a < T::ZERO) != (b < T::ZERO) {
                    places.push(corners[from] + (corners[to] - corners[from]) * (a / (a - b)));
                }
            }
        }
        let count = T::whole(places.len().max(1) as i32);
        let sum = places.iter().fold(Vec3::ZERO, |sum, place| sum + *place);
        let axis = Axis { center: sum * (T::ONE / count), direction: normal };
        let (right, up) = across(&axis);
        let angle = |place: &Vec3<T>| {
            let offset = *place - axis.center;
            offset.dot(up).to_f64().atan2(offset.dot(right).to_f64())
        };
        places.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        fan(&places)
    }

    /// A profile of distances from an axis and heights, turned about it: seen from its
    /// right-hand side, with the axis on the left of what goes up.
    pub(super) fn turned(&self, axis: &Axis<T>, profile: &[[T; 2]]) -> Vec<Corners<T>> {
        let (right, up) = across(axis);
        let turn = |k: usize| {
            let angle = pi::<T>() * T::whole(2) * T::whole((k % self.around) as i32);
            let (sine, cosine) = sin_cos(angle / T::whole(self.around as i32));
            right * cosine + up * sine
        };
        let turns: Vec<Vec3<T>> = (0..=self.around).map(turn).collect();
        let place = |[distance, height]: [T; 2], out: Vec3<T>| axis.point(height) + out * distance;
        let mut triangles = Vec::new();
        for ends in profile.windows(2) {
            for outs in turns.windows(2) {
                let [a, b] = [place(ends[0], outs[0]), place(ends[0], outs[1])];
                let [c, d] = [place(ends[1], outs[0]), place(ends[1], outs[1])];
                if ends[0][0] > T::ZERO {
                    triangles.push([a, b, d]);
                }
                if ends[1][0] > T::ZERO {
                    triangles.push([a, d, c]);
                }
            }
        }
        triangles
    }

    /// Places on an arc of a profile, about one, from an angle to another in quarters of a
    /// turn; an angle of 0 leads out of the axis.
    pub(super) fn arc(&self, center: [T; 2], radius: T, quarters: [i32; 2]) -> Vec<[T; 2]> {
        let count = (self.around as i32 * (quarters[1] - quarters[0]) / 4).max(2);
        let place = |k: i32| {
            let share = T::ratio(k, count) * T::whole(quarters[1] - quarters[0]);
            let angle = (share + T::whole(quarters[0])) * pi::<T>() * T::ratio(1, 2);
            let (sine, cosine) = sin_cos(angle);
            let distance = center[0] + radius * cosine;
            // A quarter of a turn up or down from an axis leads along it.
            let is_pole = center[0] == T::ZERO
                && (k == 0 && quarters[0] % 2 != 0 || k == count && quarters[1] % 2 != 0);
            [if is_pole { T::ZERO } else { distance }, center[1] + radius * sine]
        };
        let mut places: Vec<[T; 2]> = (0..=count).map(place).collect();
        if quarters[1] - quarters[0] == 4 {
            // A whole circle ends where it begins, bit by bit.
            places[count as usize] = places[0];
        }
        places
    }
}

/// Two unit vectors across an axis, with the right hand about it.
fn across<T: Real>(axis: &Axis<T>) -> (Vec3<T>, Vec3<T>) {
    let right = axis.side();
    (right, axis.direction.cross(right))
}

/// The triangles of a polygon without dents.
pub(super) fn fan<T: Real>(places: &[Vec3<T>]) -> Vec<Corners<T>> {
    let Some((&first, rest)) = places.split_first() else { return Vec::new() };
    rest.windows(2).map(|ends| [first, ends[0], ends[1]]).collect()
}

/// Seen from the other side, if it is a container.
pub(super) fn from_inside<T: Real>(triangles: Vec<Corners<T>>, inside: bool) -> Vec<Corners<T>> {
    if !inside {
        return triangles;
    }
    triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}

#[cfg(test)]
mod tests {
    use crate::surroundings::*;

    /// Six times the volume within triangles, positive if they are seen from outside.
    fn volume(shape: impl Into<Shape<f64>>) -> f64 {
        let within = [Vec3::new(-2.0, -3.0, -4.0), Vec3::new(2.0, 3.0, 4.0)];
        let triangles = shape.into().triangles(within, 256);
        let center = Vec3::new(0.1, 0.2, 0.3);
        let part = |[a, b, c]: [Vec3<f64>; 3]| (a - center).dot((b - center).cross(c - center));
        triangles.into_iter().map(part).sum::<f64>() / 6.0
    }

    fn is_near(found: f64, wanted: f64) {
        assert!((found / wanted - 1.0).abs() < 1e-3, "{found} is not {wanted}");
    }

    #[test]
    fn triangles_go_around_what_shapes_fill() {
        use core::f64::consts::PI;
        let (origin, up) = ([0.0; 3], [0.0, 0.6, 0.8]);
        is_near(volume(FixedSphere::solid(origin, 1.5)), 4.5 * PI);
        is_near(volume(FixedSphere::container(origin, 1.5)), -4.5 * PI);
        is_near(volume(Cuboid::solid(origin, [1.0, 2.0, 3.0])), 6.0);
        is_near(volume(Cuboid::container(origin, [1.0, 2.0, 3.0])), -6.0);
        is_near(volume(Cylinder::solid(origin, up, 0.5, Some(4.0))), PI);
        is_near(volume(Cylinder::container(origin, up, 0.5, Some(4.0))), -PI);
        is_near(volume(Capsule::solid(origin, up, 1.0)), PI * (1.0 + 4.0 / 3.0));
        is_near(volume(Cone::solid(origin, up, 3.0, [1.0, 0.0])), PI);
        is_near(volume(Torus::solid(origin, up, 2.0, 0.5)), PI * PI);
        is_near(
            volume(Revolved::solid(origin, up, [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0]])),
            PI / 1.5,
        );
        is_near(
            volume(Revolved::solid(origin, up, [[0.0, 1.0], [1.0, 0.0], [0.0, -1.0]])),
            PI / 1.5,
        );
        let corners = [origin, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        is_near(volume(Hull::new(corners)), 1.0 / 6.0);
        let pin = FixedSphere::solid(origin, 0.5);
        is_near(volume(Copies::new(pin).along([2.0, 0.0, 0.0], 4)), 4.0 * PI / 6.0);
        is_near(volume(Sensor::new(pin)), PI / 6.0);
    }

    /// Each side of a triangle is that of another one, the other way, bit by bit.
    #[test]
    fn what_is_closed_has_no_border() {
        let (origin, up) = ([0.0; 3], [0.0, 0.6, 0.8]);
        let shapes: [Shape<f64>; 6] = [
            FixedSphere::solid(origin, 1.5).into(),
            Cuboid::solid(origin, [1.0, 2.0, 3.0]).into(),
            Cylinder::solid(origin, up, 0.5, Some(4.0)).into(),
            Capsule::solid(origin, up, 1.0).into(),
            Torus::solid(origin, up, 2.0, 0.5).into(),
            Revolved::solid(origin, up, [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0]]).into(),
        ];
        for shape in shapes {
            let triangles = shape.triangles([Vec3::ZERO; 2], 72);
            let bits = |corner: Vec3<f64>| (corner + Vec3::ZERO).to_array().map(f64::to_bits);
            let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            let sides = sides.map(|ends| ends.map(bits)).filter(|[a, b]| a != b);
            let sides: std::collections::HashSet<_> = sides.collect();
            for [a, b] in &sides {
                assert!(sides.contains(&[*b, *a]), "{shape:?}");
            }
        }
    }

    #[test]
    fn what_has_no_end_fills_a_box() {
        let within = [Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 1.0)];
        let area = |shape: Shape<f64>| {
            let area = |[a, b, c]: [Vec3<f64>; 3]| (b - a).cross(c - a).length() / 2.0;
            shape.triangles(within, 64).into_iter().map(area).sum::<f64>()
        };
        is_near(area(Plane::new([0.0, 0.0, 0.5], [0.0, 0.0, 1.0]).into()), 4.0);
        is_near(area(Plane::new([0.0; 3], [1.0, 1.0, 0.0]).into()), 32.0_f64.sqrt());
        assert_eq!(area(Plane::new([0.0, 0.0, 5.0], [0.0, 0.0, 1.0]).into()), 0.0);
        let rod = Cylinder::solid([0.0; 3], [0.0, 0.0, 1.0], 0.5, None);
        assert!((area(rod.into()) - 2.0 * core::f64::consts::PI).abs() < 0.01);
        assert!(area(Cone::endless_solid([0.0; 3], [0.0, 0.0, 1.0], 1.0).into()) > 4.0);
        // What is above the plane sees it.
        let floor = Shape::from(Plane::new([0.0; 3], [0.0, 0.0, 1.0]));
        for [a, b, c] in floor.triangles(within, 64) {
            assert!((b - a).cross(c - a).z > 0.0);
        }
    }

    #[test]
    fn what_is_thin_has_each_triangle_once() {
        let within = [Vec3::ZERO; 2];
        let ring = Shape::from(Disc::new([0.0; 3], [0.0, 0.0, 1.0], 3.0, 1.0));
        assert_eq!((ring.triangles(within, 32).len(), ring.is_thin()), (64, true));
        let field = Shape::from(Heightfield::new([0.0_f64; 3], [1.0; 2], 2, &[0.0; 4]).unwrap());
        assert_eq!(field.triangles(within, 32).len(), 2);
        let tube = Shape::from(Tube::new([0.0; 3], [0.0, 0.0, 1.0], 2.0, [1.0, 0.0]));
        assert_eq!(tube.triangles(within, 32).len(), 32);
    }
}
