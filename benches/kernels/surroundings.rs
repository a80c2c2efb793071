//! Clearance of spheres from every shape.

use carom::lane::Lane;
use carom::real::Real;
use carom::surroundings::{Cuboid, Feature, FixedSphere, Plane};
use carom::vec3::Vec3;
use criterion::Criterion;

use crate::IN_CACHE;
use crate::columns::uniform;
use crate::formula::{Formula, measure};

/// All benches of this file.
pub fn benches<T: Real>(criterion: &mut Criterion) {
    let number = T::whole;
    let normal = Vec3::new(T::ZERO, T::ZERO, T::ONE);
    let features = [
        ("plane", Feature::Plane(Plane { point: Vec3::ZERO, normal })),
        ("box", Feature::Cuboid(Cuboid::solid([number(-2); 3], [number(2); 3]))),
        ("sphere", Feature::FixedSphere(FixedSphere::solid([T::ZERO; 3], number(2)))),
        ("spherical container", {
            Feature::FixedSphere(FixedSphere::container([T::ZERO; 3], number(20)))
        }),
    ];
    let centers = uniform::<T, 3>(IN_CACHE, -10.0, 10.0, 8);
    for (shape, feature) in features {
        measure(criterion, &format!("clearance/{shape}"), &centers, &ClearanceFrom(feature));
    }
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
