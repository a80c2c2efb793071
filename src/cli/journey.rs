//! Journey: an engine from its first step to its last, with what is to be
//! seen, written and sampled on the way.

use core::time::Duration;
use std::path::PathBuf;
use std::time::Instant;

use carom::contact::Surface;
use carom::engine::Stepped;
use carom::observe::Temperature;
use carom::output::{EventWriter, OutputError, OutputFile};
use carom::real::Real;
use carom::scene::Scene;

use super::failure::Failure;
use super::progress::Progress;

/// How long the engine runs between two looks at the clock.
const STRETCH: Duration = Duration::from_millis(50);

/// A run under way.
pub struct Journey {
    steps: u64,
    busy: Duration,
    /// In a periodic box, the samples for the mean temperature.
    samples: Option<Samples>,
}

impl Journey {
    /// A run of a scene over `steps` steps.
    pub fn new<T: Real>(scene: &Scene<T>, steps: u64) -> Self {
        let samples = match (&scene.periodic, Temperature::of(&scene.bodies)) {
            (Some(_), Some(first)) => Some(Samples::new(first, scene.surface, steps)),
            _ => None,
        };
        Self { steps, busy: Duration::ZERO, samples }
    }

    /// Takes all steps, and writes the collisions to `events`, which comes back
    /// whole but without its final name.
    pub fn travel<T: Real>(
        &mut self,
        world: &mut Stepped<T>,
        events: Option<OutputFile>,
    ) -> Result<Option<OutputFile>, Failure> {
        let progress = Progress::new(self.steps);
        let mut events = events.map(Recorder::new).transpose()?;
        let mut stretch = 1;
        while world.steps() < self.steps {
            let next = self.samples.as_ref().map_or(self.steps, |samples| samples.next);
            let count = stretch.min(next - world.steps());
            let start = Instant::now();
            match &mut events {
                None => world.advance_steps(count),
                Some(events) => events.advance(world, count)?,
            }
            let taken = start.elapsed();
            self.busy += taken;
            if taken < STRETCH / 2 {
                stretch = count.saturating_mul(2).max(stretch);
            } else if taken > STRETCH * 2 {
                stretch = (count / 2).max(1);
            }
            if let Some(samples) = &mut self.samples {
                samples.take(world);
            }
            progress.show(world.steps(), world.time(), world.collisions(), self.busy);
        }
        let start = Instant::now();
        let file = events.map(Recorder::finish).transpose()?;
        self.busy += start.elapsed();
        Ok(file)
    }

    /// Seconds that the engine, and writing its collisions, took.
    pub fn wall_seconds(&self) -> f64 {
        self.busy.as_secs_f64()
    }

    /// The mean translational temperature over the run; `None` where nobody
    /// needs it.
    pub fn mean_temperature(&self) -> Option<f64> {
        let samples = self.samples.as_ref()?;
        Some(samples.integral / self.steps as f64)
    }
}

/// The translational temperature, sampled on the way.
struct Samples {
    steps: u64,
    every: u64,
    /// The step at which the next sample is due.
    next: u64,
    last_step: u64,
    last: f64,
    /// Temperature × steps, by the trapezoidal rule.
    integral: f64,
}

impl Samples {
    fn new(first: Temperature, surface: Surface, steps: u64) -> Self {
        // Rough contacts exchange energy between motion and spin: the ends of a
        // run do not tell what was in between.
        let spans = match surface {
            Surface::Smooth => 1,
            Surface::Rough => 32,
        };
        let every = steps.div_ceil(spans);
        let last = first.translational;
        Self { steps, every, next: every, last_step: 0, last, integral: 0.0 }
    }

    fn take<T: Real>(&mut self, world: &Stepped<T>) {
        let step = world.steps();
        if step < self.next {
            return;
        }
        let now = Temperature::of(&world.bodies()).map_or(self.last, |now| now.translational);
        self.integral += 0.5 * (self.last + now) * (step - self.last_step) as f64;
        (self.last_step, self.last) = (step, now);
        self.next = (step + self.every).min(self.steps);
    }
}

/// An events file under way.
struct Recorder {
    path: PathBuf,
    writer: EventWriter<OutputFile>,
}

impl Recorder {
    fn new(file: OutputFile) -> Result<Self, OutputError> {
        let path = file.path().to_path_buf();
        match EventWriter::new(file) {
            Ok(writer) => Ok(Self { path, writer }),
            Err(source) => Err(OutputError::Write { path, source }),
        }
    }

    fn advance<T: Real>(&mut self, world: &mut Stepped<T>, steps: u64) -> Result<(), OutputError> {
        for _ in 0..steps {
            world.step_with(&mut |event| self.writer.record(event));
            self.writer
                .check()
                .map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        }
        Ok(())
    }

    fn finish(self) -> Result<OutputFile, OutputError> {
        self.writer.finish().map_err(|source| OutputError::Write { path: self.path, source })
    }
}
