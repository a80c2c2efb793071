//! Runs in double-double: all their digits, the same bits on all threads, and what they do
//! not take.

use carom::DoubleDouble;
use carom::lane::Lane;
use carom::real::Real;

use crate::{BOX, FLUID, Folder, rows};

/// A ball that meets nothing, and has no digits but those of the file.
const BALL: &str = r#"
precision = "dd"
engine = "event-driven"
duration = 0.7

[[spheres]]
position = [0.1, 0.0, 0.0]
velocity = [0.3, -0.1, 0.0]
radius = 0.2
"#;

/// Where a ball gets to, to the last digit: the file's numbers are those of f64.
#[test]
fn a_flight_has_all_its_digits() {
    let folder = Folder::with(BALL);
    let summary = folder.says("run scene.toml --json --state state.csv").summary();
    assert_eq!(summary["precision"], "dd");
    let (header, rows) = rows(&folder.path("state.csv"));
    let number = |name: &str| -> DoubleDouble {
        let at = header.iter().position(|column| column == name).unwrap();
        rows[0][at].parse().unwrap()
    };
    let of = DoubleDouble::from_f64;
    assert_eq!(number("x"), of(0.1) + of(0.3) * of(0.7));
    assert_eq!(number("y"), of(-0.1) * of(0.7));
    assert_eq!((number("vx"), number("radius")), (of(0.3), of(0.2)));
    let half = DoubleDouble::ratio(1, 2);
    let energy = half * (of(0.3) * of(0.3) + of(-0.1) * of(-0.1));
    let all = &summary["all_digits"]["energy"];
    let digits = |key: &str| all[key].as_str().unwrap().parse::<DoubleDouble>().unwrap();
    assert_eq!((digits("initial"), digits("final"), digits("change")), (energy, energy, of(0.0)));
    let text = folder.says("run scene.toml").well();
    assert!(text.contains("1 smooth sphere in dd"), "{text}");
    assert!(text.contains("all digits") && text.contains(&format!(" {energy}\n")), "{text}");
    assert!(folder.says("explain scene.toml").well().contains("1 in dd"));
}

/// Energy is kept to the last digits of double-double, and bits do not depend on threads
/// and lanes.
#[test]
fn both_engines_keep_the_digits() {
    for (scene, engine) in [
        (BOX, "event-driven"),
        (BOX, "stepped"),
        (FLUID, "event-driven --duration 0.3"),
        (FLUID, "stepped --duration 0.1"),
    ] {
        let folder = Folder::with(scene);
        let run = format!("run scene.toml --json --precision dd --engine {engine}");
        let summary = folder.says(&format!("{run} --threads 1")).summary();
        let other = folder.says(&format!("{run} --threads 2 --lanes 8")).summary();
        assert_eq!(other["state_hash"], summary["state_hash"], "{engine}");
        let in_f64 = run.replace("--precision dd", "--precision f64");
        let in_f64 = folder.says(&in_f64).summary();
        assert!(in_f64.get("all_digits").is_none());
        assert_eq!(in_f64["collisions"], summary["collisions"], "{engine}");
        assert_ne!(in_f64["state_hash"], summary["state_hash"], "{engine}");
        let energy = &summary["all_digits"]["energy"];
        let digits = |key: &str| energy[key].as_str().unwrap().parse::<DoubleDouble>().unwrap();
        assert_eq!(digits("final") - digits("initial"), digits("change"));
        let relative = (digits("change") / digits("initial")).high().abs();
        println!("{engine}: energy off by {relative:.1e}");
        assert!(relative < 1e-28, "{engine}: {relative:e}");
    }
}

#[test]
fn a_run_that_goes_on_is_one_run() {
    let folder = Folder::with(BOX);
    let start = "run scene.toml --json --precision dd --engine event-driven";
    let whole = folder.says(&format!("{start} --duration 0.9 --events whole.csv")).summary();
    let cut = "--snapshot kept.snapshot --events cut.csv";
    folder.says(&format!("{start} --duration 0.4 {cut}")).summary();
    let end = format!("run --resume kept.snapshot --json --duration 0.9 {cut}");
    let end = folder.says(&end).summary();
    for key in ["state_hash", "collisions", "energy", "all_digits"] {
        assert_eq!(end[key], whole[key], "{key}");
    }
    assert!(folder.read("whole.csv") == folder.read("cut.csv"));
}

/// A sweep over precisions, and frames as text.
#[test]
fn sweeps_and_frames_take_it() {
    let folder = Folder::with(BOX);
    folder.says("sweep scene.toml --vary precision=f64,dd --duration 0.2 --output sweep").well();
    let run = "run scene.toml --precision dd --duration 0.2 --record run.dump --record-every 0.1";
    folder.says(run).well();
    let frames = folder.read("run.dump");
    assert_eq!(frames.matches("ITEM: ATOMS").count(), 3);
    let last = frames.lines().last().unwrap().split(' ').nth(4).unwrap().to_owned();
    assert!(last.len() > 30, "{last}");
}

#[test]
fn what_it_does_not_take_is_refused() {
    let folder = Folder::with(BOX);
    for (arguments, words) in [
        ("batch scene.toml --count 2 --output rows.csv", "a batch is in f32 or f64"),
        ("run scene.toml --events e.npz", "arrays have no type for dd"),
        ("run scene.toml --state s.npz", "no type for dd"),
        ("run scene.toml --state s.pvd", "no type for dd"),
        ("run scene.toml --record r.npz --record-every 0.1", "no type for dd"),
        ("run scene.toml --record r.parquet --record-every 0.1", "no type for dd"),
        ("run scene.toml --record r.pvd --record-every 0.1", "give it an ending of .dump"),
    ] {
        let message = folder.says(&format!("{arguments} --precision dd")).fails_with(2);
        assert!(message.contains(words), "{arguments}: {message}");
    }
    let message = folder.says("batch scene.toml --count 2 --output b.csv --set precision=dd");
    assert!(message.fails_with(2).contains("take one of these, or `carom sweep`"));
    let message = folder.says("study scaling scene.toml --precision dd").fails_with(2);
    assert!(message.contains("f32, f64"), "{message}");
    let message = folder.says("run scene.toml --precision double").fails_with(2);
    assert!(message.contains("f32, f64, dd"), "{message}");
    assert_eq!(folder.names(), ["scene.toml"]);
    assert!(folder.says("run --help").well().contains("double-double"));
}
