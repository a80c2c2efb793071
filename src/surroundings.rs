//! Surroundings: what is fixed in space.
//!
//! A [`Shape`] is one entry of a scene. For the kernels it falls apart into
//! [`Feature`]s, each of which a sphere can touch in one point at a time: a
//! container into its six faces, every other shape into itself. A feature knows
//! two things: its [`Clearance`] from a sphere, in one function over lanes, and
//! the time at which a sphere in free flight comes to it. A new shape is a new
//! file with these two functions.

mod cuboid;
mod fixed_sphere;
mod free_flight;
mod parts;
mod plane;

pub use cuboid::Cuboid;
pub use fixed_sphere::FixedSphere;
pub use plane::Plane;

use free_flight::FreeFlight;

use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// Where a sphere stands to a fixed feature.
#[derive(Clone, Copy, Debug)]
pub struct Clearance<L> {
    /// Distance between the two surfaces, length; negative where they overlap.
    pub gap: L,
    /// From the point of contact to the sphere's centre, length `r`. Its
    /// direction is the normal out of the solid.
    pub arm: Vec3<L>,
}

/// A fixed solid, as a scene names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<T> {
    /// A half space.
    Plane(Plane<T>),
    /// A box, solid or hollow.
    Cuboid(Cuboid<T>),
    /// A sphere, solid or hollow.
    FixedSphere(FixedSphere<T>),
}

impl<T> From<Plane<T>> for Shape<T> {
    fn from(plane: Plane<T>) -> Self {
        Self::Plane(plane)
    }
}

impl<T> From<Cuboid<T>> for Shape<T> {
    fn from(cuboid: Cuboid<T>) -> Self {
        Self::Cuboid(cuboid)
    }
}

impl<T> From<FixedSphere<T>> for Shape<T> {
    fn from(sphere: FixedSphere<T>) -> Self {
        Self::FixedSphere(sphere)
    }
}

impl<T: Real> Shape<T> {
    /// The features that a sphere can touch.
    #[must_use]
    pub fn features(&self) -> Vec<Feature<T>> {
        match self {
            Self::Plane(plane) => vec![Feature::Plane(*plane)],
            Self::Cuboid(cuboid) if cuboid.inside => {
                cuboid.faces().into_iter().map(Feature::Plane).collect()
            }
            Self::Cuboid(cuboid) => vec![Feature::Cuboid(*cuboid)],
            Self::FixedSphere(sphere) => vec![Feature::FixedSphere(*sphere)],
        }
    }

    /// The region that the shape encloses as a container, `lower` and `upper`
    /// corner; `None` for a shape that spheres stay outside of.
    #[must_use]
    pub fn interior(&self) -> Option<[Vec3<T>; 2]> {
        match self {
            Self::Cuboid(cuboid) if cuboid.inside => Some([cuboid.lower, cuboid.upper]),
            Self::FixedSphere(sphere) if sphere.inside => {
                let reach = Vec3::new(sphere.radius, sphere.radius, sphere.radius);
                Some([sphere.center - reach, sphere.center + reach])
            }
            _ => None,
        }
    }
}

/// The features of all shapes, and for each of them which shape it is of.
pub(crate) fn features_of<T: Real>(shapes: &[Shape<T>]) -> (Vec<Feature<T>>, Vec<u32>) {
    let (mut features, mut parts) = (Vec::new(), Vec::new());
    for (part, shape) in shapes.iter().enumerate() {
        features.extend(shape.features());
        parts.resize(features.len(), part as u32);
    }
    (features, parts)
}

/// What a sphere can touch in one point at a time.
#[derive(Clone, Copy, Debug)]
pub enum Feature<T> {
    /// A half space, or a face of a container.
    Plane(Plane<T>),
    /// The outside of a box.
    Cuboid(Cuboid<T>),
    /// A sphere, solid or hollow.
    FixedSphere(FixedSphere<T>),
}

impl<T: Real> Feature<T> {
    /// The corners of the box that the solid fills; `None` for one without end.
    #[must_use]
    pub fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        match self {
            Self::Cuboid(cuboid) if !cuboid.inside => Some([cuboid.lower, cuboid.upper]),
            Self::FixedSphere(sphere) if !sphere.inside => {
                let reach = Vec3::new(sphere.radius, sphere.radius, sphere.radius);
                Some([sphere.center - reach, sphere.center + reach])
            }
            _ => None,
        }
    }

    /// Where spheres with these centres and radii stand to the feature.
    #[inline(always)]
    pub fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        match self {
            Self::Plane(plane) => plane.clearance(center, radius),
            Self::Cuboid(cuboid) => cuboid.clearance(center, radius),
            Self::FixedSphere(sphere) => sphere.clearance(center, radius),
        }
    }
    /// Time from now until a sphere in free flight collides with the feature,
    /// not negative; None if it never does.
    ///
    /// The flight is `c(t) = c + v t + a t²/2`, with `center` and `radius` in
    /// length, `velocity` in length per time and `acceleration` in length per
    /// time²; None is straight flight. The time is that at which the gap falls
    /// through zero: never one at which the sphere comes out again, nor a graze
    /// without depth.
    ///
    /// What overlaps the feature, by rounding, counts as touching it: it
    /// collides now, at time 0, if it approaches, and later, when it comes back
    /// to where it is, if it does not. `is_leaving` tells that the sphere has
    /// just bounced off this feature: it does not approach then, whatever
    /// rounding says. One that rests on the feature under a force collides now.
    ///
    /// Time and squares of time, velocity and length must be within the
    /// precision's range.
    ///
    /// ```
    /// use carom::surroundings::{Feature, Plane};
    /// use carom::vec3::Vec3;
    ///
    /// let floor = Feature::Plane(Plane::new([0.0; 3], [0.0, 0.0, 1.0]));
    /// let center = Vec3::new(0.0, 0.0, 6.0);
    /// let (rest, gravity) = (Vec3::ZERO, Some(Vec3::new(0.0, 0.0, -10.0)));
    /// assert_eq!(floor.contact_time(center, rest, gravity, 1.0, false), Some(1.0));
    /// assert_eq!(floor.contact_time(center, rest, None, 1.0, false), None);
    ///
    /// // Just bounced, and up again with velocity 10.
    /// let (center, up) = (Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 10.0));
    /// assert_eq!(floor.contact_time(center, up, gravity, 1.0, true), Some(2.0));
    /// ```
    #[must_use]
    pub fn contact_time(
        &self,
        center: Vec3<T>,
        velocity: Vec3<T>,
        acceleration: Option<Vec3<T>>,
        radius: T,
        is_leaving: bool,
    ) -> Option<T> {
        let flight = FreeFlight { center, velocity, acceleration, radius, is_leaving };
        match self {
            Self::Plane(plane) => plane.contact_time(&flight),
            Self::Cuboid(cuboid) => cuboid.contact_time(&flight),
            Self::FixedSphere(sphere) => sphere.contact_time(&flight),
        }
    }
}
