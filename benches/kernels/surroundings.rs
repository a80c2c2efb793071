//! Clearance of spheres from every shape, in every lane width, and the times of their
//! contacts, on straight paths and on parabolas, one by one.

use core::hint::black_box;

use carom::lane::Lane;
use carom::real::Real;
use carom::surroundings::{
    Capsule, Cone, Cuboid, Cylinder, Disc, Feature, FixedSphere, Hull, Plane, Revolved, Shape,
    Torus, Triangle, Tube,
};
use carom::vec3::Vec3;
use criterion::{Criterion, Throughput};

use crate::IN_CACHE;
use crate::columns::uniform;
use crate::formula::{Formula, measure};

/// All benches of this file.
pub fn benches<T: Real>(criterion: &mut Criterion) {
    let centers = uniform::<T, 3>(IN_CACHE, -10.0, 10.0, 8);
    let velocities = uniform::<T, 3>(IN_CACHE, -1.0, 1.0, 9);
    let flights: Vec<_> = (0..IN_CACHE)
        .map(|k| {
            let at = |columns: &[_; 3]| -> Vec3<T> {
                columns.each_ref().map(|column: &carom::column::Column<T>| column[k]).into()
            };
            let (center, toss) = (at(&centers), at(&velocities));
            // Every other one is aimed at the shape.
            let aim = if k % 2 == 0 { center * T::ratio(-1, 5) } else { Vec3::ZERO };
            (center, toss + aim)
        })
        .collect();
    for (name, shape) in shapes::<T>() {
        let features = shape.features();
        measure(
            criterion,
            &format!("clearance/{name}"),
            &centers,
            &ClearanceFrom(features[0].clone()),
        );
        let mut group = criterion.benchmark_group(format!("contact time/{name}/{}", T::NAME));
        group.throughput(Throughput::Elements(IN_CACHE as u64));
        let down = Vec3::new(T::ZERO, T::ZERO, -T::ONE);
        for (path, field) in [("straight", None), ("parabola", Some(down))] {
            group.bench_function(path, |bencher| {
                bencher.iter(|| {
                    for &(center, velocity) in &flights {
                        for feature in &features {
                            let (center, radius) = (black_box(center), T::ratio(1, 2));
                            black_box(feature.contact_time(center, velocity, field, radius, false));
                        }
                    }
                });
            });
        }
        group.finish();
    }
}

/// Every shape, about the origin.
fn shapes<T: Real>() -> Vec<(&'static str, Shape<T>)> {
    let number = T::whole;
    let (zero, one, two) = (T::ZERO, T::ONE, number(2));
    let (origin, up) = ([zero; 3], [zero, zero, one]);
    let tilted = [one, two, two];
    let corner =
        |k: usize| core::array::from_fn(|axis| if k >> axis & 1 == 0 { -two } else { two });
    let spool = [[0, -2], [2, -2], [1, 0], [2, 2], [0, 1]];
    let hopper = [[1, -3], [1, -2], [3, 1], [3, 3]];
    let profile = |places: &[[i32; 2]]| -> Vec<[T; 2]> {
        places.iter().map(|place| place.map(number)).collect()
    };
    vec![
        ("plane", Plane::new(origin, up).into()),
        ("box", Cuboid::solid([-two; 3], [two; 3]).into()),
        ("turned box", Shape::from(Cuboid::solid([-two; 3], [two; 3])).turned(tilted, one)),
        ("box as a hull", Hull::new((0..8).map(corner)).into()),
        ("sphere", FixedSphere::solid(origin, two).into()),
        ("spherical container", FixedSphere::container(origin, number(20)).into()),
        ("triangle", Triangle::new([-two, zero, zero], [two, one, zero], [zero, zero, two]).into()),
        ("capsule", Capsule::solid([-two; 3], [two; 3], one).into()),
        ("cylinder", Cylinder::solid(origin, tilted, two, Some(number(4))).into()),
        ("cylinder as a profile", {
            Revolved::solid(origin, tilted, profile(&[[0, -2], [2, -2], [2, 2], [0, 2]])).into()
        }),
        ("cone", Cone::solid([zero, zero, -two], up, number(4), [two, zero]).into()),
        ("disc", Disc::new(origin, tilted, two, zero).into()),
        ("annulus", Disc::new(origin, tilted, two, one).into()),
        ("tube", Tube::new([zero, zero, -two], up, number(4), [two, two]).into()),
        ("hopper", Revolved::thin(origin, up, profile(&hopper)).into()),
        ("spool", Revolved::solid(origin, up, profile(&spool)).into()),
        ("torus", Torus::solid(origin, up, two, one).into()),
    ]
}

/// Gap and arm of spheres of radius 1.
struct ClearanceFrom<T>(Feature<T>);

impl<T: Real> Formula<T, 3, 4> for ClearanceFrom<T> {
    #[inline(always)]
    fn of<L: Lane<Scalar = T>>(&self, center: [L; 3]) -> [L; 4] {
        let clearance = self.0.clearance(Vec3::from(center), L::ONE);
        let [x, y, z] = clearance.arm.to_array();
        [clearance.gap, x, y, z]
    }
}
