//! `carom scenes`: the built-in scenes, and the schema of scene files.

use core::fmt::Write as _;

use carom::scene::{DEFAULT_SCENE, builtin_scenes, scene_schema};

use super::failure::Failure;
use super::print;
use super::scene_argument::unknown;

/// Lists the built-in scenes, or prints one as a file, or the schema of all files.
pub fn scenes(name: Option<&str>, schema: bool) -> Result<(), Failure> {
    if schema {
        return print(&(scene_schema() + "\n"));
    }
    let Some(name) = name else { return print(&list()) };
    match builtin_scenes().iter().find(|scene| scene.name == name) {
        Some(scene) => print(scene.text),
        None => Err(Failure::Argument(unknown(name))),
    }
}

fn list() -> String {
    let scenes = builtin_scenes();
    let width = scenes.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for scene in scenes {
        let _ = writeln!(text, "{:width$}  {}", scene.name, scene.summary);
    }
    let _ = write!(
        text,
        "\n`carom run NAME` runs one; `{DEFAULT_SCENE}` is run when none is named.\n\
         `carom scenes NAME > my.toml` starts a scene file of your own from one.\n\
         `carom scenes --schema > carom.schema.json` is for an editor that checks and completes it.\n"
    );
    text
}
