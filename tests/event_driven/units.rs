//! Units: a scene in other units of length, time and mass, powers of two, is the
//! same scene, bit by bit.

use carom::contact::Surface;
use carom::engine::{Compiled, Partner};
use carom::scene::{Scene, Sphere};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, FixedSphere};

use crate::{builder, events, t3, world};

/// Twenty spheres that fall among solids, or fly in a periodic box.
fn scene<T: Compiled>(is_periodic: bool, length: f64, time: f64, mass: f64) -> Scene<T> {
    let lengths = |vector: [f64; 3]| t3::<T>(vector.map(|x| x * length));
    let mut builder = builder::<T>().surface(Surface::Rough);
    if is_periodic {
        builder = builder.periodic(PeriodicBox::new(lengths([0.0; 3]), lengths([5.0; 3])));
    } else {
        builder = builder
            .gravity(t3([0.0, 0.0, -length / (time * time)]))
            .surroundings(Cuboid::container(lengths([0.0; 3]), lengths([5.0; 3])))
            .surroundings(FixedSphere::solid(lengths([2.5; 3]), T::from_f64(0.5 * length)));
    }
    for k in 0..20_u32 {
        let site = [k % 4, k / 4 % 4, k / 16 * 3].map(|k| f64::from(k) * 1.2 + 0.7);
        let turn = |a: u32| f64::from((k * a + 3) % 17) / 8.0 - 1.0;
        let sphere = Sphere::new(site.map(|x| x * length))
            .radius((0.3 + 0.01 * f64::from(k)) * length)
            .mass((1.0 + 0.1 * f64::from(k)) * mass)
            .velocity([turn(5), turn(7), turn(11)].map(|v| v * (length / time)))
            .spin([turn(3), turn(4), turn(6)].map(|w| w / time));
        builder = builder.sphere(sphere);
    }
    builder.build().unwrap()
}

#[test]
fn units_change_no_bit() {
    fn no_bit<T: Compiled>(exponents: &[[i32; 3]]) {
        for is_periodic in [false, true] {
            let expected = events(&mut world(scene::<T>(is_periodic, 1.0, 1.0, 1.0)), 16.0);
            assert!(expected.len() > 50, "{} events", expected.len());
            for &exponents in exponents {
                let [length, time, mass] = exponents.map(|k| 2.0_f64.powi(k));
                let scene = scene::<T>(is_periodic, length, time, mass);
                let found = events(&mut world(scene), 16.0 * time);
                assert_eq!(found.len(), expected.len(), "{} {exponents:?}", T::NAME);
                for (found, expected) in found.iter().zip(&expected) {
                    assert_eq!(found.time, expected.time * time);
                    let speed = T::from_f64(length / time);
                    assert_eq!(found.velocity, expected.velocity * speed);
                    assert_eq!(found.spin, expected.spin * T::from_f64(1.0 / time));
                    let with = |partner| match partner {
                        Partner::Body { index, .. } => (true, index),
                        Partner::Surroundings(part) => (false, part),
                        other => panic!("{other:?}"),
                    };
                    assert_eq!(
                        (found.a, with(found.partner)),
                        (expected.a, with(expected.partner))
                    );
                }
            }
        }
    }
    let modest =
        [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-10, -5, 3], [7, 13, -20], [20, 5, 0], [0, -18, 0]];
    no_bit::<f32>(&modest);
    no_bit::<f64>(&modest);
    let wide = [[60, 0, 0], [-60, 0, 0], [0, 60, 0], [0, -60, 0], [-33, -50, -90], [50, 70, 99]];
    no_bit::<f64>(&wide);
}
