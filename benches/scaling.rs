//! Time and memory against the number of bodies, as a table.
//!
//! ```text
//! cargo bench --bench scaling
//! ```
//!
//! The stepped engine on the smooth gas from a thousand bodies to a million.
//! Each row is measured in a process of its own, so that the greatest resident
//! size is its own too; that includes making the scene.

#[path = "common/process.rs"]
mod process;
#[path = "common/scenes.rs"]
mod scenes;

use std::env;
use std::error::Error;
use std::process::Command;
use std::time::Instant;

use carom::contact::Surface;
use carom::engine::{Execution, Lanes, Stepped};
use carom::real::Real;

/// Says to this program that it is to measure one row.
const ROW: &str = "--row";

/// Runs of which the median is taken.
const RUNS: usize = 5;

/// Steps of one body in a run.
const BODY_STEPS: usize = 4_000_000;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [ROW, precision, bodies, threads] => {
            let (bodies, threads) = (bodies.parse()?, threads.parse()?);
            let row = match precision {
                "f32" => row::<f32>(bodies, threads)?,
                _ => row::<f64>(bodies, threads)?,
            };
            println!("{row}");
            Ok(())
        }
        _ => table(arguments.iter().any(|argument| argument == "--bench")),
    }
}

/// The table; only its first rows where this runs as a test.
fn table(is_measurement: bool) -> Result<(), Box<dyn Error>> {
    println!("| precision | threads | bodies | ns / body / step | bytes / body | peak MB |");
    println!("|---|--:|--:|--:|--:|--:|");
    let all = [1_000, 10_000, 100_000, 1_000_000];
    let sizes = if is_measurement { &all[..] } else { &all[..1] };
    for precision in ["f32", "f64"] {
        for threads in ["1", "2"] {
            for bodies in sizes {
                let row = Command::new(env::current_exe()?)
                    .args([ROW, precision, &bodies.to_string(), threads])
                    .output()?;
                if !row.status.success() {
                    return Err(String::from_utf8_lossy(&row.stderr).into());
                }
                print!("{}", String::from_utf8_lossy(&row.stdout));
            }
        }
    }
    Ok(())
}

/// One row of the table, measured.
fn row<T: Real>(bodies: usize, threads: usize) -> Result<String, Box<dyn Error>> {
    let scene = scenes::gas::<T>(bodies, Surface::Smooth)?;
    let mut world = Stepped::with_execution(scene, Execution { lanes: Lanes::Auto, threads })?;
    let steps = (BODY_STEPS / bodies).max(10);
    world.advance_steps(20);
    let mut times = [(); RUNS].map(|()| {
        let start = Instant::now();
        world.advance_steps(steps as u64);
        start.elapsed().as_secs_f64() * 1e9 / (bodies * steps) as f64
    });
    times.sort_by(f64::total_cmp);
    let bytes = world.bytes() as f64 / bodies as f64;
    let peak =
        process::peak_resident().map_or("–".to_owned(), |bytes| format!("{:.0}", bytes * 1e-6));
    let (precision, time) = (T::NAME, times[RUNS / 2]);
    Ok(format!("| {precision} | {threads} | {bodies} | {time:.1} | {bytes:.0} | {peak} |"))
}
