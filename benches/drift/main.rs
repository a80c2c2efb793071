//! How the energy drifts in long event-driven runs.
//!
//! ```text
//! cargo bench --bench drift              # 10⁸ collisions of each kind of fluid
//! cargo bench --bench drift -- 1e7
//! ```
//!
//! If roundings have no preferred side, the energy walks at random, and its
//! error grows as the square root of the number of collisions (Brouwer, *The
//! Astronomical Journal* 46, 1937). If they have one it grows with the number
//! itself. One run cannot tell the two apart: each kind of fluid is run from
//! several starts. Prints a table and draws `docs/images/energy-drift.svg`.

#[path = "../common/fluid.rs"]
mod fluid;

mod energy;
mod picture;
mod statistics;

use std::env;
use std::error::Error;
use std::iter;
use std::path::Path;

use carom::contact::Surface;
use carom::engine::{EngineError, EventDriven};
use carom::real::Real;
use carom::scene::SceneError;
use fluid::Fluid;
use rayon::prelude::*;
use statistics::Statistics;

/// Runs of each kind of fluid.
const RUNS: u64 = 16;

/// Spheres in each: few, so that the error is soon above the last digit.
const BODIES: u64 = 256;

const DENSITY: f64 = 0.5;

/// Collisions in a run up to the first point.
const FIRST: u64 = 1 << 10;

/// Collisions of a body in which the lattice melts.
const MELTING: u64 = 50;

/// Where the points are drawn.
const PICTURE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/images/energy-drift.svg");

/// Why a run was not made.
#[derive(Debug, thiserror::Error)]
enum RunError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// A kind of fluid and what was measured of it.
struct Case {
    precision: &'static str,
    surface: Surface,
    diameter: f64,
    statistics: Statistics,
}

impl Case {
    fn surface(&self) -> &'static str {
        if self.surface == Surface::Rough { "rough" } else { "smooth" }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let is_measurement = arguments.iter().any(|argument| argument == "--bench");
    let given = arguments.iter().find(|argument| !argument.starts_with('-'));
    let collisions: f64 = match given {
        Some(number) => number.parse()?,
        None if is_measurement => 1e8,
        None => 1e5,
    };
    let points = points(collisions as u64 / RUNS);

    let Some(last) = points.last() else {
        return Err(format!("at least {} collisions, please", FIRST * RUNS).into());
    };
    println!("{RUNS} runs of {last} collisions, {BODIES} spheres at density {DENSITY}.");
    println!("Errors in ε of the energy; drift in ε of a particle's energy, for each of its");
    println!("collisions. ± is one standard error. Spread: about the mean of all runs.");
    println!();
    println!(
        "| precision | surface | diameter | error at the end | exponent | of the spread | drift |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|");
    let mut cases = Vec::new();
    for diameter in [1.0, 1.37] {
        for surface in [Surface::Smooth, Surface::Rough] {
            for case in [case::<f32>, case::<f64>] {
                let case = case(surface, diameter, &points)?;
                println!("{}", row(&case));
                cases.push(case);
            }
        }
    }
    if is_measurement {
        picture::draw(Path::new(PICTURE), &points, &cases)?;
    }
    Ok(())
}

/// Numbers of collisions after which the energy is looked at, each twice the
/// one before.
fn points(last: u64) -> Vec<u64> {
    let mut points: Vec<u64> =
        iter::successors(Some(last), |n| Some(n / 2)).take_while(|&n| n >= FIRST).collect();
    points.reverse();
    points
}

/// All runs of one kind of fluid.
fn case<T: Real>(surface: Surface, diameter: f64, points: &[u64]) -> Result<Case, RunError> {
    let changes = (0..RUNS)
        .into_par_iter()
        .map(|seed| {
            let fluid = Fluid { bodies: BODIES, density: DENSITY, diameter, surface, seed };
            run::<T>(fluid, points)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let statistics = Statistics::new(points, &changes, BODIES);
    Ok(Case { precision: T::NAME, surface, diameter, statistics })
}

/// The change of the energy at every point of one run, in ε of the energy.
fn run<T: Real>(fluid: Fluid, points: &[u64]) -> Result<Vec<f64>, RunError> {
    let mut world = EventDriven::new(fluid.scene::<T>()?)?;
    world.advance_until(MELTING * BODIES / 2, 1e9)?;
    let (start, molten) = (world.bodies(), world.collisions().total());
    let mut changes = Vec::new();
    for point in points {
        world.advance_until(molten + point - world.collisions().total(), 1e9)?;
        changes.push(energy::relative_change(&world.bodies(), &start) / T::EPSILON.to_f64());
    }
    Ok(changes)
}

fn row(case: &Case) -> String {
    let Case { precision, diameter, statistics, .. } = case;
    let Statistics { errors, exponent, spread_exponent, drift } = statistics;
    let end = errors.last().copied().unwrap_or(f64::NAN);
    let surface = case.surface();
    format!(
        "| {precision} | {surface} | {diameter} | {end:.2} | {exponent:.2} | {spread_exponent:.2} \
         | {drift:.5} |"
    )
}
