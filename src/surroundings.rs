//! Surroundings: what is fixed in space.
//!
//! A [`Shape`] is one entry of a scene. For the kernels it falls apart into
//! [`Feature`]s, each of which a sphere can touch in one point at a time: a
//! hollow box into its six faces, a hollow cylinder into its wall and its ends,
//! a profile turned about an axis at its concave corners, most shapes into one. A feature knows
//! two things: its [`Clearance`] from a sphere, in one function over lanes, and
//! the time at which a sphere in free flight comes to it.
//!
//! A shape is one file, which implements the two traits of `solid.rs`, and one
//! entry of the list below. The scene file, the checks, the placement of spheres
//! and both engines know shapes through these traits only.

// Keys of shapes stand beside the shapes, and only scene files read them.
#![cfg_attr(not(feature = "files"), allow(dead_code))]

mod axis;
mod band;
mod capsule;
mod chain;
mod cone;
mod convex_hull;
mod copies;
mod cuboid;
mod cylinder;
mod disc;
mod entry;
mod facet;
mod features;
mod fixed_sphere;
mod frustum;
mod gate;
mod heightfield;
mod hull;
mod mesh;
mod mistake;
mod parts;
mod piece;
mod pieced;
mod placement;
mod plane;
mod polytope;
mod revolved;
mod rod;
mod sensor;
mod skin;
mod slant;
mod solid;
mod torus;
mod triangle;
mod tube;

#[cfg(feature = "files")]
pub(crate) use entry::{FilePath, Key, Meaning, NO_VECTOR, ShapeEntry, Value};
pub(crate) use features::{FeatureRef, Features};
pub(crate) use gate::Gate;
pub(crate) use mistake::{Mistake, corners, finite, is_positive, positive};
pub(crate) use placement::Placement;
pub(crate) use solid::ShapeKind;

pub use band::Band;
pub use chain::Chain;
pub use facet::Facet;
pub use frustum::Frustum;
pub use gate::Passages;
pub use mesh::{FilePlace, MeshError, MeshReport};
pub use polytope::Polytope;
pub use rod::Rod;

use skin::Detail;
use solid::{Obstacle, Solid, solids};

use crate::contact::FreeFlight;
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

solids! {
    shapes {
        /// A half space, or a face of a container.
        plane::Plane,
        /// A box, solid or hollow.
        cuboid::Cuboid,
        /// A sphere, solid or hollow.
        fixed_sphere::FixedSphere,
        /// A thin triangle.
        triangle::Triangle,
        /// A convex hull.
        hull::Hull,
        /// A surface of triangles.
        mesh::Mesh,
        /// A surface over a grid.
        heightfield::Heightfield,
        /// A capsule, solid or hollow.
        capsule::Capsule,
        /// A cylinder with or without ends, solid or hollow.
        cylinder::Cylinder,
        /// A cone or a frustum, solid or hollow.
        cone::Cone,
        /// A thin disc, which may have a hole.
        disc::Disc,
        /// A thin tube or funnel, open at both ends.
        tube::Tube,
        /// A torus, solid or hollow.
        torus::Torus,
        /// A profile turned about an axis: thin, solid or hollow.
        revolved::Revolved,
        /// A shape again and again, at equal steps.
        copies::Copies,
        /// A part that only counts.
        sensor::Sensor,
    }
    features {
        /// A half space, or a face of a container.
        Plane,
        /// A box.
        Cuboid,
        /// A sphere, solid or hollow.
        FixedSphere,
        /// A thin triangle.
        Facet,
        /// A convex hull.
        Polytope,
        /// A capsule, solid or hollow.
        Capsule,
        /// A cylinder without end, solid or hollow.
        Rod,
        /// A solid cylinder, cone or frustum.
        Frustum,
        /// A thin disc, tube or funnel; or the wall of a hollow cone.
        Band,
        /// A torus, solid or hollow.
        Torus,
        /// Lines of a profile turned about an axis, on one side of which is something solid.
        Chain,
    }
}

/// The kinds of shape that a scene file names.
#[cfg(feature = "files")]
pub(crate) fn shape_kinds() -> impl Iterator<Item = &'static ShapeKind> {
    ALL_KINDS.iter().filter(|kind| !kind.keys.is_empty())
}

impl<T: Real> Shape<T> {
    /// Of a sensor, its surface by its sides.
    pub(crate) fn sensed(&self) -> Option<Gate<T>> {
        match self {
            Self::Sensor(sensor) => sensor.gate(),
            _ => None,
        }
    }

    /// Its surface as triangles, for pictures: each by its corners, length, counter-clockwise
    /// as seen from where spheres are; of what is thin from one side or the other. What has no
    /// end goes as far as a box with these corners; a circle has `around` of its own.
    ///
    /// ```
    /// use carom::surroundings::{Cuboid, Shape};
    /// use carom::Vec3;
    /// let brick = Shape::from(Cuboid::solid([0.0_f64; 3], [1.0, 2.0, 3.0]));
    /// assert_eq!(brick.triangles([Vec3::ZERO; 2], 64).len(), 12);
    /// ```
    #[must_use]
    pub fn triangles(&self, within: [Vec3<T>; 2], around: usize) -> Vec<[Vec3<T>; 3]> {
        self.skin(&Detail { within, around: around.max(3) })
    }

    /// Whether it only counts.
    ///
    /// ```
    /// use carom::surroundings::{Plane, Sensor, Shape};
    /// let level = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
    /// assert!(!Shape::from(level).is_sensor() && Shape::from(Sensor::new(level)).is_sensor());
    /// ```
    #[must_use]
    pub fn is_sensor(&self) -> bool {
        matches!(self, Self::Sensor(_))
    }
}

/// Where a sphere stands to a fixed feature.
///
/// ```
/// use carom::surroundings::{Feature, Plane};
/// use carom::vec3::Vec3;
///
/// let floor = Feature::from(Plane::new([0.0; 3], [0.0, 0.0, 1.0]));
/// let clearance = floor.clearance(Vec3::new(7.0, 0.0, 3.0), 1.0);
/// assert_eq!(clearance.gap, 2.0);
/// assert_eq!(clearance.arm.to_array(), [0.0, 0.0, 1.0]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Clearance<L> {
    /// Distance between the two surfaces, length; negative where they overlap.
    pub gap: L,
    /// From the point of contact to the sphere's centre, length `r`. Its
    /// direction is the normal out of the solid.
    pub arm: Vec3<L>,
}

impl<L: Lane> Clearance<L> {
    /// Of a sphere and what is round, with the radius `fixed` about a line or a point from
    /// which the centre is off by `offset`, as long as `distance`.
    ///
    /// The arm is in proportion to the true distance, as for two free spheres: at contact
    /// it has length r exactly.
    #[inline(always)]
    fn round(offset: Vec3<L>, distance: L, fixed: L, radius: L, is_hollow: bool) -> Self {
        if is_hollow {
            let reach = fixed - radius;
            Self { gap: reach - distance, arm: -(offset * (radius / reach)) }
        } else {
            let reach = fixed + radius;
            Self { gap: distance - reach, arm: offset * (radius / reach) }
        }
    }

    /// Of a sphere and what its centre is off by a distance, along a unit normal.
    #[inline(always)]
    fn off((distance, normal): (L, Vec3<L>), radius: L) -> Self {
        Self { gap: distance - radius, arm: normal * radius }
    }

    /// How far a sphere is to be moved so that the two surfaces just touch, length.
    ///
    /// ```
    /// use carom::surroundings::{Feature, Plane};
    /// use carom::vec3::Vec3;
    ///
    /// let floor = Feature::from(Plane::new([0.0; 3], [0.0, 0.0, 1.0]));
    /// let clearance = floor.clearance(Vec3::new(7.0, 0.0, 3.0), 1.0);
    /// assert_eq!(clearance.way_to_touch().to_array(), [0.0, 0.0, -2.0]);
    /// ```
    #[inline(always)]
    pub fn way_to_touch(&self) -> Vec3<L> {
        -(self.arm * (self.gap / self.arm.length()))
    }
}

impl<T: Real> Feature<T> {
    /// The corners of the box that the solid fills, length; `None` for one
    /// without end.
    ///
    /// ```
    /// use carom::surroundings::{Feature, FixedSphere, Plane};
    ///
    /// let ball = Feature::from(FixedSphere::solid([1.0, 0.0, 0.0], 2.0));
    /// let corners = ball.bounds().map(|corners| corners.map(|c| c.to_array()));
    /// assert_eq!(corners, Some([[-1.0, -2.0, -2.0], [3.0, 2.0, 2.0]]));
    /// assert!(Feature::from(Plane::new([0.0; 3], [0.0, 0.0, 1.0])).bounds().is_none());
    /// ```
    #[must_use]
    pub fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        Obstacle::bounds(self)
    }

    /// Where spheres with these centres and radii, length, stand to the feature.
    ///
    /// A lane is one sphere or a pack of them:
    ///
    /// ```
    /// use carom::lane::Lane;
    /// use carom::surroundings::{Cuboid, Feature};
    /// use carom::vec3::Vec3;
    ///
    /// let cube = Feature::from(Cuboid::solid([0.0; 3], [1.0; 3]));
    /// assert_eq!(cube.clearance(Vec3::new(0.5, 0.5, 4.0), 1.0).gap, 2.0);
    ///
    /// let heights = wide::f64x4::from([4.0, 3.0, 2.0, 1.5]);
    /// let [half, one] = [0.5, 1.0].map(wide::f64x4::splat);
    /// let gaps = cube.clearance(Vec3::new(half, half, heights), one).gap;
    /// assert_eq!(gaps.to_array(), [2.0, 1.0, 0.0, -0.5]);
    /// ```
    #[inline(always)]
    pub fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        Obstacle::clearance(self, center, radius)
    }

    /// Time from now until a sphere in free flight collides with the feature,
    /// not negative; None if it never does.
    ///
    /// The flight is `c(t) = c + v t + a t²/2`, with `center` and `radius` in
    /// length, `velocity` in length per time and `acceleration` in length per
    /// time²; None is straight flight. The time is that at which the gap falls
    /// through zero: never one at which the sphere comes out again, nor a graze
    /// without depth, as far as rounding can tell.
    ///
    /// What overlaps the feature, by rounding, counts as touching it: it
    /// collides now, at time 0, if it approaches, and later, when it comes back
    /// to where it is, if it does not. `is_leaving` says that the sphere has
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
        Obstacle::contact_time(self, &flight)
    }

    /// Whether it is curved towards the spheres: one that grazes it follows it in
    /// shorter and shorter flights.
    pub fn is_hollow(&self) -> bool {
        Obstacle::is_hollow(self)
    }

    /// The largest coordinate that the clearance is made of, length.
    pub(crate) fn farthest(&self) -> f64 {
        Obstacle::farthest(self)
    }
}
