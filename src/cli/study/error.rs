//! `carom study error`: run time against error.

use carom::engine::Lanes;
use carom::motion::Integrator;
use carom::scene::Precision;
use carom::scene::{EngineKind, Impact};
use carom::study::Norm;
use carom::study::work_precision::{Asked, Quantity, WorkPrecision};
use clap::Args;

use super::{StudiedScene, StudyOutput};
use crate::cli::arguments::{ENGINES, LANES, PRECISIONS, one_of, positive, threads};
use crate::cli::failure::Failure;

/// What `carom study error` takes.
#[derive(Args, Debug)]
pub struct ErrorArguments {
    #[command(flatten)]
    scene: StudiedScene,

    /// Times at which methods are compared, the last one judged [default: four
    /// up to where the scene can be predicted]
    #[arg(long, value_name = "TIME,…", value_delimiter = ',', value_parser = positive)]
    times: Vec<f64>,

    /// Engines [default: both]
    #[arg(long, value_name = "ENGINE,…", value_delimiter = ',', value_parser = one_of(&ENGINES))]
    engine: Vec<EngineKind>,

    /// Integrators of the stepped engine [default: all, where there is gravity]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = one_of(&INTEGRATORS))]
    integrator: Vec<Integrator>,

    /// Impacts of the stepped engine [default: both]
    #[arg(long, value_name = "IMPACT,…", value_delimiter = ',', value_parser = one_of(&IMPACTS))]
    impact: Vec<Impact>,

    /// Lengths of a step, in the scene's unit of time [default: seven around the
    /// scene's own]
    #[arg(long, value_name = "TIME,…", value_delimiter = ',', value_parser = positive)]
    dt: Vec<f64>,

    /// Precisions; dd in steps only, since event-driven dd is the reference [default: f32,f64]
    #[arg(long, value_name = "P,…", value_delimiter = ',', value_parser = one_of(&PRECISIONS))]
    precision: Vec<Precision>,

    /// Lane widths [default: auto and scalar]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = one_of(&LANES))]
    lanes: Vec<Lanes>,

    /// Numbers of worker threads [default: one and all]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = threads())]
    threads: Vec<u64>,

    /// Samples of the time of each method, at least; each is as many runs as take 5 ms
    /// [default: 5]
    #[arg(long, value_name = "N")]
    runs: Option<usize>,

    /// The error that the diagram shows and the advice is about
    #[arg(long, value_name = "QUANTITY", value_parser = one_of(&QUANTITIES),
          default_value = "position")]
    of: Quantity,

    /// What the errors of all bodies are made one by: rms, max, l1 (their mean) or body=N, one of
    /// them from 0; another one needs no second run
    #[arg(long, value_name = "NORM", value_parser = norm, default_value = "rms")]
    norm: Norm,

    #[command(flatten)]
    output: StudyOutput,
}

const INTEGRATORS: [(&str, Integrator); 3] = [
    ("semi-implicit-euler", Integrator::SemiImplicitEuler),
    ("explicit-euler", Integrator::ExplicitEuler),
    ("velocity-verlet", Integrator::VelocityVerlet),
];

const IMPACTS: [(&str, Impact); 2] =
    [("end-of-step", Impact::EndOfStep), ("sub-step", Impact::SubStep)];

const QUANTITIES: [(&str, Quantity); 6] = [
    ("position", Quantity::Position),
    ("velocity", Quantity::Velocity),
    ("orientation", Quantity::Orientation),
    ("energy", Quantity::Energy),
    ("momentum", Quantity::Momentum),
    ("angular-momentum", Quantity::AngularMomentum),
];

fn norm(text: &str) -> Result<Norm, String> {
    match text {
        "rms" => Ok(Norm::RootMeanSquare),
        "max" => Ok(Norm::Maximum),
        "l1" => Ok(Norm::Mean),
        _ => {
            let body = text.strip_prefix("body=").and_then(|body| body.parse().ok());
            body.map(Norm::Body).ok_or_else(|| "it must be rms, max, l1 or body=N".to_owned())
        }
    }
}

impl ErrorArguments {
    /// Makes the study, and prints its report.
    pub fn run(self) -> Result<(), Failure> {
        let file = self.scene.file()?;
        let asked = Asked {
            duration: self.scene.duration,
            times: self.times,
            engines: self.engine,
            integrators: self.integrator,
            impacts: self.impact,
            steps: self.dt,
            precisions: self.precision,
            lanes: self.lanes,
            threads: self.threads.into_iter().map(|threads| threads as usize).collect(),
            runs: self.runs,
            quantity: self.of,
            norm: self.norm,
        };
        self.output.conduct(&WorkPrecision::new(&file, &asked)?)
    }
}
