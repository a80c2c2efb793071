//! Frames: the bodies at times of a run, in the formats of the programs that people
//! look at trajectories with. One file a format.

mod columns;
mod dump;
mod figures;
mod paraview;
mod rows;
mod table;
mod xyz;

pub use figures::quaternion_of;

use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::bodies::Bodies;
use crate::observe::{Images, not_finite};
use crate::real::Real;
use crate::space::PeriodicBox;

use columns::NumPy;
use paraview::ParaView;
use table::Rows;

/// The bodies at one time of a run.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a, T: Real> {
    /// Time since the start.
    pub time: f64,
    /// Steps taken; of a run without steps, the number of the frame.
    pub step: u64,
    /// All bodies, in the scene's order.
    pub bodies: &'a Bodies<T>,
    /// The periodic box; `None` in open space.
    pub space: Option<PeriodicBox<T>>,
    /// Through how many whole boxes each body has moved; `None` in open space.
    pub images: Option<&'a Images<T>>,
    /// What bodies are numbered by, where some may have come or gone; `None`: from 0.
    pub numbers: Option<&'a [u64]>,
}

impl<T: Real> Frame<'_, T> {
    /// The number of the body of an index.
    fn number(&self, index: usize) -> i64 {
        self.numbers.map_or(index as i64, |numbers| numbers[index] as i64)
    }
}

/// What frames can be written as, by the ending of a file's name.
///
/// ```
/// use std::path::Path;
/// use carom::output::FrameFormat;
/// assert_eq!(FrameFormat::of(Path::new("run.dump")), Some(FrameFormat::Dump));
/// assert_eq!(FrameFormat::of(Path::new("run.vtk")), None);
/// assert!(FrameFormat::ENDINGS.contains(".pvd"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameFormat {
    /// `.dump`, `.lammpstrj`: the text dump of LAMMPS, one frame after the other.
    Dump,
    /// `.xyz`, `.extxyz`: extended XYZ, one frame after the other.
    Xyz,
    /// `.pvd`: a series of ParaView, each frame in a `.vtp` file beside it.
    ParaView,
    /// `.npz`: arrays of NumPy, one for each column, frames × bodies.
    NumPy,
    /// `.parquet`: a table of Parquet, a row for each body of a frame.
    Parquet,
}

impl FrameFormat {
    /// The endings that there are.
    pub const ENDINGS: &'static str = ".dump, .lammpstrj, .xyz, .extxyz, .pvd, .npz or .parquet";

    /// Whether frames can be added to a file that was closed.
    #[must_use]
    pub fn goes_on(self) -> bool {
        self != Self::NumPy
    }

    /// The format of a file by its ending; `None` if it is another one.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "dump" | "lammpstrj" => Some(Self::Dump),
            "xyz" | "extxyz" => Some(Self::Xyz),
            "pvd" => Some(Self::ParaView),
            "npz" => Some(Self::NumPy),
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }
}

/// Writes frames, one after the other.
///
/// ```
/// use std::path::Path;
/// use carom::Bodies;
/// use carom::output::{Frame, FrameFormat, FrameWriter};
///
/// let bodies = Bodies::from_positions(&[[0.5, 0.0, 2.0]]).radius(0.5).build()?;
/// let mut writer = FrameWriter::new(FrameFormat::Xyz, Path::new("run.xyz"), Vec::new())?;
/// writer.write(&Frame { time: 0.0, step: 0, bodies: &bodies, space: None, images: None, numbers: None })?;
/// let text = String::from_utf8(writer.finish()?)?;
/// assert!(text.starts_with("1\nLattice="));
/// assert!(text.contains("\nX 0.5 0.0 2.0 "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FrameWriter<W: io::Write> {
    format: Writer<W>,
}

#[derive(Debug)]
enum Writer<W: io::Write> {
    Dump(BufWriter<W>),
    Xyz(BufWriter<W>),
    ParaView(ParaView<W>),
    NumPy(Box<NumPy<W>>),
    Parquet(Rows<W>),
}

impl<W: io::Write> FrameWriter<W> {
    /// Frames that go to `output`, which is or becomes the file at `path`: what a format
    /// needs besides is made in the folder of that.
    ///
    /// # Errors
    /// If a file beside it cannot be made.
    pub fn new(format: FrameFormat, path: &Path, output: W) -> io::Result<Self> {
        let buffer = |output| BufWriter::with_capacity(1 << 18, output);
        Ok(Self {
            format: match format {
                FrameFormat::Dump => Writer::Dump(buffer(output)),
                FrameFormat::Xyz => Writer::Xyz(buffer(output)),
                FrameFormat::ParaView => Writer::ParaView(ParaView::new(path, output)?),
                FrameFormat::NumPy => Writer::NumPy(Box::new(NumPy::new(path, output)?)),
                FrameFormat::Parquet => Writer::Parquet(Rows::new(output)),
            },
        })
    }

    /// Frames behind those that `output` has, of which [`keep`](Self::keep) has said
    /// something.
    ///
    /// # Errors
    /// If this is not what it has said, if a file beside it is gone, or if frames of the format
    /// cannot [go on](FrameFormat::goes_on).
    pub fn resume(format: FrameFormat, path: &Path, output: W, kept: &[u8]) -> io::Result<Self> {
        match format {
            FrameFormat::Dump | FrameFormat::Xyz => Self::new(format, path, output),
            FrameFormat::ParaView => {
                let series = ParaView::resume(path, output, kept)?;
                Ok(Self { format: Writer::ParaView(series) })
            }
            FrameFormat::NumPy => Err(io::ErrorKind::Unsupported.into()),
            FrameFormat::Parquet => {
                Ok(Self { format: Writer::Parquet(Rows::resume(output, kept)?) })
            }
        }
    }

    /// Says something of the frames as a whole, in the format that has a place for it: Parquet.
    pub fn note(&mut self, name: &str, value: &str) {
        if let Writer::Parquet(rows) = &mut self.format {
            rows.note(name, value.to_owned());
        }
    }

    /// Writes one more frame.
    ///
    /// # Errors
    /// If the output takes no more, or if a figure of a body is [no finite
    /// number](not_finite), before anything of the frame is written.
    pub fn write<T: Real>(&mut self, frame: &Frame<'_, T>) -> io::Result<()> {
        if let Some(found) = not_finite(frame.bodies) {
            return Err(io::Error::new(io::ErrorKind::InvalidData, found.to_string()));
        }
        match &mut self.format {
            Writer::Dump(output) => dump::write(output, frame),
            Writer::Xyz(output) => xyz::write(output, frame),
            Writer::ParaView(series) => series.write(frame),
            Writer::NumPy(columns) => columns.write(frame),
            Writer::Parquet(rows) => rows.write(frame),
        }
    }

    /// Hands all frames so far on to the output, and says what [`resume`](Self::resume) needs to
    /// [go on](FrameFormat::goes_on) behind them.
    ///
    /// # Errors
    /// If the output takes no more, or the format cannot go on.
    pub fn keep(&mut self) -> io::Result<(&W, Vec<u8>)> {
        match &mut self.format {
            Writer::Dump(output) | Writer::Xyz(output) => {
                output.flush()?;
                Ok((output.get_ref(), Vec::new()))
            }
            Writer::ParaView(series) => series.keep(),
            Writer::NumPy(_) => Err(io::ErrorKind::Unsupported.into()),
            Writer::Parquet(rows) => rows.keep(),
        }
    }

    /// Writes what is left, and gives the output back.
    ///
    /// # Errors
    /// If the output takes no more.
    pub fn finish(self) -> io::Result<W> {
        let whole =
            |output: BufWriter<W>| output.into_inner().map_err(io::IntoInnerError::into_error);
        match self.format {
            Writer::Dump(output) | Writer::Xyz(output) => whole(output),
            Writer::ParaView(series) => series.finish(),
            Writer::NumPy(columns) => columns.finish(),
            Writer::Parquet(rows) => rows.finish(),
        }
    }
}
