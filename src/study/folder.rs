//! Folder: where a study keeps its results.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process;

use serde::Serialize;

use super::{Journal, StudyError};
use crate::output::{Listed, write_whole};

/// The file with the results of single points.
const JOURNAL: &str = "points.jsonl";

/// The file that one process at a time has locked, with its number.
const LOCK: &str = ".carom.lock";

/// A folder that is there, and that no other process writes into.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    _lock: Lock,
}

/// A file that is locked as long as it is open, however the process ends.
#[derive(Debug)]
struct Lock {
    path: PathBuf,
    _file: File,
    _listed: Listed,
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Still locked: whoever has opened it already finds that it is gone.
        let _ = fs::remove_file(&self.path);
    }
}

impl Folder {
    /// A folder, made if it is not there. The one around it has to be.
    ///
    /// # Errors
    /// If it cannot be made or written, or if another study is under way in it.
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
        let path = PathBuf::from(path);
        let lock = Lock::of(&path)?;
        Ok(Self { path, _lock: lock })
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

impl Lock {
    /// The lock of a folder, taken. A file system without locks has none to take.
    fn of(folder: &Path) -> Result<Self, StudyError> {
        let path = folder.join(LOCK);
        let failed = |source| StudyError::File { path: path.clone(), source };
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let mut attempts = 0;
        loop {
            attempts += 1;
            let mut file = options.open(&path).map_err(failed)?;
            if let Err(TryLockError::WouldBlock) = file.try_lock() {
                let mut process = String::new();
                // Without its number the sentence still says what is wrong.
                let _ = file.take(20).read_to_string(&mut process);
                let process = process.trim().parse().ok();
                return Err(StudyError::UnderWay { path: folder.into(), process });
            }
            if is_at(&file, &path) || attempts > 100 {
                file.set_len(0).map_err(failed)?;
                writeln!(file, "{}", process::id()).map_err(failed)?;
                let listed = Listed::new(path.clone());
                return Ok(Self { path, _file: file, _listed: listed });
            }
        }
    }
}

/// Whether a file is still the one of that name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |metadata: fs::Metadata| (metadata.dev(), metadata.ino());
    match (file.metadata(), fs::metadata(path)) {
        (Ok(own), Ok(named)) => identity(own) == identity(named),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

/// Writes a whole file, or none.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    write_whole(path, bytes).map_err(|source| StudyError::File { path: path.into(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_study_at_a_time() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let first = Folder::open(folder.path())?;
        let second = Folder::open(folder.path());
        let own = process::id();
        assert!(
            matches!(second, Err(StudyError::UnderWay { process: Some(found), .. }) if found == own)
        );
        drop(first);
        Folder::open(folder.path())?;
        Ok(())
    }
}
