//! To stop and to look in between changes nothing.

use carom::contact::Surface;
use carom::engine::{Compiled, EngineError, EventDriven, Execution, Order};
use carom::observe::state_hash;
use carom::scene::{Scene, Sphere, Spheres};
use carom::space::PeriodicBox;
use carom::surroundings::Cuboid;

use crate::{builder, events, t3, world};

/// A gas in a periodic box, and one of many sizes that falls.
fn scenes<T: Compiled>() -> [Scene<T>; 2] {
    let gas = Spheres::random(100).temperature(1.0).spin_temperature(1.0).seed(6);
    let builder = || builder::<T>().surface(Surface::Rough);
    let periodic = builder()
        .periodic(PeriodicBox::new(t3([-3.0; 3]), t3([4.0; 3])))
        .spheres(gas.clone().radius(0.5));
    let falling = builder()
        .gravity(t3([0.0, 1.0, -8.0]))
        .surroundings(Cuboid::container(t3([0.0; 3]), t3([7.0; 3])))
        .spheres(gas.radius(0.2..=0.6).mass(0.5..=2.0));
    [periodic, falling].map(|scene| scene.build().unwrap())
}

/// A scene at its start, in windows of time.
fn in_windows<T: Compiled>(scene: &Scene<T>, threads: usize) -> EventDriven<T> {
    let execution = Execution::new().order(Order::Windows).threads(threads);
    let world = EventDriven::with_execution(scene.clone(), execution).unwrap();
    assert_eq!((world.plan().order, world.plan().threads), (Order::Windows, threads));
    world
}

/// Two advances are one, if their sum is exact, and looking changes no bit.
#[test]
fn parts_make_the_whole() {
    fn parts<T: Compiled>(scene: &Scene<T>) {
        let mut whole = world(scene.clone());
        let all = events(&mut whole, 6.0);
        let hash = state_hash(&whole.bodies());
        assert!(all.len() > 500, "{} events", all.len());
        for (parts, threads) in [
            vec![3.0, 3.0],
            vec![0.0, 5.5, 0.0, 0.5],
            vec![1.0 / 64.0; 384],
            (0..24).map(|k| f64::from(k % 3) * 0.25).collect(),
            vec![1.0 / 4096.0; 6 * 4096],
        ]
        .into_iter()
        .flat_map(|parts| [(parts.clone(), 0), (parts.clone(), 1), (parts, 2)])
        {
            let mut world = match threads {
                0 => world(scene.clone()),
                _ => in_windows(scene, threads),
            };
            let mut found = Vec::new();
            for (k, part) in parts.iter().enumerate() {
                found.extend(events(&mut world, *part));
                if k % 3 == 1 {
                    let _ = (world.bodies(), world.energy(), world.mean_free_path());
                }
            }
            assert_eq!(world.time(), 6.0);
            assert_eq!(found, all, "{} parts", parts.len());
            assert_eq!(state_hash(&world.bodies()), hash, "{} parts", parts.len());
            assert_eq!(world.collisions(), whole.collisions());
            assert_eq!(world.virial(), whole.virial());
            assert_eq!(world.impulse_from_surroundings(), whole.impulse_from_surroundings());
            assert_eq!(world.mean_free_path(), whole.mean_free_path());
        }
    }
    scenes::<f32>().iter().for_each(parts);
    scenes::<f64>().iter().for_each(parts);
}

/// One event after another, and they are those of one run.
#[test]
fn event_by_event() {
    fn one_by_one<T: Compiled>(scene: &Scene<T>) {
        let mut whole = world(scene.clone());
        let all = events(&mut whole, 4.0);
        let mut world = world(scene.clone());
        for (k, event) in all.iter().enumerate() {
            assert_eq!(world.advance_until(1, 4.0).unwrap(), 1);
            assert_eq!(world.collisions().total(), k as u64 + 1);
            assert_eq!(world.time(), event.time);
            // Nothing happens in no time, but for what is due at that time.
            if all.get(k + 1).is_none_or(|next| next.time > event.time) {
                assert_eq!(world.advance_until(0, 1.0).unwrap(), 0);
                world.advance(0.0).unwrap();
                assert_eq!(world.collisions().total(), k as u64 + 1);
            }
        }
        let rest = 4.0 - world.time();
        assert_eq!(world.advance_until(u64::MAX, rest).unwrap(), 0);
        let gap = |k: usize| {
            let (a, b) = (world.bodies().position_of(k), whole.bodies().position_of(k));
            (a - b).length()
        };
        // `time + rest` may be rounded.
        let worst = (0..100).map(gap).fold(T::ZERO, |most, gap| gap.greater(most));
        assert!(worst < T::whole(64) * T::EPSILON, "{worst:e}");
    }
    scenes::<f32>().iter().for_each(one_by_one);
    scenes::<f64>().iter().for_each(one_by_one);
}

/// Windows are cut at the collision that is asked for, also where the next one has the same
/// time.
#[test]
fn some_events_after_others() {
    fn some<T: Compiled>(scene: &Scene<T>) {
        let mut whole = world(scene.clone());
        let all = events(&mut whole, 4.0);
        for (threads, count) in [(1, 100), (2, 101), (3, 250), (7, 333)] {
            let mut world = in_windows(scene, threads);
            let mut found = Vec::new();
            let mut note = |event: &_| found.push(*event);
            for part in 1.. {
                let is_there = world.advance_to(4.0, count, Some(&mut note)).unwrap();
                if is_there {
                    break;
                }
                let made = part * count as usize;
                assert_eq!(world.collisions().total(), made as u64);
                assert_eq!(world.time(), all[made - 1].time);
            }
            assert_eq!(found, all, "{threads} threads");
            assert_eq!(state_hash(&world.bodies()), state_hash(&whole.bodies()));
            assert_eq!(world.virial(), whole.virial());
            assert_eq!(world.impulse_from_surroundings(), whole.impulse_from_surroundings());
            assert_eq!(world.mean_free_path(), whole.mean_free_path());
        }
    }
    scenes::<f32>().iter().for_each(some);
    scenes::<f64>().iter().for_each(some);
}

/// A period ends early where a body has become too fast for it, within a window as well:
/// one shot into bodies at rest, light ones among them.
#[test]
fn a_shot_among_bodies_at_rest() {
    fn shot<T: Compiled>() {
        let at_rest = Spheres::random(150).radius(0.2..=0.5).mass(0.01..=1.0).seed(2);
        let ball = Sphere::new([-30.0, 3.1, 2.9]).radius(0.5).mass(50.0);
        for speed in [1e-3, 1.0, 1e3] {
            let scene = builder::<T>()
                .sphere(ball.clone().velocity([speed, 0.0, 0.0]))
                .spheres(at_rest.clone().within([0.0; 3], [6.0; 3]))
                .build()
                .unwrap();
            let duration = 45.0 / speed;
            let mut strict = world(scene.clone());
            let all = events(&mut strict, duration);
            assert!(all.len() > 20, "{} events", all.len());
            for threads in [1, 2, 7] {
                let mut world = in_windows(&scene, threads);
                assert_eq!(events(&mut world, duration), all, "{threads} threads");
                assert_eq!(state_hash(&world.bodies()), state_hash(&strict.bodies()));
            }
        }
    }
    shot::<f32>();
    shot::<f64>();
}

/// Events come in order, add up to the counters, and the last one of each body
/// leaves it with the velocity that it has at the end.
#[test]
fn events_tell_the_whole_story() {
    use carom::engine::Partner;
    for scene in &scenes::<f64>()[..1] {
        let mut world = world(scene.clone());
        let all = events(&mut world, 5.0);
        let bodies = &scene.bodies;
        let mut last: Vec<_> =
            (0..100).map(|k| (bodies.velocity_of(k), bodies.spin_of(k))).collect();
        for event in &all {
            assert!(event.normal_impulse > 0.0);
            assert!((event.normal.length() - 1.0).abs() < 1e-14);
            assert!(event.normal.dot(event.tangential_impulse).abs() < 1e-12);
            last[event.a as usize] = (event.velocity, event.spin);
            if let Partner::Body { index, velocity, spin } = event.partner {
                assert!(event.a < index);
                last[index as usize] = (velocity, spin);
            }
        }
        assert!(all.windows(2).all(|two| two[0].time <= two[1].time));
        assert_eq!(world.collisions().total(), all.len() as u64);
        let bodies = world.bodies();
        for (k, (velocity, spin)) in last.into_iter().enumerate() {
            assert_eq!((velocity, spin), (bodies.velocity_of(k), bodies.spin_of(k)));
        }
    }
}

#[test]
fn no_time_is_no_change() {
    for scene in scenes::<f64>() {
        let start = state_hash(&scene.bodies);
        let mut world = world(scene);
        world.advance(0.0).unwrap();
        assert_eq!((world.time(), world.collisions().total()), (0.0, 0));
        assert_eq!(world.mean_free_path(), None);
        let mut bodies = world.bodies();
        assert!(bodies.orientation.is_some());
        assert_eq!(state_hash(&bodies), start);
        bodies.orientation = None;
        assert_eq!(state_hash(&bodies), start);
    }
}

#[test]
fn no_duration_is_an_error() {
    let [scene, _] = scenes::<f64>();
    let mut world = world(scene);
    world.advance(0.5).unwrap();
    let before = state_hash(&world.bodies());
    for duration in [-1.0, -f64::MIN_POSITIVE, f64::NAN, f64::NEG_INFINITY] {
        let error = world.advance(duration).unwrap_err();
        assert!(matches!(error, EngineError::NoDuration(_)), "{error}");
        assert!(world.advance_until(3, duration).is_err());
        assert!(world.for_each_event(duration, |_| panic!("an event")).is_err());
    }
    assert_eq!((world.time(), state_hash(&world.bodies())), (0.5, before));
}

/// Orientations are turned by the spins between contacts, whenever one looks.
#[test]
fn orientations_turn_with_the_spins() {
    let scene = builder::<f64>()
        .surface(Surface::Rough)
        .surroundings(Cuboid::container([0.0; 3], [8.0; 3]))
        .sphere(Sphere::new([4.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]).spin([0.0, 0.0, 2.0]));
    let mut world = world(scene.build().unwrap());
    let angle = |world: &carom::EventDriven<f64>| {
        let [x, _, _, y, ..] = world.bodies().orientation_of(0).rows();
        y.atan2(x)
    };
    world.advance(1.0).unwrap();
    assert!((angle(&world) - 2.0).abs() < 1e-15);
    world.advance(3.0).unwrap();
    let spin = world.bodies().spin_of(0).z;
    assert!(spin != 2.0, "no contact");
    let exact = 2.0 * 3.5 + spin * 0.5;
    assert!((angle(&world) - exact).sin().abs() < 1e-14, "{} {exact}", angle(&world));
}
