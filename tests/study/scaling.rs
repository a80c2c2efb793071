//! The scaling study. No clock is asserted upon.

use std::fs;
use std::sync::Mutex;

use carom::engine::Lanes;
use carom::scene::EngineKind;
use carom::scene::{Precision, SceneFile};
use carom::study::scaling::{Scaling, ScalingReport, Settings};
use carom::study::{Folder, Journal, Report, Study, StudyError, Watch};

/// What has been done.
#[derive(Default)]
struct Seen(Mutex<Vec<String>>);

impl Watch for Seen {
    fn begins(&self, _: usize, _: usize, seconds: f64) {
        assert!(seconds.is_finite() && seconds >= 0.0);
    }

    fn is_done(&self, key: &str, _: f64) {
        self.0.lock().unwrap().push(key.to_owned());
    }
}

fn fluid(engine: EngineKind) -> SceneFile {
    let mut file = SceneFile::builtin("hard-sphere-fluid").unwrap();
    file.engine = engine;
    file
}

fn tiny() -> Settings {
    Settings {
        bodies: vec![500, 108, 500],
        precisions: vec![Precision::F32, Precision::F64],
        threads: vec![1, 2, 1],
        lanes: vec![Lanes::Auto, Lanes::Scalar, Lanes::Eight],
        runs: 2,
    }
}

fn report(engine: EngineKind, settings: &Settings) -> ScalingReport {
    let study = Scaling::new(&fluid(engine), settings).unwrap();
    study.measure(&Journal::unwritten(), &()).unwrap()
}

#[test]
fn every_variant_of_a_size_ends_in_the_same_bits() {
    for engine in [EngineKind::Stepped, EngineKind::EventDriven] {
        let report = report(engine, &tiny());
        report.verdict().unwrap();
        assert_eq!(report.settings.bodies, [108, 500]);
        let threads = if engine == EngineKind::Stepped { 2 } else { 1 };
        // Lanes at the lesser of two sizes.
        let variants: Vec<usize> = report.points.iter().map(Vec::len).collect();
        assert_eq!(variants, [threads + 2, threads + 2, threads, threads]);
        for rows in &report.points {
            for row in rows {
                assert_eq!(row.state_hash, rows[0].state_hash);
                // As many runs as were asked for, or more while times are uncertain.
                let runs = row.timing.runs.len();
                assert!((2..=6).contains(&runs), "{runs}");
                assert_eq!((row.work, runs), (rows[0].work, rows[0].timing.runs.len()));
                assert!(row.work > 0 && row.bytes > 20 * row.bodies);
            }
        }
        assert_eq!(report.powers.len(), 2 * threads);
        // Auto and eight lanes over the scalar path, and the second thread.
        assert_eq!(report.speed_ups.len(), 2 * (2 + 2 * (threads - 1)));
        let text = report.to_string();
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
        assert!(text.contains("All variants of a size end in the same bits."), "{text}");
    }
}

#[test]
fn different_bits_are_said_loudly() {
    let settings = Settings { bodies: vec![108], ..tiny() };
    let mut report = report(EngineKind::Stepped, &settings);
    report.differing.push("f32 with 108 bodies: threads 2, lanes auto give 0x1".to_owned());
    assert!(report.to_string().contains("DIFFERENT BITS"));
    let error = report.verdict().unwrap_err();
    assert!(matches!(&error, StudyError::DifferentBits(text) if text.contains("threads 2")));
}

#[test]
fn an_interrupted_study_goes_on() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = Folder::open(temporary.path()).unwrap();
    let study = Scaling::new(&fluid(EngineKind::Stepped), &tiny()).unwrap();
    let seen = Seen::default();
    let whole = study.measure(&study.journal(&folder).unwrap(), &seen).unwrap();
    let points = ["f32 108 bodies", "f64 108 bodies", "f32 500 bodies", "f64 500 bodies"];
    assert_eq!(*seen.0.lock().unwrap(), points);

    // Without its last point.
    let path = folder.path().join("points.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    let kept: Vec<&str> = text.lines().take(4).collect();
    fs::write(&path, kept.join("\n") + "\n").unwrap();
    let seen = Seen::default();
    let resumed = study.measure(&study.journal(&folder).unwrap(), &seen).unwrap();
    assert_eq!(*seen.0.lock().unwrap(), points[3..]);
    assert_eq!(resumed.points[..3], whole.points[..3]);

    resumed.write(&folder).unwrap();
    let csv = fs::read_to_string(folder.path().join("scaling.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + resumed.points.iter().map(Vec::len).sum::<usize>());
    for name in ["report.txt", "scaling.json", "scene.toml"] {
        assert!(folder.path().join(name).exists(), "{name}");
    }
    for name in ["time", "memory", "lanes"] {
        assert!(folder.path().join(name).with_extension("svg").exists(), "{name}");
        assert!(folder.path().join(name).with_extension("png").exists(), "{name}");
    }
    let json = fs::read_to_string(folder.path().join("scaling.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["subject"]["name"], "hard-sphere-fluid");
    assert_eq!(json["settings"]["lanes"][2], "8");
    assert!(json["machine"]["processor"].is_string());
}

#[test]
fn absurd_settings_are_refused() {
    let refused = |settings: Settings, words: &str| {
        let error = Scaling::new(&fluid(EngineKind::Stepped), &settings).unwrap_err();
        assert!(matches!(error, StudyError::Asked(_)), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    refused(Settings { bodies: vec![0], ..tiny() }, "0 bodies");
    refused(Settings { bodies: vec![10, 1 << 40], ..tiny() }, "1099511627776 bodies");
    refused(Settings { bodies: vec![], ..tiny() }, "at least one number of bodies");
    refused(Settings { precisions: vec![], ..tiny() }, "at least one precision");
    refused(Settings { threads: vec![], ..tiny() }, "at least one number of threads");
    refused(Settings { lanes: vec![], ..tiny() }, "at least one choice of lanes");
    refused(Settings { threads: vec![5_000], ..tiny() }, "5000 threads");
    refused(Settings { runs: 0, ..tiny() }, "0 runs");
}

#[test]
fn what_never_collides_cannot_be_measured_by_collisions() {
    let text = "engine = \"event-driven\"\nduration = 1\nencounters = \"none\"\n[[spheres]]\n\
                count = 10\narrangement = \"cubic\"\nlower = [0, 0, 0]\nupper = [9, 9, 9]\n\
                radius = 0.5\ntemperature = 1\n";
    let file = SceneFile::parse("free.toml", text).unwrap();
    let study = Scaling::new(&file, &tiny()).unwrap();
    let error = study.measure(&Journal::unwritten(), &()).unwrap_err();
    assert!(error.to_string().contains("there is no collision"), "{error}");
}
