//! `carom study precision`.

use crate::{BOX, FLUID, Folder, rows};

#[test]
fn writes_all_files_and_goes_on() {
    let folder = Folder::with(FLUID);
    let arguments = "study precision scene.toml --engine event-driven --duration 0.5 --runs 2 \
                     --samples 16 --output out";
    let said = folder.says(arguments).well();
    assert!(said.starts_with("Precision of scene: 256 spheres, event-driven engine"), "{said}");
    for text in ["growth λ", "first collision out of order", "compressibility", "Trajectories: "] {
        assert!(said.contains(text), "{text} is missing: {said}");
    }
    assert!(said.ends_with("Tables and pictures are in out.\n"), "{said}");
    let names = [
        "divergence.png",
        "divergence.svg",
        "drift.png",
        "drift.svg",
        "points.jsonl",
        "precision.csv",
        "precision.json",
        "report.txt",
        "scene.toml",
    ];
    for name in names {
        assert!(folder.path("out").join(name).exists(), "{name} is missing");
    }
    assert!(said.starts_with(&folder.read("out/report.txt")));
    assert_eq!(folder.read("out/scene.toml"), FLUID);
    let (header, rows) = rows(&folder.path("out/precision.csv"));
    assert_eq!((header[0].as_str(), header[2].as_str(), rows.len()), ("time", "f32_distance", 17));
    let json: serde_json::Value = serde_json::from_str(&folder.read("out/precision.json")).unwrap();
    assert_eq!(json["bodies"], 256);
    assert!(json["machine"]["processor"].is_string() && json["subject"]["text"].is_string());
    // All points are there: the second time nothing is run.
    assert_eq!(folder.says(arguments).well(), said);
    let other = folder.says(&arguments.replace("0.5", "0.25")).fails_with(2);
    assert!(other.contains("--output"), "{other}");
}

#[test]
fn mistakes_are_those_of_the_arguments() {
    let folder = Folder::with(BOX);
    for options in ["--runs 0", "--samples 1000000000000", "--runs -1", "--duration nan"] {
        folder.says(&format!("study precision scene.toml {options}")).fails_with(2);
    }
    folder.says("study precision nothing.toml").fails_with(2);
    assert_eq!(folder.names(), ["scene.toml"]);
}
