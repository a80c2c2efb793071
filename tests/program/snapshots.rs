//! Runs that are kept and go on: the bits of one run, in its state and its files.

use std::fs;

use carom::output::FrameReader;

use crate::{BOX, FLUID, Folder};

/// What is written on the way, by name of the file.
fn outputs(name: &str) -> String {
    format!(
        "--events {name}.csv --series {name}-series.csv --series-every 0.07 --record {name}.dump \
         --record-every 0.11"
    )
}

/// The files of two runs are the same.
#[track_caller]
fn assert_same_files(folder: &Folder, one: &str, other: &str) {
    for ending in [".csv", "-series.csv", ".dump"] {
        let read = |name: &str| folder.read(&format!("{name}{ending}"));
        assert!(read(one) == read(other), "{one}{ending} and {other}{ending} differ");
    }
}

const KEYS: [&str; 8] = [
    "state_hash",
    "collisions",
    "parts",
    "energy",
    "momentum",
    "time",
    "collision_rate",
    "mean_free_path",
];

#[test]
fn a_run_cut_in_three_is_one_run() {
    for (scene, engine) in [
        (BOX, "--engine event-driven"),
        (BOX, "--engine stepped"),
        (FLUID, "--engine event-driven"),
        (FLUID, "--engine stepped"),
    ] {
        for precision in ["f32", "f64"] {
            let folder = Folder::with(scene);
            let start = format!("run scene.toml --json {engine} --precision {precision}");
            let whole = folder.says(&format!("{start} --duration 0.9 {}", outputs("whole")));
            let whole = whole.summary();
            let cut = format!("{} --snapshot kept.snapshot", outputs("cut"));
            folder.says(&format!("{start} --duration 0.3 {cut}")).summary();
            let go_on = "run --resume kept.snapshot --json";
            folder.says(&format!("{go_on} {cut} --duration 0.54 --threads 1")).summary();
            fs::copy(folder.path("kept.snapshot"), folder.path("second.snapshot")).unwrap();
            let end = format!("{go_on} {cut} --duration 0.9 --threads 2 --lanes scalar");
            let end = folder.says(&end).summary();
            for key in KEYS {
                assert_eq!(end.get(key), whole.get(key), "{engine} {precision}: {key}");
            }
            assert_same_files(&folder, "cut", "whole");
            // Again, from before, into other files: what comes after, under the same heads.
            let again =
                format!("run --resume second.snapshot --json --duration 0.9 {}", outputs("rest"));
            assert_eq!(folder.says(&again).summary()["state_hash"], whole["state_hash"]);
            for file in [".csv", "-series.csv"] {
                let (rest, whole) =
                    (folder.read(&format!("rest{file}")), folder.read(&format!("whole{file}")));
                let (head, rows) = rest.split_once('\n').unwrap();
                assert!(whole.starts_with(head) && whole.ends_with(rows), "rest{file}");
            }
            assert!(folder.read("whole.dump").ends_with(&folder.read("rest.dump")));
            let left = folder.names().into_iter().filter(|name| name.ends_with(".part"));
            assert_eq!(left.count(), 0);
        }
    }
}

/// The frames of a table.
fn frames(folder: &Folder, name: &str) -> Vec<String> {
    let frames = FrameReader::open(&folder.path(name)).unwrap().map(Result::unwrap);
    frames.map(|frame| format!("{:?} {:?} {:?}", frame.time, frame.bodies, frame.images)).collect()
}

#[test]
fn series_and_tables_of_frames_go_on() {
    for (scene, engine) in [(BOX, "stepped"), (FLUID, "event-driven")] {
        for precision in ["f32", "f64"] {
            let folder = Folder::with(scene);
            let start = format!("run scene.toml --engine {engine} --precision {precision}");
            let record = |name: &str| format!("--record {name} --record-every 0.11");
            folder.says(&format!("{start} --duration 0.9 {}", record("whole.pvd"))).well();
            folder.says(&format!("{start} --duration 0.9 {}", record("whole.parquet"))).well();
            for ending in ["pvd", "parquet"] {
                let kept = format!("{} --snapshot kept", record(&format!("cut.{ending}")));
                folder.says(&format!("{start} --duration 0.3 {kept}")).well();
                folder.says(&format!("run --resume kept --duration 0.54 {kept}")).well();
                fs::copy(folder.path("kept"), folder.path("second")).unwrap();
                folder.says(&format!("run --resume kept --duration 0.9 {kept}")).well();
                // Again, from before, behind the end that is there.
                folder.says(&format!("run --resume second --duration 0.9 {kept}")).well();
            }
            assert_eq!(folder.read("cut.pvd"), folder.read("whole.pvd").replace("whole", "cut"));
            for number in 0..9 {
                let read = |name: &str| folder.read(&format!("{name}_{number:06}.vtp"));
                assert!(read("cut") == read("whole"), "{engine} {precision}: {number}");
            }
            let whole = frames(&folder, "whole.parquet");
            assert_eq!(whole.len(), 9);
            assert!(frames(&folder, "cut.parquet") == whole, "{engine} {precision}");
            assert!(!folder.names().iter().any(|name| name.ends_with(".part")));
            // A frame that is gone is missed.
            let record = record("cut.pvd");
            folder.says(&format!("{start} --duration 0.5 {record} --snapshot second")).well();
            let go_on = format!("run --resume second --duration 0.9 {record}");
            fs::remove_file(folder.path("cut_000001.vtp")).unwrap();
            let message = folder.says(&go_on).fails_with(2);
            assert!(message.contains("cut_000001.vtp is no longer there"), "{message}");
        }
    }
}

#[test]
fn the_summary_of_a_run_that_goes_on_is_that_of_the_whole() {
    let folder = Folder::with(FLUID);
    let start = "run scene.toml --json --engine event-driven --set surface.kind=rough \
                 --set equilibrate=0.2 --duration 2";
    let whole = folder.says(start).summary();
    // Kept on the way, and gone on from there as if it had been killed.
    folder.says(&format!("{start} --snapshot kept.snapshot --snapshot-every 1.3")).summary();
    let end = folder.says("run --resume kept.snapshot --json").summary();
    for key in KEYS.into_iter().chain(["statistics", "compressibility", "equilibrate", "scene"]) {
        assert_eq!(end.get(key), whole.get(key), "{key}");
    }
    assert!(end.get("statistics").is_some());
}

#[test]
fn the_scene_says_where_a_run_is_kept() {
    let scene = format!("{BOX}\n[snapshot]\nfile = \"own.snapshot\"\nevery = 0.5\nwall = 60\n");
    let folder = Folder::with(&scene);
    let whole = folder.says("run scene.toml --json --duration 1.5").summary();
    fs::remove_file(folder.path("own.snapshot")).unwrap();
    folder.says("run scene.toml --duration 0.5").well();
    fs::remove_file(folder.path("scene.toml")).unwrap();
    // The scene is inside, and asks for it again.
    let end = folder.says("run --resume own.snapshot --json --duration 1.5").summary();
    assert_eq!(end["state_hash"], whole["state_hash"]);
    assert_eq!(folder.names(), ["own.snapshot"]);
}

#[test]
fn what_is_no_snapshot_is_told_apart() {
    let folder = Folder::with(BOX);
    folder.says("run scene.toml --duration 0.2 --snapshot kept.snapshot").well();
    let whole = fs::read(folder.path("kept.snapshot")).unwrap();
    let refused = |bytes: &[u8], words: &str| {
        fs::write(folder.path("bad.snapshot"), bytes).unwrap();
        let message = folder.says("run --resume bad.snapshot --duration 1").fails_with(2);
        assert!(message.contains("--resume: bad.snapshot: it "), "{message}");
        assert!(message.contains(words), "no {words:?} in: {message}");
    };
    refused(b"", "is no snapshot of carom");
    refused(BOX.as_bytes(), "is no snapshot of carom");
    refused(&whole[..whole.len() - 1], "is cut off");
    refused(&whole[..20], "is cut off");
    let mut changed = whole.clone();
    changed[whole.len() / 2] ^= 1;
    refused(&changed, "is damaged");
    changed.clone_from(&whole);
    changed[12] += 1;
    refused(&changed, "is a snapshot of version 8");
    let message = folder.says("run --resume no.snapshot").fails_with(2);
    assert!(message.contains("no.snapshot: it cannot be read"), "{message}");
}

#[test]
fn what_cannot_go_on_is_refused() {
    let folder = Folder::with(BOX);
    folder.says("run scene.toml --duration 0.2 --snapshot kept.snapshot --events e.csv").well();
    let before = folder.names();
    let refused = |arguments: &str, words: &[&str]| {
        let said = folder.says(arguments);
        assert_eq!((said.status, said.output.as_str()), (Some(2), ""), "{said:?}");
        for word in words {
            assert!(said.errors.contains(word), "no {word:?} in: {}", said.errors);
        }
        assert_eq!(folder.names(), before);
    };
    let go_on = "run --resume kept.snapshot";
    refused(&format!("{go_on} --duration 0.1"), &["it is at time 0.2", "longer --duration"]);
    refused("run scene.toml --resume kept.snapshot", &["cannot be used with"]);
    refused(&format!("{go_on} --dt 0.1 --duration 1"), &["--dt", "cannot be used with"]);
    refused(&format!("{go_on} --set seed=1"), &["--set", "cannot be used with"]);
    let frames = "--record a.npz --record-every 0.1";
    let words = ["--record is a.npz", "put together at the end", ".dump", ".parquet"];
    refused(&format!("{go_on} --duration 1 {frames}"), &words);
    refused(&format!("run scene.toml --snapshot a {frames}"), &["--record is a.npz", ".dump"]);
    refused("run scene.toml --snapshot-every 1", &["no file; give --snapshot FILE"]);
    refused("run scene.toml --snapshot scene.toml", &["--snapshot", "scene file"]);
    refused("run scene.toml --snapshot /dev/null", &["--snapshot is /dev/null"]);
    // What the snapshot counts on is gone.
    fs::write(folder.path("e.csv"), "time\n").unwrap();
    refused(
        &format!("{go_on} --duration 1 --events e.csv"),
        &["--events: e.csv", "no longer there"],
    );
    assert_eq!(folder.read("e.csv"), "time\n");
}

#[test]
fn a_state_file_that_has_changed_is_noticed() {
    let folder = Folder::with(BOX);
    folder.says("run scene.toml --state balls.csv").well();
    let scene = "duration = 1\n[[spheres]]\nfile = \"balls.csv\"\n";
    fs::write(folder.path("scene.toml"), scene).unwrap();
    folder.says("run scene.toml --duration 0.5 --snapshot kept.snapshot").well();
    folder.says("run --resume kept.snapshot --duration 1").well();
    folder.says("run scene.toml --duration 0.1 --state balls.csv").well();
    let message = folder.says("run --resume kept.snapshot --duration 1").fails_with(2);
    assert!(message.contains("state file that has changed"), "{message}");
}

#[cfg(target_os = "linux")]
mod signals {
    use std::process::{Command, Stdio};
    use std::thread::sleep;
    use std::time::Duration;

    use super::*;
    use crate::Said;

    /// Starts an endless run, sends a signal once it has written, and returns what it said.
    fn ended_by(folder: &Folder, arguments: &str, signals: &[&str]) -> Said {
        let mut program = folder.program(arguments.split_whitespace());
        let mut child = program.stderr(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let is_long =
            |name: &str| fs::metadata(folder.path(name)).is_ok_and(|file| file.len() > 300_000);
        let is_under_way = || is_long("cut.csv.part") && folder.path("kept.snapshot").exists();
        while !is_under_way() && child.try_wait().unwrap().is_none() {
            sleep(Duration::from_millis(5));
        }
        for signal in signals {
            let sent = Command::new("kill").args([*signal, &child.id().to_string()]).status();
            assert!(sent.unwrap().success());
            sleep(Duration::from_millis(50));
        }
        Said::from(child.wait_with_output().unwrap())
    }

    #[test]
    fn a_run_that_is_stopped_or_killed_loses_nothing_and_goes_on() {
        for (signals, status) in [
            (["-TERM"].as_slice(), Some(143)),
            (["-USR1", "-TERM"].as_slice(), Some(143)),
            (["-KILL"].as_slice(), None),
        ] {
            let folder = Folder::with(FLUID);
            let kept = "--snapshot kept.snapshot --snapshot-wall 0.0005";
            let run = format!(
                "run scene.toml --engine event-driven --duration 1e5 {} {kept}",
                outputs("cut")
            );
            let said = ended_by(&folder, &run, signals);
            assert_eq!(said.status, status, "{said:?}");
            if status.is_some() {
                for words in ["stopped at time ", "kept.snapshot has the run", "carom run --resume"]
                {
                    assert!(said.errors.contains(words), "no {words:?} in: {}", said.errors);
                }
            }
            let names = folder.names();
            for name in ["cut.csv.part", "cut.dump.part", "cut-series.csv.part", "kept.snapshot"] {
                assert!(names.contains(&name.to_owned()), "no {name} in {names:?}");
            }
            // A little longer than where it was kept, and the same in one go.
            let message = folder.says("run --resume kept.snapshot --duration 1e-3").fails_with(2);
            let time = message.split("it is at time ").nth(1).unwrap();
            let time: f64 = time.split(',').next().unwrap().parse().unwrap();
            let until = format!("--duration {}", time + 0.25);
            let go_on = format!("run --resume kept.snapshot --json {until} {}", outputs("cut"));
            let end = folder.says(&go_on).summary();
            let whole =
                format!("run scene.toml --json --engine event-driven {until} {}", outputs("whole"));
            assert_eq!(end["state_hash"], folder.says(&whole).summary()["state_hash"]);
            assert_same_files(&folder, "cut", "whole");
            assert!(!folder.names().iter().any(|name| name.ends_with(".part")));
        }
    }
}
