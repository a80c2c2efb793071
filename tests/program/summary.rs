//! What a run prints.

use serde_json::Value;

use crate::{BOX, FLUID, Folder};

fn number(summary: &Value, pointer: &str) -> f64 {
    let value = summary.pointer(pointer).unwrap_or_else(|| panic!("no {pointer}: {summary}"));
    let number = value.as_f64().unwrap_or_else(|| panic!("{pointer} is {value}"));
    assert!(number.is_finite());
    number
}

fn vector(summary: &Value, pointer: &str) -> [f64; 3] {
    [0, 1, 2].map(|k| number(summary, &format!("{pointer}/{k}")))
}

#[test]
fn json_has_the_keys_that_are_promised() {
    for (scene, bodies, is_periodic) in [(BOX, 20, false), (FLUID, 256, true)] {
        let summary = Folder::with(scene).says("run scene.toml --json --threads 1").summary();
        assert_eq!(summary["scene"], "scene");
        assert_eq!(summary["precision"], "f64");
        assert_eq!(summary["engine"], "stepped");
        assert_eq!(summary["threads"], 1);
        assert!(summary["lanes"].is_u64());
        assert_eq!(summary["bodies"], bodies);
        let steps = summary["steps"].as_u64().unwrap();
        let (dt, time) = (number(&summary, "/dt"), number(&summary, "/time"));
        assert_eq!(steps, if is_periodic { 500 } else { 200 });
        assert!((time - steps as f64 * dt).abs() < 1e-12 * time);
        assert!(summary["collisions"]["pairs"].as_u64().unwrap() > 0);
        assert_eq!(summary["collisions"]["surroundings"].as_u64().unwrap() > 0, !is_periodic);
        let energy = |key: &str| number(&summary, &format!("/energy/{key}"));
        let parts = energy("translational") + energy("rotational") + energy("potential");
        assert!((parts - energy("final")).abs() < 1e-14 * energy("final").abs());
        // Over the kinetic energy, and what the bodies can fall through in the box.
        let change = energy("final") - energy("initial");
        let kinetic = energy("translational") + energy("rotational");
        if is_periodic {
            assert!(energy("relative_change").abs() < 1e-12);
        } else {
            let (scale, fall) = (change / energy("relative_change"), 22.0 * 4.0);
            assert!(scale > kinetic && scale < 1.1 * kinetic + 2.0 * fall, "{scale} {kinetic}");
        }
        for vectors in ["/momentum", "/angular_momentum"] {
            for key in ["initial", "final"] {
                vector(&summary, &format!("{vectors}/{key}"));
            }
        }
        let hash = summary["state_hash"].as_str().unwrap();
        assert!(hash.starts_with("0x") && hash.len() == 18, "{hash}");
        assert!(u64::from_str_radix(&hash[2..], 16).is_ok());
        for key in ["/wall_seconds", "/collisions_per_second", "/body_steps_per_second"] {
            assert!(number(&summary, key) > 0.0);
        }
        for key in ["compressibility", "collision_rate"] {
            assert_eq!(summary.get(key).is_some_and(Value::is_f64), is_periodic);
        }
    }
}

#[test]
fn momentum_balances() {
    let summary = Folder::with(BOX).says("run scene.toml --json").summary();
    let given = ["from_surroundings", "from_gravity"]
        .map(|key| vector(&summary, &format!("/momentum/{key}")));
    let [initial, end, error] = ["initial", "final", "balance_error"]
        .map(|key| vector(&summary, &format!("/momentum/{key}")));
    for k in 0..3 {
        let scale = given[0][k].abs() + given[1][k].abs();
        assert!((end[k] - initial[k] - given[0][k] - given[1][k]).abs() <= 1e-13 * scale);
        assert!(error[k].abs() <= 1e-13 * scale);
    }
}

#[test]
fn energy_changes_by_what_the_integrator_is_known_to_do() {
    let euler = "dt = 0.01\nintegrator = \"semi-implicit-euler\"\nimpact = \"end-of-step\"";
    let folder = Folder::with(&BOX.replace("dt = 0.01", euler));
    let summary = folder.says("run scene.toml --json").summary();
    let change = number(&summary, "/energy/final") - number(&summary, "/energy/initial");
    let drift = number(&summary, "/energy/integrator_drift");
    // n Δt² g² M / 2, M = 3 + 19.
    assert!((drift + 200.0 * 1e-4 * 22.0 / 2.0).abs() < 1e-12);
    assert!((change - drift).abs() < 1e-12 * number(&summary, "/energy/initial"));
}

/// Z and Γ of a fluid belong together, Γ = (6/√π)(Z − 1), and are near the
/// published Z = 3.27 at density 0.5; 256 bodies that start from a lattice are
/// a coarse measure.
#[test]
fn a_fluid_has_the_pressure_of_the_books() {
    let scene = FLUID.replace("duration = 1.0", "duration = 4.0");
    let summary = Folder::with(&scene).says("run scene.toml --json").summary();
    let factor = number(&summary, "/compressibility");
    let rate = number(&summary, "/collision_rate");
    assert!((factor - 3.27).abs() < 0.15, "Z = {factor}");
    // The excess over an ideal gas of 256 bodies, in units of the temperature
    // that the drawn velocities have.
    let excess = factor - (1.0 - 1.0 / 256.0);
    let speed = number(&summary, "/temperature/translational").sqrt();
    let expected = 6.0 / std::f64::consts::PI.sqrt() * excess * speed;
    assert!((rate / expected - 1.0).abs() < 0.02, "Γ = {rate}, not {expected}");
}

#[test]
fn lanes_and_threads_change_no_bit() {
    let folder = Folder::with(BOX);
    for precision in ["f32", "f64"] {
        let hash = |options: &str| {
            let run = format!("run scene.toml --json --precision {precision} {options}");
            folder.says(&run).summary()["state_hash"].as_str().unwrap().to_owned()
        };
        let scalar = hash("--lanes scalar --threads 1");
        for options in ["--lanes 4", "--lanes 8 --threads 2", "--lanes 16", "--lanes auto"] {
            assert_eq!(hash(options), scalar, "{precision} {options}");
        }
        assert_ne!(hash("--seed 4"), scalar);
    }
}

#[test]
fn options_take_the_place_of_the_files_values() {
    let folder = Folder::with(BOX);
    let options = "--dt 0.25 --duration 1.1 --precision f32 --lanes scalar --threads 2";
    let summary = folder.says(&format!("run scene.toml --json {options}")).summary();
    assert_eq!(summary["dt"], 0.25);
    assert_eq!(summary["steps"], 4);
    assert_eq!(summary["time"], 1.0);
    assert_eq!(summary["precision"], "f32");
    assert_eq!(summary["lanes"], 1);
    assert_eq!(summary["threads"], 2);
    // However short, a run is a step at least.
    assert_eq!(folder.says("run scene.toml --json --duration 1e-9").summary()["steps"], 1);
}

#[test]
fn a_person_gets_a_page_of_eighty_columns() {
    let folder = Folder::with(BOX);
    for scene in ["scene.toml", "bouncing-ball", "superball", "newtons-cradle"] {
        let page = folder.says(&format!("run {scene} --duration 0.5 --dt 0.01")).well();
        let widest = page.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(widest <= 80, "{widest} columns:\n{page}");
        for word in ["energy", "momentum", "angular momentum", "state hash  0x"] {
            assert!(page.contains(word), "no {word}:\n{page}");
        }
    }
}

#[test]
fn scenes_are_listed_and_printed_to_start_from() {
    let folder = Folder::with("");
    let list = folder.says("scenes").well();
    for name in ["bouncing-ball", "newtons-cradle", "superball"] {
        assert!(list.contains(name), "{list}");
    }
    let text = folder.says("scenes superball").well();
    std::fs::write(folder.path("mine.toml"), text).unwrap();
    let hash = |scene: &str| {
        let run = format!("run {scene} --json --duration 0.5");
        folder.says(&run).summary()["state_hash"].clone()
    };
    assert_eq!(hash("mine.toml"), hash("superball"));
}

#[test]
fn explain_prints_the_plan() {
    let folder = Folder::with(BOX);
    let plan = folder.says("explain scene.toml --lanes 8 --precision f32").well();
    for word in ["f32", "rough", "lanes"] {
        assert!(plan.contains(word), "{plan}");
    }
    assert!(!folder.says("explain superball").well().is_empty());
}

#[test]
fn help_has_examples() {
    let folder = Folder::with("");
    for command in ["", "run", "explain", "scenes", "analyse", "plot", "picture", "view"] {
        let arguments = format!("{command} --help");
        let arguments = arguments.trim();
        assert!(folder.says(arguments).well().contains("Examples:"), "{arguments}");
    }
    let version = folder.says("--version").well();
    assert_eq!(version, concat!("carom ", env!("CARGO_PKG_VERSION"), "\n"));
}
