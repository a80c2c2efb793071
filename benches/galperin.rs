//! Galperin's billiard: the digits of π, counted in collisions, in f64.
//!
//! `cargo bench --bench galperin -- [most]`: a ball 100ᵏ times as heavy as
//! another drives it against a wall, for k from 0 to `most`, which is 7 if it is
//! not given; 8 is 314,159,265 collisions.

use std::error::Error;
use std::time::Instant;

use carom::engine::EventDriven;
use carom::scene::{Scene, Sphere};
use carom::surroundings::Plane;

fn main() -> Result<(), Box<dyn Error>> {
    let given = std::env::args().skip(1).find_map(|argument| argument.parse().ok());
    let most: i32 = given.unwrap_or(7);
    println!("| k | collisions | ⌊π·10ᵏ⌋ | seconds |\n|--:|--:|--:|--:|");
    for k in 0..=most {
        let start = Instant::now();
        let counted = collisions(100.0_f64.powi(k))?;
        let exact = (core::f64::consts::PI * 10.0_f64.powi(k)).floor();
        println!("| {k} | {counted} | {exact} | {:.2} |", start.elapsed().as_secs_f64());
    }
    Ok(())
}

/// The collisions of a billiard of this ratio of masses.
fn collisions(ratio: f64) -> Result<u64, Box<dyn Error>> {
    let light = Sphere::new([1.0, 0.0, 0.0]).radius(0.25).mass(1.0);
    let heavy = Sphere::new([4.0, 0.0, 0.0]).radius(0.25).mass(ratio);
    let scene = Scene::<f64>::builder()
        .surroundings(Plane::new([0.0; 3], [1.0, 0.0, 0.0]))
        .sphere(light)
        .sphere(heavy.velocity([-1.0, 0.0, 0.0]))
        .build()?;
    let mut world = EventDriven::new(scene)?;
    world.advance(10.0)?;
    Ok(world.collisions().total())
}
