//! Journal: the results of a study, point by point, in a file that an
//! interrupted study goes on from.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::StudyError;

/// The results so far. Each is a line of JSON, written whole as soon as it is
/// there: what ends the program loses at most the points under way.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    finished: HashMap<String, Value>,
    file: Option<Mutex<File>>,
}

/// The first line: of which study these are the results.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Heading {
    carom: String,
    study: Value,
}

/// A line: the result of a point.
#[derive(Serialize, Deserialize)]
struct Entry {
    point: String,
    result: Value,
}

impl Journal {
    /// A journal in memory only.
    #[must_use]
    pub fn unwritten() -> Self {
        Self { path: PathBuf::new(), finished: HashMap::new(), file: None }
    }

    /// The journal at a path, begun now or gone on with. `study` is all that the
    /// results depend on.
    ///
    /// # Errors
    /// If the file cannot be read or written, or holds the results of another
    /// study.
    pub fn open(path: &Path, study: &impl Serialize) -> Result<Self, StudyError> {
        let failed = |source| StudyError::File { path: path.into(), source };
        let heading = Heading {
            carom: env!("CARGO_PKG_VERSION").to_owned(),
            study: serde_json::to_value(study).map_err(io::Error::from).map_err(failed)?,
        };
        let text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(failed(error)),
        };
        // A line that an interrupt has cut off does not end.
        let whole = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
        let mut lines = whole.lines();
        let mut finished = HashMap::new();
        match lines.next() {
            None => {}
            Some(first) if serde_json::from_str(first).is_ok_and(|old: Heading| old == heading) => {
                for line in lines {
                    let Entry { point, result } =
                        serde_json::from_str(line).map_err(io::Error::from).map_err(failed)?;
                    finished.insert(point, result);
                }
            }
            Some(_) => return Err(StudyError::AnotherStudy(path.into())),
        }
        let mut file = OpenOptions::new().create(true).append(true).open(path).map_err(failed)?;
        file.set_len(whole.len() as u64).map_err(failed)?;
        if whole.is_empty() {
            file.write_all(line(&heading).map_err(failed)?.as_bytes()).map_err(failed)?;
        }
        Ok(Self { path: path.into(), finished, file: Some(Mutex::new(file)) })
    }

    /// How many points it has.
    #[must_use]
    pub fn len(&self) -> usize {
        self.finished.len()
    }

    /// Whether it has none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.finished.is_empty()
    }

    /// Whether the result of a point was there when the journal was opened.
    #[must_use]
    pub fn has(&self, point: &str) -> bool {
        self.finished.contains_key(point)
    }

    /// The result of a point, if it was there when the journal was opened.
    ///
    /// # Errors
    /// If it is not what it should be.
    pub fn result<R: DeserializeOwned>(&self, point: &str) -> Result<Option<R>, StudyError> {
        let found = self.finished.get(point).cloned();
        found.map(serde_json::from_value).transpose().map_err(|error| self.failed(error.into()))
    }

    /// Writes down the result of a point.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn keep(&self, point: &str, result: &impl Serialize) -> Result<(), StudyError> {
        let Some(file) = &self.file else { return Ok(()) };
        let result = serde_json::to_value(result).map_err(|error| self.failed(error.into()))?;
        let entry = Entry { point: point.to_owned(), result };
        let line = line(&entry).map_err(|error| self.failed(error))?;
        let mut file = file.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        file.write_all(line.as_bytes()).map_err(|error| self.failed(error))
    }

    fn failed(&self, source: io::Error) -> StudyError {
        StudyError::File { path: self.path.clone(), source }
    }
}

/// A line of JSON, with its end.
fn line(value: &impl Serialize) -> io::Result<String> {
    Ok(serde_json::to_string(value)? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_on_where_it_was_cut_off() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("points.jsonl");
        Journal::open(&path, &"a study")?.keep("one", &1.5)?;
        fs::write(&path, fs::read_to_string(&path)? + "{\"point\":\"two\",\"res")?;
        let journal = Journal::open(&path, &"a study")?;
        assert_eq!((journal.result("one")?, journal.result::<f64>("two")?), (Some(1.5), None));
        journal.keep("two", &2.5)?;
        drop(journal);
        let journal = Journal::open(&path, &"a study")?;
        assert_eq!((journal.len(), journal.result("two")?), (2, Some(2.5)));
        let other = Journal::open(&path, &"another study");
        assert!(matches!(other, Err(StudyError::AnotherStudy(_))));
        Ok(())
    }
}
