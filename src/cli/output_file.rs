//! Output file: one that has its name only once it is whole.

use core::cell::Cell;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use carom::output::WholeFile;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::failure::Failure;

/// A file that cannot be written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The path cannot take a file.
    #[error("{} cannot be written: {reason}", path.display())]
    Path {
        /// The path as it was given.
        path: PathBuf,
        /// Why, and what would be right.
        reason: String,
    },
    /// Writing stopped part way.
    #[error("{} could not be written to its end: {source}", path.display())]
    Write {
        /// The path as it was given.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

impl OutputError {
    /// Whether the reader at the other end of a pipe went away.
    #[must_use]
    pub fn is_closed_pipe(&self) -> bool {
        matches!(self, Self::Write { source, .. } if source.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Where a path leads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Destination {
    /// The program's standard output.
    StandardOutput,
    /// A regular file, there or not yet, by its path without links.
    Regular(PathBuf),
    /// A device or a pipe: written straight into, and never replaced.
    Special(PathBuf),
}

/// How many symbolic links in a row a path may lead over.
const MOST_LINKS: usize = 40;

impl Destination {
    /// The regular file that an option names, which is replaced as a whole.
    ///
    /// # Errors
    /// If no file can be at the path, or a device or a pipe is.
    pub fn replaceable(option: &'static str, path: &Path) -> Result<PathBuf, Failure> {
        match Self::of(path).map_err(|source| Failure::Open { option, source })? {
            Self::Regular(target) => Ok(target),
            Self::StandardOutput | Self::Special(_) => Err(Failure::Argument(format!(
                "{option} is {}, no file that can be replaced",
                path.display()
            ))),
        }
    }

    /// Follows a path. `-` is the standard output.
    ///
    /// # Errors
    /// If no file can be at the path.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        Self::follow(path).map_err(|reason| OutputError::Path { path: path.into(), reason })
    }

    fn follow(given: &Path) -> Result<Self, String> {
        if ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"]
            .iter()
            .any(|p| given == Path::new(p))
        {
            return Ok(Self::StandardOutput);
        }
        let mut path = given.to_path_buf();
        for _ in 0..MOST_LINKS {
            match fs::metadata(&path) {
                Ok(metadata) if metadata.is_dir() => {
                    return Err("it is a folder; give the path of a file".into());
                }
                Ok(metadata) if is_standard_output(&metadata) => return Ok(Self::StandardOutput),
                Ok(metadata) if metadata.is_file() => {
                    return path.canonicalize().map(Self::Regular).map_err(|e| e.to_string());
                }
                Ok(metadata) => return special(path, &metadata),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error.to_string()),
            }
            let folder = folder_of(&path);
            match fs::read_link(&path) {
                // A link to a file that is not there yet.
                Ok(target) => path = folder.join(target),
                Err(_) => return not_yet_there(&path, &folder),
            }
        }
        Err("it leads over too many symbolic links".into())
    }
}

/// What is no file: a device that takes bytes one after the other, such as
/// `/dev/null`, or a pipe that is open already, such as a shell's `>(gzip)`.
#[cfg(unix)]
fn special(path: PathBuf, metadata: &Metadata) -> Result<Destination, String> {
    use std::os::unix::fs::FileTypeExt;
    let kind = metadata.file_type();
    // A pipe without a name has no path of its own that could be opened, and that
    // would wait for a reader.
    let is_open_pipe = kind.is_fifo() && path.canonicalize().is_err();
    let what = match () {
        () if kind.is_char_device() || is_open_pipe => return Ok(Destination::Special(path)),
        () if kind.is_fifo() => "a named pipe, which waits for its reader",
        () if kind.is_block_device() => "a disk",
        () if kind.is_socket() => "a socket",
        () => "no file",
    };
    Err(format!("it is {what}; give the path of a file, or - for standard output"))
}

#[cfg(not(unix))]
fn special(path: PathBuf, _: &Metadata) -> Result<Destination, String> {
    Ok(Destination::Special(path))
}

/// A regular file that is still to be made.
fn not_yet_there(path: &Path, folder: &Path) -> Result<Destination, String> {
    let is_folder_name =
        path.as_os_str().as_encoded_bytes().last().is_some_and(|&b| b == b'/' || b == b'\\');
    let (Some(name), false) = (path.file_name(), is_folder_name) else {
        return Err("that is no name of a file".into());
    };
    let folder = folder.canonicalize().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => format!("there is no folder {}", folder.display()),
        _ => error.to_string(),
    })?;
    Ok(Destination::Regular(folder.join(name)))
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.into(),
        _ => PathBuf::from("."),
    }
}

/// Whether a file or pipe is the one that standard output goes to, under
/// whatever name: replacing it would cut off what is printed later.
#[cfg(unix)]
fn is_standard_output(metadata: &Metadata) -> bool {
    use std::os::unix::fs::{FileTypeExt, MetadataExt};
    let is_stream = metadata.is_file() || metadata.file_type().is_fifo();
    let identity = |metadata: &Metadata| (metadata.dev(), metadata.ino());
    let printed = fs::metadata("/dev/stdout");
    is_stream && printed.is_ok_and(|printed| identity(&printed) == identity(metadata))
}

#[cfg(not(unix))]
fn is_standard_output(_: &Metadata) -> bool {
    false
}

/// A file under way. A regular file is written beside its final name, and gets
/// the name, and replaces what had it, with [`finish`](OutputFile::finish):
/// nothing half written is ever under it. Dropped before that, it leaves
/// nothing.
#[derive(Debug)]
pub struct OutputFile {
    path: PathBuf,
    output: Output,
}

#[derive(Debug)]
enum Output {
    Beside(WholeFile),
    Part(Part),
    Straight(File),
    Standard(io::Stdout),
}

/// A file of a run that is kept: beside its final name as `NAME.part`, which stays when
/// the run ends before its time.
#[derive(Debug)]
struct Part {
    file: File,
    path: PathBuf,
    target: PathBuf,
    /// Whether a snapshot counts on it.
    is_kept: Cell<bool>,
    /// Whether it was there when the run went on.
    is_begun: bool,
}

/// What a snapshot counts on of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeptFile {
    /// The path, without links.
    pub path: PathBuf,
    /// The bytes that were written.
    pub length: u64,
}

impl Part {
    fn open(target: &Path, length: Option<u64>) -> io::Result<Self> {
        let mut name = target.file_name().unwrap_or_default().to_owned();
        name.push(".part");
        let path = target.with_file_name(name);
        let mut options = OpenOptions::new();
        options.write(true).create(true);
        let file = match length {
            None => options.truncate(true).open(&path)?,
            Some(length) => {
                let has = |path: &Path| fs::metadata(path).is_ok_and(|file| file.len() >= length);
                if !has(&path) {
                    if !has(target) {
                        let reason = format!(
                            "it had {length} bytes when the snapshot was taken, and they are no \
                             longer there; give another file"
                        );
                        return Err(io::Error::new(io::ErrorKind::NotFound, reason));
                    }
                    fs::copy(target, &path)?;
                }
                let mut file = options.truncate(false).open(&path)?;
                file.set_len(length)?;
                file.seek(SeekFrom::End(0))?;
                file
            }
        };
        let is_begun = length.is_some_and(|length| length > 0);
        let is_kept = Cell::new(length.is_some());
        Ok(Self { file, path, target: target.to_path_buf(), is_kept, is_begun })
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        if !self.is_kept.get() {
            // What cannot be removed is written over by the next run.
            let _ = fs::remove_file(&self.path);
        }
    }
}

impl OutputFile {
    /// Opens a path for a run that is kept, or that goes on from where `kept` was written.
    /// Another file than that begins.
    ///
    /// # Errors
    /// If no file can be written there, or what was there is gone.
    pub fn open_part(path: &Path, kept: Option<&KeptFile>) -> Result<Self, OutputError> {
        let Destination::Regular(target) = Destination::of(path)? else {
            return Self::open(path);
        };
        let length = kept.filter(|kept| kept.path == target).map(|kept| kept.length);
        let part = Part::open(&target, length)
            .map_err(|error| OutputError::Path { path: path.into(), reason: error.to_string() })?;
        Ok(Self { path: path.into(), output: Output::Part(part) })
    }

    /// Brings what is written to the disk, so that a snapshot can count on it, and returns
    /// how much that is; `None` where nothing can be added later.
    ///
    /// # Errors
    /// If it cannot be brought there.
    pub fn keep(&self) -> io::Result<Option<KeptFile>> {
        let Output::Part(part) = &self.output else { return Ok(None) };
        part.file.sync_all()?;
        part.is_kept.set(true);
        let length = part.file.metadata()?.len();
        Ok(Some(KeptFile { path: part.target.clone(), length }))
    }

    /// Whether it has the beginning of what is to be written.
    #[must_use]
    pub fn is_begun(&self) -> bool {
        matches!(&self.output, Output::Part(part) if part.is_begun)
    }

    /// Opens a path for writing.
    ///
    /// # Errors
    /// If no file can be written there.
    pub fn open(path: &Path) -> Result<Self, OutputError> {
        let failed = |error: io::Error| OutputError::Path {
            path: path.into(),
            reason: match error.kind() {
                io::ErrorKind::PermissionDenied => "permission denied".into(),
                _ => error.to_string(),
            },
        };
        let output = match Destination::of(path)? {
            Destination::StandardOutput => Output::Standard(io::stdout()),
            Destination::Special(device) => {
                Output::Straight(OpenOptions::new().write(true).open(device).map_err(failed)?)
            }
            Destination::Regular(target) => {
                Output::Beside(WholeFile::beside(&target).map_err(failed)?)
            }
        };
        Ok(Self { path: path.into(), output })
    }

    /// The path as it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes an error of writing this file.
    #[must_use]
    pub fn error(&self, source: io::Error) -> OutputError {
        OutputError::Write { path: self.path.clone(), source }
    }

    /// Gives the file its final name.
    ///
    /// # Errors
    /// If the rest cannot be written, or the name not be given.
    pub fn finish(mut self) -> Result<(), OutputError> {
        self.flush().map_err(|source| self.error(source))?;
        let failed = |source| OutputError::Write { path: self.path.clone(), source };
        match self.output {
            Output::Beside(file) => file.finish().map_err(failed),
            Output::Part(part) => {
                part.file.sync_all().map_err(failed)?;
                part.is_kept.set(true);
                fs::rename(&part.path, &part.target).map_err(failed)
            }
            Output::Straight(_) | Output::Standard(_) => Ok(()),
        }
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.output {
            Output::Beside(file) => file.write(bytes),
            Output::Part(part) => part.file.write(bytes),
            Output::Straight(file) => file.write(bytes),
            Output::Standard(stdout) => stdout.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.output {
            Output::Beside(file) => file.flush(),
            Output::Part(part) => part.file.flush(),
            Output::Straight(file) => file.flush(),
            Output::Standard(stdout) => stdout.flush(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn it_has_its_name_only_when_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.csv");
        let mut file = OutputFile::open(&path).unwrap();
        file.write_all(b"id\n").unwrap();
        assert!(!path.exists());
        file.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"id\n");
    }

    #[test]
    fn dropped_it_leaves_the_old_file_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.csv");
        fs::write(&path, "old").unwrap();
        let mut file = OutputFile::open(&path).unwrap();
        file.write_all(b"new").unwrap();
        drop(file);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["state.csv"]);
    }

    #[test]
    fn paths_that_no_file_can_have_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let message = |path: &Path| OutputFile::open(path).unwrap_err().to_string();
        assert!(message(folder.path()).contains("it is a folder"));
        assert!(message(&folder.path().join("no/such.csv")).contains("there is no folder"));
        assert!(message(&folder.path().join("new/")).contains("no name of a file"));
        assert!(message(Path::new("")).contains("no name of a file"));
        assert!(names(folder.path()).is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let [there, new, link, early] =
            ["there", "new", "link", "early"].map(|name| folder.path().join(name));
        fs::write(&there, "old").unwrap();
        fs::set_permissions(&there, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("there", &link).unwrap();
        symlink("new", &early).unwrap();
        for path in [&link, &early] {
            let mut file = OutputFile::open(path).unwrap();
            file.write_all(b"written").unwrap();
            file.finish().unwrap();
            assert!(fs::symlink_metadata(path).unwrap().is_symlink());
        }
        for path in [&there, &new] {
            assert_eq!(fs::read(path).unwrap(), b"written");
        }
        assert_eq!(fs::metadata(&there).unwrap().permissions().mode() & 0o777, 0o640);
        // What the system gives any new file, not the closed door of a
        // temporary one.
        fs::write(folder.path().join("any"), "").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&new), mode(&folder.path().join("any")));
        assert_eq!(Destination::of(&link).unwrap(), Destination::of(&there).unwrap());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_is_written_and_never_replaced() {
        let path = Path::new("/dev/full");
        let mut file = OutputFile::open(path).unwrap();
        let error = file.write_all(b"x").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
        assert!(!fs::metadata(path).unwrap().is_file());
    }
}
