//! Worlds of few bodies, advanced one step at a time: what a call costs.

use carom::contact::Surface;
use carom::engine::{Compiled, EventDriven, Execution, Stepped};
use criterion::{BenchmarkId, Criterion, Throughput};

use crate::{SetupError, WARM_UP_STEPS, criterion_settings, scenes};

/// All benches of this file.
pub fn benches<T: Compiled>(criterion: &mut Criterion) -> Result<(), SetupError> {
    let mut group = criterion_settings::group(criterion, &format!("small/{}", T::NAME), 20);
    let execution = Execution::new().threads(1);
    for bodies in [1, 5, 50] {
        group.throughput(Throughput::Elements(1));
        let scene = scenes::gas::<T>(bodies, Surface::Smooth)?;
        let mut stepped = Stepped::with_execution(scene.clone(), execution)?;
        stepped.advance_steps(WARM_UP_STEPS);
        group.bench_function(BenchmarkId::new("stepped", bodies), |bencher| {
            bencher.iter(|| stepped.step());
        });
        let dt = stepped.exact_dt();
        let mut event_driven = EventDriven::with_execution(scene, execution)?;
        group.bench_function(BenchmarkId::new("event-driven", bodies), |bencher| {
            bencher.iter(|| event_driven.advance(dt));
        });
    }
    group.finish();
    Ok(())
}
