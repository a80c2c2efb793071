//! Sine and cosine.

use carom::lane::Lane;
use carom::real::Real;
use carom::trigonometry::sin_cos;
use criterion::Criterion;

use crate::IN_CACHE;
use crate::columns::uniform;
use crate::formula::{Formula, measure};

/// All benches of this file.
pub fn benches<T: Real>(criterion: &mut Criterion) {
    measure(criterion, "sin_cos", &uniform::<T, 1>(IN_CACHE, -10.0, 10.0, 1), &SinCos);
}

struct SinCos;

impl<T: Real> Formula<T, 1, 2> for SinCos {
    #[inline(always)]
    fn of<L: Lane<Scalar = T>>(&self, [angle]: [L; 1]) -> [L; 2] {
        sin_cos(angle).into()
    }
}
