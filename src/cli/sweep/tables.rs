//! Tables: the runs of a sweep as rows, and their means.

use std::path::Path;

use carom::study::table::{Table, digits, plain};
use carom::study::{Folder, StudyError};

use super::figures::{Mean, Outcome, found_names, names};

/// What the report shows of the means.
const SHOWN: [&str; 7] = [
    "temperature",
    "compressibility",
    "collision_rate",
    "mean_free_path",
    "pairs",
    "surroundings",
    "energy_change",
];

/// The figures of which a run may give an error.
const WITH_ERRORS: [&str; 6] = [
    "temperature",
    "spin_temperature",
    "compressibility",
    "pressure",
    "collision_rate",
    "mean_free_path",
];

/// Runs that differ in nothing but the seed.
pub struct Group<'a> {
    /// The values of the keys.
    pub values: Vec<&'a str>,
    pub seeds: Vec<u64>,
    pub runs: &'a [Outcome],
}

/// The runs, one row each.
pub fn write_runs(folder: &Folder, keys: &[&str], groups: &[Group<'_>]) -> Result<(), StudyError> {
    let owned = |name: &str| name.to_owned();
    let figures = ["seed"].into_iter().chain(names()).map(owned);
    let errors = WITH_ERRORS.iter().map(|name| format!("{name}_error"));
    let runs = || groups.iter().flat_map(|group| group.runs);
    let found = found_names(runs());
    let of_analyses = found.iter().flat_map(|name| [owned(name), format!("{name}_error")]);
    let files = runs().map(|run| run.files.len()).max().unwrap_or(0);
    let of_files = (0..files).map(|index| format!("analyse[{index}].file"));
    let last = ["seconds", "state_hash", "failure"].map(owned);
    let header = keys.iter().copied().map(owned).chain(figures).chain(errors);
    let header = header.chain(of_analyses).chain(of_files).chain(last);
    let header = header.collect();
    let rows = groups.iter().flat_map(|group| {
        group.seeds.iter().zip(group.runs).map(|(seed, run)| {
            let figures = names().map(|name| run.figures.get(name));
            let errors = WITH_ERRORS.iter().map(|name| run.errors.get(*name));
            let found =
                found.iter().flat_map(|name| [run.figures.get(*name), run.errors.get(*name)]);
            let files = (0..files).map(|index| run.files.get(index).cloned().unwrap_or_default());
            let text = |text: &Option<String>| text.clone().unwrap_or_default();
            let values = group.values.iter().map(|value| (*value).to_owned());
            values
                .chain([seed.to_string()])
                .chain(
                    figures
                        .chain(errors)
                        .chain(found)
                        .map(|number| number.map_or_else(String::new, |n| plain(*n))),
                )
                .chain(files)
                .chain([digits(run.seconds), text(&run.state_hash), text(&run.failure)])
                .collect()
        })
    });
    write(folder, "runs.csv", header, rows)
}

/// The means over the seeds, with their errors.
pub fn write_means(folder: &Folder, keys: &[&str], groups: &[Group<'_>]) -> Result<(), StudyError> {
    let found = found_names(groups.iter().flat_map(|group| group.runs));
    let known = || names().map(|name| -> &str { name });
    let names = || known().chain(found.iter().copied());
    let figures = names().flat_map(|name| [name.to_owned(), format!("{name}_error")]);
    let header = keys.iter().map(|key| (*key).to_owned());
    let header = header.chain(["runs".to_owned()]).chain(figures).collect();
    let rows = groups.iter().map(|group| {
        let figures = names().flat_map(|name| {
            let mean = Mean::of(name, group.runs);
            let number = |number: Option<f64>| number.map_or_else(String::new, plain);
            [number(mean.map(|mean| mean.mean)), number(mean.and_then(|mean| mean.error))]
        });
        let values = group.values.iter().map(|value| (*value).to_owned());
        values.chain([finished(group).to_string()]).chain(figures).collect()
    });
    write(folder, "means.csv", header, rows)
}

/// How many of the runs came to their end.
fn finished(group: &Group<'_>) -> usize {
    group.runs.iter().filter(|run| run.failure.is_none()).count()
}

fn write(
    folder: &Folder,
    name: &str,
    header: Vec<String>,
    rows: impl Iterator<Item = Vec<String>>,
) -> Result<(), StudyError> {
    let failed = |source| StudyError::File { path: folder.path().join(name), source };
    let mut table = csv::Writer::from_writer(Vec::new());
    for row in [header].into_iter().chain(rows) {
        table.write_record(row).map_err(|error| failed(std::io::Error::other(error)))?;
    }
    let bytes = table.into_inner().map_err(|error| failed(error.into_error()))?;
    folder.write(name, &bytes)
}

/// What a person reads: the means that there are.
pub fn report(name: &str, keys: &[&str], groups: &[Group<'_>], folder: &Path) -> String {
    let seeds = groups.first().map_or(0, |group| group.seeds.len());
    let is_there = |name: &&str| {
        groups.iter().any(|group| Mean::of(name, group.runs).is_some_and(|mean| mean.mean != 0.0))
    };
    let found = found_names(groups.iter().flat_map(|group| group.runs));
    let shown: Vec<&str> = SHOWN.into_iter().chain(found).filter(is_there).collect();
    let mut table = Table::default();
    table.row(&keys.join(", "), shown.iter().map(|name| (*name).to_owned()));
    for group in groups {
        let cells = shown
            .iter()
            .map(|name| Mean::of(name, group.runs).map_or_else(|| "-".to_owned(), Mean::shown));
        let failed = group.runs.len() - finished(group);
        let failed = (failed > 0).then(|| format!("({failed} failed)"));
        table.row(&group.values.join(", "), cells.chain(failed));
    }
    let plural = if seeds == 1 { "seed" } else { "seeds, errors of means over them" };
    let runs: usize = groups.iter().map(|group| group.runs.len()).sum();
    format!(
        "{name}: {runs} runs, {seeds} {plural}\n\n{table}\nTables are in {}.\n",
        folder.display()
    )
}
