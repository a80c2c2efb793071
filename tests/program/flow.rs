//! Spheres that come and go: in the summary and in all files.

use std::collections::BTreeSet;

use crate::{Folder, rows};

/// A tap above a drain, in a box.
const TAP: &str = r#"
duration = 4.0
gravity = [0.0, 0.0, -2.0]
stepped = { dt = 0.01 }
surroundings = [
  { shape = "box", lower = [-2, -2, -2], upper = [2, 2, 2], inside = true },
  { shape = "box", name = "drain", lower = [-2, -2, -2], upper = [0, 0, -1.5], removes = true },
]
[[inlet]]
lower = [-1.5, -1.5, 1.5]
upper = [1.5, 1.5, 1.5]
rate = 10.0
radius = [0.2, 0.3]
velocity = [0.0, 0.0, -1.0]
temperature = 0.1
"#;

const OUTPUTS: &str = "--series series.csv --series-every 0.1 --record run.dump --record-every 0.25 \
                       --events events.csv --state state.csv";

#[test]
fn all_files_have_the_spheres_that_there_are() {
    for engine in ["event-driven", "stepped"] {
        let folder = Folder::with(TAP);
        let run = format!("run scene.toml --json --engine {engine}");
        let summary = folder.says(&format!("{run} {OUTPUTS}")).summary();
        let spheres = &summary["spheres"];
        let count = |key: &str| spheres[key].as_u64().unwrap();
        let [came, removed, end] = ["came", "removed", "end"].map(count);
        assert_eq!((count("start"), came - removed), (0, end), "{spheres}");
        assert!(came > 30 && removed > 8 && end > 8, "{engine}: {spheres}");
        assert_eq!(summary["parts"][1]["removed"].as_u64().unwrap(), removed);
        // What came and went, and what pulled, is all.
        let momentum = &summary["momentum"];
        let size = momentum["from_surroundings"][2].as_f64().unwrap().abs();
        for axis in 0..3 {
            let error = momentum["balance_error"][axis].as_f64().unwrap();
            assert!(error.abs() < 1e-9 * size, "{engine}: {momentum}");
        }
        if engine == "event-driven" {
            let change = summary["energy"]["relative_change"].as_f64().unwrap();
            assert!(change.abs() < 1e-9, "{}", summary["energy"]);
        }
        // The series: as many as there are.
        let (names, series) = rows(&folder.path("series.csv"));
        let column = |name: &str| {
            let at = names.iter().position(|other| other == name).unwrap();
            series.iter().map(|row| row[at].parse::<f64>().unwrap()).collect::<Vec<_>>()
        };
        let [there, in_all, gone] = ["spheres", "came", "removed"].map(column);
        for k in 0..there.len() {
            assert_eq!(there[k], in_all[k] - gone[k]);
        }
        assert_eq!(*gone.last().unwrap(), removed as f64);
        // The state has those that are left; events and frames name them for good.
        assert_eq!(rows(&folder.path("state.csv")).1.len() as u64, end);
        let (_, events) = rows(&folder.path("events.csv"));
        let named: BTreeSet<u64> = events.iter().map(|row| row[1].parse().unwrap()).collect();
        assert!(*named.last().unwrap() < came && named.len() as u64 >= removed, "{named:?}");
        let dump = folder.read("run.dump");
        let frames: Vec<&str> = dump.split("ITEM: TIMESTEP\n").skip(1).collect();
        assert_eq!(frames.len(), 17);
        let ids = |frame: &str| -> Vec<u64> {
            let lines = frame.lines().skip_while(|line| !line.starts_with("ITEM: ATOMS")).skip(1);
            lines.map(|line| line.split(' ').next().unwrap().parse().unwrap()).collect()
        };
        let last = ids(frames[16]);
        assert_eq!(last.len() as u64, end);
        assert!(last.windows(2).all(|pair| pair[0] < pair[1]) && *last.last().unwrap() <= came);
        // No number of one that is gone is used again.
        assert!(*last.last().unwrap() > end, "{last:?}");
        let words = folder.says(&format!("run scene.toml --engine {engine}")).well();
        assert!(
            words.contains(&format!("{came} came, {removed} removed; {end} at the end")),
            "{words}"
        );
    }
}

#[test]
fn a_run_that_was_kept_goes_on_with_its_inlets() {
    for engine in ["event-driven", "stepped"] {
        let folder = Folder::with(TAP);
        let run = format!("run scene.toml --json --engine {engine}");
        let whole = folder.says(&format!("{run} {OUTPUTS}")).summary();
        let files = ["series.csv", "run.dump", "events.csv", "state.csv"];
        let before = files.map(|name| folder.read(name));
        let cut = format!("{OUTPUTS} --snapshot kept.snapshot");
        folder.says(&format!("{run} --duration 1.57 {cut}")).summary();
        let resume = format!("run --resume kept.snapshot --json --duration 4.0 {cut} --threads 1");
        let end = folder.says(&resume).summary();
        for key in ["state_hash", "spheres", "parts", "collisions", "momentum", "energy"] {
            assert_eq!(end[key], whole[key], "{engine}: {key}");
        }
        for (name, before) in files.into_iter().zip(before) {
            assert!(folder.read(name) == before, "{engine}: {name}");
        }
    }
}

#[test]
fn what_needs_the_same_spheres_throughout_says_so() {
    let folder = Folder::with(TAP);
    let refused = |arguments: &str| folder.says(arguments).fails_with(2);
    let message = refused("run scene.toml --record run.npz --record-every 1");
    assert!(message.contains("spheres come and go") && message.contains(".dump"), "{message}");
    folder.says("run scene.toml --record run.parquet --record-every 0.05").well();
    let message = refused("batch scene.toml --count 2 --output rows.csv");
    assert!(message.contains("spheres come or go") && message.contains("a batch"), "{message}");
    let message = refused("study error scene.toml");
    assert!(message.contains("spheres come or go") && message.contains("a study"), "{message}");
    let with = Folder::with(&format!("{TAP}\n[[analyse]]\nkind = \"speed-distribution\"\n"));
    let message = with.says("run scene.toml").fails_with(2);
    assert!(message.contains("analyse") && message.contains("come or go"), "{message}");
    // A sweep only has their summaries.
    folder.says("sweep scene.toml --seeds 2 --duration 1 --output swept").well();
    let plan = folder.says("explain scene.toml").well();
    assert!(plan.contains("1 inlet, 1 part that removes"), "{plan}");
}
