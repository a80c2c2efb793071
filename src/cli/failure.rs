//! Failure: why the program ends without having done what it was asked to.

use std::io;
use std::path::PathBuf;

use carom::engine::EngineError;
use carom::observe::Standstill;
use carom::output::FrameError;
use carom::scene::EngineKind;
use carom::scene::SceneError;
use carom::study::StudyError;
use thiserror::Error;

use super::output_file::OutputError;

/// Why the program ends early. Its text is the one message.
#[derive(Debug, Error)]
pub enum Failure {
    /// A mistake in the scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A mistake in the arguments.
    #[error("{0}")]
    Argument(String),
    /// A file that an option names and that cannot be written.
    #[error("{option}: {source}")]
    Open {
        /// The option.
        option: &'static str,
        /// Why.
        source: OutputError,
    },
    /// Frames that cannot be read.
    #[error(transparent)]
    Frames(#[from] FrameError),
    /// The engine cannot run the scene.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A file could not be written to its end.
    #[error(transparent)]
    Write(#[from] OutputError),
    /// A study could not be made.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Standard output took no more.
    #[error("standard output could not be written: {0}")]
    Print(io::Error),
    /// The event-driven engine does not get on.
    #[error(
        "time stands still at {time:?}: {events} events in a row without progress, the last one of \
         sphere {body}; {why}"
    )]
    Stalled {
        /// Simulated time.
        time: f64,
        /// Events since time last advanced.
        events: u64,
        /// A body that takes part.
        body: u32,
        /// How it stands, and what helps.
        why: Standstill,
    },
    /// Runs of a sweep that came to no end.
    #[error("{failed} of {runs} runs failed, as the column `failure` of {} says; the first: {first}", path.display())]
    Runs {
        /// How many failed.
        failed: usize,
        /// Of how many.
        runs: usize,
        /// The table of the runs.
        path: PathBuf,
        /// Why the first did.
        first: String,
    },
    /// A snapshot that a run cannot go on from.
    #[error("--resume: {}: {reason}", path.display())]
    Resume {
        /// The file.
        path: PathBuf,
        /// Why, and what would be right.
        reason: String,
    },
    /// The run was asked to end, and has kept itself.
    #[error("{words}")]
    Kept {
        /// The status that it ends with.
        status: u8,
        /// Where it is kept, and how to go on.
        words: String,
    },
    /// The motion has left the numbers.
    #[error(
        "at time {time:?} {what}; nothing was written. {}--precision f64, or units in which lengths, \
         speeds and times are nearer to 1, may keep it in range",
        match engine { EngineKind::Stepped => "A smaller --dt, ", _ => "" }
    )]
    NotFinite {
        /// Simulated time.
        time: f64,
        /// What is no longer finite, as a sentence.
        what: String,
        /// The engine that moved it.
        engine: EngineKind,
    },
}

impl Failure {
    /// 2 for a mistake in the arguments or the scene, 1 for anything else.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Scene(_) | Self::Argument(_) | Self::Open { .. } | Self::Resume { .. } => 2,
            Self::Kept { status, .. } => *status,
            Self::Study(error) => match error {
                StudyError::Scene(_)
                | StudyError::Asked(_)
                | StudyError::AnotherStudy(_)
                | StudyError::NoFolder { .. } => 2,
                _ => 1,
            },
            Self::Engine(_)
            | Self::Stalled { .. }
            | Self::Runs { .. }
            | Self::Write(_)
            | Self::Print(_)
            | Self::Frames(_)
            | Self::NotFinite { .. } => 1,
        }
    }

    /// Whether the reader of the output went away, which is no error.
    pub fn is_closed_pipe(&self) -> bool {
        match self {
            Self::Print(error) => error.kind() == io::ErrorKind::BrokenPipe,
            Self::Write(error) => error.is_closed_pipe(),
            _ => false,
        }
    }
}
