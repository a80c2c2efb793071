//! The files that a run writes, opened before it starts.

use std::path::Path;

use super::arguments::RunArguments;
use super::failure::Failure;
use super::output_file::{Destination, OutputError, OutputFile};

/// The files of a run.
pub struct Outputs {
    pub events: Option<OutputFile>,
    pub state: Option<OutputFile>,
    /// Whether standard output holds one of them, and no summary.
    pub take_standard_output: bool,
}

impl Outputs {
    /// Opens what the arguments name.
    pub fn open(arguments: &RunArguments) -> Result<Self, Failure> {
        let events = destination("--events", arguments.events.as_deref())?;
        let state = destination("--state", arguments.state.as_deref())?;
        let named = [("--events", &events), ("--state", &state)];
        if let (Some(one), Some(other)) = (&events, &state)
            && one == other
            && !is_device(one)
        {
            return Err(Failure::Argument(
                "--events and --state name the same file; give each its own".to_owned(),
            ));
        }
        let scene = arguments.scene.scene.as_deref().and_then(|path| path.canonicalize().ok());
        for (option, destination) in named {
            match destination {
                Some(Destination::StandardOutput) if arguments.json => {
                    return Err(Failure::Argument(format!(
                        "{option} and --json both want standard output; give {option} a file"
                    )));
                }
                Some(Destination::Regular(path)) if scene.as_ref() == Some(path) => {
                    return Err(Failure::Argument(format!(
                        "{option} would replace the scene file {}; give it another name",
                        path.display()
                    )));
                }
                _ => {}
            }
        }
        Ok(Self {
            events: open("--events", arguments.events.as_deref())?,
            state: open("--state", arguments.state.as_deref())?,
            take_standard_output: [events, state].contains(&Some(Destination::StandardOutput)),
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
