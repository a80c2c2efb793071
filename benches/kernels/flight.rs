//! Flight: every integrator, with and without a field, in open space and in a
//! periodic box.

use std::marker::PhantomData;

use carom::column::Column;
use carom::lane::Lane;
use carom::motion::flight::{flight, flight_and_fastest};
use carom::motion::integrator::{
    Coasting, ExplicitEuler, FlightStep, SemiImplicitEuler, VelocityVerlet,
};
use carom::real::Real;
use carom::space::{OpenSpace, PeriodicBox, Space};
use carom::vec3::Vec3;
use criterion::Criterion;

use crate::columns::{uniform, write};
use crate::sweep::{Sweep, measure};

/// All benches of this file.
pub fn benches<T: Real>(criterion: &mut Criterion) {
    measure::<T, Flight<T, Coasting, Open>>(criterion, "flight/no field");
    measure::<T, Flight<T, SemiImplicitEuler, Open>>(criterion, "flight/semi-implicit Euler");
    measure::<T, Flight<T, ExplicitEuler, Open>>(criterion, "flight/explicit Euler");
    measure::<T, Flight<T, VelocityVerlet, Open>>(criterion, "flight/velocity Verlet");
    measure::<T, Flight<T, Coasting, Periodic>>(criterion, "flight/no field, periodic");
    measure::<T, Flight<T, VelocityVerlet, Periodic>>(
        criterion,
        "flight/velocity Verlet, periodic",
    );
    measure::<T, FlightAndFastest<T>>(criterion, "flight/no field, and the fastest");
}

/// The space that a sweep is in, as a type.
trait InSpace<T: Real> {
    type Space: Space<T>;
    fn space() -> Self::Space;
}

struct Open;

impl<T: Real> InSpace<T> for Open {
    type Space = OpenSpace;

    fn space() -> OpenSpace {
        OpenSpace
    }
}

struct Periodic;

impl<T: Real> InSpace<T> for Periodic {
    type Space = PeriodicBox<T>;

    fn space() -> PeriodicBox<T> {
        PeriodicBox::new([T::ZERO; 3], [T::whole(10); 3])
    }
}

/// Positions and velocities of bodies that fly by one integrator.
struct Flight<T: Real, I, P> {
    position: [Column<T>; 3],
    velocity: [Column<T>; 3],
    how: PhantomData<(I, P)>,
}

impl<T: Real, I: FlightStep, P: InSpace<T>> Sweep<T> for Flight<T, I, P> {
    const READ: usize = if I::CHANGES_VELOCITY { 0 } else { 3 };
    const REWRITTEN: usize = if I::CHANGES_VELOCITY { 6 } else { 3 };

    fn of(bodies: usize) -> Self {
        Self {
            position: uniform(bodies, 0.0, 10.0, 3),
            velocity: uniform(bodies, -1.0, 1.0, 4),
            how: PhantomData,
        }
    }

    fn run<L: Lane<Scalar = T>>(&mut self) {
        let (position, velocity) = (write(&mut self.position), write(&mut self.velocity));
        flight::<L, I, P::Space>(position, velocity, gravity(), dt(), P::space());
    }
}

/// The same without a field, looking for the fastest body on the way, which
/// tells the broad phase when to look again.
struct FlightAndFastest<T: Real>(Flight<T, Coasting, Open>);

impl<T: Real> Sweep<T> for FlightAndFastest<T> {
    const READ: usize = <Flight<T, Coasting, Open> as Sweep<T>>::READ;
    const REWRITTEN: usize = <Flight<T, Coasting, Open> as Sweep<T>>::REWRITTEN;

    fn of(bodies: usize) -> Self {
        Self(Sweep::of(bodies))
    }

    fn run<L: Lane<Scalar = T>>(&mut self) {
        let Flight { position, velocity, .. } = &mut self.0;
        let (position, velocity) = (write(position), write(velocity));
        flight_and_fastest::<L, Coasting, _>(position, velocity, gravity(), dt(), OpenSpace);
    }
}

fn gravity<T: Real>() -> Vec3<T> {
    Vec3::new(T::ZERO, T::ZERO, -T::ONE)
}

fn dt<T: Real>() -> T {
    T::ratio(1, 1024)
}
