//! Torus: a solid ring, or the hollow in one.

use super::Clearance;
use super::axis::{Axis, pi};
use super::entry::{AXIS, CENTER, INSIDE, Key, Meaning, ShapeEntry};
use super::gate::Gate;
use super::mistake::{Mistake, direction, point, positive};
use super::piece::Piece;
use super::pieced::Pieced;
use super::placement::Placement;
use super::skin::{Corners, Detail, from_inside};
use super::solid::{Obstacle, Solid};
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::Lane;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// A torus fixed in space: a tube along a circle.
///
/// In a scene file: `shape = "torus"` with `center`, `axis`, `major`, the radius of the
/// circle, `minor`, that of the tube, and `inside`; `inside = true` makes a container.
///
/// ```
/// use carom::surroundings::{Feature, Torus};
/// use carom::vec3::Vec3;
///
/// let ring = Feature::from(Torus::solid([0.0; 3], [0.0, 0.0, 1.0], 3.0, 1.0));
/// assert_eq!(ring.clearance(Vec3::new(5.0, 0.0, 0.0), 0.5).gap, 0.5);
/// assert_eq!(ring.clearance(Vec3::new(0.0, 1.0, 0.0), 0.5).gap, 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus<T> {
    axis: Axis<T>,
    radius: T,
    tube_radius: T,
    inside: bool,
}

impl<T: Real> Torus<T> {
    /// A solid ring that bodies bounce off: its centre, length, its axis, of any length but
    /// 0, the radius of the circle, and that of the tube along it, length.
    ///
    /// ```
    /// use carom::surroundings::{Shape, Torus};
    /// let ring = Torus::solid([0.0; 3], [0.0, 0.0, 2.0], 3.0, 1.0);
    /// assert_eq!(Shape::from(ring).interior(), None);
    /// ```
    #[must_use]
    pub fn solid(center: [T; 3], axis: [T; 3], radius: T, tube_radius: T) -> Self {
        Self { axis: Axis::new(center, axis), radius, tube_radius, inside: false }
    }

    /// A container that bodies are inside of, of the same lengths.
    ///
    /// ```
    /// use carom::surroundings::{Shape, Torus};
    /// let ring = Torus::container([0.0; 3], [0.0, 0.0, 2.0], 3.0, 1.0);
    /// let corners = Shape::from(ring).interior().map(|corners| corners.map(|c| c.to_array()));
    /// assert_eq!(corners, Some([[-4.0, -4.0, -1.0], [4.0, 4.0, 1.0]]));
    /// ```
    #[must_use]
    pub fn container(center: [T; 3], axis: [T; 3], radius: T, tube_radius: T) -> Self {
        Self { inside: true, ..Self::solid(center, axis, radius, tube_radius) }
    }

    fn around(&self) -> [Vec3<T>; 2] {
        let [lower, upper] = self.axis.around(T::ZERO, self.radius);
        let reach = Vec3::new(self.tube_radius, self.tube_radius, self.tube_radius);
        [lower - reach, upper + reach]
    }
}

impl<T: Real> Obstacle<T> for Torus<T> {
    /// On the circle, where no normal is defined, the arm is zero and no impulse follows.
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let place = self.axis.place(center);
        let out = place.distance - L::splat(self.radius);
        let distance = (out * out + place.height * place.height).sqrt();
        let offset = place.outward * out + Vec3::splat(self.axis.direction) * place.height;
        Clearance::round(offset, distance, L::splat(self.tube_radius), radius, self.inside)
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        (!self.inside).then(|| self.around())
    }

    fn farthest(&self) -> f64 {
        let [lower, upper] = self.around().each(|corner| greatest_component(corner.cast::<f64>()));
        lower.max(upper)
    }

    fn is_hollow(&self) -> bool {
        self.inside
    }

    fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        self.long_hop(flight, wait)
    }
}

impl<T: Real> Pieced<T> for Torus<T> {
    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        visit(Piece::Rim {
            axis: self.axis,
            height: T::ZERO,
            distance: self.radius,
            radius: self.tube_radius,
            is_hollow: self.inside,
        });
    }
}

const MAJOR: Key = Key::new("major", Meaning::Length);
const MINOR: Key = Key::new("minor", Meaning::Length);

impl<T: Real> Solid<T> for Torus<T> {
    type In<B: Real> = Torus<B>;

    const NAME: &'static str = "torus";
    const KEYS: &'static [Key] = &[CENTER, AXIS, MAJOR, MINOR, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<Torus<f64>, Mistake> {
        Ok(Torus {
            axis: Axis::new(entry.vector(CENTER)?, entry.vector(AXIS)?),
            radius: entry.number(MAJOR, "a torus has the radius of its circle")?,
            tube_radius: entry.number(MINOR, "a torus has the radius of its tube")?,
            inside: entry.flag(INSIDE),
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        point(CENTER.name, self.axis.center)?;
        direction(AXIS.name, self.axis.direction)?;
        positive::<T>(MAJOR.name, self.radius.to_f64(), "a radius")?;
        positive::<T>(MINOR.name, self.tube_radius.to_f64(), "a radius")?;
        if self.tube_radius < self.radius {
            return Ok(());
        }
        let wanted = format!(
            "it must be less than major, {:?}, so that there is a hole",
            self.radius.to_f64()
        );
        Err(Mistake::value(MINOR.name, self.tube_radius.to_f64(), wanted))
    }

    fn cast<B: Real>(&self) -> Torus<B> {
        Torus {
            axis: self.axis.cast(),
            radius: self.radius.cast(),
            tube_radius: self.tube_radius.cast(),
            inside: self.inside,
        }
    }

    fn features(&self) -> Vec<super::Feature<T>> {
        vec![(*self).into()]
    }

    fn area(&self) -> Option<T> {
        Some(pi::<T>() * pi::<T>() * T::whole(4) * self.radius * self.tube_radius)
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        let circle = detail.arc([self.radius, T::ZERO], self.tube_radius, [0, 4]);
        from_inside(detail.turned(&self.axis, &circle), self.inside)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.around().into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self {
            axis: self.axis.placed(at),
            radius: at.length(self.radius),
            tube_radius: at.length(self.tube_radius),
            inside: self.inside,
        }
    }

    fn gate(&self) -> Option<Gate<T>> {
        Some(Gate::closed(|inside| Self { inside, ..*self }.features()))
    }

    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        self.inside.then(|| self.around())
    }

    /// A cube in a piece of the tube.
    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        let center = self.axis.center + self.axis.side() * self.radius;
        let reach = self.tube_radius / T::whole(3).sqrt();
        let reach = Vec3::new(reach, reach, reach);
        self.inside.then(|| [center - reach, center + reach])
    }
}
