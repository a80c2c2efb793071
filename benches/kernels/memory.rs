//! The memory's speed over the bytes of a sweep.

use std::hint::black_box;

use carom::column::Column;
use carom::real::Real;
use criterion::BenchmarkGroup;
use criterion::measurement::WallTime;

/// Measures plain loops, a column at a time, that read `read` columns and
/// rewrite `rewritten`, which are no fewer.
pub fn measure<T: Real>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    bodies: usize,
    read: usize,
    rewritten: usize,
) {
    let columns = |count: usize| vec![Column::new(bodies, T::ONE); count];
    let (inputs, mut updated) = (columns(read), columns(rewritten));
    group.bench_function("memory", |bencher| {
        bencher.iter(|| traffic(black_box(&inputs), black_box(&mut updated)));
    });
}

fn traffic<T: Real>(inputs: &[Column<T>], updated: &mut [Column<T>]) {
    let small = T::ratio(1, 1 << 20);
    let (paired, alone) = updated.split_at_mut(inputs.len());
    for (column, input) in paired.iter_mut().zip(inputs) {
        for (x, &u) in column.iter_mut().zip(input.iter()) {
            *x = *x + u * small;
        }
    }
    for column in alone {
        for x in column.iter_mut() {
            *x = *x + small;
        }
    }
}
