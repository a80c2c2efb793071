//! Solid: what a shape has to know. All of it stands in the shape's own file.

use super::entry::{Key, ShapeEntry};
use super::gate::Gate;
use super::mistake::Mistake;
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::{Clearance, Feature, Mesh};
use crate::contact::FreeFlight;
use crate::lane::Lane;
use crate::real::Real;
use crate::space::{Bounds, joined};
use crate::vec3::Vec3;

/// What a sphere touches in one point at a time: the kernels' side of a shape.
pub(crate) trait Obstacle<T: Real> {
    /// Where spheres with these centres and radii stand to it. Runs in the innermost loops:
    /// `#[inline(always)]` for plane, box and sphere, which are most walls; `#[inline(never)]`
    /// for what is longer than a call, since every loop would have a copy of it.
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L>;

    /// When a sphere in free flight collides with it, as
    /// [`Feature::contact_time`] has it.
    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T>;

    /// The corners of the box that the solid fills; `None` for one without end.
    fn bounds(&self) -> Option<[Vec3<T>; 2]>;

    /// The largest coordinate that its clearance is made of, length: what the
    /// clearance's rounding is measured by.
    fn farthest(&self) -> f64;

    /// Whether it is curved towards the spheres, which can follow it in shorter and
    /// shorter flights: rounding of their distance would add up.
    fn is_hollow(&self) -> bool {
        false
    }

    /// From contact, the time of a flight along it that stands for shorter ones: `wait`
    /// itself, unless that is too short to get on by.
    fn hop(&self, _flight: &FreeFlight<T>, wait: T) -> T {
        wait
    }
}

/// A fixed solid, as a scene names it: the scene's side of a shape.
pub(crate) trait Solid<T: Real>: Clone {
    /// The same shape in another precision.
    type In<B: Real>: Solid<B>;

    /// What `shape` in a scene file, and messages, call it.
    const NAME: &'static str;

    /// Another name of it, in a scene file only.
    const OTHER_NAME: Option<&'static str> = None;

    /// The keys of its entry, in the order that messages list them.
    const KEYS: &'static [Key];

    /// The shape that an entry describes, with whatever values it has.
    fn read(entry: &ShapeEntry) -> Result<Self::In<f64>, Mistake>;

    /// Finds a value that cannot be.
    fn check(&self) -> Result<(), Mistake>;

    /// Every number becomes the nearest of another precision.
    fn cast<B: Real>(&self) -> Self::In<B>;

    /// The points that it is described by, length.
    fn points(&self) -> Vec<Vec3<T>>;

    /// The same shape, scaled, turned and moved.
    fn placed(&self, at: &Placement<T>) -> Self;

    /// Its surface, for pictures.
    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>>;

    /// What a sphere can touch in one point at a time: the shape itself, or
    /// what it falls apart into.
    fn features(&self) -> Vec<Feature<T>>;

    /// How many features there are.
    fn count(&self) -> usize {
        self.features().len()
    }

    /// The corners of the box around the solid; `None` for one without end.
    fn extent(&self) -> Option<Bounds<T>> {
        let bounds = self.features().into_iter().map(|feature| feature.bounds());
        let bounds: Option<Vec<_>> = bounds.collect();
        bounds?.into_iter().reduce(joined)
    }

    /// Of many triangles: the mesh that they are of, which has its own way to find them.
    fn mesh(&self) -> Option<&Mesh<T>> {
        None
    }

    /// Whether spheres are inside.
    fn is_container(&self) -> bool {
        self.interior().is_some()
    }

    /// The area of its surface, of what is thin on both sides, length²; `None` without end.
    fn area(&self) -> Option<T> {
        None
    }

    /// Whether it has no inside: what jumps into it comes out on its other side.
    fn is_thin(&self) -> bool {
        false
    }

    /// Its surface by its sides, if it has two distinct ones.
    fn gate(&self) -> Option<Gate<T>> {
        None
    }

    /// The corners of the box around the hollow, if spheres are inside of one that ends.
    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        None
    }

    /// The corners of a box that fits into the hollow, for a lattice of spheres
    /// to fill.
    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        self.interior()
    }
}

/// A kind of shape, as a reader of scene files needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeKind {
    /// As [`Solid::NAME`].
    pub(crate) name: &'static str,
    /// As [`Solid::OTHER_NAME`].
    pub(crate) other_name: Option<&'static str>,
    /// As [`Solid::KEYS`].
    pub(crate) keys: &'static [Key],
    /// As [`Solid::read`].
    pub(crate) read: fn(&ShapeEntry) -> Result<super::Shape<f64>, Mistake>,
}

impl ShapeKind {
    /// All its names in scene files.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        core::iter::once(self.name).chain(self.other_name)
    }
}

/// Makes of two lists, of solids and of what spheres touch of them, each by its module and
/// type, the enums and all that chooses between them.
macro_rules! solids {
    (
        shapes { $($(#[$doc:meta])* $module:ident::$solid:ident,)* }
        features { $($(#[$touched_doc:meta])* $touched:ident,)* }
    ) => {
        $(pub use $module::$solid;)*

        /// A fixed solid, as a scene names it.
        ///
        /// ```
        /// use carom::surroundings::{Cuboid, Shape};
        ///
        /// let container = Shape::from(Cuboid::container([0.0; 3], [2.0, 2.0, 4.0]));
        /// let [lower, upper] = container.interior().ok_or("a container has an inside")?;
        /// assert_eq!((upper - lower).to_array(), [2.0, 2.0, 4.0]);
        /// assert_eq!(container.features().len(), 6);
        /// # Ok::<(), &str>(())
        /// ```
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Shape<T> {
            $($(#[$doc])* $solid($solid<T>),)*
        }

        /// What a sphere can touch in one point at a time.
        ///
        /// ```
        /// use carom::surroundings::{Feature, FixedSphere};
        /// use carom::vec3::Vec3;
        ///
        /// let ball = Feature::from(FixedSphere::solid([0.0; 3], 2.0));
        /// let clearance = ball.clearance(Vec3::new(0.0, 0.0, 4.0), 0.5);
        /// assert_eq!(clearance.gap, 1.5);
        /// ```
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum Feature<T> {
            $($(#[$touched_doc])* $touched($touched<T>),)*
        }

        $(
            impl<T> From<$solid<T>> for Shape<T> {
                fn from(solid: $solid<T>) -> Self {
                    Self::$solid(solid)
                }
            }

        )*

        $(
            impl<T> From<$touched<T>> for Feature<T> {
                fn from(touched: $touched<T>) -> Self {
                    Self::$touched(touched)
                }
            }
        )*

        impl<T: Real> Shape<T> {
            /// The features that a sphere can touch, each in one point at a time:
            /// the six faces of a hollow box, the wall and the ends of a hollow
            /// cylinder or cone, those of a [`Revolved`], one of most shapes.
            ///
            /// ```
            /// use carom::surroundings::{Plane, Shape};
            /// let floor = Shape::from(Plane::new([0.0; 3], [0.0, 0.0, 1.0]));
            /// assert_eq!(floor.features().len(), 1);
            /// ```
            #[must_use]
            pub fn features(&self) -> Vec<Feature<T>> {
                match self {
                    $(Self::$solid(solid) => solid.features(),)*
                }
            }

            /// The box around the region that the shape encloses as a container,
            /// `lower` and `upper` corner, length; `None` for a shape that spheres
            /// stay outside of, and for one without end.
            ///
            /// ```
            /// use carom::surroundings::{FixedSphere, Shape};
            /// let hollow = Shape::from(FixedSphere::container([1.0, 0.0, 0.0], 2.0));
            /// let corners = hollow.interior().map(|corners| corners.map(|c| c.to_array()));
            /// assert_eq!(corners, Some([[-1.0, -2.0, -2.0], [3.0, 2.0, 2.0]]));
            /// assert_eq!(Shape::from(FixedSphere::solid([0.0; 3], 2.0)).interior(), None);
            /// ```
            #[must_use]
            pub fn interior(&self) -> Option<[Vec3<T>; 2]> {
                match self {
                    $(Self::$solid(solid) => solid.interior(),)*
                }
            }

            /// The shape in another precision: every number becomes the nearest.
            ///
            /// ```
            /// use carom::surroundings::{FixedSphere, Shape};
            /// let ball = Shape::from(FixedSphere::solid([0.0_f64; 3], 0.1));
            /// assert_eq!(ball.cast::<f32>(), FixedSphere::solid([0.0; 3], 0.1).into());
            /// ```
            #[must_use]
            pub fn cast<B: Real>(&self) -> Shape<B> {
                match self {
                    $(Self::$solid(solid) => Shape::$solid(solid.cast()),)*
                }
            }

            /// The area of its surface, length²: of what is thin on both sides, of a container
            /// on its inside. `None` for a shape without end.
            ///
            /// ```
            /// use carom::surroundings::{Cuboid, Plane, Shape};
            /// let brick = Shape::from(Cuboid::solid([0.0; 3], [1.0, 2.0, 3.0]));
            /// assert_eq!(brick.area(), Some(22.0));
            /// assert_eq!(Shape::from(Plane::new([0.0; 3], [0.0, 0.0, 1.0])).area(), None);
            /// ```
            #[must_use]
            pub fn area(&self) -> Option<T> {
                match self {
                    $(Self::$solid(solid) => solid.area(),)*
                }
            }

            /// As [`Solid::triangles`].
            pub(super) fn skin(&self, detail: &Detail<T>) -> Vec<skin::Corners<T>> {
                match self {
                    $(Self::$solid(solid) => Solid::triangles(solid, detail),)*
                }
            }

            /// As [`Solid::points`].
            pub(crate) fn points(&self) -> Vec<Vec3<T>> {
                match self {
                    $(Self::$solid(solid) => solid.points(),)*
                }
            }

            /// As [`Solid::placed`].
            pub(crate) fn placed(&self, at: &Placement<T>) -> Self {
                match self {
                    $(Self::$solid(solid) => Self::$solid(solid.placed(at)),)*
                }
            }

            /// As [`Solid::count`].
            pub(crate) fn count(&self) -> usize {
                match self {
                    $(Self::$solid(solid) => Solid::count(solid),)*
                }
            }

            /// The corners of the box around the solid, length; `None` without end.
            ///
            /// ```
            /// use carom::surroundings::{FixedSphere, Shape};
            /// let ball = Shape::from(FixedSphere::solid([1.0, 0.0, 0.0], 2.0));
            /// assert_eq!(ball.bounds().map(|[lower, _]| lower.x), Some(-1.0));
            /// ```
            #[must_use]
            pub fn bounds(&self) -> Option<[Vec3<T>; 2]> {
                match self {
                    $(Self::$solid(solid) => solid.extent(),)*
                }
            }

            /// The mesh that the shape is, or is made of.
            ///
            /// ```
            /// use carom::surroundings::{Heightfield, Shape};
            /// let field = Shape::from(Heightfield::new([0.0; 3], [1.0; 2], 2, &[0.0; 4])?);
            /// assert_eq!(field.mesh().map(|mesh| mesh.triangles().len()), Some(2));
            /// # Ok::<(), carom::surroundings::MeshError>(())
            /// ```
            #[must_use]
            pub fn mesh(&self) -> Option<&Mesh<T>> {
                match self {
                    $(Self::$solid(solid) => Solid::mesh(solid),)*
                }
            }

            /// As [`Solid::is_container`].
            pub(crate) fn is_container(&self) -> bool {
                match self {
                    $(Self::$solid(solid) => solid.is_container(),)*
                }
            }

            /// Whether it is touched from both sides and has no inside.
            ///
            /// ```
            /// use carom::surroundings::{Disc, Plane, Shape};
            /// assert!(Shape::from(Disc::new([0.0; 3], [0.0, 0.0, 1.0], 3.0, 1.0)).is_thin());
            /// assert!(!Shape::from(Plane::new([0.0; 3], [0.0, 0.0, 1.0])).is_thin());
            /// ```
            #[must_use]
            pub fn is_thin(&self) -> bool {
                match self {
                    $(Self::$solid(solid) => solid.is_thin(),)*
                }
            }

            /// As [`Solid::gate`].
            pub(super) fn gate(&self) -> Option<Gate<T>> {
                match self {
                    $(Self::$solid(solid) => solid.gate(),)*
                }
            }

            /// As [`Solid::inscribed`].
            pub(crate) fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
                match self {
                    $(Self::$solid(solid) => solid.inscribed(),)*
                }
            }

            /// As [`Solid::check`].
            pub(crate) fn check(&self) -> Result<(), Mistake> {
                match self {
                    $(Self::$solid(solid) => solid.check(),)*
                }
            }

            /// As [`Solid::NAME`].
            pub(crate) fn name(&self) -> &'static str {
                match self {
                    $(Self::$solid(_) => <$solid<T> as Solid<T>>::NAME,)*
                }
            }
        }

        impl<T: Real> Obstacle<T> for Feature<T> {
            #[inline(always)]
            fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
                match self {
                    $(Self::$touched(touched) => touched.clearance(center, radius),)*
                }
            }

            fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
                match self {
                    $(Self::$touched(touched) => touched.contact_time(flight),)*
                }
            }

            fn bounds(&self) -> Option<[Vec3<T>; 2]> {
                match self {
                    $(Self::$touched(touched) => touched.bounds(),)*
                }
            }

            fn farthest(&self) -> f64 {
                match self {
                    $(Self::$touched(touched) => touched.farthest(),)*
                }
            }

            fn is_hollow(&self) -> bool {
                match self {
                    $(Self::$touched(touched) => Obstacle::is_hollow(touched),)*
                }
            }

            fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
                match self {
                    $(Self::$touched(touched) => touched.hop(flight, wait),)*
                }
            }
        }

        /// All kinds of shape, in the order of the list.
        const ALL_KINDS: &[ShapeKind] = &[$(ShapeKind {
            name: <$solid<f64> as Solid<f64>>::NAME,
            other_name: <$solid<f64> as Solid<f64>>::OTHER_NAME,
            keys: <$solid<f64> as Solid<f64>>::KEYS,
            read: |entry| <$solid<f64> as Solid<f64>>::read(entry).map(Shape::$solid),
        },)*];
    };
}

pub(super) use solids;
