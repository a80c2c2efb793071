//! The studies from outside: their folders, their interruptions, their
//! mistakes.

mod error;
mod precision;
mod scaling;

use std::fs;

use super::{BOX, FLUID, Folder, Said};

/// An interrupt loses none of the finished points, and says where they are.
#[cfg(unix)]
#[test]
fn an_interrupted_study_keeps_its_points() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let folder = Folder::with(FLUID);
    let arguments = "study error scene.toml --runs 300 --output kept";
    let mut study = folder
        .program(arguments.split_whitespace())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let points = || {
        let text = fs::read_to_string(folder.path("kept/points.jsonl")).unwrap_or_default();
        text.lines().count()
    };
    let start = Instant::now();
    while points() < 3 && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(study.try_wait().unwrap().is_none(), "it was too quick to be interrupted");
    assert!(
        Command::new("kill").args(["-INT", &study.id().to_string()]).status().unwrap().success()
    );
    let said = Said::from(study.wait_with_output().unwrap());
    assert_eq!((said.status, said.output.as_str()), (Some(130), ""), "{said:?}");
    assert!(said.errors.contains("the finished points are in kept"), "{said:?}");
    // No report, and the points of a heading and two lines at least.
    assert_eq!(fs::read_dir(folder.path("kept")).unwrap().count(), 1);
    assert!(points() >= 3);
}

#[test]
fn unknown_studies_and_scenes_are_named() {
    let folder = Folder::with(BOX);
    let said = folder.says("study");
    assert_eq!(said.status, Some(2));
    for study in ["error", "precision", "scaling", "stability"] {
        assert!(said.errors.contains(study), "{study}");
    }
    let message = folder.says("study precisoin scene.toml").fails_with(2);
    assert!(message.contains("precisoin"), "{message}");
    let message = folder.says("study error no-such-scene").fails_with(2);
    assert!(message.contains("no built-in scene `no-such-scene`"), "{message}");
    let message = folder.says("study error").fails_with(2);
    assert!(message.contains("<SCENE>"), "{message}");
    assert_eq!(folder.names(), ["scene.toml"]);
}
