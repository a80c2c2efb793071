//! Journey: an engine from the start of a run to its end, with what is to be
//! seen, written and sampled on the way.

use core::cell::OnceCell;
use core::time::Duration;
use std::path::PathBuf;
use std::time::Instant;

use carom::engine::{EngineError, Event, World};
use carom::observe::{Energy, Images, Sample, Temperature};
use carom::output::EventWriter;
use carom::real::Real;
use carom::space::PeriodicBox;
use carom::study::Course;

use super::failure::Failure;
use super::measured::Measured;
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
    /// The energy at the start, and what bodies can fall through.
    energy: (Energy, f64),
    /// What the figures of the summary are taken from.
    measured: Measured,
    /// In a periodic box, where bodies are in the space that it stands for, if that is
    /// written, and where to look at them next.
    images: Option<(Images<T>, f64)>,
}

impl<T: Real> Journey<T> {
    /// A run of a world, in a periodic box or open space, that begins with an energy and
    /// that which bodies can fall through.
    pub fn new(
        course: Course,
        space: Option<PeriodicBox<T>>,
        energy: (Energy, f64),
        measured: Measured,
    ) -> Self {
        Self { course, busy: Duration::ZERO, space, energy, measured, images: None }
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
        let mut progress = Progress::new(self.course, self.energy);
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
        let measure = self.measured.mark(length);
        let look = self.images.as_ref().map(|(_, look)| *look);
        let frame = record.and_then(Recorder::mark);
        let row = series.and_then(Series::mark);
        [measure, look, frame, row].into_iter().flatten().fold(length, f64::min)
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
        let record = record.filter(|record| record.mark() == Some(position));
        let series = series.filter(|series| series.mark() == Some(position));
        let bodies = OnceCell::new();
        let bodies = || bodies.get_or_init(|| world.bodies());
        while self.measured.mark(length).is_some_and(|mark| mark <= position) {
            self.measured.take(world, position, || Temperature::of(bodies()));
        }
        if let Some((images, look)) = &mut self.images {
            let bodies = bodies();
            images.look(bodies);
            *look = self.course.after(world, images.next_look(bodies, world.gravity()));
        }
        let images = self.images.as_ref().map(|(images, _)| images);
        if let Some(record) = record {
            record.write(world, bodies(), self.space, images)?;
        }
        if let Some(series) = series {
            series.row(position, Sample::of(world, bodies(), images))?;
        }
        Ok(())
    }

    /// Seconds that the engine, and writing its collisions, took.
    pub fn seconds(&self) -> f64 {
        self.busy.as_secs_f64()
    }

    /// What the figures of the summary are taken from.
    pub fn measured(&self) -> &Measured {
        &self.measured
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
