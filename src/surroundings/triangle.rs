//! Triangle: a thin one, touched from both sides.

use super::entry::{Key, ShapeEntry, VERTICES};
use super::gate::{Gate, Opening};
use super::mistake::{Mistake, point};
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::solid::Solid;
use super::{Facet, Feature, Plane};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// A thin triangle fixed in space, touched from both sides, at its edges and its corners.
///
/// In a scene file: `shape = "triangle"` with three `vertices`.
///
/// ```
/// use carom::surroundings::{Shape, Triangle};
/// use carom::vec3::Vec3;
///
/// let triangle = Triangle::new([0.0; 3], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0]);
/// let [facet] = &Shape::from(triangle).features()[..] else { return };
/// assert_eq!(facet.clearance(Vec3::new(1.0, 1.0, -2.0), 0.5).gap, 1.5);
/// assert_eq!(facet.clearance(Vec3::new(-3.0, -4.0, 0.0), 0.5).gap, 4.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<T> {
    /// The corners, length.
    pub corners: [Vec3<T>; 3],
}

impl<T: Real> Triangle<T> {
    /// The triangle with these corners, length.
    ///
    /// ```
    /// use carom::surroundings::Triangle;
    /// let triangle = Triangle::new([0.0; 3], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0]);
    /// assert_eq!(triangle.corners[1].x, 3.0);
    /// ```
    #[must_use]
    pub fn new(a: [T; 3], b: [T; 3], c: [T; 3]) -> Self {
        Self { corners: [a.into(), b.into(), c.into()] }
    }
}

impl<T: Real> Solid<T> for Triangle<T> {
    type In<B: Real> = Triangle<B>;

    const NAME: &'static str = "triangle";
    const KEYS: &'static [Key] = &[VERTICES];

    fn read(entry: &ShapeEntry) -> Result<Triangle<f64>, Mistake> {
        match *entry.points(VERTICES)? {
            [a, b, c] => Ok(Triangle::new(a, b, c)),
            ref other => {
                let found = format!("a list of {} points", other.len());
                Err(Mistake::described(VERTICES.name, found, "a triangle has three"))
            }
        }
    }

    fn check(&self) -> Result<(), Mistake> {
        let [a, b, c] = self.corners;
        for corner in self.corners {
            point(VERTICES.name, corner)?;
        }
        let sides = [b - a, c - b, a - c];
        let longest =
            sides.each(|side| side.length_squared()).into_iter().fold(T::ZERO, T::greater);
        let area = sides[0].cross(sides[1]).length();
        // In the precision's own rounding, the sides are along one line.
        if longest.is_finite() && area > T::whole(4) * T::EPSILON * longest {
            return Ok(());
        }
        let corners = self.corners.each(|corner| corner.cast::<f64>().to_array());
        let wanted = format!(
            "the corners must not lie on one line, nor farther apart than {} can square",
            T::NAME
        );
        Err(Mistake::value(VERTICES.name, corners, wanted))
    }

    fn cast<B: Real>(&self) -> Triangle<B> {
        Triangle { corners: self.corners.each(|corner| corner.cast()) }
    }

    fn features(&self) -> Vec<Feature<T>> {
        vec![Facet::new(self.corners).into()]
    }

    fn is_thin(&self) -> bool {
        true
    }

    fn area(&self) -> Option<T> {
        let [a, b, c] = self.corners;
        Some((b - a).cross(c - a).length())
    }

    fn gate(&self) -> Option<Gate<T>> {
        let [a, b, c] = self.corners;
        let across = (b - a).cross(c - a);
        let normal = across * (T::ONE / across.length());
        let opening = Opening::Triangle(self.corners, normal);
        Some(Gate::flat(Plane { point: a, normal }, Some(opening)))
    }

    fn triangles(&self, _: &Detail<T>) -> Vec<Corners<T>> {
        vec![self.corners]
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.corners.into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self { corners: self.corners.each(|corner| at.point(corner)) }
    }
}
