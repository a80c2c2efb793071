//! `carom sweep`: a scene once for each value of some of its keys.

mod figures;
mod point;
mod tables;

use std::path::Path;

use carom::engine::Execution;
use carom::scene::SceneFile;
use carom::study::{Order, Point, StudyError, Subject};

use super::arguments::SweepArguments;
use super::failure::Failure;
use super::print;
use super::scene_argument::scene_file;
use super::study::watch::Teller;
use super::variation::{
    Variation, blamed, choices, count, refuse_both, seeds, tell_passed_over, varied,
};
use figures::Outcome;
use tables::{Group, report, write_means, write_runs};

/// How long a run takes, seconds: it is not known before the first one. Only the
/// proportions count.
const UNKNOWN: f64 = f64::MIN_POSITIVE;

/// The folder of the files of analyses, in that of the sweep.
const ANALYSES: &str = "analyses";

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
    let keys: Vec<&str> = variations.iter().map(|variation| variation.key.as_str()).collect();
    refuse_both(&arguments.scene, &keys)?;
    let choices = choices(&variations);
    let files = choices
        .iter()
        .map(|choice| varied(&base, &arguments.scene, &keys, choice))
        .collect::<Result<Vec<_>, _>>()?;
    let seeds = files
        .iter()
        .map(|file| seeds(file, "--seeds", arguments.seeds))
        .collect::<Result<Vec<_>, _>>()?;
    let execution = arguments.scene.execution().threads(1);
    if let Some(first) = files.first() {
        point::check(first, execution).map_err(|failure| match failure {
            Failure::Scene(error) => blamed(&error, &keys),
            other => other,
        })?;
    }
    tell_passed_over(&base, "a sweep", &["[[analyse]]"]);
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
    let folder = arguments.folder.open(&format!("sweep-{}", base.name))?;
    let journal = folder.journal(&("sweep", common, options))?;
    let analysed = folder.path().join(ANALYSES);
    if !base.analyses()?.is_empty() {
        std::fs::create_dir_all(&analysed).map_err(|error| StudyError::NoFolder {
            path: analysed.clone(),
            reason: error.to_string(),
        })?;
    }
    let teller = Teller::new(folder.path());
    let outcomes = side_by_side(arguments.scene.threads, || {
        let points = planned.iter().map(|planned| planned.point(execution, &analysed));
        let points: Vec<_> = points.collect();
        Point::all(&points, &journal, Order::AtOnce, &teller)
    })?;
    drop(teller);

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
    /// Its analyses go into files in a folder, by its key: of more values and seeds, those that
    /// are there keep theirs.
    fn point<'a>(&'a self, execution: Execution, folder: &'a Path) -> Point<'a, Outcome> {
        let analysed = point::Analysed { folder, key: &self.key };
        Point::new(&self.key, UNKNOWN, move || Ok(point::outcome(&self.file, execution, analysed)))
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
