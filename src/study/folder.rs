//! Folder: where a study keeps its results.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Journal, StudyError};

/// The file with the results of single points.
const JOURNAL: &str = "points.jsonl";

/// A folder that is there.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// A folder, made if it is not there. The one around it has to be.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn open(path: &Path) -> Result<Self, StudyError> {
        let refused = |reason: String| StudyError::NoFolder { path: path.into(), reason };
        match fs::create_dir(path) {
            Ok(()) => {}
            Err(_) if path.is_dir() => {}
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                return Err(refused("it is a file; give the path of a folder".to_owned()));
            }
            Err(error) => return Err(refused(error.to_string())),
        }
        Ok(Self { path: path.into() })
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The results so far of a study; `study` is all that they depend on.
    ///
    /// # Errors
    /// As [`Journal::open`].
    pub fn journal(&self, study: &impl Serialize) -> Result<Journal, StudyError> {
        Journal::open(&self.path.join(JOURNAL), study)
    }

    /// Forgets all results.
    ///
    /// # Errors
    /// If the file cannot be removed.
    pub fn forget(&self) -> Result<(), StudyError> {
        let path = self.path.join(JOURNAL);
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                Err(StudyError::File { path, source })
            }
            _ => Ok(()),
        }
    }

    /// Writes a whole file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StudyError> {
        write(&self.path.join(name), bytes)
    }

    /// Writes a file of JSON, in lines for people.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write_json(&self, name: &str, value: &impl Serialize) -> Result<(), StudyError> {
        let path = self.path.join(name);
        let text = serde_json::to_string_pretty(value)
            .map_err(|error| StudyError::File { path: path.clone(), source: error.into() })?;
        write(&path, (text + "\n").as_bytes())
    }

    /// Writes a table of comma-separated values, whose header are the names of
    /// the rows' fields.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write_csv<R: Serialize>(&self, name: &str, rows: &[R]) -> Result<(), StudyError> {
        let path = self.path.join(name);
        let mut table = csv::Writer::from_writer(Vec::new());
        let failed = |source: io::Error| StudyError::File { path: path.clone(), source };
        for row in rows {
            table.serialize(row).map_err(|error| failed(io::Error::other(error)))?;
        }
        let bytes = table.into_inner().map_err(|error| failed(error.into_error()))?;
        write(&path, &bytes)
    }
}

/// Writes a whole file, or none: under another name first, so that nothing half
/// written ever has its own.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".tmp");
    let written = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, path));
    written.map_err(|source| {
        // The file that stays is not worth a second message.
        let _ = fs::remove_file(&beside);
        StudyError::File { path: path.into(), source }
    })
}
