//! Double-double as the truth of the studies: known digits of sine and cosine,
//! of whole trajectories, and the built-in scenes against `f64`.

use carom::DoubleDouble;
use carom::contact::Surface;
use carom::engine::{Compiled, Execution, World};
use carom::lane::Lane;
use carom::observe::fall_energy;
use carom::real::Real;
use carom::scene::EngineKind;
use carom::scene::{Scene, SceneFile, Sphere, builtin_scenes};
use carom::study::deviation::Truth;
use carom::surroundings::Cuboid;
use carom::trigonometry::sin_cos;
use carom::vec3::Vec3;

fn records<R: serde::de::DeserializeOwned>(text: &str) -> Vec<R> {
    csv::Reader::from_reader(text.as_bytes()).deserialize().map(Result::unwrap).collect()
}

/// Random arguments of all sizes, double-doubles next to multiples of π/2 and
/// π/4, tiny ones; from 120 digits of mpmath.
#[test]
fn sine_and_cosine_of_hard_arguments() {
    let rows: Vec<[f64; 6]> = records(include_str!("../data/sine_cosine.csv"));
    assert!(rows.len() > 300);
    let (mut worst, mut worst_relative) = (0.0_f64, 0.0_f64);
    for [high, low, sine_high, sine_low, cosine_high, cosine_low] in rows {
        let (sine, cosine) = sin_cos(DoubleDouble::new(high, low));
        let known = [(sine, sine_high, sine_low), (cosine, cosine_high, cosine_low)];
        for (found, known_high, known_low) in known {
            let known = DoubleDouble::new(known_high, known_low);
            let error = (found - known).high().abs();
            let relative = error / known_high.abs();
            worst = worst.max(error);
            if known_high.abs() > 1e-3 || high.abs() < 1.0 {
                worst_relative = worst_relative.max(relative);
                assert!(relative < 1e-31, "{high:e} {low:e}: {relative:e}");
            }
            assert!(error < 1e-31, "{high:e} {low:e}: {error:e}");
        }
    }
    println!("sine and cosine: {worst:.2e} absolute, {worst_relative:.2e} relative");
}

/// What an infinite number does in `f64` it does here.
#[test]
fn infinite_numbers_are_those_of_f64() {
    let numbers = [0.0, 1.0, -2.5, 1e200, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    let same = |found: DoubleDouble, expected: f64, what: &str| {
        if expected.is_finite() && expected != 0.0 && found.high() != expected {
            panic!("{what}: {found:?} is not {expected}");
        }
        assert_eq!(found.high().is_nan(), expected.is_nan(), "{what}: {found:?}, {expected}");
        assert_eq!(found.is_finite(), expected.is_finite(), "{what}: {found:?}");
        if expected.is_infinite() {
            assert_eq!(found, DoubleDouble::from_f64(expected), "{what}");
        }
    };
    for a in numbers {
        let x = DoubleDouble::from_f64(a);
        same(x.sqrt(), a.sqrt(), &format!("√{a}"));
        same(x.abs(), a.abs(), &format!("|{a}|"));
        for b in numbers {
            let y = DoubleDouble::from_f64(b);
            same(x + y, a + b, &format!("{a} + {b}"));
            same(x - y, a - b, &format!("{a} - {b}"));
            same(x * y, a * b, &format!("{a} × {b}"));
            same(x / y, a / b, &format!("{a} / {b}"));
            assert_eq!((x < y, x <= y, x == y), (a < b, a <= b, a == b), "{a}, {b}");
        }
    }
}

#[derive(serde::Deserialize)]
struct Known {
    scene: String,
    events: u64,
    body: usize,
    figure: String,
    high: f64,
    low: f64,
}

/// The three spheres of `tests/event_driven/trajectories.rs`; the starts are
/// those of `tests/data/trajectories.json`.
fn three_spheres(is_rough: bool) -> Scene<DoubleDouble> {
    let text = include_str!("../data/trajectories.json");
    let known: serde_json::Value = serde_json::from_str(text).unwrap();
    let known = &known[if is_rough { "gas3_rough" } else { "grav3_smooth" }];
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let vector = |value: &serde_json::Value| core::array::from_fn(|k| number(&value[k]));
    let exact = |vector: [f64; 3]| vector.map(DoubleDouble::from_f64);
    let mut builder = Scene::builder()
        .engine(EngineKind::EventDriven)
        .surface(if is_rough { Surface::Rough } else { Surface::Smooth })
        .gravity(exact(vector(&known["g"])))
        .surroundings(Cuboid::container(exact([0.0; 3]), exact([1.0; 3])));
    for k in 0..3 {
        let sphere = Sphere::new(vector(&known["c0"][k]))
            .radius(number(&known["radii"][k]))
            .mass(number(&known["mass"][k]));
        builder =
            builder.sphere(sphere.velocity(vector(&known["v0"][k])).spin(vector(&known["w0"][k])));
    }
    builder.build().unwrap()
}

/// After 1, 10, 30 and 60 collisions, against 80 digits. Errors grow as those of
/// `f64` do, 10¹⁶ times smaller.
#[test]
fn trajectories_have_their_digits() {
    let rows: Vec<Known> = records(include_str!("../data/trajectories_dd.csv"));
    for is_rough in [true, false] {
        let name = if is_rough { "gas3_rough" } else { "grav3_smooth" };
        for (events, bound) in [(1, 1e-30), (10, 1e-29), (30, 1e-27), (60, 1e-22)] {
            let mut scene = World::new(three_spheres(is_rough), Execution::default()).unwrap();
            let World::EventDriven(world) = &mut scene else { panic!("not event-driven") };
            // An event's own velocities and spins have all digits; the state
            // between events is for a time in f64.
            let mut states = [None; 3];
            let mut on_event = |event: &carom::engine::Event<DoubleDouble>| {
                states[event.a as usize] = Some((event.velocity, event.spin));
                if let carom::engine::Partner::Body { index, velocity, spin } = event.partner {
                    states[index as usize] = Some((velocity, spin));
                }
            };
            world.advance_to(1e3, events, Some(&mut on_event)).unwrap();
            let bodies = scene.bodies();
            let time = scene.time();
            let of = rows.iter().filter(|row| row.scene == name && row.events == events);
            let rows: Vec<&Known> = of.collect();
            let exact = |row: &Known| DoubleDouble::new(row.high, row.low);
            let at = exact(rows.iter().find(|row| row.figure == "time").unwrap());
            let late = DoubleDouble::from_f64(time) - at;
            assert!(late.high().abs() < 1e-15);
            let figure = |body: usize, name: &str| {
                exact(rows.iter().find(|row| row.body == body && row.figure == name).unwrap())
            };
            let gravity = if is_rough { Vec3::ZERO } else { gravity_of(name) };
            let mut worst = 0.0_f64;
            for body in 0..3 {
                let v = Vec3::from(["vx", "vy", "vz"].map(|name| figure(body, name)));
                let c = Vec3::from(["cx", "cy", "cz"].map(|name| figure(body, name)));
                let w = Vec3::from(["wx", "wy", "wz"].map(|name| figure(body, name)));
                // From the collision to the f64 nearest to its time.
                let half = DoubleDouble::ratio(1, 2);
                let should = c + v * late + gravity * (late * late * half);
                let errors = [
                    bodies.position_of(body) - should,
                    bodies.velocity_of(body) - (v + gravity * late),
                    bodies.spin_of(body) - w,
                ];
                for error in errors {
                    worst = worst.max(error.length().high());
                }
            }
            println!("{name}: after {events} collisions {worst:.1e}");
            assert!(worst < bound, "{name}: after {events} collisions {worst:.1e}");
        }
    }
}

fn gravity_of(name: &str) -> Vec3<DoubleDouble> {
    let text = include_str!("../data/trajectories.json");
    let known: serde_json::Value = serde_json::from_str(text).unwrap();
    let component = |k: usize| DoubleDouble::from_f64(known[name]["g"][k].as_f64().unwrap());
    Vec3::new(component(0), component(1), component(2))
}

/// For as long as errors have not grown much, `f64` is the double-double to a
/// few of its own roundings, in all scenes, by both engines.
#[test]
fn built_in_scenes_agree_with_f64() {
    for builtin in builtin_scenes() {
        // A board of few balls has the pins of all.
        let text = builtin.text.replace("count = 100000\narrangement", "count = 2000\narrangement");
        for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
            let mut file = SceneFile::parse(builtin.name, &text).unwrap();
            file.engine = engine;
            let dt = file.dt.unwrap();
            let large = ["rough-gas", "free-flight", "mixture", "funnel", "hopper", "drum"];
            let duration = match engine {
                EngineKind::Stepped => 8.0 * dt,
                EngineKind::EventDriven if builtin.name == "hard-sphere-fluid" => 0.2,
                EngineKind::EventDriven if large.contains(&builtin.name) => 0.02,
                // Convex obstacles part paths quickly.
                EngineKind::EventDriven if builtin.name == "lorentz-gas" => 0.3,
                EngineKind::EventDriven if ["giant-in-dust", "terrain"].contains(&builtin.name) => {
                    0.1
                }
                EngineKind::EventDriven if builtin.name == "galton-board" => 1.5,
                _ => 2.5,
            };
            let truth = state::<DoubleDouble>(&file, duration);
            let scene = file.build::<DoubleDouble>().unwrap();
            let truth = Truth::of(&truth, scene.gravity, scene.periodic, fall_energy(&scene));
            let world = state::<f64>(&file, duration);
            let deviation = truth.deviation(&world.bodies());
            println!(
                "{} {engine:?}: {:.1e}, {:?}",
                builtin.name,
                deviation.position_worst,
                world.collisions()
            );
            assert!(deviation.position_worst < 1e-12, "{}: {deviation:?}", builtin.name);
            assert!(deviation.velocity < 1e-11, "{}: {deviation:?}", builtin.name);
        }
    }
}

fn state<T: Compiled>(file: &SceneFile, duration: f64) -> World<T> {
    let mut world = World::<T>::new(file.build().unwrap(), Execution::default()).unwrap();
    world.advance(duration).unwrap();
    world
}
