//! What a change of a world costs, beside a step of it and beside the start of a world.
//!
//! ```text
//! cargo bench --manifest-path benches/Cargo.toml --bench changes            # a minute
//! ```
//!
//! The gas of the other benches, f64, one thread. What is compared has its turns in rounds;
//! times are medians of the rounds.

#[expect(dead_code)]
#[path = "common/process.rs"]
mod process;
#[path = "common/scenes.rs"]
mod scenes;

use std::error::Error;
use std::time::Instant;

use carom::contact::Surface;
use carom::engine::{Execution, World};
use carom::scene::{EngineKind, Impact};

/// Rounds of a table.
const ROUNDS: usize = 9;

/// Steps that are timed together.
const STEPS: u32 = 20;

fn main() -> Result<(), Box<dyn Error>> {
    println!("{}", process::processor());
    println!(
        "\nms; 1 % of the bodies are removed, and as many added where they were, in one change\n"
    );
    println!("| engine | bodies | a step | a start | 1 % exchanged | 1 % removed | one kicked |");
    println!("|---|--:|--:|--:|--:|--:|--:|");
    for engine in [EngineKind::Stepped, EngineKind::EventDriven] {
        for bodies in [1_000, 10_000, 100_000] {
            row(engine, bodies)?;
        }
    }
    Ok(())
}

/// A row of the table: the costs of an engine with this many bodies.
fn row(engine: EngineKind, bodies: usize) -> Result<(), Box<dyn Error>> {
    let mut scene = scenes::gas::<f64>(bodies, Surface::Smooth)?;
    scene.engine = engine;
    // Bodies do not overlap where a step ends, and may be put back.
    scene.stepped.impact = Impact::SubStep;
    let execution = Execution::new().threads(1);
    let dt = scene.stepped.dt.ok_or("the gas has a step")?;
    let first = scene.clone();
    let mut world = World::new(scene, execution)?;
    world.advance(f64::from(STEPS) * dt)?;
    let mut times = vec![Vec::new(); 5];
    let mut put = |column: usize, start: Instant, parts: f64| {
        times[column].push(start.elapsed().as_secs_f64() * 1e3 / parts);
    };
    for round in 0..ROUNDS {
        let start = Instant::now();
        world.advance(f64::from(STEPS) * dt)?;
        put(0, start, f64::from(STEPS));

        let all = world.bodies();
        let again = first.with_bodies(all.clone())?;
        let start = Instant::now();
        let other = World::new(again, execution)?;
        put(1, start, 1.0);
        drop(other);

        let gone: Vec<usize> = (round..bodies).step_by(100).collect();
        let start = Instant::now();
        let mut change = world.change();
        change.add(&all.only(&gone));
        gone.iter().for_each(|&body| {
            change.remove(body);
        });
        change.apply()?;
        put(2, start, 1.0);

        // The last ones are those that were added.
        let last: Vec<usize> = (bodies - gone.len()..bodies).collect();
        let back = world.bodies().only(&last);
        let start = Instant::now();
        let mut change = world.change();
        last.iter().for_each(|&body| {
            change.remove(body);
        });
        change.apply()?;
        put(3, start, 1.0);
        let mut change = world.change();
        change.add(&back);
        change.apply()?;

        let start = Instant::now();
        let mut change = world.change();
        change.apply_impulse(round, [0.1, 0.0, 0.0]);
        change.apply()?;
        put(4, start, 1.0);
    }
    let median = |column: &[f64]| {
        let mut sorted = column.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[ROUNDS / 2]
    };
    let cells: Vec<_> = times.iter().map(|column| format!("{:.2}", median(column))).collect();
    println!("| {engine:?} | {bodies} | {} |", cells.join(" | "));
    Ok(())
}
