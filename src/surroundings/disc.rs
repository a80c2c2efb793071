//! Disc: a thin one, which may have a hole.

use super::axis::Axis;
use super::entry::{AXIS, CENTER, Key, Meaning, RADIUS, ShapeEntry};
use super::mistake::{Mistake, direction, not_negative, point, positive};
use super::slant::Slant;
use super::solid::Solid;
use super::{Band, Feature};
use crate::real::Real;
use crate::vec3::Vec3;

/// A thin disc fixed in space, touched from both sides and at its rim; with a hole in its
/// middle an annulus, which has another rim there.
///
/// In a scene file: `shape = "disc"` with `center`, `axis`, `radius` and `hole_radius`, 0 by
/// default.
///
/// ```
/// use carom::surroundings::{Disc, Shape};
/// use carom::vec3::Vec3;
///
/// let ring = Disc::new([0.0; 3], [0.0, 0.0, 1.0], 3.0, 1.0);
/// let [ring] = Shape::from(ring).features()[..] else { return };
/// assert_eq!(ring.clearance(Vec3::new(2.0, 0.0, -1.0), 0.5).gap, 0.5);
/// assert_eq!(ring.clearance(Vec3::new(0.25, 0.0, 0.0), 0.5).gap, 0.25);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc<T> {
    axis: Axis<T>,
    radius: T,
    hole_radius: T,
}

impl<T: Real> Disc<T> {
    /// The disc about a centre, length, across an axis, of any length but 0, with its
    /// radius, and that of its hole or 0, length.
    ///
    /// ```
    /// use carom::surroundings::{Disc, Shape};
    /// let disc = Shape::from(Disc::new([0.0; 3], [0.0, 0.0, 1.0], 3.0, 0.0));
    /// let corners = disc.features()[0].bounds().map(|corners| corners.map(|c| c.to_array()));
    /// assert_eq!(corners, Some([[-3.0, -3.0, 0.0], [3.0, 3.0, 0.0]]));
    /// ```
    #[must_use]
    pub fn new(center: [T; 3], axis: [T; 3], radius: T, hole_radius: T) -> Self {
        Self { axis: Axis::new(center, axis), radius, hole_radius }
    }
}

const HOLE_RADIUS: Key = Key::new("hole_radius", Meaning::Length);

impl<T: Real> Solid<T> for Disc<T> {
    type In<B: Real> = Disc<B>;

    const NAME: &'static str = "disc";
    const KEYS: &'static [Key] = &[CENTER, AXIS, RADIUS, HOLE_RADIUS];

    fn read(entry: &ShapeEntry) -> Result<Disc<f64>, Mistake> {
        Ok(Disc {
            axis: Axis::new(entry.vector(CENTER)?, entry.vector(AXIS)?),
            radius: entry.number(RADIUS, "a disc has a radius greater than 0")?,
            hole_radius: entry.optional(HOLE_RADIUS).unwrap_or(0.0),
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        point(CENTER.name, self.axis.center)?;
        direction(AXIS.name, self.axis.direction)?;
        let [radius, hole] = [self.radius, self.hole_radius].map(T::to_f64);
        positive::<T>(RADIUS.name, radius, "a radius")?;
        not_negative::<T>(HOLE_RADIUS.name, hole, "a radius")?;
        if self.hole_radius < self.radius {
            return Ok(());
        }
        let wanted = format!("it must be less than the radius of the disc, {radius:?}");
        Err(Mistake::value(HOLE_RADIUS.name, hole, wanted))
    }

    fn cast<B: Real>(&self) -> Disc<B> {
        Disc {
            axis: self.axis.cast(),
            radius: self.radius.cast(),
            hole_radius: self.hole_radius.cast(),
        }
    }

    fn features(&self) -> Vec<Feature<T>> {
        let slant = Slant::new([self.hole_radius, T::ZERO], [self.radius, T::ZERO]);
        vec![Band { axis: self.axis, slant, is_lining: false }.into()]
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.axis.around(T::ZERO, self.radius).into()
    }

    fn in_frame(&self, origin: Vec3<T>, scale: T) -> Self {
        Self {
            axis: self.axis.in_frame(origin, scale),
            radius: self.radius * scale,
            hole_radius: self.hole_radius * scale,
        }
    }
}
