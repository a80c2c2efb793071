//! The same bits in every lane width and for any number of threads.

use carom::bodies::Bodies;
use carom::engine::{Compiled, Execution, Lanes};
use carom::observe::state_hash;
use carom::scene::Impact;
use carom::scene::{SceneFile, builtin_scenes};

use crate::world;

/// Bodies × steps that a path of a scene takes.
const WORK: usize = 600_000;

const PATHS: [Execution; 5] = [
    Execution::new().lanes(Lanes::Scalar).threads(1),
    Execution::new().lanes(Lanes::Four).threads(2),
    Execution::new().lanes(Lanes::Eight).threads(1),
    Execution::new().lanes(Lanes::Sixteen).threads(2),
    Execution::new().lanes(Lanes::Auto).threads(2),
];

fn bodies_of<T: Compiled>(scene: &SceneFile, impact: Impact, execution: Execution) -> Bodies<T> {
    let mut scene = scene.build::<T>().unwrap();
    scene.stepped.impact = impact;
    let steps = (WORK / scene.bodies.len().max(1)).clamp(20, 4_000) as u64;
    let mut world = world(scene, execution);
    world.advance_steps(steps);
    world.bodies()
}

fn paths_agree<T: Compiled>(impact: Impact) {
    for builtin in builtin_scenes() {
        let scene = SceneFile::builtin(builtin.name).unwrap();
        let [first, others @ ..] = PATHS;
        let expected = state_hash(&bodies_of::<T>(&scene, impact, first));
        for path in others {
            let found = state_hash(&bodies_of::<T>(&scene, impact, path));
            assert_eq!(found, expected, "{} in {} {impact:?} {path:?}", builtin.name, T::NAME);
        }
    }
}

#[test]
fn every_builtin_scene_at_the_end_of_the_step() {
    paths_agree::<f32>(Impact::EndOfStep);
    paths_agree::<f64>(Impact::EndOfStep);
}

#[test]
fn every_builtin_scene_within_the_step() {
    paths_agree::<f32>(Impact::SubStep);
    paths_agree::<f64>(Impact::SubStep);
}
