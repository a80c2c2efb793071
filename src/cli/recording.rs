//! Recording: the frames that a run writes on its way.

use std::io;
use std::path::{Path, PathBuf};

use carom::bodies::Bodies;
use carom::engine::World;
use carom::observe::Images;
use carom::output::{Frame, FrameFormat, FrameWriter};
use carom::real::Real;
use carom::scene::{EngineKind, Precision, SceneFile};
use carom::space::PeriodicBox;
use carom::study::Course;
use serde::{Deserialize, Serialize};

use super::arguments::RunArguments;
use super::asked::{Asked, Words};
use super::failure::Failure;
use super::output_file::{KeptFile, OutputError, OutputFile};
use super::pace::{KeptPace, Pace};

/// What they are called.
const WORDS: Words = Words { things: "frames", option: "--record", table: "record" };

/// What is to be written, and how often.
#[derive(Clone, Debug)]
pub struct Recording {
    pub asked: Asked,
    pub format: FrameFormat,
    /// What the frames are of: names and values.
    notes: [(&'static str, String); 2],
}

impl Recording {
    /// What the options ask, and in their place the scene.
    pub fn of(
        arguments: &RunArguments,
        file: &SceneFile,
        duration: f64,
    ) -> Result<Option<Self>, Failure> {
        let options = (arguments.record.as_ref(), arguments.record_every);
        let Some(asked) = Asked::of(WORDS, options, file.record()?, duration)? else {
            return Ok(None);
        };
        let is_kept = arguments.resume.is_some()
            || arguments.snapshot.is_some()
            || file.snapshot()?.file.is_some();
        let Some(format) = FrameFormat::of(&asked.path) else {
            let wanted = format!("its ending must be {}", FrameFormat::ENDINGS);
            return Err(asked.refused(WORDS, file, &wanted));
        };
        if !takes(format, file.precision) {
            let wanted = format!(
                "its format has no type for {}; give it an ending of {TEXTS}",
                file.precision
            );
            return Err(asked.refused(WORDS, file, &wanted));
        }
        if file.has_flow() && format == FrameFormat::NumPy {
            let wanted = "spheres come and go, and an array has as many in each frame; give it an \
                          ending of .dump, .lammpstrj, .xyz, .extxyz, .pvd or .parquet";
            return Err(asked.refused(WORDS, file, wanted));
        }
        if is_kept && !format.goes_on() {
            let wanted = "arrays of NumPy are put together at the end, and frames of a run that is \
                          kept by --snapshot, or that goes on by --resume, go into a file that can \
                          be continued: .dump, .lammpstrj, .xyz, .extxyz, .pvd or .parquet";
            return Err(asked.refused(WORDS, file, wanted));
        }
        let notes = [("scene", file.name.clone()), ("seed", file.seed.to_string())];
        Ok(Some(Self { asked, format, notes }))
    }
}

/// The endings of formats of text.
const TEXTS: &str = ".dump, .lammpstrj, .xyz or .extxyz";

/// Whether a format has numbers of a precision: bytes have types, and none for double-double.
fn takes(format: FrameFormat, precision: Precision) -> bool {
    let is_text = matches!(format, FrameFormat::Dump | FrameFormat::Xyz);
    is_text || precision != Precision::DoubleDouble
}

/// How the state of a path is written: `None` for comma-separated values, which files
/// without an ending hold, devices and pipes among them.
pub fn state_format(path: &Path, precision: Precision) -> Result<Option<FrameFormat>, Failure> {
    match FrameFormat::of(path) {
        Some(format) if !takes(format, precision) => Err(Failure::Argument(format!(
            "--state is {}; its format has no type for {precision}, which keeps all its digits in \
             .csv, and others in {TEXTS}",
            path.display()
        ))),
        None if path.extension().is_none_or(|ending| ending == "csv") => Ok(None),
        Some(format) => Ok(Some(format)),
        None => Err(Failure::Argument(format!(
            "--state is {}; its ending must be .csv, {}",
            path.display(),
            FrameFormat::ENDINGS
        ))),
    }
}

/// Frames of a run that was kept.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct KeptFrames {
    pub file: Option<KeptFile>,
    pace: KeptPace,
    frames: u64,
    /// What the writer needs besides.
    format: Vec<u8>,
}

/// Frames under way.
pub struct Recorder {
    path: PathBuf,
    pace: Pace,
    writer: FrameWriter<OutputFile>,
    frames: u64,
}

impl Recorder {
    /// Frames of a world into an open file, after those that were kept.
    pub fn new<T: Real>(
        recording: &Recording,
        file: OutputFile,
        world: &World<T>,
        course: &Course,
        kept: Option<&KeptFrames>,
    ) -> Result<Self, OutputError> {
        let path = recording.asked.path.clone();
        let format = recording.format;
        let writer = match kept.filter(|_| file.is_begun()) {
            None => FrameWriter::new(format, &path, file),
            Some(kept) => FrameWriter::resume(format, &path, file, &kept.format),
        };
        let mut writer = match writer {
            Ok(writer) => writer,
            Err(gone) if gone.kind() == io::ErrorKind::NotFound => {
                return Err(OutputError::Path { path, reason: gone.to_string() });
            }
            Err(source) => return Err(OutputError::Write { path, source }),
        };
        for (name, value) in &recording.notes {
            writer.note(name, value);
        }
        let every = recording.asked.every;
        let pace = Pace::new(world, course, every, 0.0, kept.map(|kept| kept.pace));
        let kept = kept.filter(|kept| kept.pace.is_every(every));
        let frames = kept.map_or(0, |kept| kept.frames);
        Ok(Self { path, pace, writer, frames })
    }

    /// Where the next frame is due.
    pub fn mark(&self) -> Option<f64> {
        self.pace.mark()
    }

    /// Writes the bodies down, at the place where they are due.
    pub fn write<T: Real>(
        &mut self,
        world: &World<T>,
        bodies: &Bodies<T>,
        space: Option<PeriodicBox<T>>,
        images: Option<&Images<T>>,
    ) -> Result<(), OutputError> {
        let step = match world.plan().engine {
            EngineKind::Stepped => world.steps(),
            _ => self.frames,
        };
        let numbers = world.has_flow().then(|| world.numbers());
        let numbers = numbers.as_deref();
        let frame = Frame { time: world.time(), step, bodies, space, images, numbers };
        let written = self.writer.write(&frame);
        written.map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        self.frames += 1;
        self.pace.pass(Course::position(world));
        Ok(())
    }

    /// Brings all frames so far to the disk, and says what is to be remembered.
    pub fn keep(&mut self) -> Result<KeptFrames, OutputError> {
        let kept = self.writer.keep().and_then(|(file, format)| Ok((file.keep()?, format)));
        let (file, format) =
            kept.map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        Ok(KeptFrames { file, pace: self.pace.kept(), frames: self.frames, format })
    }

    /// The file, whole but for its final name.
    pub fn finish(self) -> Result<OutputFile, OutputError> {
        self.writer.finish().map_err(|source| OutputError::Write { path: self.path, source })
    }
}
