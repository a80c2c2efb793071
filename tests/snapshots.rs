//! A run that is cut anywhere and goes on from a snapshot is the run that was never cut.

mod common;

use carom::engine::{Compiled, Execution, Lanes, Order, Snapshot, World};
use carom::scene::EngineKind;
use carom::{SceneFile, state_hash};
use common::numbers::noise;

/// Rough spheres of many sizes that fall about in a box, a ball fixed in its middle.
const BOX: &str = r#"
gravity = [0.0, 0.1, -1.0]
seed = 3
surface.kind = "rough"
stepped.dt = 0.01
[[surroundings]]
shape = "box"
lower = [0.0, 0.0, 0.0]
upper = [6.0, 6.0, 6.0]
inside = true
[[surroundings]]
shape = "sphere"
center = [3.0, 3.0, 3.0]
radius = 0.5
[[spheres]]
count = 60
arrangement = "random"
radius = [0.1, 0.5]
density = 1.0
temperature = 2.0
spin_temperature = 1.0
"#;

/// A smooth fluid in a periodic box.
const FLUID: &str = r#"
periodic = "cube"
seed = 5
stepped.dt = 0.004
[[spheres]]
count = 256
arrangement = "fcc"
number_density = 0.7
radius = 0.5
temperature = 1.0
"#;

/// Spinning balls in a box far from the origin, in small units.
const FAR: &str = r#"
seed = 7
stepped.dt = 1e-9
[[surroundings]]
shape = "box"
lower = [5000.0, 0.0, 0.0]
upper = [5000.00003, 3e-5, 3e-5]
inside = true
[[spheres]]
count = 40
arrangement = "random"
lower = [5000.0, 0.0, 0.0]
upper = [5000.00003, 3e-5, 3e-5]
radius = [1e-6, 3e-6]
mass = 1e-12
temperature = 1e-10
spin_temperature = 1e-10
"#;

/// A great ball among small ones: cells of several sizes, and much crossing.
const DUST: &str = r#"
periodic = { lower = [0, 0, 0], upper = [24, 24, 24] }
seed = 9
stepped.dt = 0.01
surface.kind = "rough"
[[spheres]]
position = [12, 12, 12]
radius = 5
mass = 100
velocity = [1, 0.5, 0]
[[spheres]]
count = 300
arrangement = "random"
radius = 0.2
temperature = 1.0
"#;

/// A flat path along the inside of a hollow ball, and a bouncing one.
const HOLLOW: &str = r#"
gravity = [0, 0, -1]
stepped.dt = 0.01
[[surroundings]]
shape = "sphere"
center = [0, 0, 0]
radius = 5
inside = true
[[spheres]]
position = [0, 0, -4.4999]
velocity = [2, 0, 0]
radius = 0.5
[[spheres]]
position = [0, 2, 0]
radius = 0.5
"#;

/// What is compared: every event, the final state and all that was added up.
#[derive(Debug, PartialEq)]
struct Story {
    events: Vec<String>,
    hash: String,
    totals: String,
}

fn totals<T: Compiled>(world: &World<T>) -> String {
    let impulse = world.impulse_from_surroundings();
    let (time, path) = (world.time(), world.mean_free_path());
    format!("{:?} {:?} {impulse:?} {time:?} {path:?}", world.collisions(), world.virial())
}

/// Lets a world tell its story up to a time of the run.
fn tell<T: Compiled>(world: &mut World<T>, until: f64, events: &mut Vec<String>) {
    let mut note = |event: &carom::engine::Event<T>| events.push(format!("{event:?}"));
    match world {
        World::Stepped(world) => {
            let steps = (until / world.exact_dt()).round() as u64 - world.steps();
            world.take_steps(steps, Some(&mut note));
        }
        World::EventDriven(world) => {
            assert!(world.advance_to(until, u64::MAX, Some(&mut note)).unwrap());
        }
    }
}

fn end<T: Compiled>(world: &World<T>, events: Vec<String>) -> Story {
    Story { events, hash: state_hash(&world.bodies()).to_string(), totals: totals(world) }
}

/// A snapshot that went through bytes.
fn through_bytes(snapshot: &Snapshot) -> Snapshot {
    let bytes = postcard::to_stdvec(snapshot).unwrap();
    postcard::from_bytes(&bytes).unwrap()
}

fn scene_file(text: &str, engine: EngineKind) -> SceneFile {
    let mut file = SceneFile::parse("scene", text).unwrap();
    file.engine = engine;
    file
}

/// The story of a run cut at random, each part on other lanes and threads.
fn cut<T: Compiled>(file: &SceneFile, duration: f64, seed: u64) -> Story {
    let mut noise = noise(seed);
    let executions = [Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Auto]
        .map(|lanes| Execution::new().lanes(lanes));
    let mut events = Vec::new();
    let mut world = World::new(file.build::<T>().unwrap(), executions[3].threads(1)).unwrap();
    let mut part = 0;
    loop {
        part += 1;
        let until = world.time() + 0.4 * duration * noise();
        let is_last = until >= duration || part == 6;
        let mut collisions = u64::MAX;
        if let (World::EventDriven(world), true) = (&mut world, noise() < 0.5) {
            // Stopped by a number of collisions, where others may be due.
            collisions = (noise() * 40.0) as u64;
            let mut note = |event: &carom::engine::Event<T>| events.push(format!("{event:?}"));
            world.advance_to(until.min(duration), collisions, Some(&mut note)).unwrap();
        }
        if is_last {
            tell(&mut world, duration, &mut events);
            return end(&world, events);
        }
        if collisions == u64::MAX {
            tell(&mut world, until, &mut events);
        }
        let order = [Order::Strict, Order::Windows][part / 2 % 2];
        let execution = executions[part % 4].threads(1 + part % 2).order(order);
        let snapshot = through_bytes(&world.snapshot());
        world = World::resume(file.build::<T>().unwrap(), execution, &snapshot).unwrap();
    }
}

fn check<T: Compiled>(text: &str, duration: f64, cuts: u64) {
    for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
        let file = scene_file(text, engine);
        let mut world = World::new(file.build::<T>().unwrap(), Execution::default()).unwrap();
        let mut events = Vec::new();
        tell(&mut world, duration, &mut events);
        assert!(events.len() > 20, "{engine:?}: only {} events", events.len());
        let whole = end(&world, events);
        for seed in 0..cuts {
            let cut = cut::<T>(&file, duration, seed);
            assert_eq!(cut.events.len(), whole.events.len(), "{engine:?} {seed}");
            assert!(cut == whole, "{engine:?} {seed}: {} {}", cut.totals, whole.totals);
        }
    }
}

#[test]
fn a_rough_gas_in_a_box_goes_on() {
    check::<f64>(BOX, 3.0, 12);
    check::<f32>(BOX, 3.0, 12);
}

#[test]
fn a_fluid_goes_on() {
    check::<f64>(FLUID, 2.0, 8);
    check::<f32>(FLUID, 2.0, 8);
}

#[test]
fn a_scene_in_a_frame_of_its_own_goes_on() {
    check::<f64>(FAR, 3e-6, 8);
}

#[test]
fn bodies_of_many_sizes_go_on() {
    check::<f64>(DUST, 8.0, 6);
    check::<f32>(DUST, 8.0, 6);
}

#[test]
fn a_ball_along_a_hollow_goes_on() {
    check::<f64>(HOLLOW, 6.0, 12);
    check::<f32>(HOLLOW, 6.0, 12);
}

#[test]
fn other_ways_of_the_stepped_engine_go_on() {
    for more in [
        "stepped.impact=end-of-step",
        "stepped.integrator=semi-implicit-euler",
        "stepped.orientation=each-step",
        "stepped.summation=compensated",
        "stepped.summation=plain",
        "surface.kind=smooth",
        "encounters=none",
    ] {
        for text in [BOX, DUST] {
            let file = SceneFile::parse("scene", text).unwrap().with_values(&[more]).unwrap();
            for seed in 0..3 {
                let mut world =
                    World::new(file.build::<f64>().unwrap(), Execution::default()).unwrap();
                let mut events = Vec::new();
                tell(&mut world, 1.5, &mut events);
                assert_eq!(cut::<f64>(&file, 1.5, seed), end(&world, events), "{more}");
            }
        }
    }
}

#[test]
fn another_scenes_snapshot_is_refused() {
    let [event_driven, stepped] = [EngineKind::EventDriven, EngineKind::Stepped];
    let world = |text: &str, engine| {
        World::new(scene_file(text, engine).build::<f64>().unwrap(), Execution::default()).unwrap()
    };
    let refused = |text: &str, engine, snapshot: &Snapshot| {
        let scene = scene_file(text, engine).build::<f64>().unwrap();
        let refused = World::resume(scene, Execution::default(), snapshot);
        refused.err().map(|error| error.to_string()).unwrap_or_default()
    };
    for engine in [event_driven, stepped] {
        let snapshot = world(FLUID, engine).snapshot();
        assert_eq!(refused(FLUID, engine, &snapshot), "");
        assert!(refused(BOX, engine, &snapshot).contains("not of this scene"), "{engine:?}");
        let other = if engine == stepped { event_driven } else { stepped };
        assert!(refused(FLUID, other, &snapshot).contains("by its engine"));
        let scene = scene_file(FLUID, engine).build::<f32>().unwrap();
        let error = World::resume(scene, Execution::default(), &snapshot).unwrap_err();
        assert!(error.to_string().contains("by its precision"), "{error}");
    }
    // It has room for little more than the bodies.
    let snapshot = world(FLUID, event_driven).snapshot();
    let bytes = postcard::to_stdvec(&snapshot).unwrap().len();
    assert!(bytes < 256 * (7 * 8 + 12) + 500, "{bytes}");
}
