//! The stress suite: its laws hold, it finds what does not, and it goes on where
//! it was ended.

use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

use carom::scene::Precision;
use carom::study::stability::{
    Case, Extent, Figure, Section, Stability, StabilityReport, Verdict, cases,
};
use carom::study::{Folder, Journal, Report, Study, StudyError, Watch};

fn named(names: &[&str]) -> Vec<&'static Case> {
    names.iter().map(|name| cases().iter().find(|case| case.name == *name).unwrap()).collect()
}

/// Every law that is judged holds, in both precisions.
#[test]
fn laws_hold() {
    let study = Stability::new(cases().iter().collect(), Extent::Quick);
    let report = study.measure(&Journal::unwritten(), &()).unwrap();
    let failed: Vec<&Figure> =
        report.figures().filter(|figure| figure.verdict == Verdict::Deviates).collect();
    assert!(failed.is_empty(), "{failed:#?}\n{report}");
    for section in &report.cases {
        for precision in [Precision::F32, Precision::F64] {
            let holds = |figure: &&Figure| {
                figure.precision == precision && figure.verdict == Verdict::Holds
            };
            assert!(section.figures.iter().any(|f| holds(&f)), "{} {precision:?}", section.case);
        }
    }
    let longest = report.to_string().lines().map(|line| line.chars().count()).max();
    assert!(longest <= Some(100), "{longest:?} letters in a line");
    written(&report);
}

/// The files hold all figures, and the pictures are there.
fn written(report: &StabilityReport) {
    let folder = tempfile::tempdir().unwrap();
    report.write(&Folder::open(folder.path()).unwrap()).unwrap();
    let json = fs::read_to_string(folder.path().join("stability.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let cases: Vec<Section> = serde_json::from_value(json["cases"].clone()).unwrap();
    assert_eq!(cases, report.cases);
    let table = fs::read_to_string(folder.path().join("stability.csv")).unwrap();
    assert!(table.starts_with("case,precision,quantity,law,measured,bound,unit,verdict\n"));
    assert_eq!(table.lines().count(), 1 + report.figures().count());
    for name in ["energy-drift", "rotation", "reversal"] {
        assert!(folder.path().join(format!("{name}.svg")).exists(), "{name}");
    }
}

/// What does not hold is found: a rotation without its Newton step, judged by
/// the law that carom's step is judged by, in each precision.
#[test]
fn a_bare_rotation_deviates() {
    let study = Stability::new(named(&["rotation"]), Extent::Quick);
    let report = study.measure(&Journal::unwritten(), &()).unwrap();
    for (precision, epsilon) in
        [(Precision::F32, f64::from(f32::EPSILON)), (Precision::F64, f64::EPSILON)]
    {
        let last = |name: &str| {
            let mut curves = report.cases[0].curves.iter();
            let curve = curves.find(|c| c.precision == precision && c.name == name).unwrap();
            curve.points.last().unwrap().1 / epsilon
        };
        let judged = |skewness| Figure::at_most(precision, "‖MᵗM − 1‖", skewness, 2.0, "ε").verdict;
        assert_eq!(judged(last("skewness, carom")), Verdict::Holds);
        assert_eq!(judged(last("skewness, M ← R M alone")), Verdict::Deviates);
    }
}

#[test]
fn figures_are_judged() {
    let f64 = Precision::F64;
    let cases = [
        (Figure::at_most(f64, "a", 2.0, 2.0, "ε"), Verdict::Holds),
        (Figure::at_most(f64, "a", -2.1, 2.0, "ε"), Verdict::Deviates),
        (Figure::at_most(f64, "a", f64::NAN, 2.0, "ε"), Verdict::Deviates),
        (Figure::at_most(f64, "a", f64::INFINITY, 2.0, "ε"), Verdict::Deviates),
        (Figure::equal(f64, "a", 31_415.0, 31_415.0, ""), Verdict::Holds),
        (Figure::equal(f64, "a", 31_416.0, 31_415.0, ""), Verdict::Deviates),
        (Figure::near(f64, "a", 0.6, 0.5, 0.2, ""), Verdict::Holds),
        (Figure::near(f64, "a", 1.0, 0.5, 0.2, ""), Verdict::Deviates),
        (Figure::near(f64, "a", 1.0, 0.5, 0.2, "").beyond_precision(), Verdict::Limit),
        (Figure::near(f64, "a", 1.0, 0.5, 0.2, "").compared(), Verdict::Compared),
    ];
    for (figure, verdict) in cases {
        assert_eq!(figure.verdict, verdict, "{figure:?}");
        // As it goes through a journal.
        let text = serde_json::to_string(&figure).unwrap();
        assert_eq!(serde_json::from_str::<Figure>(&text).unwrap(), figure);
    }
}

/// Counts the points that were measured.
#[derive(Default)]
struct Count(AtomicUsize);

impl Watch for Count {
    fn begins(&self, _: usize, _: usize, _: f64) {}

    fn is_done(&self, _: &str, _: f64) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

/// A study that goes on from a part of its journal measures the rest only, and
/// gives the same report.
#[test]
fn goes_on_from_its_journal() {
    let temporary = tempfile::tempdir().unwrap();
    let path = temporary.path().join("points.jsonl");
    let folder = Folder::open(temporary.path()).unwrap();
    let study = Stability::new(named(&["superball", "cradle"]), Extent::Quick);
    let run = |watch: &Count| -> Result<StabilityReport, StudyError> {
        study.measure(&study.journal(&folder)?, watch)
    };
    let all = Count::default();
    let first = run(&all).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 1 + all.0.load(Ordering::Relaxed));
    fs::write(&path, lines[..lines.len() / 2].join("\n") + "\n").unwrap();
    let rest = Count::default();
    assert_eq!(run(&rest).unwrap(), first);
    assert_eq!(rest.0.load(Ordering::Relaxed), lines.len() - lines.len() / 2);
}
