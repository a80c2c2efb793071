//! Spheres that come and go by the scene: in both engines, on every path the same.

use carom::engine::{Compiled, Exchange, Execution, Lanes, Order, Partner, World};
use carom::observe::StateHash;
use carom::scene::{EngineKind, Inlet, Scene, SceneFile, Sphere};
use carom::state_hash;
use carom::surroundings::Plane;

const ENGINES: [EngineKind; 2] = [EngineKind::EventDriven, EngineKind::Stepped];
const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn drain() -> Plane<f64> {
    Plane::new([0.0; 3], UP)
}

/// Balls above a drain that come down to it at 1, 2.25 and 3.5.
fn column(engine: EngineKind) -> World<f64> {
    let ball = |height| Sphere::new([0.0, 0.0, height]).radius(0.5).velocity([0.0, 0.0, -1.0]);
    let scene = Scene::<f64>::builder().engine(engine).dt(0.125).sphere(ball(4.0));
    let scene = scene.sphere(ball(1.5)).sphere(ball(2.75).mass(2.0));
    let scene = scene.removing_surroundings("drain", drain()).build().unwrap();
    World::new(scene, Execution::default()).unwrap()
}

#[test]
fn each_is_taken_out_when_it_touches() {
    for engine in ENGINES {
        let mut world = column(engine);
        let handles: Vec<_> = (0..3).map(|body| world.handle_of(body).unwrap()).collect();
        let mut events = Vec::new();
        let mut note = |event: &carom::Event<f64>| {
            assert_eq!(event.partner, Partner::Surroundings(0));
            events.push((event.time, event.a));
        };
        world.for_each_event(1.5, &mut note).unwrap();
        assert_eq!((world.bodies().len(), world.index_of(handles[1])), (2, None), "{engine:?}");
        assert_eq!((world.index_of(handles[0]), world.index_of(handles[2])), (Some(0), Some(1)));
        assert_eq!(world.bodies().position_of(0).z, 2.5);
        world.for_each_event(5.5, &mut note).unwrap();
        // By their names, when the others have moved up.
        assert_eq!(events, [(1.0, 1), (2.25, 2), (3.5, 0)], "{engine:?}");
        assert!(world.bodies().is_empty());
        assert_eq!(world.time(), 7.0);
        assert_eq!((world.collisions().surroundings, world.parts()[0].removed), (3, 3));
        let Exchange { removed, .. } = world.exchange();
        assert_eq!((removed.spheres, removed.mass, removed.energy), (3, 4.0, 2.0));
        assert_eq!(
            (removed.momentum, world.impulse_from_surroundings()[2]),
            ([0.0, 0.0, 4.0], 8.0)
        );
        let energy = world.energy();
        assert_eq!((energy.kinetic(), world.impulse_from_surroundings()), (0.0, [0.0, 0.0, 8.0]));
    }
}

/// One that goes strikes nothing at that time, though it has bounced off.
#[test]
fn what_is_gone_strikes_nothing() {
    let ball = |height| Sphere::new([0.0, 0.0, height]).radius(0.5).velocity([0.0, 0.0, -1.0]);
    let scene = Scene::<f64>::builder().sphere(ball(3.5)).sphere(ball(1.5)).sphere(ball(2.5));
    let scene = scene.engine(EngineKind::EventDriven).removing_surroundings("drain", drain());
    let mut world = World::new(scene.build().unwrap(), Execution::default()).unwrap();
    world.advance(5.0).unwrap();
    assert_eq!((world.collisions().pairs, world.exchange().removed.spheres), (0, 3));
}

/// Several that touch at one time go at once.
#[test]
fn equal_times_are_one_exchange() {
    for engine in ENGINES {
        let mut scene = Scene::<f64>::builder().engine(engine).dt(0.125);
        for k in 0..9 {
            let place = [2.0 * f64::from(k % 3), 2.0 * f64::from(k / 3), 1.5];
            scene = scene.sphere(Sphere::new(place).radius(0.5).velocity([0.0, 0.0, -1.0]));
        }
        let stays = Sphere::new([0.0, 9.0, 5.0]).radius(0.5).velocity([0.5, 0.0, 0.0]);
        let scene = scene.sphere(stays).removing_surroundings("drain", drain());
        let mut world = World::new(scene.build().unwrap(), Execution::default()).unwrap();
        world.advance(1.0).unwrap();
        assert_eq!((world.bodies().len(), world.exchange().removed.spheres), (1, 9), "{engine:?}");
        assert_eq!(world.bodies().position_of(0).x, 0.5);
    }
}

/// A box whose floor has a drain in it.
const LEAK: &str = r#"
duration = 6.0
gravity = [0.0, 0.0, -3.0]
stepped = { dt = 0.0078125 }
surface = { kind = "rough" }
surroundings = [
  { shape = "box", lower = [-4, -4, -4], upper = [4, 4, 4], inside = true },
  { shape = "disc", name = "leak", center = [0, 0, -3], axis = [0, 0, 1], radius = 2, removes = true },
  { shape = "sphere", name = "ball", center = [2, 0, 0], radius = 1 },
  { shape = "plane", name = "level", point = [0, 0, 0], normal = [0, 0, 1], sensor = true },
]
[[spheres]]
count = 60
arrangement = "random"
radius = [0.2, 0.3]
temperature = 2.0
"#;

fn leak<T: Compiled>(engine: EngineKind) -> Scene<T> {
    let mut scene = SceneFile::parse("leak.toml", LEAK).unwrap().build().unwrap();
    scene.engine = engine;
    scene
}

/// All that a run comes to.
fn come_to<T: Compiled>(world: &World<T>) -> (StateHash, Exchange, String) {
    let words = format!("{:?} {:?} {}", world.parts(), world.collisions(), world.time());
    (state_hash(&world.bodies()), world.exchange(), words)
}

fn leaked<T: Compiled>(engine: EngineKind, execution: Execution, pieces: u32) -> World<T> {
    let mut world = World::new(leak::<T>(engine), execution).unwrap();
    for _ in 0..pieces {
        world.advance(6.0 / f64::from(pieces)).unwrap();
    }
    world
}

#[test]
fn what_goes_is_the_same_on_every_path() {
    fn check<T: Compiled>() {
        for engine in ENGINES {
            let plain = Execution::new().threads(1).lanes(Lanes::Scalar).order(Order::Strict);
            let world = leaked::<T>(engine, plain, 1);
            let expected = come_to(&world);
            let removed = expected.1.removed.spheres;
            assert!(removed > 20 && world.bodies().len() as u64 == 60 - removed, "{removed}");
            for (execution, pieces) in [
                (plain.lanes(Lanes::Auto), 1),
                (plain.threads(3), 1),
                (plain.order(Order::Windows).threads(3), 1),
                (plain, 48),
            ] {
                let found = come_to(&leaked::<T>(engine, execution, pieces));
                assert_eq!(found, expected, "{engine:?} {} {execution:?} {pieces}", T::NAME);
            }
        }
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn a_snapshot_goes_on_with_those_that_are_left() {
    for engine in ENGINES {
        for before in [0.25, 3.0] {
            let mut world = World::new(leak::<f64>(engine), Execution::default()).unwrap();
            world.advance(before).unwrap();
            let snapshot = world.snapshot();
            let then = come_to(&world);
            world.advance(6.0 - before).unwrap();
            let again = Execution::new().threads(1).lanes(Lanes::Four);
            let mut again = World::resume(leak::<f64>(engine), again, &snapshot).unwrap();
            assert_eq!(come_to(&again), then, "{engine:?}");
            again.advance(6.0 - before).unwrap();
            assert_eq!(come_to(&again), come_to(&world), "{engine:?} {before}");
        }
    }
}

/// What an engine of another world that a program changes by hand comes to.
#[test]
fn to_go_is_a_change_of_the_world() {
    let mut scene = leak::<f64>(EngineKind::Stepped);
    let mut world = World::new(scene.clone(), Execution::default()).unwrap();
    scene.removes.clear();
    let mut by_hand = World::new(scene, Execution::default()).unwrap();
    for _ in 0..300 {
        let mut gone = Vec::new();
        by_hand
            .for_each_event(0.0078125, |event| {
                if event.partner == Partner::Surroundings(1) {
                    gone.push(event.a as usize);
                }
            })
            .unwrap();
        let mut change = by_hand.change();
        for body in gone {
            change.remove(body);
        }
        change.apply().unwrap();
        world.advance(0.0078125).unwrap();
    }
    assert!(world.exchange().removed.spheres > 5);
    assert_eq!(state_hash(&world.bodies()), state_hash(&by_hand.bodies()));
}

#[test]
fn momentum_and_energy_are_those_of_what_is_left_and_what_is_gone() {
    for engine in ENGINES {
        let mut world = World::new(leak::<f64>(engine), Execution::default()).unwrap();
        let (before, energy) = (carom::Momentum::of(&world.bodies()).0.z, world.energy().total());
        world.advance(6.0).unwrap();
        let Exchange { removed, mass_time: (sum, since), .. } = world.exchange();
        let mass = world.bodies().len() as f64;
        let pulled = -3.0 * (sum + mass * (6.0 - since));
        let expected = before + pulled + world.impulse_from_surroundings()[2];
        let found = carom::Momentum::of(&world.bodies()).0.z + removed.momentum[2];
        assert!((found - expected).abs() < 1e-9 * pulled.abs(), "{engine:?}: {found} {expected}");
        let now = world.energy().total() + removed.energy;
        assert!(
            (now - energy).abs() < 2e-3 * energy.abs().max(100.0),
            "{engine:?}: {now} {energy}"
        );
    }
}

/// A program's own change, and one of the scene.
#[test]
fn a_program_can_add_to_what_is_left() {
    for engine in ENGINES {
        let mut world = column(engine);
        world.advance(4.0).unwrap();
        assert!(world.bodies().is_empty());
        let ball = carom::Bodies::from_positions(&[[0.0, 0.0, 2.5]]);
        let ball = ball.velocities(&[[0.0, 0.0, -1.0]]).radius(0.5).build().unwrap();
        let mut change = world.change();
        change.add(&ball);
        change.apply().unwrap();
        assert_eq!(world.handle_of(0).map(|handle| handle.number()), Some(3));
        let mut at = None;
        world.for_each_event(3.0, |event| at = Some((event.time, event.a))).unwrap();
        assert_eq!(at, Some((6.0, 3)), "{engine:?}");
        assert_eq!((world.bodies().len(), world.exchange().removed.spheres), (0, 4));
    }
}

#[test]
fn what_removes_but_cannot() {
    let message = |keys: &str, before: &str| {
        let text = format!(
            "{before}\n[[surroundings]]\n{keys}\nremoves = true\n[[spheres]]\nposition = [5, 5, 5]\n\
             radius = 0.5\n"
        );
        let built = SceneFile::parse("s.toml", &text).and_then(|file| file.build::<f64>());
        built.map_or_else(|error| error.to_string(), |_| "it can".to_owned())
    };
    let ball = "shape = \"sphere\"\ncenter = [2, 2, 2]\nradius = 1";
    assert_eq!(message(ball, ""), "it can");
    let sensor = message(&format!("{ball}\nsensor = true"), "");
    assert!(
        sensor.contains("s.toml:7: surroundings[0].removes") && sensor.contains("sensor"),
        "{sensor}"
    );
    let periodic = message(ball, "[periodic]\nlower = [0, 0, 0]\nupper = [10, 10, 10]");
    assert!(periodic.contains("a periodic box keeps its spheres"), "{periodic}");
    // An empty scene is none, whatever removes.
    let text = format!("[[surroundings]]\n{ball}\nremoves = true\n");
    let built = SceneFile::parse("s.toml", &text).unwrap().build::<f64>();
    assert!(built.is_err());
}

/// A tap above a floor that removes, in a box.
const TAP: &str = r#"
duration = 8.0
gravity = [0.0, 0.0, -1.0]
seed = 5
stepped = { dt = 0.0078125 }
surface = { kind = "rough" }
surroundings = [
  { shape = "box", lower = [-2, -2, -2], upper = [2, 2, 2], inside = true },
  { shape = "box", name = "drain", lower = [-2, -2, -2], upper = [0, 0, -1.5], removes = true },
]
[[inlet]]
lower = [-1.5, -1.5, 1.5]
upper = [1.5, 1.5, 1.5]
rate = 8.0
radius = [0.2, 0.3]
density = 1.0
velocity = [0.0, 0.0, -1.0]
temperature = 0.02
spin_temperature = 0.01
[[inlet]]
center = [0, 0, 0]
axis = [1, 2, 3]
reach = 0.5
from = 2.0
every = 0.25
count = 6
radius = 0.25
"#;

fn tap<T: Compiled>(engine: EngineKind) -> Scene<T> {
    let mut scene = SceneFile::parse("tap.toml", TAP).unwrap().build().unwrap();
    scene.engine = engine;
    scene
}

#[test]
fn spheres_come_at_their_times() {
    for engine in ENGINES {
        let tap = Inlet::at([0.0; 3]).radius(0.5).mass(2.0).velocity([0.0, 0.0, -2.0]);
        let tap = tap.every(1.0).from(0.5).count(3);
        let scene = Scene::<f64>::builder().engine(engine).dt(0.125).inlet(tap);
        let mut world = World::new(scene.build().unwrap(), Execution::default()).unwrap();
        let mut counts = Vec::new();
        for _ in 0..8 {
            world.advance(0.5).unwrap();
            counts.push(world.bodies().len());
        }
        assert_eq!(counts, [1, 1, 2, 2, 3, 3, 3, 3], "{engine:?}");
        let heights: Vec<f64> = (0..3).map(|body| world.bodies().position_of(body).z).collect();
        assert_eq!(heights, [-7.0, -5.0, -3.0], "{engine:?}");
        let Exchange { came, waits, mass_time, .. } = world.exchange();
        assert_eq!((came.spheres, came.mass, came.energy, waits), (3, 6.0, 12.0, 0));
        assert_eq!(mass_time, (6.0, 2.5), "{engine:?}");
        assert_eq!(came.momentum, [0.0, 0.0, -12.0]);
    }
}

/// One that would overlap waits until the one before is gone, and none is lost.
#[test]
fn without_room_they_wait() {
    for engine in ENGINES {
        // Each needs 4 to leave: the next three find no room.
        let tap = Inlet::at([0.0; 3]).radius(0.5).velocity([0.25, 0.0, 0.0]).every(1.0).count(3);
        let scene = Scene::<f64>::builder().engine(engine).dt(0.125).inlet(tap);
        let mut world = World::new(scene.build().unwrap(), Execution::default()).unwrap();
        world.advance(3.5).unwrap();
        assert_eq!((world.bodies().len(), world.exchange().waits), (1, 3), "{engine:?}");
        world.advance(16.5).unwrap();
        assert_eq!((world.bodies().len(), world.exchange().came.spheres), (3, 3), "{engine:?}");
        // At 0, 4 and 8.
        assert_eq!(world.exchange().waits, 7);
        assert_eq!(world.bodies().position_of(2).x, 3.0);
    }
}

#[test]
fn what_comes_and_goes_is_the_same_on_every_path() {
    fn check<T: Compiled>() {
        for engine in ENGINES {
            let run = |execution, pieces: u32| {
                let mut world = World::new(tap::<T>(engine), execution).unwrap();
                for _ in 0..pieces {
                    world.advance(8.0 / f64::from(pieces)).unwrap();
                }
                come_to(&world)
            };
            let plain = Execution::new().threads(1).lanes(Lanes::Scalar).order(Order::Strict);
            let expected = run(plain, 1);
            let Exchange { came, removed, .. } = expected.1;
            assert!(came.spheres > 40 && removed.spheres > 15, "{engine:?} {came:?} {removed:?}");
            for (execution, pieces) in [
                (plain.lanes(Lanes::Auto), 1),
                (plain.threads(3), 1),
                (plain.order(Order::Windows).threads(3), 1),
                (plain, 64),
            ] {
                let found = run(execution, pieces);
                assert_eq!(found, expected, "{engine:?} {} {execution:?} {pieces}", T::NAME);
            }
            // Kept, and on.
            let mut world = World::new(tap::<T>(engine), plain).unwrap();
            world.advance(2.375).unwrap();
            let snapshot = world.snapshot();
            let mut again = World::resume(tap::<T>(engine), plain.threads(2), &snapshot).unwrap();
            again.advance(8.0 - 2.375).unwrap();
            assert_eq!(come_to(&again), expected, "{engine:?} {}", T::NAME);
        }
    }
    check::<f32>();
    check::<f64>();
}

/// Windows of time, where nothing is removed.
#[test]
fn what_comes_is_the_same_in_windows() {
    let text = TAP.replace("removes = true", "removes = false");
    let run = |order| {
        let mut scene = SceneFile::parse("tap.toml", &text).unwrap().build::<f64>().unwrap();
        scene.engine = EngineKind::EventDriven;
        let mut world = World::new(scene, Execution::new().order(order).threads(2)).unwrap();
        world.advance(8.0).unwrap();
        come_to(&world)
    };
    assert_eq!(run(Order::Windows), run(Order::Strict));
}

/// What comes is what was asked for: places, sizes, motion.
#[test]
fn spheres_come_as_they_are_described() {
    let scene = SceneFile::parse(
        "s.toml",
        "encounters = \"none\"\n[[inlet]]\ncenter = [1, 2, 3]\naxis = [0, 3, 4]\nreach = 2\n\
         every = 0.001\ncount = 4000\nradius = [0.1, 0.3]\nmass = 2\nvelocity = [0, 0, 5]\n\
         temperature = 8\n",
    );
    let scene = scene.unwrap().build::<f64>().unwrap();
    let inlet = &scene.inlets[0];
    assert_eq!(scene.inlets.len(), 1);
    let mut world = World::new(scene.clone(), Execution::default()).unwrap();
    world.advance(0.2).unwrap();
    assert_eq!(world.bodies().len(), 201);
    let mut sums = [0.0; 4];
    for body in 0..201 {
        let bodies = world.bodies();
        let age = 0.2 - 0.001 * body as f64;
        let (place, velocity) = (bodies.position_of(body), bodies.velocity_of(body));
        let start = place - velocity * age - carom::Vec3::new(1.0, 2.0, 3.0);
        assert!((start.y * 0.6 + start.z * 0.8).abs() < 1e-9, "{start:?}");
        assert!(start.length() <= 2.0 + 1e-9);
        let radius = bodies.radius.of(body);
        assert!((0.1..0.3).contains(&radius));
        sums[0] += start.length_squared() / 201.0;
        sums[1] += (velocity.z - 5.0) / 201.0;
        sums[2] += velocity.x * velocity.x / 201.0;
        sums[3] += radius / 201.0;
    }
    // Within four standard errors: half the square of the reach, kT/m.
    assert!((sums[0] - 2.0).abs() < 0.33, "{sums:?}");
    assert!(sums[1].abs() < 0.57 && (sums[2] - 4.0).abs() < 1.6, "{sums:?}");
    assert!((sums[3] - 0.2).abs() < 0.017, "{sums:?}");
    assert_eq!(inlet, &scene.inlets[0]);
}

#[test]
fn inlets_that_cannot_be() {
    let message = |keys: &str| {
        let text = format!("[[inlet]]\n{keys}\n");
        let built = SceneFile::parse("s.toml", &text).and_then(|file| file.build::<f64>());
        built.map_or_else(|error| error.to_string(), |_| "it can".to_owned())
    };
    let point = "radius = 0.5\nposition = [0, 0, 0]";
    assert_eq!(message(&format!("{point}\nevery = 1")), "it can");
    for (keys, wanted) in [
        ("radius = 0.5\nevery = 1".to_owned(), "an inlet is a position, a box"),
        (format!("{point}\nevery = 1\nlower = [0, 0, 0]"), "inlet[0].lower"),
        (point.to_owned(), "inlet[0].every is missing"),
        (format!("{point}\nevery = 0"), "inlet[0].every is 0.0; a time must be finite"),
        (format!("{point}\nrate = -1"), "inlet[0].rate is -1.0; a rate must be finite"),
        (format!("{point}\nrate = 1\nevery = 1"), "inlet[0].rate"),
        (format!("{point}\nevery = 1\ncount = 0"), "a count must be at least 1"),
        (format!("{point}\nevery = 1\nfrom = -1"), "a time must be finite and not negative"),
        (format!("{point}\nevery = 1\nfrequency = 2"), "frequency"),
        ("position = [0, 0, 0]\nevery = 1".to_owned(), "inlet[0].radius"),
        (
            "radius = 1\nevery = 1\nlower = [0, 0, 0]\nupper = [1, -1, 1]".to_owned(),
            "no component may be less than that of lower",
        ),
        (
            "radius = 1\nevery = 1\ncenter = [0, 0, 0]\naxis = [0, 0, 0]\nreach = 1".to_owned(),
            "an axis must be finite",
        ),
    ] {
        let found = message(&keys);
        assert!(found.contains(wanted), "{keys}: {found}");
    }
    let text = format!(
        "periodic = {{ lower = [0, 0, 0], upper = [9, 9, 9] }}\n[[inlet]]\n{point}\nevery = 1\n"
    );
    let found = SceneFile::parse("s.toml", &text).unwrap().build::<f64>().unwrap_err().to_string();
    assert!(found.contains("a periodic box keeps its spheres"), "{found}");
    let text = format!("duration = 1e9\n[[inlet]]\n{point}\nevery = 1e-9\n");
    let found = SceneFile::parse("s.toml", &text).unwrap().build::<f64>().unwrap_err().to_string();
    assert!(found.contains("more than 2^53 spheres"), "{found}");
}
