//! The formulas of carom on a program's own arrays, without a scene or an
//! engine:
//!
//! ```sh
//! cargo run --release --example own_arrays
//! ```

use carom::Vec3;
use carom::contact::{Party, Rough, Smooth, collide};
use carom::motion::flight::flight;
use carom::motion::integrator::VelocityVerlet;
use carom::space::OpenSpace;
use wide::f64x4;

fn main() {
    // Ten balls in a row, thrown up at speeds from 0 to 9.
    let mut position = [core::array::from_fn(|k| 2.0 * k as f64), [0.0; 10], [0.5; 10]];
    let mut velocity = [[0.0; 10], [0.0; 10], core::array::from_fn(|k| k as f64)];
    let gravity = Vec3::new(0.0, 0.0, -10.0);

    // A tenth of a second: four at a time, and the last two one by one.
    flight::<f64x4, VelocityVerlet, _>(
        position.each_mut().map(|column| column.as_mut_slice()),
        velocity.each_mut().map(|column| column.as_mut_slice()),
        gravity,
        0.1,
        OpenSpace,
    );
    println!("heights after 0.1: {:.3?}", position[2]);

    // Four rough collisions at once: the same ball comes down on the floor
    // with four different spins.
    let falling = Party {
        velocity: Vec3::splat(Vec3::new(1.0, 0.0, -2.0)),
        spin: Vec3::new(f64x4::splat(0.0), f64x4::new([-4.0, 0.0, 2.0, 4.0]), f64x4::splat(0.0)),
        inverse_mass: f64x4::splat(1.0),
        inverse_inertia: f64x4::splat(10.0),
        share: f64x4::splat(1.0),
    };
    let from_contact_to_center = Vec3::splat(Vec3::new(0.0, 0.0, 0.5));
    for is_rough in [false, true] {
        let (mut ball, mut floor) = (falling, Party::immovable());
        let impulse = if is_rough {
            collide(Rough, from_contact_to_center, &mut ball, &mut floor)
        } else {
            collide(Smooth, from_contact_to_center, &mut ball, &mut floor)
        };
        println!("{}:", if is_rough { "rough" } else { "smooth" });
        println!("  spins before     {:.3?}", falling.spin.y.to_array());
        println!("  spins after      {:.3?}", ball.spin.y.to_array());
        println!("  velocities after {:.3?}", ball.velocity.x.to_array());
        println!("  normal impulses  {:.3?}", impulse.normal.z.to_array());
    }
}
