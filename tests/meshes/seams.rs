//! A ball on a flat mesh moves as on a plane, bit for bit.

use carom::contact::Surface;
use carom::engine::{Compiled, Execution, World};
use carom::scene::{Encounters, EngineKind, Impact, Scene, Sphere};
use carom::surroundings::{Mesh, Plane, Shape};

use crate::common::numbers::Random;
use crate::{Net, grid};

const CELLS: usize = 100;

/// A flat mesh of 20,000 triangles of all forms about the origin.
fn flat() -> Net {
    let mut random = Random(1);
    let shifts: Vec<[f64; 2]> =
        (0..101 * 101).map(|_| [0.3 * random.unit::<f64>(), 0.3 * random.unit::<f64>()]).collect();
    grid(CELLS, |i, j| {
        let [x, y] = shifts[j * 101 + i];
        [i as f64 - 50.0 + x, j as f64 - 50.0 + y, 0.0]
    })
}

/// Balls that hop far, hop low, slide, spin and lie above seams and vertices.
fn balls<T: Compiled>(mesh: &Mesh<T>) -> Vec<Sphere> {
    let mut random = Random(2);
    let mut balls = Vec::new();
    for k in 0..60 {
        let speed = [3.0, 0.5, 8.0][k % 3];
        let angle = 3.0 * random.unit::<f64>();
        let height = [0.0, 1e-6, 0.01, 0.5][k / 3 % 4];
        let mut place = [20.0 * random.unit::<f64>(), 20.0 * random.unit::<f64>(), 0.5 + height];
        if k % 5 == 0 {
            let vertex = mesh.vertices()[100 * k + 3000].to_array().map(T::to_f64);
            if vertex[0].abs() < 20.0 && vertex[1].abs() < 20.0 {
                place = [vertex[0], vertex[1], place[2]];
            }
        }
        let up = [0.5, 1e-3, 0.0, 2.0][k / 12 % 4];
        balls.push(
            Sphere::new(place)
                .radius(0.5)
                .velocity([speed * angle.cos(), speed * angle.sin(), up])
                .spin([1.0, 2.0 * speed, -1.0]),
        );
    }
    balls
}

fn run<T: Compiled>(
    floor: Shape<T>,
    balls: &[Sphere],
    surface: Surface,
    engine: EngineKind,
    impact: Impact,
) -> (Vec<[u64; 6]>, u64) {
    let mut scene = Scene::<T>::builder()
        .engine(engine)
        .impact(impact)
        .dt(0.01)
        .gravity([0.0, 0.0, -10.0].map(T::from_f64))
        .surface(surface)
        .encounters(Encounters::Surroundings)
        .surroundings(floor);
    for ball in balls {
        scene = scene.sphere(ball.clone());
    }
    let mut world = World::new(scene.build().unwrap(), Execution::new().threads(1)).unwrap();
    world.advance(2.0).unwrap();
    let bodies = world.bodies();
    let bits = (0..bodies.len())
        .map(|k| {
            let (place, velocity) = (bodies.position_of(k), bodies.velocity_of(k));
            let [x, y, z] = place.to_array().map(|c| c.to_f64().to_bits());
            let [u, v, w] = velocity.to_array().map(|c| c.to_f64().to_bits());
            [x, y, z, u, v, w]
        })
        .collect();
    (bits, world.collisions().surroundings)
}

fn moves_as_on_a_plane<T: Compiled>() {
    let mesh = flat().mesh::<T>();
    assert_eq!(mesh.report().faces, 1);
    let plane = || Plane::new([T::ZERO; 3], [T::ZERO, T::ZERO, T::ONE]).into();
    let balls = balls(&mesh);
    for (engine, impact) in [
        (EngineKind::EventDriven, Impact::SubStep),
        (EngineKind::Stepped, Impact::SubStep),
        (EngineKind::Stepped, Impact::EndOfStep),
    ] {
        for surface in [Surface::Smooth, Surface::Rough] {
            // One that starts at rest on the floor falls onto it without end.
            let is_at_rest = |k: usize| [k / 3 % 4, k / 12 % 4] == [0, 2];
            let some = |k: usize| engine == EngineKind::Stepped || !is_at_rest(k);
            let balls: Vec<_> = balls
                .iter()
                .enumerate()
                .filter(|(k, _)| some(*k))
                .map(|(_, b)| b.clone())
                .collect();
            let (on_mesh, hits) = run::<T>(mesh.clone().into(), &balls, surface, engine, impact);
            let (on_plane, wanted) = run::<T>(plane(), &balls, surface, engine, impact);
            let what = format!("{} {engine:?} {impact:?} {surface:?}", T::NAME);
            for (k, (a, b)) in on_mesh.iter().zip(&on_plane).enumerate() {
                assert_eq!(a, b, "ball {k}, {what}: {:?}", balls[k]);
            }
            assert_eq!(hits, wanted, "{what}");
            assert!(hits > 300, "{what}: {hits}");
        }
    }
}

#[test]
fn a_ball_on_a_flat_mesh_moves_as_on_a_plane() {
    moves_as_on_a_plane::<f64>();
    moves_as_on_a_plane::<f32>();
}
