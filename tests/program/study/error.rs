//! `carom study error`.

use std::fs;

use super::{BOX, FLUID, Folder};
use crate::rows;

/// One method with steps and one without, in one precision, once.
const QUICK: &str = "study error scene.toml --precision f64 --dt 0.01 --runs 1 --lanes auto,scalar";

#[test]
fn its_folder_has_all() {
    let folder = Folder::with(BOX);
    let report = folder.says(QUICK).well();
    assert!(report.contains("event-driven, f64") && report.contains("Order of convergence"));
    assert!(report.contains("All lanes and threads gave the same bits."));
    assert_eq!(folder.names(), ["scene.toml", "study-error-scene"]);
    let mut names: Vec<String> = fs::read_dir(folder.path("study-error-scene"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let expected = [
        "error.csv",
        "error.json",
        "points.jsonl",
        "report.txt",
        "scene.toml",
        "work-precision.png",
        "work-precision.svg",
    ];
    assert_eq!(names, expected);
    assert_eq!(folder.read("study-error-scene/scene.toml"), BOX);
    assert!(report.starts_with(&folder.read("study-error-scene/report.txt")));

    let (header, rows) = rows(&folder.path("study-error-scene/error.csv"));
    assert_eq!(header[..5], ["engine", "integrator", "impact", "dt", "precision"]);
    // Event-driven, three integrators with two impacts each; two executions,
    // eight times.
    assert_eq!(rows.len(), 7 * 2 * 8);
    let json = folder.read("study-error-scene/error.json");
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["subject"]["text"], BOX);
    assert!(json["machine"]["threads"].as_u64().unwrap() >= 1);
    assert_eq!(json["outcomes"].as_array().unwrap().len(), 7);
}

#[test]
fn it_goes_on_or_begins_anew() {
    let folder = Folder::with(BOX);
    let first = folder.says(QUICK).well();
    // All is there: the same times are printed again. How busy the machine was is not.
    let is_kept = |line: &&str| !line.is_empty() && !line.starts_with("The machine was busy");
    let again = folder.says(QUICK).well();
    let [first, again] =
        [&first, &again].map(|said| said.lines().filter(is_kept).collect::<Vec<_>>());
    assert_eq!(again, first);
    let journal = folder.path("study-error-scene/points.jsonl");
    let text = fs::read_to_string(&journal).unwrap();
    fs::write(&journal, &text[..text.len() * 2 / 3]).unwrap();
    folder.says(QUICK).well();
    assert_eq!(fs::read_to_string(&journal).unwrap().lines().count(), 8);

    // Other questions need another folder, or a new beginning.
    let other = format!("{QUICK} --dt 0.02");
    let message = folder.says(&other.replace("--dt 0.01", "")).fails_with(2);
    assert!(message.contains("another study") && message.contains("--output"), "{message}");
    folder.says(&other.replace("--dt 0.01", "--output two")).well();
    folder.says(&other.replace("--dt 0.01", "--restart")).well();
}

#[test]
fn mistakes_are_named_before_anything_is_made() {
    let folder = Folder::with(FLUID);
    let fails = |arguments: &str| folder.says(&format!("study error {arguments}")).fails_with(2);
    assert!(fails("scene.toml --runs 0").contains("0 runs"));
    assert!(fails("scene.toml --dt 0.1,-1").contains("greater than 0"));
    assert!(fails("scene.toml --times 1,nan").contains("greater than 0"));
    assert!(fails("scene.toml --precision f16").contains("f16"));
    assert!(fails("scene.toml --threads 5000").contains("5000"));
    assert!(fails("scene.toml --output no/such/folder").contains("no/such/folder"));
    fs::write(folder.path("file"), "x").unwrap();
    assert!(fails("scene.toml --output file").contains("it is a file"));
    assert_eq!(folder.names(), ["file", "scene.toml"]);
}

#[test]
fn a_scene_without_a_meeting_says_so() {
    let text = BOX.replacen("duration = 2.0", "duration = 2.0\nencounters = \"none\"", 1);
    let folder = Folder::with(&text);
    let report = folder.says("study error scene.toml --runs 1 --precision f64").well();
    assert!(report.contains("Nothing collides: the error is only the integrator's."));
    // Both Euler methods have order 1 in position and energy, to all digits shown.
    assert_eq!(report.matches("1.00 ± 0.00").count(), 4, "{report}");
}
