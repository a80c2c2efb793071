//! Series: the figures that a run writes on its way.

use std::path::PathBuf;

use carom::engine::World;
use carom::observe::Sample;
use carom::output::{SeriesColumn, SeriesWriter};
use carom::real::Real;
use carom::scene::SceneFile;
use carom::study::{Course, Schedule};

use super::arguments::RunArguments;
use super::asked::{Asked, Words};
use super::failure::Failure;
use super::output_file::{OutputError, OutputFile};

/// What they are called.
const WORDS: Words = Words { things: "rows of a series", option: "--series", table: "series" };

/// What is to be written, and how often.
#[derive(Clone, Debug)]
pub struct AskedSeries {
    pub asked: Asked,
    columns: Vec<SeriesColumn>,
}

impl AskedSeries {
    /// What the options ask, and in their place the scene.
    pub fn of(
        arguments: &RunArguments,
        file: &SceneFile,
        duration: f64,
    ) -> Result<Option<Self>, Failure> {
        let columns = match file.series_columns() {
            None => SeriesColumn::all(),
            Some(names) => names
                .iter()
                .map(|name| {
                    SeriesColumn::named(name).ok_or_else(|| {
                        let known: Vec<_> = SeriesColumn::names().collect();
                        let wanted = format!("a column is one of {}", known.join(", "));
                        file.mistake("series.columns", &format!("{name:?}"), &wanted)
                    })
                })
                .collect::<Result<_, _>>()?,
        };
        let options = (arguments.series.as_ref(), arguments.series_every);
        let asked = Asked::of(WORDS, options, file.series()?, duration)?;
        if let Some(asked) = &asked
            && asked.path.extension().is_some_and(|ending| ending != "csv")
        {
            return Err(asked.refused(WORDS, file, "its ending must be .csv"));
        }
        Ok(asked.map(|asked| Self { asked, columns }))
    }
}

/// A series under way.
pub struct Series {
    path: PathBuf,
    schedule: Schedule,
    writer: SeriesWriter<OutputFile>,
}

impl Series {
    /// Figures of a world into an open file, from a time on; `volume` is that of a periodic
    /// box.
    pub fn new<T: Real>(
        series: &AskedSeries,
        file: OutputFile,
        world: &World<T>,
        course: &Course,
        start: f64,
        volume: Option<f64>,
    ) -> Result<Self, OutputError> {
        let path = series.asked.path.clone();
        let writer = match SeriesWriter::new(file, series.columns.clone(), volume) {
            Ok(writer) => writer,
            Err(source) => return Err(OutputError::Write { path, source }),
        };
        let schedule = Schedule::new(world, course, series.asked.every).starting(start);
        Ok(Self { path, schedule, writer })
    }

    /// Where the next row is due.
    pub fn mark(&self) -> Option<f64> {
        self.schedule.mark()
    }

    /// Writes down what is measured, at the place where it is due.
    pub fn row(&mut self, position: f64, sample: Sample) -> Result<(), OutputError> {
        let written = self.writer.row(sample);
        written.map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        self.schedule.pass(position);
        Ok(())
    }

    /// The file, whole but for its final name.
    pub fn finish(self) -> Result<OutputFile, OutputError> {
        self.writer.finish().map_err(|source| OutputError::Write { path: self.path, source })
    }
}
