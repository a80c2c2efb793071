//! The arguments that the program takes.

mod drawn;

use core::ops::RangeInclusive;
use std::path::PathBuf;

use carom::engine::{Execution, Lanes, MOST_THREADS, Order};
use carom::output::{FrameFormat, FrameReader};
use carom::scene::EngineKind;
use carom::scene::{AnalysisKind, DEFAULT_SCENE, Precision};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;

use super::analyse::KINDS;
use super::events::bodies;
use super::study::{StudyCommand, StudyFolder};
use super::variation::MOST_RUNS;

pub use drawn::{PictureArguments, PlotArguments, ViewArguments};

/// Simulates rigid spheres in motion: free flight and elastic collisions,
/// smooth and rough, with the same bits on every path.
#[derive(Debug, Parser)]
#[command(
    name = "carom",
    version,
    after_help = "\
Examples:
  carom                                 run the built-in default scene
  carom run superball --precision f32   run another built-in scene, in f32
  carom run pi --events e.csv           every collision at its exact time
  carom scenes rough-gas > gas.toml     start a scene file of your own
  carom run gas.toml --events e.csv     run it and write down every collision
  carom explain gas.toml                what the engine does for it, and skips
  carom analyse gas.npz                 what recorded frames amount to
  carom plot gas.csv                    draw a time series of a run
  carom picture gas.toml -o gas.svg     draw its spheres
  carom view gas.toml                   play its motion in a browser: gas.html
  carom sweep gas.toml --vary spheres[0].radius=0.1:0.3:5   a run for each value
  carom batch gas.toml --count 10000 --output gas.csv   a run for each of many seeds
  carom study error gas.toml            what each method costs, and its error

Without a command, `carom` does what `carom run` does."
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene and print a summary.
    #[command(after_help = "\
Examples:
  carom run                                      the built-in default scene
  carom run newtons-cradle --dt 1e-4             a built-in scene, other steps
  carom run gas.toml --engine event-driven       without steps, exactly
  carom run gas.toml --state end.csv             a scene file; write the end
  carom run gas.toml --events e.csv --threads 1  write down every collision
  carom run gas.toml --events e.npz --events-from 5 --events-every 100 --events-of 0-9
                                                 some of them, as arrays of NumPy
  carom run gas.toml --record gas.dump --record-every 0.1   frames of it for OVITO
  carom run gas.toml --record gas.parquet --record-every 0.1   a row a body and frame, for pandas
  carom run gas.toml --series gas.csv --series-every 0.1   figures of it in time
  carom run gas.toml --snapshot gas.snapshot --snapshot-wall 10   keep the run
  carom run --resume gas.snapshot --duration 20            and go on with it
  carom run gas.toml --set spheres[0].radius=0.4 --set surface.kind=smooth
                                                 other values of its keys
  carom run gas.toml --json | jq .energy         the summary for a program

A scene takes spheres from a state file by spheres = { file = \"end.csv\" }.
Lanes and threads change the time of a run, and no bit of its result.
Exit status: 0 done, 2 a mistake in the arguments or the scene, 1 otherwise;
130, 143 or 129 if it is ended by Ctrl-C, TERM or HUP.")]
    Run(RunArguments),
    /// Print what the engine does for a scene, and what it skips.
    #[command(after_help = "\
Examples:
  carom explain                              the built-in default scene
  carom explain free-flight --precision f32  a built-in scene in f32
  carom explain gas.toml --lanes 8           a scene file in eight lanes
  carom explain gas.toml --engine event-driven  the same for the other engine")]
    Explain(SceneArguments),
    /// List the built-in scenes, or print one as a file to start from.
    #[command(after_help = "\
Examples:
  carom scenes                          list them
  carom scenes rough-gas > gas.toml     start a file of your own from one
  carom run gas.toml                    and run it
  carom scenes --schema > carom.schema.json   let an editor check and complete it

With #:schema ./carom.schema.json as its first line, editors that know TOML by taplo (Even
Better TOML, Helix, Neovim) check a scene file as it is written.")]
    Scenes {
        /// The built-in scene to print.
        name: Option<String>,

        /// Print the JSON Schema of scene files, for editors.
        #[arg(long, conflicts_with = "name")]
        schema: bool,
    },
    /// Find in recorded frames how bodies are arranged, and how they move.
    ///
    /// Each kind goes into a file of comma-separated values, with its statistical errors.
    /// `[[analyse]]` in a scene does the same on the way of a run, without frames, and knows
    /// collisions besides.
    #[command(after_help = "\
Examples:
  carom run gas.toml --record gas.npz --record-every 0.05
  carom analyse gas.npz                 all kinds, gas-radial-distribution.csv and others
  carom analyse gas.npz --kind radial-distribution --range 4 --bins 400 --plot
  carom analyse gas.npz --kind mean-squared-displacement,velocity-autocorrelation --from 5
  carom analyse gas.dump --every 0.05   a dump has no times
  carom analyse mix.xyz --kind radial-distribution --species 1,2

Exit status: 0 done, 2 a mistake in the arguments, 1 for frames that cannot be read.")]
    Analyse(AnalyseArguments),
    /// Draw the columns of a table against its first one, or how their values are distributed.
    #[command(after_help = "\
Examples:
  carom run gas.toml --series gas.csv --series-every 0.1
  carom plot gas.csv                    draws gas.svg
  carom plot gas.csv -o energy.pdf --columns energy,kinetic,potential --width 302
  carom plot breaks.csv --histogram --columns pairs,x[0]   of the rows of a batch")]
    Plot(PlotArguments),
    /// Draw a still picture of a scene, a state or a recorded frame.
    ///
    /// Spheres are shaded, and fixed parts drawn around them: walls behind them, what would
    /// hide them by its edges.
    #[command(
        mut_arg("scene", |scene| scene.help(format!(
            "A scene file, the name of a built-in scene, a state file ending in .csv, or \
             recorded frames: {} [default: {DEFAULT_SCENE}]", FrameReader::ENDINGS
        ))),
        mut_arg("duration", |at| at.long("at").help(
            "How long a scene runs before it is drawn; of frames the first one from this time on \
             [default: the start of a scene, the last frame]"
        )),
        mut_arg("width", |width| width.default_value("640").help(
            "Width of the picture, 96 pixels to the inch; text keeps its size"
        )),
        after_help = "\
Examples:
  carom picture rough-gas               draws rough-gas.svg, the start of it
  carom picture gas.toml --at 5 -o gas.png --color speed   five units of time later
  carom picture end.csv -o end.pdf --from 1,0,0 --width 302   a state, along the x axis
  carom picture gas.npz --theme dark --perspective 30      the last of recorded frames

Exit status: 0 done, 2 a mistake in the arguments or the scene, 1 otherwise.")]
    Picture(PictureArguments),
    /// Make one HTML file that plays the motion in a browser.
    ///
    /// It needs no network and nothing beside it: spheres, fixed parts and the script are in the
    /// file. Spheres that turn have marks.
    #[command(
        mut_arg("scene", |scene| scene.help(format!(
            "A scene file, the name of a built-in scene, or recorded frames: {} \
             [default: {DEFAULT_SCENE}]", FrameReader::ENDINGS
        ))),
        after_help = "\
Examples:
  carom view superball                  runs it, and makes superball.html
  carom view gas.toml --duration 5 --frames 600 -o gas.html
  carom view gas.npz                    the frames that a run has recorded

Mouse and touch turn, move and zoom; Space plays, arrows go from frame to frame.
Exit status: 0 done, 2 a mistake in the arguments or the scene, 1 otherwise.")]
    View(ViewArguments),
    /// Run a scene once for each value of some of its keys, side by side on all cores.
    ///
    /// Each run is one row of a table; runs that differ in nothing but the seed give means
    /// with their errors. An interrupted sweep goes on where it was when it is started
    /// again, and one that is given more values or seeds keeps the runs that it has.
    #[command(after_help = "\
Examples:
  carom sweep gas.toml --vary spheres[0].radius=0.1,0.2,0.3
                                        three runs of a scene file
  carom sweep hard-sphere-fluid --vary spheres[0].number_density=0.1:0.5:5 --seeds 8
                                        five densities, each with eight seeds
  carom sweep box.toml --vary gravity=[0,0,-1],[0,0,-2] --vary stepped.dt=1e-3,1e-4
                                        each value of one with each of the other
  carom sweep gas.toml --seeds 100 --set surface.kind=rough --engine event-driven
                                        nothing but seeds

Each run has one thread, and as many go side by side as --threads says.
Writes runs.csv, means.csv, report.txt and scene.toml into its folder.
Exit status: 0 done, 2 a mistake in the arguments or the scene, 1 if a run fails or a
file cannot be written.")]
    Sweep(SweepArguments),
    /// Run a scene many times at once, each with a seed and values of its own.
    ///
    /// Each scene is one row of a table, as `carom run` with its seed and values gives it, bit
    /// by bit. Small scenes of the stepped engine with impacts at the end of a step take one
    /// lane each; others run one by one on all threads (`carom explain` says which). An
    /// interrupted batch goes on where it was when it is started again.
    #[command(after_help = "\
Examples:
  carom batch break.toml --count 100000 --output breaks.csv
                                        nothing but seeds
  carom batch break.toml --count 1000 --vary 'spheres[0].velocity=[1,0,0],[2,0,0]' --output b.csv
                                        two values in turn
  carom batch break.toml --count 1000 --vary 'spheres[0].radius=uniform(0.4,0.5)' --output b.csv
                                        a radius drawn for each scene, by its seed
  carom batch break.toml --count 1000 --observe temperature,x[0],y[0] --output b.npz
                                        figures of the end, as arrays of NumPy
  carom batch break.toml --count 100000 --output breaks.parquet
                                        for pandas, Polars, DuckDB or R

Rows have scene, seed, what is varied, state_hash, collisions, pairs, surroundings,
energy_change, what is observed, and failure: why a scene came to no end.
Exit status: 0 done, 2 a mistake in the arguments or the first scene, 1 if a scene fails or
the file cannot be written.")]
    Batch(BatchArguments),
    /// Measure what methods cost and how far off they are.
    #[command(after_help = "\
Examples:
  carom study error superball            run time against error, method by method
  carom study precision hard-sphere-fluid --duration 2  f32, f64, double-double
  carom study stability --quick          the stress suite in a minute
  carom study scaling rough-gas          time and memory against size and threads

Each writes tables and pictures into a folder, one study at a time. An
interrupted study goes on where it was when it is started again.")]
    Study {
        #[command(subcommand)]
        study: StudyCommand,
    },
    /// Print what a shell needs to complete commands and options.
    #[command(after_help = "\
Examples:
  carom completions bash > ~/.local/share/bash-completion/completions/carom
  carom completions zsh > ~/.zfunc/_carom      in a folder of $fpath
  carom completions fish > ~/.config/fish/completions/carom.fish")]
    Completions {
        /// The shell.
        shell: Shell,
    },
}

/// Which scene, and how it is run.
#[derive(Args, Debug, Default)]
pub struct SceneArguments {
    #[arg(help = format!(
        "A scene file, or the name of a built-in scene [default: {DEFAULT_SCENE}]"
    ))]
    pub scene: Option<PathBuf>,

    /// In which numbers: single or double precision, or double-double, with 32 digits at some
    /// forty times the cost; the scene says it otherwise
    #[arg(long, value_parser = one_of(&PRECISIONS))]
    pub precision: Option<Precision>,

    /// Steps of fixed length, or every collision at its exact time; the scene
    /// says it otherwise
    #[arg(long, value_parser = one_of(&ENGINES))]
    pub engine: Option<EngineKind>,

    /// Length of a step of the stepped engine, in the scene's unit of time: a scene that
    /// names no engine is run by that one then; the event-driven engine has no steps
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    pub dt: Option<f64>,

    /// How long to simulate, in the scene's unit of time
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    pub duration: Option<f64>,

    /// Worker threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = threads(), allow_negative_numbers = true)]
    pub threads: Option<u64>,

    /// How many numbers to work on at once
    #[arg(long, value_name = "N", value_parser = one_of(&LANES), default_value = "auto")]
    pub lanes: Option<Lanes>,

    /// The order in which the event-driven engine works collisions off: one after the
    /// other in time, or in windows of time, block by block and on all threads; the
    /// result is the same
    #[arg(long, value_parser = one_of(&ORDERS), default_value = "auto")]
    pub order: Option<Order>,

    /// Seed of the scene's random numbers
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// Put a value in the place of the scene file's, as spheres[0].radius=0.4 or
    /// surface.kind=rough; can be given many times
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// What `carom run` takes.
#[derive(Args, Debug, Default)]
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,

    /// Print the summary as one JSON object, and nothing else
    #[arg(long)]
    pub json: bool,

    /// Write every collision to a file of comma-separated values, or as arrays of NumPy if
    /// it ends in .npz
    #[arg(long, value_name = "FILE")]
    pub events: Option<PathBuf>,

    /// Write only collisions from this time on
    #[arg(long, value_name = "TIME", requires = "events", value_parser = time,
          allow_negative_numbers = true)]
    pub events_from: Option<f64>,

    /// Write only the first collision, and of the others every Nth
    #[arg(long, value_name = "N", requires = "events", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u64).range(1..))]
    pub events_every: Option<u64>,

    /// Write only collisions in which these bodies take part, as 3,7,20-29
    #[arg(long, value_name = "BODY,…", requires = "events", value_delimiter = ',',
          value_parser = bodies)]
    pub events_of: Vec<RangeInclusive<u32>>,

    /// Write the final state to a file of comma-separated values, or in a format of
    /// --record by its ending
    #[arg(long, value_name = "FILE.csv")]
    pub state: Option<PathBuf>,

    #[arg(long, value_name = "FILE", help = format!(
        "Write frames of the trajectory; the ending chooses the format: {}",
        FrameFormat::ENDINGS
    ))]
    pub record: Option<PathBuf>,

    /// Time from one frame to the next; the first one is the start
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    pub record_every: Option<f64>,

    /// Write energies, momentum, temperatures, collisions, pressure and more at times to
    /// a file of comma-separated values
    #[arg(long, value_name = "FILE.csv")]
    pub series: Option<PathBuf>,

    /// Time from one row of --series to the next; the first one is the start
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    pub series_every: Option<f64>,

    /// Keep the run in a file that it can go on from: at its end, on USR1, and when it
    /// is ended by Ctrl-C, TERM or HUP
    #[arg(long, value_name = "FILE")]
    pub snapshot: Option<PathBuf>,

    /// Keep it also at every multiple of this, in the scene's unit of time
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    pub snapshot_every: Option<f64>,

    /// Keep it also each time that this many minutes of wall-clock time have passed
    #[arg(long, value_name = "MINUTES", value_parser = positive, allow_negative_numbers = true)]
    pub snapshot_wall: Option<f64>,

    /// Go on from a snapshot, with the bits of a run that was never cut; --duration still
    /// counts from the start of the first run
    #[arg(long, value_name = "FILE",
          conflicts_with_all = ["scene", "precision", "engine", "dt", "seed", "set"])]
    pub resume: Option<PathBuf>,
}

/// What `carom sweep` takes.
#[derive(Args, Debug)]
pub struct SweepArguments {
    #[command(flatten)]
    pub scene: SceneArguments,

    /// A key of the scene file and its values, as KEY=a,b,c or, for n numbers at equal
    /// distances, KEY=from:to:n; can be given many times: each value goes with each of the
    /// other keys
    #[arg(long, value_name = "KEY=VALUES")]
    pub vary: Vec<String>,

    /// Runs for each choice of values, with seeds that count up from the scene's
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true,
          value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub seeds: u64,

    #[command(flatten)]
    pub folder: StudyFolder,
}

/// What `carom analyse` takes.
#[derive(Args, Debug)]
pub struct AnalyseArguments {
    #[arg(help = format!("Recorded frames: {}", FrameReader::ENDINGS))]
    pub file: PathBuf,

    /// What to find [default: all that the frames allow]
    #[arg(long, value_name = "KIND,…", value_delimiter = ',', value_parser = one_of(&KINDS))]
    pub kind: Vec<AnalysisKind>,

    /// Into how many bins the range is divided
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub bins: Option<u64>,

    /// How far it goes, or from where to where: distances, times, wave numbers, speeds in
    /// units of the thermal one
    #[arg(long, value_name = "[FROM,]TO", value_parser = range, allow_negative_numbers = true,
          requires = "kind")]
    pub range: Option<[Option<f64>; 2]>,

    /// Of which kinds of bodies, counted from 1 as `type` in frames is; of two for the radial
    /// distribution between them
    #[arg(long, value_name = "N,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub species: Vec<u64>,

    /// Leave out the frames before this time
    #[arg(long, value_name = "TIME", value_parser = time, allow_negative_numbers = true)]
    pub from: Option<f64>,

    /// Time from one frame to the next, for frames without times
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    pub every: Option<f64>,

    /// The folder of the files [default: that of the frames]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,

    /// Draw each file too, as NAME.svg
    #[arg(long)]
    pub plot: bool,
}

/// What `carom batch` takes.
#[derive(Args, Debug)]
pub struct BatchArguments {
    #[command(flatten)]
    pub scene: SceneArguments,

    /// How many scenes: scene k, from 0, has the scene file's seed plus k
    #[arg(long, value_name = "N", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u64).range(1..=MOST_RUNS))]
    pub count: u64,

    /// A key of the scene file and what scenes have there: KEY=a,b,c or KEY=from:to:n in
    /// turn, each value with each of the other keys; or KEY=uniform(a,b) or
    /// KEY=normal(mean,sd), drawn for each scene by its seed; can be given many times
    #[arg(long, value_name = "KEY=VALUES")]
    pub vary: Vec<String>,

    /// Figures of the end that rows have besides: time, steps, energy, translational,
    /// rotational, potential, temperature, spin_temperature; of body 3 x[3], y[3], z[3],
    /// vx[3], …, wx[3], …
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub observe: Vec<String>,

    /// The table: comma-separated values, arrays of NumPy if it ends in .npz, or a table of
    /// Parquet if it ends in .parquet
    #[arg(long, value_name = "FILE")]
    pub output: PathBuf,

    /// Forget the rows of a batch that was interrupted, and begin again
    #[arg(long)]
    pub restart: bool,
}

impl SceneArguments {
    /// On what the scene is to be run.
    pub fn execution(&self) -> Execution {
        Execution::new()
            .lanes(self.lanes.unwrap_or_default())
            .threads(self.threads.map_or(0, |threads| threads as usize))
            .order(self.order.unwrap_or_default())
    }
}

pub const PRECISIONS: [(&str, Precision); 3] =
    [("f32", Precision::F32), ("f64", Precision::F64), ("dd", Precision::DoubleDouble)];

/// Those that there are lanes for.
pub const FAST_PRECISIONS: [(&str, Precision); 2] =
    [("f32", Precision::F32), ("f64", Precision::F64)];

pub const ENGINES: [(&str, EngineKind); 2] =
    [("stepped", EngineKind::Stepped), ("event-driven", EngineKind::EventDriven)];

pub const ORDERS: [(&str, Order); 3] =
    [("auto", Order::Auto), ("strict", Order::Strict), ("windows", Order::Windows)];

pub const LANES: [(&str, Lanes); 5] = [
    ("scalar", Lanes::Scalar),
    ("4", Lanes::Four),
    ("8", Lanes::Eight),
    ("16", Lanes::Sixteen),
    ("auto", Lanes::Auto),
];

/// Takes one of a few words.
pub fn one_of<V: Copy + Send + Sync + 'static>(
    words: &'static [(&'static str, V)],
) -> impl TypedValueParser<Value = V> {
    let names = PossibleValuesParser::new(words.iter().map(|(name, _)| *name));
    names.try_map(move |given| {
        let found = words.iter().find(|(name, _)| *name == given);
        found.map(|(_, value)| *value).ok_or("not one of the possible values")
    })
}

/// Takes a length of time.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("it must be a finite number greater than 0".to_owned()),
    }
}

/// Takes where a range ends, or both of its ends.
fn range(text: &str) -> Result<[Option<f64>; 2], String> {
    let wanted = "it must be a number, or two as 1,3";
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wanted.to_owned());
    match text.split_once(',') {
        None => Ok([None, Some(number(text)?)]),
        Some((from, to)) => Ok([Some(number(from)?), Some(number(to)?)]),
    }
}

/// Takes a time since the start.
fn time(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("it must be a finite number, 0 or more".to_owned()),
    }
}

/// Takes a number of threads.
pub fn threads() -> clap::builder::RangedU64ValueParser<u64> {
    clap::value_parser!(u64).range(1..=MOST_THREADS as u64)
}
