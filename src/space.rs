//! Space: open or periodic, and what is near what in it.
//!
//! ```
//! use carom::motion::flight::Wrap;
//! use carom::space::{Bounds, FixedParts, OpenSpace, PeriodicBox, Space, Tree};
//! use carom::surroundings::{Feature, FixedSphere};
//! use carom::Vec3;
//!
//! // A periodic box measures differences to the nearest image, open space as they are.
//! let space = PeriodicBox::new([0.0; 3], [10.0, 10.0, 4.0]);
//! let far = Vec3::new(9.0, 0.0, 1.0);
//! assert_eq!(space.sides().to_array(), [10.0, 10.0, 4.0]);
//! assert_eq!(space.wrap(Vec3::new(12.0, 5.0, 1.0)).x, 2.0);
//! assert_eq!(space.nearest(far).to_array(), [-1.0, 0.0, 1.0]);
//! assert_eq!(space.shift(space.turns(far)).to_array(), [10.0, 0.0, 0.0]);
//! assert_eq!((space.images().len(), OpenSpace.nearest(far)), (27, far));
//!
//! // What is fixed, and a tree that finds the part near a place.
//! let balls = [0.0, 3.0].map(|x| Feature::from(FixedSphere::solid([x, 0.0, 0.0], 1.0)));
//! let parts: &[Feature<f64>] = &balls;
//! assert_eq!((parts.count(), parts.gap(1, Vec3::new(6.0, 0.0, 0.0), 0.5)), (2, 1.5));
//! let tree = Tree::new((0..parts.count()).map(|part| FixedParts::bounds(parts, part)));
//! let around: Bounds<f64> = [Vec3::new(2.5, 0.0, 0.0), Vec3::new(6.0, 1.0, 1.0)];
//! let mut near = Vec::new();
//! tree.for_each(around, |part| near.push(part));
//! assert_eq!((near, tree.any(around, |part| part == 0)), (vec![1], false));
//! assert_eq!((tree.len(), tree.is_empty()), (2, false));
//! ```

pub(crate) mod broadphase;
pub(crate) mod cells;
pub(crate) mod curve;
pub(crate) mod hierarchy;
pub(crate) mod levels;
mod near_pairs;
pub(crate) mod neighbours;
#[cfg(test)]
mod noise;
mod parts;
mod periodic;
pub(crate) mod pieces;
pub(crate) mod rows;
pub(crate) mod shadow;
mod sizes;
mod sphere_tree;
#[cfg(test)]
mod test_boxes;
mod tree;

pub(crate) use near_pairs::for_each_near_pair;
pub use near_pairs::near_pairs;
pub use parts::FixedParts;
pub use periodic::{OpenSpace, PeriodicBox, Space};
pub use sphere_tree::{RayHit, SphereTree};
pub(crate) use sphere_tree::{along_boxes, unit};
pub use tree::{Bounds, Tree};
pub(crate) use tree::{Ray, joined};
