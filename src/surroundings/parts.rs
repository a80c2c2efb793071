//! Parts: features as a search for what is near them sees them.

use super::Feature;
use crate::lane::Lane;
use crate::real::Real;
use crate::space::{Bounds, FixedParts};
use crate::vec3::Vec3;

impl<T: Real> FixedParts<T> for [Feature<T>] {
    fn count(&self) -> usize {
        self.len()
    }

    fn bounds(&self, part: usize) -> Option<Bounds<T>> {
        self[part].bounds()
    }

    #[inline(always)]
    fn gap<L: Lane<Scalar = T>>(&self, part: usize, center: Vec3<L>, radius: L) -> L {
        self[part].clearance(center, radius).gap
    }
}
