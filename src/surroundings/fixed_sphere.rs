//! Fixed sphere: a solid ball, or the hollow in one.

use super::axis::Axis;
use super::axis::pi;
use super::entry::{CENTER, INSIDE, Key, RADIUS, ShapeEntry};
use super::gate::Gate;
use super::mistake::{Mistake, point, positive};
use super::placement::Placement;
use super::skin::{Corners, Detail, from_inside};
use super::solid::{Obstacle, Solid};
use super::{Clearance, Feature};
use crate::contact::{Approach, FreeFlight, Start, greatest_component};
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// A sphere fixed in space.
///
/// In a scene file: `shape = "sphere"` with `center`, `radius` and `inside`;
/// `inside = true` makes a container.
///
/// ```
/// use carom::surroundings::{Feature, FixedSphere};
/// use carom::vec3::Vec3;
///
/// let hollow = FixedSphere::container([0.0; 3], 5.0);
/// let clearance = Feature::from(hollow).clearance(Vec3::new(3.0, 0.0, 0.0), 1.0);
/// assert_eq!((clearance.gap, clearance.arm.x), (1.0, -0.75));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedSphere<T> {
    /// Its centre, length.
    pub center: Vec3<T>,
    /// Its radius, length.
    pub radius: T,
    /// Whether bodies are inside of it: a spherical container.
    pub inside: bool,
}

impl<T: Real> FixedSphere<T> {
    /// A solid sphere that bodies bounce off; `center` and `radius` in length.
    ///
    /// ```
    /// use carom::surroundings::FixedSphere;
    /// assert!(!FixedSphere::solid([0.0, 0.0, 1.0], 0.5).inside);
    /// ```
    #[must_use]
    pub fn solid(center: [T; 3], radius: T) -> Self {
        Self { center: center.into(), radius, inside: false }
    }

    /// A spherical container that bodies are inside of; `center` and `radius` in
    /// length.
    ///
    /// ```
    /// use carom::surroundings::FixedSphere;
    /// assert!(FixedSphere::container([0.0, 0.0, 1.0], 0.5).inside);
    /// ```
    #[must_use]
    pub fn container(center: [T; 3], radius: T) -> Self {
        Self { center: center.into(), radius, inside: true }
    }

    /// The flight of a centre, seen from its own.
    fn approach(&self, flight: &FreeFlight<T>) -> Approach<T> {
        let radius = if self.inside { -flight.radius } else { flight.radius };
        Approach {
            offset: flight.center - self.center,
            velocity: flight.velocity,
            acceleration: flight.acceleration.unwrap_or(Vec3::ZERO),
            reach: self.radius + radius,
            is_hollow: self.inside,
        }
    }

    /// The cube about its centre whose faces are `reach` away.
    fn cube(&self, reach: T) -> [Vec3<T>; 2] {
        let reach = Vec3::new(reach, reach, reach);
        [self.center - reach, self.center + reach]
    }
}

impl<T: Real> Obstacle<T> for FixedSphere<T> {
    /// At the common centre, where no normal is defined, the arm is zero and
    /// no impulse follows.
    #[inline(always)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let offset = center - Vec3::splat(self.center);
        let distance = offset.length();
        Clearance::round(offset, distance, L::splat(self.radius), radius, self.inside)
    }

    /// For centres at the sum of the radii, inside at their difference.
    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        let approach = self.approach(flight);
        let slack = approach.squared(flight.slack(self.center));
        let start = Start::at(approach.gap_squared(), slack, flight.is_leaving);
        approach.contact_time(start, &|_| true)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        (!self.inside).then(|| self.cube(self.radius))
    }

    fn farthest(&self) -> f64 {
        greatest_component(self.center.cast::<f64>()) + self.radius.to_f64()
    }

    fn is_hollow(&self) -> bool {
        self.inside
    }

    fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        self.approach(flight).hop(wait)
    }
}

impl<T: Real> Solid<T> for FixedSphere<T> {
    type In<B: Real> = FixedSphere<B>;

    const NAME: &'static str = "sphere";
    const KEYS: &'static [Key] = &[CENTER, RADIUS, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<FixedSphere<f64>, Mistake> {
        Ok(FixedSphere {
            center: entry.vector(CENTER)?.into(),
            radius: entry.number(RADIUS, "a sphere has a radius greater than 0")?,
            inside: entry.flag(INSIDE),
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        point(CENTER.name, self.center)?;
        positive::<T>(RADIUS.name, self.radius.to_f64(), "a radius")
    }

    fn cast<B: Real>(&self) -> FixedSphere<B> {
        FixedSphere { center: self.center.cast(), radius: self.radius.cast(), inside: self.inside }
    }

    fn features(&self) -> Vec<Feature<T>> {
        vec![(*self).into()]
    }

    fn area(&self) -> Option<T> {
        Some(pi::<T>() * T::whole(4) * self.radius * self.radius)
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        let axis = Axis { center: self.center, direction: Vec3::new(T::ZERO, T::ZERO, T::ONE) };
        let half_circle = detail.arc([T::ZERO; 2], self.radius, [-1, 1]);
        from_inside(detail.turned(&axis, &half_circle), self.inside)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        let [lower, upper] = self.cube(self.radius);
        vec![self.center, lower, upper]
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self { center: at.point(self.center), radius: at.length(self.radius), inside: self.inside }
    }

    fn gate(&self) -> Option<Gate<T>> {
        Some(Gate::closed(|inside| Self { inside, ..*self }.features()))
    }

    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        self.inside.then(|| self.cube(self.radius))
    }

    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        self.inside.then(|| self.cube(self.radius / T::whole(3).sqrt()))
    }
}
