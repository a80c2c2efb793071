//! Recording: the frames that a run writes on its way.

use std::path::{Path, PathBuf};

use carom::bodies::Bodies;
use carom::engine::World;
use carom::observe::Images;
use carom::output::{Frame, FrameFormat, FrameWriter};
use carom::real::Real;
use carom::scene::{EngineKind, SceneFile};
use carom::space::PeriodicBox;
use carom::study::{Course, Schedule};

use super::arguments::RunArguments;
use super::failure::Failure;
use super::output_file::{OutputError, OutputFile};

/// The most times that something is written on the way.
const MOST_TIMES: f64 = 1e7;

/// What is to be written, and how often.
#[derive(Debug)]
pub struct Recording {
    pub path: PathBuf,
    pub format: FrameFormat,
    pub every: f64,
}

impl Recording {
    /// What the options ask, and in their place the scene.
    pub fn of(
        arguments: &RunArguments,
        file: &SceneFile,
        duration: f64,
    ) -> Result<Option<Self>, Failure> {
        let scene = file.record()?;
        let every = arguments.record_every.or(scene.every);
        let path = arguments.record.clone().or_else(|| scene.file.clone());
        let (path, every) = match (path, every) {
            (None, None) => return Ok(None),
            (Some(path), Some(every)) => (path, every),
            (path, _) => {
                let missing = if path.is_none() { "file" } else { "time between them" };
                return Err(Failure::Argument(format!(
                    "frames are asked for, but no {missing}; give --record FILE and \
                     --record-every TIME, or `file` and `every` under [record]"
                )));
            }
        };
        let times = duration / every;
        if times > MOST_TIMES {
            return Err(Failure::Argument(format!(
                "a frame every {every:?} would be {times:.1e} of them until {duration:?}, more \
                 than {MOST_TIMES:e}; take a longer time between frames (--record-every)"
            )));
        }
        let wanted = format!("its ending must be {}", FrameFormat::ENDINGS);
        match FrameFormat::of(&path) {
            Some(format) => Ok(Some(Self { path, format, every })),
            None if arguments.record.is_some() => {
                Err(Failure::Argument(format!("--record is {}; {wanted}", path.display())))
            }
            None => {
                let found = format!("{:?}", path.display().to_string());
                Err(file.mistake("record.file", &found, &wanted).into())
            }
        }
    }
}

/// How the state of a path is written: `None` for comma-separated values, which files
/// without an ending hold, devices and pipes among them.
pub fn state_format(path: &Path) -> Result<Option<FrameFormat>, Failure> {
    match FrameFormat::of(path) {
        None if path.extension().is_none_or(|ending| ending == "csv") => Ok(None),
        Some(format) => Ok(Some(format)),
        None => Err(Failure::Argument(format!(
            "--state is {}; its ending must be .csv, {}",
            path.display(),
            FrameFormat::ENDINGS
        ))),
    }
}

/// Frames under way.
pub struct Recorder {
    path: PathBuf,
    schedule: Schedule,
    writer: FrameWriter<OutputFile>,
    frames: u64,
}

impl Recorder {
    /// Frames of a world into an open file.
    pub fn new<T: Real>(
        recording: &Recording,
        file: OutputFile,
        world: &World<T>,
        course: &Course,
    ) -> Result<Self, OutputError> {
        let path = recording.path.clone();
        let writer = match FrameWriter::new(recording.format, &path, file) {
            Ok(writer) => writer,
            Err(source) => return Err(OutputError::Write { path, source }),
        };
        let schedule = Schedule::new(world, course, recording.every);
        Ok(Self { path, schedule, writer, frames: 0 })
    }

    /// Where the next frame is due.
    pub fn mark(&self) -> Option<f64> {
        self.schedule.mark()
    }

    /// Writes the bodies down if they are due.
    pub fn look<T: Real>(
        &mut self,
        world: &World<T>,
        bodies: &Bodies<T>,
        space: Option<PeriodicBox<T>>,
        images: Option<&Images<T>>,
    ) -> Result<(), OutputError> {
        let position = Course::position(world);
        if self.mark() != Some(position) {
            return Ok(());
        }
        let step = match world.plan().engine {
            EngineKind::Stepped => world.steps(),
            _ => self.frames,
        };
        let frame = Frame { time: world.time(), step, bodies, space, images };
        let written = self.writer.write(&frame);
        written.map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        self.frames += 1;
        self.schedule.pass(position);
        Ok(())
    }

    /// The file, whole but for its final name.
    pub fn finish(self) -> Result<OutputFile, OutputError> {
        self.writer.finish().map_err(|source| OutputError::Write { path: self.path, source })
    }
}
