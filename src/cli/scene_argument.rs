//! The scene that the arguments name, with the options in place of the file's
//! values.

use std::path::Path;

use carom::scene::{DEFAULT_SCENE, EngineKind, SceneFile, builtin_scenes};

use super::arguments::SceneArguments;
use super::failure::Failure;
use super::plain;

/// Reads the scene that the arguments name.
pub fn scene_file(arguments: &SceneArguments) -> Result<SceneFile, Failure> {
    let mut file = match &arguments.scene {
        None => builtin(DEFAULT_SCENE)?,
        Some(path) if is_path(path) => {
            let mut file = SceneFile::load(path)?;
            // It is printed in summaries and reports, and made from a file's name.
            file.name = plain(&file.name);
            file
        }
        Some(name) => builtin(&name.to_string_lossy())?,
    };
    if !arguments.set.is_empty() {
        file = file.with_values(&arguments.set)?;
    }
    Ok(with_options(file, arguments))
}

/// The scene file with the options in place of its values.
pub fn with_options(mut file: SceneFile, arguments: &SceneArguments) -> SceneFile {
    if let Some(engine) = arguments.engine {
        file.engine = engine;
    } else if arguments.dt.is_some() && !file.names_engine() {
        // As a `[stepped]` table does.
        file.engine = EngineKind::Stepped;
    }
    if let Some(precision) = arguments.precision {
        file.precision = precision;
    }
    if let Some(seed) = arguments.seed {
        file.seed = seed;
    }
    file.duration = arguments.duration.or(file.duration);
    file.dt = arguments.dt.or(file.dt);
    file
}

/// Whether an argument means a file rather than a built-in scene.
fn is_path(argument: &Path) -> bool {
    let has_separator = argument.as_os_str().to_string_lossy().chars().any(std::path::is_separator);
    let is_toml = argument.extension().is_some_and(|ending| ending == "toml");
    has_separator || is_toml || argument.is_file() || (argument.exists() && !is_builtin(argument))
}

/// Whether a built-in scene has that name.
fn is_builtin(name: &Path) -> bool {
    builtin_scenes().iter().any(|scene| name == Path::new(scene.name))
}

/// The built-in scene of that name.
pub fn builtin(name: &str) -> Result<SceneFile, Failure> {
    SceneFile::builtin(name).ok_or_else(|| Failure::Argument(unknown(name)))
}

/// What to say to a name that no scene has.
pub fn unknown(name: &str) -> String {
    /// Likeness, from 0 to 1, from which a name may have been meant.
    const LIKE: f64 = 0.75;
    let names = builtin_scenes().iter().map(|scene| scene.name);
    let likeness = |other: &str| strsim::jaro_winkler(&name.to_lowercase(), other);
    let nearest = names.clone().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let meant = match nearest {
        Some(other) if likeness(other) >= LIKE => format!(" Did you mean `{other}`?"),
        _ => String::new(),
    };
    format!(
        "there is no built-in scene `{name}`.{meant} There are {}; \
         a scene file is given by its path, ending in .toml",
        names.collect::<Vec<_>>().join(", ")
    )
}
