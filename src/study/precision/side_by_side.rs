//! Side by side: the three precisions at the same times. The states of the
//! double-double are compared as they come and not kept: the bodies of a large
//! scene at all times would fill the memory.

use serde::{Deserialize, Serialize};

use super::order::{Comparer, Departures, Seen};
use super::run::{Run, Track, finite};
use crate::engine::Compiled;
use crate::lane::Lane;
use crate::real::DoubleDouble;
use crate::scene::SceneFile;
use crate::study::StudyError;
use crate::study::deviation::Truth;

/// The double-double's run, and how far the others are from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SideBySide {
    /// How many bodies there are.
    pub bodies: usize,
    /// The greatest radius, length.
    pub radius: f64,
    /// The diagonal of the box about all positions of bodies,
    /// length.
    pub extent: f64,
    /// Whether there is a uniform field.
    pub has_gravity: bool,
    /// Whether space is periodic.
    pub is_periodic: bool,
    /// Whether bodies can meet something fixed.
    pub has_surroundings: bool,
    /// What was seen of the double-double.
    pub truth: Track,
    /// `f32` and `f64`.
    pub others: [Comparison; 2],
}

/// A run against the double-double's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// What was seen of it.
    pub track: Track,
    /// Root of the mean square distance of the centres at each time, length.
    pub distance: Vec<Option<f64>>,
    /// The greatest distance, length.
    pub greatest: Vec<Option<f64>>,
    /// The first collisions that are others.
    pub departures: Departures,
}

/// One of the others under way.
struct Companion<T: Compiled> {
    run: Option<Run<T>>,
    comparer: Comparer,
    comparison: Comparison,
}

impl<T: Compiled> Companion<T> {
    fn new(run: Result<Run<T>, StudyError>, bodies: usize) -> Self {
        let mut comparison = Comparison::default();
        let run = run.map_err(|error| comparison.track.stopped = Some(error.to_string())).ok();
        Self { run, comparer: Comparer::new(bodies), comparison }
    }

    /// Goes to a point in time, where the truth is already.
    fn follow(&mut self, point: u32, truth: &Truth, should: &[Seen]) {
        let Some(run) = &mut self.run else { return };
        let mut seen = Vec::new();
        let listener = (!self.comparer.is_done()).then_some(&mut seen);
        let advanced = run.advance(point, listener);
        if let Err(error) = advanced {
            self.comparison.track.stopped = Some(error.to_string());
            self.run = None;
            return;
        }
        self.comparer.compare(should, &seen);
        let bodies = run.world().bodies();
        let deviation = truth.deviation(&bodies);
        self.comparison.distance.push(finite(deviation.position));
        self.comparison.greatest.push(finite(deviation.position_worst));
        self.comparison.track.samples.push(run.sample(&bodies));
    }

    fn finish(self) -> Comparison {
        // A run that stopped early lacks the collisions after that.
        let seen = self.comparison.track.samples.iter().rev().nth(1);
        let before = seen.map_or(0.0, |sample| sample.time);
        Comparison { departures: self.comparer.finish(before), ..self.comparison }
    }
}

impl SideBySide {
    /// Runs all three.
    ///
    /// # Errors
    /// If the double-double cannot be run.
    pub(super) fn measured(
        file: &SceneFile,
        duration: f64,
        samples: u32,
    ) -> Result<Self, StudyError> {
        let mut run = Run::<DoubleDouble>::new(file, duration, samples, 0)?;
        let bodies = run.world().bodies().len();
        let mut single = Companion::new(Run::<f32>::new(file, duration, samples, 0), bodies);
        let mut double = Companion::new(Run::<f64>::new(file, duration, samples, 0), bodies);
        let mut truth = Track::default();
        let mut corners = [[f64::MAX; 3], [f64::MIN; 3]];
        let mut seen = Vec::new();
        for point in 0..=samples {
            seen.clear();
            let is_needed = !(single.comparer.is_done() && double.comparer.is_done());
            run.advance(point, is_needed.then_some(&mut seen))?;
            let now = Truth::of(run.world(), run.gravity, run.periodic, run.fall);
            truth.samples.push(run.sample(&now.bodies));
            for index in 0..bodies {
                let position = now.bodies.position_of(index).cast::<f64>().to_array();
                for (k, x) in position.into_iter().enumerate() {
                    corners[0][k] = corners[0][k].min(x);
                    corners[1][k] = corners[1][k].max(x);
                }
            }
            single.follow(point, &now, &seen);
            double.follow(point, &now, &seen);
        }
        let sides = (0..3).map(|k| corners[1][k] - corners[0][k]);
        let extent = sides.map(|side| side * side).sum::<f64>().sqrt();
        Ok(Self {
            bodies,
            radius: run.radius,
            extent: finite(extent).unwrap_or(0.0),
            has_gravity: run.gravity.to_array().iter().any(|&a| a != DoubleDouble::ZERO),
            is_periodic: run.periodic.is_some(),
            has_surroundings: run.has_surroundings,
            truth,
            others: [single.finish(), double.finish()],
        })
    }

    /// Collisions per body at each time: each collision of two bodies counts for
    /// both.
    #[must_use]
    pub fn collisions_per_body(&self) -> Vec<f64> {
        let per_body = |ends: u64| ends as f64 / self.bodies as f64;
        self.truth.samples.iter().map(|sample| per_body(sample.ends)).collect()
    }
}
