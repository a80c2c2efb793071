//! Source: what a scene file is made from: its text, and what takes the place of values
//! in it.

use std::path::{self, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::error::SceneError;
use super::file::SceneFile;
use super::settings::{EngineKind, Precision};

/// What a [`SceneFile`] was made from, as plain data that can be kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SceneSource {
    /// What the summary calls it.
    pub name: String,
    path: String,
    folder: PathBuf,
    text: String,
    set: Vec<String>,
    /// In which numbers.
    pub precision: Precision,
    /// What moves it through time.
    pub engine: EngineKind,
    /// How long a run takes, time.
    pub duration: Option<f64>,
    dt: Option<f64>,
    seed: u64,
}

impl SceneFile {
    /// The file with other values: each assignment is `KEY=VALUE`, with a key path as
    /// errors name it and a value as the file would have it. What is no TOML value is
    /// taken for a text, so that quotes can be left out. A later assignment prevails.
    /// The public fields become what the file says then, but for the name.
    ///
    /// ```
    /// use carom::SceneFile;
    ///
    /// let file = SceneFile::builtin("superball").ok_or("no such scene")?;
    /// let file = file.with_values(&["surface.kind=smooth", "spheres[0].radius=0.25"])?;
    /// assert_eq!(file.build::<f64>()?.bodies.radius.of(0), 0.25);
    /// let error = file.with_values(&["spheres[0].radus=0.25"]).unwrap_err().to_string();
    /// assert!(error.starts_with("--set spheres[0].radus is not a key"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If a key leads nowhere or is unknown, or a value is of the wrong type.
    pub fn with_values<S: AsRef<str>>(&self, assignments: &[S]) -> Result<Self, SceneError> {
        let further = assignments.iter().map(|set| set.as_ref().to_owned());
        let set = self.set.iter().cloned().chain(further).collect();
        let read = Self::read(&self.path, Arc::clone(&self.text), set)?;
        Ok(Self { name: self.name.clone(), folder: self.folder.clone(), ..read })
    }

    /// What takes the place of the text's values, as [`with_values`] was given it.
    ///
    /// [`with_values`]: SceneFile::with_values
    #[must_use]
    pub fn values(&self) -> &[String] {
        &self.set
    }

    /// All that the file says and that was put in its place, as plain data.
    ///
    /// ```
    /// use carom::SceneFile;
    ///
    /// let mut file = SceneFile::parse("ball", "[[spheres]]\nposition = [0, 0, 0]\nradius = 1\n")?;
    /// file.duration = Some(2.0);
    /// let again = SceneFile::of_source(file.source())?;
    /// assert_eq!((again.duration, again.name.as_str()), (Some(2.0), "ball"));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn source(&self) -> SceneSource {
        SceneSource {
            name: self.name.clone(),
            path: self.path.clone(),
            folder: path::absolute(&self.folder).unwrap_or_else(|_| self.folder.clone()),
            text: self.text.to_string(),
            set: self.set.clone(),
            precision: self.precision,
            engine: self.engine,
            duration: self.duration,
            dt: self.dt,
            seed: self.seed,
        }
    }

    /// The file that has a source.
    ///
    /// # Errors
    /// As [`parse`](SceneFile::parse).
    pub fn of_source(source: SceneSource) -> Result<Self, SceneError> {
        let SceneSource { name, path, folder, text, set, precision, engine, duration, dt, seed } =
            source;
        let read = Self::read(&path, text.into(), set)?;
        Ok(Self { name, folder, precision, engine, duration, dt, seed, ..read })
    }
}
