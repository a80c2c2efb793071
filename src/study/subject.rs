//! Subject: the scene that a study is of, as its files describe it.

use serde::Serialize;

use super::{Folder, StudyError};
use crate::scene::SceneFile;

/// A scene, and what options have put in the place of its values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Subject {
    /// What it is called.
    pub name: String,
    /// How long it is simulated, in its own unit of time.
    pub duration: Option<f64>,
    /// Length of a step, in its own unit of time.
    pub dt: Option<f64>,
    /// The seed of its random numbers.
    pub seed: u64,
    /// The scene file.
    pub text: String,
}

impl Subject {
    /// Of a scene file.
    #[must_use]
    pub fn of(file: &SceneFile) -> Self {
        Self {
            name: file.name.clone(),
            duration: file.duration,
            dt: file.dt,
            seed: file.seed,
            text: file.text().to_owned(),
        }
    }

    /// Puts the scene file into the folder, as `scene.toml`.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, folder: &Folder) -> Result<(), StudyError> {
        folder.write("scene.toml", self.text.as_bytes())
    }
}
