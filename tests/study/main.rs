//! The studies: orders, laws and figures that they have to find, and the
//! double-double that they take for the truth.

mod double_double;
mod precision;
mod scaling;
mod stability;
mod work_precision;

use carom::scene::SceneFile;

/// A scene from its text.
fn scene(text: &str) -> SceneFile {
    SceneFile::parse("scene", text).unwrap()
}
