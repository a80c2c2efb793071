//! The laws of energy and momentum, time turned back, and no overlaps.

use carom::bodies::Bodies;
use carom::contact::Surface;
use carom::engine::Compiled;
use carom::observe::{AngularMomentum, Energy, Momentum, fall_energy, total_mass};
use carom::real::Real;
use carom::scene::{SceneBuilder, Spheres};
use carom::space::{PeriodicBox, Space};
use carom::surroundings::{Cuboid, FixedSphere};

use crate::{builder, t3, world};

const SURFACES: [Surface; 2] = [Surface::Smooth, Surface::Rough];

/// A crowd of spheres, all alike or of many sizes.
fn crowd(count: u64, is_mixed: bool) -> Spheres {
    let crowd = Spheres::random(count).temperature(1.0).spin_temperature(1.0).seed(11);
    if is_mixed { crowd.radius(0.1..=0.6).density(1.0..=2.0) } else { crowd.radius(0.5) }
}

/// Crowds in open space, a periodic box, and among solids under gravity.
fn crowds<T: Real>(surface: Surface, is_mixed: bool) -> [SceneBuilder<T>; 3] {
    let builder = || builder::<T>().surface(surface);
    let crowd = crowd(300, is_mixed);
    [
        builder().spheres(crowd.clone().within([0.0; 3], [8.5; 3])),
        builder().periodic(PeriodicBox::new(t3([0.0; 3]), t3([8.5; 3]))).spheres(crowd.clone()),
        builder()
            .gravity(t3([0.5, 0.0, -2.0]))
            .surroundings(Cuboid::container(t3([0.0; 3]), t3([10.0; 3])))
            .surroundings(FixedSphere::solid(t3([5.0; 3]), T::from_f64(1.5)))
            .spheres(crowd),
    ]
}

/// The greatest change of the totals, in ε of what they are sums of.
fn drift<T: Compiled>(scene: SceneBuilder<T>, collisions: u64, longest: f64) -> [f64; 3] {
    let scene = scene.build().unwrap();
    let is_periodic = scene.periodic.is_some();
    let is_walled = !scene.surroundings.is_empty();
    let (gravity, before) = (scene.gravity, scene.bodies.clone());
    let fall = fall_energy(&scene);
    let mut world = world(scene);
    world.advance_until(collisions, longest).unwrap();
    let after = world.bodies();
    let [first, last] = [&before, &after].map(|bodies| Energy::of(bodies, gravity));
    let energy = last.relative_change(&first, fall).abs();
    let speed = (2.0 * Energy::of(&before, gravity).kinetic() / total_mass(&before)).sqrt();
    let scale = total_mass(&before) * speed;
    let mut momentum = (Momentum::of(&after).0 - Momentum::of(&before).0).length() / scale;
    if is_walled {
        // What the bodies gain is what gravity and the surroundings gave them.
        let gained = (Momentum::of(&after).0 - Momentum::of(&before).0).to_array();
        let walls = world.impulse_from_surroundings();
        momentum = 0.0;
        for axis in 0..3 {
            let field = gravity.to_array()[axis].to_f64() * total_mass(&before) * world.time();
            momentum = (gained[axis] - walls[axis] - field).abs().max(momentum);
        }
        momentum /= scale + 2.0 * total_mass(&before) * world.time();
    }
    let turned = AngularMomentum::of(&after).0 - AngularMomentum::of(&before).0;
    // In a box there is no angular momentum to keep.
    let has_walls = is_periodic || is_walled;
    let angular = if has_walls { 0.0 } else { turned.length() / (scale * 8.5) };
    [energy, momentum, angular].map(|error| error / T::EPSILON.to_f64())
}

/// Energy, momentum and angular momentum stay, to the rounding of one sum.
#[test]
fn totals_are_kept() {
    fn totals<T: Compiled>() {
        for surface in SURFACES {
            for is_mixed in [false, true] {
                for (scene, kind) in
                    crowds::<T>(surface, is_mixed).into_iter().zip(["open", "periodic", "walls"])
                {
                    let [energy, momentum, angular] = drift(scene, 3_000, 4.0);
                    println!(
                        "{} {kind} {surface:?} {}: energy {energy:.1} ε, momentum {momentum:.1} ε, \
                         angular {angular:.1} ε",
                        T::NAME,
                        if is_mixed { "mixed" } else { "equal" }
                    );
                    assert!(energy < 50.0 && momentum < 50.0 && angular < 50.0);
                }
            }
        }
    }
    totals::<f32>();
    totals::<f64>();
}

/// A gas keeps its energy over many collisions.
#[test]
fn energy_over_a_million_collisions() {
    fn drift_of<T: Compiled>(surface: Surface) -> f64 {
        let gas = Spheres::fcc(1_000).radius(0.5).number_density(0.5).temperature(1.0);
        drift(builder::<T>().surface(surface).periodic_cube().spheres(gas), 1_000_000, 1e3)[0]
    }
    for surface in SURFACES {
        let (single, double) = (drift_of::<f32>(surface), drift_of::<f64>(surface));
        println!("{surface:?}: f32 {single:.1} ε, f64 {double:.1} ε");
        assert!(single < 1000.0 && double < 1000.0, "{single} {double}");
    }
}

/// Bodies with their motion reversed.
fn reversed<T: Compiled>(mut bodies: Bodies<T>) -> Bodies<T> {
    for column in bodies.velocity.iter_mut().chain(&mut bodies.spin) {
        column.iter_mut().for_each(|value| *value = -*value);
    }
    bodies
}

/// With all motion reversed a gas goes back to where it came from, as far as
/// rounding, which every collision enlarges, lets it.
#[test]
fn time_can_be_turned_back() {
    fn way_off<T: Compiled>(scene: SceneBuilder<T>, time: f64) -> f64 {
        let scene = scene.build().unwrap();
        let mut world = world(scene.clone());
        world.advance(time).unwrap();
        let there = world.bodies();
        let mut back = builder::<T>().surface(scene.surface).gravity(scene.gravity);
        if let Some(space) = scene.periodic {
            back = back.periodic(space);
        }
        for shape in scene.surroundings {
            back = back.surroundings(shape);
        }
        let mut world = crate::world(back.bodies(reversed(there)).build().unwrap());
        world.advance(time).unwrap();
        assert!(world.collisions().total() > 100, "{:?}", world.collisions());
        let end = world.bodies();
        let mut worst = 0.0_f64;
        for k in 0..end.len() {
            let off = end.position_of(k) - scene.bodies.position_of(k);
            let off = scene.periodic.map_or(off, |space| space.nearest(off)).length().to_f64();
            worst = worst.max(off);
        }
        worst / T::EPSILON.to_f64()
    }
    for surface in SURFACES {
        for is_mixed in [false, true] {
            // Small spheres scatter more: less time.
            let time = if is_mixed { 0.25 } else { 0.5 };
            let single = crowds::<f32>(surface, is_mixed).map(|scene| way_off(scene, time));
            let double = crowds::<f64>(surface, is_mixed).map(|scene| way_off(scene, time));
            println!("{surface:?} f32 {single:.0?} ε, f64 {double:.0?} ε");
            let worst = single.into_iter().chain(double).fold(0.0, f64::max);
            assert!(worst < 1e5, "{worst} ε");
        }
    }
}

/// Whenever one looks, no two bodies overlap by more than rounding, nor a body
/// and what is fixed.
#[test]
fn nothing_overlaps() {
    fn deepest<T: Compiled>(scene: SceneBuilder<T>) -> f64 {
        let scene = scene.build().unwrap();
        let features: Vec<_> =
            scene.surroundings.iter().flat_map(|shape| shape.features()).collect();
        let mut world = world(scene.clone());
        let mut least = T::ZERO;
        for look in 0..60 {
            if look % 2 == 0 {
                // Just after a collision: two are in contact.
                world.advance_until(17, 1.0).unwrap();
            } else {
                world.advance(0.0371).unwrap();
            }
            let bodies = world.bodies();
            for a in 0..bodies.len() {
                let (center, radius) = (bodies.position_of(a), bodies.radius.of(a));
                for feature in &features {
                    least = least.lesser(feature.clearance(center, radius).gap);
                }
                for b in 0..a {
                    let offset = center - bodies.position_of(b);
                    let offset = scene.periodic.map_or(offset, |space| space.nearest(offset));
                    least = least.lesser(offset.length() - radius - bodies.radius.of(b));
                }
            }
        }
        -least.to_f64() / T::EPSILON.to_f64() / 8.5
    }
    for surface in SURFACES {
        for is_mixed in [false, true] {
            let single = crowds::<f32>(surface, is_mixed).map(deepest);
            let double = crowds::<f64>(surface, is_mixed).map(deepest);
            println!("{surface:?}: f32 {single:.2?} εL, f64 {double:.2?} εL");
            let worst = single.into_iter().chain(double).fold(0.0, f64::max);
            assert!(worst < 4.0, "{worst} ε of the box");
        }
    }
}
