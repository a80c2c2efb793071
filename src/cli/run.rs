//! `carom run`: a scene from its start to the summary.

use std::io::{self, Write};
use std::time::Instant;

use carom::DoubleDouble;
use carom::contact::Surface;
use carom::engine::{Compiled, EngineError, World};
use carom::observe::{Standstill, Totals, Unresolved, fall_energy, unresolved};
use carom::output::{Frame, FrameFormat, FrameWriter, write_state};
use carom::real::Real;
use carom::scene::{Precision, Scene, SceneFile};
use carom::study::Course;
use carom::surroundings::Shape;

use super::analyses::{Analyses, AskedAnalysis};
use super::arguments::RunArguments;
use super::asked::Asked;
use super::conclusion::Ended;
use super::events::{AskedEvents, Events};
use super::failure::Failure;
use super::journey::{Journey, OnTheWay};
use super::kept::{Keeping, Kept, options};
use super::measured::Measured;
use super::outlook;
use super::output_file::{OutputError, OutputFile};
use super::outputs::Outputs;
use super::progress::SettingUp;
use super::recording::{Recorder, Recording, state_format};
use super::scene_argument::scene_file;
use super::series::{AskedSeries, Series};
use super::summary::{AllDigits, Setup, Summary};
use super::{print, standard_output};

/// Runs a scene and prints its summary.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let kept = arguments.resume.as_deref().map(Kept::read).transpose()?;
    let file = match &kept {
        None => scene_file(&arguments.scene)?,
        Some(kept) => {
            let mut file = SceneFile::of_source(kept.source.clone())?;
            file.duration = arguments.scene.duration.or(file.duration);
            file
        }
    };
    match file.precision {
        Precision::F32 => run_in::<f32>(&file, arguments, kept.as_ref()),
        Precision::DoubleDouble => run_in::<DoubleDouble>(&file, arguments, kept.as_ref()),
        _ => run_in::<f64>(&file, arguments, kept.as_ref()),
    }
}

/// A scene in motion from its start, or from where it was kept, on its way to a time.
fn set_out<T: Compiled>(
    scene: Scene<T>,
    arguments: &RunArguments,
    kept: Option<&Kept>,
    duration: f64,
) -> Result<(World<T>, Course), Failure> {
    let execution = arguments.scene.execution();
    let (Some(kept), Some(path)) = (kept, &arguments.resume) else {
        let world = World::new(scene, execution)?;
        let course = Course::new(&world, duration);
        return Ok((world, course));
    };
    kept.check_start(&scene.bodies, path)?;
    let refused = |reason: String| Failure::Resume { path: path.clone(), reason };
    let world = World::resume(scene, execution, &kept.snapshot)
        .map_err(|error| refused(error.to_string()))?;
    let course = Course::new(&world, duration);
    if Course::position(&world) > course.length() {
        return Err(refused(format!(
            "it is at time {:?}, beyond the end of the run at {duration:?}; give a longer --duration",
            kept.time
        )));
    }
    Ok((world, course))
}

fn run_in<T: Compiled>(
    file: &SceneFile,
    arguments: &RunArguments,
    kept: Option<&Kept>,
) -> Result<(), Failure> {
    let start = Instant::now();
    let setting_up = SettingUp::new();
    let duration = file.run_duration()?;
    let equilibration = file.equilibration(duration)?;
    let recording = Recording::of(arguments, file, duration)?;
    let series = AskedSeries::of(arguments, file, duration)?;
    let keeping = Keeping::of(arguments, file)?;
    let state_format = |path| state_format(path, file.precision);
    let state_format = arguments.state.as_deref().map(state_format).transpose()?.flatten();
    let scene = file.build::<T>()?;
    let is_kept = keeping.is_some() || kept.is_some();
    let events = AskedEvents::of(arguments, file.precision, scene.bodies.len(), is_kept)?;
    let analyses = AskedAnalysis::all(file, &scene, (duration, equilibration))?;
    outlook::check(&scene, duration, arguments.scene.execution())?;
    let before = totals_at_start(&scene)?;
    let conserved_at_start = AllDigits::at_start(&scene);
    standard_output()?;
    let doubt = unresolved(&scene.bodies, duration);
    let mut setup = Setup::of(&scene);
    let gas = gas(&scene);
    let volume = volume(&scene);
    let fall = fall_energy(&scene);
    let (shapes, space) = (scene.surroundings.clone(), scene.periodic);
    let snapshot = keeping.as_ref().map(|keeping| keeping.path.clone());
    let keeper = keeping.map(|keeping| keeping.begin(file, &scene.bodies, options(arguments)));
    let (mut world, course) = set_out(scene, arguments, kept, duration)?;
    let notes = kept.map(|kept| &kept.notes);
    let measured = match notes {
        None => Measured::new(&world, &course, equilibration, gas),
        Some(notes) if notes.length == course.length() => notes.measured.clone(),
        Some(notes) => notes.measured.clone().stretched(),
    };
    let earlier = (world.collisions(), world.steps());
    let mut journey = Journey::new(course, space, (before.energy, fall), measured);
    setup.lanes = world.plan().sweep_lanes;
    setup.threads = world.plan().threads;
    let path = |asked: &Asked| asked.path.clone();
    let outputs = Outputs::open(
        arguments,
        recording.as_ref().map(|recording| path(&recording.asked)).as_deref(),
        series.as_ref().map(|series| path(&series.asked)).as_deref(),
        snapshot.as_deref(),
        &analyses.iter().map(|asked| asked.path.as_path()).collect::<Vec<_>>(),
        notes,
    )?;
    let counted = notes.and_then(|notes| notes.images.as_ref());
    let looks = recording.is_some() || series.is_some() || !analyses.is_empty();
    if looks || state_format.is_some() || counted.is_some() {
        journey.count_images(&world, counted);
    }
    let record = recording.zip(outputs.record).map(|(recording, file)| {
        let kept = notes.and_then(|notes| notes.record.as_ref());
        Recorder::new(&recording, file, &world, &course, kept).map_err(|source| match source {
            OutputError::Path { .. } => Failure::Open { option: "--record", source },
            OutputError::Write { .. } => source.into(),
        })
    });
    let series = series.zip(outputs.series).map(|(series, file)| {
        let kept = notes.and_then(|notes| notes.series.as_ref());
        Series::new(&series, file, &world, &course, equilibration, volume, kept)
    });
    let events = events.zip(outputs.events).map(|(asked, file)| {
        Events::new(asked, file, notes.and_then(|notes| notes.events.as_ref()))
    });
    let kept = notes.map(|notes| notes.analyses.as_slice());
    let way = (&world, &course);
    let analyses = Analyses::new(analyses, outputs.analyses, way, equilibration, kept);
    let on_the_way = OnTheWay {
        events: events.transpose()?,
        record: record.transpose()?,
        series: series.transpose()?,
        analyses,
        keeper,
    };
    drop(setting_up);
    let setup_seconds = start.elapsed().as_secs_f64();

    let arrived = journey
        .travel(&mut world, on_the_way)
        .map_err(|failure| explained(failure, &world, &shapes))?;

    let bodies = world.bodies();
    let time = world.time();
    let ended = Ended {
        setup,
        world: &world,
        bodies: &bodies,
        course,
        before,
        start: conserved_at_start,
        fall,
        equilibration,
        measured: journey.measured(),
        earlier,
        found: arrived.found,
        seconds: [setup_seconds, journey.seconds()],
    };
    let summary = ended.summary()?;
    if let Some(doubt) = doubt.or_else(|| unresolved(&bodies, time)) {
        warn(&doubt);
    }
    let (space, images) = journey.space();
    let numbers = world.has_flow().then(|| world.numbers());
    let numbers = numbers.as_deref();
    let frame = Frame { time, step: world.steps(), bodies: &bodies, space, images, numbers };
    let state = outputs.state.map(|file| in_format(state_format, file, &frame)).transpose()?;
    // All are whole before one of them gets its name.
    for file in arrived.files.into_iter().chain(state) {
        file.finish()?;
    }
    show(&summary, arguments.json, outputs.take_standard_output)
}

/// The volume of a periodic box.
fn volume<T: Real>(scene: &Scene<T>) -> Option<f64> {
    scene.periodic.map(|space| space.sides().cast::<f64>().to_array().iter().product())
}

/// The volume and the surfaces of a gas in a periodic box, if that is what a scene is.
pub fn gas<T: Real>(scene: &Scene<T>) -> Option<(f64, Surface)> {
    volume(scene).filter(|_| scene.bodies.len() > 1).map(|volume| (volume, scene.surface))
}

/// What is conserved, at the start of a scene.
pub fn totals_at_start<T: Real>(scene: &Scene<T>) -> Result<Totals, Failure> {
    let totals = Totals::of(&scene.bodies, scene.gravity);
    if totals.is_finite() {
        return Ok(totals);
    }
    Err(Failure::Argument(format!(
        "{}: the scene's energy or momentum is out of the range of numbers; \
         choose units in which masses, speeds and lengths are nearer to 1",
        scene.name
    )))
}

/// Says what of a result means nothing.
fn warn(doubt: &Unresolved) {
    // A message that cannot be written ends no run.
    let _ = writeln!(io::stderr(), "warning: {doubt}");
}

/// Why a run has ended, with what the state tells of it.
pub fn explained<T: Real>(failure: Failure, world: &World<T>, shapes: &[Shape<T>]) -> Failure {
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
fn in_format<T: Real>(
    format: Option<FrameFormat>,
    mut file: OutputFile,
    frame: &Frame<'_, T>,
) -> Result<OutputFile, Failure> {
    let Some(format) = format else {
        write_state(&mut file, frame.bodies).map_err(|error| file.error(error))?;
        return Ok(file);
    };
    let path = file.path().to_path_buf();
    let write = || {
        let mut writer = FrameWriter::new(format, &path, file)?;
        writer.write(frame)?;
        writer.finish()
    };
    Ok(write().map_err(|source| OutputError::Write { path: path.clone(), source })?)
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
