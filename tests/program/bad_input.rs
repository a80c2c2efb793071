//! What the program refuses: exit status 2, one message that says where, what,
//! and what would be right; nothing is run and nothing written.

use std::fs;

use crate::{BOX, Folder};

/// Refuses `run scene.toml` with these options; the message has these words.
#[track_caller]
fn refused(scene: &str, options: &str, words: &[&str]) {
    let folder = Folder::with(scene);
    let run = format!("run scene.toml --state state.csv {options}");
    let message = folder.says(&run).fails_with(2);
    for word in words {
        assert!(message.contains(word), "no {word:?} in: {message}");
    }
    assert_eq!(folder.names(), ["scene.toml"], "{message}");
}

/// The box with a line replaced.
fn with(line: &str, other: &str) -> String {
    assert_eq!(BOX.matches(line).count(), 1);
    BOX.replace(line, other)
}

#[test]
fn mistakes_in_the_file() {
    let mistakes: &[(&str, &str, &[&str])] = &[
        ("seed = 3", "sede = 3", &["scene.toml:4:", "sede"]),
        ("seed = 3", "seed = \"three\"", &["scene.toml:4:", "seed"]),
        ("seed = 3", "seed = ", &["scene.toml:4:"]),
        ("mass = 3.0", "mass = \"heavy\"", &["scene.toml:21:", "mass"]),
        ("radius = 0.5", "radius = nan", &["scene.toml:20:", "radius", "NaN"]),
        ("radius = 0.5", "radius = 0.0", &["scene.toml:20:", "radius", "0"]),
        ("radius = 0.5", "radius = -0.5", &["scene.toml:20:", "radius", "-0.5"]),
        ("radius = 0.5", "radius = inf", &["scene.toml:20:", "radius", "inf"]),
        ("mass = 3.0", "mass = nan", &["scene.toml:21:", "mass"]),
        ("mass = 3.0", "mass = 0", &["scene.toml:21:", "mass"]),
        ("mass = 3.0", "mass = -3", &["scene.toml:21:", "mass"]),
        ("mass = 3.0", "mass = inf", &["scene.toml:21:", "mass"]),
        ("duration = 2.0", "duration = nan", &["scene.toml:2:", "duration"]),
        ("duration = 2.0", "duration = 0", &["scene.toml:2:", "duration"]),
        ("duration = 2.0", "duration = -1", &["scene.toml:2:", "duration"]),
        ("duration = 2.0", "duration = inf", &["scene.toml:2:", "duration"]),
        ("duration = 2.0", "", &["scene.toml:", "duration", "--duration"]),
        ("dt = 0.01", "dt = nan", &["scene.toml:7:", "dt"]),
        ("dt = 0.01", "dt = 0.0", &["scene.toml:7:", "dt"]),
        ("dt = 0.01", "dt = -0.01", &["scene.toml:7:", "dt"]),
        ("dt = 0.01", "dt = inf", &["scene.toml:7:", "dt"]),
        ("dt = 0.01", "", &["scene.toml:", "dt", "--dt"]),
        ("gravity = [0.0, 0.0, -1.0]", "gravity = [0.0, 0.0]", &["scene.toml:3:", "gravity"]),
        ("gravity = [0.0, 0.0, -1.0]", "gravity = [0, 0, nan]", &["scene.toml:3:", "gravity"]),
        ("position = [2.0, 2.0, 3.4]", "position = [2, 2, 3.7]", &["scene.toml:", "body 0"]),
        ("position = [2.0, 2.0, 3.4]", "position = [2, 2, inf]", &["scene.toml:19:", "position"]),
        ("count = 19", "count = 100000", &["scene.toml:", "100000", "room"]),
        ("kind = \"rough\"", "kind = \"sticky\"", &["scene.toml:10:", "sticky", "rough"]),
    ];
    for (line, other, words) in mistakes {
        refused(&with(line, other), "", words);
    }
}

#[test]
fn scenes_without_spheres_or_with_one_in_another() {
    refused("duration = 1.0\n[stepped]\ndt = 0.1\n", "", &["scene.toml", "[[spheres]]"]);
    let ball = |x: f64| format!("[[spheres]]\nposition = [{x:?}, 0.0, 0.0]\nradius = 0.5\n");
    let pair = format!("duration = 1.0\n[stepped]\ndt = 0.1\n{}{}", ball(0.0), ball(0.75));
    refused(&pair, "", &["scene.toml:", "body 1", "body 0", "overlap", "0.25"]);
    let stone = "[[surroundings]]\nshape = \"sphere\"\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\n";
    let inside = format!("duration = 1.0\n{stone}{}[stepped]\ndt = 0.1\n", ball(0.0));
    refused(&inside, "", &["scene.toml:", "body 0"]);
}

#[test]
fn mistakes_in_the_options() {
    let mistakes: &[(&str, &[&str])] = &[
        ("--lanes 5", &["--lanes", "5", "scalar, 4, 8, 16, auto"]),
        ("--threads 0", &["--threads", "0", "1..=1024"]),
        ("--threads 100000", &["--threads", "100000"]),
        ("--threads -1", &["--threads", "-1"]),
        ("--threads two", &["--threads", "two"]),
        ("--dt nan", &["--dt", "nan", "greater than 0"]),
        ("--dt -1", &["--dt", "-1", "greater than 0"]),
        ("--dt 0", &["--dt", "0", "greater than 0"]),
        ("--dt inf", &["--dt", "inf"]),
        ("--dt fast", &["--dt", "fast"]),
        ("--duration inf", &["--duration", "inf"]),
        ("--duration 0", &["--duration", "0"]),
        ("--duration -2.5", &["--duration", "-2.5"]),
        ("--duration 1e300", &["steps", "2^53"]),
        ("--precision f16", &["--precision", "f16", "f32, f64"]),
        ("--engine magic", &["--engine", "magic", "stepped"]),
        ("--seed -1", &["--seed", "-1"]),
        ("--sede 3", &["--sede", "--seed"]),
    ];
    for (options, words) in mistakes {
        refused(BOX, options, words);
    }
    // The stepped engine has no step to go on; the other one needs none.
    let event_driven =
        BOX.replace("seed = 3", "seed = 3\nengine = \"event-driven\"").replace("dt = 0.01", "");
    refused(&event_driven, "--engine stepped", &["dt", "--dt"]);
    refused(&event_driven, "--dt -1", &["--dt", "-1", "greater than 0"]);
}

#[test]
fn scenes_that_are_not_there() {
    let folder = Folder::with(BOX);
    let message = folder.says("run no.toml --state state.csv").fails_with(2);
    assert!(message.contains("no.toml") && message.contains("read"), "{message}");
    for command in ["run", "explain", "scenes"] {
        let message = folder.says(&format!("{command} superbal")).fails_with(2);
        assert!(message.contains("Did you mean `superball`?"), "{message}");
        assert!(message.contains("newtons-cradle"), "{message}");
    }
    let message = folder.says("run xyz").fails_with(2);
    assert!(!message.contains("Did you mean"), "{message}");
    let message = folder.says("rnu").fails_with(2);
    assert!(message.contains("rnu") && message.contains("--help"), "{message}");
    fs::write(folder.path("noise.toml"), [0xff, 0xfe, 0x00]).unwrap();
    folder.says("run noise.toml").fails_with(2);
    fs::create_dir(folder.path("folder.toml")).unwrap();
    folder.says("run folder.toml").fails_with(2);
}

#[test]
fn paths_that_cannot_be_written() {
    let folder = Folder::with(BOX);
    fs::create_dir(folder.path("folder")).unwrap();
    for option in ["--events", "--state"] {
        for (path, why) in [
            ("folder", "it is a folder"),
            ("no/such/file.csv", "there is no folder no/such"),
            ("scene.toml/file.csv", "scene.toml"),
            ("new/", "no name of a file"),
        ] {
            let message = folder.says(&format!("run scene.toml {option} {path}")).fails_with(2);
            assert!(message.contains(option) && message.contains(path), "{message}");
            assert!(message.contains(why), "{message}");
        }
    }
    assert_eq!(folder.names(), ["folder", "scene.toml"]);
}

#[test]
fn files_that_would_be_written_over_each_other() {
    let folder = Folder::with(BOX);
    for (events, state) in [("a.csv", "a.csv"), ("a.csv", "./a.csv"), ("-", "-")] {
        let run = format!("run scene.toml --events {events} --state {state}");
        let message = folder.says(&run).fails_with(2);
        assert!(message.contains("--events and --state"), "{message}");
    }
    let message = folder.says("run scene.toml --snapshot ./scene.toml").fails_with(2);
    assert!(message.contains("scene file"), "{message}");
    assert_eq!(folder.read("scene.toml"), BOX);
    // A scene file needs no ending.
    std::fs::rename(folder.path("scene.toml"), folder.path("scene")).unwrap();
    let message = folder.says("run ./scene --events scene").fails_with(2);
    assert!(message.contains("scene file"), "{message}");
    std::fs::rename(folder.path("scene"), folder.path("scene.toml")).unwrap();
    let message = folder.says("run scene.toml --json --events -").fails_with(2);
    assert!(message.contains("standard output"), "{message}");
    assert_eq!(folder.names(), ["scene.toml"]);
}

/// A mistake found after the paths were given leaves what was there.
#[test]
fn nothing_is_overwritten() {
    let folder = Folder::with(&with("radius = 0.5", "radius = -1.0"));
    fs::write(folder.path("state.csv"), "old").unwrap();
    folder.says("run scene.toml --state state.csv --events events.csv").fails_with(2);
    assert_eq!(folder.read("state.csv"), "old");
    assert_eq!(folder.names(), ["scene.toml", "state.csv"]);
}
