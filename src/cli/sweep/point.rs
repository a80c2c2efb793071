//! Point: one run of a sweep, from its scene to its figures.

use std::time::Instant;

use carom::DoubleDouble;
use carom::engine::{Compiled, Execution, World};
use carom::observe::{Temperature, fall_energy};
use carom::scene::{Precision, SceneFile};
use carom::study::Course;

use super::figures::Outcome;
use crate::cli::conclusion::Ended;
use crate::cli::failure::Failure;
use crate::cli::measured::Measured;
use crate::cli::outlook;
use crate::cli::run::{explained, gas, totals_at_start};
use crate::cli::summary::{Setup, Summary};

/// Runs a scene; a failure is an outcome too.
pub fn outcome(file: &SceneFile, execution: Execution) -> Outcome {
    let run = match file.precision {
        Precision::F32 => run::<f32>(file, execution),
        Precision::DoubleDouble => run::<DoubleDouble>(file, execution),
        _ => run::<f64>(file, execution),
    };
    match run {
        Ok(summary) => Outcome::of(&summary),
        Err(failure) => Outcome { failure: Some(failure.to_string()), ..Outcome::default() },
    }
}

/// Finds a mistake in a scene without running it.
pub fn check(file: &SceneFile, execution: Execution) -> Result<(), Failure> {
    match file.precision {
        Precision::F32 => check_in::<f32>(file, execution),
        Precision::DoubleDouble => check_in::<DoubleDouble>(file, execution),
        _ => check_in::<f64>(file, execution),
    }
}

fn check_in<T: Compiled>(file: &SceneFile, execution: Execution) -> Result<(), Failure> {
    let duration = file.run_duration()?;
    file.equilibration(duration)?;
    let scene = file.build::<T>()?;
    outlook::check(&scene, duration, execution)?;
    totals_at_start(&scene)?;
    Ok(())
}

fn run<T: Compiled>(file: &SceneFile, execution: Execution) -> Result<Summary, Failure> {
    let start = Instant::now();
    let duration = file.run_duration()?;
    let equilibration = file.equilibration(duration)?;
    let scene = file.build::<T>()?;
    outlook::check(&scene, duration, execution)?;
    let before = totals_at_start(&scene)?;
    let (mut setup, gas, fall) = (Setup::of(&scene), gas(&scene), fall_energy(&scene));
    let shapes = scene.surroundings.clone();
    let mut world = World::new(scene, execution)?;
    setup.lanes = world.plan().sweep_lanes;
    setup.threads = world.plan().threads;
    let course = Course::new(&world, duration);
    let mut measured = Measured::new(&world, &course, equilibration, gas);
    let setup_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    loop {
        let position = Course::position(&world);
        while measured.mark(course.length()).is_some_and(|mark| mark <= position) {
            measured.take(&world, position, || Temperature::of(&world.bodies()));
        }
        if position >= course.length() {
            break;
        }
        let mark = measured.mark(course.length()).unwrap_or(course.length());
        course
            .finish(&mut world, mark, None)
            .map_err(|error| explained(error.into(), &world, &shapes))?;
    }
    let bodies = world.bodies();
    let ended = Ended {
        setup,
        world: &world,
        bodies: &bodies,
        course,
        before,
        start: None,
        fall,
        equilibration,
        measured: &measured,
        earlier: Default::default(),
        found: Vec::new(),
        seconds: [setup_seconds, start.elapsed().as_secs_f64()],
    };
    ended.summary()
}
