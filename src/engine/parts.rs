//! Parts: which parts of the surroundings are counted apart, and what they come to.

use super::account::PartSum;
use crate::numbers::array;
use crate::real::Real;
use crate::scene::Scene;
use crate::surroundings::Passages;

/// Parts without a name are counted apart in scenes of at most this many parts: of more, each
/// would have its sums far from the others' in memory.
const MOST_UNNAMED: usize = 64;

/// The counter of a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counter {
    pub index: usize,
    /// Whether its part has a name.
    pub is_named: bool,
    /// Whether spheres that touch it are removed.
    pub removes: bool,
}

/// The counters of parts.
#[derive(Clone, Debug)]
pub(super) struct Counted {
    /// By part.
    counters: Vec<Option<Counter>>,
    /// By counter: the part, and the area of its surface, length².
    parts: Vec<(u32, Option<f64>)>,
}

impl Counted {
    /// Of a scene: parts with a name, those that count or remove, and all parts if they are few.
    pub fn of<T: Real>(scene: &Scene<T>) -> Self {
        let len = scene.surroundings.len();
        let (mut counters, mut parts) = (Vec::with_capacity(len), Vec::new());
        for (part, shape) in (0..).zip(&scene.surroundings) {
            let is_named = scene.part_names.get(counters.len()).is_some_and(Option::is_some);
            let removes = scene.removes.get(counters.len()).is_some_and(|removes| *removes);
            let is_counted = is_named || removes || shape.is_sensor() || len <= MOST_UNNAMED;
            let index = parts.len();
            counters.push(is_counted.then_some(Counter { index, is_named, removes }));
            if is_counted {
                parts.push((part, shape.area().map(T::to_f64)));
            }
        }
        Self { counters, parts }
    }

    /// The counter of a part, if it has one.
    #[inline(always)]
    pub fn counter(&self, part: u32) -> Option<Counter> {
        self.counters[part as usize]
    }

    /// What the sums of the counters say of their parts.
    pub fn totals(&self, sums: &[PartSum]) -> Vec<PartTotals> {
        let none = PartSum::default();
        let totals = |(counter, &(part, area)): (usize, &(u32, Option<f64>))| {
            let sum = sums.get(counter).unwrap_or(&none);
            PartTotals { area, ..sum.totals(part) }
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
    /// The sum of the magnitudes of their normal components, of a part with a name; otherwise
    /// 0.
    pub normal_impulse: f64,
    /// The area of its surface, length², of both sides of what is thin; `None` without end.
    pub area: Option<f64>,
    /// How many spheres it has taken out.
    pub removed: u64,
    /// How often centres have passed through it, of a [sensor](crate::surroundings::Sensor).
    pub passages: Option<Passages>,
}

impl PartTotals {
    /// The same after what was before.
    pub(super) fn after(&self, before: &Self) -> Self {
        Self {
            part: self.part,
            collisions: self.collisions + before.collisions,
            impulse: array::from_fn(|axis| before.impulse[axis] + self.impulse[axis]),
            normal_impulse: before.normal_impulse + self.normal_impulse,
            area: self.area,
            removed: self.removed + before.removed,
            passages: self.passages.map(|mut passages| {
                passages += before.passages.unwrap_or_default();
                passages
            }),
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
            impulse: array::from_fn(|axis| self.impulse[axis] - earlier.impulse[axis]),
            normal_impulse: self.normal_impulse - earlier.normal_impulse,
            area: self.area,
            removed: self.removed - earlier.removed,
            passages: self
                .passages
                .map(|passages| passages.since(earlier.passages.unwrap_or_default())),
        }
    }
}
