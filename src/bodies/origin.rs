//! Origin: what has put bodies where they are, and so how far a scene holds them against
//! overlaps.

use super::{Bodies, PerBody};
use crate::real::Real;

/// What has put bodies where they are. It is no part of what they are: bodies are equal
/// whatever it is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Origin {
    /// A person or a program.
    Described,
    /// The state of an earlier run, which may have been written to since.
    State,
    /// A world, with this fingerprint.
    World(u64),
}

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<T: Real> Bodies<T> {
    /// The same, as a world has left them.
    pub(crate) fn left_by_world(mut self) -> Self {
        self.origin = Origin::World(self.fingerprint());
        self
    }

    /// What has put them where they are; what a world has left and was written to
    /// since is a state.
    pub(crate) fn known_origin(&self) -> Origin {
        match self.origin {
            Origin::World(fingerprint) if fingerprint != self.fingerprint() => Origin::State,
            origin => origin,
        }
    }

    /// A number that is another one, as good as always, where centres or radii are.
    fn fingerprint(&self) -> u64 {
        /// FNV's, of 64 digits.
        const PRIME: u64 = 0x0100_0000_01b3;
        let radii = match &self.radius {
            PerBody::Same(radius) => core::slice::from_ref(radius),
            PerBody::Each(column) => column,
        };
        let columns = self.position.iter().map(|column| &**column).chain([radii]);
        columns.fold(self.len() as u64, |all, column| {
            // Four at a time, so that one multiplication need not wait for another.
            let mut sums = [all, 1, 2, 3];
            for four in column.chunks(sums.len()) {
                for (sum, value) in sums.iter_mut().zip(four) {
                    *sum = (*sum ^ value.to_f64().to_bits()).wrapping_mul(PRIME);
                }
            }
            sums.into_iter().fold(0, |all, sum| (all ^ sum).wrapping_mul(PRIME).rotate_left(29))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_to_is_no_longer_as_the_world_left_it() {
        let row: Vec<[f64; 3]> = (0..9).map(|k| [f64::from(k), 0.0, 1.0]).collect();
        let left = Bodies::from_positions(&row).radius(0.5).build().unwrap().left_by_world();
        assert!(matches!(left.known_origin(), Origin::World(_)));
        for (axis, body) in [(0, 0), (0, 8), (1, 3), (2, 7)] {
            let mut moved = left.clone();
            moved.position[axis][body] += 1e-12;
            assert!(matches!(moved.known_origin(), Origin::State), "{axis} {body}");
        }
        let mut swapped = left.clone();
        swapped.position[0].swap(2, 6);
        assert!(matches!(swapped.known_origin(), Origin::State));
        let mut grown = left.clone();
        grown.radius = PerBody::Same(0.75);
        assert!(matches!(grown.known_origin(), Origin::State));
        let mut faster = left.clone();
        faster.velocity[0].fill(1.0);
        assert!(matches!(faster.known_origin(), Origin::World(_)));
    }
}
