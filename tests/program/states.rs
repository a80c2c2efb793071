//! Spheres from a state file: read back bit by bit, with what is missing filled
//! in, and mistakes with their file, line and column.

use std::fs;

use carom::DoubleDouble;
use carom::bodies::Bodies;
use carom::observe::state_hash;
use carom::scene::{Buildable, SceneFile};

use crate::{BOX, Folder};

/// The box of `BOX`, with spheres from a file.
const AGAIN: &str = r#"
spheres = { file = "state.csv" }
duration = 1.0
gravity = [0.0, 0.0, -1.0]

[stepped]
dt = 0.01

[surface]
kind = "rough"

[[surroundings]]
shape = "box"
lower = [0.0, 0.0, 0.0]
upper = [4.0, 4.0, 4.0]
inside = true
"#;

/// Two spheres by their places.
const PLACES: &str = "x,y,z\n1,1,1\n3,3,3\n";

fn bodies<T: Buildable>(folder: &Folder, scene: &str) -> Bodies<T> {
    let path = folder.path("again.toml");
    fs::write(&path, scene).unwrap();
    SceneFile::load(&path).unwrap().build::<T>().unwrap().bodies
}

#[test]
fn a_state_of_its_own_is_read_back_bit_by_bit() {
    fn check<T: Buildable>() {
        for engine in ["event-driven", "stepped"] {
            let folder = Folder::with(BOX);
            let options = format!("--precision {} --engine {engine}", T::NAME);
            let run = format!("run scene.toml --json --state state.csv {options}");
            let summary = folder.says(&run).summary();
            let bodies = bodies::<T>(&folder, AGAIN);
            assert_eq!(summary["state_hash"], state_hash(&bodies).to_string());
            // Radii and masses, and with them the moments of inertia.
            let first = SceneFile::load(&folder.path("scene.toml")).unwrap().build::<T>().unwrap();
            assert_eq!(bodies.radius, first.bodies.radius);
            assert_eq!(bodies.mass, first.bodies.mass);
            assert_eq!(bodies.inertia, first.bodies.inertia);
            let summary = folder.says(&format!("run again.toml --json {options}")).summary();
            assert_eq!(summary["bodies"], 20);
        }
    }
    check::<f32>();
    check::<f64>();
    check::<DoubleDouble>();
}

/// Columns in another order, with spaces and unknown ones among them; and the
/// file as one entry among others, in a folder of its own.
#[test]
fn columns_are_found_by_their_names() {
    let folder = Folder::with("");
    fs::create_dir(folder.path("states")).unwrap();
    let text = "name, z ,radius,y,x,id\r\na, 3.5 ,0.25,2.5,1.5,7\r\nb,1,0.5,1,1,3\r\n";
    fs::write(folder.path("states/two.csv"), text).unwrap();
    let scene = "[[spheres]]\nposition = [9, 9, 9]\nradius = 1\n\n[[spheres]]\nfile = \
                 \"states/two.csv\"\ndensity = 2.0\nvelocity = [1, 2, 3]\nspin = [0, 0, 4]\n\
                 inertia_factor = 0.5\n[stepped]\ndt = 1\n";
    let bodies = bodies::<f64>(&folder, scene);
    assert_eq!(bodies.len(), 3);
    assert_eq!(bodies.position_of(1).to_array(), [1.5, 2.5, 3.5]);
    assert_eq!(bodies.radius.of(1), 0.25);
    let mass = 2.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.125;
    assert!((bodies.mass.of(2) - mass).abs() < 1e-15);
    assert!((bodies.inertia.of(2) - 0.5 * mass * 0.25).abs() < 1e-16);
    assert_eq!(bodies.velocity_of(2).to_array(), [1.0, 2.0, 3.0]);
    assert_eq!(bodies.spin_of(1).to_array(), [0.0, 0.0, 4.0]);
    assert!(bodies.orientation.is_none());
}

#[test]
fn a_temperature_gives_velocities_that_the_file_has_not() {
    let folder = Folder::with("");
    let rows: String = (0..1000).map(|k| format!("{k},0,0\n")).collect();
    fs::write(folder.path("state.csv"), format!("x,y,z\n{rows}")).unwrap();
    let scene = "seed = 5\n[stepped]\ndt = 1\n[[spheres]]\nfile = \"state.csv\"\nradius = [0.1, \
                 0.4]\nmass = 2.0\ntemperature = 3.0\nspin_temperature = 1.0\n";
    let bodies = bodies::<f64>(&folder, scene);
    let gas = carom::Temperature::of(&bodies).unwrap();
    assert!((gas.translational / 3.0 - 1.0).abs() < 0.1, "{gas}");
    assert!((gas.rotational - 1.0).abs() < 0.1, "{gas}");
}

/// Refuses the scene, by a message with these words.
#[track_caller]
fn refused(state: &[u8], entry: &str, words: &[&str]) {
    let folder = Folder::with("");
    fs::write(folder.path("state.csv"), state).unwrap();
    let scene =
        format!("duration = 1\n[stepped]\ndt = 0.1\n[[spheres]]\nfile = \"state.csv\"\n{entry}\n");
    fs::write(folder.path("scene.toml"), scene).unwrap();
    let message = folder.says("run scene.toml --state end.csv").fails_with(2);
    for word in words {
        assert!(message.contains(word), "no {word:?} in: {message}");
    }
    assert_eq!(folder.names(), ["scene.toml", "state.csv"]);
}

#[test]
fn mistakes_in_the_file_have_their_line_and_column() {
    let radius = "radius = 0.5";
    let cases: &[(&[u8], &[&str])] = &[
        (b"", &["state.csv: is empty"]),
        (b"\n\n", &["state.csv: is empty"]),
        (b"x,y,z\n", &["state.csv: is without spheres"]),
        (b"x,z\n1,2\n", &["state.csv:1: column y is missing", "x,z"]),
        (b"x;y;z\n1;2;3\n", &["state.csv:1: column x is missing", "x;y;z"]),
        (b"x,y,z,vx,vz\n1,2,3,4,5\n", &["state.csv:1: column vy is missing", "vz"]),
        (b"x,y,z,x\n1,2,3,4\n", &["state.csv:1: column x", "another"]),
        (b"x,y,z,Mass\n1,2,3,4\n", &["state.csv:1: column mass", "\"Mass\""]),
        (b"x,y,z\n1,2,3\n4,abc,6\n", &["state.csv:3: column y is \"abc\"", "number"]),
        (b"x,y,z\n1,2,NaN\n", &["state.csv:2: column z is \"NaN\"", "finite"]),
        (b"x,y,z\n1,-inf,2\n", &["state.csv:2: column y is \"-inf\"", "finite"]),
        (b"x,y,z\n1,1e999,2\n", &["state.csv:2: column y is \"1e999\""]),
        (b"x,y,z\n1,,2\n", &["state.csv:2: column y is \"\""]),
        (b"x,y,z\n1,2,3\n\n4,5\n", &["state.csv:4: the line is 2 fields long", "3 columns"]),
        (b"x,y,z\n1,2,3,4\n", &["state.csv:2: the line is 4 fields long"]),
        (b"x,y,z\n1,\x1b[2J\xff,3\n", &["state.csv:2: column y is \"\\u{1b}[2J"]),
        (b"x,y,z,mass\n1,2,3,0\n", &["state.csv:2: column mass is \"0\"", "greater than 0"]),
        (
            b"x,y,z,m00,m01,m02,m10,m11,m12,m20,m21,m22\n1,2,3,1,0,0,0,1,0,0,0,2\n",
            &["state.csv:2: columns m00 to m22 is no rotation"],
        ),
        (b"x,y,z\n1,2,3\n1,2,3.1\n", &["spheres[0] puts body 1 into body 0", "0.9"]),
    ];
    for (state, words) in cases {
        refused(state, radius, words);
    }
    let bad = b"x,y,z,radius\n1,2,3,-0.5\n";
    refused(bad, "", &["state.csv:2: column radius is \"-0.5\"", "greater than 0"]);
    let long = format!("x,y,z\n1,2,{}\n", "9x".repeat(100_000));
    refused(long.as_bytes(), radius, &["state.csv:2: column z is \"9x", "…"]);
}

#[test]
fn keys_that_contradict_the_file_are_refused() {
    let state = PLACES.as_bytes();
    refused(state, "", &["scene.toml", "spheres[0].radius is missing"]);
    refused(state, "radius = -1", &["scene.toml:6:", "spheres[0].radius", "-1"]);
    refused(state, "radius = 0.5\nmass = 1\ndensity = 1", &["density", "mass"]);
    for key in ["count = 2", "position = [1, 1, 1]", "lower = [0, 0, 0]", "number_density = 1"] {
        let name = key.split(' ').next().unwrap();
        refused(state, &format!("radius = 0.5\n{key}"), &["scene.toml:7:", name, "beside file"]);
    }
    let all = b"x,y,z,radius,mass,vx,vy,vz,wx,wy,wz\n1,1,1,0.5,1,0,0,0,0,0,0\n";
    for key in ["radius = 1", "mass = 1", "density = 1", "velocity = [1, 0, 0]", "temperature = 1"]
    {
        let name = key.split(' ').next().unwrap();
        refused(all, key, &["scene.toml:6:", name, "state.csv", "columns"]);
    }
}

#[test]
fn what_is_no_file_is_refused() {
    let folder = Folder::with("");
    fs::create_dir(folder.path("folder.csv")).unwrap();
    for file in ["none.csv", "folder.csv", "/dev/zero", ""] {
        let scene = format!("duration = 1\n[stepped]\ndt = 0.1\n[[spheres]]\nfile = {file:?}\n");
        fs::write(folder.path("scene.toml"), scene).unwrap();
        let message = folder.says("run scene.toml").fails_with(2);
        assert!(message.contains("scene.toml:5: spheres[0].file is"), "{message}");
        assert!(message.contains("cannot be read"), "{message}");
    }
}

/// Steps end with spheres in each other; a run from there is no mistake, and
/// spheres that are deep in each other are one.
#[test]
fn spheres_may_overlap_as_a_step_leaves_them() {
    let folder = Folder::with("");
    let scene =
        "duration = 1\n[stepped]\ndt = 0.1\n[[spheres]]\nfile = \"state.csv\"\nradius = 0.5\n";
    fs::write(folder.path("scene.toml"), scene).unwrap();
    let says = |distance: f64| {
        fs::write(folder.path("state.csv"), format!("x,y,z\n0,0,0\n{distance},0,0\n")).unwrap();
        folder.says("run scene.toml --json")
    };
    says(0.95).summary();
    let message = says(0.5).fails_with(2);
    assert!(message.contains("overlap by 0.5;"), "{message}");
}

/// What long steps leave spheres in, a scene of such steps takes.
#[test]
fn a_run_in_long_steps_goes_on_from_its_state() {
    let folder = Folder::with(BOX);
    let options = "--set stepped.impact=end-of-step --dt 0.1 --engine stepped --json";
    for duration in 1..=12 {
        let run = format!("run scene.toml --duration {duration} --state state.csv {options}");
        folder.says(&run).summary();
        fs::write(folder.path("again.toml"), AGAIN).unwrap();
        let summary = folder.says(&format!("run again.toml {options}")).summary();
        assert_eq!(summary["bodies"], 20);
    }
}
