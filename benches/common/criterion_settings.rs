//! How criterion measures here: short, since there is much to measure.

use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion};

/// A group of benches. What takes many milliseconds gets few samples, at least
/// 10.
pub fn group<'a>(
    criterion: &'a mut Criterion,
    name: &str,
    samples: usize,
) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group
        .sample_size(samples)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(400));
    group
}

/// criterion without plots and with as many resamples as a figure of a noisy
/// machine deserves; options of the command line still hold.
pub fn criterion() -> Criterion {
    Criterion::default().without_plots().nresamples(5_000).configure_from_args()
}
