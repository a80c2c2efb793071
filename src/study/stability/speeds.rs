//! Speeds from 10⁻¹² to 10¹².

use super::case::{
    Case, Extent, Findings, Random, Studied, Trial, greatest, in_epsilon, t3, trial,
};
use super::{Figure, StudyError, pair};
use crate::bodies::Bodies;
use crate::contact::Surface;
use crate::engine::EventDriven;
use crate::scene::{Scene, Spheres};
use crate::study::table::power_of_ten;
use crate::surroundings::Cuboid;

pub(super) const CASE: Case = Case {
    name: "speed",
    title: "speeds from 10⁻¹² to 10¹²",
    law: "No speed is special: with velocities, spins and 1/t multiplied by a power of 2, and g by its \
          square, every bit of the places and velocities is the same, but for the factor. Two that \
          meet, one at 10¹² and one at 10⁻¹², part right to a few ε of the greater.",
    trials,
    combine: Findings::joined,
    picture: None,
};

fn trials(extent: Extent) -> Vec<Trial> {
    let (pairs, collisions) = extent.of((20_000, 200_000), (500, 5_000));
    let mut trials = vec![two::<f32>(pairs), two::<f64>(pairs)];
    // 2^±40 is about 10^±12.
    // g goes with the square: its own square is out of the range of f32 sooner.
    for (power, gravity) in [(-40, 0.0), (-20, 0.0), (20, 0.0), (40, 0.0), (-20, 0.5), (20, 0.5)] {
        for surface in [Surface::Smooth, Surface::Rough] {
            trials.push(scaled::<f32>(power, surface, gravity, collisions));
            trials.push(scaled::<f64>(power, surface, gravity, collisions));
        }
    }
    trials
}

fn scaled<T: Studied>(power: i32, surface: Surface, gravity: f64, collisions: u64) -> Trial {
    let decade = (f64::from(power) * 2.0_f64.log10()).round() as i32;
    let field = if gravity > 0.0 { " and falling" } else { "" };
    let key = format!("{surface}{field}, times {}", power_of_ten(decade));
    trial::<T, _>(key.clone(), 4e-6 * collisions as f64, move || {
        let one = run::<T>(surface, gravity, 0, collisions)?;
        let other = run::<T>(surface, gravity, power, collisions)?;
        let factor = T::from_f64(2.0_f64.powi(power));
        let differs = (0..one.len()).filter(|&k| {
            let is_same = one.position_of(k) == other.position_of(k)
                && one.velocity_of(k) * factor == other.velocity_of(k)
                && one.spin_of(k) * factor == other.spin_of(k);
            !is_same
        });
        let name = format!("bodies that differ, {key}");
        Ok(vec![Figure::equal(T::PRECISION, name, differs.count() as f64, 0.0, "")])
    })
}

/// A gas at speeds of 2^power after a number of collisions.
fn run<T: Studied>(
    surface: Surface,
    gravity: f64,
    power: i32,
    collisions: u64,
) -> Result<Bodies<T>, StudyError> {
    let spheres = Spheres::random(100).radius(0.5).temperature(1.0).spin_temperature(1.0);
    let plain = Scene::<T>::builder()
        .surroundings(Cuboid::container(t3([0.0; 3]), t3([6.0; 3])))
        .spheres(spheres);
    let factor = T::from_f64(2.0_f64.powi(power));
    let mut bodies = plain.build()?.bodies;
    bodies.scale_motion(factor);
    let scene = Scene::<T>::builder()
        .surface(surface)
        .gravity(t3([0.0, 0.0, -gravity * 4.0_f64.powi(power)]))
        .surroundings(Cuboid::container(t3([0.0; 3]), t3([6.0; 3])))
        .bodies(bodies);
    let mut world = EventDriven::new(scene.build()?)?;
    world.advance_until(collisions, 1e6 * 2.0_f64.powi(-power))?;
    // To a time when nothing happens.
    world.advance(2.0_f64.powi(-power - 10))?;
    Ok(world.bodies())
}

fn two<T: Studied>(pairs: u64) -> Trial {
    trial::<T, _>("one fast, one slow", 1e-4 * pairs as f64, move || {
        let mut random = Random(3);
        let mut worst: f64 = 0.0;
        for k in 0..pairs {
            let surface = [Surface::Smooth, Surface::Rough][k as usize % 2];
            let aim = 0.7 * random.unit();
            let mut balls = pair::meeting(&mut random, [0.5; 2], [1.0, 2.0], aim);
            balls[0].velocity = balls[0].velocity * 1e12;
            balls[0].spin = balls[0].spin * 1e12;
            balls[1].velocity = random.direction() * 1e-12;
            balls[1].spin = balls[1].spin * 1e-12;
            if let Some((off, _)) = pair::measured::<T>(&balls, surface, 1e-11)? {
                worst = greatest([worst, greatest(off) * 1e-12]);
            }
        }
        let name = "10¹² meets 10⁻¹²";
        Ok(vec![Figure::at_most(T::PRECISION, name, in_epsilon::<T>(worst), 16.0, "ε")])
    })
}
