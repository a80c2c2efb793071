//! `carom sweep`.

use std::fs;

use crate::{BOX, FLUID, Folder, rows};

/// The column of a name, as numbers.
fn column(folder: &Folder, file: &str, name: &str) -> Vec<f64> {
    let (header, rows) = rows(&folder.path(file));
    let at = header.iter().position(|column| column == name).unwrap();
    rows.iter().map(|row| row[at].parse().unwrap()).collect()
}

/// The texts of a column.
fn texts(folder: &Folder, file: &str, name: &str) -> Vec<String> {
    let (header, rows) = rows(&folder.path(file));
    let at = header.iter().position(|column| column == name).unwrap();
    rows.iter().map(|row| row[at].clone()).collect()
}

const TWO: &str = "sweep scene.toml --vary spheres[0].number_density=0.3:0.5:2 \
                   --vary engine=stepped,event-driven --duration 0.5 --seeds 3 --output s";

#[test]
fn each_run_is_the_run_of_its_values() {
    let folder = Folder::with(FLUID);
    let text = folder.says(TWO).well();
    assert!(text.contains("scene: 12 runs, 3 seeds"), "{text}");
    assert_eq!(folder.read("s/report.txt"), text);
    assert_eq!(folder.read("s/scene.toml"), FLUID);
    let hashes = texts(&folder, "s/runs.csv", "state_hash");
    let seeds = texts(&folder, "s/runs.csv", "seed");
    let densities = texts(&folder, "s/runs.csv", "spheres[0].number_density");
    let engines = texts(&folder, "s/runs.csv", "engine");
    let pairs = column(&folder, "s/runs.csv", "pairs");
    let factors = column(&folder, "s/runs.csv", "compressibility");
    assert_eq!(
        (hashes.len(), engines[5].as_str(), engines[6].as_str()),
        (12, "event-driven", "stepped")
    );
    assert_eq!((densities[5].as_str(), densities[6].as_str()), ("0.3", "0.5"));
    for run in [0, 5, 10] {
        let options = format!(
            "run scene.toml --json --duration 0.5 --set spheres[0].number_density={} \
             --set engine={} --seed {}",
            densities[run], engines[run], seeds[run]
        );
        let summary = folder.says(&options).summary();
        assert_eq!(summary["state_hash"], hashes[run]);
        assert_eq!(summary["collisions"]["pairs"].as_f64(), Some(pairs[run]));
        assert_eq!(summary["compressibility"].as_f64(), Some(factors[run]));
    }
    // Means over the three seeds, and s/√3.
    let (means, errors) = (
        column(&folder, "s/means.csv", "compressibility"),
        column(&folder, "s/means.csv", "compressibility_error"),
    );
    for (group, values) in factors.chunks(3).enumerate() {
        let mean = values.iter().sum::<f64>() / 3.0;
        let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        assert!((means[group] - mean).abs() < 1e-12);
        assert!((errors[group] - (square / 6.0).sqrt()).abs() < 1e-12);
    }
    assert_eq!(texts(&folder, "s/means.csv", "runs"), ["3"; 4]);
}

#[test]
fn a_sweep_goes_on_and_grows() {
    let folder = Folder::with(FLUID);
    folder.says(TWO).well();
    let all = folder.read("s/runs.csv");
    let journal = folder.read("s/points.jsonl");
    // Cut off in the middle of a line, on other threads: the same rows but for their times.
    let kept: usize = journal.split_inclusive('\n').take(6).map(str::len).sum();
    fs::write(folder.path("s/points.jsonl"), &journal[..kept + 9]).unwrap();
    folder.says(&format!("{TWO} --threads 1")).well();
    assert_eq!(folder.read("s/points.jsonl").lines().count(), 13);
    let timeless = |text: &str| -> Vec<String> {
        let lines = text.lines().map(|line| {
            let mut fields: Vec<&str> = line.split(',').collect();
            let seconds = fields.len() - 3;
            fields.remove(seconds);
            fields.join(",")
        });
        lines.collect()
    };
    assert_eq!(timeless(&folder.read("s/runs.csv")), timeless(&all));
    // More seeds: what is there is not run again.
    let text = folder.says(&TWO.replace("--seeds 3", "--seeds 4")).well();
    assert!(text.contains("16 runs, 4 seeds"), "{text}");
    assert_eq!(folder.read("s/points.jsonl").lines().count(), 17);
    // Another scene has a folder of its own.
    let message = folder.says(&TWO.replace("0.5 --seeds", "0.25 --seeds")).fails_with(2);
    assert!(message.contains("--output"), "{message}");
}

#[test]
fn a_run_that_fails_is_a_row() {
    let folder = Folder::with(FLUID);
    let said = folder.says("sweep scene.toml --vary spheres[0].number_density=0.5,1.6 --output s");
    assert_eq!(said.status, Some(1), "{said:?}");
    assert!(said.errors.contains("1 of 2 runs failed"), "{said:?}");
    assert!(said.output.contains("(1 failed)"), "{said:?}");
    let failures = texts(&folder, "s/runs.csv", "failure");
    assert!(failures[0].is_empty() && failures[1].contains("no room"), "{failures:?}");
    assert_eq!(texts(&folder, "s/means.csv", "runs"), ["1", "0"]);
}

#[test]
fn without_a_key_there_are_seeds() {
    let folder = Folder::with(BOX);
    let text = folder.says("sweep scene.toml --seeds 2 --seed 8 --precision f32").well();
    assert!(text.contains("sweep-scene"), "{text}");
    assert_eq!(texts(&folder, "sweep-scene/runs.csv", "seed"), ["8", "9"]);
    let hashes = texts(&folder, "sweep-scene/runs.csv", "state_hash");
    assert_ne!(hashes[0], hashes[1]);
    let summary = folder.says("run scene.toml --json --seed 9 --precision f32").summary();
    assert_eq!(summary["state_hash"], hashes[1]);
}

#[test]
fn mistakes_are_named_before_anything_runs() {
    let folder = Folder::with(BOX);
    for (arguments, words) in [
        ("--vary radius", "KEY=a,b,c"),
        ("--vary spheres[0].radus=1,2", "--vary spheres[0].radus is not a key"),
        ("--vary spheres[0].radius=0.1,big", "--vary spheres[0].radius"),
        ("--vary spheres[7].radius=0.1,0.2", "beyond the end of its list"),
        ("--vary spheres[1].count=10:20:4", "--vary spheres[1].count"),
        ("--vary duration=1,2 --duration 3", "--vary duration and --duration both"),
        ("--vary duration=1,2 --vary duration=3", "twice"),
        ("--vary duration=1:2:1", "n of from:to:n"),
        ("--vary spheres[0].mass=-1,2", "--vary spheres[0].mass is -1"),
        ("--seeds 0", "--seeds"),
        ("--seed 18446744073709551615 --seeds 2", "not so many seeds"),
        ("--vary stepped.dt=1e-3:1e-2:1000000 --seeds 2", "too many"),
        ("--vary duration=1,2 --output no/such/folder", "no/such/folder"),
    ] {
        let message = folder.says(&format!("sweep scene.toml {arguments}")).fails_with(2);
        assert!(message.contains(words), "{arguments}: {message}");
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}

/// What the scene analyses is in a file for each run, as one run writes it, and its figures
/// are in the tables.
#[test]
fn analyses_of_each_run() {
    let scene = format!(
        "{FLUID}[[analyse]]\nkind = \"radial-distribution\"\nfile = \"g.csv\"\n\
         [[analyse]]\nkind = \"mean-squared-displacement\"\n\
         [[analyse]]\nkind = \"collision-statistics\"\n"
    );
    let folder = Folder::with(&scene);
    const SWEEP: &str = "sweep scene.toml --vary engine=stepped,event-driven --output s --seeds";
    let text = folder.says(&format!("{SWEEP} 2")).well();
    assert!(text.contains("analyse[1].diffusion"), "{text}");
    let files: Vec<Vec<String>> =
        (0..3).map(|k| texts(&folder, "s/runs.csv", &format!("analyse[{k}].file"))).collect();
    assert_eq!(files[0][3], "g_engine=event-driven_seed=1.csv");
    assert_eq!(files[1][0], "scene-mean-squared-displacement_engine=stepped_seed=0.csv");
    let diffusion = column(&folder, "s/runs.csv", "analyse[1].diffusion");
    for (run, options) in [(0, "engine=stepped"), (3, "engine=event-driven --seed 1")] {
        let summary = folder.says(&format!("run scene.toml --json --set {options}")).summary();
        let alone =
            ["g.csv", "scene-mean-squared-displacement.csv", "scene-collision-statistics.csv"];
        for (alone, files) in alone.into_iter().zip(&files) {
            let of_run = folder.read(&format!("s/analyses/{}", files[run]));
            assert!(of_run.lines().count() > 20);
            assert_eq!(of_run, folder.read(alone));
        }
        let figures = &summary["analyses"][1]["figures"];
        assert_eq!(figures["diffusion"]["mean"].as_f64(), Some(diffusion[run]));
    }
    let means = column(&folder, "s/means.csv", "analyse[1].diffusion");
    assert_eq!(means[0], (diffusion[0] + diffusion[1]) / 2.0);
    // More seeds: those that are there keep their files.
    folder.says(&format!("{SWEEP} 3")).well();
    let more = texts(&folder, "s/runs.csv", "analyse[0].file");
    assert_eq!((more[0].clone(), more[3].clone()), (files[0][0].clone(), files[0][2].clone()));
    assert_eq!(fs::read_dir(folder.path("s/analyses")).unwrap().count(), 18);
}

#[test]
fn analyses_that_cannot_be_are_named_before_anything_runs() {
    for (entries, words) in [
        ("kind = \"bond-order\"\nevery = -1.0\n", "analyse[0].every"),
        ("kind = \"bond-order\"\nfile = \"a.txt\"\n", "its ending must be .csv"),
        (
            "kind = \"bond-order\"\nfile = \"a.csv\"\n[[analyse]]\nkind = \"bond-order\"\n\
             file = \"b/a.csv\"\n",
            "analyse[0] has a file of that name",
        ),
    ] {
        let folder = Folder::with(&format!("{FLUID}[[analyse]]\n{entries}"));
        let message = folder.says("sweep scene.toml --seeds 2").fails_with(2);
        assert!(message.contains(words), "{message}");
        assert_eq!(folder.names(), ["scene.toml"]);
    }
}
