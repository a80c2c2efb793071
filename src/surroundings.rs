//! Surroundings: what is fixed in space, and the periodic box.
//!
//! A [`Shape`] is one entry of a scene. For the kernels it falls apart into
//! [`Feature`]s, each of which a sphere can touch in one point at a time: a
//! container into its six faces, every other shape into itself. A feature knows
//! one thing, its [`Clearance`] from a sphere, in one function over lanes; a new
//! shape is a new file with that function.

mod cuboid;
mod fixed_sphere;
mod periodic;
mod plane;

pub use cuboid::Cuboid;
pub use fixed_sphere::FixedSphere;
pub use periodic::{OpenSpace, PeriodicBox, Space};
pub use plane::Plane;

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
}
