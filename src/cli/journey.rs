//! Journey: an engine from the start of a run to its end, with what is to be
//! seen, written and sampled on the way.

use core::time::Duration;
use std::path::PathBuf;
use std::time::Instant;

use carom::contact::Surface;
use carom::engine::{EngineError, Event, World};
use carom::observe::Temperature;
use carom::output::EventWriter;
use carom::real::Real;
use carom::study::Course;

use super::failure::Failure;
use super::output_file::{OutputError, OutputFile};
use super::progress::Progress;

/// How long the engine runs between two looks at the clock.
const STRETCH: Duration = Duration::from_millis(50);

/// A run under way.
pub struct Journey {
    course: Course,
    busy: Duration,
    /// In a periodic box, the samples for the mean temperature.
    samples: Option<Samples>,
}

impl Journey {
    /// A run of a world over a duration. In a gas, `temperature` and `surface`
    /// are what its mean temperature is to be made of.
    pub fn new<T: Real>(
        world: &World<T>,
        duration: f64,
        gas: Option<(Temperature, Surface)>,
    ) -> Self {
        let course = Course::new(world, duration);
        let samples = gas.map(|(first, surface)| Samples::new(first, surface));
        Self { course, busy: Duration::ZERO, samples }
    }

    /// Goes all the way, and writes the collisions to `events`, which comes back
    /// whole but without its final name.
    pub fn travel<T: Real>(
        &mut self,
        world: &mut World<T>,
        events: Option<OutputFile>,
    ) -> Result<Option<OutputFile>, Failure> {
        let mut progress = Progress::new(self.course);
        let mut events = events.map(Recorder::new).transpose()?;
        let mut stretch: u64 = 1;
        loop {
            let length = self.course.length();
            let mark = self.samples.as_ref().map_or(length, |samples| samples.mark(length));
            let start = Instant::now();
            let is_there = match &mut events {
                None => self.course.advance(world, mark, stretch, None)?,
                Some(events) => events.advance(|on_event| {
                    self.course.advance(world, mark, stretch, Some(on_event))
                })?,
            };
            let taken = start.elapsed();
            self.busy += taken;
            if taken < STRETCH / 2 {
                stretch = stretch.saturating_mul(2);
            } else if taken > STRETCH * 2 {
                stretch = (stretch / 2).max(1);
            }
            progress.show(world, self.busy);
            if !is_there {
                continue;
            }
            if let Some(samples) = &mut self.samples {
                samples.take(world);
            }
            if mark >= length {
                break;
            }
        }
        let start = Instant::now();
        let file = events.map(Recorder::finish).transpose()?;
        self.busy += start.elapsed();
        Ok(file)
    }

    /// Seconds that the engine, and writing its collisions, took.
    pub fn seconds(&self) -> f64 {
        self.busy.as_secs_f64()
    }

    /// The mean translational temperature over the run; `None` where it is
    /// not needed.
    pub fn mean_temperature(&self) -> Option<f64> {
        let samples = self.samples.as_ref()?;
        Some(samples.integral / self.course.length())
    }
}

/// The translational temperature, sampled on the way.
struct Samples {
    /// Into how many spans the run is divided: a power of two, so that their
    /// ends are exact.
    spans: u32,
    /// How many have passed.
    passed: u32,
    last_position: f64,
    last: f64,
    /// Temperature × position, by the trapezoidal rule.
    integral: f64,
}

impl Samples {
    fn new(first: Temperature, surface: Surface) -> Self {
        // Rough contacts exchange energy between motion and spin: the ends of a
        // run do not show what was in between.
        let spans = if surface.changes_spins() { 32 } else { 1 };
        Self { spans, passed: 0, last_position: 0.0, last: first.translational, integral: 0.0 }
    }

    /// Where the next sample is due.
    fn mark(&self, length: f64) -> f64 {
        length * f64::from(self.passed + 1) / f64::from(self.spans)
    }

    fn take<T: Real>(&mut self, world: &World<T>) {
        let position = Course::position(world);
        let now = Temperature::of(&world.bodies()).map_or(self.last, |now| now.translational);
        self.integral += 0.5 * (self.last + now) * (position - self.last_position);
        (self.last_position, self.last) = (position, now);
        self.passed += 1;
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

    /// Writes down the collisions of a stretch of the way.
    fn advance<T: Real>(
        &mut self,
        stretch: impl FnOnce(&mut dyn FnMut(&Event<T>)) -> Result<bool, EngineError>,
    ) -> Result<bool, Failure> {
        let result = stretch(&mut |event| self.writer.record(event));
        self.writer
            .check()
            .map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        Ok(result?)
    }

    fn finish(self) -> Result<OutputFile, OutputError> {
        self.writer.finish().map_err(|source| OutputError::Write { path: self.path, source })
    }
}
