//! `carom batch`.

use std::fs;

use crate::{BOX, FLUID, Folder, rows};

/// Sixteen balls on a table, in lanes.
const BREAK: &str = r#"
duration = 1.0
seed = 5

[stepped]
dt = 0.01
impact = "end-of-step"

[[surroundings]]
shape = "box"
lower = [0.0, 0.0, 0.0]
upper = [8.0, 4.0, 1.0]
inside = true

[[spheres]]
position = [1.0, 2.0, 0.5]
velocity = [6.0, 0.0, 0.0]
radius = 0.2

[[spheres]]
count = 15
arrangement = "random"
lower = [3.0, 0.0, 0.0]
upper = [8.0, 4.0, 1.0]
radius = 0.2
temperature = 0.1
"#;

/// A column of a table.
fn texts(folder: &Folder, file: &str, name: &str) -> Vec<String> {
    let (header, rows) = rows(&folder.path(file));
    let at = header.iter().position(|column| column == name).unwrap();
    rows.iter().map(|row| row[at].clone()).collect()
}

/// Holds a row against the program's run of its values.
fn is_the_run(folder: &Folder, file: &str, row: usize, keys: &[&str], options: &str) {
    let of = |name: &str| texts(folder, file, name)[row].clone();
    let values = keys.iter().map(|key| format!(" --set {key}={}", of(key)));
    let arguments = format!(
        "run scene.toml --json --state end.csv --seed {} {options} {}",
        of("seed"),
        values.collect::<String>()
    );
    let summary = folder.says(&arguments).summary();
    assert_eq!(summary["state_hash"], of("state_hash"), "{arguments}");
    let number = |name: &str| of(name).parse::<f64>().ok();
    assert_eq!(summary["collisions"]["pairs"].as_f64(), number("pairs"));
    assert_eq!(summary["collisions"]["surroundings"].as_f64(), number("surroundings"));
    assert_eq!(summary["energy"]["relative_change"].as_f64(), number("energy_change"));
    assert_eq!(summary["energy"]["final"].as_f64(), number("energy"));
    assert_eq!(summary["temperature"]["translational"].as_f64(), number("temperature"));
    let (header, bodies) = rows(&folder.path("end.csv"));
    let x = header.iter().position(|column| column == "x").unwrap();
    assert_eq!(bodies[2][x].parse::<f64>().ok(), number("x[2]"));
}

const OBSERVED: &str = "--observe energy,temperature,x[2]";

#[test]
fn a_row_is_the_run_of_its_values() {
    let folder = Folder::with(BREAK);
    let text = folder
        .says(&format!(
            "batch scene.toml --count 40 --vary spheres[0].mass=1,3 \
             --vary spheres[0].radius=uniform(0.1,0.3) --vary duration=normal(1,0.1) {OBSERVED} \
             --output rows.csv"
        ))
        .well();
    assert!(text.contains("40 scenes, 40 of them in lanes"), "{text}");
    assert_eq!(texts(&folder, "rows.csv", "seed")[39], "44");
    let masses = texts(&folder, "rows.csv", "spheres[0].mass");
    assert_eq!((masses[6].as_str(), masses[7].as_str()), ("1", "3"));
    let keys = ["spheres[0].mass", "spheres[0].radius", "duration"];
    for row in [0, 7, 39] {
        is_the_run(&folder, "rows.csv", row, &keys, "");
    }
    // The scenes of other lanes, threads and numbers are the same.
    folder
        .says(&format!(
            "batch scene.toml --count 7 --vary spheres[0].mass=1,3 --lanes 4 --threads 1 \
             --vary spheres[0].radius=uniform(0.1,0.3) --vary duration=normal(1,0.1) {OBSERVED} \
             --output few.csv"
        ))
        .well();
    let (all, few) = (folder.read("rows.csv"), folder.read("few.csv"));
    assert!(all.starts_with(&few) && few.lines().count() == 8);
    assert_eq!(folder.names(), ["end.csv", "few.csv", "rows.csv", "scene.toml"]);
}

#[test]
fn what_a_batch_does_not_write_is_told() {
    let asked =
        "[record]\nfile = \"b.dump\"\nevery = 0.1\n[[analyse]]\nkind = \"speed-distribution\"\n";
    let folder = Folder::with(&format!("{BREAK}\n{asked}"));
    let said = folder.says("batch scene.toml --count 2 --output b.csv");
    assert_eq!(
        said.errors,
        "[record] and [[analyse]] of the scene are passed over: a batch writes a row for each run\n"
    );
    assert_eq!(folder.names(), ["b.csv", "scene.toml"]);
    let said = folder.says("sweep scene.toml --seeds 2 --output s");
    let passed_over = "[record] of the scene is passed over: a sweep writes a row for each run\n";
    assert_eq!((said.status, said.errors.as_str()), (Some(0), passed_over));
}

#[test]
fn what_lanes_do_not_take_has_its_row_too() {
    for (scene, options) in [
        (BOX, ""),
        (BOX, "--engine event-driven --precision f32"),
        (FLUID, "--duration 0.1"),
        (BREAK, "--precision f32"),
    ] {
        let folder = Folder::with(scene);
        let text = folder
            .says(&format!("batch scene.toml --count 3 {OBSERVED} --output r.csv {options}"))
            .well();
        let is_in_lanes = scene != FLUID && !options.contains("event-driven");
        let in_lanes = if is_in_lanes { "3 of them" } else { "0 of them" };
        assert!(text.contains(in_lanes), "{text}");
        for row in [0, 2] {
            is_the_run(&folder, "r.csv", row, &[], options);
        }
        let explained = folder.says(&format!("explain scene.toml {options}")).well();
        let lanes = "in a batch            a scene in each lane";
        assert_eq!(explained.contains(lanes), is_in_lanes, "{explained}");
    }
}

/// What is beside the output of a batch that is killed when a part of it is done; `None` if
/// it was through before.
fn interrupted(folder: &Folder, arguments: &str) -> Option<String> {
    let mut child = folder.program(arguments.split_whitespace()).spawn().unwrap();
    loop {
        let journal = fs::read_to_string(folder.path("rows.csv.points.jsonl")).unwrap_or_default();
        if journal.lines().count() >= 2 {
            child.kill().unwrap();
            child.wait().unwrap();
            return Some(journal);
        }
        if child.try_wait().unwrap().is_some() {
            return None;
        }
    }
}

#[test]
fn an_interrupted_batch_goes_on() {
    let folder = Folder::with(BREAK);
    let batch = "batch scene.toml --count 10000 --duration 0.02 --output rows.csv";
    folder.says(batch).well();
    let all = folder.read("rows.csv");
    // The rows of the first part, as an interrupt leaves them, and half of a line.
    let journal = |text: &str| fs::write(folder.path("rows.csv.points.jsonl"), text).unwrap();
    let kept = (0..20).find_map(|_| interrupted(&folder, batch)).expect("it was never caught");
    let cut: usize = kept.split_inclusive('\n').take(2).map(str::len).sum();
    journal(&format!("{}{{\"point\":", &kept[..cut]));
    fs::remove_file(folder.path("rows.csv")).unwrap();
    folder.says(batch).well();
    assert_eq!(folder.read("rows.csv"), all);
    // Rows of other values are not mixed in.
    journal(&kept[..cut]);
    let message = folder.says(&batch.replace("0.02", "0.03")).fails_with(2);
    assert!(message.contains("rows.csv.points.jsonl"), "{message}");
    folder.says(&format!("{batch} --restart").replace("0.02", "0.03")).well();
    assert_ne!(folder.read("rows.csv"), all);
}

#[test]
fn a_scene_that_fails_is_a_row() {
    let folder = Folder::with(BREAK);
    let said = folder.says(
        "batch scene.toml --count 4 --vary spheres[1].radius=0.2,0.9 --observe x[0] --output r.csv",
    );
    assert_eq!(said.status, Some(1), "{said:?}");
    assert!(said.errors.contains("2 of 4 runs failed"), "{said:?}");
    assert!(said.errors.contains("scene 1: "), "{said:?}");
    let failures = texts(&folder, "r.csv", "failure");
    assert!(failures[0].is_empty() && !failures[1].is_empty(), "{failures:?}");
    let hashes = texts(&folder, "r.csv", "state_hash");
    assert!(hashes[1].is_empty() && hashes[2].starts_with("0x"));
}

#[test]
fn arrays_are_those_of_numpy() {
    let folder = Folder::with(BREAK);
    folder
        .says("batch scene.toml --count 3 --vary spheres[0].mass=1,3 --observe time --output r.npz")
        .well();
    let bytes = fs::read(folder.path("r.npz")).unwrap();
    let holds = |text: &str| bytes.windows(text.len()).any(|window| window == text.as_bytes());
    for name in ["scene.npy", "spheres[0].mass.npy", "state_hash.npy", "time.npy"] {
        assert!(holds(name), "{name}");
    }
    assert!(holds("'descr': '<u8', 'fortran_order': False, 'shape': (3,)"));
    assert!(holds("'descr': '<f8'") && holds("'descr': '<U1'"));
    let masses: Vec<u8> = [1.0_f64, 3.0, 1.0].iter().flat_map(|mass| mass.to_le_bytes()).collect();
    assert!(bytes.windows(masses.len()).any(|window| window == masses));
}

#[test]
fn mistakes_are_named_before_anything_runs() {
    let folder = Folder::with(BREAK);
    for (arguments, words) in [
        ("--output r.csv", "--count"),
        ("--count 0 --output r.csv", "--count"),
        ("--count 3", "--output"),
        ("--count 3 --output r.feather", "must end in .csv, .npz or .parquet"),
        ("--count 3 --output no/such/r.csv", "no/such"),
        ("--count 3 --output r.csv --vary radius", "KEY=a,b,c"),
        ("--count 3 --output r.csv --vary spheres[0].radus=1,2", "radus is not a key"),
        ("--count 3 --output r.csv --vary spheres[0].radius=uniform(2,1)", "a < b"),
        ("--count 3 --output r.csv --vary spheres[0].mass=-1", "--vary spheres[0].mass is -1"),
        ("--count 3 --output r.csv --vary precision=f32,f64", "carom sweep"),
        ("--count 3 --output r.csv --vary duration=1,2 --duration 3", "both"),
        ("--count 3 --output r.csv --observe speed", "there is no such figure"),
        ("--count 3 --output r.csv --set equilibrate=0.5", "equilibrate"),
        ("--count 2 --seed 18446744073709551615 --output r.csv", "not so many seeds"),
    ] {
        let message = folder.says(&format!("batch scene.toml {arguments}")).fails_with(2);
        assert!(message.contains(words), "{arguments}: {message}");
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}
