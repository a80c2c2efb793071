//! The command line, from the arguments to the exit status.

mod analyse;
mod analyses;
mod arguments;
mod asked;
mod batch;
mod boxes;
mod closed_output;
mod completions;
mod conclusion;
mod events;
mod explain;
mod failure;
mod interrupt;
mod journey;
mod kept;
mod measured;
mod outline;
mod outlook;
mod output_file;
mod outputs;
mod pace;
mod picture;
mod pictures;
mod plain;
mod plot;
mod progress;
mod recording;
mod run;
mod scene_argument;
mod scenes;
mod series;
mod shown;
mod study;
mod summary;
mod sweep;
mod variation;
mod view;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command, RunArguments};
use failure::Failure;
use plain::{acts_on_terminals, plain};

/// Runs the program.
pub fn main() -> ExitCode {
    interrupt::watch();
    let result = match Arguments::try_parse() {
        Ok(Arguments { command }) => match command {
            None => run::run(&RunArguments::default()),
            Some(Command::Run(arguments)) => run::run(&arguments),
            Some(Command::Explain(arguments)) => explain::explain(&arguments),
            Some(Command::Scenes { name, schema }) => scenes::scenes(name.as_deref(), schema),
            Some(Command::Analyse(arguments)) => analyse::analyse(&arguments),
            Some(Command::Plot(arguments)) => plot::plot(&arguments),
            Some(Command::Picture(arguments)) => picture::picture(&arguments),
            Some(Command::View(arguments)) => view::view(&arguments),
            Some(Command::Sweep(arguments)) => sweep::sweep(&arguments),
            Some(Command::Batch(arguments)) => batch::batch(&arguments),
            Some(Command::Study { study }) => study.run(),
            Some(Command::Completions { shell }) => completions::completions(shell),
        },
        Err(answer) => return answered(&answer),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failed(&failure),
    }
}

/// Help, the version, or a mistake in the arguments.
fn answered(answer: &clap::Error) -> ExitCode {
    let given: Vec<_> =
        std::env::args_os().map(|given| given.to_string_lossy().into_owned()).collect();
    let is_plain =
        !given.iter().any(|given| given.chars().any(acts_on_terminals) || given.len() > 200);
    if answer.use_stderr() && !is_plain {
        // Without colours, and each line on its own.
        for line in answer.to_string().lines() {
            let _ = writeln!(io::stderr(), "{}", plain(line));
        }
        return ExitCode::from(2);
    }
    if !answer.use_stderr()
        && let Err(closed) = standard_output()
    {
        return failed(&closed);
    }
    match answer.print().and_then(|()| io::stdout().flush()) {
        Ok(()) => ExitCode::from(u8::try_from(answer.exit_code()).unwrap_or(2)),
        Err(error) => failed(&Failure::Print(error)),
    }
}

fn failed(failure: &Failure) -> ExitCode {
    if failure.is_closed_pipe() {
        return ExitCode::SUCCESS;
    }
    if let Failure::Kept { words, .. } = failure {
        let _ = writeln!(io::stderr(), "\n{}", plain(words));
        return ExitCode::from(failure.exit_status());
    }
    // No message can be written when standard error is closed too.
    let _ = writeln!(io::stderr(), "error: {}", plain(&failure.to_string()));
    ExitCode::from(failure.exit_status())
}

/// Standard output, if there is one.
fn standard_output() -> Result<io::Stdout, Failure> {
    closed_output::open().map_err(Failure::Print)?;
    Ok(io::stdout())
}

/// Prints to standard output, all of it.
fn print(text: &str) -> Result<(), Failure> {
    let mut output = standard_output()?.lock();
    output.write_all(text.as_bytes()).and_then(|()| output.flush()).map_err(Failure::Print)
}
