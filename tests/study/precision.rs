//! The study of precision: its figures on a small fluid, on a scene without
//! collisions, and after an interrupt.

use carom::scene::SceneFile;
use carom::study::precision::{PrecisionReport, PrecisionStudy};
use carom::study::{Folder, Journal, Report, Study, StudyError};

const FLUID: &str = r#"
engine = "event-driven"
duration = 3.0
seed = 1
periodic = "cube"

[[spheres]]
count = 108
arrangement = "fcc"
number_density = 0.5
radius = 0.5
temperature = 1.0
"#;

const NOBODY_MEETS: &str = r#"
duration = 1.0
seed = 2
encounters = "none"

[stepped]
dt = 0.01

[[spheres]]
count = 20
arrangement = "cubic"
lower = [0.0, 0.0, 0.0]
upper = [10.0, 10.0, 10.0]
radius = 0.5
temperature = 1.0
spin_temperature = 1.0
"#;

fn file(text: &str) -> SceneFile {
    SceneFile::parse("scene", text).unwrap()
}

fn report(text: &str, runs: u64) -> PrecisionReport {
    let study = PrecisionStudy::new(&file(text), runs, 64).unwrap();
    study.measure(&Journal::unwritten(), &()).unwrap()
}

#[test]
fn errors_in_a_fluid_grow_by_equal_factors() {
    let report = report(FLUID, 4);
    println!("{report}");
    let [single, double] = &report.divergences;
    let [slow, fast] = [single, double].map(|found| found.growth.unwrap().rate);
    // Both precisions have the growth of the scene.
    assert!((0.5..1.2).contains(&slow.value), "{slow:?}");
    assert!((0.5..1.2).contains(&fast.value), "{fast:?}");
    // Single precision starts 2²⁹ times less exact and is lost earlier by what
    // that is in collisions, if it is lost at all.
    let lost = single.lost.unwrap();
    assert!((10.0..25.0).contains(&lost.collisions_per_body), "{lost:?}");
    assert_eq!(double.lost, None);
    let would = double.would_be_lost.unwrap();
    assert!((25.0..60.0).contains(&would.collisions_per_body), "{would:?}");
    let first = single.departures.order.unwrap();
    let other = single.departures.partner.unwrap();
    assert!(first.time <= other.time && first.collision <= other.collision);
    assert!(other.time < lost.time * 1.5 && first.collision > 50, "{first:?} {other:?}");
    // Momentum and energy are conserved; angular momentum is not, in a box.
    let names: Vec<&str> = report.drifts.iter().map(|drift| drift.invariant).collect();
    assert_eq!(names, ["energy", "energy", "momentum", "momentum"]);
    for drift in &report.drifts {
        assert!(drift.in_epsilons < 20.0 && drift.runs == 4, "{drift:?}");
    }
    let names: Vec<&str> = report.averages.iter().map(|average| average.name).collect();
    let all = [
        "compressibility",
        "collisions per body and time",
        "translational temperature",
        "mean free path",
    ];
    assert_eq!(names, all);
    let text = report.to_string();
    assert!(text.contains("Averages: f32 suffices"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
}

#[test]
fn no_collision_is_said() {
    let report = report(NOBODY_MEETS, 2);
    let text = report.to_string();
    assert!(text.contains("No collision happened: the error is only the integrator's"), "{text}");
    assert!(text.contains("f32 to the end"), "{text}");
    assert!(report.divergences.iter().all(|found| found.growth.is_none()));
    let folder = tempfile::tempdir().unwrap();
    report.write(&Folder::open(folder.path()).unwrap()).unwrap();
    assert!(folder.path().join("divergence.svg").exists());
}

#[test]
fn resumed_is_the_same() {
    let temporary = tempfile::tempdir().unwrap();
    let path = temporary.path().join("points.jsonl");
    let study = PrecisionStudy::new(&file(NOBODY_MEETS), 3, 16).unwrap();
    let folder = Folder::open(temporary.path()).unwrap();
    let journal = || study.journal(&folder).unwrap();
    let first = study.measure(&journal(), &()).unwrap();
    // As if it had been interrupted after two points, within the third.
    let text = std::fs::read_to_string(&path).unwrap();
    let ends: Vec<usize> = text.match_indices('\n').map(|(end, _)| end + 1).collect();
    assert_eq!(ends.len(), 6);
    std::fs::write(&path, &text[..ends[2] + 5]).unwrap();
    let second = study.measure(&journal(), &()).unwrap();
    let third = study.measure(&journal(), &()).unwrap();
    assert_eq!(first.to_string(), second.to_string());
    assert_eq!(first.to_string(), third.to_string());
    let json = |report| serde_json::to_string(report).unwrap();
    assert_eq!(json(&first), json(&third));
    // More runs need only those.
    let more = PrecisionStudy::new(&file(NOBODY_MEETS), 4, 16).unwrap();
    assert_eq!(journal().len(), 5);
    more.measure(&journal(), &()).unwrap();
    assert_eq!(journal().len(), 7);
}

#[test]
fn what_makes_no_study_is_refused() {
    for (runs, samples) in [(0, 64), (65, 64), (8, 0), (8, 7), (8, 1_000_000_000_000)] {
        let refused = PrecisionStudy::new(&file(FLUID), runs, samples);
        assert!(matches!(refused, Err(StudyError::Asked(_))), "{runs} {samples}");
    }
    let endless = FLUID.replace("duration = 3.0", "");
    let refused = PrecisionStudy::new(&file(&endless), 8, 64);
    assert!(matches!(refused, Err(StudyError::Scene(_))));
}

/// A ball at rest on the floor never stops colliding, in any precision.
#[test]
fn what_stalls_is_said_to() {
    let text = r#"
        engine = "event-driven"
        duration = 1.0
        gravity = [0.0, 0.0, -1.0]
        [[surroundings]]
        shape = "plane"
        point = [0.0, 0.0, 0.0]
        normal = [0.0, 0.0, 1.0]
        [[spheres]]
        position = [0.0, 0.0, 0.5]
        radius = 0.5
    "#;
    let study = PrecisionStudy::new(&file(text), 2, 16).unwrap();
    let stalled = study.measure(&Journal::unwritten(), &()).unwrap_err();
    assert!(stalled.to_string().contains("time stands still"), "{stalled}");
}
