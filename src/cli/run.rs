//! `carom run`: a scene from its start to the summary.

use std::io::{self, Write};
use std::time::Instant;

use carom::bodies::Bodies;
use carom::engine::{Compiled, EngineError, World};
use carom::observe::{
    Standstill, Temperature, Totals, Unresolved, fall_energy, not_finite, state_hash, unresolved,
};
use carom::output::write_state;
use carom::real::Real;
use carom::scene::{Precision, SceneFile};
use carom::surroundings::Shape;

use super::arguments::RunArguments;
use super::failure::Failure;
use super::journey::Journey;
use super::outlook;
use super::output_file::{OutputError, OutputFile};
use super::outputs::Outputs;
use super::progress::SettingUp;
use super::scene_argument::scene_file;
use super::summary::{Setup, Summary, Work};
use super::{print, standard_output};

/// Runs a scene and prints its summary.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let file = scene_file(&arguments.scene)?;
    match file.precision {
        Precision::F32 => run_in::<f32>(&file, arguments),
        _ => run_in::<f64>(&file, arguments),
    }
}

fn run_in<T: Compiled>(file: &SceneFile, arguments: &RunArguments) -> Result<(), Failure> {
    let start = Instant::now();
    let setting_up = SettingUp::new();
    let duration = file.run_duration()?;
    let scene = file.build::<T>()?;
    outlook::check(&scene, duration, arguments.scene.execution())?;
    let before = Totals::of(&scene.bodies, scene.gravity);
    if !before.is_finite() {
        return Err(Failure::Argument(format!(
            "{}: the scene's energy or momentum is out of the range of numbers; \
             choose units in which masses, speeds and lengths are nearer to 1",
            scene.name
        )));
    }
    standard_output()?;
    let doubt = unresolved(&scene.bodies, duration);
    let mut setup = Setup::of(&scene);
    let gas = scene.periodic.and_then(|_| Temperature::of(&scene.bodies));
    let gas = gas.map(|temperature| (temperature, scene.surface));
    let fall = fall_energy(&scene);
    let shapes = scene.surroundings.clone();
    let mut world = World::new(scene, arguments.scene.execution())?;
    let mut journey = Journey::new(&world, duration, gas);
    setup.lanes = world.plan().sweep_lanes;
    setup.threads = world.plan().threads;
    let outputs = Outputs::open(arguments)?;
    drop(setting_up);
    let setup_seconds = start.elapsed().as_secs_f64();

    let events = journey
        .travel(&mut world, outputs.events)
        .map_err(|failure| explained(failure, &world, &shapes))?;

    let after = world.totals();
    let bodies = world.bodies();
    let not_finite = not_finite(&bodies).map(|found| found.to_string());
    let total = || "the energy or a momentum of all bodies is no longer finite".to_owned();
    let (time, engine) = (world.time(), setup.engine);
    if let Some(what) = not_finite.or_else(|| (!after.is_finite()).then(total)) {
        return Err(Failure::NotFinite { time, what, engine });
    }
    let temperature = Temperature::of(&bodies);
    let hash = state_hash(&bodies);
    let work = Work {
        mean_temperature: journey.mean_temperature(),
        fall,
        setup_seconds,
        engine_seconds: journey.seconds(),
        ..Work::of(&world)
    };
    let summary = Summary::new(setup, &before, &after, temperature, hash, &work);
    if let Some(what) = summary.not_finite() {
        let what = format!("the {what} of the summary is no finite number");
        return Err(Failure::NotFinite { time, what, engine });
    }
    if let Some(doubt) = doubt.or_else(|| unresolved(&bodies, time)) {
        warn(&doubt);
    }
    let state = outputs.state.map(|file| written(file, &bodies)).transpose()?;
    // Both are whole before either gets its name.
    for file in [events, state].into_iter().flatten() {
        file.finish()?;
    }
    show(&summary, arguments.json, outputs.take_standard_output)
}

/// Says what of a result means nothing.
fn warn(doubt: &Unresolved) {
    // A message that cannot be written ends no run.
    let _ = writeln!(io::stderr(), "warning: {doubt}");
}

/// Why a run has ended, with what the state tells of it.
fn explained<T: Real>(failure: Failure, world: &World<T>, shapes: &[Shape<T>]) -> Failure {
    match failure {
        Failure::Engine(EngineError::Stalled { time, events, body }) => {
            let why = Standstill::of(&world.bodies(), shapes, world.gravity(), body as usize);
            Failure::Stalled { time, events, body, why }
        }
        Failure::Write(OutputError::Write { source, .. })
            if source.kind() == io::ErrorKind::InvalidData =>
        {
            let (time, engine) = (world.time(), world.plan().engine);
            Failure::NotFinite { time, what: source.to_string(), engine }
        }
        other => other,
    }
}

/// A state file with the state in it.
fn written<T: Real>(mut file: OutputFile, bodies: &Bodies<T>) -> Result<OutputFile, Failure> {
    write_state(&mut file, bodies).map_err(|error| file.error(error))?;
    Ok(file)
}

/// Prints the summary; for a person on standard error where standard output
/// holds a file.
fn show(summary: &Summary, as_json: bool, is_taken: bool) -> Result<(), Failure> {
    if as_json {
        let object =
            serde_json::to_string(summary).map_err(|error| Failure::Print(error.into()))?;
        return print(&format!("{object}\n"));
    }
    if is_taken {
        return write!(io::stderr(), "{summary}").map_err(Failure::Print);
    }
    print(&summary.to_string())
}
