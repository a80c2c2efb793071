//! Sensors: they count what passes, in both engines, on every path, and change nothing.

use carom::bodies::Bodies;
use carom::engine::{Compiled, Execution, Lanes, Order, World};
use carom::scene::{Encounters, EngineKind, Scene, SceneFile, Sphere};
use carom::state_hash;
use carom::surroundings::{
    Capsule, Cone, Cuboid, Cylinder, Disc, Feature, FixedSphere, Passages, Plane, Revolved, Sensor,
    Shape, Torus, Triangle,
};

const ENGINES: [EngineKind; 2] = [EngineKind::EventDriven, EngineKind::Stepped];
const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn passed<T: Compiled>(world: &World<T>) -> Vec<Passages> {
    world.parts().iter().filter_map(|part| part.passages).collect()
}

fn counts(passages: Passages) -> [u64; 2] {
    [passages.inward, passages.outward]
}

/// A ball goes to and fro between two walls, 8 apart for its centre, at a speed of 1.
fn shuttle<T: Compiled>(engine: EngineKind, sensor: Shape<f64>) -> World<T> {
    let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([0.0, 0.0, 1.0]);
    let walls = Shape::from(Cuboid::container([-4.5; 3], [4.5; 3])).cast::<T>();
    let sensor = Shape::from(Sensor::new(sensor)).cast::<T>();
    let scene = Scene::<T>::builder().dt(0.0625).engine(engine);
    let scene = scene.surroundings(walls).surroundings(sensor).sphere(ball);
    World::new(scene.build().unwrap(), Execution::default()).unwrap()
}

fn shuttled<T: Compiled>() {
    let at = |height: f64| [0.25, 0.0, height];
    // Passed at 1, at 7, at 17, at 23 and so on.
    let level = |up| Shape::from(Plane::new(at(1.0), up));
    let hoop = Shape::from(Disc::new(at(1.0), UP, 1.0, 0.0));
    let corners = [at(1.0), [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]];
    let [a, b, c] = corners;
    let miss = Shape::from(Disc::new(at(1.0), UP, 1.0, 0.5));
    let room = Shape::from(FixedSphere::container(at(2.0), 1.0));
    // Half the chord.
    let half = 15.0_f64.sqrt() / 4.0;
    let every = |first: f64| [first, first + 16.0, first + 32.0];
    let room_in = [every(2.0 - half), every(6.0 - half)].concat();
    let room_out = [every(2.0 + half), every(6.0 + half)].concat();
    let (up, down) = (every(1.0).to_vec(), every(7.0).to_vec());
    for engine in ENGINES {
        for (sensor, inward, outward) in [
            (level(UP), &down, &up),
            (level([0.0, 0.0, -2.0]), &up, &down),
            (hoop.clone(), &down, &up),
            (miss.clone(), &vec![], &vec![]),
            (Triangle::new(a, b, c).into(), &down, &up),
            (room.clone(), &room_in, &room_out),
        ] {
            let mut world = shuttle::<T>(engine, sensor.clone());
            for time in 1..=40 {
                world.advance(if time == 1 { 0.5 } else { 1.0 }).unwrap();
                let now = f64::from(time) - 0.5;
                let before =
                    |times: &[f64]| times.iter().filter(|time| **time < now).count() as u64;
                assert_eq!(
                    counts(passed(&world)[0]),
                    [before(inward), before(outward)],
                    "{engine:?} {} {sensor:?} at {now}",
                    T::NAME
                );
            }
        }
    }
}

#[test]
fn a_ball_that_goes_to_and_fro_is_counted_each_time() {
    shuttled::<f64>();
    shuttled::<f32>();
}

/// Everything that is closed, and what a place is in it by the shape itself.
fn closed() -> Vec<Shape<f64>> {
    let origin = [0.0; 3];
    let slanted = [1.0, 2.0, 2.0];
    let bottle = [[0.0, -1.0], [1.0, -1.0], [0.25, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let ring = [[0.5, -0.5], [1.5, -0.5], [1.5, 0.5], [1.0, 0.0], [0.5, 0.5]];
    vec![
        Cuboid::solid([-1.0, -0.5, -0.75], [1.0, 0.5, 0.75]).into(),
        Shape::from(Cuboid::solid([-1.0, -0.5, -0.75], [1.0, 0.5, 0.75])).turned(slanted, 0.7),
        FixedSphere::solid(origin, 1.0).into(),
        Capsule::solid([-0.5, 0.0, 0.0], [0.5, 0.5, 0.0], 0.5).into(),
        Cylinder::solid(origin, slanted, 0.75, Some(1.5)).into(),
        Cylinder::solid(origin, slanted, 0.75, None).into(),
        Cone::solid([0.0, 0.0, -0.75], UP, 1.5, [1.0, 0.0]).into(),
        Cone::solid([0.0, 0.0, -0.75], slanted, 1.5, [1.0, 0.5]).into(),
        Cone::endless_solid([0.0, 0.0, -0.75], UP, 0.75).into(),
        Torus::solid(origin, slanted, 0.75, 0.25).into(),
        Revolved::solid(origin, UP, bottle).into(),
        Revolved::solid(origin, slanted, ring).into(),
    ]
}

fn is_inside(shape: &Shape<f64>, place: carom::Vec3<f64>) -> bool {
    shape.features().iter().any(|feature: &Feature<f64>| feature.clearance(place, 0.0).gap < 0.0)
}

/// Draws that are the same everywhere.
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    }

    fn vector(&mut self, length: f64) -> [f64; 3] {
        core::array::from_fn(|_| length * self.next())
    }
}

#[test]
fn all_passages_of_a_parabola_through_what_is_closed_are_found() {
    const FLIGHTS: usize = 150;
    const LOOKS: usize = 1500;
    let duration = 3.0;
    for (kind, shape) in closed().into_iter().enumerate() {
        for gravity in [[0.0; 3], [0.0, 0.0, -2.0]] {
            let mut draws = Draws(kind as u64 + 7);
            let mut scene = Scene::<f64>::builder()
                .gravity(gravity)
                .encounters(Encounters::None)
                .engine(EngineKind::EventDriven)
                .surroundings(Sensor::new(shape.clone()));
            let balls: Vec<Sphere> = (0..FLIGHTS)
                .map(|_| {
                    let start = draws.vector(1.5);
                    let velocity = draws.vector(1.5);
                    Sphere::new(start).radius(0.1).velocity(velocity)
                })
                .collect();
            for ball in &balls {
                scene = scene.sphere(ball.clone());
            }
            let scene = scene.build().unwrap();
            let (start, features) = (scene.bodies.clone(), shape.features());
            let mut world = World::new(scene, Execution::default()).unwrap();
            world.advance(duration).unwrap();
            let found = passed(&world)[0];
            let (mut seen, mut grazes) = (Passages::default(), 0);
            for body in 0..FLIGHTS {
                let [c, v] = [start.position_of(body), start.velocity_of(body)];
                let mut was_inside = is_inside(&shape, c);
                let mut nearest = f64::INFINITY;
                for look in 1..=LOOKS {
                    let t = duration * look as f64 / LOOKS as f64;
                    let place = c + (v + carom::Vec3::from(gravity) * (0.5 * t)) * t;
                    for feature in &features {
                        nearest = nearest.min(feature.clearance(place, 0.0).gap.abs());
                    }
                    let now_inside = is_inside(&shape, place);
                    match (was_inside, now_inside) {
                        (false, true) => seen.inward += 1,
                        (true, false) => seen.outward += 1,
                        _ => {}
                    }
                    was_inside = now_inside;
                }
                grazes += u64::from(nearest < 1e-9);
            }
            // Looks can miss what is shorter than between two of them; never the finder.
            let more = found.inward - seen.inward;
            assert_eq!(more, found.outward - seen.outward, "{shape:?}: {found:?} for {seen:?}");
            assert!(more <= 2 + grazes, "{shape:?}: {found:?} for {seen:?}");
            assert!(seen.inward > 4 && seen.outward > 4, "{shape:?}: {seen:?}");
        }
    }
}

/// Rough balls that meet each other and walls, with a sensor of every kind among them.
const GAS: &str = r#"
duration = 4.0
gravity = [0.0, 0.0, -2.0]
stepped = { dt = 0.0078125 }
surface = { kind = "rough" }
surroundings = [
  { shape = "box", lower = [-4, -4, -4], upper = [4, 4, 4], inside = true },
  { shape = "plane", name = "level", point = [0, 0, 0.1], normal = [0, 1, 3], sensor = true },
  { shape = "sphere", name = "ball", center = [1, 0, 0], radius = 2, sensor = true },
  { shape = "box", lower = [-3, -3, -3], upper = [0, 1, 2], sensor = true },
  { shape = "torus", center = [0, 0, 0], axis = [0, 1, 3], major = 2, minor = 1, sensor = true },
  { shape = "annulus", center = [0, 0, 0], axis = [1, 0, 1], inner = 1, outer = 3, sensor = true },
  { shape = "funnel", center = [0, 0, 0], axis = [0, 0, 1], profile = [[0.5, -1], [3, 1]] },
]
[[spheres]]
count = 60
arrangement = "random"
radius = [0.2, 0.3]
temperature = 2.0
"#;

fn gas<T: Compiled>(engine: EngineKind) -> Scene<T> {
    let mut scene = SceneFile::parse("gas.toml", GAS).unwrap().build().unwrap();
    scene.engine = engine;
    scene
}

fn without_sensors(engine: EngineKind) -> Scene<f64> {
    let text: String =
        GAS.lines().filter(|line| !line.contains("sensor")).collect::<Vec<_>>().join("\n");
    let mut scene = SceneFile::parse("gas.toml", &text).unwrap().build().unwrap();
    scene.engine = engine;
    scene
}

fn inside(bodies: &Bodies<f64>, shape: &Shape<f64>) -> i64 {
    (0..bodies.len()).filter(|&body| is_inside(shape, bodies.position_of(body))).count() as i64
}

#[test]
fn what_came_in_less_what_went_out_is_inside() {
    let shapes: [Shape<f64>; 4] = [
        Plane::new([0.0, 0.0, 0.1], [0.0, 1.0, 3.0]).into(),
        FixedSphere::solid([1.0, 0.0, 0.0], 2.0).into(),
        Cuboid::solid([-3.0; 3], [0.0, 1.0, 2.0]).into(),
        Torus::solid([0.0; 3], [0.0, 1.0, 3.0], 2.0, 1.0).into(),
    ];
    for engine in ENGINES {
        let mut world = World::new(gas::<f64>(engine), Execution::default()).unwrap();
        let before = shapes.each_ref().map(|shape| inside(&world.bodies(), shape));
        world.advance(4.0).unwrap();
        let found = passed(&world);
        assert_eq!(found.len(), 5);
        for ((shape, before), found) in shapes.iter().zip(before).zip(&found) {
            let more = found.inward as i64 - found.outward as i64;
            assert_eq!(more, inside(&world.bodies(), shape) - before, "{engine:?} {shape:?}");
            assert!(found.inward > 15, "{engine:?} {found:?}");
        }
        assert!(found[4].inward + found[4].outward > 9, "{found:?}");
    }
}

#[test]
fn a_run_has_the_bits_of_one_without_sensors() {
    for engine in ENGINES {
        let run = |scene| {
            let mut world = World::new(scene, Execution::default()).unwrap();
            world.advance(4.0).unwrap();
            (state_hash(&world.bodies()), world.collisions(), world.impulse_from_surroundings())
        };
        assert_eq!(run(gas(engine)), run(without_sensors(engine)), "{engine:?}");
    }
}

fn counted<T: Compiled>(engine: EngineKind, execution: Execution, pieces: u32) -> Vec<Passages> {
    let mut world = World::new(gas::<T>(engine), execution).unwrap();
    for _ in 0..pieces {
        world.advance(4.0 / f64::from(pieces)).unwrap();
        // To look changes nothing.
        let _ = world.parts();
    }
    passed(&world)
}

#[test]
fn passages_are_the_same_on_every_path() {
    fn check<T: Compiled>() {
        for engine in ENGINES {
            let plain = Execution::new().threads(1).lanes(Lanes::Scalar).order(Order::Strict);
            let expected = counted::<T>(engine, plain, 1);
            for execution in [
                plain.lanes(Lanes::Auto),
                plain.threads(3),
                plain.order(Order::Windows),
                plain.order(Order::Windows).threads(3),
            ] {
                let found = counted::<T>(engine, execution, 1);
                assert_eq!(found, expected, "{engine:?} {} {execution:?}", T::NAME);
            }
            assert_eq!(counted::<T>(engine, plain, 32), expected, "{engine:?} {}", T::NAME);
            let in_windows = plain.order(Order::Windows);
            assert_eq!(counted::<T>(engine, in_windows, 32), expected, "{engine:?}");
        }
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn a_snapshot_remembers_what_was_counted() {
    for engine in ENGINES {
        let mut world = World::new(gas::<f64>(engine), Execution::default()).unwrap();
        world.advance(1.375).unwrap();
        let snapshot = world.snapshot();
        let before = passed(&world);
        world.advance(2.625).unwrap();
        let mut again =
            World::resume(gas::<f64>(engine), Execution::new().threads(1), &snapshot).unwrap();
        assert_eq!(passed(&again), before);
        again.advance(2.625).unwrap();
        assert_eq!(passed(&again), passed(&world), "{engine:?}");
        // Of a scene with other sensors, or without.
        let error = World::resume(without_sensors(engine), Execution::default(), &snapshot);
        assert!(error.unwrap_err().to_string().contains("by its sensors"), "{engine:?}");
        let bare = World::new(without_sensors(engine), Execution::default()).unwrap().snapshot();
        let error = World::resume(gas::<f64>(engine), Execution::default(), &bare);
        assert!(error.unwrap_err().to_string().contains("by its sensors"), "{engine:?}");
    }
}

#[test]
fn a_change_of_the_world_lets_counts_go_on() {
    for engine in ENGINES {
        let mut world = shuttle::<f64>(engine, Plane::new([0.0, 0.0, 1.0], UP).into());
        world.advance(8.0).unwrap();
        let mut change = world.change();
        change.set_velocity(0, [0.0, 0.0, 2.0]);
        change.apply().unwrap();
        // At 0: up past 1, to 4 at 2, and down past 1 at 3.5.
        world.advance(3.0).unwrap();
        assert_eq!(counts(passed(&world)[0]), [1, 2], "{engine:?}");
        world.advance(1.0).unwrap();
        assert_eq!(counts(passed(&world)[0]), [2, 2], "{engine:?}");
    }
}

/// Far from the origin, in other units: the engine's own frame has the sensors too.
#[test]
fn a_scene_far_away_counts_alike() {
    let far = [1024.0 * 1024.0, -524_288.0, 2_097_152.0];
    for engine in ENGINES {
        let near = counted::<f64>(engine, Execution::default(), 1);
        let mut scene = gas::<f64>(engine);
        let bodies = scene.bodies.clone();
        let mut builder = Scene::<f64>::builder()
            .engine(engine)
            .dt(0.0078125)
            .gravity([0.0, 0.0, -2.0])
            .surface(scene.surface);
        for shape in scene.surroundings.drain(..) {
            builder = builder.surroundings(shape.moved(far));
        }
        let mut moved = bodies;
        for (column, shift) in moved.position.iter_mut().zip(far) {
            // So few digits that none is lost.
            column.iter_mut().for_each(|x| *x = (*x * 1024.0).round() / 1024.0 + shift);
        }
        let mut world =
            World::new(builder.bodies(moved).build().unwrap(), Execution::default()).unwrap();
        world.advance(4.0).unwrap();
        let found = passed(&world);
        // Another run by its last digits, and after some collisions altogether.
        for (near, far) in near.iter().zip(found) {
            let [a, b] = [near.inward as f64, far.inward as f64];
            assert!((a - b).abs() < 0.35 * a, "{engine:?}: {near:?} {far:?}");
        }
    }
}

#[test]
fn sensors_that_cannot_be() {
    let message = |keys: &str, before: &str| {
        let text = format!(
            "{before}\n[[surroundings]]\n{keys}\nsensor = true\n[[spheres]]\nposition = [5, 5, 5]\n\
             radius = 0.5\n"
        );
        let built = SceneFile::parse("s.toml", &text).and_then(|file| file.build::<f64>());
        built.map_or_else(|error| error.to_string(), |_| "it can".to_owned())
    };
    let sides = "has no two distinct sides: a sensor is a plane, a disc, an annulus, a \
                 triangle, or what is closed: a box, a sphere, a capsule, a cylinder, a cone, a torus \
                 or a closed profile";
    let tube =
        "shape = \"tube\"\ncenter = [0, 0, 0]\naxis = [0, 0, 1]\nradius = 1\nhalf_height = 1";
    assert_eq!(
        message(tube, ""),
        format!("s.toml:8: surroundings[0].sensor is true; a tube {sides}")
    );
    let funnel =
        "shape = \"funnel\"\ncenter = [0, 0, 0]\naxis = [0, 0, 1]\nprofile = [[1, 0], [2, 1]]";
    let words = message(funnel, "");
    assert!(words.contains(sides), "{words}");
    let flat = "shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0";
    assert!(message(flat, "").contains("a radius must be finite and greater than 0"));
    let ball = "shape = \"sphere\"\ncenter = [5, 5, 5]\nradius = 2";
    assert_eq!(message(ball, ""), "it can");
    let periodic = "[periodic]\nlower = [0, 0, 0]\nupper = [10, 10, 10]";
    assert!(
        message(ball, periodic).contains("a sensor counts in open space only"),
        "{}",
        message(ball, periodic)
    );
    let words = message("shape = \"sensor\"", "");
    assert!(words.contains("shape is `sensor`; it must be one of `plane`"), "{words}");
}
