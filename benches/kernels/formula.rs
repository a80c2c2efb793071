//! A formula over lanes, applied to columns in the cache.

use std::hint::black_box;

use carom::column::Column;
use carom::lane::Lane;
use carom::real::Real;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput};

use crate::columns::{read, write};
use crate::{criterion_settings, in_each_width};

/// A formula of `I` numbers that gives `O`.
pub trait Formula<T: Real, const I: usize, const O: usize> {
    /// The formula in one lane type.
    fn of<L: Lane<Scalar = T>>(&self, inputs: [L; I]) -> [L; O];
}

/// Measures a formula over all elements of the columns in every lane width.
pub fn measure<T: Real, const I: usize, const O: usize>(
    criterion: &mut Criterion,
    title: &str,
    inputs: &[Column<T>; I],
    formula: &impl Formula<T, I, O>,
) {
    let mut group = criterion_settings::group(criterion, &format!("{title}/{}", T::NAME), 20);
    let len = inputs[0].len();
    group.throughput(Throughput::Elements(len as u64));
    let mut outputs = [(); O].map(|()| Column::new(len, T::ZERO));
    in_each_width!(T, in_width::<_, I, O>(&mut group, inputs, &mut outputs, formula));
    group.finish();
}

fn in_width<L: Lane, const I: usize, const O: usize>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    inputs: &[Column<L::Scalar>; I],
    outputs: &mut [Column<L::Scalar>; O],
    formula: &impl Formula<L::Scalar, I, O>,
) {
    group.bench_function(L::WIDTH.to_string(), |bencher| {
        bencher.iter(|| {
            apply::<L, I, O>(black_box(read(inputs)), black_box(write(outputs)), formula);
        });
    });
}

fn apply<L: Lane, const I: usize, const O: usize>(
    inputs: [&[L::Scalar]; I],
    outputs: [&mut [L::Scalar]; O],
    formula: &impl Formula<L::Scalar, I, O>,
) {
    let inputs = inputs.map(|column| L::arrays(column).0);
    let outputs = outputs.map(|column| L::arrays_mut(column).0);
    // As many of each, so that no bound is checked in the loop.
    let len = inputs[0].len();
    let inputs = inputs.map(|column| &column[..len]);
    let outputs = outputs.map(|column| &mut column[..len]);
    for i in 0..len {
        let results = formula.of(inputs.each_ref().map(|column| L::from_array(column[i])));
        for k in 0..O {
            outputs[k][i] = results[k].to_array();
        }
    }
}
