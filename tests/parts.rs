//! What each part of the surroundings does: counted by both engines, in every order and on
//! any number of threads, as their events say.

use carom::engine::{Execution, Lanes, Order, PartTotals, Partner, World};
use carom::scene::{EngineKind, Scene, SceneFile, Sphere};
use carom::state_hash;
use carom::surroundings::{
    Capsule, Cone, Copies, Cuboid, Cylinder, Disc, FixedSphere, Hull, Plane, Revolved, Shape,
    Torus, Triangle, Tube,
};

/// Balls in a container with a funnel, and a plate that none comes to.
const VESSEL: &str = r#"
duration = 4.0
gravity = [0.0, 0.0, -2.0]
stepped = { dt = 0.01 }
surface = { kind = "rough" }
surroundings = [
  { shape = "box", lower = [-4, -4, -4], upper = [4, 4, 4], inside = true },
  { shape = "funnel", name = "funnel", center = [0, 0, 0], axis = [0, 0, 1], profile = [[0.5, -1], [3, 1]] },
  { shape = "disc", center = [9, 0, 0], axis = [0, 0, 1], radius = 1 },
]
[[spheres]]
count = 40
arrangement = "random"
radius = [0.2, 0.3]
temperature = 2.0
"#;

fn vessel(engine: EngineKind) -> Scene<f64> {
    let mut scene = SceneFile::parse("vessel.toml", VESSEL).unwrap().build().unwrap();
    scene.engine = engine;
    scene
}

fn parts_of(scene: &Scene<f64>, execution: Execution) -> Vec<PartTotals> {
    let mut world = World::new(scene.clone(), execution).unwrap();
    world.advance(4.0).unwrap();
    let parts = world.parts();
    let count: u64 = parts.iter().map(|part| part.collisions).sum();
    assert_eq!(count, world.collisions().surroundings);
    parts
}

#[test]
fn the_events_of_a_part_add_up_to_its_totals() {
    for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
        let scene = vessel(engine);
        let mut world = World::new(scene.clone(), Execution::new().threads(1)).unwrap();
        let mut counted = [(0, [0.0; 3]); 3];
        world
            .for_each_event(4.0, |event| {
                if let Partner::Surroundings(part) = event.partner {
                    let (count, sum) = &mut counted[part as usize];
                    *count += 1;
                    let impulse = event.normal * event.normal_impulse + event.tangential_impulse;
                    for (sum, j) in sum.iter_mut().zip(impulse.to_array()) {
                        *sum += j;
                    }
                }
            })
            .unwrap();
        let parts = world.parts();
        assert_eq!(parts.len(), 3);
        for (part, (count, sum)) in parts.iter().zip(counted) {
            assert_eq!(part.collisions, count, "{engine:?} {part:?}");
            for (j, sum) in part.impulse.iter().zip(sum) {
                assert!((j - sum).abs() < 1e-10 * (1.0 + sum.abs()), "{engine:?}: {part:?} {sum}");
            }
        }
        assert!(parts[0].collisions > 50 && parts[1].collisions > 20, "{parts:?}");
        assert_eq!((parts[2].part, parts[2].collisions, parts[2].impulse), (2, 0, [0.0; 3]));
    }
}

#[test]
fn parts_are_counted_alike_in_every_order() {
    let plain = Execution::new().threads(1).lanes(Lanes::Scalar);
    for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
        let scene = vessel(engine);
        let expected = parts_of(&scene, plain);
        for execution in [
            plain.lanes(Lanes::Auto),
            plain.threads(3),
            plain.order(Order::Windows),
            plain.order(Order::Windows).threads(3),
        ] {
            assert_eq!(parts_of(&scene, execution), expected, "{engine:?} {execution:?}");
        }
    }
}

#[test]
fn of_many_parts_those_with_names_are_counted() {
    let ball = |x: f64| Sphere::new([x, 0.0, 2.0]).radius(0.25).velocity([0.0, 0.0, -1.0]);
    let mut scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(70.0));
    for k in 0..100 {
        let place = [f64::from(k), 0.0, 0.0];
        let post = FixedSphere::solid(place, 0.25);
        scene = match k {
            70 => scene.named_surroundings("post", post),
            _ => scene.surroundings(post),
        };
    }
    scene = scene.named_surroundings("wall", Plane::new([0.0, 5.0, 0.0], [0.0, -1.0, 0.0]));
    let mut world =
        World::new(scene.engine(EngineKind::EventDriven).build().unwrap(), Execution::default())
            .unwrap();
    world.advance(3.0).unwrap();
    assert_eq!(world.collisions().surroundings, 2);
    let parts: Vec<_> = world.parts().iter().map(|part| (part.part, part.collisions)).collect();
    assert_eq!(parts, [(70, 1), (100, 0)]);
    // The others count for the whole.
    let mass = 1.0;
    assert_eq!(world.impulse_from_surroundings(), [0.0, 0.0, 4.0 * mass]);
}

/// What had added up before a change of the world goes on.
#[test]
fn a_change_of_the_world_lets_parts_go_on() {
    let ball = Sphere::new([0.0, 0.0, 0.0]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    let tube = Cylinder::container([0.0; 3], [0.0, 0.0, 1.0], 1.5, None);
    let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).surroundings(tube);
    let mut world = World::new(scene.sphere(ball).build().unwrap(), Execution::default()).unwrap();
    world.advance(1.5).unwrap();
    let mut change = world.change();
    change.set_velocity(0, [-2.0, 0.0, 0.0]);
    change.apply().unwrap();
    world.advance(1.0).unwrap();
    let [tube] = world.parts()[..] else { panic!("{:?}", world.parts()) };
    assert_eq!((tube.collisions, tube.impulse), (2, [2.0, 0.0, 0.0]));
}

#[test]
fn names_that_cannot_be() {
    let message = |names: [&str; 2]| {
        let plane = "[[surroundings]]\nshape = \"plane\"\npoint = [0, 0, -1]\nnormal = [0, 0, 1]\n";
        let [a, b] = names.map(|name| format!("{plane}name = \"{name}\"\n"));
        let text = format!("{a}{b}[[spheres]]\nposition = [0, 0, 0]\nradius = 0.5\n");
        let built = SceneFile::parse("s.toml", &text).unwrap().build::<f64>();
        built.map_or_else(|error| error.to_string(), |scene| format!("{:?}", scene.part_names))
    };
    assert_eq!(message(["floor", "wall"]), r#"[Some("floor"), Some("wall")]"#);
    assert_eq!(
        message(["floor", "floor"]),
        "s.toml:10: surroundings[1].name is \"floor\"; surroundings[0] is called so already"
    );
    assert_eq!(
        message(["floor", ""]),
        "s.toml:10: surroundings[1].name is \"\"; a name has letters, and no line breaks or other \
         control characters"
    );
}

/// For balls that do not meet each other in a sphere, `Σ|J_n| (R − r) = 2 E t` in the mean: the
/// theorem of the virial.
#[test]
fn the_pressure_in_a_sphere_is_that_of_the_virial() {
    let text = r#"
        encounters = "surroundings"
        stepped = { dt = 0.01 }
        [[surroundings]]
        shape = "sphere"
        name = "vessel"
        center = [0, 0, 0]
        radius = 2
        inside = true
        [[spheres]]
        count = 200
        arrangement = "random"
        radius = 0.25
        temperature = 1.0
    "#;
    let mut scene = SceneFile::parse("vessel.toml", text).unwrap().build::<f64>().unwrap();
    for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
        scene.engine = engine;
        let mut world = World::new(scene.clone(), Execution::default()).unwrap();
        let duration = 50.0;
        world.advance(duration).unwrap();
        let [vessel] = world.parts()[..] else { panic!("{:?}", world.parts()) };
        let expected = 2.0 * world.energy().translational * duration / 1.75;
        let error = (vessel.normal_impulse / expected - 1.0).abs();
        assert!(error < 0.01, "{engine:?}: {} for {expected}", vessel.normal_impulse);
        assert_eq!(vessel.area, Some(16.0 * core::f64::consts::PI));
    }
}

#[test]
fn areas_are_those_of_the_surfaces() {
    let pi = core::f64::consts::PI;
    let (origin, up) = ([0.0; 3], [0.0, 0.0, 1.0]);
    let corner = |k: usize| core::array::from_fn(|axis| f64::from((k >> axis & 1) as u32));
    let can = [[0.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 3.0]];
    let areas: [(Shape<f64>, f64); 13] = [
        (Cuboid::container([0.0; 3], [1.0, 2.0, 3.0]).into(), 22.0),
        (Hull::new((0..8).map(corner).chain([[0.5; 3]])).into(), 6.0),
        (FixedSphere::solid(origin, 2.0).into(), 16.0 * pi),
        (Capsule::solid(origin, [0.0, 0.0, 3.0], 2.0).into(), 28.0 * pi),
        (Cylinder::solid(origin, up, 2.0, Some(3.0)).into(), 20.0 * pi),
        (Revolved::solid(origin, up, can).into(), 20.0 * pi),
        (Cone::solid(origin, up, 4.0, [3.0, 0.0]).into(), 24.0 * pi),
        (Disc::new(origin, up, 2.0, 1.0).into(), 6.0 * pi),
        (Tube::new(origin, up, 4.0, [3.0, 0.0]).into(), 30.0 * pi),
        (Revolved::thin(origin, up, [[0.0, 4.0], [3.0, 0.0]]).into(), 30.0 * pi),
        (Torus::solid(origin, up, 3.0, 1.0).into(), 12.0 * pi * pi),
        (Triangle::new(origin, [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]).into(), 12.0),
        (Shape::from(FixedSphere::solid(origin, 1.0)).scaled(3.0), 36.0 * pi),
    ];
    for (shape, area) in areas {
        let found = shape.area().unwrap();
        assert!((found / area - 1.0).abs() < 1e-14, "{found} for {area}: {shape:?}");
    }
    assert_eq!(Shape::from(Cylinder::solid(origin, up, 1.0, None)).area(), None);
    assert_eq!(Shape::from(Cone::endless_solid(origin, up, 1.0)).area(), None);
}

/// Copies are the same shapes, one by one, as entries of their own: event by event, and step
/// by step.
#[test]
fn copies_are_as_shapes_of_their_own() {
    let before = "gravity = [0, 0, -2]\nstepped = { dt = 0.01 }\n[[spheres]]\ncount = 60\n\
                  arrangement = \"random\"\nradius = 0.2\ntemperature = 2\nlower = [-4, -4, 2]\n\
                  upper = [4, 4, 4]\n[[surroundings]]\nshape = \"box\"\ninside = true\n\
                  lower = [-4, -4, -4]\nupper = [4, 4, 4]\n";
    let pin = |center: [f64; 3]| {
        format!(
            "[[surroundings]]\nshape = \"capped-cylinder\"\naxis = [0, 1, 0]\nradius = 0.25\n\
             half_height = 1\ncenter = {center:?}\n"
        )
    };
    let rows =
        "copies = [{ count = 4, step = [1.5, 0, 0] }, { count = 3, step = [0.25, 0, -1] }]\n";
    let together = format!("{before}{}name = \"pins\"\n{rows}", pin([-3.0, 0.5, 0.0]));
    let mut alone = before.to_owned();
    for (row, k) in (0..3).flat_map(|row| (0..4).map(move |k| (f64::from(row), f64::from(k)))) {
        alone += &pin([-3.0 + 1.5 * k + 0.25 * row, 0.5, -row]);
    }
    for everyone in ["", "encounters = \"surroundings\"\n"] {
        for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
            let come_to = |text: &str| {
                let text = format!("{everyone}{text}");
                let mut scene: Scene<f64> =
                    SceneFile::parse("pins.toml", &text).unwrap().build().unwrap();
                scene.engine = engine;
                let mut world = World::new(scene, Execution::new()).unwrap();
                world.advance(8.0).unwrap();
                let parts = world.parts();
                let pins = parts.iter().filter(|part| part.part > 0);
                (state_hash(&world.bodies()), pins.map(|part| part.collisions).sum::<u64>())
            };
            let (hash, collisions) = come_to(&together);
            assert_eq!((hash, collisions), come_to(&alone), "{engine:?} {everyone}");
            assert!(collisions > 50, "{collisions}");
        }
    }
}

/// A crowd in a corner of a field of obstacles has cells that fold: obstacles are found by a
/// tree, in both orders of time.
#[test]
fn a_crowd_in_a_corner_finds_all_obstacles() {
    let lattice = Copies::new(FixedSphere::solid([0.0; 3], 0.4));
    let lattice = lattice.along([2.0, 0.0, 0.0], 20).along([0.0, 2.0, 0.0], 20);
    let lattice = lattice.along([0.0, 0.0, 2.0], 20);
    let mut scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).surroundings(lattice);
    for k in 0..400 {
        let place = [k % 8, k / 8 % 8, k / 64].map(|k| 0.6 + 0.11 * f64::from(k));
        let velocity = place.map(|c: f64| 10.0 * (c - 0.99).sin());
        scene = scene.sphere(Sphere::new(place).radius(0.05).velocity(velocity));
    }
    let scene = scene.build().unwrap();
    // How far a coordinate is from the nearest centre.
    let off = |c: f64| (c - 2.0 * (c / 2.0).round().clamp(0.0, 19.0)).powi(2);
    let come_to = |order: Order| {
        let execution = Execution::new().threads(1).order(order);
        let mut world = World::new(scene.clone(), execution).unwrap();
        let mut events = Vec::new();
        for _ in 0..60 {
            world.for_each_event(0.1, |event| events.push((event.time, event.a))).unwrap();
            let bodies = world.bodies();
            for body in 0..bodies.len() {
                let [x, y, z] = bodies.position_of(body).to_array().map(off);
                assert!((x + y + z).sqrt() > 0.45 - 1e-12, "{body} is in an obstacle");
            }
        }
        assert!(world.collisions().surroundings > 200, "{:?}", world.collisions());
        events
    };
    assert!(come_to(Order::Strict) == come_to(Order::Windows));
}
