//! Hull: the convex hull of some points, solid.

use super::convex_hull::hull_triangles;
use super::entry::{Key, ShapeEntry, VERTICES};
use super::mistake::{Mistake, finite};
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::solid::Solid;
use super::{Feature, Polytope};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// The convex hull of some points, fixed in space: all that is between them, solid.
///
/// In a scene file: `shape = "hull"` with `vertices`, a list of four points or more that do
/// not lie in one plane. Those inside of the others count for nothing.
///
/// ```
/// use carom::surroundings::{Hull, Shape};
/// use carom::vec3::Vec3;
///
/// let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let corner = Shape::from(Hull::new([o, x, y, z, [0.25; 3]]));
/// let [corner] = &corner.features()[..] else { return };
/// assert_eq!(corner.clearance(Vec3::new(-2.0, 0.25, 0.25), 0.5).gap, 1.5);
/// assert_eq!(corner.clearance(Vec3::new(4.0, -4.0, 0.0), 0.5).gap, 4.5);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Hull<T> {
    /// The points, length.
    pub vertices: Vec<Vec3<T>>,
}

/// How thin a hull may be, in ε of its extent.
const LEAST: f64 = 16.0;

impl<T: Real> Hull<T> {
    /// The convex hull of points, length.
    ///
    /// ```
    /// use carom::surroundings::Hull;
    /// let wedge = Hull::new([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    /// assert_eq!(wedge.vertices.len(), 4);
    /// ```
    #[must_use]
    pub fn new(vertices: impl IntoIterator<Item = [T; 3]>) -> Self {
        Self { vertices: vertices.into_iter().map(Vec3::from).collect() }
    }

    /// The triangles around all points, by their numbers; `None` if these lie in one plane.
    fn triangles(&self) -> Option<Vec<[usize; 3]>> {
        let points: Vec<Vec3<f64>> = self.vertices.iter().map(|point| point.cast()).collect();
        hull_triangles(&points, LEAST * T::EPSILON.to_f64())
    }
}

impl<T: Real> Solid<T> for Hull<T> {
    type In<B: Real> = Hull<B>;

    const NAME: &'static str = "hull";
    const KEYS: &'static [Key] = &[VERTICES];

    fn read(entry: &ShapeEntry) -> Result<Hull<f64>, Mistake> {
        Ok(Hull::new(entry.points(VERTICES)?.iter().copied()))
    }

    fn check(&self) -> Result<(), Mistake> {
        let key = VERTICES.name;
        let count = self.vertices.len();
        if count < 4 {
            let wanted = "a hull has four or more, as in [[0, 0, 0], [1, 0, 0], [0, 1, 0], …]";
            return Err(Mistake::described(key, format!("a list of {count} points"), wanted));
        }
        for vertex in &self.vertices {
            finite::<T>(key, vertex.cast(), "every component")?;
        }
        if self.triangles().is_some() {
            return Ok(());
        }
        let wanted = format!("a hull has a volume, more than {} rounds its points by", T::NAME);
        Err(Mistake::described(key, format!("{count} points in one plane"), wanted))
    }

    fn cast<B: Real>(&self) -> Hull<B> {
        Hull { vertices: self.vertices.iter().map(|vertex| vertex.cast()).collect() }
    }

    fn features(&self) -> Vec<Feature<T>> {
        let triangles = self.triangles();
        triangles.map(|all| Polytope::new(&self.vertices, &all).into()).into_iter().collect()
    }

    fn area(&self) -> Option<T> {
        let area = |[a, b, c]: [usize; 3]| {
            let [a, b, c] = [a, b, c].each(|k| self.vertices[k]);
            (b - a).cross(c - a).length() * T::ratio(1, 2)
        };
        Some(self.triangles()?.into_iter().map(area).fold(T::ZERO, |sum, area| sum + area))
    }

    fn triangles(&self, _: &Detail<T>) -> Vec<Corners<T>> {
        let triangles = self.triangles().into_iter().flatten();
        triangles.map(|corners| corners.each(|k| self.vertices[k])).collect()
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.vertices.clone()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self { vertices: self.vertices.iter().map(|&vertex| at.point(vertex)).collect() }
    }
}
