//! View: the scenes of a pack as slices.

use super::pack::Pack;
use crate::numbers::array::Each;
use crate::real::Real;

/// The scenes of a pack where they are in memory: the same body of all of them side by side.
/// See [`Batch::packs`](super::Batch::packs).
#[derive(Clone, Debug)]
pub struct PackView<'a, T: Real> {
    /// How many lanes there are.
    pub lanes: usize,
    /// The components of the centres, length: a body in a lane is element
    /// [`index`](PackView::index).
    pub position: [&'a [T]; 3],
    /// The components of the velocities, length per time.
    pub velocity: [&'a [T]; 3],
    pack: &'a Pack<T>,
}

impl<'a, T: Real> PackView<'a, T> {
    pub(super) fn of(pack: &'a Pack<T>) -> Self {
        Self {
            lanes: pack.moving.width,
            position: pack.position.refs().each(|column| &**column),
            velocity: pack.moving.velocity.refs().each(|column| &**column),
            pack,
        }
    }

    /// The element of a body in a lane.
    #[inline]
    #[must_use]
    pub fn index(&self, body: usize, lane: usize) -> usize {
        body * self.lanes + lane
    }

    /// The lanes with scenes, and the numbers of these.
    pub fn scenes(&self) -> impl Iterator<Item = (usize, usize)> {
        let seats = self.pack.moving.seats.iter().enumerate();
        seats.filter_map(|(lane, seat)| Some((lane, seat.scene?)))
    }
}
