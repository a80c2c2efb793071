//! What the program does where a run would come to no end, to no number, or to
//! no sense.

use std::fs;
use std::time::{Duration, Instant};

use crate::{BOX, FLUID, Folder, Said};

/// Runs a scene of its own.
fn says(scene: &str, options: &str) -> Said {
    Folder::with(scene).says(&format!("run scene.toml --json {options}"))
}

/// Fails before anything is written, with these words.
#[track_caller]
fn fails(scene: &str, options: &str, status: i32, words: &[&str]) {
    let folder = Folder::with(scene);
    fs::write(folder.path("state.csv"), "old").unwrap();
    let start = Instant::now();
    let run = format!("run scene.toml {options} --state state.csv --events events.csv");
    let said = folder.says(&run);
    assert_eq!((said.status, said.output.as_str()), (Some(status), ""), "{said:?}");
    for word in words {
        assert!(said.errors.contains(word), "no {word:?} in: {}", said.errors);
    }
    assert!(start.elapsed() < Duration::from_secs(60));
    assert_eq!(folder.names(), ["scene.toml", "state.csv"]);
    assert_eq!(folder.read("state.csv"), "old");
}

/// A ball that spins and meets nothing.
fn spinning(duration: f64, spin: f64, more: &str) -> String {
    format!(
        "duration = {duration:e}\n{more}\n[[spheres]]\nposition = [0.0, 0.0, 0.0]\n\
         spin = [{spin:e}, 0.0, 0.0]\nradius = 0.5\n"
    )
}

#[test]
fn what_is_not_finite_is_no_result() {
    let event_driven = "engine = \"event-driven\"\nprecision = \"f32\"";
    let words = ["the orientation of body 0 is no longer finite", "--precision f64"];
    fails(&spinning(1e10, 1e10, event_driven), "", 1, &words);
    for surface in ["rough", "smooth"] {
        let steps =
            format!("precision = \"f32\"\n[stepped]\ndt = 1e20\n[surface]\nkind = \"{surface}\"");
        fails(&spinning(1e20, 1.0, &steps), "", 1, &words);
    }
    // Not the first body of the file.
    let second = "[[spheres]]\nposition = [9.0, 0.0, 0.0]\nradius = 0.5\n";
    let pair = format!("engine = \"event-driven\"\n{second}{}", spinning(1.0, 1.0, ""));
    let pair = pair.replace("duration = 1e0\n", "").replace("spin = [1e0", "spin = [1e30");
    let pair = format!("precision = \"f32\"\nduration = 1e5\n{pair}").replace("1e30", "1e18");
    fails(&pair, "", 1, &["the orientation of body 1"]);
}

/// An angle without a digit gives a warning, whether it comes out as a number or not.
#[test]
fn angles_and_places_beyond_the_precision_are_told() {
    let said = says(&spinning(1e15, 1e15, "engine = \"event-driven\""), "");
    assert_eq!(said.status, Some(0), "{said:?}");
    assert!(said.errors.starts_with("warning: body 0 turns by 1.0e30 rad"), "{said:?}");
    assert!(said.errors.contains("f64") && said.errors.contains("orientation"), "{said:?}");
    let far = "duration = 1\nengine = \"event-driven\"\nprecision = \"f32\"\n[[spheres]]\n\
               position = [0.0, 0.0, 0.0]\nvelocity = [1e9, 0.0, 0.0]\nradius = 0.5\n";
    let said = says(far, "");
    assert_eq!(said.status, Some(0), "{said:?}");
    assert!(said.errors.contains("body 0 is at 1.0e9"), "{said:?}");
    says(&spinning(1e6, 1.0, "engine = \"event-driven\""), "").summary();
}

/// A container of this depth, and a ball of diameter 1 in the middle.
fn slab(depth: f64, velocity: [f64; 3], more: &str) -> String {
    format!(
        "duration = 0.01\n{more}\n[stepped]\ndt = 1e-3\n[[surroundings]]\nshape = \"box\"\n\
         lower = [0.0, 0.0, 0.0]\nupper = [10.0, 10.0, {depth:?}]\ninside = true\n\
         [[spheres]]\nposition = [2.0, 2.0, {:?}]\nvelocity = {velocity:?}\nradius = 0.5\n",
        depth / 2.0
    )
}

#[test]
fn a_container_that_leaves_no_room_is_refused() {
    let words = ["surroundings[0]", "the container leaves body 0 no room in z"];
    for engine in ["stepped", "event-driven"] {
        for precision in ["f32", "f64"] {
            let options = format!("--engine {engine} --precision {precision}");
            fails(&slab(1.0, [1.0, 0.0, 0.1], ""), &options, 2, &words);
            let gravity = "gravity = [0.0, 0.0, -1.0]";
            fails(&slab(1.0, [1.0, 0.0, 0.0], gravity), &options, 2, &words);
            // In its plane it can move, and with some room every way.
            says(&slab(1.0, [1.0, 0.5, 0.0], ""), &options).summary();
            says(&slab(1.01, [1.0, 0.0, 0.1], ""), &options).summary();
        }
    }
    let planes = "duration = 1\nengine = \"event-driven\"\n[[surroundings]]\nshape = \"plane\"\n\
                  point = [1.0, 0.0, 0.0]\nnormal = [-3.0, 0.0, -4.0]\n[[surroundings]]\nshape = \
                  \"plane\"\npoint = [0.4, 0.0, -0.8]\nnormal = [3.0, 0.0, 4.0]\n[[spheres]]\n\
                  position = [0.7, 0.0, -0.4]\nradius = 0.5\nvelocity = [0.0, 1.0, 1.0]\n";
    fails(planes, "", 2, &["with surroundings[1] it leaves body 0 no room in the direction"]);
    let along = planes.replace("[0.0, 1.0, 1.0]", "[0.0, 1.0, 0.0]");
    says(&along, "").summary();
}

#[test]
fn a_standstill_is_told_as_what_it_is() {
    // A ball stops dead under another one, which flies away.
    let drop = "duration = 0.6\ngravity = [0.0, 0.0, -9.81]\nengine = \"event-driven\"\nprecision \
                = \"f32\"\n[[surroundings]]\nshape = \"plane\"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, \
                0.0, 1.0]\n[[spheres]]\nposition = [0.0, 0.0, 1.12]\nradius = 0.12\nmass = \
                3.0\n[[spheres]]\nposition = [0.0, 0.0, 1.27]\nradius = 0.03\nmass = 1.0\n";
    let message = says(drop, "").fails_with(1);
    assert!(message.contains("it rests on surroundings[0]"), "{message}");
    assert!(message.contains("--engine stepped"), "{message}");
    says(drop, "--engine stepped --dt 1e-4").summary();
    let wedged = "duration = 1.0\ngravity = [0.0, 0.0, -1.0]\nengine = \"event-driven\"\n\
                  [[surroundings]]\nshape = \"box\"\nlower = [0.0, 0.0, 0.0]\nupper = [4.0, 4.0, \
                  4.0]\ninside = true\n[[spheres]]\nposition = [2.0, 2.0, 0.5]\nradius = 0.5\n\
                  [[spheres]]\nposition = [2.0, 2.0, 1.5]\nradius = 0.5\n";
    let message = says(wedged, "").fails_with(1);
    assert!(message.contains("wedged between") || message.contains("rests on"), "{message}");
}

/// Smooth spheres need no moment of inertia; for rough ones the message says
/// which units help.
#[test]
fn molecules_in_f32() {
    let molecules = "duration = 2e-11\nprecision = \"f32\"\nengine = \"event-driven\"\n\
                     [[surroundings]]\nshape = \"box\"\nlower = [0.0, 0.0, 0.0]\nupper = [4e-9, \
                     4e-9, 4e-9]\ninside = true\n[[spheres]]\ncount = 64\narrangement = \
                     \"cubic\"\nradius = 1.85e-10\nmass = 4.65e-26\ntemperature = 4.14e-21\n";
    for options in ["", "--engine stepped --dt 1e-14"] {
        let summary = says(molecules, options).summary();
        assert!(summary["collisions"]["pairs"].as_u64().unwrap() > 100);
        assert!(summary["energy"]["relative_change"].as_f64().unwrap().abs() < 1e-3);
    }
    let rough = format!("{molecules}[surface]\nkind = \"rough\"\n");
    fails(&rough, "", 2, &["moment of inertia of body 0", "units", "precision = \"f64\""]);
}

/// A ball bounces far from the origin: the potential there is no measure.
#[test]
fn energy_is_measured_by_what_the_motion_exchanges() {
    let far = |height: f64| {
        format!(
            "duration = 10.0\ngravity = [0.0, -9.81, 0.0]\nengine = \"event-driven\"\n\
             [[surroundings]]\nshape = \"plane\"\npoint = [0.0, {height:?}, 0.0]\nnormal = [0.0, \
             1.0, 0.0]\n[stepped]\ndt = 1e-3\nintegrator = \"explicit-euler\"\nimpact = \"end-of-step\"\n[[spheres]]\n\
             position = [0.0, {:?}, 0.0]\nradius = 0.5\n",
            height + 1.5
        )
    };
    let change = |height: f64| {
        let summary = says(&far(height), "--engine stepped").summary();
        summary["energy"]["relative_change"].as_f64().unwrap()
    };
    let near = change(0.0);
    assert!(near > 0.01, "{near}");
    for height in [586_507.0, -586_507.0, 1e4] {
        assert!((change(height) / near - 1.0).abs() < 0.2, "{height}");
    }
    // Over whole bounces, from rest to rest, too.
    let exact = says(&far(586_507.0), "").summary();
    assert!(exact["energy"]["relative_change"].as_f64().unwrap().abs() < 1e-8);
}

#[test]
fn runs_without_an_end_are_refused_before_they_begin() {
    let many = "duration = 1e15\n[stepped]\ndt = 1.0\n[[spheres]]\ncount = 10000\n\
                arrangement = \"cubic\"\nlower = [0.0, 0.0, 0.0]\nupper = [100.0, 100.0, 100.0]\n\
                radius = 0.5\n";
    let words = ["1.0e15 steps of 10000 bodies", "years", "--duration", "--dt"];
    fails(many, "--threads 1", 2, &words);
    fails(BOX, "--duration 1e15", 2, &["2^53"]);
    let still = spinning(1e100, 1.0, "engine = \"event-driven\"");
    fails(&still, "", 2, &["1e100", "--duration", "unit of time"]);
}

#[test]
fn set_up_counts_and_the_summary_has_it() {
    let summary = says(BOX, "").summary();
    let [wall, setup] = ["wall_seconds", "setup_seconds"].map(|key| summary[key].as_f64().unwrap());
    assert!(setup > 0.0 && setup < wall, "{setup} of {wall}");
}

/// What stands in a file, a path or an argument does nothing to a terminal.
#[test]
fn messages_have_no_control_characters() {
    let long = "x".repeat(1_000_000);
    let scenes = [
        "[surface]\nkind = \"\\u001b[2J\\u001b[31mhello\"\n".to_owned(),
        "\"\\u001b]0;title\\u0007\" = 1\n".to_owned(),
        "[[surroundings]]\nshape = \"\\u009b31m\\u202e\"\n".to_owned(),
        "[[spheres]]\nfile = \"\\u001b[2J\\n.csv\"\n".to_owned(),
        "spheres = \"\\u001b[2J\"\n".to_owned(),
        "[stepped]\n\"a\\r\\nb\\u007f\" = 1\n".to_owned(),
        "gravity = \u{1b}[2J\n".to_owned(),
        format!("precision = \"{long}\"\n"),
        format!("{long} = 1\n"),
    ];
    for scene in scenes {
        let message = Folder::with(&scene).says("run scene.toml").fails_with(2);
        check(&message, 1);
        assert!(message.contains("scene.toml:"), "{message}");
    }
    let folder = Folder::with(BOX);
    fs::copy(folder.path("scene.toml"), folder.path("\u{1b}[2J.toml")).unwrap();
    let said = Said::from(folder.program(["run", "\u{1b}[2J.toml"]).output().unwrap());
    assert!(said.output.starts_with("\\u{1b}[2J: 20 rough spheres"), "{said:?}");
    for arguments in [
        vec!["run", "no\u{1b}[2J.toml"],
        vec!["run", "no\u{1b}[2J"],
        vec!["run", "scene.toml", "--state", "no\u{1b}[2J/x.csv"],
        vec!["run", "scene.toml", "--dt", "\u{1b}[2J"],
        vec!["run", "--\u{1b}[2J"],
        vec!["\u{1b}[2J\u{7}"],
        vec!["scenes", &long[..100_000]],
        vec!["run", "scene.toml", "--lanes", &long[..100_000]],
    ] {
        let said = Said::from(folder.program(arguments).output().unwrap());
        assert_eq!(said.status, Some(2), "{said:?}");
        check(&said.errors, 20);
    }
}

fn check(message: &str, lines: usize) {
    let is_plain = |c: char| c == '\n' || (!c.is_control() && c != '\u{202e}');
    assert!(message.chars().all(is_plain), "{message:?}");
    assert!(message.lines().count() <= lines && message.len() < 5000, "{message:?}");
}

/// The gas of `FLUID` in a closed box for ever.
#[test]
fn crossings_are_counted() {
    let words = ["--duration", "2^53"];
    fails(FLUID, "--engine event-driven --duration 1e30", 2, &words);
    let alone = "duration = 1e20\nengine = \"event-driven\"\n[[surroundings]]\nshape = \"box\"\n\
                 lower = [0.0, 0.0, 0.0]\nupper = [4.0, 4.0, 4.0]\ninside = true\n[[spheres]]\n\
                 position = [2.0, 2.0, 2.0]\nvelocity = [1.0, 0.0, 0.0]\nradius = 0.5\n";
    fails(alone, "", 2, &words);
    // A ball that never moves is there at once.
    says(&alone.replace("[1.0, 0.0, 0.0]", "[0.0, 0.0, 0.0]"), "").summary();
}
