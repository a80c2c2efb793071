//! The files that a run writes, opened before it starts.

use std::path::Path;

use super::arguments::RunArguments;
use super::failure::Failure;
use super::kept::Notes;
use super::output_file::{Destination, KeptFile, OutputError, OutputFile};

/// What names the files of analyses.
const ANALYSE: &str = "[[analyse]] file";

/// The files of a run.
pub struct Outputs {
    pub events: Option<OutputFile>,
    pub state: Option<OutputFile>,
    pub record: Option<OutputFile>,
    pub series: Option<OutputFile>,
    pub analyses: Vec<OutputFile>,
    /// Whether standard output holds one of them, and no summary.
    pub take_standard_output: bool,
}

impl Outputs {
    /// Opens what the arguments and the scene name.
    pub fn open(
        arguments: &RunArguments,
        record: Option<&Path>,
        series: Option<&Path>,
        snapshot: Option<&Path>,
        analyses: &[&Path],
        notes: Option<&Notes>,
    ) -> Result<Self, Failure> {
        let asked = [
            ("--events", arguments.events.as_deref()),
            ("--state", arguments.state.as_deref()),
            ("--record", record),
            ("--series", series),
            ("--snapshot", snapshot),
        ];
        let mut named: Vec<(&'static str, Destination)> = Vec::new();
        let scene = arguments.scene.scene.as_deref().and_then(|path| path.canonicalize().ok());
        let analysed = analyses.iter().map(|path| (ANALYSE, Some(*path)));
        for (option, path) in asked.into_iter().chain(analysed) {
            let Some(destination) = destination(option, path)? else { continue };
            let is_same = |(_, other): &&(_, _)| *other == destination && !is_device(other);
            if let Some((other, _)) = named.iter().find(is_same) {
                return Err(Failure::Argument(format!(
                    "{other} and {option} name the same file; give each its own"
                )));
            }
            match &destination {
                Destination::StandardOutput if arguments.json => {
                    return Err(Failure::Argument(format!(
                        "{option} and --json both want standard output; give {option} a file"
                    )));
                }
                Destination::Regular(path) if scene.as_ref() == Some(path) => {
                    return Err(Failure::Argument(format!(
                        "{option} would replace the scene file {}; give it another name",
                        path.display()
                    )));
                }
                _ => {}
            }
            named.push((option, destination));
        }
        let is_standard = |(_, destination): &_| *destination == Destination::StandardOutput;
        // Of a run that is kept or goes on, what is on the disk counts.
        let in_parts = snapshot.is_some() || notes.is_some();
        let on_the_way = |option, path: Option<&Path>, kept: Option<&KeptFile>| {
            if !in_parts {
                return open(option, path);
            }
            let file = path.map(|path| OutputFile::open_part(path, kept)).transpose();
            file.map_err(refused(option))
        };
        let kept_events = notes.and_then(|notes| notes.events.as_ref()?.file.as_ref());
        let kept_record = notes.and_then(|notes| notes.record.as_ref()?.file.as_ref());
        let kept_series = notes.and_then(|notes| notes.series.as_ref()?.file.as_ref());
        Ok(Self {
            events: on_the_way("--events", arguments.events.as_deref(), kept_events)?,
            state: open("--state", arguments.state.as_deref())?,
            record: on_the_way("--record", record, kept_record)?,
            series: on_the_way("--series", series, kept_series)?,
            analyses: analyses
                .iter()
                .map(|path| OutputFile::open(path).map_err(refused(ANALYSE)))
                .collect::<Result<_, _>>()?,
            take_standard_output: named.iter().any(is_standard),
        })
    }
}

/// Whether two streams into it do not mix: `/dev/null`, `/dev/full`.
fn is_device(destination: &Destination) -> bool {
    let Destination::Special(path) = destination else { return false };
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        path.metadata().is_ok_and(|metadata| metadata.file_type().is_char_device())
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        true
    }
}

fn destination(option: &'static str, path: Option<&Path>) -> Result<Option<Destination>, Failure> {
    path.map(Destination::of).transpose().map_err(refused(option))
}

fn open(option: &'static str, path: Option<&Path>) -> Result<Option<OutputFile>, Failure> {
    path.map(OutputFile::open).transpose().map_err(refused(option))
}

fn refused(option: &'static str) -> impl Fn(OutputError) -> Failure {
    move |source| Failure::Open { option, source }
}
