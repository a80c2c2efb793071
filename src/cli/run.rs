//! `carom run`: a scene from its start to the summary.

use std::io::{self, Write};

use carom::bodies::Bodies;
use carom::engine::{Compiled, World};
use carom::observe::{Temperature, Totals, state_hash};
use carom::output::write_state;
use carom::real::Real;
use carom::scene::{Precision, SceneFile};

use super::arguments::RunArguments;
use super::failure::Failure;
use super::journey::Journey;
use super::output_file::OutputFile;
use super::outputs::Outputs;
use super::print;
use super::scene_argument::scene_file;
use super::summary::{Setup, Summary, Work};

/// Runs a scene and prints its summary.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let file = scene_file(&arguments.scene)?;
    match file.precision {
        Precision::F32 => run_in::<f32>(&file, arguments),
        _ => run_in::<f64>(&file, arguments),
    }
}

fn run_in<T: Compiled>(file: &SceneFile, arguments: &RunArguments) -> Result<(), Failure> {
    let duration = file.run_duration()?;
    let scene = file.build::<T>()?;
    let before = Totals::of(&scene.bodies, scene.gravity);
    if !before.is_finite() {
        return Err(Failure::Argument(format!(
            "{}: the scene's energy or momentum is out of the range of numbers; \
             choose units in which masses, speeds and lengths are nearer to 1",
            scene.name
        )));
    }
    let mut setup = Setup::of(&scene);
    let gas = scene.periodic.and_then(|_| Temperature::of(&scene.bodies));
    let gas = gas.map(|temperature| (temperature, scene.surface));
    let gravity = scene.gravity;
    let mut world = World::new(scene, arguments.scene.execution())?;
    let mut journey = Journey::new(&world, duration, gas);
    setup.lanes = world.plan().sweep_lanes;
    setup.threads = world.plan().threads;
    let outputs = Outputs::open(arguments)?;

    let events = journey.travel(&mut world, outputs.events)?;

    let bodies = world.bodies();
    let after = Totals::of(&bodies, gravity);
    if !after.is_finite() {
        return Err(Failure::NotFinite { time: world.time(), engine: setup.engine });
    }
    let temperature = Temperature::of(&bodies);
    let hash = state_hash(&bodies);
    let state = outputs.state.map(|file| written(file, &bodies)).transpose()?;
    // Both are whole before either gets its name.
    for file in [events, state].into_iter().flatten() {
        file.finish()?;
    }
    let work = Work {
        mean_temperature: journey.mean_temperature(),
        wall_seconds: journey.wall_seconds(),
        ..Work::of(&world)
    };
    let summary = Summary::new(setup, &before, &after, temperature, hash, &work);
    show(&summary, arguments.json, outputs.take_standard_output)
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
