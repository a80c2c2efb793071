//! Rotation: the formulas, and the sweep that turns every body.

use carom::column::Column;
use carom::lane::Lane;
use carom::mat3::Mat3;
use carom::motion::rotation::{reference_rotation, turned};
use carom::motion::turning::turn;
use carom::real::Real;
use carom::vec3::Vec3;
use criterion::Criterion;

use crate::IN_CACHE;
use crate::columns::{read, uniform, write};
use crate::formula::{self, Formula};
use crate::sweep::{self, Sweep};

/// All benches of this file.
pub fn benches<T: Real>(criterion: &mut Criterion) {
    let spins = spins::<T>(IN_CACHE);
    formula::measure(criterion, "rotation/reference", &spins, &Reference);
    formula::measure(criterion, "rotation/turned, a step", &spins, &Turned { steps: 1 });
    formula::measure(criterion, "rotation/turned, 100 turns", &spins, &Turned { steps: 60_000 });
    sweep::measure::<T, Turning<T>>(criterion, "rotation/sweep");
}

/// Angular velocities of about 0.01 rad per step.
fn spins<T: Real>(bodies: usize) -> [Column<T>; 3] {
    uniform(bodies, -0.01, 0.01, 2)
}

/// The rotation of a step by the formula as printed.
struct Reference;

impl<T: Real> Formula<T, 3, 9> for Reference {
    #[inline(always)]
    fn of<L: Lane<Scalar = T>>(&self, spin: [L; 3]) -> [L; 9] {
        reference_rotation(Vec3::from(spin), L::ONE).rows()
    }
}

/// The fast formula, for an orientation last touched some steps ago.
struct Turned {
    steps: i32,
}

impl<T: Real> Formula<T, 3, 9> for Turned {
    #[inline(always)]
    fn of<L: Lane<Scalar = T>>(&self, spin: [L; 3]) -> [L; 9] {
        let steps = L::ratio(self.steps, 1);
        turned(Mat3::splat(Mat3::IDENTITY), Vec3::from(spin), steps).rows()
    }
}

/// Orientations turned in every step.
struct Turning<T: Real> {
    orientation: [Column<T>; 9],
    spin: [Column<T>; 3],
}

impl<T: Real> Sweep<T> for Turning<T> {
    const READ: usize = 3;
    const REWRITTEN: usize = 9;

    fn of(bodies: usize) -> Self {
        let orientation = Mat3::<T>::IDENTITY.rows().map(|element| Column::new(bodies, element));
        Self { orientation, spin: spins(bodies) }
    }

    fn run<L: Lane<Scalar = T>>(&mut self) {
        turn::<L>(write(&mut self.orientation), read(&self.spin), T::ONE);
    }
}
