//! Filter: which collisions of a run are written.

use core::ops::RangeInclusive;

use crate::engine::{Event, Partner};
use crate::real::Real;

/// Which collisions are wanted: those from a time on, of some bodies, and of these every
/// nth.
///
/// ```
/// use carom::output::EventFilter;
/// use carom::{Cuboid, EventDriven, Scene, Sphere};
///
/// let scene = Scene::<f64>::builder()
///     .surroundings(Cuboid::container([0.0; 3], [2.0; 3]))
///     .sphere(Sphere::new([1.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
///     .build()?;
/// // It hits a wall at 0.5, 1.5, …; of those from 1 on each third.
/// let mut filter = EventFilter::new().from(1.0).every(3);
/// let mut times = Vec::new();
/// EventDriven::new(scene)?.for_each_event(8.0, |event| {
///     if filter.takes(event) {
///         times.push(event.time);
///     }
/// })?;
/// assert_eq!(times, [1.5, 4.5, 7.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EventFilter {
    from: Option<f64>,
    every: Option<u64>,
    bodies: Vec<RangeInclusive<u32>>,
    /// How many were wanted but for `every`.
    passed: u64,
}

impl EventFilter {
    /// All collisions.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Those at this time since the start or later.
    #[must_use]
    pub fn from(self, time: f64) -> Self {
        Self { from: Some(time), ..self }
    }

    /// Of all others that are wanted the first, and then every `every`th; 0 is as 1.
    #[must_use]
    pub fn every(self, every: u64) -> Self {
        Self { every: Some(every.max(1)), ..self }
    }

    /// Those in which a body of one of these ranges takes part; without ranges, of all.
    #[must_use]
    pub fn of(self, bodies: Vec<RangeInclusive<u32>>) -> Self {
        Self { bodies, ..self }
    }

    /// How many collisions were wanted so far, those that `every` leaves out counted.
    #[must_use]
    pub fn passed(&self) -> u64 {
        self.passed
    }

    /// The same after `passed` wanted ones.
    #[must_use]
    pub fn after(self, passed: u64) -> Self {
        Self { passed, ..self }
    }

    /// Whether the next collision of the run is wanted; each is to be asked about once.
    pub fn takes<T: Real>(&mut self, event: &Event<T>) -> bool {
        if self.from.is_some_and(|from| event.time < from) {
            return false;
        }
        let is_of = |body: u32| self.bodies.iter().any(|range| range.contains(&body));
        let is_other_of = || match event.partner {
            Partner::Body { index, .. } => is_of(index),
            Partner::Surroundings(_) => false,
        };
        if !self.bodies.is_empty() && !is_of(event.a) && !is_other_of() {
            return false;
        }
        let number = self.passed;
        self.passed += 1;
        number.is_multiple_of(self.every.unwrap_or(1))
    }
}
