//! `carom study scaling`: time and memory against the number of bodies.

use carom::engine::Lanes;
use carom::scene::EngineKind;
use carom::scene::{MOST_BODIES, Precision};
use carom::study::scaling::{Scaling, Settings};
use clap::Args;

use super::{StudiedScene, StudyOutput};
use crate::cli::arguments::{ENGINES, FAST_PRECISIONS, LANES, one_of, positive, threads};
use crate::cli::failure::Failure;

/// What `carom study scaling` takes.
#[derive(Args, Debug)]
pub struct ScalingArguments {
    #[command(flatten)]
    scene: StudiedScene,

    /// Steps of fixed length, or every collision at its exact time; the scene
    /// says it otherwise
    #[arg(long, value_parser = one_of(&ENGINES))]
    engine: Option<EngineKind>,

    /// Length of a step of the stepped engine, in the scene's unit of time
    #[arg(long, value_name = "TIME", value_parser = positive, allow_negative_numbers = true)]
    dt: Option<f64>,

    /// Numbers of bodies [default: 1000,10000,100000]
    #[arg(long, value_name = "N,…", value_delimiter = ',', allow_negative_numbers = true,
        value_parser = clap::value_parser!(u64).range(1..=MOST_BODIES))]
    bodies: Vec<u64>,

    /// In which numbers [default: f32,f64]
    #[arg(long, value_delimiter = ',', value_parser = one_of(&FAST_PRECISIONS))]
    precision: Vec<Precision>,

    /// Worker threads of the stepped engine [default: 1 and one for each core]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = threads(),
        allow_negative_numbers = true)]
    threads: Vec<u64>,

    /// How many numbers to work on at once; the first is taken for all sizes, the
    /// others at the middle one [default: auto,scalar,4,8,16]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = one_of(&LANES))]
    lanes: Vec<Lanes>,

    /// How often each variant is run
    #[arg(long, value_name = "N", default_value_t = 5, allow_negative_numbers = true,
        value_parser = clap::value_parser!(u64).range(1..=10_000))]
    runs: u64,

    #[command(flatten)]
    output: StudyOutput,
}

impl ScalingArguments {
    /// Makes the study.
    pub fn run(self) -> Result<(), Failure> {
        let mut file = self.scene.file()?;
        file.engine = self.engine.unwrap_or(file.engine);
        file.dt = self.dt.or(file.dt);
        self.output.conduct(&Scaling::new(&file, &self.settings())?)
    }

    fn settings(&self) -> Settings {
        let defaults = Settings::default();
        let threads = self.threads.iter().map(|&threads| threads as usize).collect();
        Settings {
            bodies: given(self.bodies.clone(), defaults.bodies),
            precisions: given(self.precision.clone(), defaults.precisions),
            threads: given(threads, defaults.threads),
            lanes: given(self.lanes.clone(), defaults.lanes),
            runs: self.runs as usize,
        }
    }
}

fn given<V>(values: Vec<V>, default: Vec<V>) -> Vec<V> {
    if values.is_empty() { default } else { values }
}
