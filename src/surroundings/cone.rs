//! Cone: a cone or a frustum, solid or hollow.

use super::axis::{Axis, inscribed, pi};
use super::entry::{AXIS, BASE, HEIGHT, INSIDE, Key, Meaning, RADIUS, ShapeEntry, TOP_RADIUS};
use super::gate::Gate;
use super::mistake::{Mistake, direction, point, positive};
use super::placement::Placement;
use super::skin::{Corners, Detail, from_inside};
use super::slant::{Slant, check_slanted};
use super::solid::Solid;
use super::{Band, Feature, Frustum, Plane};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// A cone fixed in space, or, with a radius at its top, a frustum.
///
/// In a scene file: `shape = "cone"` with its `apex`, the `axis` from there into it, and
/// `slope`, its radius over the height from there, which goes on without end; or with the
/// middle of its `base`, the `axis` from there, `height`, the `radius` of the base and
/// `top_radius`, 0 by default. `inside = true` makes a container, closed at both ends if it
/// has any.
///
/// ```
/// use carom::surroundings::{Cone, Shape};
/// use carom::vec3::Vec3;
///
/// let cone = Cone::solid([0.0; 3], [0.0, 0.0, 1.0], 4.0, [3.0, 0.0]);
/// let [cone] = &Shape::from(cone).features()[..] else { return };
/// assert_eq!(cone.clearance(Vec3::new(0.0, 0.0, 6.0), 0.5).gap, 1.5);
/// assert_eq!(cone.clearance(Vec3::new(3.0, 0.0, -4.0), 0.5).gap, 3.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<T> {
    /// From the middle of the base, or from the apex if it has no end.
    axis: Axis<T>,
    extent: Extent<T>,
    inside: bool,
}

/// How far it reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Extent<T> {
    /// The height, and the radii of the base and the top, length.
    Ended(T, [T; 2]),
    /// Radius over height.
    Endless(T),
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
        Self { axis: Axis::new(base, axis), extent: Extent::Ended(height, radii), inside: false }
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

    /// A solid cone that goes on without end: its apex, length, the axis from there into it,
    /// of any length but 0, and its slope, radius over height.
    ///
    /// ```
    /// use carom::surroundings::{Cone, Shape};
    /// use carom::vec3::Vec3;
    ///
    /// let cone = Cone::endless_solid([0.0; 3], [0.0, 0.0, -1.0], 0.75);
    /// let [cone] = &Shape::from(cone).features()[..] else { return };
    /// assert_eq!(cone.clearance(Vec3::new(8.0, 0.0, -4.0), 0.5).gap, 3.5);
    /// assert_eq!(cone.clearance(Vec3::new(0.0, 0.0, 3.0), 0.5).gap, 2.5);
    /// ```
    #[must_use]
    pub fn endless_solid(apex: [T; 3], axis: [T; 3], slope: T) -> Self {
        Self { axis: Axis::new(apex, axis), extent: Extent::Endless(slope), inside: false }
    }

    /// A container that goes on without end, as [`endless_solid`](Self::endless_solid) has it.
    ///
    /// ```
    /// use carom::surroundings::{Cone, Shape};
    /// use carom::vec3::Vec3;
    ///
    /// let cone = Cone::endless_container([0.0; 3], [0.0, 0.0, 1.0], 0.75);
    /// let [wall] = &Shape::from(cone).features()[..] else { return };
    /// assert!((wall.clearance(Vec3::new(0.0, 0.0, 5.0), 0.5).gap - 2.5_f64).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn endless_container(apex: [T; 3], axis: [T; 3], slope: T) -> Self {
        Self { inside: true, ..Self::endless_solid(apex, axis, slope) }
    }

    /// The corners of the box around it, if it has an end.
    fn around(&self) -> Option<[Vec3<T>; 2]> {
        let Extent::Ended(height, [base, top]) = self.extent else { return None };
        Some(joined(self.axis.around(T::ZERO, base), self.axis.around(height, top)))
    }
}

const APEX: Key = Key::new("apex", Meaning::Point);
const SLOPE: Key = Key::new("slope", Meaning::Ratio);

impl<T: Real> Solid<T> for Cone<T> {
    type In<B: Real> = Cone<B>;

    const NAME: &'static str = "cone";
    const KEYS: &'static [Key] = &[APEX, SLOPE, BASE, AXIS, HEIGHT, RADIUS, TOP_RADIUS, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<Cone<f64>, Mistake> {
        let inside = entry.flag(INSIDE);
        if entry.has(APEX) || entry.has(SLOPE) {
            let ended = [BASE, HEIGHT, RADIUS, TOP_RADIUS];
            if let Some(key) = ended.into_iter().find(|key| entry.has(*key)) {
                let wanted = "a cone has an apex and a slope, or a base, a height and a radius";
                return Err(Mistake::described(key.name, "there beside apex or slope", wanted));
            }
            let axis = Axis::new(entry.vector(APEX)?, entry.vector(AXIS)?);
            let slope =
                entry.number(SLOPE, "a cone without an end has a slope, radius over height")?;
            return Ok(Cone { axis, extent: Extent::Endless(slope), inside });
        }
        let radius = entry.number(RADIUS, "a cone has the radius of its base")?;
        let radii = [radius, entry.optional(TOP_RADIUS).unwrap_or(0.0)];
        let height = entry.number(HEIGHT, "a cone has a height greater than 0")?;
        let axis = Axis::new(entry.vector(BASE)?, entry.vector(AXIS)?);
        Ok(Cone { axis, extent: Extent::Ended(height, radii), inside })
    }

    fn check(&self) -> Result<(), Mistake> {
        match self.extent {
            Extent::Ended(height, radii) => check_slanted(&self.axis, height, radii),
            Extent::Endless(slope) => {
                point(APEX.name, self.axis.center)?;
                direction(AXIS.name, self.axis.direction)?;
                positive::<T>(SLOPE.name, slope.to_f64(), "a slope")
            }
        }
    }

    fn cast<B: Real>(&self) -> Cone<B> {
        let extent = match self.extent {
            Extent::Ended(height, radii) => Extent::Ended(height.cast(), radii.each(Real::cast)),
            Extent::Endless(slope) => Extent::Endless(slope.cast()),
        };
        Cone { axis: self.axis.cast(), extent, inside: self.inside }
    }

    /// A container is its wall and its ends.
    fn features(&self) -> Vec<Feature<T>> {
        let Self { axis, extent, inside } = *self;
        let (height, [base, top]) = match extent {
            Extent::Ended(height, radii) => (height, radii),
            Extent::Endless(slope) => {
                let band = if inside { Band::lining } else { Band::endless };
                return vec![band(axis, Slant::endless(slope)).into()];
            }
        };
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
        let wall = Feature::from(Band::lining(axis, slant));
        core::iter::once(wall).chain(ends.map(|(_, plane)| plane.into())).collect()
    }

    fn area(&self) -> Option<T> {
        let Extent::Ended(height, [base, top]) = self.extent else { return None };
        let wall = Slant::new([base, T::ZERO], [top, height]).area();
        Some(wall + pi::<T>() * (base * base + top * top))
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        let zero = T::ZERO;
        let triangles = match self.extent {
            Extent::Ended(height, [base, top]) => {
                let profile = [[zero, zero], [base, zero], [top, height], [zero, height]];
                detail.turned(&self.axis, &profile)
            }
            Extent::Endless(slope) => {
                let [_, height] = detail.heights(&self.axis);
                let height = height.greater(zero);
                // What is within the cone is below its profile.
                detail.turned(&self.axis, &[[zero, zero], [slope * height, height]])
            }
        };
        from_inside(triangles, self.inside)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.around().unwrap_or([self.axis.center; 2]).into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        let extent = match self.extent {
            Extent::Ended(height, radii) => {
                Extent::Ended(at.length(height), radii.each(|radius| at.length(radius)))
            }
            endless => endless,
        };
        Self { axis: self.axis.placed(at), extent, inside: self.inside }
    }

    fn gate(&self) -> Option<Gate<T>> {
        Some(Gate::closed(|inside| Self { inside, ..*self }.features()))
    }

    fn is_container(&self) -> bool {
        self.inside
    }

    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        self.around().filter(|_| self.inside)
    }

    /// A box in a cylinder through the wider half.
    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        let Extent::Ended(height, [base, top]) = self.extent else { return None };
        let radius = (base + top) * T::ratio(1, 2);
        let share = if base < top { T::ratio(3, 4) } else { T::ratio(1, 4) };
        let middle = self.axis.moved(height * share);
        self.inside.then(|| inscribed(&middle, radius, height * T::ratio(1, 4)))
    }
}
