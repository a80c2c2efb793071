//! Cone: a cone or a frustum, solid or hollow.

use super::axis::{Axis, inscribed, joined};
use super::entry::{AXIS, BASE, HEIGHT, INSIDE, Key, RADIUS, ShapeEntry, TOP_RADIUS};
use super::mistake::Mistake;
use super::slant::{Slant, check_slanted};
use super::solid::Solid;
use super::{Band, Feature, Frustum, Plane};
use crate::real::Real;
use crate::vec3::Vec3;

/// A cone fixed in space, or, with a radius at its top, a frustum.
///
/// In a scene file: `shape = "cone"` with the middle of its `base`, the `axis` from there,
/// `height`, the `radius` of the base, `top_radius`, 0 by default, and `inside`;
/// `inside = true` makes a container, closed at both ends.
///
/// ```
/// use carom::surroundings::{Cone, Shape};
/// use carom::vec3::Vec3;
///
/// let cone = Cone::solid([0.0; 3], [0.0, 0.0, 1.0], 4.0, [3.0, 0.0]);
/// let [cone] = Shape::from(cone).features()[..] else { return };
/// assert_eq!(cone.clearance(Vec3::new(0.0, 0.0, 6.0), 0.5).gap, 1.5);
/// assert_eq!(cone.clearance(Vec3::new(3.0, 0.0, -4.0), 0.5).gap, 3.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<T> {
    /// From the middle of the base.
    axis: Axis<T>,
    height: T,
    /// Of the base and the top.
    radii: [T; 2],
    inside: bool,
}

impl<T: Real> Cone<T> {
    /// A solid cone that bodies bounce off: the middle of its base, its axis, of any length
    /// but 0, its height, and the radii of its base and its top, one of which may be 0;
    /// lengths.
    ///
    /// ```
    /// use carom::surroundings::{Cone, Shape};
    /// let cone = Cone::solid([0.0; 3], [0.0, 0.0, 1.0], 4.0, [3.0, 1.0]);
    /// assert_eq!(Shape::from(cone).features().len(), 1);
    /// ```
    #[must_use]
    pub fn solid(base: [T; 3], axis: [T; 3], height: T, radii: [T; 2]) -> Self {
        Self { axis: Axis::new(base, axis), height, radii, inside: false }
    }

    /// A container that bodies are inside of, of the same lengths.
    ///
    /// ```
    /// use carom::surroundings::{Cone, Shape};
    /// let cone = Cone::container([0.0; 3], [0.0, 0.0, 1.0], 4.0, [3.0, 1.0]);
    /// let corners = Shape::from(cone).interior().map(|corners| corners.map(|c| c.to_array()));
    /// assert_eq!(corners, Some([[-3.0, -3.0, 0.0], [3.0, 3.0, 4.0]]));
    /// ```
    #[must_use]
    pub fn container(base: [T; 3], axis: [T; 3], height: T, radii: [T; 2]) -> Self {
        Self { inside: true, ..Self::solid(base, axis, height, radii) }
    }

    fn around(&self) -> [Vec3<T>; 2] {
        let [base, top] = self.radii;
        joined(self.axis.around(T::ZERO, base), self.axis.around(self.height, top))
    }
}

impl<T: Real> Solid<T> for Cone<T> {
    type In<B: Real> = Cone<B>;

    const NAME: &'static str = "cone";
    const KEYS: &'static [Key] = &[BASE, AXIS, HEIGHT, RADIUS, TOP_RADIUS, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<Cone<f64>, Mistake> {
        let radius = entry.number(RADIUS, "a cone has the radius of its base")?;
        Ok(Cone {
            axis: Axis::new(entry.vector(BASE)?, entry.vector(AXIS)?),
            height: entry.number(HEIGHT, "a cone has a height greater than 0")?,
            radii: [radius, entry.optional(TOP_RADIUS).unwrap_or(0.0)],
            inside: entry.flag(INSIDE),
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        check_slanted(&self.axis, self.height, self.radii)
    }

    fn cast<B: Real>(&self) -> Cone<B> {
        Cone {
            axis: self.axis.cast(),
            height: self.height.cast(),
            radii: self.radii.map(Real::cast),
            inside: self.inside,
        }
    }

    /// A container is its wall and its ends.
    fn features(&self) -> Vec<Feature<T>> {
        let Self { axis, height, radii: [base, top], inside } = *self;
        if !inside {
            return vec![Frustum::new(axis, height, [base, top]).into()];
        }
        let slant = Slant::new([base, T::ZERO], [top, height]);
        let normal = axis.direction;
        let ends = [
            (base, Plane { point: axis.center, normal }),
            (top, Plane { point: axis.point(height), normal: -normal }),
        ];
        let ends = ends.into_iter().filter(|(radius, _)| *radius > T::ZERO);
        let wall = Feature::from(Band { axis, slant, is_lining: true });
        core::iter::once(wall).chain(ends.map(|(_, plane)| plane.into())).collect()
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.around().into()
    }

    fn in_frame(&self, origin: Vec3<T>, scale: T) -> Self {
        Self {
            axis: self.axis.in_frame(origin, scale),
            height: self.height * scale,
            radii: self.radii.map(|radius| radius * scale),
            inside: self.inside,
        }
    }

    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        self.inside.then(|| self.around())
    }

    /// A box in a cylinder through the wider half.
    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        let [base, top] = self.radii;
        let radius = (base + top) * T::ratio(1, 2);
        let share = if base < top { T::ratio(3, 4) } else { T::ratio(1, 4) };
        let middle = self.axis.moved(self.height * share);
        self.inside.then(|| inscribed(&middle, radius, self.height * T::ratio(1, 4)))
    }
}
