//! `carom scenes`: the built-in scenes.

use core::fmt::Write as _;

use carom::scene::{DEFAULT_SCENE, builtin_scenes};

use super::failure::Failure;
use super::print;
use super::scene_argument::unknown;

/// Lists the built-in scenes, or prints one as a file.
pub fn scenes(name: Option<&str>) -> Result<(), Failure> {
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
         `carom scenes NAME > my.toml` starts a scene file of your own from one.\n"
    );
    text
}
