//! `carom study`: the studies, from their arguments to their folders.

mod error;
mod precision;
mod scaling;
mod stability;
pub mod watch;

use std::path::{Path, PathBuf};

use carom::scene::SceneFile;
use carom::study::{Folder, Report, Study};
use clap::{Args, Subcommand};

use super::arguments::{SceneArguments, positive};
use super::failure::Failure;
use super::pictures::PictureLook;
use super::print;
use super::scene_argument::scene_file;
use watch::Teller;

/// The studies.
#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Run time against error: what each method costs in a scene, and how far
    /// off it is.
    ///
    /// Engines, integrators, impacts, steps, precisions, lanes and threads are
    /// compared from the same start with a run in double-double at exact times.
    /// The report has the orders of convergence and the fastest method for each
    /// size of the error; the folder has tables and a work-precision diagram.
    #[command(after_help = "\
Examples:
  carom study error superball                     all methods
  carom study error gas.toml --times 0.5,1,2      at these times
  carom study error gas.toml --precision f64 --dt 1e-2,1e-3,1e-4
  carom study error rough-gas --lanes scalar,4,8,16,auto --threads 1,2
  carom study error bouncing-ball --of energy     judged by the energy
  carom study error box.toml --norm max           by the sphere that is farthest off")]
    Error(error::ErrorArguments),
    /// The stress suite: extremes and long runs against the laws that should hold.
    ///
    /// Each case has a law, from a known solution or from theory, and is measured
    /// and judged in f32 and f64. All of it takes about ten minutes on two cores.
    #[command(after_help = "\
Examples:
  carom study stability                    all cases
  carom study stability --quick            a hundredth of them, in a minute
  carom study stability galperin cradle    these two
  carom study stability --list             what there is

A figure that does not hold is a finding, and no failure of the program: exit
status 0.")]
    Stability(stability::StabilityArguments),
    /// Time and memory against the number of bodies, threads and lanes.
    ///
    /// The scene is made larger and smaller at the density that it has: the
    /// counts of its groups are multiplied, and its places dilated about the
    /// origin. What is compared is run in turn, so that another program on the
    /// machine slows all of it; and all of it has to end in the same bits.
    #[command(after_help = "\
Examples:
  carom study scaling rough-gas                    a thousand to 100,000 bodies
  carom study scaling gas.toml --bodies 1000,1000000 --lanes auto
                                                   two sizes, and no lanes
  carom study scaling gas.toml --threads 1,2,4,8   what threads give
  carom study scaling hard-sphere-fluid            time per collision, on the one
                                                   thread that this engine has

Exit status: 0 done, 2 a mistake in the arguments or the scene, 1 otherwise.")]
    Scaling(scaling::ScalingArguments),
    /// Find out what precision a scene needs: f32 and f64 beside double-double.
    ///
    /// How trajectories diverge and when they are lost, the first collision out
    /// of order, how invariants drift, and what averages lose.
    #[command(after_help = "\
Examples:
  carom study precision gas.toml                           by the scene's own engine
  carom study precision hard-sphere-fluid --duration 2     for a shorter time
  carom study precision mixture --engine event-driven      by the other engine
  carom study precision gas.toml --runs 32                 sharper laws of drift

Writes precision.csv, precision.json, report.txt, divergence.svg and drift.svg,
both also as .png, and scene.toml into its folder.")]
    Precision(precision::PrecisionArguments),
}

impl StudyCommand {
    /// Makes the study.
    pub fn run(self) -> Result<(), Failure> {
        match self {
            Self::Error(arguments) => arguments.run(),
            Self::Scaling(arguments) => arguments.run(),
            Self::Precision(arguments) => arguments.run(),
            Self::Stability(arguments) => arguments.run(),
        }
    }
}

/// Which scene is studied.
#[derive(Args, Debug)]
pub struct StudiedScene {
    /// A scene file, or the name of a built-in scene
    pub scene: PathBuf,

    /// How long to simulate, in the scene's unit of time; the scene says it
    /// otherwise
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    pub duration: Option<f64>,

    /// Seed of the scene's random numbers
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// Put a value in the place of the scene file's, as spheres[0].radius=0.4 or
    /// surface.kind=rough; can be given many times
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl StudiedScene {
    /// Reads the scene.
    pub fn file(&self) -> Result<SceneFile, Failure> {
        let file = scene_file(&SceneArguments {
            scene: Some(self.scene.clone()),
            duration: self.duration,
            seed: self.seed,
            set: self.set.clone(),
            ..SceneArguments::default()
        })?;
        refuse_flow(&file, "a study")?;
        Ok(file)
    }
}

/// Refuses a scene where spheres come or go.
pub fn refuse_flow(file: &SceneFile, what: &str) -> Result<(), Failure> {
    if !file.has_flow() {
        return Ok(());
    }
    Err(Failure::Argument(format!(
        "{}: spheres come or go in it, and {what} compares the same spheres at its ends; leave out \
         [[inlet]] and `removes`, or use carom run or carom sweep",
        file.name
    )))
}

/// Where the results go.
#[derive(Args, Debug)]
pub struct StudyFolder {
    /// The folder for tables, pictures and finished points [default: study-…
    /// with the names of the study and the scene]
    #[arg(long, value_name = "FOLDER")]
    output: Option<PathBuf>,

    /// Forget what is in the folder, and begin again
    #[arg(long)]
    restart: bool,
}

impl StudyFolder {
    /// The folder, without the points that are to be forgotten.
    pub fn open(&self, default: &str) -> Result<Folder, Failure> {
        let folder = Folder::open(self.output.as_deref().unwrap_or(Path::new(default)))?;
        if self.restart {
            folder.forget()?;
        }
        Ok(folder)
    }
}

/// Where the results of a study go, and what its pictures look like.
#[derive(Args, Debug)]
pub struct StudyOutput {
    #[command(flatten)]
    folder: StudyFolder,

    #[command(flatten)]
    pictures: PictureLook,
}

impl StudyOutput {
    /// Makes a study, writes all that it found, and prints its report.
    pub fn conduct(&self, study: &impl Study) -> Result<(), Failure> {
        let folder = self.folder.open(&study.folder())?;
        let path = folder.path().display();
        let teller = Teller::new(folder.path());
        let report = study.measure(&study.journal(&folder)?, &teller)?;
        drop(teller);
        report.write(&folder, &self.pictures.look())?;
        print(&format!("{report}\nTables and pictures are in {path}.\n"))?;
        Ok(report.verdict()?)
    }
}
