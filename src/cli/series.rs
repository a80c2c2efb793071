//! Series: the figures that a run writes on its way.

use std::path::PathBuf;

use carom::engine::World;
use carom::observe::Sample;
use carom::output::{SeriesColumn, SeriesWriter};
use carom::real::Real;
use carom::scene::SceneFile;
use carom::study::Course;
use serde::{Deserialize, Serialize};

use super::arguments::RunArguments;
use super::asked::{Asked, Words};
use super::failure::Failure;
use super::output_file::{KeptFile, OutputError, OutputFile};
use super::pace::{KeptPace, Pace};

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
        let mut all = SeriesColumn::all(file.parts());
        if file.has_flow() {
            all.extend(SeriesColumn::of_flow());
        }
        let columns = match file.series_columns() {
            None => all,
            Some(names) => names
                .iter()
                .map(|name| {
                    all.iter().find(|column| column.name() == name).cloned().ok_or_else(|| {
                        let known: Vec<_> = all.iter().map(SeriesColumn::name).collect();
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

/// A series of a run that was kept.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct KeptSeries {
    pub file: Option<KeptFile>,
    pace: KeptPace,
    last: Option<Sample>,
}

/// A series under way.
pub struct Series {
    path: PathBuf,
    pace: Pace,
    writer: SeriesWriter<OutputFile>,
}

impl Series {
    /// Figures of a world into an open file, from a time on, after those that were kept;
    /// `volume` is that of a periodic box.
    pub fn new<T: Real>(
        series: &AskedSeries,
        file: OutputFile,
        world: &World<T>,
        course: &Course,
        start: f64,
        volume: Option<f64>,
        kept: Option<&KeptSeries>,
    ) -> Result<Self, OutputError> {
        let (path, every) = (series.asked.path.clone(), series.asked.every);
        let columns = series.columns.clone();
        let writer = match file.is_begun() {
            true => Ok(SeriesWriter::further(file, columns, volume)),
            false => SeriesWriter::new(file, columns, volume),
        };
        let writer = match writer {
            Ok(writer) => writer.after(kept.and_then(|kept| kept.last.clone())),
            Err(source) => return Err(OutputError::Write { path, source }),
        };
        let pace = Pace::new(world, course, every, start, kept.map(|kept| kept.pace));
        Ok(Self { path, pace, writer })
    }

    /// Where the next row is due.
    pub fn mark(&self) -> Option<f64> {
        self.pace.mark()
    }

    /// Writes down what is measured, at the place where it is due.
    pub fn row(&mut self, position: f64, sample: Sample) -> Result<(), OutputError> {
        let written = self.writer.row(sample);
        written.map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        self.pace.pass(position);
        Ok(())
    }

    /// Brings all rows so far to the disk, and says what is to be remembered.
    pub fn keep(&mut self) -> Result<KeptSeries, OutputError> {
        let file = self.writer.flush().and_then(OutputFile::keep);
        let file = file.map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        Ok(KeptSeries { file, pace: self.pace.kept(), last: self.writer.last() })
    }

    /// The file, whole but for its final name.
    pub fn finish(self) -> Result<OutputFile, OutputError> {
        self.writer.finish().map_err(|source| OutputError::Write { path: self.path, source })
    }
}
