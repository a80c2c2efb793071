//! A gas of a thousand to a million spheres on one thread and on two.

use carom::contact::Surface;
use carom::engine::Compiled;
use criterion::{BenchmarkId, Criterion};

use crate::{SetupError, criterion_settings, measure, scenes};

/// All benches of this file.
pub fn benches<T: Compiled>(criterion: &mut Criterion) -> Result<(), SetupError> {
    for (surface, name) in [(Surface::Smooth, "smooth"), (Surface::Rough, "rough")] {
        let mut group =
            criterion_settings::group(criterion, &format!("gas/{name}/{}", T::NAME), 10);
        for bodies in [1_000, 10_000, 100_000, 1_000_000] {
            let scene = scenes::gas::<T>(bodies, surface)?;
            for (threads, id) in [(1, "1 thread"), (2, "2 threads")] {
                measure(&mut group, BenchmarkId::new(id, bodies), scene.clone(), threads)?;
            }
        }
        group.finish();
    }
    Ok(())
}
