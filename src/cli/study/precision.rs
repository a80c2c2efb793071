//! `carom study precision`: the same scene in three precisions.

use carom::scene::EngineKind;
use carom::study::precision::{MOST_RUNS, PrecisionStudy};
use clap::Args;

use super::{StudiedScene, StudyFolder};
use crate::cli::arguments::{ENGINES, one_of};
use crate::cli::failure::Failure;

/// What `carom study precision` takes.
#[derive(Args, Debug)]
pub struct PrecisionArguments {
    #[command(flatten)]
    scene: StudiedScene,

    /// Steps of fixed length, or every collision at its exact time; the scene
    /// says it otherwise
    #[arg(long, value_parser = one_of(&ENGINES))]
    engine: Option<EngineKind>,

    #[arg(
        long,
        value_name = "N",
        default_value_t = 8,
        allow_negative_numbers = true,
        help = format!("Runs of each precision, for the laws of the drifts; up to {MOST_RUNS}")
    )]
    runs: u64,

    /// Into how many parts the time is divided
    #[arg(long, value_name = "N", default_value_t = 128, allow_negative_numbers = true)]
    samples: u64,

    #[command(flatten)]
    folder: StudyFolder,
}

impl PrecisionArguments {
    /// Makes the study.
    pub fn run(&self) -> Result<(), Failure> {
        let mut file = self.scene.file()?;
        if let Some(engine) = self.engine {
            file.engine = engine;
        }
        self.folder.conduct(&PrecisionStudy::new(&file, self.runs, self.samples)?)
    }
}
