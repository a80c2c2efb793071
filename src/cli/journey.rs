//! Journey: an engine from the start of a run to its end, with what is to be
//! seen, written and sampled on the way.

use core::time::Duration;
use std::path::PathBuf;
use std::time::Instant;

use carom::bodies::Bodies;
use carom::contact::Surface;
use carom::engine::{EngineError, Event, World};
use carom::observe::{Images, Sample, Temperature};
use carom::output::EventWriter;
use carom::real::Real;
use carom::space::PeriodicBox;
use carom::study::Course;

use super::failure::Failure;
use super::output_file::{OutputError, OutputFile};
use super::progress::Progress;
use super::recording::Recorder;
use super::series::Series;

/// How long the engine runs between two looks at the clock.
const STRETCH: Duration = Duration::from_millis(50);

/// What a run writes on its way.
pub struct OnTheWay {
    /// Every collision.
    pub events: Option<OutputFile>,
    /// Frames.
    pub record: Option<Recorder>,
    /// Figures.
    pub series: Option<Series>,
}

/// A run under way.
pub struct Journey<T: Real> {
    course: Course,
    busy: Duration,
    space: Option<PeriodicBox<T>>,
    /// In a periodic box, the samples for the mean temperature.
    samples: Option<Samples>,
    /// In a periodic box, where bodies are in the space that it stands for, if that is
    /// written, and where to look at them next.
    images: Option<(Images<T>, f64)>,
}

impl<T: Real> Journey<T> {
    /// A run of a world over a duration, in a periodic box or open space. In a gas,
    /// `temperature` and `surface` are what its mean temperature is to be made of.
    pub fn new(
        world: &World<T>,
        duration: f64,
        space: Option<PeriodicBox<T>>,
        gas: Option<(Temperature, Surface)>,
    ) -> Self {
        let course = Course::new(world, duration);
        let samples = gas.map(|(first, surface)| Samples::new(first, surface));
        Self { course, busy: Duration::ZERO, space, samples, images: None }
    }

    /// How far the run goes.
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// Keeps count of the boxes that bodies move through, from now on.
    pub fn count_images(&mut self, world: &World<T>) {
        let images = self.space.map(|space| Images::new(space, &world.bodies()));
        self.images = images.map(|images| (images, 0.0));
    }

    /// The periodic box, and the boxes that bodies have moved through.
    pub fn space(&self) -> (Option<PeriodicBox<T>>, Option<&Images<T>>) {
        (self.space, self.images.as_ref().map(|(images, _)| images))
    }

    /// Goes all the way, and writes what is to be written. The files come back whole but
    /// without their final names.
    pub fn travel(
        &mut self,
        world: &mut World<T>,
        on_the_way: OnTheWay,
    ) -> Result<Vec<OutputFile>, Failure> {
        let OnTheWay { events, mut record, mut series } = on_the_way;
        let mut progress = Progress::new(self.course);
        let mut events = events.map(Events::new).transpose()?;
        let mut stretch: u64 = 1;
        let length = self.course.length();
        let start = Instant::now();
        self.look(world, record.as_mut(), series.as_mut())?;
        self.busy += start.elapsed();
        loop {
            let mark = self.mark(record.as_ref(), series.as_ref());
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
            let start = Instant::now();
            self.look(world, record.as_mut(), series.as_mut())?;
            self.busy += start.elapsed();
            if mark >= length {
                break;
            }
        }
        let start = Instant::now();
        let events = events.map(Events::finish).transpose()?;
        let record = record.map(Recorder::finish).transpose()?;
        let series = series.map(Series::finish).transpose()?;
        self.busy += start.elapsed();
        Ok([events, record, series].into_iter().flatten().collect())
    }

    /// Where the bodies are to be looked at next.
    fn mark(&self, record: Option<&Recorder>, series: Option<&Series>) -> f64 {
        let length = self.course.length();
        let sample = self.samples.as_ref().map(|samples| samples.mark(length));
        let look = self.images.as_ref().map(|(_, look)| *look);
        let frame = record.and_then(Recorder::mark);
        let row = series.and_then(Series::mark);
        [sample, look, frame, row].into_iter().flatten().fold(length, f64::min)
    }

    /// Looks at the bodies, for all that is due.
    fn look(
        &mut self,
        world: &World<T>,
        record: Option<&mut Recorder>,
        series: Option<&mut Series>,
    ) -> Result<(), Failure> {
        let position = Course::position(world);
        let length = self.course.length();
        let samples = self.samples.as_mut().filter(|samples| samples.mark(length) == position);
        let record = record.filter(|record| record.mark() == Some(position));
        let series = series.filter(|series| series.mark() == Some(position));
        let is_due = samples.is_some() || record.is_some() || series.is_some();
        if !is_due && self.images.is_none() {
            return Ok(());
        }
        let bodies = world.bodies();
        if let Some(samples) = samples {
            samples.take(position, &bodies);
        }
        if let Some((images, look)) = &mut self.images {
            images.look(&bodies);
            *look = self.course.after(world, images.next_look(&bodies, world.gravity()));
        }
        let images = self.images.as_ref().map(|(images, _)| images);
        if let Some(record) = record {
            record.write(world, &bodies, self.space, images)?;
        }
        if let Some(series) = series {
            series.row(position, Sample::of(world, &bodies, images))?;
        }
        Ok(())
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

    fn take<T: Real>(&mut self, position: f64, bodies: &Bodies<T>) {
        let now = Temperature::of(bodies).map_or(self.last, |now| now.translational);
        self.integral += 0.5 * (self.last + now) * (position - self.last_position);
        (self.last_position, self.last) = (position, now);
        self.passed += 1;
    }
}

/// An events file under way.
struct Events {
    path: PathBuf,
    writer: EventWriter<OutputFile>,
}

impl Events {
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
