//! Species: bodies that are alike.

use std::collections::HashMap;

use crate::bodies::{Bodies, PerBody};
use crate::numbers::array::Each;
use crate::real::Real;

/// The most species that have numbers of their own; where there are more, all are one.
const MOST: usize = 64;

/// The species of each body, from 1 in the order in which they appear: those of one have
/// one radius and one mass. Where there are more than 64, all bodies are of one.
///
/// ```
/// use carom::Bodies;
/// use carom::observe::species;
/// let places = [[0.0; 3], [4.0, 0.0, 0.0], [8.0, 0.0, 0.0]];
/// let bodies = Bodies::from_positions(&places).radii(&[1.0, 0.5, 1.0]).build()?;
/// assert_eq!(species(&bodies), [1, 2, 1]);
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[must_use]
pub fn species<T: Real>(bodies: &Bodies<T>) -> Vec<u32> {
    if let (PerBody::Same(_), PerBody::Same(_)) = (&bodies.radius, &bodies.mass) {
        return vec![1; bodies.len()];
    }
    let mut known: HashMap<[u64; 2], u32> = HashMap::new();
    let mut species = Vec::with_capacity(bodies.len());
    for index in 0..bodies.len() {
        let figures = [bodies.radius.of(index), bodies.mass.of(index)];
        let next = known.len() as u32 + 1;
        species
            .push(*known.entry(figures.each(|figure| figure.to_f64().to_bits())).or_insert(next));
        if known.len() > MOST {
            return vec![1; bodies.len()];
        }
    }
    species
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn species_are_counted_as_they_appear() {
        let positions: Vec<[f64; 3]> = (0..100).map(|k| [3.0 * f64::from(k), 0.0, 0.0]).collect();
        let radii: Vec<f64> = (0..100).map(|k| [1.0, 0.5, 1.0][k % 3]).collect();
        let few = Bodies::from_positions(&positions).radii(&radii).build().unwrap();
        assert_eq!(species(&few)[..4], [1, 2, 1, 1]);
        let radii: Vec<f64> = (0..100).map(|k| 1.0 - 0.001 * f64::from(k)).collect();
        let many = Bodies::from_positions(&positions).radii(&radii).build().unwrap();
        assert_eq!(species(&many), vec![1; 100]);
    }
}
