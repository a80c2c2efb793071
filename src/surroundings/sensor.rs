//! Sensor: a part that only counts.

use super::entry::{Key, ShapeEntry};
use super::gate::Gate;
use super::mistake::Mistake;
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::solid::Solid;
use super::{Feature, Shape};
use crate::real::Real;
use crate::space::Bounds;
use crate::vec3::Vec3;

/// A part that spheres pass through: it counts how often their centres do, each way, and
/// changes nothing.
///
/// It has two sides: a plane, a disc, an annulus or a triangle, or what is closed, of which it
/// is the surface.
///
/// In a scene file: `sensor = true` beside the keys of the shape.
///
/// ```
/// use carom::surroundings::Sensor;
/// use carom::{EventDriven, Plane, Scene, Sphere};
///
/// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
/// let level = Sensor::new(Plane::new([0.0; 3], [0.0, 0.0, 1.0]));
/// let mut world = EventDriven::new(Scene::<f64>::builder().surroundings(level).sphere(ball).build()?)?;
/// world.advance(2.0)?;
/// assert_eq!(world.bodies().position_of(0).z, -1.0);
/// assert_eq!(world.parts()[0].passages.map(|passages| passages.inward), Some(1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor<T> {
    shape: Box<Shape<T>>,
}

impl<T: Real> Sensor<T> {
    /// One that has the surface of a shape.
    ///
    /// ```
    /// use carom::surroundings::{Cuboid, Sensor, Shape};
    /// let room = Shape::from(Sensor::new(Cuboid::solid([0.0; 3], [1.0; 3])));
    /// assert!(room.features().is_empty());
    /// ```
    #[must_use]
    pub fn new(shape: impl Into<Shape<T>>) -> Self {
        Self { shape: Box::new(shape.into()) }
    }

    fn of(shape: Shape<T>) -> Self {
        Self { shape: Box::new(shape) }
    }

    /// Its surface by its sides, if it has two.
    pub(super) fn gate(&self) -> Option<Gate<T>> {
        self.shape.gate()
    }
}

impl<T: Real> Solid<T> for Sensor<T> {
    type In<B: Real> = Sensor<B>;

    const NAME: &'static str = "sensor";
    /// No shape of a scene file: any shape may be one there.
    const KEYS: &'static [Key] = &[];

    fn read(entry: &ShapeEntry) -> Result<Sensor<f64>, Mistake> {
        Err(Mistake::described("shape", entry.shape, "a sensor is a shape with sensor = true"))
    }

    fn check(&self) -> Result<(), Mistake> {
        self.shape.check()?;
        if self.gate().is_some() {
            return Ok(());
        }
        let wanted = format!(
            "a {} has no two distinct sides: a sensor is a plane, a disc, an annulus, a \
             triangle, or what is closed: a box, a sphere, a capsule, a cylinder, a cone, a torus or \
             a closed profile",
            self.shape.name()
        );
        Err(Mistake::value("sensor", true, wanted))
    }

    fn cast<B: Real>(&self) -> Sensor<B> {
        Sensor::of(self.shape.cast())
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        self.shape.skin(detail)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.shape.points()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self::of(self.shape.placed(at))
    }

    /// Spheres touch nothing of it.
    fn features(&self) -> Vec<Feature<T>> {
        Vec::new()
    }

    fn extent(&self) -> Option<Bounds<T>> {
        self.shape.bounds()
    }

    fn area(&self) -> Option<T> {
        self.shape.area()
    }
}
