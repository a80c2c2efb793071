//! What goes wrong in a study.

use std::io;
use std::path::PathBuf;

use crate::engine::EngineError;
use crate::scene::SceneError;

/// Why a study ends early.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A mistake in the scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// An engine can't run the scene.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A mistake in what the study was asked for.
    #[error("{0}")]
    Asked(String),
    /// A file of the study's folder.
    #[error("{}: {source}", path.display())]
    File {
        /// Which one.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The folder has results already, and not of this study.
    #[error(
        "{} has the results of another study, scene or version of carom; give this one a folder \
         of its own with --output, or remove that file",
        .0.display()
    )]
    AnotherStudy(PathBuf),
    /// Another process makes a study in the folder.
    #[error(
        "{}: a study is under way there, in {}; wait for its end, or give this one a folder of its \
         own with --output",
        path.display(),
        process.map_or_else(|| "another process".to_owned(), |number| format!("process {number}"))
    )]
    UnderWay {
        /// The folder.
        path: PathBuf,
        /// The number of the process, if it is known.
        process: Option<u32>,
    },
    /// A line of the journal is not what a study writes.
    #[error(
        "{}:{line}: this is no result of a study: {reason}; mend or remove the line, or take \
         --restart, which forgets all results of this folder",
        path.display()
    )]
    Damaged {
        /// The journal.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// Lanes or threads, which change no bit of a result, have changed some.
    #[error("{0}: this is a mistake in carom, please report it with the scene and the machine")]
    DifferentBits(String),
    /// There can be no folder at the path.
    #[error("{} cannot be written: {reason}", path.display())]
    NoFolder {
        /// The path as it was given.
        path: PathBuf,
        /// Why, and what would be right.
        reason: String,
    },
    /// A picture could not be drawn.
    #[error("{} could not be drawn: {reason}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}
