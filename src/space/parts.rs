//! Parts: what a search asks of things that are fixed in space.

use super::Bounds;
use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// Numbered things fixed in space, that spheres are near to or not.
pub trait FixedParts<T: Real>: Sync {
    /// How many there are.
    fn count(&self) -> usize;

    /// The corners of the box around a part; `None` for one without end.
    fn bounds(&self, part: usize) -> Option<Bounds<T>>;

    /// The distance between the surfaces of a part and of spheres with these
    /// centres and radii, length; negative where they overlap.
    fn gap<L: Lane<Scalar = T>>(&self, part: usize, center: Vec3<L>, radius: L) -> L;

    /// How many parts, the first ones, are to be put into a search's own tree; all of them
    /// unless there are some that [`for_each_near`](Self::for_each_near) finds.
    fn alone(&self) -> usize {
        self.count()
    }

    /// Visits the parts behind those whose boxes touch `bounds`, each with its box.
    fn for_each_near(&self, _bounds: Bounds<T>, _visit: impl FnMut(Bounds<T>, u32)) {}
}
