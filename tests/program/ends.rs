//! How the program ends, by a signal, a limit or an output that is gone, and what
//! it leaves behind.

#![cfg(target_os = "linux")]

use std::fs;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::{BOX, FLUID, Folder, Said};

/// Longer than any test waits.
const ENDLESS: &str =
    "run scene.toml --engine event-driven --duration 1e9 --events events.csv --state state.csv";

/// Waits for something.
fn wait_for(what: &str, mut is_there: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_there() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        sleep(Duration::from_millis(10));
    }
}

/// A run under way, which writes two files.
fn under_way(folder: &Folder) -> Child {
    fs::write(folder.path("state.csv"), "old").unwrap();
    let mut program = folder.program(ENDLESS.split(' '));
    let child = program.stderr(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    wait_for("two files under way", || temporary(folder).len() == 2);
    child
}

/// The names of files that are not whole.
fn temporary(folder: &Folder) -> Vec<String> {
    folder.names().into_iter().filter(|name| name.starts_with(".carom-")).collect()
}

fn kill(signal: &str, child: &Child) {
    let status = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(status.unwrap().success());
}

/// Whether the tests were started with a signal ignored, as `nohup` and shells without
/// job control do: a program that they start leaves it ignored.
fn is_ignored(signal: u32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[test]
fn each_signal_has_its_status_and_nothing_is_left() {
    for (signal, number) in [("-TERM", 15), ("-HUP", 1), ("-INT", 2)] {
        if is_ignored(number) {
            continue;
        }
        let status = 128 + number as i32;
        let folder = Folder::with(BOX);
        let child = under_way(&folder);
        kill(signal, &child);
        let said = Said::from(child.wait_with_output().unwrap());
        assert_eq!((said.status, said.output.as_str()), (Some(status), ""), "{signal} {said:?}");
        assert_eq!(folder.names(), ["scene.toml", "state.csv"], "{signal}");
        assert_eq!(folder.read("state.csv"), "old");
    }
    // Without a file to write, too.
    let folder = Folder::with(BOX);
    let child = folder.program("run scene.toml --duration 1e9".split(' ')).spawn().unwrap();
    sleep(Duration::from_millis(300));
    kill("-TERM", &child);
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(143));
}

/// `nohup` keeps its word.
#[test]
fn a_hangup_that_is_to_be_ignored_is() {
    let folder = Folder::with(BOX);
    let script = format!("trap '' HUP; exec {} {ENDLESS}", env!("CARGO_BIN_EXE_carom"));
    let mut child =
        Command::new("sh").args(["-c", &script]).current_dir(folder.folder.path()).spawn().unwrap();
    wait_for("two files under way", || temporary(&folder).len() == 2);
    kill("-HUP", &child);
    sleep(Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none());
    kill("-TERM", &child);
    assert_eq!(child.wait().unwrap().code(), Some(143));
}

/// What a killed run leaves is known by its process, and removed by the next
/// one that writes there. One that is under way keeps its own.
#[test]
fn what_killed_runs_leave_is_removed() {
    let folder = Folder::with(BOX);
    let mut child = under_way(&folder);
    let own = format!(".carom-{}-", child.id());
    assert!(temporary(&folder).iter().all(|name| name.starts_with(&own)));
    let other = folder.says("run scene.toml --state other.csv");
    other.well();
    assert_eq!(temporary(&folder).len(), 2);
    kill("-KILL", &child);
    child.wait().unwrap();
    assert_eq!(temporary(&folder).len(), 2);
    assert_eq!(folder.read("state.csv"), "old");
    folder.says("run scene.toml --state other.csv").well();
    assert_eq!(folder.names(), ["other.csv", "scene.toml", "state.csv"]);
}

/// A file that may not grow any more is like a full disk.
#[test]
fn a_limit_of_a_file_leaves_the_old_one() {
    let folder = Folder::with(BOX);
    fs::write(folder.path("events.csv"), "old").unwrap();
    let run = "run scene.toml --duration 60 --events events.csv --state state.csv";
    let script = format!("ulimit -f 8; exec {} {run}", env!("CARGO_BIN_EXE_carom"));
    let output =
        Command::new("sh").args(["-c", &script]).current_dir(folder.folder.path()).output();
    let message = Said::from(output.unwrap()).fails_with(1);
    assert!(message.contains("events.csv could not be written to its end"), "{message}");
    assert_eq!(folder.names(), ["events.csv", "scene.toml"]);
    assert_eq!(folder.read("events.csv"), "old");
    // A table under way, and the rest of one at the end; one that is kept ends with its run.
    fs::write(folder.path("run.parquet"), "old").unwrap();
    for (every, kept) in [("1e-4", ""), ("0.1", ""), ("1e-4", "--snapshot kept.snapshot")] {
        let run = format!(
            "run scene.toml --engine event-driven --record run.parquet --record-every {every} {kept}"
        );
        let script = format!("ulimit -f 8; exec {} {run}", env!("CARGO_BIN_EXE_carom"));
        let output =
            Command::new("sh").args(["-c", &script]).current_dir(folder.folder.path()).output();
        let message = Said::from(output.unwrap()).fails_with(1);
        assert!(message.contains("run.parquet could not be written to its end"), "{message}");
        assert_eq!(folder.names(), ["events.csv", "run.parquet", "scene.toml"]);
        assert_eq!(folder.read("run.parquet"), "old");
    }
}

/// Runs a line of a shell in a folder.
fn shell(folder: &Folder, line: &str) -> Said {
    let line = line.replace("carom", env!("CARGO_BIN_EXE_carom"));
    let output = Command::new("sh").args(["-c", &line]).current_dir(folder.folder.path()).output();
    Said::from(output.unwrap())
}

#[test]
fn a_closed_standard_output_is_an_error() {
    let folder = Folder::with(BOX);
    for arguments in [
        "run scene.toml",
        "run scene.toml --json",
        "run scene.toml --state -",
        "run scene.toml --state state.csv",
        "explain scene.toml",
        "scenes",
        "--help",
        "--version",
    ] {
        let message = shell(&folder, &format!("carom {arguments} >&-")).fails_with(1);
        assert!(message.contains("standard output") && message.contains("closed"), "{message}");
        assert_eq!(message.lines().count(), 1);
    }
    assert_eq!(folder.names(), ["scene.toml"]);
    // Thrown away is not closed.
    assert_eq!(shell(&folder, "carom run scene.toml >/dev/null").status, Some(0));
    assert_eq!(shell(&folder, "carom run scene.toml 1<>/dev/null").status, Some(0));
    // A mistake is a mistake all the same.
    let message = shell(&folder, "carom run scene.toml --dt 0 >&-").fails_with(2);
    assert!(message.contains("--dt"), "{message}");
}

#[test]
fn what_is_no_regular_file_is_no_scene() {
    let folder = Folder::with(BOX);
    fs::create_dir(folder.path("folder")).unwrap();
    fs::create_dir(folder.path("folder.toml")).unwrap();
    fs::create_dir(folder.path("pi")).unwrap();
    assert!(Command::new("mkfifo").arg(folder.path("pipe")).status().unwrap().success());
    for (scene, what) in [
        ("folder", "a folder"),
        ("folder.toml", "a folder"),
        ("./pi", "a folder"),
        (".", "a folder"),
        ("pipe", "a pipe"),
        ("./pipe", "a pipe"),
        ("/dev/zero", "a device"),
        ("/dev/null", "a device"),
    ] {
        for command in ["run", "explain", "study error"] {
            let message = folder.says(&format!("{command} {scene}")).fails_with(2);
            assert!(message.contains(what) && message.contains("scene file"), "{message}");
        }
    }
    // A folder does not stand in the way of a built-in scene.
    folder.says("explain pi").well();
    let message = folder.says("run scene.toml --state pipe").fails_with(2);
    assert!(message.contains("--state: pipe") && message.contains("named pipe"), "{message}");
    // A pipe of the shell's is open already.
    let said = Command::new("bash")
        .args(["-c", &format!("{} run scene.toml --state >(wc -l)", env!("CARGO_BIN_EXE_carom"))])
        .current_dir(folder.folder.path())
        .output();
    if let Ok(output) = said {
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
    folder.says("run scene.toml --state /dev/null --events /dev/null").well();
}

#[test]
fn one_study_at_a_time_in_a_folder() {
    let folder = Folder::with(FLUID);
    let study = "study error scene.toml --runs 900 --output kept";
    let mut first = folder
        .program(study.split(' '))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for("a point", || {
        fs::read_to_string(folder.path("kept/points.jsonl")).is_ok_and(|text| text.len() > 10)
    });
    for options in ["", " --restart"] {
        let message = folder.says(&format!("{study}{options}")).fails_with(1);
        assert!(message.contains(&format!("process {}", first.id())), "{message}");
        assert!(message.contains("--output"), "{message}");
    }
    kill("-TERM", &first);
    assert_eq!(first.wait().unwrap().code(), Some(143));
    let kept: Vec<_> = fs::read_dir(folder.path("kept"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert!(!kept.iter().any(|name| name.starts_with(".carom")), "{kept:?}");
}

#[test]
fn a_damaged_journal_names_its_line() {
    let folder = Folder::with(BOX);
    let study = "study error scene.toml --precision f64 --dt 0.01 --runs 1 --lanes auto --output o";
    folder.says(study).well();
    let journal = folder.path("o/points.jsonl");
    let mut bytes = fs::read(&journal).unwrap();
    let ends: Vec<_> = (0..bytes.len()).filter(|k| bytes[*k] == b'\n').collect();
    bytes[ends[0] + 1] = 0xff;
    fs::write(&journal, &bytes).unwrap();
    let message = folder.says(study).fails_with(1);
    assert!(message.contains("points.jsonl:2:") && message.contains("--restart"), "{message}");
    assert_eq!(fs::read(&journal).unwrap(), bytes);
    folder.says(&format!("{study} --restart")).well();
}
