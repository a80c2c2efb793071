//! What scene files and builders make.

use carom::bodies::{Bodies, PerBody};
use carom::contact::Surface;
use carom::engine::Stepped;
use carom::motion::Integrator;
use carom::scene::{
    DEFAULT_SCENE, Encounters, Precision, Scene, SceneFile, Sphere, Spheres, builtin_scenes,
};
use carom::scene::{EngineKind, Impact, OrientationUpdate};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, FixedSphere, Plane, Shape};

use crate::assert_starts;

#[test]
fn every_key_of_the_contract_is_understood() {
    let text = r#"
precision = "f32"
engine = "stepped"
duration = 10
gravity = [0, 0.0, -9.81]
seed = 7
encounters = "surroundings"

[stepped]
dt = 1e-3
integrator = "velocity-verlet"
impact = "sub-step"
orientation = "each-step"

[surface]
kind = "rough"

[[surroundings]]
shape = "plane"
point = [0.0, 0.0, -5.0]
normal = [0.0, 0.0, 2.0]

[[surroundings]]
shape = "box"
lower = [-5.0, -5.0, -5.0]
upper = [5.0, 5.0, 10.0]
inside = true

[[surroundings]]
shape = "sphere"
center = [0.0, 0.0, 8.0]
radius = 1.0

[[spheres]]
position = [0.0, 0.0, 1.0]
velocity = [1.0, 0.0, 0.0]
spin = [0.0, 3.0, 0.0]
radius = 0.5
mass = 2.0
inertia_factor = 0.5

[[spheres]]
count = 8
arrangement = "cubic"
lower = [-5.0, -5.0, -5.0]
upper = [5.0, 5.0, 5.0]
radius = 0.5
density = 1.0
velocity = [0.0, 0.0, 1.0]
"#;
    let file = SceneFile::parse("all", text).unwrap();
    assert_eq!(file.precision, Precision::F32);
    assert_eq!((file.seed, file.dt, file.run_duration().unwrap()), (7, Some(1e-3), 10.0));
    let scene = file.build::<f32>().unwrap();
    assert_eq!(scene.engine, EngineKind::Stepped);
    assert_eq!(scene.duration, Some(10.0));
    assert_eq!(scene.gravity.to_array(), [0.0, 0.0, -9.81]);
    assert_eq!(scene.surface, Surface::Rough);
    assert_eq!(scene.encounters, Encounters::Surroundings);
    assert_eq!(scene.stepped.integrator, Integrator::VelocityVerlet);
    assert_eq!(scene.stepped.impact, Impact::SubStep);
    assert_eq!(scene.stepped.orientation, OrientationUpdate::EachStep);
    assert_eq!(
        scene.surroundings,
        [
            Shape::from(Plane::new([0.0, 0.0, -5.0], [0.0, 0.0, 1.0])),
            Cuboid::container([-5.0; 3], [5.0, 5.0, 10.0]).into(),
            FixedSphere::solid([0.0, 0.0, 8.0], 1.0).into(),
        ]
    );
    let bodies = &scene.bodies;
    assert_eq!(bodies.len(), 9);
    assert_eq!(bodies.spin_of(0).to_array(), [0.0, 3.0, 0.0]);
    assert_eq!((bodies.mass.of(0), bodies.inertia.of(0)), (2.0, 0.25));
    assert!(matches!(bodies.radius, PerBody::Same(0.5)));
    assert!((bodies.mass.of(8) - core::f32::consts::FRAC_PI_6).abs() < 1e-6);
    assert_eq!(bodies.position_of(1).to_array(), [-2.5, -2.5, -2.5]);
    assert_eq!(bodies.position_of(8).to_array(), [2.5, 2.5, 2.5]);
    assert_eq!(bodies.velocity_of(8).to_array(), [0.0, 0.0, 1.0]);
}

#[test]
fn number_density_sizes_a_periodic_cube() {
    let text = "periodic = \"cube\"\n[[spheres]]\ncount = 10976\narrangement = \"fcc\"\n\
                number_density = 0.5\nradius = 0.5\ntemperature = 1.0\n";
    let scene = SceneFile::parse("s", &format!("stepped.dt = 1e-3\n{text}"))
        .and_then(|file| file.build::<f64>())
        .unwrap();
    let sides = scene.periodic.unwrap().sides().to_array();
    for side in sides {
        assert!((side - 28.0).abs() < 1e-12);
    }
}

#[test]
fn builtin_scenes_build_in_both_precisions() {
    assert!(builtin_scenes().iter().any(|scene| scene.name == DEFAULT_SCENE));
    for builtin in builtin_scenes() {
        assert!(!builtin.summary.contains('\n') && builtin.summary.len() < 80);
        SceneFile::parse(builtin.name, builtin.text).unwrap();
        let file = SceneFile::builtin(builtin.name).unwrap();
        let double = file.build::<f64>().unwrap();
        let single = file.build::<f32>().unwrap();
        assert_eq!(double.name, builtin.name);
        let steps = file.run_duration().unwrap() / file.dt.unwrap();
        assert!((steps - steps.round()).abs() < 1e-3 * steps.max(1.0).log10(), "{steps}");
        // One scene, rounded.
        for index in 0..double.bodies.len() {
            let rounded = double.bodies.position_of(index).to_array().map(|c| c as f32);
            assert_eq!(single.bodies.position_of(index).to_array(), rounded);
            let rounded = double.bodies.velocity_of(index).to_array().map(|c| c as f32);
            assert_eq!(single.bodies.velocity_of(index).to_array(), rounded);
        }
    }
    assert!(SceneFile::builtin("no-such-scene").is_none());
}

#[test]
fn temperatures_give_maxwell_distributions_without_momentum() {
    let scene = Scene::<f64>::builder()
        .periodic(PeriodicBox::new([0.0; 3], [100.0; 3]))
        .spheres(
            Spheres::cubic(40_000)
                .radius(0.5)
                .mass(1.0..=10.0)
                .temperature(2.0)
                .spin_temperature(3.0)
                .velocity([0.0, 0.0, 5.0]),
        )
        .dt(1e-3)
        .build()
        .unwrap();
    let bodies = &scene.bodies;
    let mut momentum = [0.0; 3];
    let [mut total, mut flight, mut spin] = [0.0; 3];
    for index in 0..bodies.len() {
        let mass = bodies.mass.of(index);
        assert!((1.0..=10.0).contains(&mass));
        total += mass;
        let mut velocity = bodies.velocity_of(index).to_array();
        velocity[2] -= 5.0;
        for axis in 0..3 {
            momentum[axis] += mass * velocity[axis];
            flight += mass * velocity[axis] * velocity[axis];
        }
        let inertia = bodies.inertia.of(index);
        assert!((inertia - 0.4 * mass * 0.25).abs() < 1e-15);
        spin += inertia * bodies.spin_of(index).length_squared();
    }
    for component in momentum {
        assert!(component.abs() < 1e-12 * total);
    }
    // Four standard errors of 120,000 degrees of freedom.
    let degrees = 3.0 * bodies.len() as f64;
    assert!((flight / degrees / 2.0 - 1.0).abs() < 4.0 * (2.0 / degrees).sqrt());
    assert!((spin / degrees / 3.0 - 1.0).abs() < 4.0 * (2.0 / degrees).sqrt());
}

#[test]
fn seeds_decide() {
    let places = |seed| {
        let mut file = SceneFile::builtin("mixture").unwrap();
        file.seed = seed;
        let bodies = file.build::<f64>().unwrap().bodies;
        (bodies.position_of(17).to_array(), bodies.spin_of(17).to_array())
    };
    assert_eq!(places(1), places(1));
    assert_ne!(places(1).0, places(2).0);
    assert_ne!(places(1).1, places(2).1);
}

/// What a seed makes is the same on every machine and in every build, and in
/// every version to come.
#[test]
fn what_a_seed_makes_is_fixed() {
    let bodies = SceneFile::builtin("mixture").unwrap().build::<f64>().unwrap().bodies;
    let mut hash = 0_u64;
    let figures = [&bodies.radius, &bodies.mass, &bodies.inertia];
    for index in 0..bodies.len() {
        let vectors = [bodies.position_of(index), bodies.velocity_of(index), bodies.spin_of(index)];
        let vectors = vectors.into_iter().flat_map(|vector| vector.to_array());
        for value in vectors.chain(figures.map(|figure| figure.of(index))) {
            hash = (hash.rotate_left(5) ^ value.to_bits()).wrapping_mul(0x517c_c1b7_2722_0a95);
        }
    }
    assert_eq!(hash, 0xb2ed_b7e8_b06f_9a7b, "{hash:#x}");
}

#[test]
fn random_groups_find_places_among_all_others() {
    let scene = Scene::<f64>::builder()
        .surroundings(FixedSphere::container([0.0; 3], 5.0))
        .surroundings(FixedSphere::solid([0.0; 3], 1.0))
        .spheres(Spheres::random(200).radius(0.1..=0.5))
        .sphere(Sphere::new([3.0, 0.0, 0.0]).radius(1.0))
        .dt(1e-3)
        .build()
        .unwrap();
    assert_eq!(scene.bodies.radius.of(200), 1.0);
    // The largest first.
    let radii: Vec<f64> = (0..200).map(|index| scene.bodies.radius.of(index)).collect();
    assert!(radii.is_sorted_by(|a, b| a >= b) && radii[0] > 0.45 && radii[199] < 0.15);
}

#[test]
fn ready_bodies_are_taken_as_they_are() {
    let scene = Scene::<f32>::builder()
        .spheres(Spheres::fcc(20).radius(0.5).within([0.0; 3], [10.0; 3]))
        .dt(1e-3)
        .build()
        .unwrap();
    let bodies = scene.bodies.clone();
    let again = Scene::builder().bodies(bodies.clone()).dt(1e-3).build().unwrap();
    assert_eq!(again.bodies.position_of(19), bodies.position_of(19));
    let both = Scene::builder()
        .sphere(Sphere::new([-5.0; 3]).radius(0.25))
        .bodies(bodies.clone())
        .dt(1e-3)
        .build()
        .unwrap();
    assert_eq!(both.bodies.len(), 21);
    assert_eq!(both.bodies.position_of(20), bodies.position_of(19));
    assert_eq!((both.bodies.radius.of(0), both.bodies.radius.of(20)), (0.25, 0.5));

    let mut short = bodies.clone();
    short.spin[1] = carom::column::Column::new(3, 0.0);
    let error = Scene::builder().bodies(short).dt(1e-3).build().unwrap_err();
    assert_starts(&error.to_string(), "scene: spheres[0].spin is 3 long; ");
    let mut heap: Bodies<f32> = bodies;
    heap.position[0].fill(1.0);
    heap.position[1].fill(f32::NAN);
    let error = Scene::builder().bodies(heap).dt(1e-3).build().unwrap_err();
    assert_starts(
        &error.to_string(),
        "scene: spheres[0] is such that the position of body 0 is not finite",
    );
}

#[test]
fn touching_is_no_overlap_in_either_precision() {
    // None of these numbers is exact in binary.
    for shift in [0.0, 0.3, 1000.7, 123_456.7] {
        let mut builder32 = Scene::<f32>::builder().dt(1e-3);
        let mut builder64 = Scene::<f64>::builder().dt(1e-3);
        for k in 0..20 {
            let x = shift + 0.2 * f64::from(k);
            builder32 = builder32.sphere(Sphere::new([x, shift, 0.1]).radius(0.1));
            builder64 = builder64.sphere(Sphere::new([x, shift, 0.1]).radius(0.1));
        }
        builder64 = builder64.surroundings(Plane::new([0.0; 3], [0.0, 0.0, 1.0]));
        builder64.build().unwrap();
        // Where an f32 has no digits left for the radius, they overlap in fact.
        let built = builder32.surroundings(Plane::new([0.0; 3], [0.0, 0.0, 1.0])).build();
        assert_eq!(built.is_ok(), shift < 1e5, "{shift}");
    }
}

/// A fast ball half in a wall after one long step, and another body far away.
fn left_in_a_wall() -> (Scene<f64>, Bodies<f64>) {
    let scene = Scene::<f64>::builder()
        .surroundings(Cuboid::container([0.0; 3], [4.0; 3]))
        .impact(Impact::EndOfStep)
        .dt(0.5)
        .sphere(Sphere::new([2.0, 1.0, 1.0]).radius(0.5).velocity([3.5, 0.0, 0.0]))
        .sphere(Sphere::new([1.0, 3.0, 3.0]).radius(0.5))
        .build()
        .unwrap();
    let mut world = Stepped::new(scene.clone()).unwrap();
    world.step();
    (scene, world.bodies())
}

#[test]
fn what_a_world_leaves_is_a_scene_unless_it_is_written_to() {
    let (scene, left) = left_in_a_wall();
    assert_eq!(left.position_of(0).x, 3.75);
    let again = scene.with_bodies(left.clone()).unwrap();
    assert_eq!(again.bodies, left);
    assert_eq!((again.stepped, again.engine), (scene.stepped, scene.engine));
    // Beside others, which are checked against it and against what is fixed.
    let beside = |x: f64| {
        let ball = Sphere::new([x, 1.0, 1.0]).radius(0.5);
        let walls = Cuboid::container([0.0; 3], [4.0; 3]);
        let scene = Scene::<f64>::builder().surroundings(walls).bodies(left.clone());
        scene.sphere(ball).build().map(|scene| scene.bodies.len())
    };
    assert_eq!(beside(2.75).unwrap(), 3);
    assert!(beside(2.85).unwrap_err().to_string().contains("spheres[1] puts body 2 into body 0"));
    assert!(beside(0.4).unwrap_err().to_string().contains("outside of its container"));
    // A state that is written to may be as deep as a tenth and two steps: all of this one.
    let mut moved = left.clone();
    moved.velocity[0].fill(0.0);
    moved.position[1][1] = 2.9;
    let error = scene.with_bodies(moved).unwrap_err().to_string();
    assert!(error.contains("outside of its container"), "{error}");
}
