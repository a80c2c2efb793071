//! Conclusion: the summary of a run that is at its end.

use carom::bodies::Bodies;
use carom::engine::{Collisions, World};
use carom::observe::{Temperature, Totals, not_finite, state_hash};
use carom::real::Real;
use carom::study::Course;
use carom::study::invariants::Invariants;

use super::analyses::Found;
use super::failure::Failure;
use super::measured::Measured;
use super::summary::{AllDigits, Setup, Summary, Work};

/// A run at its end.
pub struct Ended<'a, T: Real> {
    pub setup: Setup,
    pub world: &'a World<T>,
    /// Its bodies.
    pub bodies: &'a Bodies<T>,
    pub course: Course,
    /// What was conserved at the start, and the energy that bodies can fall through.
    pub before: Totals,
    /// The same to more digits, of a run that has them.
    pub start: Option<Invariants>,
    pub fall: f64,
    pub equilibration: f64,
    pub measured: &'a Measured,
    /// The collisions and steps of the first part of a run that goes on.
    pub earlier: (Collisions, u64),
    /// What the analyses have found.
    pub found: Vec<Found>,
    /// Wall time before the engine ran, and while it ran, seconds.
    pub seconds: [f64; 2],
}

impl<T: Real> Ended<'_, T> {
    /// The summary, if all of it is finite.
    pub fn summary(self) -> Result<Summary, Failure> {
        let Self { setup, world, bodies, course, before, measured, .. } = self;
        let (time, engine) = (world.time(), setup.engine);
        let left = |what: String| Failure::NotFinite { time, what, engine };
        if let Some(found) = not_finite(bodies) {
            return Err(left(found.to_string()));
        }
        let after = world.totals();
        if !after.is_finite() {
            let what = "the energy or a momentum of all bodies is no longer finite";
            return Err(left(what.to_owned()));
        }
        let (earlier, earlier_steps) = self.earlier;
        let [setup_seconds, engine_seconds] = self.seconds;
        let work = Work {
            earlier,
            earlier_steps,
            measured: measured.total(world),
            parts: measured.parts(world),
            equilibration: self.equilibration,
            mean_temperature: measured.mean_temperature(course.length()),
            statistics: measured.statistics(course.length()),
            fall: self.fall,
            setup_seconds,
            engine_seconds,
            found: self.found,
            ..Work::of(world)
        };
        let hash = state_hash(bodies);
        let temperature = Temperature::of(bodies);
        let mut summary = Summary::new(setup, &before, &after, temperature, hash, &work);
        summary.all_digits = self.start.map(|start| AllDigits::of(&start, bodies, world.gravity()));
        match summary.not_finite() {
            Some(what) => Err(left(format!("the {what} of the summary is no finite number"))),
            None => Ok(summary),
        }
    }
}
