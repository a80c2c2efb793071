//! Parts: which parts of the surroundings are counted apart, and what they come to.

use super::account::PartSum;
use crate::real::Real;
use crate::scene::Scene;

/// Parts without a name are counted apart in scenes of so many parts at most: of more, each
/// would have its sums far from the others' in memory.
const MOST_UNNAMED: usize = 64;

/// No counter.
const NONE: u32 = u32::MAX;

/// The counters of parts.
#[derive(Clone, Debug)]
pub(super) struct Counted {
    /// By part.
    counters: Vec<u32>,
    /// By counter.
    parts: Vec<u32>,
}

impl Counted {
    /// Of a scene: parts with a name, and all parts if they are few.
    pub fn of<T: Real>(scene: &Scene<T>) -> Self {
        let len = scene.surroundings.len();
        let is_named = |part: usize| scene.part_names.get(part).is_some_and(Option::is_some);
        let is_counted = |part: &u32| len <= MOST_UNNAMED || is_named(*part as usize);
        let parts: Vec<u32> = (0..len as u32).filter(is_counted).collect();
        let mut counters = vec![NONE; len];
        for (counter, part) in (0..).zip(&parts) {
            counters[*part as usize] = counter;
        }
        Self { counters, parts }
    }

    /// The counter of a part, if it has one.
    #[inline(always)]
    pub fn counter(&self, part: u32) -> Option<usize> {
        let counter = self.counters[part as usize];
        (counter != NONE).then_some(counter as usize)
    }

    /// What the sums of the counters say of their parts.
    pub fn totals(&self, sums: &[PartSum]) -> Vec<PartTotals> {
        let totals = |(counter, part): (usize, &u32)| match sums.get(counter) {
            Some(sum) => sum.totals(*part),
            None => PartTotals { part: *part, ..PartTotals::default() },
        };
        self.parts.iter().enumerate().map(totals).collect()
    }
}

/// What the collisions with one part of the surroundings have added up to.
///
/// ```
/// use carom::{EventDriven, Plane, Scene, Sphere};
///
/// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
/// let floor = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
/// let scene = Scene::<f64>::builder().named_surroundings("floor", floor).sphere(ball).build()?;
/// let mut world = EventDriven::new(scene)?;
/// world.advance(1.0)?;
/// let [floor] = world.parts()[..] else { return Ok(()) };
/// assert_eq!((floor.part, floor.collisions, floor.impulse), (0, 1, [0.0, 0.0, 2.0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct PartTotals {
    /// Its index in the scene.
    pub part: u32,
    /// How many there were.
    pub collisions: u64,
    /// The sum of its impulses on the bodies, mass × length per time.
    pub impulse: [f64; 3],
}

impl PartTotals {
    /// The same after what was before.
    pub(super) fn after(&self, before: &Self) -> Self {
        Self {
            part: self.part,
            collisions: self.collisions + before.collisions,
            impulse: core::array::from_fn(|axis| before.impulse[axis] + self.impulse[axis]),
        }
    }

    /// What has come since an earlier time.
    ///
    /// ```
    /// use carom::engine::PartTotals;
    /// let none = PartTotals::default();
    /// assert_eq!(none.since(&none), none);
    /// ```
    #[must_use]
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            part: self.part,
            collisions: self.collisions - earlier.collisions,
            impulse: core::array::from_fn(|axis| self.impulse[axis] - earlier.impulse[axis]),
        }
    }
}
