//! Balls in and about meshes, by both engines.

use std::collections::HashSet;

use carom::contact::Surface;
use carom::engine::{Compiled, Execution, Lanes, World};
use carom::observe::{Energy, state_hash};
use carom::scene::{Encounters, EngineKind, Scene, SceneBuilder, Sphere, Spheres};
use carom::space::PeriodicBox;
use carom::surroundings::{Cuboid, FixedSphere, Mesh, Shape};

use crate::common::numbers::Random;
use crate::{Net, grid, icosphere};

const ENGINES: [EngineKind; 2] = [EngineKind::EventDriven, EngineKind::Stepped];

fn world<T: Compiled>(scene: SceneBuilder<T>) -> World<T> {
    World::new(scene.build().unwrap(), Execution::new().threads(1)).unwrap()
}

/// The faces of a box as twelve triangles, in an order.
fn cube([low, high]: [f64; 2], order: impl Fn(usize) -> usize) -> Net {
    let end = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { low } else { high };
    let vertices = (0..8).map(|corner| core::array::from_fn(|axis| end(corner, axis))).collect();
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let all: Vec<[u32; 3]> = faces
        .iter()
        .enumerate()
        .flat_map(
            |(k, &[a, b, c, d])| {
                if k % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[b, c, d], [b, d, a]] }
            },
        )
        .collect();
    Net { vertices, triangles: (0..12).map(|k| all[order(k)]).collect() }
}

fn places<T: Compiled>(world: &World<T>) -> Vec<[u64; 3]> {
    let bodies = world.bodies();
    let place = |k: usize| bodies.position_of(k).to_array().map(|c| c.to_f64().to_bits());
    (0..bodies.len()).map(place).collect()
}

#[test]
fn a_box_of_triangles_in_any_order_is_the_container() {
    let mut random = Random(5);
    let balls: Vec<Sphere> = (0..8)
        .map(|k| {
            let place = [k & 1, k >> 1 & 1, k >> 2].map(|c: usize| 2.0 + 4.0 * c as f64);
            let [x, y, z] = random.vector::<f64>().to_array();
            Sphere::new(place).radius(0.5).velocity([3.0 * x, 3.0 * y, 3.0 * z])
        })
        .collect();
    for engine in ENGINES {
        let run = |shape: Shape<f64>| {
            let scene = Scene::<f64>::builder()
                .engine(engine)
                .dt(0.01)
                .gravity([0.0, 0.0, -1.0])
                .encounters(Encounters::Surroundings)
                .surroundings(shape);
            let mut world = world(balls.iter().cloned().fold(scene, SceneBuilder::sphere));
            world.advance(20.0).unwrap();
            assert!(world.collisions().surroundings > 40, "{:?}", world.collisions());
            places(&world)
        };
        // The event-driven engine goes by the extent of a container in its periods of time:
        // there the last digits differ.
        let container = run(Cuboid::container([0.0; 3], [8.0; 3]).into());
        let near = |a: u64, b: u64| (f64::from_bits(a) - f64::from_bits(b)).abs() < 1e-9;
        let first = run(cube([0.0, 8.0], |k| k).mesh().into());
        for (a, b) in first.iter().flatten().zip(container.iter().flatten()) {
            assert!(a == b || engine == EngineKind::EventDriven && near(*a, *b), "{engine:?}");
        }
        for order in [|k| 11 - k, |k| 5 * k % 12, |k| (7 * k + 3) % 12] {
            let found = run(cube([0.0, 8.0], order).mesh().into());
            assert_eq!(found, first, "{engine:?}");
        }
    }
}

#[test]
fn energy_is_kept_in_closed_meshes_and_nothing_leaves() {
    let extent = 4.0;
    for engine in ENGINES {
        for surface in [Surface::Smooth, Surface::Rough] {
            for net in [cube([-extent, extent], |k| 5 * k % 12), icosphere(extent, 2)] {
                let scene = Scene::<f64>::builder()
                    .engine(engine)
                    .dt(0.01)
                    .gravity([0.0, 0.0, -1.0])
                    .surface(surface)
                    .surroundings(net.mesh())
                    .spheres(
                        Spheres::fcc(108)
                            .within([-2.0; 3], [2.0; 3])
                            .radius(0.2)
                            .temperature(1.0)
                            .seed(3),
                    );
                let mut world = world(scene);
                let gravity = [0.0, 0.0, -1.0].into();
                let before = Energy::of(&world.bodies(), gravity).total();
                world.advance(4.0).unwrap();
                let bodies = world.bodies();
                let after = Energy::of(&bodies, gravity).total();
                let change = (after - before).abs() / before.abs().max(100.0);
                // A step adds what the path within it differs by from the velocity.
                assert!(change < 1e-12, "{engine:?} {surface:?}: {change:e}");
                assert!(world.collisions().surroundings > 100);
                for k in 0..bodies.len() {
                    let place = bodies.position_of(k);
                    let reach = place.x.abs().max(place.y.abs()).max(place.z.abs());
                    assert!(reach < extent, "{engine:?}: body {k} has left, {place:?}");
                }
            }
        }
    }
}

/// First contacts of the same flights inside.
fn first_contacts(shape: Shape<f64>) -> Vec<f64> {
    let mut random = Random(11);
    let mut scene = Scene::<f64>::builder()
        .engine(EngineKind::EventDriven)
        .encounters(Encounters::Surroundings)
        .surroundings(shape);
    for _ in 0..200 {
        let place = random.vector::<f64>().to_array().map(|c| 0.3 * c);
        let way = random.vector::<f64>();
        let velocity = (way * (1.0 / way.length())).to_array();
        scene = scene.sphere(Sphere::new(place).radius(0.1).velocity(velocity));
    }
    let mut times = vec![0.0; 200];
    world(scene)
        .for_each_event(1.6, |event| {
            let first = &mut times[event.a as usize];
            if *first == 0.0 {
                *first = event.time;
            }
        })
        .unwrap();
    times
}

#[test]
fn a_sphere_of_triangles_comes_to_the_sphere_by_order_two() {
    let exact = first_contacts(FixedSphere::container([0.0; 3], 1.0).into());
    assert!(exact.iter().all(|&time| time > 0.0));
    let errors: Vec<f64> = (1..6)
        .map(|level| {
            let found = first_contacts(icosphere(1.0, level).mesh().into());
            let errors = found.iter().zip(&exact).map(|(a, b)| (a - b).abs());
            errors.sum::<f64>() / 200.0
        })
        .collect();
    for pair in errors.windows(2).skip(1) {
        let ratio = pair[0] / pair[1];
        assert!((3.4..4.6).contains(&ratio), "{errors:?}");
    }
}

/// A scene of many balls over hills.
fn over_hills<T: Compiled>(engine: EngineKind) -> SceneBuilder<T> {
    let hills = grid(24, |i, j| {
        let [x, y] = [i as f64 - 12.0, j as f64 - 12.0];
        [0.5 * x, 0.5 * y, 0.03 * (x * x + y * y) + 0.3 * ((i * 7 + j * 5) % 3) as f64]
    });
    Scene::<T>::builder()
        .engine(engine)
        .dt(0.02)
        .gravity([0.0, 0.0, -10.0].map(T::from_f64))
        .surface(Surface::Rough)
        .surroundings(hills.mesh::<T>())
        .spheres(
            Spheres::cubic(216)
                .within([-2.0, -2.0, 3.0], [2.0, 2.0, 7.0])
                .radius(0.15)
                .temperature(0.5)
                .seed(7),
        )
}

#[test]
fn threads_and_lanes_give_the_same_bits() {
    fn all<T: Compiled>() {
        for engine in ENGINES {
            let mut hashes = HashSet::new();
            for (threads, lanes) in [
                (1, Lanes::Scalar),
                (1, Lanes::Four),
                (1, Lanes::Eight),
                (1, Lanes::Sixteen),
                (2, Lanes::Auto),
                (3, Lanes::Auto),
            ] {
                let execution = Execution::new().threads(threads).lanes(lanes);
                let mut world =
                    World::<T>::new(over_hills(engine).build().unwrap(), execution).unwrap();
                world.advance(1.2).unwrap();
                assert!(world.collisions().surroundings > 80, "{:?}", world.collisions());
                hashes.insert(state_hash(&world.bodies()).0);
            }
            assert_eq!(hashes.len(), 1, "{engine:?} {}", T::NAME);
        }
    }
    all::<f64>();
    all::<f32>();
}

#[test]
fn windows_of_time_have_the_bits_of_strict_order() {
    use carom::engine::Order;
    let hash = |order: Order| {
        let execution = Execution::new().threads(2).order(order);
        let scene = over_hills::<f64>(EngineKind::EventDriven).build().unwrap();
        let mut world = World::new(scene, execution).unwrap();
        world.advance(0.8).unwrap();
        state_hash(&world.bodies()).0
    };
    assert_eq!(hash(Order::Strict), hash(Order::Windows));
}

#[test]
fn in_a_periodic_box_a_closed_mesh_is_the_solid() {
    for engine in ENGINES {
        let run = |shape: Shape<f64>| {
            let mut random = Random(3);
            let mut scene = Scene::<f64>::builder()
                .engine(engine)
                .dt(0.01)
                .periodic(PeriodicBox::new([0.0; 3], [6.0; 3]))
                .encounters(Encounters::Surroundings)
                .surroundings(shape);
            for k in 0..40 {
                let [x, y, z] = random.vector::<f64>().to_array().map(|c| 3.0 + 2.9 * c);
                // Beside the solid, and above its ends.
                let place = if k % 2 == 0 { [0.2, y, z] } else { [x, y, 5.8] };
                let velocity = (random.vector::<f64>() * 3.0).to_array();
                scene = scene.sphere(Sphere::new(place).radius(0.25).velocity(velocity));
            }
            let mut world = world(scene);
            world.advance(2.0).unwrap();
            let bodies = world.bodies();
            let places = (0..40).map(|k| bodies.position_of(k).to_array()).collect::<Vec<_>>();
            (places, world.collisions().surroundings)
        };
        let (solid, wanted) = run(Cuboid::solid([0.75; 3], [4.25; 3]).into());
        let (mesh, found) = run(cube([0.75, 4.25], |k| k).mesh().into());
        assert_eq!(found, wanted, "{engine:?}");
        assert!(found > 30, "{found}");
        for (a, b) in mesh.iter().zip(&solid) {
            let off = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            assert!(off.min((off - 6.0).abs()) < 1e-9, "{engine:?}: {a:?} {b:?}");
        }
    }
}

/// Bounces of a ball that falls on a mesh from above.
fn bounces(mesh: Mesh<f64>, engine: EngineKind, place: [f64; 3]) -> Vec<(f64, [f64; 3])> {
    let scene = Scene::<f64>::builder()
        .engine(engine)
        .dt(0.01)
        .gravity([0.0, 0.0, -10.0])
        .surroundings(mesh)
        .sphere(Sphere::new(place).radius(0.5));
    let mut events = Vec::new();
    world(scene)
        .for_each_event(0.9, |event| events.push((event.time, event.normal.to_array())))
        .unwrap();
    events
}

#[test]
fn triangles_without_area_are_touched_as_what_they_are() {
    let along = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.25, 0.0, 0.0]];
    let line = Mesh::new(&along, &[[0, 1, 2]]).unwrap();
    let point = Mesh::new(&[[0.5, 0.0, 0.0]], &[[0, 0, 0]]).unwrap();
    assert_eq!((line.report().degenerate, point.report().degenerate), (1, 1));
    for engine in ENGINES {
        for mesh in [&line, &point] {
            // It falls through 1.25 in half a second, and comes straight back.
            let events = bounces(mesh.clone(), engine, [0.5, 0.0, 1.75]);
            assert_eq!(events.len(), 1, "{engine:?}: {events:?}");
            let (time, normal) = events[0];
            assert!((time - 0.5).abs() < 1e-12 && (normal[2] - 1.0).abs() < 1e-12, "{events:?}");
        }
        // Beside the point there is nothing.
        assert_eq!(bounces(point.clone(), engine, [1.25, 0.0, 1.75]), []);
        assert_eq!(bounces(line.clone(), engine, [1.75, 0.0, 1.75]), []);
    }
}

#[test]
fn an_edge_of_three_triangles_is_hit_once() {
    let corners =
        [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, -1.0], [0.0, -1.0, -1.0], [0.0, 0.0, -1.0]];
    let fan = Mesh::new(&corners, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]).unwrap();
    assert_eq!(fan.report().non_manifold_edges, 1);
    for engine in ENGINES {
        let events = bounces(fan.clone(), engine, [0.0, 0.0, 1.75]);
        assert_eq!(events.len(), 1, "{engine:?}: {events:?}");
        assert!((events[0].0 - 0.5).abs() < 1e-12);
    }
}

/// On a roof, a ball that hops over the ridge touches it as the ridge that it is, and one in
/// the valley touches both sides.
#[test]
fn ridges_are_hit_and_valleys_are_not() {
    let bent = |up: f64| {
        let net = grid(20, |i, j| {
            let [x, y] = [i as f64 - 10.0, j as f64 - 10.0];
            [x, y, up * x.abs()]
        });
        net.mesh::<f64>()
    };
    assert_eq!(bent(0.5).report().faces, 2);
    for engine in ENGINES {
        let ridge = bounces(bent(-0.5), engine, [0.0, 0.375, 1.75]);
        assert_eq!(ridge.len(), 1, "{ridge:?}");
        assert!((ridge[0].1[2] - 1.0).abs() < 1e-12);
        // It comes to both sides of the valley at once.
        let valley = bounces(bent(0.5), engine, [0.0, 0.375, 1.75]);
        let leans = |normal: [f64; 3]| (normal[0].abs() - 0.2_f64.sqrt()).abs() < 1e-12;
        assert!(valley.len() >= 2 && valley.iter().all(|(_, n)| leans(*n)), "{valley:?}");
    }
}

/// Bodies over hills, in flight and rolling, at many times.
#[test]
fn no_ball_comes_into_a_mesh() {
    fn deepest<T: Compiled>(engine: EngineKind) -> f64 {
        let scene = over_hills::<T>(engine).build().unwrap();
        let facets = scene.surroundings[0].features();
        let mut world = World::new(scene, Execution::new().threads(1)).unwrap();
        let mut deepest = 0.0_f64;
        for _ in 0..20 {
            world.advance(0.1).unwrap();
            let bodies = world.bodies();
            for k in 0..bodies.len() {
                let (center, radius) = (bodies.position_of(k), bodies.radius.of(k));
                for facet in &facets {
                    let gap = facet.clearance(center, radius).gap.to_f64();
                    deepest = deepest.max(-gap / T::EPSILON.to_f64());
                }
            }
        }
        assert!(world.collisions().surroundings > 100);
        deepest
    }
    for engine in ENGINES {
        let [double, single] = [deepest::<f64>(engine), deepest::<f32>(engine)];
        // Coordinates of up to 8, and some roundings on the way to each.
        assert!(double < 200.0 && single < 200.0, "{engine:?}: {double} ε, {single} ε");
    }
}
