//! Point: one run of a sweep, from its scene to its figures.

use std::path::Path;
use std::time::Instant;

use carom::DoubleDouble;
use carom::engine::{Compiled, Event, Execution, World};
use carom::observe::{Temperature, fall_energy};
use carom::scene::{Precision, SceneFile};
use carom::study::Course;

use super::figures::Outcome;
use crate::cli::analyses::{Analyses, AskedAnalysis, of_one_run};
use crate::cli::boxes::Boxes;
use crate::cli::conclusion::Ended;
use crate::cli::failure::Failure;
use crate::cli::measured::Measured;
use crate::cli::outlook;
use crate::cli::output_file::OutputFile;
use crate::cli::run::{explained, gas, totals_at_start};
use crate::cli::summary::Setup;

/// Where the findings of a run go: into files in a folder, by the key of the run.
#[derive(Clone, Copy)]
pub struct Analysed<'a> {
    pub folder: &'a Path,
    pub key: &'a str,
}

/// Runs a scene; a failure is an outcome too.
pub fn outcome(file: &SceneFile, execution: Execution, analysed: Analysed<'_>) -> Outcome {
    let run = match file.precision {
        Precision::F32 => run::<f32>(file, execution, analysed),
        Precision::DoubleDouble => run::<DoubleDouble>(file, execution, analysed),
        _ => run::<f64>(file, execution, analysed),
    };
    match run {
        Ok(outcome) => outcome,
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
    let equilibration = file.equilibration(duration)?;
    let scene = file.build::<T>()?;
    outlook::check(&scene, duration, execution)?;
    totals_at_start(&scene)?;
    let mut asked = AskedAnalysis::all(file, &scene, (duration, equilibration))?;
    of_one_run(file, &mut asked, Path::new(""), "")?;
    Ok(())
}

fn run<T: Compiled>(
    file: &SceneFile,
    execution: Execution,
    analysed: Analysed<'_>,
) -> Result<Outcome, Failure> {
    let start = Instant::now();
    let duration = file.run_duration()?;
    let equilibration = file.equilibration(duration)?;
    let scene = file.build::<T>()?;
    outlook::check(&scene, duration, execution)?;
    let before = totals_at_start(&scene)?;
    let (mut setup, gas, fall) = (Setup::of(&scene), gas(&scene), fall_energy(&scene));
    let (shapes, space) = (scene.surroundings.clone(), scene.periodic);
    let mut asked = AskedAnalysis::all(file, &scene, (duration, equilibration))?;
    let names = of_one_run(file, &mut asked, analysed.folder, analysed.key)?;
    let mut world = World::new(scene, execution)?;
    setup.lanes = world.plan().sweep_lanes;
    setup.threads = world.plan().threads;
    let course = Course::new(&world, duration);
    let mut measured = Measured::new(&world, &course, equilibration, gas);
    let files = asked.iter().map(|asked| OutputFile::open(&asked.path));
    let files = files.collect::<Result<Vec<_>, _>>()?;
    let analysed_space = space.filter(|_| !asked.is_empty());
    let mut boxes = analysed_space.map(|space| Boxes::new(space, &world, &course, None));
    let mut analyses = Analyses::new(asked, files, (&world, &course), equilibration, None);
    let setup_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    loop {
        let position = Course::position(&world);
        while measured.mark(course.length()).is_some_and(|mark| mark <= position) {
            measured.take(&world, position, || Temperature::of(&world.bodies()));
        }
        let is_analysed = analyses.mark() == Some(position);
        if let Some(boxes) = boxes.as_mut().filter(|it| is_analysed || it.next() <= position) {
            boxes.look(&world, &world.bodies(), &course);
        }
        if is_analysed {
            let images = boxes.as_ref().map(Boxes::images);
            analyses.look(&world, &world.bodies(), space, images);
        }
        if position >= course.length() {
            break;
        }
        let marks =
            [measured.mark(course.length()), analyses.mark(), boxes.as_ref().map(Boxes::next)];
        let mark = marks.into_iter().flatten().fold(course.length(), f64::min);
        let hears = analyses.hears();
        let mut hear = |event: &Event<T>| analyses.hear(event);
        course
            .finish(&mut world, mark, if hears { Some(&mut hear) } else { None })
            .map_err(|error| explained(error.into(), &world, &shapes))?;
    }
    let (files, found): (Vec<_>, Vec<_>) = analyses.finish()?.into_iter().unzip();
    for file in files {
        file.finish()?;
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
        found: found.clone(),
        seconds: [setup_seconds, start.elapsed().as_secs_f64()],
    };
    Ok(Outcome::of(&ended.summary()?).with_found(&found, names))
}
