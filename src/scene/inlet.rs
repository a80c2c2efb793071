//! Inlet: a source of spheres, where and how often they come.

use super::spheres::{Make, Spread, make_setters};

/// Where the centres of spheres come in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Opening {
    At([f64; 3]),
    /// Anywhere in a box.
    Box([[f64; 3]; 2]),
    /// Anywhere in a disc: its centre, its axis, its radius.
    Disc([f64; 3], [f64; 3], f64),
}

/// A source of spheres: one comes after each interval of time, if there is room where it is to be.
///
/// One that finds no room waits, and is tried again whenever the next one is due, in another
/// place of the inlet; those that follow wait behind it.
///
/// ```
/// use carom::engine::World;
/// use carom::scene::Inlet;
/// use carom::{Execution, Scene};
///
/// let tap = Inlet::at([0.0; 3]).radius(0.5).velocity([0.0, 0.0, -2.0]).every(1.0);
/// let scene = Scene::<f64>::builder().inlet(tap).build()?;
/// let mut world = World::new(scene, Execution::default())?;
/// // At 0, 1, 2 and 3.
/// world.advance(3.5)?;
/// assert_eq!((world.bodies().len(), world.exchange().came.spheres), (4, 4));
/// assert_eq!(world.bodies().position_of(0).z, -7.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Inlet {
    pub(super) opening: Opening,
    pub(super) make: Make,
    pub(super) temperature: f64,
    pub(super) spin_temperature: f64,
    /// Without it, `every` is to be said.
    pub(super) every: Option<f64>,
    pub(super) count: Option<u64>,
    pub(super) from: f64,
    pub(super) seed: Option<u64>,
}

impl Inlet {
    fn new(opening: Opening) -> Self {
        Self {
            opening,
            make: Make::default(),
            temperature: 0.0,
            spin_temperature: 0.0,
            every: None,
            count: None,
            from: 0.0,
            seed: None,
        }
    }

    /// One whose spheres come with their centres at a point, length. How often, and their
    /// radius, have to be set.
    #[must_use]
    pub fn at(position: [f64; 3]) -> Self {
        Self::new(Opening::At(position))
    }

    /// One whose spheres come with their centres anywhere in a box, length, which may be flat.
    ///
    /// ```
    /// use carom::Scene;
    /// use carom::scene::Inlet;
    ///
    /// let slit = Inlet::within([0.0; 3], [9.0, 1.0, 0.0]).radius(0.1..=0.2).every(0.5);
    /// let slit = slit.from(1.0).count(100).temperature(0.1).spin_temperature(0.1).seed(7);
    /// assert_eq!(Scene::<f64>::builder().inlet(slit).build()?.inlets.len(), 1);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn within(lower: [f64; 3], upper: [f64; 3]) -> Self {
        Self::new(Opening::Box([lower, upper]))
    }

    /// One whose spheres come with their centres anywhere in a disc about a centre, length,
    /// across an axis of any length but 0, up to a distance, length.
    #[must_use]
    pub fn disc(center: [f64; 3], axis: [f64; 3], reach: f64) -> Self {
        Self::new(Opening::Disc(center, axis, reach))
    }

    /// The time from one sphere to the next.
    #[must_use]
    pub fn every(mut self, time: f64) -> Self {
        self.every = Some(time);
        self
    }

    /// How many come at most; without end by default.
    #[must_use]
    pub fn count(mut self, count: u64) -> Self {
        self.count = Some(count);
        self
    }

    /// When the first one comes; at time 0 by default.
    #[must_use]
    pub fn from(mut self, time: f64) -> Self {
        self.from = time;
        self
    }

    /// `kT` of their velocities, energy: each component is normal with variance kT/m.
    #[must_use]
    pub fn temperature(mut self, temperature: f64) -> Self {
        self.temperature = temperature;
        self
    }

    /// The same of their angular velocities, with variance kT/I.
    #[must_use]
    pub fn spin_temperature(mut self, temperature: f64) -> Self {
        self.spin_temperature = temperature;
        self
    }

    /// A seed of its own for its random numbers, in place of the scene's.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = Some(seed);
        self
    }

    make_setters!();

    /// The time at which its sphere of a number, from 0, is due.
    pub(crate) fn time(&self, number: u64) -> f64 {
        self.from + self.every.unwrap_or(f64::INFINITY) * number as f64
    }

    /// How many are due up to a time, that included, if it was `before` until then.
    pub(crate) fn due(&self, before: u64, time: f64) -> u64 {
        let passed = ((time - self.from) / self.every.unwrap_or(f64::INFINITY)).floor();
        let mut due = before.max(passed as u64);
        // By one, for the rounding of the quotient.
        while self.time(due) <= time {
            due += 1;
        }
        due
    }

    /// How many come at most.
    pub(crate) fn most(&self) -> u64 {
        self.count.unwrap_or(u64::MAX)
    }
}
