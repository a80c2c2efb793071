//! What holds of every input, tried on inputs out of seeds: bytes of any kind, and scene
//! files with some of their text changed. `fuzz/` tries the same for as long as one
//! likes.

#[path = "common/mod.rs"]
mod common;
#[path = "common/properties/mod.rs"]
mod properties;

use std::path::Path;

use carom::scene::builtin_scenes;
use properties::{Inputs, Kind, Outcome, PROPERTIES, corpus};

/// Tries a property on `count` inputs, of which at least `least` are to be scenes.
fn tries(name: &str, count: u64, least: usize) {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let kind = Kind::of(name);
    let given = match kind {
        Kind::Bytes => Vec::new(),
        Kind::File => corpus(&package.join("tests/data/meshes")),
        Kind::Text => builtin_scenes().iter().map(|scene| scene.text.into()).collect(),
    };
    let inputs = Inputs::new(given, kind);
    let (_, property) = PROPERTIES.into_iter().find(|(found, _)| *found == name).unwrap();
    let mut outcomes = [0; 3];
    for number in 0..count {
        outcomes[property(&inputs.input(number)) as usize] += 1;
    }
    // What has broken a property before is among the corpus; a package has none.
    for file in corpus(&package.join("fuzz/corpus").join(name)) {
        property(&file);
    }
    println!("{name}: refused, ran, stopped: {outcomes:?}");
    assert!(outcomes[Outcome::Ran as usize] >= least, "{outcomes:?}");
}

#[test]
fn any_text_is_a_scene_or_an_error() {
    tries("text", 10_000, 100);
}

#[test]
fn any_file_of_a_surface_is_a_mesh_or_an_error() {
    tries("mesh", 20_000, 2_000);
}

#[test]
fn any_calls_of_the_builder_are_a_scene_or_an_error() {
    tries("builder", 20_000, 200);
}

#[test]
fn scenes_keep_what_elastic_motion_keeps_event_by_event() {
    tries("event_driven", 2_000, 1_000);
}

#[test]
fn scenes_keep_what_elastic_motion_keeps_in_steps() {
    tries("stepped", 2_000, 1_000);
}
