//! A sweep over the columns of all bodies, in the cache and out of it.

use carom::lane::Lane;
use carom::real::Real;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput};

use crate::{IN_CACHE, OUT_OF_CACHE, criterion_settings, in_each_width, memory};

/// A sweep with the columns that it goes over.
pub trait Sweep<T: Real> {
    /// Columns that it only reads.
    const READ: usize;

    /// Columns that it reads and writes.
    const REWRITTEN: usize;

    /// The columns of some bodies.
    fn of(bodies: usize) -> Self;

    /// The sweep in one lane type.
    fn run<L: Lane<Scalar = T>>(&mut self);
}

/// Measures a sweep in every lane width.
pub fn measure<T: Real, S: Sweep<T>>(criterion: &mut Criterion, title: &str) {
    let mut group =
        criterion_settings::group(criterion, &format!("{title}, cached/{}", T::NAME), 20);
    in_widths::<T, S>(&mut group, IN_CACHE);
    group.finish();

    let mut group =
        criterion_settings::group(criterion, &format!("{title}, memory/{}", T::NAME), 10);
    in_widths::<T, S>(&mut group, OUT_OF_CACHE);
    memory::measure::<T>(&mut group, OUT_OF_CACHE, S::READ, S::REWRITTEN);
    group.finish();
}

fn in_widths<T: Real, S: Sweep<T>>(group: &mut BenchmarkGroup<'_, WallTime>, bodies: usize) {
    let bytes = bodies * (S::READ + 2 * S::REWRITTEN) * size_of::<T>();
    group.throughput(Throughput::ElementsAndBytes { elements: bodies as u64, bytes: bytes as u64 });
    let mut sweep = S::of(bodies);
    in_each_width!(T, in_width::<_, S>(group, &mut sweep));
}

fn in_width<L: Lane, S: Sweep<L::Scalar>>(group: &mut BenchmarkGroup<'_, WallTime>, sweep: &mut S) {
    group.bench_function(L::WIDTH.to_string(), |bencher| bencher.iter(|| sweep.run::<L>()));
}
