//! Disc: a thin one, which may have a hole.

use super::axis::Axis;
use super::entry::{AXIS, CENTER, Key, Meaning, RADIUS, ShapeEntry};
use super::gate::{Gate, Opening};
use super::mistake::{Mistake, direction, not_negative, point, positive};
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::slant::Slant;
use super::solid::Solid;
use super::{Band, Feature, Plane};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// A thin disc fixed in space, touched from both sides and at its rim; with a hole in its
/// middle an annulus, which has another rim there.
///
/// In a scene file: `shape = "disc"` with `center`, `axis` and `radius`, or `shape =
/// "annulus"` with `center`, `axis`, and the radii `inner` and `outer`.
///
/// ```
/// use carom::surroundings::{Disc, Shape};
/// use carom::vec3::Vec3;
///
/// let ring = Disc::new([0.0; 3], [0.0, 0.0, 1.0], 3.0, 1.0);
/// let [ring] = &Shape::from(ring).features()[..] else { return };
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

const INNER: Key = Key::new("inner", Meaning::Length);
const OUTER: Key = Key::new("outer", Meaning::Length);
const ANNULUS: &str = "annulus";

impl<T: Real> Solid<T> for Disc<T> {
    type In<B: Real> = Disc<B>;

    const NAME: &'static str = "disc";
    const OTHER_NAME: Option<&'static str> = Some(ANNULUS);
    const KEYS: &'static [Key] = &[CENTER, AXIS, RADIUS, INNER, OUTER];

    fn read(entry: &ShapeEntry) -> Result<Disc<f64>, Mistake> {
        let axis = Axis::new(entry.vector(CENTER)?, entry.vector(AXIS)?);
        let (others, name) = if entry.shape == ANNULUS {
            (&[RADIUS][..], "disc")
        } else {
            (&[INNER, OUTER][..], ANNULUS)
        };
        if let Some(other) = others.iter().find(|key| entry.has(**key)) {
            let found = format!("there beside shape = \"{}\"", entry.shape);
            return Err(Mistake::described(other.name, found, format!("it is a key of a {name}")));
        }
        if entry.shape == ANNULUS {
            let hole_radius = entry.number(INNER, "an annulus has the radius of its hole")?;
            let radius = entry.number(OUTER, "an annulus has a radius greater than 0")?;
            return Ok(Disc { axis, radius, hole_radius });
        }
        let radius = entry.number(RADIUS, "a disc has a radius greater than 0")?;
        Ok(Disc { axis, radius, hole_radius: 0.0 })
    }

    fn check(&self) -> Result<(), Mistake> {
        point(CENTER.name, self.axis.center)?;
        direction(AXIS.name, self.axis.direction)?;
        let [radius, hole] = [self.radius, self.hole_radius].each(T::to_f64);
        positive::<T>(if hole == 0.0 { RADIUS } else { OUTER }.name, radius, "a radius")?;
        not_negative::<T>(INNER.name, hole, "a radius")?;
        if self.hole_radius < self.radius {
            return Ok(());
        }
        let wanted = format!("it must be less than outer, {radius:?}");
        Err(Mistake::value(INNER.name, hole, wanted))
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
        vec![Band::thin(self.axis, slant).into()]
    }

    fn is_thin(&self) -> bool {
        true
    }

    fn area(&self) -> Option<T> {
        Some(Slant::new([self.hole_radius, T::ZERO], [self.radius, T::ZERO]).area() * T::whole(2))
    }

    fn gate(&self) -> Option<Gate<T>> {
        let Axis { center, direction } = self.axis;
        let opening = Opening::Ring([self.hole_radius, self.radius], center);
        Some(Gate::flat(Plane { point: center, normal: direction }, Some(opening)))
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        detail.turned(&self.axis, &[[self.hole_radius, T::ZERO], [self.radius, T::ZERO]])
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.axis.around(T::ZERO, self.radius).into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self {
            axis: self.axis.placed(at),
            radius: at.length(self.radius),
            hole_radius: at.length(self.hole_radius),
        }
    }
}
