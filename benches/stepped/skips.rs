//! What a scene saves that lacks something: it has to cost what it would in a
//! program that never heard of it.
//!
//! A row without a thing is to be compared with the row that has it. The first
//! group also has the bare loop of such a program: `c += vΔt` over columns.

use carom::column::Column;
use carom::contact::Surface;
use carom::engine::Compiled;
use carom::motion::flight::flight;
use carom::motion::integrator::Coasting;
use carom::real::Real;
use carom::scene::{Encounters, SceneBuilder, Spheres};
use carom::scene::{Impact, OrientationUpdate};
use carom::space::{OpenSpace, PeriodicBox};
use carom::vec3::Vec3;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, Throughput};

use crate::scenes::{container, spheres, steps};
use crate::{SetupError, criterion_settings, measure};

const BODIES: usize = 10_000;

/// All benches of this file.
pub fn benches<T: Compiled>(criterion: &mut Criterion) -> Result<(), SetupError> {
    let mut group = criterion_settings::group(criterion, &format!("free flight/{}", T::NAME), 10);
    bare_loop::<T>(&mut group);
    for (name, scene) in free_flights::<T>() {
        measure(&mut group, BenchmarkId::from_parameter(name), scene.build()?, 1)?;
    }
    group.finish();

    let mut group =
        criterion_settings::group(criterion, &format!("gas with and without/{}", T::NAME), 10);
    for (name, scene) in gases::<T>() {
        measure(&mut group, BenchmarkId::from_parameter(name), scene.build()?, 1)?;
    }
    group.finish();
    Ok(())
}

/// The least that free flight can be, on one thread in the widest lanes.
fn bare_loop<T: Real>(group: &mut BenchmarkGroup<'_, WallTime>) {
    let columns = |value| [(); 3].map(|()| Column::new(BODIES, value));
    let (mut position, mut velocity) = (columns(T::ZERO), columns(T::ONE));
    let steps = 1_000_000 / BODIES;
    group.throughput(Throughput::Elements((BODIES * steps) as u64));
    group.bench_function("bare loop", |bencher| {
        bencher.iter(|| {
            for _ in 0..steps {
                let position = position.each_mut().map(|column| &mut column[..]);
                let velocity = velocity.each_mut().map(|column| &mut column[..]);
                let dt = T::ratio(1, 1024);
                flight::<T::Pack16, Coasting, _>(position, velocity, Vec3::ZERO, dt, OpenSpace);
            }
        });
    });
}

/// Spheres that pass through everything.
fn free_flights<T: Real>() -> Vec<(&'static str, SceneBuilder<T>)> {
    let (spheres, side) = spheres(BODIES);
    let spinning = spheres.clone().spin_temperature(1.0);
    let free =
        |spheres: &Spheres| steps::<T>().encounters(Encounters::None).spheres(spheres.clone());
    let space = PeriodicBox::new([T::ZERO; 3], [T::from_f64(side); 3]);
    let down = [T::ZERO, T::ZERO, -T::ONE];
    vec![
        ("nothing", free(&spheres)),
        ("spins", free(&spinning)),
        ("spins, turned in each step", free(&spinning).orientation(OrientationUpdate::EachStep)),
        ("gravity", free(&spheres).gravity(down)),
        ("periodic box", free(&spheres).periodic(space)),
        ("container, passed through", free(&spheres).surroundings(container(side))),
        ("container, met", {
            free(&spheres).encounters(Encounters::Surroundings).surroundings(container(side))
        }),
    ]
}

/// Spheres that meet.
fn gases<T: Real>() -> Vec<(&'static str, SceneBuilder<T>)> {
    let (spheres, side) = spheres(BODIES);
    let spinning = spheres.clone().spin_temperature(1.0);
    let gas =
        |spheres: &Spheres| steps::<T>().surroundings(container(side)).spheres(spheres.clone());
    let almost = 0.499..=0.5;
    vec![
        ("smooth", gas(&spheres)),
        ("smooth, spins", gas(&spinning)),
        ("smooth, radii differ", gas(&spheres.clone().radius(almost))),
        ("smooth, masses differ", gas(&spheres.clone().mass(0.999..=1.001))),
        ("smooth, gravity", gas(&spheres).gravity([T::ZERO, T::ZERO, -T::ratio(1, 100)])),
        ("smooth, sub-step", gas(&spheres).impact(Impact::SubStep)),
        ("rough", gas(&spinning).surface(Surface::Rough)),
        ("rough, turned in each step", {
            gas(&spinning).surface(Surface::Rough).orientation(OrientationUpdate::EachStep)
        }),
    ]
}
