//! The event-driven engine, from outside.

use std::fs;

use serde_json::Value;

use crate::{BOX, FLUID, Folder, rows};

/// A scene without a `[stepped]` section, for the event-driven engine.
fn without_steps(scene: &str) -> String {
    let lines = scene.lines().filter(|line| *line != "[stepped]" && !line.starts_with("dt ="));
    let lines: Vec<&str> = lines.collect();
    format!("engine = \"event-driven\"\n{}", lines.join("\n"))
}

/// A ball that lies on the floor, and one that would take its time.
const AT_REST: &str = r#"
engine = "event-driven"
duration = 1.0
gravity = [0.0, 0.0, -9.81]

[[surroundings]]
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]

[[spheres]]
position = [0.0, 0.0, 0.5]
radius = 0.5
"#;

/// The collisions of both kinds, and the rest of a summary.
fn collisions(summary: &Value) -> [u64; 2] {
    ["pairs", "surroundings"].map(|kind| summary["collisions"][kind].as_u64().unwrap())
}

#[test]
fn the_summary_has_the_keys_that_are_promised() {
    for (scene, bodies, is_periodic) in [(BOX, 20, false), (FLUID, 256, true)] {
        let folder = Folder::with(&without_steps(scene));
        let summary = folder.says("run scene.toml --json --threads 2").summary();
        assert_eq!(summary["engine"], "event-driven");
        assert_eq!(summary["bodies"], bodies);
        for key in ["dt", "integrator", "impact"] {
            assert_eq!(summary.get(key), Some(&Value::Null), "{key}");
        }
        assert_eq!((&summary["steps"], &summary["threads"]), (&0.into(), &1.into()));
        assert_eq!(summary["body_steps_per_second"], 0.0);
        assert!(summary["collisions_per_second"].as_f64().unwrap() > 0.0);
        // Time is what was asked for, not a number of steps.
        assert_eq!(summary["time"], if is_periodic { 1.0 } else { 2.0 });
        assert!(summary["energy"]["relative_change"].as_f64().unwrap().abs() < 1e-13);
        assert!(summary["energy"].get("integrator_drift").is_none());
        assert!(summary["mean_free_path"].as_f64().unwrap() > 0.0);
        for key in ["compressibility", "collision_rate"] {
            assert_eq!(summary.get(key).is_some_and(Value::is_f64), is_periodic);
        }
        for error in summary["momentum"]["balance_error"].as_array().unwrap() {
            assert!(error.as_f64().unwrap().abs() < 1e-11);
        }
    }
}

#[test]
fn either_engine_takes_either_scene_with_the_options_of_both() {
    let stepped = Folder::with(BOX);
    let exact = Folder::with(&without_steps(BOX));
    let options = "--json --dt 0.01 --duration 1.5";
    let hash = |folder: &Folder, engine: &str| {
        let summary = folder.says(&format!("run scene.toml {options} --engine {engine}")).summary();
        assert_eq!(summary["engine"], engine);
        summary["state_hash"].clone()
    };
    assert_eq!(hash(&stepped, "stepped"), hash(&exact, "stepped"));
    assert_eq!(hash(&stepped, "event-driven"), hash(&exact, "event-driven"));
    // An engine without steps ignores the length of a step.
    let other = exact.says("run scene.toml --json --dt 0.3 --duration 1.5").summary();
    assert_eq!(other["state_hash"], hash(&exact, "event-driven"));
}

#[test]
fn lanes_threads_and_who_is_told_change_no_bit() {
    // Rough and periodic: the run stops 32 times to look at the temperature.
    let rough = format!("{}\n[surface]\nkind = \"rough\"\n", without_steps(FLUID));
    for scene in [without_steps(BOX), rough] {
        let folder = Folder::with(&scene);
        for precision in ["f32", "f64"] {
            let hash = |options: &str| {
                let run = format!("run scene.toml --json --precision {precision} {options}");
                folder.says(&run).summary()["state_hash"].clone()
            };
            let scalar = hash("--lanes scalar --threads 1");
            for options in [
                "--lanes 4",
                "--lanes 8 --threads 2",
                "--lanes 16",
                "--lanes auto",
                "--events events.csv",
                "--state state.csv",
            ] {
                assert_eq!(hash(options), scalar, "{precision} {options}");
            }
        }
    }
}

/// The mean of a rough gas's temperature is taken on the way, where energy goes
/// into spin, not from the ends alone.
#[test]
fn the_pressure_of_a_rough_gas_has_its_mean_temperature() {
    let rough = format!("{}\n[surface]\nkind = \"rough\"\n", FLUID).replace("n = 1.0", "n = 4.0");
    let folder = Folder::with(&rough);
    let factor = |engine: &str| {
        let run = format!("run scene.toml --json --engine {engine}");
        folder.says(&run).summary()["compressibility"].as_f64().unwrap()
    };
    let (stepped, exact) = (factor("stepped"), factor("event-driven"));
    assert!((stepped - exact).abs() < 0.2, "{stepped} {exact}");
}

#[test]
fn encounters_may_be_left_out() {
    let folder = Folder::with(&without_steps(BOX));
    let counts = [("all", [true, true]), ("surroundings", [false, true]), ("none", [false; 2])];
    for (encounters, expected) in counts {
        let scene = format!("encounters = \"{encounters}\"\n{}", without_steps(BOX));
        fs::write(folder.path("other.toml"), scene).unwrap();
        let summary = folder.says("run other.toml --json --events events.csv").summary();
        assert_eq!(collisions(&summary).map(|count| count > 0), expected, "{encounters}");
        let (_, rows) = rows(&folder.path("events.csv"));
        assert_eq!(rows.len() as u64, collisions(&summary).iter().sum::<u64>());
        let has_flights = expected[1];
        assert_eq!(summary.get("mean_free_path").is_some(), has_flights, "{encounters}");
    }
}

#[test]
fn collisions_count_the_digits_of_pi() {
    let folder = Folder::with("");
    let summary = folder.says("run pi --json").summary();
    assert_eq!(collisions(&summary).iter().sum::<u64>(), 314_159);
    assert!(summary["energy"]["relative_change"].as_f64().unwrap().abs() < 1e-10);
}

#[test]
fn a_ball_in_a_wedge_comes_to_its_end() {
    let folder = Folder::with("");
    for precision in ["f32", "f64"] {
        let run = format!("run wedge --json --precision {precision} --events events.csv");
        let summary = folder.says(&run).summary();
        assert_eq!(summary["time"], 1000.0);
        assert!(collisions(&summary)[1] > 1_000);
        let change = summary["energy"]["relative_change"].as_f64().unwrap();
        assert!(change.abs() < if precision == "f32" { 1e-3 } else { 1e-12 }, "{change}");
    }
}

/// Santaló's mean free path, 4V/S.
#[test]
fn balls_among_fixed_ones_have_their_mean_free_path() {
    let folder = Folder::with("");
    let summary = folder.says("run lorentz-gas --json").summary();
    let path = summary["mean_free_path"].as_f64().unwrap();
    let around = 4.0 * std::f64::consts::PI * 0.95 * 0.95;
    let free = 64.0 - 8.0 * around * 0.95 / 3.0;
    assert!((path / (4.0 * free / (8.0 * around)) - 1.0).abs() < 0.01, "{path}");
}

#[test]
fn what_is_at_rest_is_told_and_leaves_no_file() {
    let folder = Folder::with(AT_REST);
    fs::write(folder.path("state.csv"), "old").unwrap();
    for options in ["", "--precision f32", "--json", "--events events.csv --state state.csv"] {
        let message = folder.says(&format!("run scene.toml {options}")).fails_with(1);
        for words in ["time stands still at 0.0", "sphere 0", "--engine stepped"] {
            assert!(message.contains(words), "{message}");
        }
    }
    assert_eq!(folder.names(), ["scene.toml", "state.csv"]);
    assert_eq!(folder.read("state.csv"), "old");
    // Nothing happens to a ball that nothing pushes.
    let weightless = AT_REST.replace("-9.81", "0.0");
    let summary = Folder::with(&weightless).says("run scene.toml --json").summary();
    assert_eq!(collisions(&summary), [0, 0]);
}

#[test]
fn motion_that_leaves_the_numbers_is_told() {
    let ball = "[[spheres]]\nposition = [0, 0, 0]\nradius = 0.5\n";
    let stone = "[[surroundings]]\nshape = \"sphere\"\ncenter = [9, 0, 0]\nradius = 1\n";
    let top = "engine = \"event-driven\"\nduration = 1e9\n";
    let fast = format!("{top}precision = \"f32\"\n{stone}{ball}velocity = [0, 3e19, 0]\n");
    let faster = fast.replace("3e19", "3e38");
    let falling = format!("{top}gravity = [0, 0, 1e200]\n{ball}");
    assert_eq!(
        collisions(
            &Folder::with(&fast.replace("1e9", "1e-18")).says("run scene.toml --json").summary()
        ),
        [0, 0]
    );
    for (scene, words) in [(faster, "range of numbers"), (falling, "no longer finite")] {
        let folder = Folder::with(&scene);
        let message = folder.says("run scene.toml --state state.csv").fails_with(1);
        assert!(message.contains(words), "{message}");
        assert_eq!(folder.names(), ["scene.toml"]);
    }
}

#[test]
fn every_builtin_scene_runs_on_either_engine() {
    let folder = Folder::with("");
    let list = folder.says("scenes").well();
    let names = list.lines().take_while(|line| !line.is_empty());
    for name in names.map(|line| line.split(' ').next().unwrap()) {
        for engine in ["stepped", "event-driven"] {
            let run = format!("run {name} --engine {engine} --dt 1e-3 --duration 0.02 --json");
            let summary = folder.says(&run).summary();
            assert_eq!((&summary["engine"], &summary["scene"]), (&engine.into(), &name.into()));
            let plan = folder.says(&format!("explain {name} --engine {engine}")).well();
            assert!(plan.contains(&format!("engine                {engine}\n")), "{plan}");
        }
    }
}

#[test]
fn explain_tells_what_this_engine_does() {
    let folder = Folder::with(&without_steps(BOX));
    let plan = folder.says("explain scene.toml --lanes 8").well();
    for words in ["a parabola", "quadratics", "exact time", "from the last contact", "cells"] {
        assert!(plan.contains(words), "no {words}: {plan}");
    }
    assert!(plan.contains("8 in contact times, 8 where neighbours are screened"), "{plan}");
    let plan = folder.says("explain hard-sphere-fluid --precision f32").well();
    for words in ["a straight line", "periodic", "every neighbour is tried", "nothing spins"] {
        assert!(plan.contains(words), "no {words}: {plan}");
    }
    // No orientation is turned in steps that are not taken.
    let plan = folder.says("explain free-flight --engine event-driven").well();
    assert!(plan.contains("one closed form from the start"), "{plan}");
}

#[test]
fn explain_tells_what_meshes_are_like() {
    let folder = Folder::with(
        "duration = 1.0\n[[surroundings]]\nshape = \"mesh\"\nfile = \"roof.obj\"\n\
         [[spheres]]\nposition = [0, 0, 9]\nradius = 1\n",
    );
    let roof =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nv 2 0 0\nv 0 -1 0\nf 1 2 3 4\nf 1 2 5\nf 1 2 6\n";
    std::fs::write(folder.path("roof.obj"), roof).unwrap();
    let plan = folder.says("explain scene.toml").well();
    for words in [
        "surroundings[0]       4 triangles between 6 vertices, 3 faces after seams, 1 component",
        "bounds [0.0, -1.0, 0.0] to [2.0, 1.0, 0.5]",
        "1 non-manifold edge",
        "1 degenerate triangle",
        "4 features",
    ] {
        assert!(plan.contains(words), "no {words}: {plan}");
    }
    let plan = folder.says("explain terrain").well();
    for words in ["2048 triangles between 1089 vertices", "1 component", "open: 128 open edges"] {
        assert!(plan.contains(words), "no {words}: {plan}");
    }
}

#[test]
fn a_person_gets_a_page_of_eighty_columns() {
    let folder = Folder::with(&without_steps(FLUID));
    for scene in ["scene.toml", "wedge", "lorentz-gas"] {
        let page = folder.says(&format!("run {scene} --duration 0.5")).well();
        let widest = page.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(widest <= 80, "{widest} columns:\n{page}");
        for words in ["event-driven", "time        0.5\n", "state hash  0x"] {
            assert!(page.contains(words), "no {words}:\n{page}");
        }
        assert!(!page.contains("step"), "{page}");
    }
}

/// Bodies that start in a plane or in a point leave it.
#[test]
fn a_scene_without_depth_is_no_scene_without_motion() {
    let ball = |x: f64| format!("[[spheres]]\nposition = [{x:?}, 0.1, 2.0]\nradius = 0.5\n");
    let pair = format!("{}velocity = [1.0, 0.0, 0.0]\n{}", ball(0.0), ball(5.0));
    let floor = AT_REST.split("[[spheres]]").next().unwrap().replace("n = 1.0", "n = 10.0");
    let summary = Folder::with(&format!("{floor}{pair}")).says("run scene.toml --json").summary();
    let [pairs, bounces] = collisions(&summary);
    assert_eq!(pairs, 1);
    assert!((16..=18).contains(&bounces), "{bounces}");
}
