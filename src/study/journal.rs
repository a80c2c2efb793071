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
    /// The results, and the lines that they stand on.
    finished: HashMap<String, (usize, Value)>,
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
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(failed(error)),
        };
        // A line that an interrupt has cut off does not end.
        let end = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        let whole = &bytes[..end];
        let mut lines = whole.split_inclusive(|byte| *byte == b'\n').zip(1..);
        let mut finished = HashMap::new();
        if let Some((first, number)) = lines.next() {
            let old: Heading = read(path, number, first)?;
            if old != heading {
                return Err(StudyError::AnotherStudy(path.into()));
            }
        }
        for (line, number) in lines {
            let Entry { point, result } = read(path, number, line)?;
            finished.insert(point, (number, result));
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
        let Some((line, result)) = self.finished.get(point) else { return Ok(None) };
        let result = serde_json::from_value(result.clone());
        result.map(Some).map_err(|error| damaged(&self.path, *line, &error))
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

/// What stands on a line.
fn read<R: DeserializeOwned>(path: &Path, number: usize, line: &[u8]) -> Result<R, StudyError> {
    serde_json::from_slice(line).map_err(|error| damaged(path, number, &error))
}

fn damaged(path: &Path, line: usize, error: &serde_json::Error) -> StudyError {
    // The line that it counts is that of the text that it was given.
    let reason = error.to_string();
    let reason = reason.split_once(" at line ").map_or(reason.as_str(), |(reason, _)| reason);
    StudyError::Damaged { path: path.into(), line, reason: reason.to_owned() }
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

    #[test]
    fn a_damaged_line_is_named() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("points.jsonl");
        let journal = Journal::open(&path, &"a study")?;
        journal.keep("one", &1.5)?;
        journal.keep("two", &2.5)?;
        let text = fs::read(&path)?;
        let damages: [(&[u8], usize); 4] =
            [(b"carom", 1), (b"\"one\"", 2), (b"{\"point\":\"two", 3), (b"1.5", 2)];
        for (damaged, line) in damages {
            let at = text.windows(damaged.len()).position(|window| window == damaged);
            let mut text = text.clone();
            text[at.ok_or("not there")?] = 0xff;
            fs::write(&path, text)?;
            let error = Journal::open(&path, &"a study").map(drop).unwrap_err().to_string();
            assert!(error.contains(&format!("points.jsonl:{line}:")), "{error}");
            assert!(error.contains("--restart"), "{error}");
        }
        // A result that is one, but of something else.
        fs::write(&path, String::from_utf8(text)?.replace("2.5", "\"2.5\""))?;
        let error = Journal::open(&path, &"a study")?.result::<f64>("two").unwrap_err();
        assert!(error.to_string().contains("points.jsonl:3:"), "{error}");
        Ok(())
    }
}
