//! Balls on a line: Galperin's billiard, cradles, rods.

use carom::engine::Compiled;
use carom::real::Real;
use carom::scene::{Buildable, Scene, Sphere};
use carom::surroundings::Plane;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::common::known::{CRADLES, Cradle};
use crate::{builder, t3, world};

/// Collisions in all of a ball at rest between a wall and a ball `ratio` times
/// as heavy that comes in.
fn collisions<T: Compiled>(ratio: f64) -> u64 {
    let ball = |x: f64| Sphere::new([x, 0.0, 0.0]).radius(0.0625);
    let scene = builder::<T>()
        .surroundings(Plane::new(t3([0.0; 3]), t3([1.0, 0.0, 0.0])))
        .sphere(ball(1.0))
        .sphere(ball(5.0).mass(ratio).velocity([-1.0, 0.0, 0.0]));
    let mut world = world(scene.build().unwrap());
    world.advance(400.0).unwrap();
    world.collisions().total()
}

/// `⌊π 10^k⌋` for masses of 1 and 100^k.
#[test]
fn galperin_finds_the_digits_of_pi() {
    for k in 0..=6 {
        let ratio = 100.0_f64.powi(k);
        let exact = (core::f64::consts::PI * 10.0_f64.powi(k)).floor() as u64;
        assert_eq!(collisions::<f64>(ratio), exact, "f64, k = {k}");
        if k <= 4 {
            assert_eq!(collisions::<f32>(ratio), exact, "f32, k = {k}");
        }
    }
}

#[test]
fn galperin_with_other_masses() {
    let cases = [
        (2.0, 5),
        (3.0, 5),
        (4.0, 6),
        (5.0, 7),
        (7.0, 8),
        (10.0, 10),
        (16.0, 12),
        (1000.0, 99),
        (1e5, 993),
    ];
    for (ratio, exact) in cases {
        assert_eq!(collisions::<f64>(ratio), exact, "f64, {ratio}");
        assert_eq!(collisions::<f32>(ratio), exact, "f32, {ratio}");
    }
}

/// Cradles, touching or not, pairwise in order.
#[test]
fn cradles() {
    fn cradle<T: Compiled>(cradle: Cradle, gap: f64) {
        let (masses, before, after, collisions) = cradle;
        let mut builder = builder::<T>();
        for (k, (mass, velocity)) in masses.iter().zip(before).enumerate() {
            let sphere = Sphere::new([k as f64 * (1.0 + gap), 0.0, 0.0]).radius(0.5);
            builder = builder.sphere(sphere.mass(*mass).velocity([*velocity, 0.0, 0.0]));
        }
        let mut world = world(builder.build().unwrap());
        world.advance(16.0).unwrap();
        assert_eq!(world.collisions().pairs, collisions, "{masses:?} {gap} {}", T::NAME);
        for (k, exact) in after.iter().enumerate() {
            let error = (world.bodies().velocity_of(k).x.to_f64() - exact).abs();
            assert!(error <= 4.0 * T::EPSILON.to_f64(), "{masses:?} {gap}: {error:e}");
        }
    }
    for gap in [0.0, 0.1, 0.5] {
        for case in CRADLES {
            cradle::<f32>(case, gap);
            cradle::<f64>(case, gap);
        }
    }
}

/// Rods of length 1 on a line between two walls.
struct Rods {
    length: f64,
    position: Vec<f64>,
    velocity: Vec<f64>,
}

impl Rods {
    /// Rods at random places, with as much free length as they have.
    fn new<T: Real>(count: usize) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(12);
        let free = count as f64;
        let mut reduced: Vec<f64> = (0..count).map(|_| random.random_range(0.0..free)).collect();
        reduced.sort_by(f64::total_cmp);
        let rounded = |value: f64| T::from_f64(value).to_f64();
        Self {
            length: free + count as f64,
            position: (0..count).map(|k| rounded(reduced[k] + k as f64 + 0.5)).collect(),
            velocity: (0..count).map(|_| rounded(random.random_range(-1.0..1.0))).collect(),
        }
    }

    fn scene<T: Buildable>(&self) -> Scene<T> {
        let mut builder = builder::<T>()
            .surroundings(Plane::new(t3([0.0; 3]), t3([1.0, 0.0, 0.0])))
            .surroundings(Plane::new(t3([self.length, 0.0, 0.0]), t3([-1.0, 0.0, 0.0])));
        for (&x, &v) in self.position.iter().zip(&self.velocity) {
            let sphere = Sphere::new([x, 0.0, 0.0]).radius(0.5);
            builder = builder.sphere(sphere.velocity([v, 0.0, 0.0]));
        }
        builder.build().unwrap()
    }

    /// The rods as points that pass through each other.
    fn reduced(&self) -> Vec<[f64; 2]> {
        let points = self.position.iter().zip(&self.velocity).enumerate();
        points.map(|(k, (x, v))| [x - (k as f64 + 0.5), *v]).collect()
    }

    /// Where the rods are at a time: points, folded into the free length and
    /// sorted.
    fn at(&self, time: f64) -> Vec<f64> {
        let free = self.length - self.position.len() as f64;
        let fold = |x: f64| {
            let x = x.rem_euclid(2.0 * free);
            x.min(2.0 * free - x)
        };
        let mut points: Vec<f64> = self.reduced().iter().map(|[x, v]| fold(x + v * time)).collect();
        points.sort_by(f64::total_cmp);
        points.iter().enumerate().map(|(k, x)| x + k as f64 + 0.5).collect()
    }

    /// Contacts of pairs and with the walls up to a time: how often the sums,
    /// the differences and the places of points pass a multiple of what space
    /// folds to.
    fn contacts(&self, time: f64) -> [u64; 2] {
        let free = self.length - self.position.len() as f64;
        let passes = |x: f64, v: f64, period: f64| {
            (((x + v * time) / period).floor() - (x / period).floor()).abs() as u64
        };
        let points = self.reduced();
        let mut contacts = [0, 0];
        for (k, [x, v]) in points.iter().enumerate() {
            contacts[1] += passes(*x, *v, free);
            for [y, w] in &points[..k] {
                contacts[0] += passes(x - y, v - w, 2.0 * free) + passes(x + y, v + w, 2.0 * free);
            }
        }
        contacts
    }
}

/// Equal balls on a line exchange velocities: any number of collisions has a
/// closed form.
#[test]
fn rods() {
    fn error<T: Compiled>(count: usize, time: f64) -> f64 {
        let rods = Rods::new::<T>(count);
        let mut world = world(rods.scene::<T>());
        world.advance(time).unwrap();
        let found = world.collisions();
        let [pairs, walls] = rods.contacts(time);
        // In f32 some contact may be on the other side of the end.
        if T::NAME == "f64" {
            assert_eq!([found.pairs, found.surroundings], [pairs, walls]);
        }
        let bodies = world.bodies();
        let errors = rods.at(time).into_iter().enumerate();
        let errors = errors.map(|(k, exact)| (bodies.position_of(k).x.to_f64() - exact).abs());
        println!("{count} {}: {found:?}", T::NAME);
        errors.fold(0.0, f64::max) / (rods.length * T::EPSILON.to_f64())
    }
    for (count, time) in [(12, 256.0), (10_000, 32.0)] {
        let (single, double) = (error::<f32>(count, time), error::<f64>(count, time));
        println!("{count} rods: f32 {single:.1} εL, f64 {double:.1} εL");
        assert!(single < 200.0 && double < 200.0, "{count}: {single} {double}");
    }
}
