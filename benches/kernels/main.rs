//! Every kernel in every lane width and both precisions.
//!
//! ```text
//! cargo bench --manifest-path benches/Cargo.toml --bench kernels
//! cargo bench --manifest-path benches/Cargo.toml --bench kernels -- 'flight.*f32'
//! ```
//!
//! A group is one kernel in one precision. Its members are the lane widths that
//! the engines use, from `1`, the scalar reference that the others are to be
//! compared with. Sweeps are measured in the cache and out of it; there a
//! member `memory` reads and writes as many bytes in plain loops, which is as
//! fast as a sweep can be.

#[path = "../common/criterion_settings.rs"]
mod criterion_settings;

mod columns;
mod contact;
mod flight;
mod formula;
mod memory;
mod rotation;
mod surroundings;
mod sweep;
mod trigonometry;

use carom::real::Real;
use criterion::Criterion;

/// Bodies whose columns stay in the cache next to the core. No multiple of
/// 4 KiB: columns that far apart get in each other's way.
const IN_CACHE: usize = 4_000;

/// Bodies whose columns are in memory.
const OUT_OF_CACHE: usize = 4_000_000;

/// Calls a function for every lane type of a precision, the scalar first.
macro_rules! in_each_width {
    ($real:ident, $function:ident::<_ $(, $more:ident)*>($($argument:expr),*)) => {
        $function::<$real $(, $more)*>($($argument),*);
        $function::<$real::Pack4 $(, $more)*>($($argument),*);
        $function::<$real::Pack8 $(, $more)*>($($argument),*);
        $function::<$real::Pack16 $(, $more)*>($($argument),*);
    };
}
pub(crate) use in_each_width;

fn benches<T: Real>(criterion: &mut Criterion) {
    trigonometry::benches::<T>(criterion);
    rotation::benches::<T>(criterion);
    flight::benches::<T>(criterion);
    contact::benches::<T>(criterion);
    surroundings::benches::<T>(criterion);
}

fn main() {
    let mut criterion = criterion_settings::criterion();
    benches::<f32>(&mut criterion);
    benches::<f64>(&mut criterion);
    criterion.final_summary();
}
