//! Full disks, closed pipes, and standard output as a file.

#![cfg(target_os = "linux")]

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::process::Stdio;

use crate::{BOX, Folder, Said};

#[test]
fn a_full_disk_is_told() {
    let folder = Folder::with(BOX);
    for option in ["--events", "--state"] {
        let message = folder.says(&format!("run scene.toml {option} /dev/full")).fails_with(1);
        assert!(message.contains("/dev/full") && message.contains("space"), "{message}");
    }
    for arguments in ["run scene.toml", "run scene.toml --json", "scenes", "--help", "explain"] {
        let full = File::create("/dev/full").unwrap();
        let output = folder.program(arguments.split(' ')).stdout(full).output().unwrap();
        let message = Said::from(output).fails_with(1);
        assert!(message.contains("standard output"), "{arguments}: {message}");
    }
    assert_eq!(folder.names(), ["scene.toml"]);
    assert!(!std::fs::metadata("/dev/full").unwrap().is_file());
}

/// Once a file of the run cannot be written, none gets its name.
#[test]
fn a_full_disk_spoils_the_other_file_too() {
    let folder = Folder::with(BOX);
    folder.says("run scene.toml --events /dev/full --state state.csv").fails_with(1);
    folder.says("run scene.toml --state /dev/full --events events.csv").fails_with(1);
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn a_closed_pipe_is_no_error() {
    let folder = Folder::with(BOX);
    for arguments in [
        "run scene.toml",
        "run scene.toml --json",
        "run scene.toml --duration 60 --events /dev/stdout",
        "run scene.toml --state -",
        "scenes",
        "scenes superball",
        "explain",
        "--help",
        "run --help",
        "--version",
    ] {
        let mut child = folder
            .program(arguments.split(' '))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let said = Said::from(child.wait_with_output().unwrap());
        said.well();
    }
}

#[test]
fn the_first_lines_of_a_long_file_are_to_be_had() {
    let folder = Folder::with(BOX);
    let run = "run scene.toml --duration 1e6 --events /dev/stdout";
    let mut child = folder
        .program(run.split(' '))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.next().unwrap().unwrap().starts_with("time,a,b,"));
    assert!(lines.next().is_some());
    drop(lines);
    Said::from(child.wait_with_output().unwrap()).well();
}

#[test]
fn standard_output_holds_a_file_and_nothing_else() {
    let folder = Folder::with(BOX);
    for path in ["-", "/dev/stdout"] {
        let said = folder.says(&format!("run scene.toml --state {path}"));
        assert_eq!(said.status, Some(0));
        assert_eq!(said.output.lines().count(), 21);
        assert!(said.errors.contains("state hash"));
    }
    // Under its own name too: replaced, it would lose what is printed later.
    let out = File::create(folder.path("out.csv")).unwrap();
    let mut program = folder.program("run scene.toml --state out.csv".split(' '));
    let said = Said::from(program.stdout(out).output().unwrap());
    assert_eq!(said.status, Some(0), "{said:?}");
    assert_eq!(folder.read("out.csv").lines().count(), 21);
    assert_eq!(folder.names(), ["out.csv", "scene.toml"]);
}

/// Shells complete commands and options.
#[test]
fn shells_are_told_what_to_complete() {
    let folder = Folder::with(BOX);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.says(&format!("completions {shell}")).well();
        for word in ["carom", "sweep", "--record-every", "completions"] {
            let word = if shell == "fish" { word.trim_start_matches('-') } else { word };
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
    let error = folder.says("completions tcsh").fails_with(2);
    assert!(error.contains("fish"), "{error}");
}
