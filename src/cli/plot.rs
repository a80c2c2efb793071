//! `carom plot`: the columns of a table as a picture.

mod histogram;

use std::path::Path;

use carom::output::write_whole;
use carom::study::chart::{Axis, Chart, Format, Look, Mark, Picture, Scale, Series};

use super::arguments::PlotArguments;
use super::failure::Failure;
use super::output_file::{Destination, OutputError};

/// Columns that are drawn in one chart, with what it shows. All others have a chart of
/// their own.
const TOGETHER: [(&str, &[&str]); 9] = [
    ("energy", &["energy", "kinetic", "translational", "rotational", "potential"]),
    ("momentum", &["px", "py", "pz"]),
    ("temperature", &["temperature", "spin_temperature"]),
    ("collisions", &["pairs", "surroundings"]),
    ("force", &["force_x", "force_y", "force_z"]),
    ("density", &["density", "maxwell"]),
    ("density of times", &["time_density", "time_at_random"]),
    ("density of paths", &["path_density", "path_at_random"]),
    ("centre of mass", &["center_x", "center_y", "center_z"]),
];

/// The columns of a file, each with its name.
type Columns = Vec<(String, Vec<Option<f64>>)>;

/// Draws a file.
pub fn plot(arguments: &PlotArguments) -> Result<(), Failure> {
    let path = &arguments.file;
    let output = arguments.output.clone().unwrap_or_else(|| path.with_extension("svg"));
    let charts = |title: &str, columns: Columns| {
        let columns = chosen(columns, &arguments.columns, path)?;
        Ok(histogram::charts(title, &columns, arguments.bins))
    };
    let look = arguments.pictures.look();
    match arguments.histogram {
        true => write(path, &output, charts, &look),
        false => draw(path, &output, &arguments.columns, &look),
    }
}

/// Draws columns of a file, or all of them, as a picture.
pub fn draw(path: &Path, output: &Path, names: &[String], look: &Look) -> Result<(), Failure> {
    let over_time = |title: &str, mut columns: Columns| {
        let (time, values) = columns[0].clone();
        if names.is_empty() {
            columns.remove(0);
        }
        let columns = chosen(columns, names, path)?;
        Ok(charts(title, &time, &values, &columns))
    };
    write(path, output, over_time, look)
}

/// Draws what is made of the columns of a file, as a picture.
fn write(
    path: &Path,
    output: &Path,
    charts: impl FnOnce(&str, Columns) -> Result<Vec<Chart>, Failure>,
    look: &Look,
) -> Result<(), Failure> {
    let shown = output.display();
    let format = Format::of(output).ok_or_else(|| {
        Failure::Argument(format!("-o is {shown}; its ending must be .svg, .png or .pdf"))
    })?;
    let refused = |source| Failure::Open { option: "-o", source };
    let target = Destination::replaceable("-o", output)?;
    let columns = read(path)?;
    let title = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
    let picture = Picture { charts: charts(&title, columns)? };
    let bytes = picture.bytes(format, look);
    let bytes =
        bytes.map_err(|reason| refused(OutputError::Path { path: output.into(), reason }))?;
    let written = write_whole(&target, &bytes);
    written.map_err(|source| OutputError::Write { path: output.into(), source }.into())
}

/// All columns; a field that is no number is `None`.
fn read(path: &Path) -> Result<Columns, Failure> {
    let failed = |reason: String| Failure::Argument(format!("{}: {reason}", path.display()));
    let mut reader = csv::Reader::from_path(path).map_err(|error| failed(error.to_string()))?;
    let names = reader.headers().map_err(|error| failed(error.to_string()))?.clone();
    let mut columns: Columns = names.iter().map(|name| (name.to_owned(), Vec::new())).collect();
    for record in reader.records() {
        let record = record.map_err(|error| failed(error.to_string()))?;
        for ((_, column), field) in columns.iter_mut().zip(&record) {
            column.push(field.parse().ok().filter(|value: &f64| value.is_finite()));
        }
    }
    if columns.len() < 2 || columns[0].1.iter().flatten().next().is_none() {
        let wanted = "it must have names in its first line and at least two columns of numbers, the \
                      first one the time, as `carom run --series` writes it";
        return Err(failed(wanted.to_owned()));
    }
    Ok(columns)
}

/// The columns that are asked for, or all with a number in them.
fn chosen(columns: Columns, names: &[String], path: &Path) -> Result<Columns, Failure> {
    if names.is_empty() {
        let has_numbers = |column: &[Option<f64>]| column.iter().any(Option::is_some);
        return Ok(columns.into_iter().filter(|(_, column)| has_numbers(column)).collect());
    }
    let known = || columns.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
    let find = |name: &String| {
        columns.iter().find(|(other, _)| other == name).cloned().ok_or_else(|| {
            let path = path.display();
            Failure::Argument(format!(
                "--columns: {path} has no column {name:?}; it has {}",
                known()
            ))
        })
    };
    names.iter().map(find).collect()
}

/// A chart for each kind of figure, in the order of the columns.
fn charts(
    title: &str,
    time: &str,
    values: &[Option<f64>],
    columns: &[(String, Vec<Option<f64>>)],
) -> Vec<Chart> {
    let mut charts: Vec<Chart> = Vec::new();
    for (name, column) in columns {
        let together = TOGETHER.iter().find(|(_, names)| names.contains(&name.as_str()));
        let label = together.map_or(name.as_str(), |(label, _)| label);
        let own = charts.iter().position(|chart| chart.y.label == label).unwrap_or(charts.len());
        if own == charts.len() {
            charts.push(Chart {
                title: title.to_owned(),
                x: Axis::new(time, Scale::Linear),
                y: Axis::new(label, Scale::Linear),
                series: Vec::new(),
            });
        }
        let series = &mut charts[own].series;
        let points = values.iter().zip(column).filter_map(|(time, value)| time.zip(*value));
        series.push(Series::new(name, points).color(series.len()).mark(Mark::Line));
    }
    charts
}
