//! `carom sweep`: a scene once for each value of some of its keys.

mod figures;
mod point;
mod tables;
mod variation;

use carom::engine::Execution;
use carom::scene::{SceneError, SceneFile};
use carom::study::{Order, Point, StudyError, Subject};

use super::arguments::{SceneArguments, SweepArguments};
use super::failure::Failure;
use super::print;
use super::scene_argument::{scene_file, with_options};
use super::study::watch::Teller;
use figures::Outcome;
use tables::{Group, report, write_means, write_runs};
use variation::{Variation, choices, count};

/// How long a run takes, seconds: it is not known before the first one. Only the
/// proportions count.
const UNKNOWN: f64 = f64::MIN_POSITIVE;

/// A run that is to be made.
struct Planned {
    key: String,
    file: SceneFile,
}

/// Runs all, writes their tables and prints the means.
pub fn sweep(arguments: &SweepArguments) -> Result<(), Failure> {
    let base = scene_file(&arguments.scene)?;
    let variations = Variation::all(&arguments.vary)?;
    count(&variations, arguments.seeds)?;
    refuse_both(&arguments.scene, &variations)?;
    let choices = choices(&variations);
    let files = choices
        .iter()
        .map(|choice| varied(&base, &arguments.scene, &variations, choice))
        .collect::<Result<Vec<_>, _>>()?;
    let seeds =
        files.iter().map(|file| seeds(file, arguments.seeds)).collect::<Result<Vec<_>, _>>()?;
    let execution = arguments.scene.execution().threads(1);
    if let Some(first) = files.first() {
        point::check(first, execution).map_err(|failure| match failure {
            Failure::Scene(error) => blamed(&error, &variations),
            other => other,
        })?;
    }
    let planned = files.iter().zip(&seeds).zip(&choices).flat_map(|((file, seeds), choice)| {
        let variations = &variations;
        seeds.iter().map(move |&seed| {
            let mut file = file.clone();
            file.seed = seed;
            let keys = variations.iter().zip(choice);
            let values = keys.map(|(variation, value)| format!("{}={value} ", variation.key));
            Planned { key: format!("{}seed={seed}", values.collect::<String>()), file }
        })
    });
    let planned: Vec<Planned> = planned.collect();

    // What is varied is no part of it: more values and seeds keep the runs that are there.
    let common = Subject { seed: 0, ..Subject::of(&base) };
    let options = (arguments.scene.engine, arguments.scene.precision.map(|p| p.to_string()));
    let (folder, journal) =
        arguments.folder.open(&format!("sweep-{}", base.name), &("sweep", common, options))?;
    let teller = Teller::new(&folder);
    let outcomes = side_by_side(arguments.scene.threads, || {
        let points: Vec<_> = planned.iter().map(|planned| planned.point(execution)).collect();
        Point::all(&points, &journal, Order::AtOnce, &teller)
    })?;
    drop(teller);

    let keys: Vec<&str> = variations.iter().map(|variation| variation.key.as_str()).collect();
    let of_choice = outcomes.chunks(arguments.seeds as usize);
    let groups: Vec<Group<'_>> = choices
        .into_iter()
        .zip(seeds)
        .zip(of_choice)
        .map(|((values, seeds), runs)| Group { values, seeds, runs })
        .collect();
    write_runs(&folder, &keys, &groups)?;
    write_means(&folder, &keys, &groups)?;
    let report = report(&base.name, &keys, &groups, folder.path());
    folder.write("report.txt", report.as_bytes())?;
    folder.write("scene.toml", base.text().as_bytes())?;
    print(&report)?;
    let failures: Vec<&String> = outcomes.iter().filter_map(|run| run.failure.as_ref()).collect();
    match failures.first() {
        None => Ok(()),
        Some(first) => Err(Failure::Runs {
            failed: failures.len(),
            runs: outcomes.len(),
            path: folder.path().join("runs.csv"),
            first: (*first).clone(),
        }),
    }
}

impl Planned {
    fn point(&self, execution: Execution) -> Point<'_, Outcome> {
        Point::new(&self.key, UNKNOWN, move || Ok(point::outcome(&self.file, execution)))
    }
}

/// Does this with a number of threads; with as many as there are cores if no number is given.
fn side_by_side<R: Send>(
    threads: Option<u64>,
    work: impl FnOnce() -> Result<R, StudyError> + Send,
) -> Result<R, Failure> {
    let Some(threads) = threads else { return Ok(work()?) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build();
    let pool = pool.map_err(|error| Failure::Argument(format!("--threads {threads}: {error}")))?;
    Ok(pool.install(work)?)
}

/// The scene with one choice of values.
fn varied(
    base: &SceneFile,
    arguments: &SceneArguments,
    variations: &[Variation],
    choice: &[&str],
) -> Result<SceneFile, Failure> {
    let keys = variations.iter().zip(choice);
    let values: Vec<String> =
        keys.map(|(variation, value)| format!("{}={value}", variation.key)).collect();
    let file = base.with_values(&values).map_err(|error| blamed(&error, variations))?;
    Ok(with_options(file, arguments))
}

/// An error of a value that is varied names the option that gives it.
fn blamed(error: &SceneError, variations: &[Variation]) -> Failure {
    let text = error.to_string();
    let is_varied = |variation: &Variation| {
        let option = format!("--set {}", variation.key);
        text.strip_prefix(&option).is_some_and(|rest| !rest.starts_with(['.', '[']))
    };
    match text.strip_prefix("--set ") {
        Some(rest) if variations.iter().any(is_varied) => {
            Failure::Argument(format!("--vary {rest}"))
        }
        _ => Failure::Argument(text),
    }
}

/// The seeds of a scene's runs.
fn seeds(file: &SceneFile, count: u64) -> Result<Vec<u64>, Failure> {
    let last = file.seed.checked_add(count - 1).ok_or_else(|| {
        let seed = file.seed;
        Failure::Argument(format!("--seeds {count}: from {seed} on there are not so many seeds"))
    })?;
    Ok((file.seed..=last).collect())
}

/// A key that an option gives one value cannot be given others.
fn refuse_both(arguments: &SceneArguments, variations: &[Variation]) -> Result<(), Failure> {
    let given = [
        ("precision", "--precision", arguments.precision.is_some()),
        ("engine", "--engine", arguments.engine.is_some()),
        ("stepped.dt", "--dt", arguments.dt.is_some()),
        ("duration", "--duration", arguments.duration.is_some()),
        ("seed", "--seed", arguments.seed.is_some()),
    ];
    let is_varied = |key: &str| variations.iter().any(|variation| variation.key == key);
    match given.into_iter().find(|(key, _, is_given)| *is_given && is_varied(key)) {
        None => Ok(()),
        Some((key, option, _)) => Err(Failure::Argument(format!(
            "--vary {key} and {option} both give it values; leave out one of them"
        ))),
    }
}
