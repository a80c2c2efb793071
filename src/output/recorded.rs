//! Recorded: the frames of a run that were written before, one after the other.

mod arrays;
mod bodies;
mod dump;
mod lines;
mod table;
mod xyz;
mod zip;

use core::fmt;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::FrameFormat;
use crate::bodies::Bodies;
use crate::observe::Moment;
use crate::space::PeriodicBox;

use arrays::Arrays;
use lines::Lines;
use table::Rows;

/// The bodies at one time of a run, as a file has them.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RecordedFrame {
    /// Time since the start, where the file has it.
    pub time: Option<f64>,
    /// All bodies.
    pub bodies: Bodies<f64>,
    /// The periodic box; `None` in open space.
    pub space: Option<PeriodicBox<f64>>,
    /// Through how many whole boxes each body has moved, where the file has it.
    pub images: Option<Vec<[i32; 3]>>,
}

impl RecordedFrame {
    /// What an analysis looks at.
    #[must_use]
    pub fn moment(&self, time: f64) -> Moment<'_> {
        let Self { bodies, space, images, .. } = self;
        Moment { time, bodies, space: *space, images: images.as_deref() }
    }
}

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FramePlace {
    /// In the file as a whole.
    File,
    /// On a line, from 1.
    Line(u64),
    /// At a byte, from 0.
    Byte(u64),
}

impl fmt::Display for FramePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, ": byte {byte}"),
        }
    }
}

/// Why frames cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}{place}: {problem}", path.display())]
#[non_exhaustive]
pub struct FrameError {
    /// The file.
    pub path: PathBuf,
    /// Where in it.
    pub place: FramePlace,
    /// What is wrong, and what would be right.
    pub problem: String,
}

/// What is wrong at a place, before the file is named.
#[derive(Debug)]
struct Wrong {
    place: FramePlace,
    problem: String,
}

impl Wrong {
    fn new(place: FramePlace, problem: impl Into<String>) -> Self {
        Self { place, problem: problem.into() }
    }

    fn unreadable(place: FramePlace, error: &io::Error) -> Self {
        Self::new(place, format!("cannot be read: {error}"))
    }
}

/// Reads frames that a run has recorded: `.dump`, `.lammpstrj`, `.xyz`, `.extxyz`, `.npz` or
/// `.parquet`, as carom or another program wrote them.
///
/// ```
/// use carom::Bodies;
/// use carom::output::{Frame, FrameFormat, FrameReader, FrameWriter};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("run.xyz");
/// let bodies = Bodies::from_positions(&[[0.5, 0.0, 2.0]]).radius(0.5).build()?;
/// let mut writer = FrameWriter::new(FrameFormat::Xyz, &path, std::fs::File::create(&path)?)?;
/// writer.write(&Frame { time: 1.5, step: 0, bodies: &bodies, space: None, images: None, numbers: None })?;
/// writer.finish()?;
/// for frame in FrameReader::open(&path)? {
///     let frame = frame?;
///     assert_eq!((frame.time, frame.bodies.position_of(0).z), (Some(1.5), 2.0));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FrameReader {
    path: PathBuf,
    source: Source,
    /// Of the frame before.
    bodies: Option<usize>,
    in_full: bool,
    is_over: bool,
}

#[derive(Debug)]
enum Source {
    Dump(Lines),
    Xyz(Lines),
    NumPy(Box<Arrays>),
    Parquet(Box<Rows>),
}

impl FrameReader {
    /// What can be read.
    pub const ENDINGS: &'static str = ".dump, .lammpstrj, .xyz, .extxyz, .npz or .parquet";

    /// Opens a file, whose ending says what it is.
    ///
    /// # Errors
    /// If it cannot be read, or is none of these.
    pub fn open(path: &Path) -> Result<Self, FrameError> {
        let format = FrameFormat::of(path);
        let source = match format {
            Some(FrameFormat::Dump) => Lines::open(path).map(Source::Dump),
            Some(FrameFormat::Xyz) => Lines::open(path).map(Source::Xyz),
            Some(FrameFormat::NumPy) => Arrays::open(path).map(|it| Source::NumPy(Box::new(it))),
            Some(FrameFormat::Parquet) => Rows::open(path).map(|it| Source::Parquet(Box::new(it))),
            _ => {
                let problem = format!("its ending must be {}", Self::ENDINGS);
                Err(Wrong::new(FramePlace::File, problem))
            }
        };
        let path = path.to_path_buf();
        match source {
            Ok(source) => Ok(Self { path, source, bodies: None, in_full: false, is_over: false }),
            Err(Wrong { place, problem }) => Err(FrameError { path, place, problem }),
        }
    }

    /// Reads spins and orientations too, where the file has them, and takes frames of other
    /// numbers of bodies than the first one: for pictures.
    #[must_use]
    pub fn in_full(self) -> Self {
        Self { in_full: true, ..self }
    }

    fn read(&mut self) -> Result<Option<RecordedFrame>, Wrong> {
        let in_full = self.in_full;
        let (frame, place) = match &mut self.source {
            Source::Dump(lines) => (dump::read(lines, in_full)?, lines.place()),
            Source::Xyz(lines) => (xyz::read(lines, in_full)?, lines.place()),
            Source::NumPy(arrays) => (arrays.read(in_full)?, FramePlace::File),
            Source::Parquet(rows) => (rows.read(in_full)?, FramePlace::File),
        };
        let Some(frame) = frame else { return Ok(None) };
        let count = frame.bodies.len();
        let before = *self.bodies.get_or_insert(count);
        if before != count && !in_full {
            let problem = format!("a frame of {count} bodies comes after one of {before}");
            return Err(Wrong::new(place, problem));
        }
        Ok(Some(frame))
    }
}

impl Iterator for FrameReader {
    type Item = Result<RecordedFrame, FrameError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let read = self.read().map_err(|Wrong { place, problem }| FrameError {
            path: self.path.clone(),
            place,
            problem,
        });
        self.is_over = !matches!(read, Ok(Some(_)));
        read.transpose()
    }
}
