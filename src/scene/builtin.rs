//! Built-in scenes: files that come with the program, to run and to start from.

/// A scene file that comes with the program.
///
/// ```
/// use carom::scene::{SceneFile, builtin_scenes};
///
/// for scene in builtin_scenes() {
///     println!("{:<18}{}", scene.name, scene.summary);
///     SceneFile::parse(scene.name, scene.text)?;
/// }
/// # Ok::<(), carom::SceneError>(())
/// ```
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct BuiltinScene {
    /// What to call it by.
    pub name: &'static str,
    /// What it shows, in a line.
    pub summary: &'static str,
    /// The file.
    pub text: &'static str,
}

/// The scene that is run when none is named.
///
/// ```
/// use carom::scene::{DEFAULT_SCENE, SceneFile};
/// assert!(SceneFile::builtin(DEFAULT_SCENE).is_some());
/// ```
pub const DEFAULT_SCENE: &str = "rough-gas";

macro_rules! scenes {
    ($($name:literal: $summary:literal,)*) => {
        &[$(BuiltinScene {
            name: $name,
            summary: $summary,
            text: include_str!(concat!("builtin/", $name, ".toml")),
        },)*]
    };
}

/// All built-in scenes, the default first.
///
/// ```
/// use carom::scene::{DEFAULT_SCENE, builtin_scenes};
/// assert_eq!(builtin_scenes()[0].name, DEFAULT_SCENE);
/// ```
#[must_use]
pub fn builtin_scenes() -> &'static [BuiltinScene] {
    scenes! {
        "rough-gas": "20,000 rough spheres in a container under gravity",
        "bouncing-ball": "a ball on a floor, after 1,000 bounces as high as at the start",
        "newtons-cradle": "five balls in a row, one of them swung in",
        "superball": "a rough ball between floor and ceiling, where it turns back",
        "hard-sphere-fluid": "10,976 smooth spheres in a periodic cube at density 0.5",
        "mixture": "spheres of many sizes and masses, 1 to 10, in a container",
        "lorentz-gas": "1,000 balls among fixed ones, at their mean free path",
        "pi": "a heavy ball, a light one and a wall: 314,159 collisions",
        "wedge": "a ball between two slopes under gravity, never at rest",
        "giant-in-dust": "a sphere among 5,000 that are a hundred times smaller",
        "galton-board": "100,000 balls fall through 2,000 pins between two panes, into bins",
        "funnel": "rough balls fall through a funnel into a container",
        "hopper": "balls come into a hopper, fall through its outlet and are taken out",
        "drum": "rough balls in a drum that lies on its side",
        "sinai-billiard": "a ball between four walls, with a post in the middle",
        "ball-in-torus": "a ball in a torus, which keeps its angular momentum about the axis",
        "ball-in-tube": "a rough ball in a vertical tube, which comes up again",
        "terrain": "1,000 rough balls on hills of 2,048 triangles",
        "free-flight": "100,000 spinning spheres that meet nothing",
    }
}
