//! Near pairs: the broad phase on its own, for programs with arrays of their own.

use super::broadphase::{BroadPhase, Candidates, Surveyed};
use super::{Bounds, FixedParts, PeriodicBox};
use crate::bodies::{Bodies, Columns3, PerBody};
use crate::column::Column;
use crate::lane::Lane;
use crate::motion::flight::Wrap;
use crate::numbers::array;
use crate::real::Real;
use crate::vec3::Vec3;
use crate::workers::Workers;

/// All pairs of spheres whose surfaces are nearer to each other than `gap`, length,
/// 0 or more: in open space, or to the nearest image in a periodic box whose sides
/// are at least twice a diameter and a gap. Each pair once, the lesser index first,
/// in ascending order.
///
/// Time and memory are linear in the spheres and the pairs, whatever the sizes and
/// distances.
///
/// ```
/// use carom::Bodies;
/// use carom::space::near_pairs;
///
/// // A program's own arrays.
/// let centers = [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [1.2, 0.0, 0.0]];
/// let bodies = Bodies::from_positions(&centers).radius(0.5).build()?;
/// assert_eq!(near_pairs(&bodies, None, 0.25), [[0, 2]]);
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[must_use]
pub fn near_pairs<T: Real>(
    bodies: &Bodies<T>,
    periodic: Option<PeriodicBox<T>>,
    gap: T,
) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for_each_near_pair(bodies, periodic, gap, |a, b| pairs.push([a.min(b), a.max(b)]));
    pairs.sort_unstable();
    pairs
}

/// Visits the same pairs in an order that depends on nothing but the bodies.
pub(crate) fn for_each_near_pair<T: Real>(
    bodies: &Bodies<T>,
    periodic: Option<PeriodicBox<T>>,
    gap: T,
    mut visit: impl FnMut(u32, u32),
) {
    let (len, skin) = (bodies.len(), gap.greater(T::ZERO));
    let workers = Workers::default();
    let center = |index: usize| {
        let center = bodies.position_of(index);
        periodic.map_or(center, |space| space.wrap(center))
    };
    let mut broad_phase = BroadPhase::new(&bodies.radius, len, &Nothing);
    let mut position = columns(len, center);
    let surveyed = Surveyed {
        position: &position,
        radius: &bodies.radius,
        periodic,
        parts: &Nothing,
        pairs: true,
    };
    let order = broad_phase.sort(&surveyed, skin, &workers).to_vec();
    position = columns(len, |slot| center(order[slot] as usize));
    let radius = match &bodies.radius {
        PerBody::Same(radius) => PerBody::Same(*radius),
        PerBody::Each(radii) => {
            let mut sorted = Column::new(len, T::ONE);
            for (radius, &index) in sorted.iter_mut().zip(&order) {
                *radius = radii[index as usize];
            }
            PerBody::Each(sorted)
        }
    };
    let surveyed =
        Surveyed { position: &position, radius: &radius, periodic, parts: &Nothing, pairs: true };
    let mut candidates = Candidates::default();
    broad_phase.search::<T::Pack8, _>(&surveyed, skin, &mut candidates, &workers);
    let found = candidates.chunks.iter().flat_map(|chunk| chunk.pairs.iter().flatten());
    for [a, b] in found {
        visit(order[*a as usize], order[*b as usize]);
    }
}

fn columns<T: Real>(len: usize, point: impl Fn(usize) -> Vec3<T>) -> Columns3<T> {
    let mut columns = array::from_fn(|_| Column::new(len, T::ZERO));
    for k in 0..len {
        for (column, value) in columns.iter_mut().zip(point(k).to_array()) {
            column[k] = value;
        }
    }
    columns
}

/// No fixed parts.
struct Nothing;

impl<T: Real> FixedParts<T> for Nothing {
    fn count(&self) -> usize {
        0
    }

    fn bounds(&self, _: usize) -> Option<Bounds<T>> {
        None
    }

    fn gap<L: Lane<Scalar = T>>(&self, _: usize, _: Vec3<L>, _: L) -> L {
        L::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Space;
    use crate::space::noise::noise;

    /// As a search of all pairs finds them, for equal and for very different sizes.
    fn agrees_with_all_pairs<T: Real>() {
        let mut noise = noise();
        for trial in 0..12 {
            let (len, side) = (300, 20.0);
            let centers: Vec<[T; 3]> =
                (0..len).map(|_| [(); 3].map(|()| T::from_f64(side * noise()))).collect();
            let radii: Vec<T> = (0..len)
                .map(|_| {
                    T::from_f64(if trial % 2 == 0 { 0.5 } else { 2.0 * noise().powi(4) + 0.01 })
                })
                .collect();
            let periodic =
                (trial % 3 == 0).then(|| PeriodicBox::new([T::ZERO; 3], [T::from_f64(side); 3]));
            let gap = T::from_f64(0.3 * f64::from(trial % 4));
            let bodies = Bodies::from_positions(&centers).radii(&radii).build().unwrap();
            let mut expected = Vec::new();
            for a in 0..len {
                for b in a + 1..len {
                    let offset = bodies.position_of(a) - bodies.position_of(b);
                    let offset = periodic.map_or(offset, |space| space.nearest(offset));
                    let reach = radii[a] + radii[b] + gap;
                    if offset.length_squared() < reach * reach {
                        expected.push([a as u32, b as u32]);
                    }
                }
            }
            assert!(!expected.is_empty());
            assert_eq!(near_pairs(&bodies, periodic, gap), expected, "trial {trial}");
        }
    }

    #[test]
    fn near_pairs_are_those_of_a_search_of_all() {
        agrees_with_all_pairs::<f32>();
        agrees_with_all_pairs::<f64>();
    }

    #[test]
    fn one_sphere_has_no_pair() {
        let bodies = Bodies::from_positions(&[[0.0_f64; 3]]).radius(1.0).build().unwrap();
        assert!(near_pairs(&bodies, None, 1.0).is_empty());
    }
}
