//! The studies from outside: their folders, their interruptions, their
//! mistakes.

mod error;
mod precision;
mod scaling;

use super::{BOX, FLUID, Folder};

#[test]
fn unknown_studies_and_scenes_are_named() {
    let folder = Folder::with(BOX);
    let said = folder.says("study");
    assert_eq!(said.status, Some(2));
    for study in ["error", "precision", "scaling"] {
        assert!(said.errors.contains(study), "{study}");
    }
    let message = folder.says("study precisoin scene.toml").fails_with(2);
    assert!(message.contains("precisoin"), "{message}");
    let message = folder.says("study error no-such-scene").fails_with(2);
    assert!(message.contains("no built-in scene `no-such-scene`"), "{message}");
    let message = folder.says("study error").fails_with(2);
    assert!(message.contains("<SCENE>"), "{message}");
    assert_eq!(folder.names(), ["scene.toml"]);
}
