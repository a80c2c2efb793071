//! Instructions of the engines and of the kernels that they spend their time in: the
//! figures that repeat on a busy machine.
//!
//! ```text
//! RUSTFLAGS="-C target-cpu=x86-64-v3" cargo bench --manifest-path benches/Cargo.toml --bench instructions
//! RUSTFLAGS="-C target-cpu=x86-64-v3" cargo bench --manifest-path benches/Cargo.toml --bench instructions -- rough
//! ```
//!
//! Each row is run twice under valgrind's callgrind, in processes of their own: once for a
//! number of units of work and once for none. The difference of the two is what the units
//! take, without what goes before. Valgrind does not know AVX-512, which these flags leave
//! out.

// Other benches use the rest of these.
#[expect(dead_code)]
#[path = "kernels/columns.rs"]
mod columns;
#[path = "common/fluid.rs"]
mod fluid;
#[expect(dead_code)]
#[path = "common/process.rs"]
mod process;
#[path = "common/scenes.rs"]
mod scenes;

use std::env;
use std::error::Error;
use std::hint::black_box;
use std::process::{Command, Stdio};

use carom::contact::{self, Party, Surface, collide, contact_time};
use carom::engine::{Batch, Compiled, EventDriven, Execution, Order, Stepped};
use carom::lane::Lane;
use carom::mat3::Mat3;
use carom::motion::rotation::turned;
use carom::real::Real;
use carom::scene::{EngineKind, Impact, Scene};
use carom::surroundings::{Capsule, Cuboid, Feature, FixedSphere, Plane, Torus};
use carom::vec3::Vec3;
use columns::uniform;
use fluid::Fluid;

/// Says to this program that it is to do the work of one row.
const ROW: &str = "--row";

/// A time that no row comes to.
const END: f64 = 1e9;

/// Bodies of the fluids; those of the stepped gases.
const BODIES: u64 = 1_372;
const GAS: usize = 4_000;

/// Scenes of a batch, and bodies of each; they are as many as of a small world.
const SCENES: usize = 64;
const FEW: usize = 16;

/// How often the kernels go over their columns in one unit, and the length of these.
const SPHERES: usize = 960;

/// Does a number of units of work, and returns how many it has done.
type Work = Box<dyn Fn(u64) -> Result<u64, Box<dyn Error>>>;

/// One row of the table.
struct Row {
    name: String,
    /// What the instructions are divided by.
    unit: &'static str,
    units: u64,
    work: Work,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let mut rows = rows();
    if let [ROW, index, units] = arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        let done = (rows.swap_remove(index.parse()?).work)(units.parse()?)?;
        println!("{done}");
        return Ok(());
    }
    let names: Vec<_> = arguments.iter().filter(|text| *text != "--bench").collect();
    let is_wanted =
        |row: &Row| names.is_empty() || names.iter().any(|name| row.name.contains(name.as_str()));
    if cfg!(target_feature = "avx512f") {
        return Err(
            "valgrind does not know AVX-512: set RUSTFLAGS=\"-C target-cpu=x86-64-v3\"".into()
        );
    }
    println!("{}; callgrind of {}", process::processor(), version()?);
    println!("\n| | instructions | a |\n|---|--:|---|");
    for (index, row) in rows.iter().enumerate().filter(|(_, row)| is_wanted(row)) {
        // Valgrind does not know every instruction: the other rows are counted all the same.
        match counted(index, 0).and_then(|none| Ok((none, counted(index, row.units)?))) {
            Ok(([none, _], [some, done])) => {
                let each = (some - none) as f64 / done as f64;
                println!("| {} | {each:.0} | {} |", row.name, row.unit);
            }
            Err(error) => println!("| {} | – | {error} |", row.name),
        }
    }
    Ok(())
}

/// What valgrind calls itself.
fn version() -> Result<String, Box<dyn Error>> {
    let output = Command::new("valgrind").arg("--version").output();
    let output = output.map_err(|error| format!("valgrind does not start: {error}"))?;
    Ok(String::from_utf8(output.stdout)?.trim().to_owned())
}

/// The instructions of a process that does a number of units of a row, and the units done.
fn counted(index: usize, units: u64) -> Result<[u64; 2], Box<dyn Error>> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe()?)
        .args([ROW, &index.to_string(), &units.to_string()])
        .stdin(Stdio::null())
        .output()?;
    let messages = String::from_utf8_lossy(&output.stderr);
    let count = messages.lines().find_map(|line| line.split_once("Collected : "));
    let Some((_, count)) = count.filter(|_| output.status.success()) else {
        let reason = messages.lines().find(|line| line.contains("nrecognised instruction"));
        return Err(reason.unwrap_or(&messages).to_owned().into());
    };
    Ok([count.trim().parse()?, String::from_utf8(output.stdout)?.trim().parse()?])
}

fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for density in [0.1, 0.5, 0.9] {
        rows.push(collisions::<f64>("f64", density, Surface::Smooth, Order::Strict));
    }
    rows.push(collisions::<f64>("f64", 0.9, Surface::Smooth, Order::Windows));
    rows.push(collisions::<f64>("f64", 0.5, Surface::Rough, Order::Strict));
    rows.push(collisions::<f32>("f32", 0.5, Surface::Smooth, Order::Strict));
    for surface in [Surface::Smooth, Surface::Rough] {
        for impact in [Impact::EndOfStep, Impact::SubStep] {
            rows.push(steps::<f32>("f32", surface, impact));
            rows.push(steps::<f64>("f64", surface, impact));
        }
    }
    for surface in [Surface::Smooth, Surface::Rough] {
        for impact in [Impact::EndOfStep, Impact::SubStep] {
            rows.push(batch_steps(surface, impact));
        }
        rows.extend([8, 16, 32, 64].map(|bodies| few(bodies, surface)));
    }
    for engine in [EngineKind::Stepped, EngineKind::EventDriven] {
        rows.push(set_up(engine));
    }
    kernels::<f32>("f32", &mut rows);
    kernels::<f64>("f64", &mut rows);
    times(&mut rows);
    rows
}

/// Collisions of a fluid in the event-driven engine, after 15 of each body.
fn collisions<T: Compiled>(precision: &str, density: f64, surface: Surface, order: Order) -> Row {
    let work = move |collisions: u64| {
        let scene =
            Fluid { bodies: BODIES, density, diameter: 1.0, surface, seed: 1 }.scene::<T>()?;
        let execution = Execution::new().threads(1).order(order);
        let mut world = EventDriven::with_execution(scene, execution)?;
        world.advance_about(END, 15 * BODIES / 2, None)?;
        let before = world.collisions().total();
        if collisions > 0 {
            world.advance_about(END, collisions, None)?;
        }
        Ok(world.collisions().total() - before)
    };
    Row {
        name: format!(
            "event-driven, density {density}, {BODIES} {surface} bodies, {precision}, {order}"
        ),
        unit: "collision",
        units: 10_000,
        work: Box::new(work),
    }
}

/// Steps of a gas in the stepped engine.
fn steps<T: Compiled>(precision: &str, surface: Surface, impact: Impact) -> Row {
    let work = move |steps: u64| {
        let mut scene = scenes::gas::<T>(GAS, surface)?;
        scene.stepped.impact = impact;
        let mut world = Stepped::with_execution(scene, Execution::new().threads(1))?;
        world.advance_steps(20);
        world.advance_steps(steps);
        Ok(steps * GAS as u64)
    };
    Row {
        name: format!("stepped, {GAS} {surface} bodies, {precision}, {impact}"),
        unit: "body and step",
        units: 200,
        work: Box::new(work),
    }
}

/// Steps of a batch of small gases.
fn batch_steps(surface: Surface, impact: Impact) -> Row {
    let work = move |steps: u64| {
        let mut scene = scenes::gas::<f64>(FEW, surface)?;
        scene.engine = EngineKind::Stepped;
        scene.stepped.impact = impact;
        let mut batch = Batch::varied(&scene, SCENES, Execution::new().threads(1), |k, scene| {
            scene.bodies.velocity[0][0] += 1e-3 * k as f64;
        })?;
        batch.advance_steps(200)?;
        batch.advance_steps(steps)?;
        Ok(steps * (FEW * SCENES) as u64)
    };
    Row {
        name: format!("a batch of {FEW} {surface} bodies, f64, {impact}"),
        unit: "body and step",
        units: 200,
        work: Box::new(work),
    }
}

/// Scenes that a batch is made of.
fn set_up(engine: EngineKind) -> Row {
    let work = move |scenes: u64| {
        let mut scene = scenes::gas::<f64>(FEW, Surface::Smooth)?;
        scene.engine = engine;
        let vary = |k: usize, scene: &mut Scene<f64>| {
            scene.bodies.velocity[0][0] += 1e-3 * k as f64;
        };
        let execution = Execution::new().threads(1);
        let made = |count: u64| Batch::varied(&scene, count as usize, execution, vary);
        made(1)?;
        if scenes > 0 {
            made(scenes)?;
        }
        Ok(scenes)
    };
    Row {
        name: format!("set-up of {FEW} bodies in a batch, f64, {engine:?}"),
        unit: "scene",
        units: 1_000,
        work: Box::new(work),
    }
}

/// Collisions of a small gas in the event-driven engine.
fn few(bodies: usize, surface: Surface) -> Row {
    let work = move |collisions: u64| {
        let scene = scenes::gas::<f64>(bodies, surface)?;
        let mut world = EventDriven::with_execution(scene, Execution::new().threads(1))?;
        world.advance_about(END, 1_000, None)?;
        let before = world.collisions().total();
        if collisions > 0 {
            world.advance_about(END, collisions, None)?;
        }
        Ok(world.collisions().total() - before)
    };
    Row {
        name: format!("event-driven, {bodies} {surface} bodies in a container, f64"),
        unit: "collision",
        units: 20_000,
        work: Box::new(work),
    }
}

/// The formulas over lanes, one real at a time and in the widest pack for gathers.
fn kernels<T: Real>(precision: &str, rows: &mut Vec<Row>) {
    fn row<L: Lane>(
        (precision, name): (&str, &str),
        formula: impl Fn([L; 12]) -> L + 'static,
    ) -> Row {
        let inputs = uniform::<L::Scalar, 12>(SPHERES, -1.0, 1.0, 1);
        let work = move |times: u64| {
            for _ in 0..times {
                let columns = inputs.each_ref().map(|column| L::arrays(black_box(column)).0);
                for k in 0..SPHERES / L::WIDTH {
                    black_box(formula(columns.map(|column| L::from_array(column[k]))));
                }
            }
            Ok(times * SPHERES as u64)
        };
        let lanes = if L::WIDTH == 1 { "one lane".into() } else { format!("{} lanes", L::WIDTH) };
        Row {
            name: format!("{name}, {precision}, {lanes}"),
            unit: "pair or body",
            units: 20,
            work: Box::new(work),
        }
    }
    fn in_lanes<L: Lane>(precision: &str, rows: &mut Vec<Row>) {
        rows.push(row(
            (precision, "time of contact of a pair"),
            |[x, y, z, u, v, w, ..]: [L; 12]| {
                let contact = contact_time(Vec3::new(x, y, z), Vec3::new(u, v, w), L::ratio(1, 2));
                L::select(contact.meets, contact.time, L::ZERO)
            },
        ));
        rows.push(row((precision, "smooth impulse"), |inputs: [L; 12]| {
            pair(contact::Smooth, inputs)
        }));
        rows.push(row((precision, "rough impulse"), |inputs: [L; 12]| {
            pair(contact::Rough, inputs)
        }));
        rows.push(row((precision, "rotation"), |[x, y, z, ..]: [L; 12]| {
            let rows = turned(Mat3::splat(Mat3::IDENTITY), Vec3::new(x, y, z), L::ONE).rows();
            rows.into_iter().fold(L::ZERO, |sum, element| sum + element)
        }));
    }
    in_lanes::<T>(precision, rows);
    in_lanes::<T::Pack8>(precision, rows);
}

/// The impulse of two bodies of the same kind.
fn pair<L: Lane>(law: impl contact::Law<L>, inputs: [L; 12]) -> L {
    let [x, y, z, ux, uy, uz, vx, vy, vz, px, py, pz] = inputs;
    let party = |velocity: [L; 3], spin: [L; 3]| Party {
        velocity: velocity.into(),
        spin: spin.into(),
        inverse_mass: L::ONE,
        inverse_inertia: L::ratio(10, 1),
        share: L::ratio(1, 2),
    };
    let (mut a, mut b) = (party([ux, uy, uz], [px, py, pz]), party([vx, vy, vz], [pz, px, py]));
    collide(law, Vec3::new(x, y, z), &mut a, &mut b);
    a.velocity.dot(b.velocity) + a.spin.dot(b.spin)
}

/// Times of contact with what is fixed: half of the flights are aimed at it.
fn times(rows: &mut Vec<Row>) {
    type Made = fn() -> Feature<f64>;
    let features: [(&str, Made); 5] = [
        ("a plane", || Plane::new([0.0; 3], [0.0, 0.0, 1.0]).into()),
        ("a sphere", || FixedSphere::solid([0.0; 3], 2.0).into()),
        ("a box", || Cuboid::solid([-2.0; 3], [2.0; 3]).into()),
        ("a capsule", || Capsule::solid([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], 1.0).into()),
        ("a torus", || Torus::solid([0.0; 3], [0.0, 0.0, 1.0], 3.0, 1.0).into()),
    ];
    for (name, feature) in features {
        for (path, field) in [("straight", None), ("parabola", Some(Vec3::new(0.0, 0.0, -1.0)))] {
            let flights = uniform::<f64, 6>(SPHERES, -1.0, 1.0, 2);
            let work = move |times: u64| {
                let feature = feature();
                for _ in 0..times {
                    for k in 0..SPHERES {
                        let [x, y, z, u, v, w] = flights.each_ref().map(|column| column[k]);
                        let center = Vec3::new(x, y, z) * 10.0;
                        let aim = if k % 2 == 0 { center * -0.2 } else { Vec3::ZERO };
                        let velocity = Vec3::new(u, v, w) + aim;
                        black_box(feature.contact_time(center, velocity, field, 0.5, false));
                    }
                }
                Ok(times * SPHERES as u64)
            };
            rows.push(Row {
                name: format!("time of contact with {name}, {path}, f64"),
                unit: "sphere",
                units: 10,
                work: Box::new(work),
            });
        }
    }
}
