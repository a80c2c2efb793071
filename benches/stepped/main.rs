//! The stepped engine as a whole, and what a scene saves that lacks something.
//!
//! ```text
//! cargo bench --manifest-path benches/Cargo.toml --bench stepped
//! cargo bench --manifest-path benches/Cargo.toml --bench stepped -- 'gas/smooth/f32'
//! ```
//!
//! Elements are steps of one body: 40 Melem/s are 25 ns per body and step.

#[path = "../common/criterion_settings.rs"]
mod criterion_settings;
#[path = "../common/scenes.rs"]
mod scenes;

mod gas;
mod parts;
mod skips;
mod small;

use carom::engine::{Compiled, EngineError, Execution, Stepped};
use carom::scene::{Scene, SceneError};
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Throughput};

/// Why a bench could not be set up.
#[derive(Debug, thiserror::Error)]
enum SetupError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// Steps before the clock starts, in which buffers grow to their size.
const WARM_UP_STEPS: u64 = 20;

/// Measures as many steps of a scene as make up a million steps of one body,
/// but some: a search for candidates serves several steps.
fn measure<T: Compiled>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    id: BenchmarkId,
    scene: Scene<T>,
    threads: usize,
) -> Result<(), SetupError> {
    let bodies = scene.bodies.len() as u64;
    let steps = (1_000_000 / bodies).max(10);
    let mut world = Stepped::with_execution(scene, Execution::new().threads(threads))?;
    world.advance_steps(WARM_UP_STEPS);
    group.throughput(Throughput::Elements(bodies * steps));
    group.bench_function(id, |bencher| bencher.iter(|| world.advance_steps(steps)));
    Ok(())
}

fn main() -> Result<(), SetupError> {
    let mut criterion = criterion_settings::criterion();
    gas::benches::<f32>(&mut criterion)?;
    gas::benches::<f64>(&mut criterion)?;
    skips::benches::<f32>(&mut criterion)?;
    skips::benches::<f64>(&mut criterion)?;
    parts::benches::<f64>(&mut criterion)?;
    small::benches::<f32>(&mut criterion)?;
    small::benches::<f64>(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}
