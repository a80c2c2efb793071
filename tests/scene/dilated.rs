//! Scenes made larger and smaller.

use carom::observe::state_hash;
use carom::scene::{Scene, SceneFile, builtin_scenes};
use carom::surroundings::Shape;

use crate::{BALL, assert_starts, file};

fn builtin(name: &str) -> SceneFile {
    SceneFile::builtin(name).unwrap()
}

/// The volume of the first container.
fn volume(scene: &Scene<f64>) -> f64 {
    match &scene.surroundings[0] {
        Shape::Cuboid(cuboid) => (cuboid.upper - cuboid.lower).to_array().iter().product(),
        Shape::FixedSphere(sphere) => sphere.radius.powi(3),
        shape => panic!("{shape:?} has no volume"),
    }
}

/// Building checks that no bodies overlap each other or the walls.
#[test]
fn the_density_stays() {
    for name in ["rough-gas", "mixture"] {
        let dense = |scene: &Scene<f64>| scene.bodies.len() as f64 / volume(scene);
        let before = builtin(name).build().unwrap();
        for bodies in [50, 1_000, 30_000] {
            let scene = builtin(name).with_bodies(bodies).unwrap().build().unwrap();
            assert_eq!(scene.bodies.len() as u64, bodies);
            assert!((dense(&scene) / dense(&before) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn as_many_as_before_is_the_same_scene() {
    for scene in builtin_scenes() {
        let before = builtin(scene.name).build::<f64>().unwrap();
        let Ok(same) = builtin(scene.name).with_bodies(before.bodies.len() as u64) else {
            // Single bodies only.
            assert!(before.bodies.len() < 100);
            continue;
        };
        let after = same.build::<f64>().unwrap();
        assert_eq!(state_hash(&after.bodies), state_hash(&before.bodies));
        assert_eq!(after.surroundings, before.surroundings);
    }
}

#[test]
fn full_lattices_stay_full() {
    let fluid = |bodies| {
        let scene = builtin("hard-sphere-fluid").with_bodies(bodies).unwrap();
        let scene = scene.build::<f64>().unwrap();
        let bounds = scene.periodic.unwrap();
        let side = bounds.upper.x - bounds.lower.x;
        assert!((scene.bodies.len() as f64 / side.powi(3) - 0.5).abs() < 1e-12);
        scene.bodies.len()
    };
    assert_eq!([1, 1_000, 10_000, 100_000].map(fluid), [4, 864, 10_976, 97_556]);
    let cubic = "[[spheres]]\ncount = 27\narrangement = \"cubic\"\nradius = 0.4\n\
                 lower = [0, 0, 0]\nupper = [3, 3, 3]\n";
    let scene = file(cubic).unwrap().with_bodies(1_100).unwrap().build::<f64>().unwrap();
    assert_eq!(scene.bodies.len(), 1_000);
    let last = scene.bodies.position_of(999).to_array();
    assert!(last.iter().all(|c| (c - 9.5).abs() < 1e-12), "{last:?}");
}

#[test]
fn places_are_dilated_and_radii_stay() {
    let text = "[[surroundings]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 8\ninside = true\n\
                [[surroundings]]\nshape = \"sphere\"\ncenter = [1, 0, 0]\nradius = 0.5\n\
                [[surroundings]]\nshape = \"plane\"\npoint = [0, 0, -7]\nnormal = [0, 0, 2]\n\
                [[spheres]]\nposition = [-3, 0, 0]\nradius = 0.5\n\
                [[spheres]]\ncount = 9\narrangement = \"random\"\nradius = 0.1\n\
                lower = [2, -3, -3]\nupper = [4, 3, 3]\n";
    // Eight times the group, and the single one.
    let scene = file(text).unwrap().with_bodies(73).unwrap().build::<f64>().unwrap();
    assert_eq!(scene.bodies.len(), 73);
    let [Shape::FixedSphere(container), Shape::FixedSphere(ball), Shape::Plane(plane)] =
        scene.surroundings[..]
    else {
        panic!("{:?}", scene.surroundings);
    };
    assert_eq!((container.radius, ball.center.x, ball.radius), (16.0, 2.0, 0.5));
    assert_eq!(plane.point.z, -14.0);
    assert_eq!(scene.bodies.position_of(0).to_array(), [-6.0, 0.0, 0.0]);
    assert_eq!((scene.bodies.radius.of(0), scene.bodies.radius.of(1)), (0.5, 0.1));
    let furthest = (1..73).map(|k| scene.bodies.position_of(k).x).fold(0.0, f64::max);
    assert!(furthest > 7.0 && furthest < 7.9, "{furthest}");
}

#[test]
fn errors_name_what_is_wrong() {
    let refused = |file: &SceneFile, bodies| match file.with_bodies(bodies) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{bodies} bodies are taken"),
    };
    let single = file(BALL).unwrap();
    let no_group = "s.toml:2: spheres cannot number 10: there is no group";
    assert_starts(&refused(&single, 10), no_group);
    let group = format!("{BALL}[[spheres]]\ncount = 9\narrangement = \"random\"\nradius = 0.1\n");
    let group = file(&group).unwrap();
    let too_few = "s.toml:2: spheres cannot number 1: more are needed than the 1 with a `position`";
    assert_starts(&refused(&group, 1), too_few);
    assert_starts(&refused(&group, 0), "s.toml:2: spheres cannot number 0");
    let too_many = "s.toml:2: spheres cannot number 1000000000000: a scene has 100000000";
    assert_starts(&refused(&group, 1_000_000_000_000), too_many);

    // A container that is smaller than what it is to hold.
    let gas = builtin("mixture").with_bodies(1).unwrap();
    let error = gas.build::<f64>().unwrap_err().to_string();
    assert_starts(&error, "mixture:");
}
