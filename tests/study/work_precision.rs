//! Run time against error: the orders that theory says, and what is said where
//! there is nothing to tell.

use carom::engine::Lanes;
use carom::motion::Integrator;
use carom::scene::{EngineKind, Impact, Precision, SceneFile};
use carom::study::chart::Look;
use carom::study::work_precision::{
    Asked, Family, Found, Method, Outcome, Quantity, Theory, WorkPrecision, WorkPrecisionReport,
};
use carom::study::{Folder, Journal, Norm, Report, Study};

use super::scene;

/// A throw that meets nothing.
const THROW: &str = r#"
duration = 2.0
gravity = [0.0, -1.0, -9.75]

[stepped]
dt = 0.01

[[spheres]]
position = [0.0, 0.0, 0.0]
velocity = [1.0, 2.0, 3.0]
spin = [3.0, 2.0, 1.0]
radius = 0.5
"#;

/// Rough balls of different sizes that fall about in a box.
const BOX: &str = r#"
duration = 1.0
gravity = [0.0, 0.0, -1.0]
seed = 5

[stepped]
dt = 0.004

[surface]
kind = "rough"

[[surroundings]]
shape = "box"
lower = [0.0, 0.0, 0.0]
upper = [4.0, 4.0, 4.0]
inside = true

[[spheres]]
count = 24
arrangement = "random"
radius = [0.2, 0.4]
mass = [1.0, 3.0]
temperature = 1.0
"#;

/// A fluid that no method can predict for long.
const FLUID: &str = r#"
duration = 20.0
periodic = "cube"

[stepped]
dt = 0.002

[[spheres]]
count = 32
arrangement = "fcc"
number_density = 0.5
radius = 0.5
temperature = 1.0
"#;

/// The usual, but quick, in one lane and in the fastest.
fn quick() -> Asked {
    Asked { lanes: vec![Lanes::Auto, Lanes::Scalar], runs: Some(1), ..Asked::default() }
}

fn study(file: &SceneFile, asked: &Asked) -> WorkPrecisionReport {
    let study = WorkPrecision::new(file, asked).unwrap();
    study.measure(&Journal::unwritten(), &()).unwrap()
}

/// What was found of a quantity in `f64`, by the family's name.
fn found(report: &WorkPrecisionReport, quantity: Quantity) -> Vec<(String, Theory, Found)> {
    let (_, orders) = report.orders.iter().find(|(of, _)| *of == quantity).unwrap();
    let fine = orders.iter().filter(|order| order.family.precision == Precision::F64);
    fine.map(|order| (order.family.to_string(), order.theory, order.found)).collect()
}

#[test]
fn integrators_have_their_orders() {
    let report = study(&scene(THROW), &quick());
    assert!(report.notes.iter().any(|note| note.contains("Nothing collides")));
    let orders = found(&report, Quantity::Position);
    assert_eq!(orders.len(), 3);
    for (name, theory, found) in orders {
        match (theory, found) {
            (Theory::First, Found::Power(power)) => {
                assert!((power.value - 1.0).abs() < 1e-3, "{name}: {power:?}");
            }
            (Theory::Exact, Found::Rounding(worst)) => {
                assert!(name.starts_with("velocity Verlet") && worst < 1e-11, "{name}: {worst}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
    // The error of semi-implicit Euler is ½ |a| t Δt.
    let (method, outcome) = report.sweep.methods.iter().zip(&report.outcomes).next_back().unwrap();
    assert_eq!(method.precision, Precision::F64);
    assert!(outcome.moments.iter().all(|moment| moment.deviation.unwrap().position < 1e-11));
    let (method, outcome) = (report.sweep.methods.iter().zip(&report.outcomes))
        .find(|(method, _)| {
            method.to_string().starts_with("semi-implicit Euler")
                && method.precision == Precision::F64
        })
        .unwrap();
    let moment = outcome.moments.last().unwrap();
    let law = 0.5 * (1.0_f64 + 9.75 * 9.75).sqrt() * moment.time * method.stepping.unwrap().dt;
    assert!((moment.deviation.unwrap().position / law - 1.0).abs() < 1e-9);
}

#[test]
fn impacts_within_a_step_are_better_by_their_order() {
    let report = study(&scene(BOX), &quick());
    assert!(!report.notes.iter().any(|note| note.contains("Nothing collides")));
    for (name, theory, found) in found(&report, Quantity::Position) {
        match (theory, found) {
            (Theory::First, Found::Power(power)) => {
                let within = 0.15 + 3.0 * power.error;
                assert!((power.value - 1.0).abs() < within && within < 0.7, "{name}: {power:?}");
            }
            (Theory::Exact, Found::Rounding(worst)) => {
                assert_eq!(name, "velocity Verlet, sub-step, f64");
                assert!(worst < 1e-9, "{worst}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
    // At exact times there is rounding only, and it grows with the collisions.
    for (method, outcome) in report.sweep.methods.iter().zip(&report.outcomes) {
        if *method.to_string() == *"event-driven, f64" {
            let first = outcome.moments[0].deviation.unwrap();
            let last = outcome.moments.last().unwrap().deviation.unwrap();
            assert!(first.position < 1e-14 && last.position < 1e-11, "{first:?} {last:?}");
            assert!(last.energy.abs() < 1e-14);
        }
    }
    // The advice for digits is to take what is exact.
    let (bound, best) = report.advice.last().unwrap();
    let Family { precision, stepping } = best.method.family();
    let exact = [None, Some((Integrator::VelocityVerlet, Impact::SubStep))];
    assert!(*bound < 1e-11 && precision == Precision::F64 && exact.contains(&stepping), "{best:?}");
}

#[test]
fn past_predictability_there_is_no_figure() {
    let report = study(&scene(FLUID), &quick());
    let lost = report.scale.f32_lost.unwrap();
    assert!(report.time < lost && lost < 20.0);
    assert!(report.limits.iter().any(|note| note.starts_with("Chaotic")));

    // Asked for more, it says that nothing is left of the trajectories.
    let file = scene(FLUID);
    let asked = Asked {
        duration: file.duration,
        precisions: vec![Precision::F32],
        times: vec![0.2, 18.0, 20.0],
        ..quick()
    };
    let report = study(&file, &asked);
    assert!(report.limits.iter().any(|note| note.contains("every method has lost")));
    assert_eq!(report.time, 0.2);
    // Of the energy there is.
    let report = study(&file, &Asked { quantity: Quantity::Energy, ..asked });
    assert_eq!(report.time, 20.0);
    assert!(report.front.iter().all(|best| best.error < 1e-5));
}

#[test]
fn goes_on_where_it_was() {
    let file = scene(BOX);
    let asked = Asked { precisions: vec![Precision::F32], ..quick() };
    let study = WorkPrecision::new(&file, &asked).unwrap();
    let temporary = tempfile::tempdir().unwrap();
    let folder = Folder::open(temporary.path()).unwrap();
    let journal = study.journal(&folder).unwrap();
    let first = study.measure(&journal, &()).unwrap();
    drop(journal);

    // Interrupted in the middle of a line.
    let path = temporary.path().join("points.jsonl");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, &text[..text.len() / 2]).unwrap();
    let journal = study.journal(&folder).unwrap();
    let points = journal.len();
    assert!(points > 0 && points < study.sweep().methods.len());
    let second = study.measure(&journal, &()).unwrap();
    for (k, (first, second)) in first.outcomes.iter().zip(&second.outcomes).enumerate() {
        assert_eq!((&first.moments, &first.state_hash), (&second.moments, &second.state_hash));
        // What was there is not measured again.
        assert_eq!(first.timings == second.timings, k < points);
    }
    second.write(&folder, &Look::default()).unwrap();
    for name in ["error.csv", "error.json", "report.txt", "scene.toml", "work-precision.png"] {
        assert!(std::fs::metadata(temporary.path().join(name)).unwrap().len() > 0, "{name}");
    }
    let json = std::fs::read_to_string(temporary.path().join("error.json")).unwrap();
    assert!(serde_json::from_str::<serde_json::Value>(&json).is_ok());
}

#[test]
fn what_is_not_possible_is_said() {
    let refused = |asked: Asked| {
        WorkPrecision::new(&scene(THROW), &asked).map(|_| ()).unwrap_err().to_string()
    };
    assert!(refused(Asked { runs: Some(0), ..quick() }).contains("0 runs"));
    assert!(refused(Asked { steps: vec![-1.0], ..quick() }).contains("steps: -1"));
    assert!(refused(Asked { times: vec![f64::NAN], ..quick() }).contains("NaN"));
}

#[test]
fn a_scene_beyond_f32_is_studied_in_f64() {
    // Two balls a millimetre apart, as far from the origin as the sun.
    let far = r#"
duration = 1.0

[stepped]
dt = 0.01

[[spheres]]
position = [1.5e11, 0.0, 0.0]
velocity = [1.0, 0.0, 0.0]
radius = 0.5

[[spheres]]
position = [1.50000000001001e11, 0.0, 0.0]
radius = 0.5
"#;
    let asked = Asked { precisions: vec![Precision::F64], ..quick() };
    let report = study(&scene(far), &asked);
    assert!(report.outcomes.iter().all(|outcome| outcome.moments.len() == 8));
    let both = WorkPrecision::new(&scene(far), &quick()).unwrap();
    let refused = both.measure(&Journal::unwritten(), &()).unwrap_err();
    assert!(refused.to_string().contains("overlap"), "{refused}");
}

#[test]
fn steps_that_look_alike_are_two() {
    let steps = vec![0.01, 0.010_000_001];
    let asked = Asked { steps, precisions: vec![Precision::F64], ..quick() };
    let file = scene(THROW);
    let study = WorkPrecision::new(&file, &asked).unwrap();
    let temporary = tempfile::tempdir().unwrap();
    let folder = Folder::open(temporary.path()).unwrap();
    let journal = study.journal(&folder).unwrap();
    study.measure(&journal, &()).unwrap();
    drop(journal);
    assert_eq!(study.journal(&folder).unwrap().len(), study.sweep().methods.len());
}

/// Another norm, or another body, is made of the points that are there.
#[test]
fn another_norm_needs_no_second_run() {
    let file = scene(BOX);
    let asked = Asked { precisions: vec![Precision::F64], ..quick() };
    let temporary = tempfile::tempdir().unwrap();
    let folder = Folder::open(temporary.path()).unwrap();
    let in_norm = |norm| {
        let study = WorkPrecision::new(&file, &Asked { norm, ..asked.clone() }).unwrap();
        study.measure(&study.journal(&folder).unwrap(), &()).unwrap()
    };
    let rms = in_norm(Norm::RootMeanSquare);
    let journal = std::fs::read(temporary.path().join("points.jsonl")).unwrap();
    let [max, mean] = [Norm::Maximum, Norm::Mean].map(in_norm);
    let bodies: Vec<_> = (0..24).map(|body| in_norm(Norm::Body(body))).collect();
    assert_eq!(std::fs::read(temporary.path().join("points.jsonl")).unwrap(), journal);
    for (k, outcome) in rms.outcomes.iter().enumerate() {
        for (l, moment) in outcome.moments.iter().enumerate() {
            let of =
                |report: &WorkPrecisionReport| report.outcomes[k].moments[l].deviation.unwrap();
            let (rms, max, mean) = (moment.deviation.unwrap(), of(&max), of(&mean));
            // Single errors are kept to three digits.
            let is_near = |a: f64, b: f64| (a - b).abs() <= 2e-3 * b;
            assert!(is_near(max.position, rms.position_worst));
            assert!(max.position >= rms.position * 0.998 && rms.position >= mean.position * 0.998);
            let of_each: Vec<f64> = bodies.iter().map(|report| of(report).velocity).collect();
            let squares = of_each.iter().map(|error| error * error).sum::<f64>();
            assert!(is_near((squares / 24.0).sqrt(), rms.velocity));
            assert_eq!((max.energy, mean.momentum), (rms.energy, rms.momentum));
        }
    }
    assert!(max.to_string().contains("greatest of all bodies"), "{max}");
    let beyond = Asked { norm: Norm::Body(24), ..asked };
    let refused = WorkPrecision::new(&file, &beyond).map(drop).unwrap_err();
    assert!(refused.to_string().contains("no body 24"), "{refused}");
}

/// Double-double at exact times is the reference itself; its steps have errors of steps only.
#[test]
fn double_double_is_compared_in_steps() {
    let asked = Asked {
        precisions: vec![Precision::F64, Precision::DoubleDouble],
        steps: vec![0.25 / 6.0, 0.25 / 13.0, 0.25 / 24.0, 0.25 / 50.0],
        ..quick()
    };
    let report = study(&scene(THROW), &asked);
    let is_said = |text: &String| text.contains("Event-driven dd is the reference itself");
    assert_eq!(report.limits.iter().filter(|limit| is_said(limit)).count(), 1);
    assert!(report.to_string().contains("Event-driven dd is the reference itself"));
    // At the last of the times, by the way to move and the step.
    let errors = |precision: Precision| -> Vec<(String, f64)> {
        let methods = report.sweep.methods.iter().zip(&report.outcomes);
        let of = methods.filter(|(method, _)| method.precision == precision);
        let stepped = of.filter(|(method, _)| method.stepping.is_some());
        let error = |(method, outcome): (&Method, &Outcome)| {
            let name = method.to_string().replace(precision.name(), "");
            (name, outcome.moments.last().unwrap().deviation.unwrap().position)
        };
        stepped.map(error).collect()
    };
    let (double, finer) = (errors(Precision::F64), errors(Precision::DoubleDouble));
    assert_eq!((double.len(), finer.len()), (12, 12));
    assert_eq!(report.sweep.methods.len(), 25, "event-driven dd is left out");
    for ((name, double), (same, finer)) in double.into_iter().zip(finer) {
        assert_eq!(name, same);
        if name.starts_with("velocity Verlet") {
            assert!(finer < 1e-28 && double > 1e-18, "{name}: {finer:e}, f64 {double:e}");
        } else {
            assert!((finer / double - 1.0).abs() < 1e-6, "{name}: {finer:e}, f64 {double:e}");
        }
    }
    let (_, orders) = report.orders.iter().find(|(of, _)| *of == Quantity::Position).unwrap();
    for order in orders.iter().filter(|order| order.family.precision == Precision::DoubleDouble) {
        match (order.theory, order.found) {
            (Theory::First, Found::Power(power)) => assert!((power.value - 1.0).abs() < 1e-3),
            (Theory::Exact, Found::Rounding(worst)) => assert!(worst < 1e-28, "{worst:e}"),
            other => panic!("{}: {other:?}", order.family),
        }
    }
    // Alone it leaves nothing to compare.
    let engines = vec![EngineKind::EventDriven];
    let asked = Asked { engines, precisions: vec![Precision::DoubleDouble], ..quick() };
    let error = WorkPrecision::new(&scene(THROW), &asked).err().unwrap().to_string();
    assert!(error.starts_with("nothing is left to compare: event-driven dd"), "{error}");
}

/// With collisions, impacts inside the step are exact in it too.
#[test]
fn double_double_steps_through_collisions() {
    let asked = Asked {
        engines: vec![EngineKind::Stepped],
        precisions: vec![Precision::DoubleDouble],
        integrators: vec![Integrator::VelocityVerlet],
        impacts: vec![Impact::SubStep],
        steps: vec![0.008, 0.004, 0.002, 0.001],
        ..quick()
    };
    let report = study(&scene(BOX), &asked);
    for (method, outcome) in report.sweep.methods.iter().zip(&report.outcomes) {
        let moment = outcome.moments.last().unwrap();
        let error = moment.deviation.unwrap().position;
        println!("{method}: {error:.1e} after {:.1} collisions of a body", moment.collisions);
        assert!(error < 1e-24, "{method}: {error:e}");
        assert_eq!(moment.collisions, moment.true_collisions);
    }
}
