//! Subject: the scene that a study is of, as its files describe it.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use serde::Serialize;
use xxhash_rust::xxh3::Xxh3Default;

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
    /// What takes the place of the file's values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// The hashes of the files that it takes spheres from.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<String>,
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
            set: file.values().to_vec(),
            states: file.state_files().iter().map(|path| hash(path)).collect(),
        }
    }
}

/// XXH3-64 of a file's bytes.
fn hash(path: &Path) -> String {
    let read = || -> io::Result<u64> {
        let mut file = File::open(path)?;
        let mut hasher = Xxh3Default::new();
        let mut piece = vec![0; 1 << 16];
        loop {
            match file.read(&mut piece)? {
                0 => return Ok(hasher.digest()),
                length => hasher.update(&piece[..length]),
            }
        }
    };
    // Neither a pipe nor a device has an end. The scene that cannot be built says what is wrong with the file.
    let hashed = if path.is_file() { read() } else { Err(io::ErrorKind::InvalidInput.into()) };
    hashed.map_or_else(|_| "unreadable".to_owned(), |hash| format!("{hash:#018x}"))
}
