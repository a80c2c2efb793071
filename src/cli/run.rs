//! `carom run`: a scene from its start to the summary.

use std::io::{self, Write};

use carom::bodies::Bodies;
use carom::engine::Stepped;
use carom::observe::{Temperature, Totals, state_hash};
use carom::output::{OutputFile, Setup, Summary, Work, write_state};
use carom::real::Real;
use carom::scene::{Precision, Scene, SceneFile};

use super::arguments::RunArguments;
use super::failure::Failure;
use super::journey::Journey;
use super::outputs::Outputs;
use super::print;
use super::scene_argument::scene_file;

/// Runs a scene and prints its summary.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let file = scene_file(&arguments.scene)?;
    match file.precision {
        Precision::F32 => run_in::<f32>(&file, arguments),
        Precision::F64 => run_in::<f64>(&file, arguments),
    }
}

fn run_in<T: Real>(file: &SceneFile, arguments: &RunArguments) -> Result<(), Failure> {
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
    let mut journey = Journey::new(&scene, step_count(&scene, duration));
    let gravity = scene.gravity;
    let mut world = Stepped::with_execution(scene, arguments.scene.execution())?;
    setup.lanes = world.plan().sweep_lanes;
    setup.threads = world.plan().threads;
    let outputs = Outputs::open(arguments)?;

    let events = journey.travel(&mut world, outputs.events)?;

    let bodies = world.bodies();
    let after = Totals::of(&bodies, gravity);
    if !after.is_finite() {
        return Err(Failure::NotFinite { steps: world.steps(), time: world.time() });
    }
    let temperature = Temperature::of(&bodies);
    let hash = state_hash(&bodies);
    let state = outputs.state.map(|file| written(file, &bodies)).transpose()?;
    // Both are whole before either gets its name.
    for file in [events, state].into_iter().flatten() {
        file.finish()?;
    }
    let work = Work {
        time: world.time(),
        steps: world.steps(),
        collisions: world.collisions(),
        impulse_from_surroundings: world.impulse_from_surroundings(),
        virial: world.virial(),
        mean_temperature: journey.mean_temperature(),
        wall_seconds: journey.wall_seconds(),
    };
    let summary = Summary::new(setup, &before, &after, temperature, hash, &work);
    show(&summary, arguments.json, outputs.take_standard_output)
}

/// The whole number of steps nearest to the duration, at least one. A checked
/// scene has a step, and no more steps than can be counted.
fn step_count<T: Real>(scene: &Scene<T>, duration: f64) -> u64 {
    let dt = scene.stepped.dt.unwrap_or(duration);
    (duration / dt).round().max(1.0) as u64
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
