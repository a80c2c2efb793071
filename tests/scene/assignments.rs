//! `--set`: other values in the place of the file's.

use carom::scene::{EngineKind, Precision};
use carom::{SceneFile, Surface};

const TWO: &str = "duration = 1\ngravity = [0, 0, -1]\n[surface]\nkind = \"rough\"\n\
                   [[spheres]]\nposition = [0, 0, 0]\nradius = 1\n\
                   [[spheres]]\nposition = [0, 0, 5]\nradius = 2\nspin = [0, 0, 1]\n";

fn set(assignments: &[&str]) -> Result<SceneFile, String> {
    let file = SceneFile::parse("s.toml", TWO).unwrap();
    file.with_values(assignments).map_err(|error| error.to_string())
}

#[track_caller]
fn assert_refused(assignments: &[&str], message: &str) {
    let refused = match set(assignments) {
        Ok(file) => file.build::<f64>().unwrap_err().to_string(),
        Err(refused) => refused,
    };
    assert!(refused.starts_with(message), "{refused}\nis not\n{message}");
}

#[test]
fn every_kind_of_key_can_be_set() {
    let file = set(&[
        "spheres[1].radius=0.5",
        " spheres[0].velocity = [1, 2, 3] ",
        "spheres[1].spin[2]=7",
        "gravity[2]=-9.81",
        "surface.kind=smooth",
        "stepped.dt=0.125",
        "precision=\"f32\"",
        "seed=18446744073709551615",
        "duration=3",
        "duration=4",
        "periodic={lower=[-20,-20,-20],upper=[20,20,20]}",
    ])
    .unwrap();
    assert_eq!((file.duration, file.dt, file.seed), (Some(4.0), Some(0.125), u64::MAX));
    assert_eq!((file.precision, file.engine), (Precision::F32, EngineKind::Stepped));
    let scene = file.build::<f64>().unwrap();
    assert_eq!(scene.gravity.to_array(), [0.0, 0.0, -9.81]);
    assert_eq!(scene.surface, Surface::Smooth);
    assert_eq!((scene.bodies.radius.of(0), scene.bodies.radius.of(1)), (1.0, 0.5));
    assert_eq!(scene.bodies.velocity_of(0).to_array(), [1.0, 2.0, 3.0]);
    assert_eq!(scene.bodies.spin_of(1).to_array(), [0.0, 0.0, 7.0]);
    assert!(scene.periodic.is_some());
    assert_eq!(file.values().len(), 11);
    // What was set before stays.
    let further = file.with_values(&["spheres[0].radius=1.5"]).unwrap();
    assert_eq!(further.build::<f64>().unwrap().bodies.radius.of(1), 0.5);
}

#[test]
fn a_set_file_is_the_file_with_those_values() {
    let built = |file: SceneFile| format!("{:?}", file.build::<f64>().unwrap().bodies);
    let written = SceneFile::parse("s.toml", &TWO.replace("radius = 2", "radius = 0.25")).unwrap();
    assert_eq!(built(set(&["spheres[1].radius=0.25"]).unwrap()), built(written));
    let single = SceneFile::parse("s", "spheres = { position = [0, 0, 0], radius = 1 }").unwrap();
    let single = single.with_values(&["spheres[0].radius=2"]).unwrap();
    assert_eq!(single.build::<f64>().unwrap().bodies.radius.of(0), 2.0);
}

#[test]
fn mistakes_are_those_of_the_file_and_name_the_option() {
    assert_refused(
        &["spheres[0].radius=0.5", "spheres[0].radus=1", "duration=2"],
        "--set spheres[0].radus is not a key that means something here; known are `file`, ",
    );
    assert_refused(&["sphere=1"], "--set sphere is not a key that means something here; ");
    assert_refused(
        &["spheres[0].radius=big"],
        "--set spheres[0].radius is string \"big\"; it must be a number, or two, ",
    );
    assert_refused(&["seed=-1"], "--set seed is integer `-1`; it must be a whole number from 0 up");
    assert_refused(&["surface.kind=wet"], "--set surface.kind is `wet`; it must be ");
    assert_refused(&["spheres[0].radius=-1"], "--set spheres[0].radius is -1.0; a radius must be ");
    assert_refused(&["duration=-1"], "--set duration is -1.0; ");
    assert_refused(&["stepped.dt=0"], "--set stepped.dt is 0.0; a time step must be ");
    assert_refused(&["spheres=[{position=[0,0,0]}]"], "--set spheres is missing; ");
    assert_refused(
        &["spheres[2].radius=1"],
        "--set spheres[2].radius is beyond the end of its list; entries are counted from 0, and \
         there are 2",
    );
    assert_refused(&["duration.x=1"], "--set duration.x is in a single value; only a table has ");
    assert_refused(&["surface[0]=1"], "--set surface[0] is in a table; only a list has an entry");
    for text in ["radius", "=1", "radius=", "a..b=1", "a[b]=1", "a[0=1", "a b=1"] {
        assert_refused(&[text], &format!("--set is {text:?}; it must be KEY=VALUE, as in "));
    }
    // An option of its own comes last.
    let mut file = set(&["duration=2"]).unwrap();
    file.duration = Some(f64::NAN);
    let message = file.build::<f64>().unwrap_err().to_string();
    assert!(message.starts_with("--duration is NaN; "), "{message}");
    // A mistake in the file itself has its line, whatever is set.
    let error = SceneFile::parse("s.toml", "seed = \"x\"").unwrap_err().to_string();
    assert!(error.starts_with("s.toml:1: seed is string"), "{error}");
}
