//! State hash: one number for all bits of a state.

use core::fmt;

use serde::{Serialize, Serializer};
use xxhash_rust::xxh3::Xxh3Default;

use crate::bodies::Bodies;
use crate::real::Real;

/// A 64-bit hash of the bits of a state. It is written as `0x` and sixteen
/// hexadecimal digits, in JSON too: JSON readers lose the digits of a whole
/// number past 2⁵³.
///
/// ```
/// use carom::observe::StateHash;
/// assert_eq!(StateHash(0xab).to_string(), "0x00000000000000ab");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StateHash(pub u64);

impl fmt::Display for StateHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#018x}", self.0)
    }
}

impl Serialize for StateHash {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// XXH3-64 (seed 0) of the bodies' bytes.
///
/// The bytes are those of each body in the order of the scene file: centre
/// `x y z`, velocity, angular velocity, then the orientation's nine elements row
/// by row, each number as [`Real::write_bits`] gives it (`f32` and `f64`: little
/// endian). Orientations that are not stored count as the identity that they are.
/// Radii and masses do not count: they never change. The two zeros are
/// different bits.
///
/// ```
/// use carom::{Bodies, state_hash};
/// let at = |x: f64| Bodies::from_positions(&[[x, 0.0, 0.0]]).radius(0.5).build();
/// assert_eq!(state_hash(&at(1.0)?), state_hash(&at(1.0)?));
/// assert_ne!(state_hash(&at(0.0)?), state_hash(&at(-0.0)?));
/// assert_eq!(state_hash(&at(1.0)?).to_string().len(), 18);
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[must_use]
pub fn state_hash<T: Real>(bodies: &Bodies<T>) -> StateHash {
    const BODIES_AT_ONCE: usize = 256;
    let mut hasher = Xxh3Default::new();
    let mut bytes = Vec::new();
    for index in 0..bodies.len() {
        let vectors = [bodies.position_of(index), bodies.velocity_of(index), bodies.spin_of(index)];
        for value in vectors.into_iter().flat_map(|vector| vector.to_array()) {
            value.write_bits(&mut bytes);
        }
        for value in bodies.orientation_of(index).rows() {
            value.write_bits(&mut bytes);
        }
        if index % BODIES_AT_ONCE == BODIES_AT_ONCE - 1 {
            hasher.update(&bytes);
            bytes.clear();
        }
    }
    hasher.update(&bytes);
    StateHash(hasher.digest())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::{Origin, PerBody};
    use crate::column::Column;

    fn row(len: usize) -> Bodies<f32> {
        let columns = |scale: f32| {
            [1.0, 2.0, 3.0].map(|component: f32| {
                Column::from_values((0..len).map(|k| scale * component + k as f32), 0.0)
            })
        };
        Bodies {
            origin: Origin::Described,
            position: columns(1.0),
            velocity: columns(0.25),
            spin: columns(0.125),
            orientation: None,
            radius: PerBody::Same(0.5),
            mass: PerBody::Same(1.0),
            inertia: PerBody::Same(0.1),
        }
    }

    #[test]
    fn the_identity_counts_as_its_nine_numbers() {
        let mut bodies = row(300);
        let unsaid = state_hash(&bodies);
        bodies.orientation = Some(Box::new(core::array::from_fn(|k| {
            Column::new(300, if k % 4 == 0 { 1.0 } else { 0.0 })
        })));
        assert_eq!(state_hash(&bodies), unsaid);
    }

    #[test]
    fn it_is_the_hash_of_the_documented_bytes() {
        let bodies = row(2);
        let numbers = [
            [1.0, 2.0, 3.0, 0.25, 0.5, 0.75, 0.125, 0.25, 0.375],
            [2.0, 3.0, 4.0, 1.25, 1.5, 1.75, 1.125, 1.25, 1.375],
        ];
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let bytes: Vec<u8> = numbers
            .iter()
            .flat_map(|body| body.iter().chain(&identity))
            .flat_map(|number: &f32| number.to_le_bytes())
            .collect();
        assert_eq!(state_hash(&bodies).0, xxhash_rust::xxh3::xxh3_64(&bytes));
    }

    #[test]
    fn every_bit_counts() {
        let hashes = [0_usize, 1, 255, 299].map(|changed| {
            let mut bodies = row(300);
            bodies.spin[2][changed] = f32::from_bits(bodies.spin[2][changed].to_bits() ^ 1);
            state_hash(&bodies)
        });
        for (index, hash) in hashes.iter().enumerate() {
            assert_ne!(*hash, state_hash(&row(300)));
            assert!(!hashes[..index].contains(hash));
        }
        assert_eq!(StateHash(0xab).to_string(), "0x00000000000000ab");
    }
}
