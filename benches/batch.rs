//! Batches: body-steps and collisions a second of many scenes in lanes, beside the same
//! scenes one by one, what a scene costs to set up, and its memory.
//!
//! ```text
//! cargo bench --manifest-path benches/Cargo.toml --bench batch            # six minutes
//! cargo bench --manifest-path benches/Cargo.toml --bench batch -- quick   # 16 bodies only
//! ```
//!
//! The rows of a table have their turns in rounds, so that a busy spell of the machine falls
//! on all of them; times are the least of the rounds, ratios medians of theirs.

#[path = "common/process.rs"]
mod process;
#[path = "common/scenes.rs"]
mod scenes;

use std::error::Error;
use std::time::Instant;

use carom::contact::Surface;
use carom::engine::{Batch, Compiled, EventDriven, Execution, Lanes, Stepped};
use carom::scene::{EngineKind, Impact, Scene, SceneError};

/// Rounds of a table.
const ROUNDS: usize = 7;

/// Bodies of all scenes of a batch: they stay in the second-level cache, as the packs of a
/// longer batch do while their turn lasts.
const BODIES: usize = 16_384;

/// Steps of one body that a turn takes.
const WORK: usize = 6_000_000;

/// Collisions of all scenes in the rows of the event-driven engine.
const COLLISIONS: u64 = 100_000;

const WIDTHS: [Lanes; 5] = [Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen, Lanes::Auto];

fn main() -> Result<(), Box<dyn Error>> {
    let is_quick = std::env::args().any(|argument| argument == "quick");
    println!("{}", process::processor());
    println!("\nns of wall time for a body and step; times as fast as one by one on one thread");
    println!(
        "bodies  impact       surface  precision  alone     lanes 1      4           8           16"
    );
    let sizes: &[usize] = if is_quick { &[16] } else { &[2, 5, 16, 50, 100, 200] };
    for &bodies in sizes {
        for impact in [Impact::EndOfStep, Impact::SubStep] {
            for surface in [Surface::Smooth, Surface::Rough] {
                steps::<f32>(bodies, impact, surface)?;
                steps::<f64>(bodies, impact, surface)?;
            }
        }
    }
    println!("\nset-up of a scene of 16 bodies, µs on one thread, and its memory, bytes");
    set_up::<f32>(Surface::Smooth)?;
    set_up::<f64>(Surface::Smooth)?;
    set_up::<f32>(Surface::Rough)?;
    set_up::<f64>(Surface::Rough)?;
    println!("\nevent-driven, 16 bodies in f64: ns of wall time a collision");
    events()?;
    let resident = process::peak_resident().map_or_else(String::new, |bytes| {
        format!("\ngreatest resident size: {:.0} MB", bytes / 1e6)
    });
    println!("{resident}");
    Ok(())
}

/// Spheres of diameter 1 in a container, for the stepped engine.
fn gas<T: Compiled>(
    bodies: usize,
    impact: Impact,
    surface: Surface,
) -> Result<Scene<T>, SceneError> {
    let mut scene = scenes::gas::<T>(bodies, surface)?;
    scene.stepped.impact = impact;
    scene.engine = EngineKind::Stepped;
    Ok(scene)
}

/// One table row: threads 1 and 2 in all widths, beside worlds one by one.
fn steps<T: Compiled>(
    bodies: usize,
    impact: Impact,
    surface: Surface,
) -> Result<(), Box<dyn Error>> {
    let count = (BODIES / bodies).next_multiple_of(16);
    let steps = (WORK / (count * bodies)).max(4) as u64;
    let scene = gas::<T>(bodies, impact, surface)?;
    let mut batches = Vec::new();
    for threads in [1, 2] {
        for lanes in WIDTHS {
            let execution = Execution::new().lanes(lanes).threads(threads);
            batches.push(Batch::made(count, execution, |_| Ok(scene.clone()))?);
        }
    }
    // As many worlds one by one as make a turn of about the same length.
    let alone = Execution::new().threads(1);
    let worlds = (0..count / 8).map(|_| Stepped::with_execution(scene.clone(), alone));
    let mut worlds = worlds.collect::<Result<Vec<_>, _>>()?;
    // Scenes that were equal go apart: each is kicked by its number.
    for batch in &mut batches {
        for k in 0..count {
            batch.apply_impulse(k, 0, [1e-3 * k as f64, 0.0, 0.0].map(T::from_f64))?;
        }
        batch.advance_steps(200)?;
    }
    for (k, world) in worlds.iter_mut().enumerate() {
        let mut change = world.change();
        change.apply_impulse(0, [1e-3 * k as f64, 0.0, 0.0].map(T::from_f64));
        change.apply()?;
        world.advance_steps(200);
    }
    let mut rounds = Vec::new();
    for _ in 0..ROUNDS {
        let start = Instant::now();
        worlds.iter_mut().for_each(|world| world.advance_steps(steps));
        let done = (worlds.len() * bodies) as f64 * steps as f64;
        let mut times = vec![start.elapsed().as_secs_f64() / done * 1e9];
        for batch in &mut batches {
            let start = Instant::now();
            batch.advance_steps(steps)?;
            times
                .push(start.elapsed().as_secs_f64() / (count * bodies) as f64 / steps as f64 * 1e9);
        }
        rounds.push(times);
    }
    let least =
        |column: usize| rounds.iter().map(|times| times[column]).fold(f64::INFINITY, f64::min);
    let ratio = |column: usize| {
        let mut ratios: Vec<f64> = rounds.iter().map(|times| times[0] / times[column]).collect();
        ratios.sort_by(f64::total_cmp);
        ratios[ROUNDS / 2]
    };
    for threads in [1, 2] {
        let first = 1 + (threads - 1) * WIDTHS.len();
        let cells = (first..first + WIDTHS.len())
            .map(|column| format!("{:6.2} {:5.1}", least(column), ratio(column)));
        println!(
            "{bodies:6}  {:11}  {surface:7}  {:9}  {:6.1}   {}   ({threads} threads; last: auto)",
            if impact == Impact::SubStep { "within step" } else { "end of step" },
            T::NAME,
            least(0),
            cells.collect::<Vec<_>>().join("  "),
        );
    }
    Ok(())
}

/// What a scene costs before it moves.
fn set_up<T: Compiled>(surface: Surface) -> Result<(), Box<dyn Error>> {
    const COUNT: usize = 20_000;
    let scene = gas::<T>(16, Impact::EndOfStep, surface)?;
    let execution = Execution::new().threads(1);
    let (mut batch_time, mut alone_time, mut bytes) = (f64::INFINITY, f64::INFINITY, 0);
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let batch = Batch::varied(&scene, COUNT, execution, |k, scene| {
            scene.bodies.velocity[0][0] = T::from_f64(k as f64 * 1e-6);
        })?;
        batch_time = batch_time.min(start.elapsed().as_secs_f64() / COUNT as f64);
        bytes = batch.bytes() / COUNT;
        let start = Instant::now();
        let worlds = (0..COUNT / 20).map(|_| {
            let mut scene = scene.with_bodies(scene.bodies.clone())?;
            scene.name.clear();
            Ok::<_, Box<dyn Error>>(Stepped::with_execution(scene, execution)?)
        });
        let worlds = worlds.collect::<Result<Vec<_>, _>>()?;
        alone_time = alone_time.min(start.elapsed().as_secs_f64() / worlds.len() as f64);
    }
    println!(
        "{surface:7} {}  in a batch {:.2}  alone {:.1}  bytes {bytes}",
        T::NAME,
        batch_time * 1e6,
        alone_time * 1e6
    );
    Ok(())
}

/// The event-driven engine, whose scenes run alone on all threads.
fn events() -> Result<(), Box<dyn Error>> {
    let mut scene = scenes::gas::<f64>(16, Surface::Smooth)?;
    scene.engine = EngineKind::EventDriven;
    const COUNT: usize = 512;
    let mut times = vec![Vec::new(); 3];
    for _ in 0..ROUNDS {
        let execution = Execution::new().threads(1);
        let worlds = (0..COUNT).map(|_| EventDriven::with_execution(scene.clone(), execution));
        let mut worlds = worlds.collect::<Result<Vec<_>, _>>()?;
        let duration = COLLISIONS as f64 / (COUNT as f64 * 25.0);
        let start = Instant::now();
        for world in &mut worlds {
            world.advance(duration)?;
        }
        let collided: u64 = worlds.iter().map(|world| world.collisions().total()).sum();
        times[0].push(start.elapsed().as_secs_f64() / collided as f64 * 1e9);
        for threads in [1, 2] {
            let execution = Execution::new().threads(threads);
            let mut batch = Batch::made(COUNT, execution, |_| Ok(scene.clone()))?;
            let start = Instant::now();
            batch.advance(duration)?;
            let collided: u64 = batch.collisions().map(|collisions| collisions.total()).sum();
            times[threads].push(start.elapsed().as_secs_f64() / collided as f64 * 1e9);
        }
    }
    for (times, name) in times.iter().zip(["one by one", "a batch", "a batch on two threads"]) {
        let least = times.iter().copied().fold(f64::INFINITY, f64::min);
        println!("{name}: {least:.0}");
    }
    Ok(())
}
