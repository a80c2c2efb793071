//! Sphere tree: which spheres are at a place, nearest to it, or in the way of a ray.

use std::collections::HashSet;

use super::tree::Ray;
use super::{Bounds, PeriodicBox, Space, Tree};
use crate::bodies::Bodies;
use crate::motion::flight::Wrap;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

/// How often the reach is doubled before all spheres are looked at.
const DOUBLINGS: usize = 64;

/// The most boxes that a ray is followed through.
const MOST_BOXES: usize = 1 << 16;

/// Spheres at one moment, found by place. In a periodic box they are found through its
/// faces as well, each once: by its nearest image.
///
/// It takes `O(n log n)` to make, whatever the sizes and distances, and about the logarithm
/// of the number for each that is found.
///
/// ```
/// use carom::Bodies;
/// use carom::space::{PeriodicBox, SphereTree};
///
/// let row: Vec<[f64; 3]> = (0..10).map(|k| [f64::from(k) + 0.5, 0.5, 0.5]).collect();
/// let bodies = Bodies::from_positions(&row).radius(0.25).build()?;
/// let tree = SphereTree::new(&bodies, None);
/// assert_eq!(tree.in_sphere([3.0, 0.5, 0.5], 0.5), [2, 3]);
/// assert_eq!(tree.in_box([0.0; 3], [1.0, 1.0, 1.0]), [0]);
/// assert_eq!(tree.nearest([9.75, 0.5, 2.0], 2), [9, 8]);
/// let hit = tree.ray([5.0, 0.5, 0.5], [1.0, 0.0, 0.0], 100.0).ok_or("nothing is hit")?;
/// assert_eq!((hit.body, hit.distance, hit.normal.x), (5, 0.25, -1.0));
/// // The same where the row goes on without end.
/// let tree = SphereTree::new(&bodies, Some(PeriodicBox::new([0.0; 3], [10.0; 3])));
/// assert_eq!(tree.in_sphere([0.0, 0.5, 0.5], 0.5), [0, 9]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SphereTree<T> {
    tree: Tree<T>,
    /// Centres and radii, length.
    spheres: Vec<(Vec3<T>, T)>,
    periodic: Option<PeriodicBox<T>>,
}

/// Where a ray meets a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RayHit<T> {
    /// Its index among the spheres.
    pub body: usize,
    /// From the ray's origin, length; 0 inside a sphere.
    pub distance: T,
    /// The point on its surface; the origin, inside a sphere. In a periodic box, of the
    /// image that is hit, which the box need not hold.
    pub point: Vec3<T>,
    /// The unit normal there, out of the sphere; zero at its centre.
    pub normal: Vec3<T>,
}

impl<T: Real> SphereTree<T> {
    /// Of bodies, in open space or in a periodic box.
    #[must_use]
    pub fn new(bodies: &Bodies<T>, periodic: Option<PeriodicBox<T>>) -> Self {
        let center = |index: usize| {
            let center = bodies.position_of(index);
            periodic.map_or(center, |space| space.wrap(center))
        };
        let spheres: Vec<_> =
            (0..bodies.len()).map(|index| (center(index), bodies.radius.of(index))).collect();
        let tree = Tree::new(spheres.iter().map(|&(center, radius)| Some(around(center, radius))));
        Self { tree, spheres, periodic }
    }

    /// The spheres that reach into a sphere, of a centre and radius, length; in rising
    /// order.
    #[must_use]
    pub fn in_sphere(&self, center: impl Into<Vec3<T>>, radius: T) -> Vec<u32> {
        let center = self.wrapped(center.into());
        self.found(around(center, radius), |sphere, own| {
            let reach = radius + own;
            self.nearest_way(center, sphere).length_squared() <= reach * reach
        })
    }

    /// The spheres that reach into a box between two corners, length; in rising order.
    #[must_use]
    pub fn in_box(&self, lower: impl Into<Vec3<T>>, upper: impl Into<Vec3<T>>) -> Vec<u32> {
        let (lower, upper) = (lower.into(), upper.into());
        let middle = (lower + upper) * T::ratio(1, 2);
        let half = (upper - lower) * T::ratio(1, 2);
        let middle = self.wrapped(middle);
        self.found([middle - half, middle + half], |sphere, own| {
            let way = self.nearest_way(middle, sphere).to_array();
            let beyond = |axis: usize| (way[axis].abs() - half.to_array()[axis]).greater(T::ZERO);
            let beyond = Vec3::new(beyond(0), beyond(1), beyond(2));
            beyond.length_squared() <= own * own
        })
    }

    /// The `count` spheres whose surfaces are nearest to a point, length; the
    /// nearest first, equal ones by their numbers. A point inside is nearer the deeper it
    /// is.
    #[must_use]
    pub fn nearest(&self, point: impl Into<Vec3<T>>, count: usize) -> Vec<u32> {
        let point = self.wrapped(point.into());
        let count = count.min(self.spheres.len());
        let distance = |number: u32| {
            let (center, radius) = self.spheres[number as usize];
            self.nearest_way(point, center).length() - radius
        };
        let sorted = |mut found: Vec<(T, u32)>| {
            found.sort_by(|a, b| {
                let order = a.0.partial_cmp(&b.0).unwrap_or(core::cmp::Ordering::Equal);
                order.then(a.1.cmp(&b.1))
            });
            found.truncate(count);
            found.into_iter().map(|(_, number)| number).collect()
        };
        if count == 0 {
            return Vec::new();
        }
        // From a reach at which one sphere is found, farther by factors of two.
        let mut reach = self.first_reach(point);
        for _ in 0..DOUBLINGS {
            let mut found = Vec::new();
            self.each_near(around(point, reach), |number| found.push(number));
            found.sort_unstable();
            found.dedup();
            let found: Vec<_> =
                found.into_iter().map(|number| (distance(number), number)).collect();
            let within: Vec<_> = found.into_iter().filter(|(far, _)| *far <= reach).collect();
            if within.len() >= count {
                return sorted(within);
            }
            reach = reach + reach;
        }
        sorted((0..self.spheres.len() as u32).map(|number| (distance(number), number)).collect())
    }

    /// The first sphere in the way of a ray from a point, length, in a direction of any
    /// length, up to a distance, length. Without a direction there is none, nor in a periodic
    /// box without a finite distance; it is followed through 65,536 boxes at most.
    #[must_use]
    pub fn ray(
        &self,
        origin: impl Into<Vec3<T>>,
        direction: impl Into<Vec3<T>>,
        longest: T,
    ) -> Option<RayHit<T>> {
        let (origin, direction) = (origin.into(), direction.into());
        let unit = unit(direction)?;
        if self.periodic.is_some() && !longest.is_finite() {
            return None;
        }
        let mut first: Option<(T, u32, Vec3<T>)> = None;
        let mut from = |shift: Vec3<T>, longest: T| {
            let start = self.wrapped(origin) - shift;
            self.tree.for_each_along(Ray::new(start, unit, longest), |number| {
                let (center, radius) = self.spheres[number as usize];
                if let Some(distance) = meets(start, unit, center, radius)
                    && distance <= longest
                    && first.is_none_or(|(nearest, other, _)| {
                        distance < nearest || distance == nearest && number < other
                    })
                {
                    first = Some((distance, number, shift));
                }
            });
            first.map(|(distance, ..)| distance)
        };
        match self.periodic {
            None => {
                from(Vec3::ZERO, longest);
            }
            Some(space) => along_boxes(space, self.wrapped(origin), unit, longest, from),
        }
        let (distance, number, shift) = first?;
        let center = self.spheres[number as usize].0 + shift + (origin - self.wrapped(origin));
        let point = origin + unit * distance;
        let normal = self::unit(point - center).unwrap_or(Vec3::ZERO);
        Some(RayHit { body: number as usize, distance, point, normal })
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.spheres.len()
    }

    /// The centre and radius of a sphere, within the periodic box.
    pub(crate) fn sphere(&self, number: u32) -> (Vec3<T>, T) {
        self.spheres[number as usize]
    }

    pub(crate) fn periodic(&self) -> Option<PeriodicBox<T>> {
        self.periodic
    }

    /// Visits the spheres that may reach into a sphere, some of them more than once.
    pub(crate) fn for_each_near(&self, center: Vec3<T>, radius: T, visit: impl FnMut(u32)) {
        self.each_near(around(center, radius), visit);
    }

    /// The bytes that it holds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(self.spheres.as_slice())
    }

    /// A point within the periodic box.
    pub(crate) fn wrapped(&self, point: Vec3<T>) -> Vec3<T> {
        self.periodic.map_or(point, |space| space.wrap(point))
    }

    /// The way from one point to another, to the nearest image.
    pub(crate) fn nearest_way(&self, from: Vec3<T>, to: Vec3<T>) -> Vec3<T> {
        self.periodic.map_or(to - from, |space| space.nearest(to - from))
    }

    /// The spheres whose boxes touch `bounds`, and that are what is wanted.
    fn found(&self, bounds: Bounds<T>, is_wanted: impl Fn(Vec3<T>, T) -> bool) -> Vec<u32> {
        let mut found = Vec::new();
        self.each_near(bounds, |number| {
            let (center, radius) = self.spheres[number as usize];
            if is_wanted(center, radius) {
                found.push(number);
            }
        });
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Visits the spheres whose boxes touch `bounds`, those of images too, some of them
    /// more than once.
    fn each_near(&self, [lower, upper]: Bounds<T>, mut visit: impl FnMut(u32)) {
        let Some(space) = self.periodic else {
            return self.tree.for_each([lower, upper], visit);
        };
        for image in space.images() {
            self.tree.for_each([lower + image, upper + image], &mut visit);
        }
    }

    /// A reach within which there is a sphere, or about the distance of one from the next.
    fn first_reach(&self, point: Vec3<T>) -> T {
        let Some([lower, upper]) = self.tree.bounds() else { return T::ONE };
        let greatest = |[x, y, z]: [T; 3]| x.greater(y).greater(z);
        let outside =
            greatest((lower - point).to_array()).greater(greatest((point - upper).to_array()));
        let extent = greatest((upper - lower).to_array());
        let apart = extent / T::from_f64((self.spheres.len() as f64).cbrt());
        outside.greater(T::ZERO) + apart.greater(T::EPSILON * extent)
    }
}

/// The box around a sphere.
fn around<T: Real>(center: Vec3<T>, radius: T) -> Bounds<T> {
    let reach = Vec3::new(radius, radius, radius);
    [center - reach, center + reach]
}

/// A vector of length 1 in a direction, if it is one.
pub(crate) fn unit<T: Real>(direction: Vec3<T>) -> Option<Vec3<T>> {
    let [x, y, z] = direction.to_array().each(|component| component.abs());
    let greatest = x.greater(y).greater(z);
    if !(greatest > T::ZERO && greatest.is_finite()) {
        return None;
    }
    // Squares of what is between 1 and √3 are numbers in any units.
    let scaled = Vec3::from(direction.to_array().each(|component| component / greatest));
    Some(scaled * (T::ONE / scaled.length()))
}

/// How far along a ray from a point in a unit direction a sphere is; 0 from inside.
///
/// With `o` from the centre to the point, `b = o·u`, `h² = r² − |o − b u|²`:
/// `t = (o² − r²)/(−b + h)`, which has no difference of like numbers.
fn meets<T: Real>(start: Vec3<T>, unit: Vec3<T>, center: Vec3<T>, radius: T) -> Option<T> {
    let offset = start - center;
    let gap = (offset.length() - radius) * (offset.length() + radius);
    if gap <= T::ZERO {
        return Some(T::ZERO);
    }
    let along = offset.dot(unit);
    let aside = (offset - unit * along).length();
    if along >= T::ZERO || aside > radius {
        return None;
    }
    let half = ((radius - aside) * (radius + aside)).sqrt();
    Some(gap / (half - along))
}

/// Follows a ray through the images of a periodic box, in the order in which it comes to
/// them, each with its neighbours, what is in which reaches into it. `from` looks at one image
/// and gives the distance of the nearest hit so far.
pub(crate) fn along_boxes<T: Real>(
    space: PeriodicBox<T>,
    start: Vec3<T>,
    unit: Vec3<T>,
    longest: T,
    mut from: impl FnMut(Vec3<T>, T) -> Option<T>,
) {
    let shift = |cell: [i32; 3]| {
        let sides = space.sides().to_array();
        Vec3::from(array::from_fn(|axis| T::whole(cell[axis]) * sides[axis]))
    };
    let [start, unit] = [start, unit].each(Vec3::to_array);
    let mut cell = [0_i32; 3];
    let mut looked_at = HashSet::new();
    for _ in 0..MOST_BOXES {
        let mut nearest = None;
        for neighbour in 0..27_i32 {
            let step = [neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1];
            let image = array::from_fn(|axis| cell[axis] + step[axis]);
            if looked_at.insert(image) {
                nearest = from(shift(image), longest).or(nearest);
            }
        }
        let own = shift(cell);
        let [lower, upper] = [space.lower + own, space.upper + own].each(Vec3::to_array);
        let exit = |axis: usize| {
            let face = if unit[axis] > T::ZERO { upper[axis] } else { lower[axis] };
            let is_along = unit[axis] != T::ZERO;
            if is_along { (face - start[axis]) / unit[axis] } else { T::from_f64(f64::INFINITY) }
        };
        let sooner = |a: usize, b: usize| if exit(b) < exit(a) { b } else { a };
        let axis = sooner(sooner(0, 1), 2);
        let (end, is_ahead) = (exit(axis), exit(axis) < longest);
        if nearest.is_some_and(|distance| distance <= end) || !is_ahead {
            return;
        }
        cell[axis] += if unit[axis] > T::ZERO { 1 } else { -1 };
    }
}
