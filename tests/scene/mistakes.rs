//! What is said to a mistake in a scene file.

use std::path::Path;

use carom::engine::{EventDriven, Stepped};
use carom::scene::{Problem, Scene, SceneFile, Sphere, builtin_scenes};

use crate::{BALL, assert_starts, ball_message, file, group_message, message, message_in};

#[test]
fn overlaps_are_found_whatever_the_sizes() {
    let near = "[[spheres]]\nposition = [0, 0, 5.25]\nradius = 4.5\n";
    assert_starts(
        &message(&format!("{BALL}{near}")),
        "s.toml:5: spheres[1] puts body 1 into body 0: they overlap by 0.25; ",
    );
    let across = "periodic = { lower = [-5, -5, -5], upper = [5, 5, 5] }\n\
                  [[spheres]]\nposition = [0, 0, 4.5]\nradius = 1\n\
                  [[spheres]]\nposition = [0, 0, -4.5]\nradius = 1\n";
    assert_starts(&message(across), "s.toml:6: spheres[1] puts body 1 into body 0: ");
    let both = format!("encounters = \"none\"\n{BALL}{BALL}");
    assert_eq!(file(&both).unwrap().build::<f64>().unwrap().bodies.len(), 2);
}

#[test]
fn what_is_no_scene_file_is_told_apart() {
    let error = SceneFile::load(Path::new("no/such/file.toml")).unwrap_err();
    assert!(matches!(*error.problem, Problem::Unreadable(_)));
    assert_starts(&error.to_string(), "no/such/file.toml: cannot be read: ");
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("bytes.toml");
    std::fs::write(&path, b"seed = 1\n\xff").unwrap();
    let error = SceneFile::load(&path).unwrap_err();
    assert!(error.to_string().contains("is not text: byte 9 is not UTF-8"), "{error}");
    std::fs::write(&path, format!("stepped.dt = 1\n{BALL}")).unwrap();
    assert_eq!(SceneFile::load(&path).unwrap().name, "bytes");

    assert_starts(&message("gravity = [0, 0\nseed = 1"), "s.toml:3: not TOML: ");
    assert_starts(&message("seed = 1\nseed = 2"), "s.toml:3: not TOML: duplicate key");
}

#[test]
fn unknown_keys_and_wrong_types() {
    assert_starts(&message("gravitation = 1"), "s.toml:2: gravitation is not a key that means ");
    assert_starts(&ball_message("radus = 1"), "s.toml:5: spheres[0].radus is not a key that ");
    assert_starts(&message("[surface]\nfriction = 1"), "s.toml:3: surface.friction is not a key");
    assert_starts(
        &message("periodic = { lower = [0, 0, 0], upper = [1, 1, 1], sides = 1 }"),
        "s.toml:2: periodic.sides is not a key",
    );
    assert_eq!(
        ball_message("mass = \"heavy\""),
        "s.toml:5: spheres[0].mass is string \"heavy\"; \
         it must be a number, or two, [least, greatest], to spread over"
    );
    assert_eq!(
        message("duration = true"),
        "s.toml:2: duration is boolean `true`; it must be a number"
    );
    assert_starts(&message("gravity = 9.81"), "s.toml:2: gravity is floating point `9.81`; ");
    assert_starts(&message("gravity = [0, 0]"), "s.toml:2: gravity is an array of length 2; ");
    assert_starts(&message("gravity = [0, 0, 0, 0]"), "s.toml:2: gravity is too long an array; ");
    assert_starts(&message("gravity = [0, \"a\", 0]"), "s.toml:2: gravity[1] is string \"a\"; ");
    assert_starts(&message("seed = -1"), "s.toml:2: seed is integer `-1`; ");
    assert_starts(&message("seed = 1.5"), "s.toml:2: seed is floating point `1.5`; ");
    assert_starts(&message("engine = \"warp\""), "s.toml:2: engine is `warp`; it must be ");
    assert_starts(&message("periodic = \"sphere\""), "s.toml:2: periodic is string \"sphere\"; ");
    assert_starts(&message("spheres = 3"), "s.toml:2: spheres is integer `3`; ");
}

#[test]
fn values_out_of_range() {
    for bad in ["0", "-0.5", "nan", "inf", "-inf"] {
        for key in ["radius", "mass", "density"] {
            let text = format!("[[spheres]]\nposition = [0, 0, 0]\n{key} = {bad}\n");
            let text = if key == "radius" { text } else { format!("{text}radius = 1\n") };
            let message = message(&text);
            assert_starts(&message, &format!("s.toml:4: spheres[0].{key} is "));
            let right = format!("; a {key} must be finite and greater than 0");
            assert!(message.ends_with(&right), "{message}");
        }
        let message = message(&format!("duration = {bad}\n{BALL}"));
        assert_starts(&message, "s.toml:2: duration is ");
        assert!(message.ends_with("; a duration must be finite and greater than 0"), "{message}");
        let text = format!("# a step\n[stepped]\ndt = {bad}\n{BALL}");
        let message = SceneFile::parse("s", &text).unwrap().build::<f64>().unwrap_err().to_string();
        assert_starts(&message, "s:3: stepped.dt is ");
    }
    for bad in ["0.0", "-0.1", "0.7", "nan"] {
        let message = ball_message(&format!("inertia_factor = {bad}"));
        assert_starts(&message, "s.toml:5: spheres[0].inertia_factor is ");
    }
    assert_starts(&ball_message("velocity = [0, nan, 0]"), "s.toml:5: spheres[0].velocity is [0.");
    assert_starts(&ball_message("spin = [0, inf, 0]"), "s.toml:5: spheres[0].spin is [0.0, inf");
    assert_starts(&message("gravity = [0, 0, nan]"), "s.toml:2: gravity is [0.0, 0.0, NaN]; ");
    assert_starts(
        &message("[[spheres]]\nposition = [nan, 0, 0]\nradius = 1"),
        "s.toml:3: spheres[0].position is [NaN, 0.0, 0.0]; ",
    );
    assert_starts(
        &message_in::<f32>("[[spheres]]\nposition = [0, 0, 0]\nradius = 1e-50"),
        "s.toml:4: spheres[0].radius is 1e-50; a radius must be finite and greater than 0 in f32",
    );
    assert_starts(
        &message_in::<f32>(
            "surface.kind = \"rough\"\n[[spheres]]\nposition = [0, 0, 0]\nradius = 1e-25",
        ),
        "s.toml:3: spheres[0] is such that the moment of inertia of body 0 is 0.0 in f32; ",
    );
    assert_starts(
        &message("[[spheres]]\nposition = [0, 0, 0]\nradius = [2, 1]"),
        "s.toml:4: spheres[0].radius is [2.0, 1.0]; the lesser bound comes first",
    );
}

#[test]
fn steps_that_are_missing_or_too_many() {
    let built = |text: &str| SceneFile::parse("s", text).unwrap().build::<f64>();
    assert_starts(
        &built(&format!("engine = \"stepped\"\n{BALL}")).unwrap_err().to_string(),
        "s: stepped.dt is missing; the stepped engine has no default for it: set `dt` under \
         [stepped], or --dt",
    );
    // Code chooses its engine after the scene is built.
    let ball =
        || Scene::<f64>::builder().sphere(Sphere::new([0.0; 3]).radius(1.0)).build().unwrap();
    let error = Stepped::new(ball()).unwrap_err();
    assert!(error.to_string().contains("`.dt()` of the builder"), "{error}");
    EventDriven::new(ball()).unwrap();
    built(BALL).unwrap();
    built(&format!("engine = \"event-driven\"\n{BALL}")).unwrap();
    let error = built(&format!("duration = 1e9\nstepped.dt = 1e-9\n{BALL}")).unwrap_err();
    assert_starts(&error.to_string(), "s:2: stepped.dt is 1e-9; that is 1e18 steps, ");
    // An engine without steps takes as many.
    built(&format!("engine = \"event-driven\"\nduration = 1e9\nstepped.dt = 1e-9\n{BALL}"))
        .unwrap();
    let file = SceneFile::parse("s", BALL).unwrap();
    assert_starts(&file.run_duration().unwrap_err().to_string(), "s: duration is missing; set ");
}

#[test]
fn options_are_blamed_for_their_values() {
    let mut file = file(&format!("duration = 1\n{BALL}")).unwrap();
    file.dt = Some(-1.0);
    let error = file.build::<f64>().unwrap_err();
    assert_eq!(error.place.option.as_deref(), Some("--dt"));
    assert_eq!(error.to_string(), "--dt is -1.0; a time step must be finite and greater than 0");
    file.dt = Some(0.1);
    file.duration = Some(f64::NAN);
    assert_starts(&file.build::<f64>().unwrap_err().to_string(), "--duration is NaN; ");
}

#[test]
fn bodies_where_they_cannot_be() {
    let plane = "[[surroundings]]\nshape = \"plane\"\npoint = [0, 0, -0.75]\nnormal = [0, 0, 1]\n";
    assert_starts(
        &message(&format!("{plane}{BALL}")),
        "s.toml:6: spheres[0] puts body 0 inside of surroundings[0], which is solid, by 0.25; ",
    );
    let solid = "[[surroundings]]\nshape = \"box\"\nlower = [0.5, -1, -1]\nupper = [2, 1, 1]\n";
    assert_starts(
        &message(&format!("{solid}{BALL}")),
        "s.toml:6: spheres[0] puts body 0 inside of surroundings[0], which is solid, by 0.5; ",
    );
    let container = format!("{solid}inside = true\n{BALL}");
    assert_starts(
        &message(&container),
        "s.toml:7: spheres[0] puts body 0 outside of its container, surroundings[0], by 1.5; ",
    );
    let hollow = "[[surroundings]]\nshape = \"sphere\"\ncenter = [1, 0, 0]\nradius = 1.5\n\
                  inside = true\n";
    assert_starts(
        &message(&format!("{hollow}{BALL}")),
        "s.toml:7: spheres[0] puts body 0 outside of its container, surroundings[0], by 0.5; ",
    );
    let periodic = "periodic = { lower = [1, -9, -9], upper = [19, 9, 9] }\n";
    assert_starts(
        &message(&format!("{periodic}{BALL}")),
        "s.toml:3: spheres[0] puts body 0 outside of the periodic box, by 1.0; ",
    );
    // A centre on the upper face is one on the lower.
    let text = format!("periodic = {{ lower = [-9, -9, -9], upper = [0, 9, 9] }}\n{BALL}");
    let bodies = file(&text).unwrap().build::<f64>().unwrap().bodies;
    assert_eq!(bodies.position_of(0).to_array(), [-9.0, 0.0, 0.0]);
}

#[test]
fn boxes_that_cannot_be() {
    let periodic = |lower: &str, upper: &str| {
        message(&format!("[periodic]\nlower = {lower}\nupper = {upper}\n{BALL}"))
    };
    assert_starts(&periodic("[0, 0, 0]", "[5, 5, 0]"), "s.toml:3: periodic.lower is [0.0, 0.0,");
    assert_starts(&periodic("[0, 0, nan]", "[5, 5, 5]"), "s.toml:3: periodic.lower is [0.0, ");
    assert_starts(&periodic("[0, 0, 0]", "[5, 5, inf]"), "s.toml:4: periodic.upper is [5.0, ");
    assert_starts(&periodic("[0, 0, 0]", "[5, 5, 3.5]"), "s.toml:2: periodic is 3.5 wide; a side");
    assert_starts(&message("[periodic]\nlower = [0, 0, 0]"), "s.toml:2: periodic.upper is missing");
    let walls = "[[surroundings]]\nshape = \"box\"\nlower = [0, 0, 0]\nupper = [9, 9, 9]\n";
    let space = "[periodic]\nlower = [0, 0, 0]\nupper = [9, 9, 9]\n";
    assert_starts(
        &message(&format!("{walls}inside = true\n{space}{BALL}")),
        "s.toml:2: surroundings[0] cannot stand beside a periodic box: a container ends space",
    );
    assert_starts(
        &message(&format!("{walls}{space}{BALL}")),
        "s.toml:2: surroundings[0] is too near to the faces of the periodic box; ",
    );
}

/// What is said to the keys of a shape, the first of which stands on line 4.
fn shape_message(shape: &str, keys: &str) -> String {
    message(&format!("[[surroundings]]\nshape = \"{shape}\"\n{keys}\n{BALL}"))
}

#[test]
fn round_shapes_that_cannot_be() {
    let cases = [
        (
            "triangle",
            "vertices = [[0, 0, 5], [1, 0, 5]]",
            "s.toml:4: surroundings[0].vertices is a list of 2 points; a triangle has three",
        ),
        (
            "triangle",
            "vertices = [[0, 0, 5], [1, 1, 5], [3, 3, 5]]",
            "s.toml:4: surroundings[0].vertices is [[0.0, 0.0, 5.0], [1.0, 1.0, 5.0], [3.0, 3.0, \
             5.0]]; the corners must not lie on one ",
        ),
        (
            "triangle",
            "vertices = [[0, 0, 5], [1, inf, 5], [3, 3, 5]]",
            "s.toml:4: surroundings[0].vertices is [1.0, inf, 5.0]; every component must be finite",
        ),
        (
            "capsule",
            "a = [0, 0, 5]\nb = [0, 0, 5]\nradius = 1",
            "s.toml:5: surroundings[0].b is [0.0, 0.0, 5.0]; it must be another point than a, ",
        ),
        (
            "cylinder",
            "center = [0, 0, 5]\naxis = [0, 0, 0]\nradius = 1",
            "s.toml:5: surroundings[0].axis is no direction; an axis must be finite and ",
        ),
        (
            "cylinder",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nradius = 1\nheight = 0",
            "s.toml:7: surroundings[0].height is 0.0; a height must be finite and greater than 0",
        ),
        (
            "cylinder",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nradius = 1\ntop_radius = 2",
            "s.toml:7: surroundings[0].top_radius cannot stand beside shape = \"cylinder\": ",
        ),
        (
            "cone",
            "base = [0, 0, 5]\naxis = [0, 0, 1]\nheight = 2\nradius = 0",
            "s.toml:7: surroundings[0].radius is 0.0; the base or the top must have a radius",
        ),
        (
            "cone",
            "base = [0, 0, 5]\naxis = [0, 0, 1]\nheight = 2\nradius = 1\ntop_radius = -1",
            "s.toml:8: surroundings[0].top_radius is -1.0; a radius, if not 0, must be finite ",
        ),
        (
            "annulus",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\ninner = 1\nouter = 1",
            "s.toml:6: surroundings[0].inner is 1.0; it must be less than outer, 1.0",
        ),
        (
            "annulus",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nradius = 1",
            "s.toml:6: surroundings[0].radius is there beside shape = \"annulus\"; it is a key of \
             a disc",
        ),
        (
            "capped-cylinder",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nradius = 1",
            "s.toml:2: surroundings[0].half_height is missing; ",
        ),
        (
            "cone",
            "apex = [0, 0, 5]\naxis = [0, 0, 1]\nslope = 1\nheight = 2",
            "s.toml:7: surroundings[0].height is there beside apex or slope; a cone has ",
        ),
        (
            "hull",
            "vertices = [[0, 0, 5], [1, 0, 5], [0, 1, 5]]",
            "s.toml:4: surroundings[0].vertices is a list of 3 points; a hull has four or more",
        ),
        (
            "hull",
            "vertices = [[0, 0, 5], [1, 0, 5], [0, 1, 5], [1, 1, 5], [3, 2, 5]]",
            "s.toml:4: surroundings[0].vertices is 5 points in one plane; a hull has a volume",
        ),
        (
            "hull",
            "vertices = [[0, 0, 5], [1, 0, 5], [0, 1]]",
            "s.toml:4: surroundings[0].vertices[2] is an array of length 2; it must be three ",
        ),
        (
            "revolved",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nprofile = [[1, 0], [2, 1]]\ninside = true",
            "s.toml:7: surroundings[0].inside is true; closed = true belongs beside it",
        ),
        (
            "revolved",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nprofile = [[1, 0], [-2, 1]]",
            "s.toml:6: surroundings[0].profile is through [-2.0, 1.0]; a place is a distance from ",
        ),
        (
            "funnel",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nprofile = [[1, 0], [1, 0]]",
            "s.toml:6: surroundings[0].profile is twice at [1.0, 0.0]; each place must be ",
        ),
        (
            "revolved",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nclosed = true\n\
             profile = [[1, 0], [2, 1], [2, 0], [1, 1]]",
            "s.toml:7: surroundings[0].profile is one whose lines from [1.0, 0.0] to [2.0, 1.0] and \
             from [2.0, 0.0] to [1.0, 1.0] meet; ",
        ),
        (
            "tube",
            "axis = [0, 0, 1]\nheight = 2\nradius = 1",
            "s.toml:2: surroundings[0].base is missing; three numbers belong here",
        ),
        (
            "torus",
            "center = [0, 0, 5]\naxis = [0, 0, 1]\nmajor = 1\nminor = 1.5",
            "s.toml:7: surroundings[0].minor is 1.5; it must be less than major, 1.0",
        ),
        (
            "box",
            "lower = [0, 0, 5]\nupper = [1, 1, 6]\nrotation = { axis = [0, 0, 0], angle = 1 }",
            "s.toml:6: surroundings[0].rotation.axis is [0.0, 0.0, 0.0]; an axis must be finite ",
        ),
        (
            "box",
            "lower = [0, 0, 5]\nupper = [1, 1, 6]\nrotation = { axis = [0, 0, 1] }",
            "s.toml:6: surroundings[0].rotation.angle is missing; an angle in rad belongs here",
        ),
        (
            "box",
            "lower = [0, 0, 5]\nupper = [1, 1, 6]\nscale = -2",
            "s.toml:6: surroundings[0].scale is -2.0; a scale must be finite and greater than 0",
        ),
        (
            "box",
            "lower = [0, 0, 5]\nupper = [1, 1, 5]\ntranslation = [0, 0, 3]",
            "s.toml:4: surroundings[0].lower is [0.0, 0.0, 5.0]; every component must be below ",
        ),
        (
            "box",
            "lower = [0, 0, 5]\nupper = [1, 1, 6]\ntranslation = [0, 0, inf]",
            "s.toml:6: surroundings[0].translation is [0.0, 0.0, inf]; every component must be ",
        ),
        (
            "box",
            "lower = [0, 0, 5]\nupper = [2, 2, 7]\ntranslation = [-1, -1, -6]",
            "s.toml:7: spheres[0] puts body 0 inside of surroundings[0], which is solid, ",
        ),
        (
            "torus",
            "center = [0, 0, 0]\naxis = [0, 0, 1]\nmajor = 1\nminor = 0.5",
            "s.toml:8: spheres[0] puts body 0 inside of surroundings[0], which is solid, ",
        ),
    ];
    for (shape, keys, expected) in cases {
        assert_starts(&shape_message(shape, keys), expected);
    }
    // An endless one in a periodic box, and one that is too near its faces.
    let periodic = "periodic = { lower = [-9, -9, -9], upper = [9, 9, 9] }\n";
    let endless = "[[surroundings]]\nshape = \"cylinder\"\ncenter = [0, 0, 5]\naxis = [1, 0, 0]\n\
                   radius = 1\n";
    assert_starts(
        &message(&format!("{periodic}{endless}{BALL}")),
        "s.toml:3: surroundings[0] cannot ",
    );
    let near = format!("{periodic}{endless}height = 17\n{BALL}");
    assert_starts(&message(&near), "s.toml:3: surroundings[0] is too near to the faces ");
}

/// A step at whose end impacts are looked for must be shorter than what is thin can be jumped
/// through in.
#[test]
fn what_is_thin_is_not_jumped_through() {
    let scene = |keys: &str, shape: &str| {
        format!(
            "[stepped]\ndt = 0.5\n{keys}\n[[surroundings]]\n{shape}\n{BALL}velocity = [0, 0, -3]\n"
        )
    };
    let built = |keys: &str, shape: &str| {
        let scene = SceneFile::parse("s.toml", &scene(keys, shape)).unwrap().build::<f64>();
        scene.map(|_| ()).map_err(|error| error.to_string())
    };
    let disc = "shape = \"disc\"\ncenter = [0, 0, -5]\naxis = [0, 0, 1]\nradius = 2";
    let solid = "shape = \"sphere\"\ncenter = [0, 0, -5]\nradius = 2";
    assert_eq!(
        built("impact = \"end-of-step\"", disc).unwrap_err(),
        "s.toml:4: surroundings[0] cannot stand beside impact = \"end-of-step\": it is thin, and \
         body 0 flies 1.500 in a step, farther than its radius, 1.0, and could jump through it; \
         set impact = \"sub-step\", or dt to 3.3e-1 or less",
    );
    assert_eq!(built("impact = \"sub-step\"", disc), Ok(()));
    assert_eq!(built("impact = \"end-of-step\"", solid), Ok(()));
}

#[test]
fn shapes_that_cannot_be() {
    let shape = |keys: &str| message(&format!("[[surroundings]]\n{keys}\n{BALL}"));
    assert_starts(&shape("inside = true"), "s.toml:2: surroundings[0].shape is missing; it is ");
    assert_eq!(
        shape("shape = \"cube\""),
        "s.toml:3: surroundings[0].shape is `cube`; it must be one of `plane`, `box`, `sphere`, \
         `triangle`, `hull`, `mesh`, `heightfield`, `capsule`, `cylinder`, `capped-cylinder`, `cone`, `disc`, `annulus`, \
         `tube`, `torus`, `revolved`, `funnel`"
    );
    assert_starts(
        &shape("shape = 3"),
        "s.toml:3: surroundings[0].shape is integer `3`; it must be one of `plane`, `box`, ",
    );
    assert_eq!(
        shape("shape = \"plane\"\nhole = [0, 0, 1]"),
        "s.toml:4: surroundings[0].hole is not a key that means something here; known are \
         `shape`, `point`, `normal`, `lower`, `upper`, `vertices`, `triangles`, `origin`, `spacing`, `columns`, `rows`, `heights`, `file`, `range`, `a`, `b`, `apex`, `slope`, `inner`, `outer`, `base`, `half_height`, `height`, `radius`, `top_radius`, `major`, `minor`, `center`, `axis`, `profile`, `closed`, `inside`, `name`, `copies`, `sensor`, `removes`, `translation`, `rotation`, `scale`"
    );
    assert_eq!(
        shape("shape = \"sphere\"\ncenter = 3"),
        "s.toml:4: surroundings[0].center is integer `3`; \
         it must be three numbers, as in [0.0, 0.0, 1.0]"
    );
    assert_starts(&shape("inside = 1"), "s.toml:3: surroundings[0].inside is integer `1`; ");
    assert_eq!(
        message(&format!("surroundings = [3]\n{BALL}")),
        "s.toml:2: surroundings[0] is integer `3`; it must be a table with a shape"
    );
    assert_starts(
        &shape("shape = \"plane\"\npoint = [0, 0, -1]"),
        "s.toml:2: surroundings[0].normal is missing; three numbers ",
    );
    for normal in ["[0, 0, 0]", "[nan, 0, 1]", "[inf, 0, 0]"] {
        assert_starts(
            &shape(&format!("shape = \"plane\"\npoint = [0, 0, -1]\nnormal = {normal}")),
            "s.toml:5: surroundings[0].normal is no direction; ",
        );
    }
    assert_starts(
        &shape("shape = \"plane\"\npoint = [0, 0, -1]\nnormal = [0, 0, 1]\nradius = 1"),
        "s.toml:6: surroundings[0].radius cannot stand beside shape = \"plane\": ",
    );
    assert_starts(
        &shape("shape = \"box\"\nlower = [3, 3, 3]\nupper = [2, 4, 4]"),
        "s.toml:4: surroundings[0].lower is [3.0, 3.0, 3.0]; every component must be below ",
    );
    assert_starts(
        &shape("shape = \"sphere\"\ncenter = [3, 3, 3]\nradius = -1"),
        "s.toml:5: surroundings[0].radius is -1.0; ",
    );
    assert_starts(
        &shape("shape = \"sphere\"\ncenter = [3, 3, 3]"),
        "s.toml:2: surroundings[0].radius is missing; ",
    );
}

#[test]
fn entries_that_contradict_themselves() {
    assert_starts(&message("gravity = [0, 0, 1]"), "s.toml: the scene has no spheres; ");
    assert_starts(&message("[[spheres]]\nradius = 1"), "s.toml:2: spheres[0].position is missing");
    assert_starts(
        &message("[[spheres]]\nposition = [0, 0, 0]"),
        "s.toml:2: spheres[0].radius is missing; ",
    );
    assert_starts(&ball_message("count = 3"), "s.toml:5: spheres[0].count cannot stand beside ");
    assert_starts(&ball_message("temperature = 3"), "s.toml:5: spheres[0].temperature cannot ");
    assert_starts(
        &ball_message("mass = 1\ndensity = 1"),
        "s.toml:6: spheres[0].density cannot stand beside mass: ",
    );
    assert_starts(
        &group_message("count = 3\nradius = 1"),
        "s.toml:2: spheres[0].arrangement is missing; it is ",
    );
    assert_starts(
        &group_message("count = 3\nradius = 1\narrangement = \"random\""),
        "s.toml:2: spheres[0].lower is missing; nothing bounds these spheres: ",
    );
    let group = "count = 3\nradius = 1\narrangement = \"random\"\nlower = [0, 0, 0]\n";
    assert_starts(&group_message(group), "s.toml:2: spheres[0].upper is missing; ");
    assert_starts(
        &group_message(&format!("{group}upper = [0, 9, 9]")),
        "s.toml:6: spheres[0].lower is [0.0, 0.0, 0.0]; ",
    );
    let group = format!("{group}upper = [9, 9, 9]\n");
    assert_starts(
        &group_message(&format!("{group}number_density = 1")),
        "s.toml:8: spheres[0].number_density cannot stand beside open space: ",
    );
    for key in ["temperature", "spin_temperature"] {
        for bad in ["-1", "nan", "inf"] {
            assert_starts(
                &group_message(&format!("{group}{key} = {bad}")),
                &format!("s.toml:8: spheres[0].{key} is "),
            );
        }
    }
    assert_starts(
        &message("periodic = \"cube\"\n[[spheres]]\nposition = [0, 0, 0]\nradius = 1"),
        "s.toml:2: periodic is \"cube\"; one group of spheres has to size ",
    );
    let sized = "[[spheres]]\ncount = 4\narrangement = \"fcc\"\nradius = 0.1\nnumber_density = 1\n";
    assert_starts(
        &message(&format!("periodic = \"cube\"\n{sized}{sized}")),
        "s.toml:12: spheres[1].number_density cannot stand beside spheres[0].number_density: ",
    );
    assert_starts(
        &message(&format!("periodic = {{ lower = [0, 0, 0], upper = [9, 9, 9] }}\n{sized}")),
        "s.toml:7: spheres[0].number_density cannot stand beside the bounds of a periodic box: ",
    );
}

#[test]
fn counts_that_do_not_fit() {
    let group = |count: u64, arrangement: &str, radius: f64| {
        group_message(&format!(
            "count = {count}\narrangement = \"{arrangement}\"\nradius = {radius}\n\
             lower = [0, 0, 0]\nupper = [10, 10, 10]"
        ))
    };
    assert_starts(&group(0, "fcc", 0.5), "s.toml:3: spheres[0].count is 0; a count must be ");
    assert_starts(
        &group(100_000_001, "fcc", 1e-9),
        "s.toml:3: spheres[0].count is 100000001; a scene can have 100000000 spheres at most",
    );
    assert_starts(
        &group(u64::MAX / 2, "fcc", 1e-9),
        "s.toml:3: spheres[0].count is 9223372036854775807; a scene can have 100000000 ",
    );
    let no_room = |count, arrangement, radius| {
        let start = format!("s.toml:3: spheres[0].count is {count}, for which there is no room: ");
        assert_starts(&group(count, arrangement, radius), &start);
    };
    no_room(1, "random", 5.5);
    no_room(1, "cubic", 5.5);
    no_room(1_100, "cubic", 0.5);
    no_room(1_500, "fcc", 0.5);
    no_room(800, "random", 0.5);
    no_room(730, "random", 0.5);
    no_room(100_000_000, "random", 0.5);
    // A lattice finds room where a random order finds none.
    let lattice = "count = 1000\narrangement = \"cubic\"\nradius = 0.5\n\
                   lower = [0, 0, 0]\nupper = [10, 10, 10]";
    file(&format!("[[spheres]]\n{lattice}\n")).unwrap().build::<f32>().unwrap();
}

/// Whatever is cut out of a scene file, doubled or put in another's place:
/// there is a scene or a message, never a panic.
#[test]
fn mutilated_files_make_no_panic() {
    let mut state = 1_u64;
    let mut random = move |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let values = [
        "0",
        "-1",
        "nan",
        "inf",
        "1e300",
        "-1e300",
        "1e-300",
        "9223372036854775807",
        "[]",
        "{}",
        "[1, 2]",
        "[1, 2, 3]",
        "[nan, 0, 0]",
        "[1e300, -1e300, 0]",
        "\"cube\"",
        "\"random\"",
        "true",
        "0.1",
        "1979-05-27",
        "[[1, 2, 3]]",
        "[0.001, 0.002]",
        "\"plane\"",
    ];
    let words: Vec<&str> = builtin_scenes()
        .iter()
        .flat_map(|scene| scene.text.lines())
        .filter(|line| !line.starts_with('#'))
        .collect();
    let mut built = 0;
    for _ in 0..5_000 {
        let scene = &builtin_scenes()[random(builtin_scenes().len())];
        // Small enough to build quickly.
        let text = scene.text.replace("000\n", "\n").replace("10976", "108");
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for _ in 0..=random(3) {
            let at = random(lines.len());
            match random(5) {
                0 => drop(lines.remove(at)),
                1 => lines.insert(at, words[random(words.len())].to_owned()),
                2 => {
                    if let Some((key, _)) = lines[at].clone().split_once('=') {
                        lines[at] = format!("{key}= {}", values[random(values.len())]);
                    }
                }
                3 => {
                    let line = lines[at].clone();
                    lines.insert(at, line);
                }
                _ => {
                    let cut = random(lines[at].len() + 1);
                    lines[at] = lines[at].chars().take(cut).collect();
                }
            }
            if lines.is_empty() {
                lines.push(String::new());
            }
        }
        let text = lines.join("\n");
        let error = match SceneFile::parse("mutilated", &text) {
            Err(error) => Some(error),
            Ok(file) if random(2) == 0 => file.build::<f32>().err(),
            Ok(file) => file.build::<f64>().err(),
        };
        match error {
            None => built += 1,
            Some(error) => assert!(!error.to_string().is_empty() && !text.is_empty()),
        }
    }
    assert!(built > 500);
}
