//! The engine against the [reference](crate::reference) on random small scenes.
//! Not close to it: the same events, every bit of them.

use carom::contact::Surface;
use carom::engine::{Compiled, Event, EventDriven, Execution, Lanes, Order};
use carom::observe::state_hash;
use carom::real::Real;
use carom::scene::{Buildable, Encounters, Scene, Sphere, Spheres};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, Feature, FixedSphere, Plane, Shape};
use carom::vec3::Vec3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::reference::{Collision, Reference};
use crate::{builder, t3};

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
    Symmetric,
}

const KINDS: [Kind; 9] = [
    Kind::Open,
    Kind::Floor,
    Kind::Container,
    Kind::Solids,
    Kind::Hollow,
    Kind::Periodic,
    Kind::NarrowPeriodic,
    Kind::PeriodicSolids,
    Kind::Symmetric,
];

const LANES: [Lanes; 5] = [Lanes::Auto, Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen];

/// What is fixed in a space of these sides.
fn surroundings(
    kind: Kind,
    lower: [f64; 3],
    sides: [f64; 3],
    random: &mut ChaCha8Rng,
) -> Vec<Shape<f64>> {
    let part = |k: usize, share: f64| lower[k] + share * sides[k];
    let at = |share: f64| [part(0, share), part(1, share), part(2, share)];
    let solids = |random: &mut ChaCha8Rng| -> Vec<Shape<f64>> {
        let [low, high] = [random.random_range(0.1..0.3), random.random_range(0.32..0.45)];
        let corner = [part(0, low), part(1, 1.0 - high), part(2, low)];
        let opposite = [part(0, high), part(1, 1.0 - low), part(2, high)];
        let radius = random.random_range(0.05..0.2) * sides[0].min(sides[1]).min(sides[2]);
        let sphere = FixedSphere::solid([part(0, 0.7), part(1, 0.3), part(2, 0.6)], radius);
        vec![Cuboid::solid(corner, opposite).into(), sphere.into()]
    };
    let container = Cuboid::container(lower, at(1.0)).into();
    match kind {
        Kind::Open | Kind::Periodic | Kind::NarrowPeriodic | Kind::Symmetric => vec![],
        Kind::Floor => {
            let tilt = [random.random_range(-0.3..0.3), random.random_range(-0.3..0.3), 1.0];
            vec![Plane::new(lower, tilt).into()]
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

/// A shape in the scene's precision.
fn rounded<T: Real>(shape: Shape<f64>) -> Shape<T> {
    match shape {
        // To the length that the normal has in this precision.
        Shape::Plane(Plane { point, normal }) => {
            Plane::new(t3(point.to_array()), t3(normal.to_array())).into()
        }
        shape => shape.cast(),
    }
}

/// A random scene.
fn scene<T: Buildable>(kind: Kind, seed: u64) -> Scene<T> {
    if kind == Kind::Symmetric {
        return symmetric(seed);
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let is_mixed = random.random_bool(0.5);
    // Some as small as a hundredth of others.
    let least: f64 = if random.random_bool(0.3) { 0.005 } else { 0.1 };
    let count = random.random_range(if kind == Kind::NarrowPeriodic { 2..6 } else { 2..31 });
    let sides: [f64; 3] = core::array::from_fn(|_| match kind {
        Kind::NarrowPeriodic => random.random_range(2.05..4.2),
        Kind::Periodic => random.random_range(3.0..8.0),
        Kind::PeriodicSolids => random.random_range(6.0..8.0),
        _ => random.random_range(4.0..8.0),
    });
    // Far off, where positions have some digits less, and not so far that the engine
    // computes about an origin of its own.
    let is_far = random.random_bool(0.2) && count > 5;
    let lower = if is_far { [4.0 * sides[0], -6.0 * sides[1], 0.0] } else { [0.0; 3] };
    let upper = core::array::from_fn(|k| lower[k] + sides[k]);
    // Some fast ones among many that hardly move.
    let decades = if random.random_bool(0.25) { 3.0 } else { 0.0 };
    let is_periodic = matches!(kind, Kind::Periodic | Kind::NarrowPeriodic | Kind::PeriodicSolids);
    let has_field = kind == Kind::Floor || random.random_bool(0.4);
    let gravity = if has_field { [0.3, 0.0, -random.random_range(0.1..5.0)] } else { [0.0; 3] };
    let rough = random.random_bool(0.5);
    let encounters = match random.random_range(0..20) {
        0 => Encounters::None,
        1 => Encounters::Surroundings,
        _ => Encounters::All,
    };
    let shapes = surroundings(kind, lower, sides, &mut random);
    let features: Vec<Feature<f64>> = shapes.iter().flat_map(Shape::features).collect();

    let mut builder = builder::<T>()
        .name(format!("{kind:?} {seed}"))
        .surface(if rough { Surface::Rough } else { Surface::Smooth })
        .encounters(encounters)
        .gravity(t3(gravity));
    if is_periodic {
        builder = builder.periodic(PeriodicBox::new(t3(lower), t3(upper)));
    }
    for shape in shapes {
        builder = builder.surroundings(rounded(shape));
    }
    let mut placed: Vec<([f64; 3], f64)> = Vec::new();
    for _ in 0..count * 20 {
        let radius = if is_mixed { least * (0.5 / least).powf(random.random()) } else { 0.5 };
        let center: [f64; 3] = core::array::from_fn(|k| random.random_range(lower[k]..upper[k]));
        let is_far = |(other, reach): &([f64; 3], f64)| {
            let distance = (0..3).map(|k| {
                let d = (center[k] - other[k]).abs();
                if is_periodic { d.min(sides[k] - d) } else { d }
            });
            distance.map(|d| d * d).sum::<f64>().sqrt() > radius + reach + 0.02
        };
        let gap = |feature: &Feature<f64>| feature.clearance(Vec3::from(center), radius).gap;
        let gaps = features.iter().all(|feature| gap(feature) > 0.02);
        if placed.len() == count || !gaps || !placed.iter().all(is_far) {
            continue;
        }
        placed.push((center, radius));
        let inwards = if matches!(kind, Kind::Open | Kind::Floor) { 1.0 } else { 0.0 };
        let speed = 10.0_f64.powf(decades * random.random_range(-1.0..1.0));
        let velocity = core::array::from_fn(|k| {
            let outwards = center[k] - lower[k] - 0.5 * sides[k];
            speed * (random.random_range(-1.0..1.0) - inwards * outwards)
        });
        let spin = core::array::from_fn(|_| random.random_range(-3.0..3.0));
        let mass = if is_mixed { random.random_range(0.2..3.0) } else { 1.0 };
        let sphere = Sphere::new(center).radius(radius).mass(mass);
        builder = builder.sphere(sphere.velocity(velocity).spin(spin));
    }
    builder.build().unwrap_or_else(|error| panic!("{kind:?} {seed}: {error}"))
}

/// Balls on some sites of a lattice with velocities of a few values: many
/// contacts come at the same time.
fn symmetric<T: Buildable>(seed: u64) -> Scene<T> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut builder = builder::<T>().name(format!("Symmetric {seed}"));
    let (spacing, sites) = (if seed.is_multiple_of(3) { 1.0 } else { 1.5 }, 4);
    // With room for one to stand back: a full row would hand a push to and fro
    // for ever.
    let side = spacing * f64::from(sites) + 0.25;
    builder = match seed % 4 {
        0 => builder,
        1 => builder.surroundings(Cuboid::container(t3([0.0; 3]), t3([side; 3]))),
        _ => builder.periodic(PeriodicBox::new(t3([0.0; 3]), t3([side; 3]))),
    };
    if seed.is_multiple_of(5) {
        builder = builder.surface(Surface::Rough);
    }
    let share = random.random_range(0.1..0.5);
    for site in 0..sites * sites * sites {
        if !random.random_bool(share) {
            continue;
        }
        let site = [site % sites, site / sites % sites, site / (sites * sites)];
        let center = site.map(|k| spacing * (f64::from(k) + 0.5));
        let velocity = core::array::from_fn(|_| f64::from(random.random_range(-1..2)));
        builder = builder.sphere(Sphere::new(center).radius(0.5).velocity(velocity));
    }
    builder.build().unwrap()
}

fn agree<T: Compiled>(kind: Kind, seed: u64, most: u64) -> usize {
    same_events(&scene::<T>(kind, seed), seed, most)
}

/// Runs both for a number of events, and compares them.
fn same_events<T: Compiled>(scene: &Scene<T>, seed: u64, most: u64) -> usize {
    let lanes = LANES[seed as usize % LANES.len()];
    let world = || {
        EventDriven::with_execution(scene.clone(), Execution::new().lanes(lanes).threads(1))
            .unwrap()
    };
    let mut first = world();
    first.advance_until(most, 50.0).unwrap();
    // Between two events: which of two roundings an end has is no matter.
    let end = first.time() * (1.0 + 1.0 / 1024.0);
    // A push may go round for ever among balls that touch.
    let cap = 2 * most as usize;
    let story = |mut world: EventDriven<T>| {
        let mut found: Vec<Event<T>> = Vec::new();
        let result = world.for_each_event(end, |event| {
            if found.len() < cap {
                found.push(*event);
            }
        });
        assert!(result.is_ok() || found.len() == cap, "{}: {result:?}", scene.name);
        (found, world, result)
    };
    let (found, world, result) = story(world());
    // Threads that come and go for a few balls take longer than all else.
    let others = [2, 3, 7][seed as usize % 3];
    let all: &[usize] = if seed.is_multiple_of(4) { &[1, others] } else { &[1] };
    for &threads in all {
        let execution = Execution::new().lanes(lanes).threads(threads).order(Order::Windows);
        let (windows, other, _) =
            story(EventDriven::with_execution(scene.clone(), execution).unwrap());
        let name = format!("{} {} in windows on {threads} threads", scene.name, T::NAME);
        for (k, (found, expected)) in windows.iter().zip(&found).enumerate() {
            assert_eq!(found, expected, "{name}: event {k}");
        }
        assert_eq!(windows.len(), found.len(), "{name}");
        if result.is_ok() {
            assert_eq!(state_hash(&other.bodies()), state_hash(&world.bodies()), "{name}");
            assert_eq!(other.collisions(), world.collisions(), "{name}");
            assert_eq!(other.virial().to_bits(), world.virial().to_bits(), "{name}");
            assert_eq!(other.impulse_from_surroundings(), world.impulse_from_surroundings());
            assert_eq!(other.mean_free_path(), world.mean_free_path(), "{name}");
        }
    }
    let mut reference = Reference::new(scene);
    for (k, event) in found.iter().enumerate() {
        let expected = reference.next_event(end);
        assert_eq!(
            Some(Collision::from(*event)),
            expected,
            "{} {} event {k} of {lanes:?}",
            scene.name,
            T::NAME
        );
    }
    if found.len() < cap {
        assert_eq!(reference.next_event(end), None, "{} {}: missed", scene.name, T::NAME);
    } else {
        println!("{} {}: {result:?}", scene.name, T::NAME);
    }
    found.len()
}

fn scenes_agree<T: Compiled>(kind: Kind) {
    let scenes = scenes();
    let found: usize = (0..scenes).map(|seed| agree::<T>(kind, seed, 100)).sum();
    println!("{kind:?} {}: {found} equal events in {scenes} scenes", T::NAME);
    assert!(found as u64 > scenes * 10, "{kind:?}: {found} events are too few to compare");
}

/// Crowds, with many cells and spans of the calendar.
#[test]
fn in_a_crowd() {
    fn crowds<T: Compiled>() {
        let crowd = Spheres::random(250).temperature(1.0).spin_temperature(1.0).seed(8);
        let scenes = [
            builder::<T>()
                .name("a gas")
                .periodic(PeriodicBox::new(t3([0.0; 3]), t3([9.0; 3])))
                .spheres(crowd.clone().radius(0.5)),
            builder::<T>()
                .name("mixed sizes that fall")
                .surface(Surface::Rough)
                .gravity(t3([0.0, 0.0, -2.0]))
                .surroundings(Cuboid::container(t3([0.0; 3]), t3([9.0; 3])))
                .surroundings(Cuboid::solid(t3([3.0; 3]), t3([5.0; 3])))
                .spheres(crowd.radius(0.02..=0.6).density(1.0)),
        ];
        for (scene, most) in scenes.into_iter().zip([300, 1_500]) {
            same_events(&scene.build().unwrap(), 0, most);
        }
        // Cells suit the crowd; some that are far away come back through it.
        let crowd = Spheres::random(120).radius(0.3).temperature(1.0).seed(9);
        let mut open = builder::<T>().name("strays").spheres(crowd.within([0.0; 3], [4.5; 3]));
        for k in 0..6 {
            let far = 50.0 + 150.0 * f64::from(k);
            let [x, y, z] = [[far, 2.0, 2.2], [2.5, -far, 2.0], [2.0, 2.4, far]][k as usize % 3];
            let velocity = [x, y, z].map(|c: f64| (2.25 - c) * 3.0);
            open = open.sphere(Sphere::new([x, y, z]).radius(0.2).velocity(velocity));
        }
        same_events(&open.build().unwrap(), 0, 300);
    }
    crowds::<f32>();
    crowds::<f64>();
}

/// A few great bodies in dust: cells in levels by size.
#[test]
fn giants_in_dust() {
    fn giants<T: Compiled>() {
        for seed in 0..8 {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let side = 30.0;
            let dust = Spheres::random(random.random_range(250..350))
                .radius(if seed % 3 == 0 { 0.2..=0.2 } else { 0.02..=0.6 })
                .density(0.1)
                .temperature(1.0)
                .seed(seed);
            let mut scene = builder::<T>().name(format!("giants {seed}"));
            let centers = [[8.0, 22.0, 15.0], [22.0, 8.0, 8.0], [22.0, 22.0, 24.0]];
            for (center, most) in centers.into_iter().zip([6.0, 4.0, 2.0]) {
                let radius = random.random_range(0.7..1.0) * most;
                let velocity = core::array::from_fn(|_| random.random_range(-3.0..3.0));
                scene =
                    scene.sphere(Sphere::new(center).radius(radius).mass(5.0).velocity(velocity));
            }
            scene = match seed % 4 {
                0 => scene,
                1 => scene.surroundings(Cuboid::container(t3([0.0; 3]), t3([side; 3]))),
                _ => scene.periodic(PeriodicBox::new(t3([0.0; 3]), t3([side; 3]))),
            };
            if seed % 2 == 1 {
                scene = scene.surface(Surface::Rough).gravity(t3([0.5, 0.0, -2.0]));
            }
            let dust = if seed % 4 == 0 { dust.within([0.0; 3], [side; 3]) } else { dust };
            same_events(&scene.spheres(dust).build().unwrap(), seed, 100);
        }
    }
    giants::<f32>();
    giants::<f64>();
}

/// Crowds in the corners of a large box: cells fold.
#[test]
fn crowds_in_corners() {
    fn crowds<T: Compiled>() {
        for seed in 0..8 {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let (side, crowd) = (2_000.0, 12.0);
            let mut scene = builder::<T>().name(format!("crowds {seed}"));
            let corners = [[0.0; 3], [side - crowd, 0.0, side - crowd]];
            for (corner, count) in corners.into_iter().zip([150, 60]) {
                let opposite = corner.map(|x| x + crowd);
                let crowd = Spheres::random(random.random_range(count..count + 50))
                    .radius(if seed % 3 == 0 { 0.4..=0.4 } else { 0.1..=0.6 })
                    .density(0.1)
                    .temperature(1.0)
                    .within(corner, opposite);
                scene = scene.spheres(crowd);
            }
            // Fast, through many folds.
            scene = scene.sphere(
                Sphere::new([side / 2.0, 6.0, 6.0]).radius(0.5).velocity([-700.0, 1.0, 2.0]),
            );
            scene = match seed % 3 {
                0 => scene,
                1 => scene.surroundings(Cuboid::container(t3([0.0; 3]), t3([side; 3]))),
                _ => scene
                    .periodic(PeriodicBox::new(t3([0.0; 3]), t3([side; 3])))
                    .surroundings(FixedSphere::solid(t3([20.0, 8.0, 8.0]), T::ONE)),
            };
            if seed % 2 == 1 {
                scene = scene.surface(Surface::Rough).gravity(t3([0.5, 0.0, -2.0]));
            }
            same_events(&scene.seed(seed).build().unwrap(), seed, 100);
        }
    }
    crowds::<f32>();
    crowds::<f64>();
}

/// Random scenes of each kind and precision.
const SCENES: u64 = 40;

/// How many: as the environment wants it, for long tests.
fn scenes() -> u64 {
    std::env::var("SCENES").ok().map_or(SCENES, |text| text.parse().unwrap())
}

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
    in_step_on_a_lattice: Symmetric,
}
