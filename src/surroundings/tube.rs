//! Tube: a thin tube or funnel, open at both ends.

use super::axis::Axis;
use super::entry::{AXIS, BASE, CENTER, HALF_HEIGHT, HEIGHT, Key, RADIUS, ShapeEntry, TOP_RADIUS};
use super::mistake::Mistake;
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::slant::{Slant, check_slanted};
use super::solid::Solid;
use super::{Band, Feature};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// A thin tube fixed in space, open at both ends, touched from inside, from outside and at
/// its rims; with another radius at its top it is a funnel.
///
/// In a scene file: `shape = "tube"` with `center`, `axis`, `half_height` and `radius`; or with
/// the middle of its `base`, the `axis` from there, `height`, `radius` at the base, and
/// `top_radius`, by default the same.
///
/// ```
/// use carom::surroundings::{Shape, Tube};
/// use carom::vec3::Vec3;
///
/// let tube = Tube::new([0.0; 3], [0.0, 0.0, 1.0], 4.0, [3.0, 3.0]);
/// let [tube] = &Shape::from(tube).features()[..] else { return };
/// assert_eq!(tube.clearance(Vec3::new(1.0, 0.0, 2.0), 0.5).gap, 1.5);
/// assert_eq!(tube.clearance(Vec3::new(5.0, 0.0, 2.0), 0.5).gap, 1.5);
/// assert_eq!(tube.clearance(Vec3::new(0.0, 0.0, 8.0), 0.5).gap, 4.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tube<T> {
    /// From the middle of the base.
    axis: Axis<T>,
    height: T,
    /// Of the base and the top.
    radii: [T; 2],
}

impl<T: Real> Tube<T> {
    /// A tube: the middle of its base, its axis, of any length but 0, its height, and its
    /// radii at the base and the top, one of which may be 0; lengths.
    ///
    /// ```
    /// use carom::surroundings::{Shape, Tube};
    /// let funnel = Shape::from(Tube::new([0.0; 3], [0.0, 0.0, 1.0], 4.0, [0.5, 3.0]));
    /// let corners = funnel.features()[0].bounds().map(|corners| corners.map(|c| c.to_array()));
    /// assert_eq!(corners, Some([[-3.0, -3.0, 0.0], [3.0, 3.0, 4.0]]));
    /// ```
    #[must_use]
    pub fn new(base: [T; 3], axis: [T; 3], height: T, radii: [T; 2]) -> Self {
        Self { axis: Axis::new(base, axis), height, radii }
    }
}

impl<T: Real> Solid<T> for Tube<T> {
    type In<B: Real> = Tube<B>;

    const NAME: &'static str = "tube";
    const KEYS: &'static [Key] = &[CENTER, BASE, AXIS, HALF_HEIGHT, HEIGHT, RADIUS, TOP_RADIUS];

    fn read(entry: &ShapeEntry) -> Result<Tube<f64>, Mistake> {
        let radius = entry.number(RADIUS, "a tube has the radius of its base")?;
        let height = entry.height()?.ok_or_else(|| {
            Mistake::missing(HEIGHT.name, "a tube has a height greater than 0, or a half_height")
        })?;
        let axis =
            |end| -> Result<_, Mistake> { Ok(Axis::new(entry.vector(end)?, entry.vector(AXIS)?)) };
        Ok(Tube {
            axis: if entry.has(CENTER) { axis(CENTER)?.moved(-0.5 * height) } else { axis(BASE)? },
            height,
            radii: [radius, entry.optional(TOP_RADIUS).unwrap_or(radius)],
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        check_slanted(&self.axis, self.height, self.radii)
    }

    fn cast<B: Real>(&self) -> Tube<B> {
        Tube {
            axis: self.axis.cast(),
            height: self.height.cast(),
            radii: self.radii.each(Real::cast),
        }
    }

    fn features(&self) -> Vec<Feature<T>> {
        let [base, top] = self.radii;
        let slant = Slant::new([base, T::ZERO], [top, self.height]);
        vec![Band::thin(self.axis, slant).into()]
    }

    fn is_thin(&self) -> bool {
        true
    }

    fn area(&self) -> Option<T> {
        let [base, top] = self.radii;
        Some(Slant::new([base, T::ZERO], [top, self.height]).area() * T::whole(2))
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        let [base, top] = self.radii;
        detail.turned(&self.axis, &[[base, T::ZERO], [top, self.height]])
    }

    fn points(&self) -> Vec<Vec3<T>> {
        let [base, top] = self.radii;
        joined(self.axis.around(T::ZERO, base), self.axis.around(self.height, top)).into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self {
            axis: self.axis.placed(at),
            height: at.length(self.height),
            radii: self.radii.each(|radius| at.length(radius)),
        }
    }
}
