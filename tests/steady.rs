//! A batch allocates nothing once it is under way.

use std::alloc::System;

use cap::Cap;
use carom::contact::Surface;
use carom::engine::{Batch, Compiled, Execution};
use carom::scene::{EngineKind, Impact, Scene, Spheres};
use carom::surroundings::Cuboid;

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Bytes allocated by calls on a thread of their own each: a pool's list of work grows now
/// and then.
const A_CALL: u64 = 1 << 10;

fn batch<T: Compiled>(surface: Surface, impact: Impact, threads: usize) -> Batch<T> {
    let t3 = |vector: [f64; 3]| vector.map(T::from_f64);
    let spheres = Spheres::random(16).radius(0.5).temperature(1.0).spin_temperature(1.0);
    let scene = Scene::<T>::builder()
        .engine(EngineKind::Stepped)
        .gravity(t3([0.0, 0.0, -1.0]))
        .surface(surface)
        .impact(impact)
        .dt(0.01)
        .surroundings(Cuboid::container(t3([0.0; 3]), t3([4.0; 3])))
        .spheres(spheres.within([0.0; 3], [4.0; 3]).seed(1))
        .build()
        .unwrap();
    Batch::varied(&scene, 200, Execution::new().threads(threads), |k, scene| {
        scene.bodies.velocity[0][0] = T::from_f64(0.01 * k as f64);
    })
    .unwrap()
}

/// Bytes allocated by some calls, and how many collisions there were.
fn allocated<T: Compiled>(batch: &mut Batch<T>, calls: u64) -> (u64, u64) {
    batch.advance_steps(100).unwrap();
    // The first impulse of a smooth scene that spins makes room for orientations.
    for scene in 0..batch.len() {
        batch.apply_impulse(scene, 3, [T::ONE; 3]).unwrap();
    }
    let before = ALLOCATOR.total_allocated() as u64;
    for call in 0..calls {
        batch.advance_steps(2).unwrap();
        batch.apply_impulse(call as usize, 3, [T::ONE; 3]).unwrap();
    }
    let bytes = ALLOCATOR.total_allocated() as u64 - before;
    assert_eq!(batch.faults().map(|(k, fault)| (k, fault.to_string())).next(), None);
    (bytes, batch.collisions().map(|collisions| collisions.total()).sum())
}

/// One test, since the count is one for all. What has one thread comes first: the threads of
/// a pool that has gone may still be ending.
#[test]
fn nothing_is_allocated_under_way() {
    const SURFACES: [Surface; 2] = [Surface::Smooth, Surface::Rough];
    const IMPACTS: [Impact; 2] = [Impact::EndOfStep, Impact::SubStep];
    let kinds = || SURFACES.iter().flat_map(|surface| IMPACTS.map(|impact| (*surface, impact)));
    for (surface, impact) in kinds() {
        for (bytes, collisions) in [
            allocated(&mut batch::<f32>(surface, impact, 1), 100),
            allocated(&mut batch::<f64>(surface, impact, 1), 100),
        ] {
            assert_eq!(bytes, 0, "{surface}, {impact}");
            assert!(collisions > 20_000, "{collisions}");
        }
    }
    for (surface, impact) in kinds() {
        let (bytes, _) = allocated(&mut batch::<f64>(surface, impact, 2), 100);
        assert!(bytes <= 100 * A_CALL, "{bytes} on two threads");
    }
}
