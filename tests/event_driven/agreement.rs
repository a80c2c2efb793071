//! The engine against the [reference](crate::reference) on random small scenes.
//! Not close to it: the same events, every bit of them.

use carom::contact::Surface;
use carom::engine::{EventDriven, Execution, Lanes};
use carom::real::Real;
use carom::scene::{Scene, Sphere};
use carom::surroundings::{Cuboid, Feature, FixedSphere, PeriodicBox, Plane, Shape};
use carom::vec3::Vec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::reference::Reference;
use crate::{builder, events, t3};

/// Where balls are put, and among what.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Open,
    Floor,
    Container,
    Solids,
    Hollow,
    Periodic,
    NarrowPeriodic,
    PeriodicSolids,
}

const KINDS: [Kind; 8] = [
    Kind::Open,
    Kind::Floor,
    Kind::Container,
    Kind::Solids,
    Kind::Hollow,
    Kind::Periodic,
    Kind::NarrowPeriodic,
    Kind::PeriodicSolids,
];

const LANES: [Lanes; 5] = [Lanes::Auto, Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen];

/// What is fixed in a space of these sides.
fn surroundings(kind: Kind, sides: [f64; 3], random: &mut ChaCha8Rng) -> Vec<Shape<f64>> {
    let part = |k: usize, share: f64| share * sides[k];
    let at = |share: f64| [part(0, share), part(1, share), part(2, share)];
    let solids = |random: &mut ChaCha8Rng| -> Vec<Shape<f64>> {
        let [low, high] = [random.random_range(0.1..0.3), random.random_range(0.32..0.45)];
        let corner = [part(0, low), part(1, 1.0 - high), part(2, low)];
        let opposite = [part(0, high), part(1, 1.0 - low), part(2, high)];
        let radius = random.random_range(0.05..0.2) * sides[0].min(sides[1]).min(sides[2]);
        let sphere = FixedSphere::solid([part(0, 0.7), part(1, 0.3), part(2, 0.6)], radius);
        vec![Cuboid::solid(corner, opposite).into(), sphere.into()]
    };
    let container = Cuboid::container([0.0; 3], sides).into();
    match kind {
        Kind::Open | Kind::Periodic | Kind::NarrowPeriodic => vec![],
        Kind::Floor => {
            let tilt = [random.random_range(-0.3..0.3), random.random_range(-0.3..0.3), 1.0];
            vec![Plane::new([0.0; 3], tilt).into()]
        }
        Kind::Container => vec![container],
        Kind::Solids => [vec![container], solids(random)].concat(),
        Kind::Hollow => {
            let radius = 0.6 * sides[0].max(sides[1]).max(sides[2]);
            vec![FixedSphere::container(at(0.5), radius).into()]
        }
        Kind::PeriodicSolids => solids(random),
    }
}

/// A random scene.
fn scene<T: Real>(kind: Kind, seed: u64) -> Scene<T> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let is_mixed = random.random_bool(0.5);
    let is_narrow = kind == Kind::NarrowPeriodic;
    let most = if is_narrow { 4 } else { 30 };
    let count = random.random_range(if is_narrow { 2..6 } else { 2..most + 1 });
    let sides: [f64; 3] = core::array::from_fn(|_| match kind {
        Kind::NarrowPeriodic => random.random_range(2.05..4.2),
        Kind::Periodic => random.random_range(3.0..8.0),
        Kind::PeriodicSolids => random.random_range(6.0..8.0),
        _ => random.random_range(4.0..8.0),
    });
    let is_periodic = matches!(kind, Kind::Periodic | Kind::NarrowPeriodic | Kind::PeriodicSolids);
    let has_field = kind == Kind::Floor || random.random_bool(0.4);
    let gravity = if has_field { [0.3, 0.0, -random.random_range(0.1..5.0)] } else { [0.0; 3] };
    let rough = random.random_bool(0.5);
    let shapes = surroundings(kind, sides, &mut random);
    let features: Vec<Feature<f64>> = shapes.iter().flat_map(Shape::features).collect();

    let mut builder = builder::<T>()
        .name(format!("{kind:?} {seed}"))
        .surface(if rough { Surface::Rough } else { Surface::Smooth })
        .gravity(t3(gravity));
    if is_periodic {
        builder = builder.periodic(PeriodicBox::new(t3([0.0; 3]), t3(sides)));
    }
    for shape in shapes {
        builder = match shape {
            Shape::Plane(Plane { point, normal }) => {
                builder.surroundings(Plane::new(t3(point.to_array()), t3(normal.to_array())))
            }
            Shape::Cuboid(cuboid) => builder.surroundings(Cuboid {
                lower: t3(cuboid.lower.to_array()).into(),
                upper: t3(cuboid.upper.to_array()).into(),
                inside: cuboid.inside,
            }),
            Shape::FixedSphere(sphere) => builder.surroundings(FixedSphere {
                center: t3(sphere.center.to_array()).into(),
                radius: T::from_f64(sphere.radius),
                inside: sphere.inside,
            }),
        };
    }
    let mut placed: Vec<([f64; 3], f64)> = Vec::new();
    for _ in 0..count * 20 {
        let radius = if is_mixed { random.random_range(0.1..0.5) } else { 0.5 };
        let center = sides.map(|side| random.random_range(0.0..side));
        let is_far = |(other, reach): &([f64; 3], f64)| {
            let distance = (0..3).map(|k| {
                let d = (center[k] - other[k]).abs();
                if is_periodic { d.min(sides[k] - d) } else { d }
            });
            distance.map(|d| d * d).sum::<f64>().sqrt() > radius + reach + 1e-3
        };
        let gap = |feature: &Feature<f64>| feature.clearance(Vec3::from(center), radius).gap;
        let gaps = features.iter().all(|feature| gap(feature) > 1e-3);
        if placed.len() == count || !gaps || !placed.iter().all(is_far) {
            continue;
        }
        placed.push((center, radius));
        let inwards = if matches!(kind, Kind::Open | Kind::Floor) { 1.0 } else { 0.0 };
        let velocity = core::array::from_fn(|k| {
            random.random_range(-1.0..1.0) - inwards * (center[k] - 0.5 * sides[k])
        });
        let spin = core::array::from_fn(|_| random.random_range(-3.0..3.0));
        let mass = if is_mixed { random.random_range(0.2..3.0) } else { 1.0 };
        let sphere = Sphere::new(center).radius(radius).mass(mass);
        builder = builder.sphere(sphere.velocity(velocity).spin(spin));
    }
    builder.build().unwrap_or_else(|error| panic!("{kind:?} {seed}: {error}"))
}

/// Runs both for a number of events, and compares them.
fn agree<T: Real>(kind: Kind, seed: u64, most: u64) -> usize {
    let scene = scene::<T>(kind, seed);
    let lanes = LANES[seed as usize % LANES.len()];
    let world = || {
        EventDriven::with_execution(scene.clone(), Execution { lanes, threads: 1 }).unwrap()
    };
    let mut first = world();
    first.advance_until(most, 50.0).unwrap();
    // Between two events: which of two roundings an end has is no matter.
    let end = first.time() * (1.0 + 1.0 / 1024.0);
    let found = events(&mut world(), end);
    let mut reference = Reference::new(&scene);
    for (k, event) in found.iter().enumerate() {
        let expected = reference.next_event(end);
        assert_eq!(Some(*event), expected, "{} {} event {k} of {lanes:?}", scene.name, T::NAME);
    }
    assert_eq!(reference.next_event(end), None, "{} {}: missed", scene.name, T::NAME);
    found.len()
}

fn scenes_agree<T: Real>(kind: Kind) {
    let found: usize = (0..SCENES).map(|seed| agree::<T>(kind, seed, 100)).sum();
    println!("{kind:?} {}: {found} equal events in {SCENES} scenes", T::NAME);
    assert!(found as u64 > SCENES * 10, "{kind:?}: {found} events are too few to compare");
}

/// Random scenes of each kind and precision.
const SCENES: u64 = 40;

macro_rules! kinds {
    ($($test:ident: $kind:ident,)*) => {$(
        #[test]
        fn $test() {
            scenes_agree::<f32>(Kind::$kind);
            scenes_agree::<f64>(Kind::$kind);
        }
    )*

        #[test]
        fn every_kind_is_tested() {
            assert_eq!(KINDS, [$(Kind::$kind),*]);
        }
    };
}

kinds! {
    open_space: Open,
    over_a_floor: Floor,
    in_a_container: Container,
    among_solids: Solids,
    in_a_hollow_sphere: Hollow,
    in_a_periodic_box: Periodic,
    in_a_narrow_periodic_box: NarrowPeriodic,
    among_periodic_solids: PeriodicSolids,
}
