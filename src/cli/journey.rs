//! Journey: an engine from the start of a run to its end, with what is to be
//! seen, written and sampled on the way.

use core::cell::OnceCell;
use core::time::Duration;
use std::time::Instant;

use carom::engine::{Event, World};
use carom::observe::{Energy, Images, Sample, Temperature};
use carom::real::Real;
use carom::space::PeriodicBox;
use carom::study::Course;

use super::analyses::{Analyses, Found};
use super::boxes::Boxes;
use super::events::Events;
use super::failure::Failure;
use super::interrupt;
use super::kept::{Keeper, Notes};
use super::measured::Measured;
use super::output_file::OutputFile;
use super::progress::Progress;
use super::recording::Recorder;
use super::series::Series;

/// How far the engine goes between two looks at the clock, as [`Course::advance`] has it.
pub struct Stretch(pub u64);

impl Stretch {
    /// How long one is to take.
    const USUAL: Duration = Duration::from_millis(50);

    /// The shortest one.
    pub fn new() -> Self {
        Self(1)
    }

    /// The next one is longer or shorter, by how long this one has taken.
    pub fn adapt(&mut self, taken: Duration) {
        if taken < Self::USUAL / 2 {
            self.0 = self.0.saturating_mul(2);
        } else if taken > Self::USUAL * 2 {
            self.0 = (self.0 / 2).max(1);
        }
    }
}

/// What a run writes on its way.
pub struct OnTheWay {
    /// Collisions.
    pub events: Option<Events>,
    /// Frames.
    pub record: Option<Recorder>,
    /// Figures.
    pub series: Option<Series>,
    /// What is found of the bodies.
    pub analyses: Analyses,
    /// The run itself, to go on from.
    pub keeper: Option<Keeper>,
}

impl Drop for OnTheWay {
    fn drop(&mut self) {
        interrupt::keeps(false);
    }
}

/// What a run has written on its way.
pub struct Arrived {
    /// The files, whole but without their final names.
    pub files: Vec<OutputFile>,
    /// What the analyses have found.
    pub found: Vec<Found>,
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
    /// written.
    boxes: Option<Boxes<T>>,
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
        Self { course, busy: Duration::ZERO, space, energy, measured, boxes: None }
    }

    /// Keeps count of the boxes that bodies move through, from now on; `counted` are those
    /// of a run that goes on.
    pub fn count_images(&mut self, world: &World<T>, counted: Option<&Vec<[i32; 3]>>) {
        let boxes = |space| Boxes::new(space, world, &self.course, counted);
        self.boxes = self.space.map(boxes);
    }

    /// The periodic box, and the boxes that bodies have moved through.
    pub fn space(&self) -> (Option<PeriodicBox<T>>, Option<&Images<T>>) {
        (self.space, self.boxes.as_ref().map(Boxes::images))
    }

    /// Goes all the way, and writes what is to be written.
    pub fn travel(
        &mut self,
        world: &mut World<T>,
        mut on_the_way: OnTheWay,
    ) -> Result<Arrived, Failure> {
        let mut progress = Progress::new(self.course, self.energy);
        let mut stretch = Stretch::new();
        let length = self.course.length();
        if let Some(keeper) = &mut on_the_way.keeper {
            keeper.set_out(world, &self.course);
            interrupt::keeps(true);
        }
        let start = Instant::now();
        self.look(world, &mut on_the_way)?;
        self.busy += start.elapsed();
        loop {
            let mark = self.mark(&on_the_way);
            let start = Instant::now();
            let is_there = self.advance(world, &mut on_the_way, mark, stretch.0)?;
            let taken = start.elapsed();
            self.busy += taken;
            stretch.adapt(taken);
            progress.show(world, self.busy);
            let start = Instant::now();
            if is_there {
                self.look(world, &mut on_the_way)?;
            }
            let is_end = is_there && mark >= length;
            self.keep(world, &mut on_the_way, is_end)?;
            self.busy += start.elapsed();
            if is_end {
                break;
            }
        }
        let start = Instant::now();
        let events = on_the_way.events.take().map(Events::finish).transpose()?;
        let record = on_the_way.record.take().map(Recorder::finish).transpose()?;
        let series = on_the_way.series.take().map(Series::finish).transpose()?;
        let found = core::mem::take(&mut on_the_way.analyses).finish()?;
        let (analysed, found): (Vec<OutputFile>, Vec<Found>) = found.into_iter().unzip();
        self.busy += start.elapsed();
        let written = [events, record, series].into_iter().flatten();
        Ok(Arrived { files: written.chain(analysed).collect(), found })
    }

    /// Goes on for a stretch towards a mark, and tells those that listen of collisions.
    fn advance(
        &self,
        world: &mut World<T>,
        on_the_way: &mut OnTheWay,
        mark: f64,
        stretch: u64,
    ) -> Result<bool, Failure> {
        let OnTheWay { events, analyses, .. } = on_the_way;
        let course = self.course;
        match (events, analyses.hears()) {
            (None, false) => Ok(course.advance(world, mark, stretch, None)?),
            (None, true) => {
                let hear = &mut |event: &Event<T>| analyses.hear(event);
                Ok(course.advance(world, mark, stretch, Some(hear))?)
            }
            (Some(events), hears) => events.advance(|record| {
                let both = &mut |event: &Event<T>| {
                    if hears {
                        analyses.hear(event);
                    }
                    record(event);
                };
                course.advance(world, mark, stretch, Some(both))
            }),
        }
    }

    /// Keeps the run at its end, where it is due, and when it is asked to end, which it
    /// does then.
    fn keep(
        &mut self,
        world: &World<T>,
        on_the_way: &mut OnTheWay,
        is_end: bool,
    ) -> Result<(), Failure> {
        let OnTheWay { events, record, series, analyses, keeper } = on_the_way;
        let Some(keeper) = keeper else { return Ok(()) };
        let asked = interrupt::asked_to_end().filter(|_| !is_end);
        if !is_end && asked.is_none() && !keeper.is_due(Course::position(world)) {
            return Ok(());
        }
        if let Some(boxes) = &mut self.boxes {
            boxes.look(world, &world.bodies(), &self.course);
        }
        let notes = Notes {
            length: self.course.length(),
            measured: self.measured.clone(),
            images: self.boxes.as_ref().map(|boxes| boxes.images().counts().to_vec()),
            events: events.as_mut().map(Events::keep).transpose()?,
            record: record.as_mut().map(Recorder::keep).transpose()?,
            series: series.as_mut().map(Series::keep).transpose()?,
            analyses: analyses.kept(),
        };
        keeper.keep(world, notes)?;
        asked.map_or(Ok(()), |status| Err(keeper.ended(world.time(), status)))
    }

    /// Where the bodies are to be looked at next.
    fn mark(&self, on_the_way: &OnTheWay) -> f64 {
        let length = self.course.length();
        let measure = self.measured.mark(length);
        let look = self.boxes.as_ref().map(Boxes::next);
        let frame = on_the_way.record.as_ref().and_then(Recorder::mark);
        let row = on_the_way.series.as_ref().and_then(Series::mark);
        let kept = on_the_way.keeper.as_ref().and_then(Keeper::mark);
        let analysed = on_the_way.analyses.mark();
        [measure, look, frame, row, analysed, kept].into_iter().flatten().fold(length, f64::min)
    }

    /// Looks at the bodies, for all that is due.
    fn look(&mut self, world: &World<T>, on_the_way: &mut OnTheWay) -> Result<(), Failure> {
        let position = Course::position(world);
        let length = self.course.length();
        let OnTheWay { record, series, analyses, .. } = on_the_way;
        let is_analysed = analyses.mark() == Some(position);
        let record = record.as_mut().filter(|record| record.mark() == Some(position));
        let series = series.as_mut().filter(|series| series.mark() == Some(position));
        let bodies = OnceCell::new();
        let bodies = || bodies.get_or_init(|| world.bodies());
        while self.measured.mark(length).is_some_and(|mark| mark <= position) {
            self.measured.take(world, position, || Temperature::of(bodies()));
        }
        let is_read = record.is_some() || series.is_some() || is_analysed || position >= length;
        let boxes = self.boxes.as_mut().filter(|boxes| is_read || boxes.next() <= position);
        if let Some(boxes) = boxes {
            boxes.look(world, bodies(), &self.course);
        }
        let images = self.boxes.as_ref().map(Boxes::images);
        if let Some(record) = record {
            record.write(world, bodies(), self.space, images)?;
        }
        if let Some(series) = series {
            series.row(position, Sample::of(world, bodies(), images))?;
        }
        if is_analysed {
            analyses.look(world, bodies(), self.space, images);
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
