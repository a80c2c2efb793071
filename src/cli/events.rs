//! Events: the collisions that a run writes on its way.

use core::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use carom::engine::{EngineError, Event};
use carom::output::{EventArrays, EventFilter, EventWriter};
use carom::real::Real;
use carom::scene::Precision;
use serde::{Deserialize, Serialize};

use super::arguments::RunArguments;
use super::failure::Failure;
use super::output_file::{KeptFile, OutputError, OutputFile};

/// The endings that an events file can have.
const ENDINGS: &str = ".csv or .npz";

/// Collisions of a run that was kept.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct KeptEvents {
    pub file: Option<KeptFile>,
    /// How many had passed the filter.
    passed: u64,
}

/// What of the collisions is to be written, and how.
#[derive(Clone, Debug)]
pub struct AskedEvents {
    filter: EventFilter,
    is_archive: bool,
}

impl AskedEvents {
    /// What the options ask, of a scene in a precision and with a number of bodies.
    pub fn of(
        arguments: &RunArguments,
        precision: Precision,
        bodies: usize,
        is_kept: bool,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = &arguments.events else { return Ok(None) };
        let is_archive = is_archive(path)?;
        if is_archive && precision == Precision::DoubleDouble {
            return Err(Failure::Argument(format!(
                "--events is {}; arrays have no type for {precision}, which keeps all its digits in \
                 text: .csv",
                path.display()
            )));
        }
        if is_archive && is_kept {
            return Err(Failure::Argument(format!(
                "--events is {}; events of a run that is kept by --snapshot, or that goes on by \
                 --resume, go into a file that can be continued: .csv",
                path.display()
            )));
        }
        let ranges = arguments.events_of.clone();
        if let Some(range) = ranges.iter().find(|range| *range.end() as usize >= bodies) {
            return Err(Failure::Argument(format!(
                "--events-of {}: there are {bodies} bodies, counted from 0",
                shown(range)
            )));
        }
        let filter = EventFilter::new().of(ranges);
        let filter = arguments.events_from.into_iter().fold(filter, EventFilter::from);
        let filter = arguments.events_every.into_iter().fold(filter, EventFilter::every);
        Ok(Some(Self { filter, is_archive }))
    }
}

/// Whether a file is one of arrays; files without an ending, devices and pipes among them,
/// hold comma-separated values.
fn is_archive(path: &Path) -> Result<bool, Failure> {
    match path.extension() {
        None => Ok(false),
        Some(ending) if ending == "csv" => Ok(false),
        Some(ending) if ending == "npz" => Ok(true),
        Some(_) => Err(Failure::Argument(format!(
            "--events is {}; its ending must be {ENDINGS}",
            path.display()
        ))),
    }
}

/// Reads the number of a body, or a range of them as `20-29`.
pub fn bodies(text: &str) -> Result<RangeInclusive<u32>, String> {
    let wanted = "it must be the number of a body, or a range of them as 20-29";
    let number = |text: &str| text.trim().parse::<u32>().map_err(|_| wanted.to_owned());
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let range = number(first)?..=number(last)?;
    if range.is_empty() { Err(wanted.to_owned()) } else { Ok(range) }
}

/// A range as it is typed.
pub fn shown(range: &RangeInclusive<u32>) -> String {
    let (first, last) = (range.start(), range.end());
    if first == last { first.to_string() } else { format!("{first}-{last}") }
}

/// An events file under way.
pub struct Events {
    path: PathBuf,
    filter: EventFilter,
    writer: Writer,
}

enum Writer {
    Rows(Box<EventWriter<OutputFile>>),
    Arrays(Box<EventArrays<OutputFile>>),
}

impl Writer {
    fn record<T: Real>(&mut self, event: &Event<T>) {
        match self {
            Self::Rows(rows) => rows.record(event),
            Self::Arrays(arrays) => arrays.record(event),
        }
    }
}

impl Events {
    /// Collisions into an open file, after those that it has.
    pub fn new(
        asked: AskedEvents,
        file: OutputFile,
        kept: Option<&KeptEvents>,
    ) -> Result<Self, OutputError> {
        let path = file.path().to_path_buf();
        let filter = asked.filter.after(kept.map_or(0, |kept| kept.passed));
        let writer = match (asked.is_archive, file.is_begun()) {
            (true, _) => EventArrays::new(&path, file).map(|arrays| Writer::Arrays(arrays.into())),
            (false, true) => Ok(Writer::Rows(EventWriter::further(file).into())),
            (false, false) => EventWriter::new(file).map(|rows| Writer::Rows(rows.into())),
        };
        match writer {
            Ok(writer) => Ok(Self { path, filter, writer }),
            Err(source) => Err(OutputError::Write { path, source }),
        }
    }

    /// Writes down the collisions of a stretch of the way.
    pub fn advance<T: Real>(
        &mut self,
        stretch: impl FnOnce(&mut dyn FnMut(&Event<T>)) -> Result<bool, EngineError>,
    ) -> Result<bool, Failure> {
        let Self { path, filter, writer } = self;
        let result = stretch(&mut |event| {
            if filter.takes(event) {
                writer.record(event);
            }
        });
        let checked = match writer {
            Writer::Rows(rows) => rows.check(),
            Writer::Arrays(arrays) => arrays.check(),
        };
        checked.map_err(|source| OutputError::Write { path: path.clone(), source })?;
        Ok(result?)
    }

    /// Brings all collisions so far to the disk, and says what is to be remembered.
    pub fn keep(&mut self) -> Result<KeptEvents, OutputError> {
        let file = match &mut self.writer {
            Writer::Rows(rows) => rows.flush().and_then(OutputFile::keep),
            Writer::Arrays(_) => Err(std::io::ErrorKind::Unsupported.into()),
        };
        let file = file.map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        Ok(KeptEvents { file, passed: self.filter.passed() })
    }

    /// The file, whole but for its final name.
    pub fn finish(self) -> Result<OutputFile, OutputError> {
        let finished = match self.writer {
            Writer::Rows(rows) => rows.finish(),
            Writer::Arrays(arrays) => arrays.finish(),
        };
        finished.map_err(|source| OutputError::Write { path: self.path, source })
    }
}
