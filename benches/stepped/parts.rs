//! Sizes and fixed parts that must not matter: the cost of a ball among few and many
//! fixed spheres, and of dust with and without a giant in it, in both engines.

use carom::engine::{Compiled, EventDriven, Execution};
use carom::scene::{Scene, SceneError, Sphere, Spheres};
use carom::surroundings::FixedSphere;
use criterion::{BenchmarkId, Criterion, Throughput};

use crate::{SetupError, criterion_settings, measure, scenes};

/// Side of the container, diameters of a ball: a packing fraction of 0.1 for
/// 50,000.
const SIDE: f64 = 64.0;
const BALLS: u64 = 50_000;

/// Collisions that are timed at once.
const COLLISIONS: u64 = 10_000;

/// All benches of this file.
pub fn benches<T: Compiled>(criterion: &mut Criterion) -> Result<(), SetupError> {
    let mut group = criterion_settings::group(criterion, &format!("parts/{}", T::NAME), 10);
    for along in [4, 8, 16, 32] {
        let scene = among_fixed_spheres::<T>(along)?;
        let parts = along * along * along;
        measure(&mut group, BenchmarkId::new("stepped", parts), scene.clone(), 1)?;
        event_driven(&mut group, BenchmarkId::new("event-driven", parts), scene)?;
    }
    for (name, has_giant) in [("dust", false), ("giant in dust", true)] {
        let scene = dust::<T>(has_giant)?;
        measure(&mut group, BenchmarkId::new(name, "stepped"), scene.clone(), 1)?;
        event_driven(&mut group, BenchmarkId::new(name, "event-driven"), scene)?;
    }
    group.finish();
    Ok(())
}

fn event_driven<T: Compiled>(
    group: &mut criterion::BenchmarkGroup<'_, criterion::measurement::WallTime>,
    id: BenchmarkId,
    scene: Scene<T>,
) -> Result<(), SetupError> {
    let mut world = EventDriven::with_execution(scene, Execution::new().threads(1))?;
    world.advance_until(COLLISIONS, 100.0)?;
    group.throughput(Throughput::Elements(COLLISIONS));
    group.bench_function(id, |bencher| {
        bencher.iter(|| world.advance_until(COLLISIONS, 100.0));
    });
    Ok(())
}

/// Balls of diameter 1 among small fixed spheres on a lattice.
fn among_fixed_spheres<T: Compiled>(along: u32) -> Result<Scene<T>, SceneError> {
    let spacing = SIDE / f64::from(along);
    let at = |k: u32| T::from_f64((f64::from(k) + 0.5) * spacing);
    let mut scene = scenes::steps::<T>().surroundings(scenes::container(SIDE));
    for k in 0..along * along * along {
        let center = [at(k % along), at(k / along % along), at(k / (along * along))];
        scene = scene.surroundings(FixedSphere::solid(center, T::ratio(1, 8)));
    }
    scene.spheres(Spheres::random(BALLS).radius(0.5).temperature(1.0).seed(1)).build()
}

/// Small balls in a container, and one of 300 times their size among them.
fn dust<T: Compiled>(has_giant: bool) -> Result<Scene<T>, SceneError> {
    let side = 100.0;
    let mut scene = scenes::steps::<T>().surroundings(scenes::container(side));
    if has_giant {
        scene = scene.sphere(Sphere::new([0.5 * side; 3]).radius(15.0).mass(1e3));
    }
    let dust = Spheres::random(40_000).radius(0.05).mass(1e-2).temperature(1.0).seed(1);
    scene.spheres(dust).build()
}
