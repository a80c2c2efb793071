//! Impacts inside the step against the event-driven engine: the same collisions
//! in the same order at the same times, to rounding, however long a step is; and
//! what a step can no longer miss.

use carom::contact::Surface;
use carom::engine::{Compiled, Event, EventDriven, Partner};
use carom::motion::Integrator;
use carom::observe::Energy;
use carom::real::Real;
use carom::scene::{Impact, Scene, SceneBuilder, Sphere, Spheres};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, FixedSphere, Plane};

use crate::{FAST, world};

fn t3<T: Real>(vector: [f64; 3]) -> [T; 3] {
    vector.map(T::from_f64)
}

fn builder<T: Compiled>(dt: f64) -> SceneBuilder<T> {
    Scene::<T>::builder().impact(Impact::SubStep).integrator(Integrator::VelocityVerlet).dt(dt)
}

/// Runs both engines for a number of steps and compares collisions as long as an error
/// of rounding has not grown to `1/64`; returns how many are equal and the greatest
/// difference of time, in units of what rounding explains.
///
/// From one collision to the next an error grows with the way that lies between, in
/// radii.
fn compare<T: Compiled>(scene: &Scene<T>, steps: u64) -> (usize, f64) {
    let mut expected = Vec::new();
    let duration = scene.stepped.dt.unwrap() * (steps as f64 + 1.0);
    let mut exact = EventDriven::with_execution(scene.clone(), FAST).unwrap();
    exact.for_each_event(duration, |event| expected.push(*event)).unwrap();
    let mut found = Vec::new();
    world(scene.clone(), FAST).take_steps(steps, Some(&mut |event: &Event<T>| found.push(*event)));

    let rounding = 16.0 * T::EPSILON.to_f64();
    let bodies = &scene.bodies;
    // The error of each body, when it last collided, and its speed since.
    let mut last: Vec<_> = (0..bodies.len())
        .map(|k| (rounding, 0.0, bodies.velocity_of(k).length().to_f64()))
        .collect();
    let (mut equal, mut worst) = (0, 0.0_f64);
    for (event, exact) in found.iter().zip(&expected) {
        let (a, b) = (event.a as usize, partner(event));
        let grown = |body: usize| {
            let (error, time, speed) = last[body];
            let way = speed * (event.time - time) / bodies.radius.of(body).to_f64();
            error * (8.0 + 8.0 * way)
        };
        let grown = b.map_or(grown(a), |b| grown(a).max(grown(b)));
        if grown > 1.0 / 64.0 {
            break;
        }
        let what = || format!("{} {} event {equal}: {event:?}, not {exact:?}", scene.name, T::NAME);
        assert_eq!((event.a, partner(event)), (exact.a, partner(exact)), "{}", what());
        let difference = (event.time - exact.time).abs() / (1.0 + exact.time);
        assert!(difference <= grown, "{difference:e} > {grown:e}: {}", what());
        worst = worst.max(difference / grown);
        last[a] = (grown, event.time, event.velocity.length().to_f64());
        if let Partner::Body { index, velocity, .. } = event.partner {
            last[index as usize] = (grown, event.time, velocity.length().to_f64());
        }
        equal += 1;
    }
    (equal, worst)
}

fn partner<T: Real>(event: &Event<T>) -> Option<usize> {
    match event.partner {
        Partner::Body { index, .. } => Some(index as usize),
        _ => None,
    }
}

/// Scenes of a seed: all kinds of space and surroundings.
fn scenes<T: Compiled>(seed: u64) -> Vec<Scene<T>> {
    let dt = [0.25, 0.375, 0.5, 0.625][seed as usize % 4];
    let surface = if seed.is_multiple_of(3) { Surface::Rough } else { Surface::Smooth };
    let new = || builder::<T>(dt).surface(surface);
    let balls = |count: u64| {
        let radius = if seed.is_multiple_of(2) { 0.5..=0.5 } else { 0.15..=0.5 };
        let balls = Spheres::random(count).radius(radius).density(1.0..=2.0);
        balls.temperature(0.5).spin_temperature(0.5).seed(seed)
    };
    let container = |side: f64| Cuboid::container(t3([0.0; 3]), t3([side; 3]));
    let periodic = |side: f64| PeriodicBox::new(t3([0.0; 3]), t3([side; 3]));
    let gravity = t3([0.3, 0.0, -2.0]);
    let solids = |scene: SceneBuilder<T>| {
        scene
            .surroundings(Cuboid::solid(t3([1.2, 1.4, 1.0]), t3([2.0, 2.5, 1.01])))
            .surroundings(FixedSphere::solid(t3([3.5, 3.7, 3.0]), T::from_f64(0.05)))
            .surroundings(FixedSphere::solid(t3([3.2, 1.7, 2.0]), T::from_f64(0.6)))
    };
    let box_of = |scene: SceneBuilder<T>| scene.surroundings(container(5.0));
    vec![
        new().name("container").surroundings(container(4.5)).spheres(balls(20)),
        box_of(new()).name("container, gravity").gravity(gravity).spheres(balls(20)),
        solids(box_of(new())).name("solids").spheres(balls(12)),
        solids(box_of(new())).name("solids, gravity").gravity(gravity).spheres(balls(12)),
        solids(new().periodic(periodic(5.0))).name("periodic solids").spheres(balls(12)),
        new().name("periodic").periodic(periodic(4.5)).spheres(balls(24)),
        new().name("narrow periodic").periodic(periodic(2.2)).spheres(balls(2)),
        new()
            .name("hollow sphere, gravity")
            .gravity(gravity)
            .surroundings(FixedSphere::container(t3([0.0; 3]), T::from_f64(3.0)))
            .spheres(balls(12)),
        new()
            .name("slope")
            .gravity(gravity)
            .surroundings(Plane::new(t3([0.0; 3]), t3([0.2, 0.1, 1.0])))
            .spheres(balls(12).within([-2.0, -2.0, 1.0], [2.0, 2.0, 5.0])),
    ]
    .into_iter()
    .map(|scene| {
        let mut scene = scene.build().unwrap();
        scene.name = format!("{} {seed}", scene.name);
        scene
    })
    .collect()
}

/// A second exact engine: the same collisions at steps of .3 to .9 diameters.
#[test]
fn impacts_inside_the_step_are_those_of_the_event_driven_engine() {
    fn agree<T: Compiled>(seeds: u64, least: usize) {
        let (mut equal, mut worst) = (0, 0.0_f64);
        for seed in 0..seeds {
            for scene in scenes::<T>(seed) {
                let (found, off) = compare(&scene, 40);
                equal += found;
                worst = worst.max(off);
            }
        }
        println!("{}: {equal} equal collisions, {worst:.2} of what rounding explains", T::NAME);
        assert!(equal >= least, "{equal} equal collisions are too few");
    }
    agree::<f64>(48, 12_000);
    agree::<f32>(48, 2_000);
}

/// More bodies than can all be candidates of each other, some so fast that they
/// pass through many neighbourhoods in a step.
#[test]
fn fast_bodies_among_many_meet_all_that_they_should() {
    fn agree<T: Compiled>(space: Option<f64>) {
        let side = space.unwrap_or(24.0);
        let slow = Spheres::random(400).radius(0.5).temperature(1e-4).seed(4);
        let mut scene = builder::<T>(0.5).name("fast among many").spheres(slow);
        scene = match space {
            Some(_) => scene.periodic(PeriodicBox::new(t3([0.0; 3]), t3([side; 3]))),
            None => scene.surroundings(Cuboid::container(t3([0.0; 3]), t3([side; 3]))),
        };
        let mut scene = scene.build().unwrap();
        for k in 0..6 {
            let velocity = [60.0, -35.0, 20.0 + 7.0 * k as f64];
            for axis in 0..3 {
                scene.bodies.velocity[axis][17 * k] = T::from_f64(velocity[(axis + k) % 3]);
            }
        }
        let (equal, worst) = compare(&scene, 6);
        println!("{}: {equal} equal, {worst:.2} of what rounding explains", T::NAME);
        assert!(equal >= 4, "{equal}");
    }
    for space in [None, Some(24.0), Some(20.0)] {
        agree::<f64>(space);
        agree::<f32>(space);
    }
}

/// A third ball is hit into a pair before the two meet, all in one step.
#[test]
fn a_third_ball_comes_between_a_pair_in_one_step() {
    fn agree<T: Compiled>() {
        for k in 0..40 {
            let at = f64::from(k) / 40.0;
            let ball = |x: f64, y: f64, u: f64, v: f64| {
                Sphere::new([x, y, 0.0]).radius(0.5).velocity([u, v, 0.0])
            };
            let scene = builder::<T>(1.0)
                .name(format!("third ball {k}"))
                .sphere(ball(0.0, 0.0, 1.0, 0.0))
                .sphere(ball(2.0, 0.1, -0.5, 0.0))
                .sphere(ball(0.2 + at, 1.6, 0.0, -2.0 + at))
                .sphere(ball(0.3 - at, 4.0, 0.0, -4.0));
            compare(&scene.build().unwrap(), 3);
        }
    }
    agree::<f64>();
    agree::<f32>();
}

/// A ball at speed 50 is stopped by what is thinner than a step's way, alone and
/// among enough that candidates are searched with a narrow skin.
#[test]
fn thin_parts_are_not_passed_through() {
    fn thrown<T: Compiled>(aside: f64, part: usize, others: bool, start: f64) -> (u64, f64) {
        let mut scene = builder::<T>(1.0 / 60.0)
            .sphere(Sphere::new([-start, aside, 0.0]).radius(0.1).velocity([50.0, 0.0, 0.0]));
        scene = match part {
            0 => scene.surroundings(Cuboid::solid(t3([0.0, -1.0, -1.0]), t3([0.01, 1.0, 1.0]))),
            _ => scene.surroundings(FixedSphere::solid(t3([0.0; 3]), T::ratio(1, 20))),
        };
        if others {
            let crowd = Spheres::random(600).radius(0.1).seed(3);
            scene = scene.spheres(crowd.within([-20.0, 5.0, -20.0], [20.0, 45.0, 20.0]));
        }
        let mut world = world(scene.build().unwrap(), FAST);
        world.advance_steps(60);
        (world.collisions().surroundings, world.bodies().velocity_of(0).x.to_f64())
    }
    fn all<T: Compiled>() {
        for others in [false, true] {
            for k in 0..25 {
                let start = 4.0 + f64::from(k) / 30.0;
                let (hits, speed) = thrown::<T>(0.3, 0, others, start);
                let error = (speed + 50.0).abs() / 50.0;
                assert!(hits == 1 && error <= 4.0 * T::EPSILON.to_f64(), "wall from {start}");
                let (hits, speed) = thrown::<T>(0.03, 1, others, start);
                assert!(hits == 1 && speed < 0.0, "sphere from {start}: {hits} {speed}");
                // Grazes inside a step: at an edge, at the side of the sphere.
                let (hits, speed) = thrown::<T>(1.099, 0, others, start);
                assert!(hits == 1 && speed > 40.0, "edge from {start}: {hits} {speed}");
                let (hits, speed) = thrown::<T>(0.1495, 1, others, start);
                assert!(hits == 1 && speed > 40.0, "side from {start}: {hits} {speed}");
            }
        }
    }
    all::<f64>();
    all::<f32>();
}

/// A ball that touches its wall, whatever the rounding, and is shot at it collides
/// at once.
#[test]
fn a_touching_ball_shot_at_its_wall_collides_at_once() {
    fn all<T: Compiled>() {
        for k in 0..200_u8 {
            let place = 0.1 + 0.37 * f64::from(k);
            let radius = 0.05 + 0.013 * f64::from(k % 17);
            let off = T::from_f64([0.0, 1.0, -1.0, 2.0, -2.0][k as usize % 5]) * T::EPSILON;
            // The precision's nearest, and some steps of rounding to either side.
            let center = T::from_f64(place) + T::from_f64(radius);
            let center = (center + center * off).to_f64();
            for (number, integrator) in
                [Integrator::SemiImplicitEuler, Integrator::VelocityVerlet].into_iter().enumerate()
            {
                let wall = [T::from_f64(place), T::ZERO, T::ZERO];
                let scene = builder::<T>(0.25)
                    .integrator(integrator)
                    .surroundings(Plane::new(wall, t3([1.0, 0.0, 0.0])))
                    .sphere(
                        Sphere::new([center, 0.0, 0.0]).radius(radius).velocity([-1.0, 0.5, 0.0]),
                    );
                let scene = if number == 1 { scene.gravity(t3([0.0, 0.0, -1.0])) } else { scene };
                let mut times = Vec::new();
                let mut world = world(scene.build().unwrap(), FAST);
                world.take_steps(1, Some(&mut |event: &Event<T>| times.push(event.time)));
                let rounding = 16.0 * (1.0 + place) * T::EPSILON.to_f64();
                assert!(matches!(times[..], [time] if time <= rounding), "{place}: {times:?}");
                let x = world.bodies().position_of(0).x.to_f64();
                assert!((x - (center + 0.25)).abs() <= rounding, "{place}: {x}");
            }
        }
    }
    all::<f64>();
    all::<f32>();
}

/// A ball at rest on a floor stays within what it falls in a step, and keeps its
/// energy.
#[test]
fn a_ball_at_rest_stays_on_its_floor() {
    fn rests<T: Compiled>() {
        for height in [0.5, 0.1, 0.3] {
            let dt = 0.01;
            let scene = builder::<T>(dt)
                .gravity(t3([0.0, 0.0, -10.0]))
                .surroundings(Plane::new(t3([0.0; 3]), t3([0.0, 0.0, 1.0])))
                .sphere(Sphere::new([0.0, 0.0, height]).radius(height))
                .build()
                .unwrap();
            let gravity = scene.gravity;
            let start = Energy::of(&scene.bodies, gravity).total();
            let mut world = world(scene, FAST);
            let rounding = 16.0 * T::EPSILON.to_f64();
            for _ in 0..2_000 {
                world.advance_steps(1);
                let bodies = world.bodies();
                let depth = height - bodies.position_of(0).z.to_f64();
                assert!(depth.abs() <= 10.0 * dt * dt + rounding, "{depth:e}");
                let energy = Energy::of(&bodies, gravity).total();
                let error = ((energy - start) / start).abs();
                assert!(error < 1e4 * T::EPSILON.to_f64(), "{error:e}");
            }
            // And costs next to nothing: no bounces without end.
            assert!(world.collisions().surroundings <= 4_000, "{:?}", world.collisions());
        }
    }
    rests::<f64>();
    rests::<f32>();
}

/// Many bounces in one step are those of many steps.
#[test]
fn a_ball_bounces_many_times_in_a_step() {
    let run = |dt: f64, steps: u64| {
        let scene = builder::<f64>(dt)
            .gravity([0.0, 0.0, -10.0])
            .surroundings(Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
            .sphere(Sphere::new([0.0, 0.0, 0.625]).radius(0.5));
        let mut world = world(scene.build().unwrap(), FAST);
        world.advance_steps(steps);
        (world.collisions().surroundings, world.bodies().position_of(0).z)
    };
    let (long, short) = (run(4.0, 1), run(0.0625, 64));
    assert_eq!(long.0, short.0);
    assert!((long.1 - short.1).abs() < 1e-12, "{long:?} {short:?}");
}
