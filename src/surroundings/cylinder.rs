//! Cylinder: solid or hollow, with ends or without.

use super::axis::{Axis, inscribed, pi};
use super::entry::{AXIS, CENTER, HALF_HEIGHT, HEIGHT, INSIDE, Key, RADIUS, ShapeEntry};
use super::gate::Gate;
use super::mistake::{Mistake, direction, point, positive};
use super::placement::Placement;
use super::skin::{Corners, Detail, from_inside};
use super::solid::Solid;
use super::{Feature, Frustum, Plane, Rod};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// A cylinder fixed in space.
///
/// In a scene file: `shape = "cylinder"` with `center`, `axis`, `radius`, `height` or
/// `half_height`, and `inside`; `inside = true` makes a container. Without a height it has no
/// end, unless it is called `"capped-cylinder"`, which has to have one.
///
/// ```
/// use carom::surroundings::{Cylinder, Shape};
/// use carom::vec3::Vec3;
///
/// let drum = Cylinder::solid([0.0; 3], [0.0, 0.0, 1.0], 2.0, Some(2.0));
/// let [drum] = &Shape::from(drum).features()[..] else { return };
/// assert_eq!(drum.clearance(Vec3::new(5.0, 5.0, 0.0), 0.5).gap, 50.0_f64.sqrt() - 2.5);
/// assert_eq!(drum.clearance(Vec3::new(5.0, 0.0, 5.0), 0.5).gap, 4.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<T> {
    axis: Axis<T>,
    radius: T,
    height: Option<T>,
    inside: bool,
}

impl<T: Real> Cylinder<T> {
    /// A solid cylinder that bodies bounce off: the middle of it, its axis, of any length
    /// but 0, its radius, and its height if it has ends; lengths.
    ///
    /// ```
    /// use carom::surroundings::{Cylinder, Shape};
    /// let pole = Cylinder::solid([0.0; 3], [0.0, 0.0, 2.0], 1.0, None);
    /// assert!(Shape::from(pole).features()[0].bounds().is_none());
    /// ```
    #[must_use]
    pub fn solid(center: [T; 3], axis: [T; 3], radius: T, height: Option<T>) -> Self {
        Self { axis: Axis::new(center, axis), radius, height, inside: false }
    }

    /// A container that bodies are inside of, of the same lengths.
    ///
    /// ```
    /// use carom::surroundings::{Cylinder, Shape};
    /// let can = Cylinder::container([0.0; 3], [0.0, 0.0, 2.0], 1.0, Some(4.0));
    /// let corners = Shape::from(can).interior().map(|corners| corners.map(|c| c.to_array()));
    /// assert_eq!(corners, Some([[-1.0, -1.0, -2.0], [1.0, 1.0, 2.0]]));
    /// ```
    #[must_use]
    pub fn container(center: [T; 3], axis: [T; 3], radius: T, height: Option<T>) -> Self {
        Self { inside: true, ..Self::solid(center, axis, radius, height) }
    }

    fn around(&self) -> Option<[Vec3<T>; 2]> {
        let half = self.height? * T::ratio(1, 2);
        Some(joined(self.axis.around(-half, self.radius), self.axis.around(half, self.radius)))
    }
}

/// One that has ends.
const CAPPED: &str = "capped-cylinder";

impl<T: Real> Solid<T> for Cylinder<T> {
    type In<B: Real> = Cylinder<B>;

    const NAME: &'static str = "cylinder";
    const OTHER_NAME: Option<&'static str> = Some(CAPPED);
    const KEYS: &'static [Key] = &[CENTER, AXIS, RADIUS, HEIGHT, HALF_HEIGHT, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<Cylinder<f64>, Mistake> {
        let height = entry.height()?;
        if height.is_none() && entry.shape == CAPPED {
            let wanted = "a capped cylinder has a half_height, or a height";
            return Err(Mistake::missing(HALF_HEIGHT.name, wanted));
        }
        Ok(Cylinder {
            axis: Axis::new(entry.vector(CENTER)?, entry.vector(AXIS)?),
            radius: entry.number(RADIUS, "a cylinder has a radius greater than 0")?,
            height,
            inside: entry.flag(INSIDE),
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        point(CENTER.name, self.axis.center)?;
        direction(AXIS.name, self.axis.direction)?;
        positive::<T>(RADIUS.name, self.radius.to_f64(), "a radius")?;
        self.height.map_or(Ok(()), |height| positive::<T>(HEIGHT.name, height.to_f64(), "a height"))
    }

    fn cast<B: Real>(&self) -> Cylinder<B> {
        Cylinder {
            axis: self.axis.cast(),
            radius: self.radius.cast(),
            height: self.height.map(Real::cast),
            inside: self.inside,
        }
    }

    /// A container is its wall and the two ends.
    fn features(&self) -> Vec<Feature<T>> {
        let Self { axis, radius, height, inside } = *self;
        let rod = Rod { axis, radius, inside };
        let Some(height) = height else { return vec![rod.into()] };
        let half = height * T::ratio(1, 2);
        if !inside {
            return vec![Frustum::new(axis.moved(-half), height, [radius, radius]).into()];
        }
        let normal = axis.direction;
        let base = Plane { point: axis.point(-half), normal };
        let top = Plane { point: axis.point(half), normal: -normal };
        vec![rod.into(), base.into(), top.into()]
    }

    fn area(&self) -> Option<T> {
        Some(pi::<T>() * T::whole(2) * self.radius * (self.height? + self.radius))
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        let (zero, radius) = (T::ZERO, self.radius);
        let triangles = match self.height {
            Some(height) => {
                let [low, high] = [-height, height].each(|height| height * T::ratio(1, 2));
                let profile = [[zero, low], [radius, low], [radius, high], [zero, high]];
                detail.turned(&self.axis, &profile)
            }
            None => {
                let profile = detail.heights(&self.axis).each(|height| [radius, height]);
                detail.turned(&self.axis, &profile)
            }
        };
        from_inside(triangles, self.inside)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        let around = self.around().unwrap_or_else(|| self.axis.around(T::ZERO, self.radius));
        around.into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self {
            axis: self.axis.placed(at),
            radius: at.length(self.radius),
            height: self.height.map(|height| at.length(height)),
            inside: self.inside,
        }
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

    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        let half = self.height? * T::ratio(1, 2);
        self.inside.then(|| inscribed(&self.axis, self.radius, half))
    }
}
