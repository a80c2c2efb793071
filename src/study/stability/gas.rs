//! What a gas keeps over many collisions.

use super::case::{Studied, greatest, in_epsilon};
use super::{Figure, StudyError};
use crate::bodies::Bodies;
use crate::engine::EventDriven;
use crate::observe::{Energy, Momentum, total_mass};
use crate::scene::Scene;
use crate::space::{PeriodicBox, Space};
use crate::study::invariants::energy_change;
use crate::surroundings::Feature;
use crate::vec3::Vec3;

/// How far a gas is from what it should keep.
pub(super) struct Kept {
    /// Change of the energy, in what a random walk is good for: √n ε of the
    /// energy of one of N bodies.
    pub energy: f64,
    /// The same of the momentum, over `√(2 M E)`.
    pub momentum: f64,
    /// The deepest overlap that was seen, in [roundings](rounding) of a place.
    pub overlap: f64,
}

impl Kept {
    /// The energy, judged by what it may walk by; `name` says of what a figure is.
    pub fn energy<T: Studied>(&self, name: impl Fn(&str) -> String) -> Figure {
        Figure::at_most(T::PRECISION, name("energy"), self.energy, WALK, "√n ε")
    }

    /// The same of the momentum.
    pub fn momentum<T: Studied>(&self, name: impl Fn(&str) -> String) -> Figure {
        Figure::at_most(T::PRECISION, name("momentum"), self.momentum, WALK, "√n ε")
    }

    /// The overlap, judged.
    pub fn overlap<T: Studied>(&self, name: impl Fn(&str) -> String) -> Figure {
        Figure::at_most(T::PRECISION, name("overlap"), self.overlap, 4.0, "δ")
    }
}

/// What a place in a box that reaches to `extent` is uncertain by: its own
/// rounding, and the way that a fast body goes in what the time is rounded by,
/// which is an `f64` in both precisions. For a temperature and masses of 1.
pub(super) fn rounding<T: Studied>(extent: f64, time: f64) -> f64 {
    T::EPSILON.to_f64() * extent + f64::EPSILON * time * FAST
}

/// Of the fastest bodies.
const FAST: f64 = 4.0;

/// What the energy of a gas may walk by, √n ε of the energy of one of N bodies:
/// it is 2 to 4, root mean square, for a fluid of equal spheres.
pub(super) const WALK: f64 = 12.0;

/// Whether the sum of 1 and this part rounds to one side again and again, in
/// whatever units: the part is some roundings of the sum, or less than one. Where
/// it is less than a thousandth of one, what it leaves out no longer matters.
pub(super) fn rounds_alike<T: Studied>(part: f64) -> bool {
    (1e-3..1e3).contains(&(part / T::EPSILON.to_f64()))
}

/// How often overlaps are looked for.
const LOOKS: u64 = 16;

/// Runs a gas in no field for a number of collisions. No coordinate is above
/// `extent`.
pub(super) fn run<T: Studied>(
    scene: Scene<T>,
    collisions: u64,
    extent: f64,
) -> Result<Kept, StudyError> {
    let features: Vec<Feature<T>> =
        scene.surroundings.iter().flat_map(|shape| shape.features()).collect();
    let (start, periodic) = (scene.bodies.clone(), scene.periodic);
    let mut world = EventDriven::new(scene)?;
    let mut deepest: f64 = 0.0;
    for _ in 0..LOOKS {
        // Just after a collision: two are in contact.
        world.advance_until(collisions / LOOKS, 1e12)?;
        let nearest = |offset| periodic.map_or(offset, |space| space.nearest(offset));
        let overlap = overlap(&world.bodies(), &features, nearest);
        deepest = greatest([deepest, overlap / rounding::<T>(extent, world.time())]);
    }
    let end = world.bodies();
    let walk = (world.collisions().total() as f64).sqrt() / start.len() as f64;
    let scale = (2.0 * total_mass(&start) * Energy::of(&start, Vec3::ZERO).kinetic()).sqrt();
    let gained = (Momentum::of(&end).0 - Momentum::of(&start).0).length();
    Ok(Kept {
        energy: in_epsilon::<T>(energy_change(&end, &start)).abs() / walk,
        momentum: in_epsilon::<T>(gained / scale) / walk,
        overlap: deepest,
    })
}

/// How far each body is from where it was, or from the nearest image of that,
/// length.
pub(super) fn distances<T: Studied>(
    now: &Bodies<T>,
    before: &Bodies<T>,
    space: Option<PeriodicBox<T>>,
) -> Vec<f64> {
    let distance = |k| {
        let offset = now.position_of(k) - before.position_of(k);
        space.map_or(offset, |space| space.nearest(offset)).cast::<f64>().length()
    };
    (0..now.len()).map(distance).collect()
}

/// The deepest overlap of two bodies, or of a body and something fixed.
pub(super) fn overlap<T: Studied>(
    bodies: &Bodies<T>,
    features: &[Feature<T>],
    nearest: impl Fn(Vec3<T>) -> Vec3<T>,
) -> f64 {
    let mut least = T::ZERO;
    for a in 0..bodies.len() {
        let (center, radius) = (bodies.position_of(a), bodies.radius.of(a));
        for feature in features {
            least = least.lesser(feature.clearance(center, radius).gap);
        }
        for b in 0..a {
            let offset = nearest(center - bodies.position_of(b));
            least = least.lesser(offset.length() - radius - bodies.radius.of(b));
        }
    }
    -least.to_f64()
}
