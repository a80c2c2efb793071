//! Frames: scenes far from their origin, or in units far from their own sizes, give
//! what they give near it and in their own units.

use carom::contact::Surface;
use carom::engine::{Compiled, Event, EventDriven, Partner, Stepped};
use carom::real::Real;
use carom::scene::{Scene, SceneBuilder, Sphere, Spheres};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, FixedSphere, Plane};

/// A change of units, by powers of two.
#[derive(Clone, Copy)]
struct Units {
    length: i32,
    time: i32,
    mass: i32,
}

impl Units {
    const OWN: Self = Self { length: 0, time: 0, mass: 0 };

    fn length(self, value: f64) -> f64 {
        value * 2.0_f64.powi(self.length)
    }

    fn speed(self, value: f64) -> f64 {
        value * 2.0_f64.powi(self.length - self.time)
    }

    fn time(self, value: f64) -> f64 {
        value * 2.0_f64.powi(self.time)
    }
}

/// Rough balls of several sizes in a container with a fixed ball, in gravity.
fn gas<T: Real>(units: Units, periodic: bool) -> SceneBuilder<T> {
    let t = T::from_f64;
    let length = |value: f64| t(units.length(value));
    let mut builder = Scene::<T>::builder()
        .surface(Surface::Rough)
        .dt(units.time(1.0 / 64.0))
        .surroundings(FixedSphere::solid([length(4.0); 3], length(1.0)));
    builder = if periodic {
        builder.periodic(PeriodicBox::new([length(0.0); 3], [length(8.0); 3]))
    } else {
        let fall = t(-units.speed(1.0) * 2.0_f64.powi(-units.time));
        builder
            .gravity([T::ZERO, T::ZERO, fall])
            .surroundings(Cuboid::container([length(0.0); 3], [length(8.0); 3]))
    };
    let placed = gas_in_own_units();
    for (k, (position, velocity)) in placed.into_iter().enumerate() {
        let sphere = Sphere::new(position.map(|x| units.length(x)))
            .velocity(velocity.map(|v| units.speed(v)))
            .spin([0.5, -0.25, 1.0].map(|w| w * 2.0_f64.powi(-units.time)))
            .radius(units.length(if k % 2 == 0 { 0.5 } else { 0.25 }))
            .mass((if k % 2 == 0 { 1.0 } else { 0.125 }) * 2.0_f64.powi(units.mass));
        builder = builder.sphere(sphere);
    }
    builder
}

/// Centres and velocities that single precision holds exactly.
fn gas_in_own_units() -> Vec<([f64; 3], [f64; 3])> {
    let spheres = Spheres::random(40).radius(0.5).temperature(1.0).within([0.0; 3], [8.0; 3]);
    let container = FixedSphere::solid([4.0; 3], 1.0);
    let scene = Scene::<f32>::builder().surroundings(container).spheres(spheres).build().unwrap();
    let numbers = |v: carom::Vec3<f32>| v.to_array().map(f64::from);
    (0..scene.bodies.len())
        .map(|k| (numbers(scene.bodies.position_of(k)), numbers(scene.bodies.velocity_of(k))))
        .collect()
}

/// All that an engine gives, as bits, in units of its own.
fn events<T: Compiled>(scene: Scene<T>, units: Units, stepped: bool) -> Vec<[u64; 12]> {
    let mut rows = Vec::new();
    let mut listener = |event: &Event<T>| {
        let [length, speed] = [-units.length, units.time - units.length];
        let real = |value: T, exponent: i32| (value.to_f64() * 2.0_f64.powi(exponent)).to_bits();
        let [x, y, z] = event.point.to_array().map(|x| real(x, length));
        let [u, v, w] = event.velocity.to_array().map(|x| real(x, speed));
        let [p, q, r] = event.spin.to_array().map(|x| real(x, units.time));
        let time = (event.time * 2.0_f64.powi(-units.time)).to_bits();
        let partner = match event.partner {
            Partner::Body { index, .. } => u64::from(index),
            Partner::Surroundings(part) => 1_000 + u64::from(part),
            _ => unreachable!(),
        };
        let impulse = real(event.normal_impulse, speed - units.mass);
        rows.push([time, u64::from(event.a), partner, x, y, z, u, v, w, p ^ q, r, impulse]);
    };
    let duration = units.time(4.0);
    if stepped {
        Stepped::new(scene).unwrap().for_each_event(duration, &mut listener).unwrap();
    } else {
        EventDriven::new(scene).unwrap().for_each_event(duration, &mut listener).unwrap();
    }
    rows
}

/// Other units change no bit.
fn units_change_nothing<T: Compiled>(largest: i32) {
    for stepped in [false, true] {
        for periodic in [false, true] {
            let own = events(gas::<T>(Units::OWN, periodic).build().unwrap(), Units::OWN, stepped);
            assert!(own.len() > 20, "{} events", own.len());
            for length in [-largest, -largest / 2, largest / 2, largest] {
                for (time, mass) in [(0, 0), (length, 0), (length / 2, length / 2)] {
                    let units = Units { length, time, mass };
                    let scene = gas::<T>(units, periodic).build().unwrap();
                    let other = events(scene, units, stepped);
                    assert_eq!(
                        own, other,
                        "2^{length} length, 2^{time} time, {stepped} {periodic}"
                    );
                }
            }
        }
    }
}

#[test]
fn units_of_single_precision() {
    // A moment of inertia m r² has to be a number.
    units_change_nothing::<f32>(38);
}

#[test]
fn units_of_double_precision() {
    units_change_nothing::<f64>(320);
}

/// A ball over a floor far from the origin bounces as it does near it.
fn far_bounces<T: Compiled>(height: f64) {
    let fall = |floor: f64| {
        let t = T::from_f64;
        Scene::<T>::builder()
            .gravity([T::ZERO, t(-9.81), T::ZERO])
            .dt(1e-3)
            .surroundings(Plane::new([T::ZERO, t(floor), T::ZERO], [T::ZERO, T::ONE, T::ZERO]))
            .sphere(Sphere::new([0.0, floor + 1.5, 0.0]).radius(0.5))
            .build()
            .unwrap()
    };
    let ends = |floor: f64| {
        let mut stepped = Stepped::new(fall(floor)).unwrap();
        let mut event_driven = EventDriven::new(fall(floor)).unwrap();
        stepped.advance(10.0).unwrap();
        event_driven.advance(10.0).unwrap();
        assert_eq!(stepped.collisions(), event_driven.collisions());
        [stepped.bodies(), event_driven.bodies()].map(|bodies| {
            (bodies.position_of(0).y.to_f64() - floor, bodies.velocity_of(0).y.to_f64())
        })
    };
    let near = ends(0.0);
    let far = ends(height);
    for ((near_height, near_speed), (far_height, far_speed)) in near.into_iter().zip(far) {
        assert_eq!(near_speed.to_bits(), far_speed.to_bits());
        // Rounded to the digits that there are.
        assert!((near_height - far_height).abs() <= height * T::EPSILON.to_f64());
    }
}

#[test]
fn far_from_the_origin() {
    for height in [1024.0, 586_507.0, 8_388_000.0] {
        far_bounces::<f32>(height);
        far_bounces::<f64>(height);
    }
    far_bounces::<f64>(1e12);
}
