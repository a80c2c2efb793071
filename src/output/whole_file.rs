//! Whole file: one that has its name only once it is whole.
//!
//! It is written beside its final name, as `.carom-PROCESS-….tmp`, and renamed
//! when all of it is on the disk. A program that is killed leaves such a file
//! behind; the next one that writes into the folder removes it. A program that
//! is asked to end removes its own with [`abandon_unfinished`].

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::{Mutex, MutexGuard, PoisonError};

use sysinfo::{Pid, ProcessesToUpdate, System};
use tempfile::{Builder, NamedTempFile};

/// What all temporary names begin with.
const PREFIX: &str = ".carom-";

/// What all temporary names end with.
const SUFFIX: &str = ".tmp";

/// The files of this process that have no name yet.
struct Unfinished {
    paths: Vec<PathBuf>,
    /// The folders that were looked through for what others left.
    tidied: Vec<PathBuf>,
}

static UNFINISHED: Mutex<Unfinished> =
    Mutex::new(Unfinished { paths: Vec::new(), tidied: Vec::new() });

fn unfinished() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file under way. It gets its name, and replaces what had it, with
/// [`finish`](WholeFile::finish). Dropped before that, it leaves nothing.
///
/// ```
/// use std::io::Write;
/// use carom::output::WholeFile;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("state.csv");
/// let mut file = WholeFile::beside(&path)?;
/// file.write_all(b"id\n")?;
/// assert!(!path.exists());
/// file.finish()?;
/// assert_eq!(std::fs::read(&path)?, b"id\n");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct WholeFile {
    temporary: Temporary,
    target: PathBuf,
}

/// A temporary file, on the list of those that the end of the program removes.
#[derive(Debug)]
struct Temporary {
    // Dropped in this order: the file first, then its place in the list.
    file: NamedTempFile,
    listed: Listed,
}

/// The place of a path in the list of files that the end of the program removes.
#[derive(Debug)]
pub(crate) struct Listed(PathBuf);

impl Listed {
    /// From now on the end of the program removes this file.
    pub(crate) fn new(path: PathBuf) -> Self {
        unfinished().paths.push(path.clone());
        Self(path)
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        unfinished().paths.retain(|path| *path != self.0);
    }
}

impl WholeFile {
    /// A file that is to be `target`, in the same folder, with the permissions
    /// that `target` has, or would be made with.
    ///
    /// # Errors
    /// If no file can be written there.
    pub fn beside(target: &Path) -> io::Result<Self> {
        let existing = match OpenOptions::new().write(true).open(target) {
            Ok(file) => Some(file.metadata()?.permissions()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let temporary = Temporary::new(folder)?;
        if let Some(permissions) = existing {
            temporary.file.as_file().set_permissions(permissions)?;
        }
        Ok(Self { temporary, target: target.to_path_buf() })
    }

    /// Gives the file its final name, once all of it is on the disk.
    ///
    /// # Errors
    /// If the rest cannot be written, or the name not be given.
    pub fn finish(self) -> io::Result<()> {
        let Self { temporary: Temporary { mut file, listed }, target } = self;
        file.flush()?;
        file.as_file().sync_all()?;
        let unfinished = unfinished();
        let named = file.persist(&target);
        drop(unfinished);
        drop(listed);
        named.map(|_| ()).map_err(|error| error.error)
    }
}

impl Temporary {
    /// A temporary file in a folder, with the permissions of any new file.
    fn new(folder: &Path) -> io::Result<Self> {
        let prefix = format!("{PREFIX}{}-", process::id());
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(SUFFIX);
        #[cfg(unix)]
        let readable_by_others = {
            use std::os::unix::fs::PermissionsExt;
            fs::Permissions::from_mode(0o666)
        };
        #[cfg(unix)]
        builder.permissions(readable_by_others);
        // From here on no file is made that an end of the program would miss.
        let mut unfinished = unfinished();
        if !unfinished.tidied.iter().any(|tidied| tidied == folder) {
            tidy(folder);
            unfinished.tidied.push(folder.to_path_buf());
        }
        let file = builder.tempfile_in(folder)?;
        // It tells a file under way from one that was left. Where the file system
        // has no locks, nothing is taken for left.
        let _ = file.as_file().try_lock();
        let path = file.path().to_path_buf();
        unfinished.paths.push(path.clone());
        drop(unfinished);
        Ok(Self { file, listed: Listed(path) })
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.temporary.file.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.temporary.file.as_file_mut().flush()
    }
}

/// Writes a whole file, or none.
///
/// # Errors
/// If it cannot be written; a file that was there is then as it was.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = WholeFile::beside(path)?;
    file.write_all(bytes)?;
    file.finish()
}

/// Removes the files of this process that have no name yet, and then ends it as
/// the function says. Meanwhile no file is begun and none gets its name.
pub fn abandon_unfinished<R>(end: impl FnOnce() -> R) -> R {
    let unfinished = unfinished();
    for path in &unfinished.paths {
        // What cannot be removed, the next program in the folder tries again.
        let _ = fs::remove_file(path);
    }
    end()
}

/// Removes what programs that were killed have left in a folder. What cannot be
/// looked at or removed stays.
fn tidy(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(process) = name.to_str().and_then(process_of) else { continue };
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && process != process::id() && !is_running(process) {
            let path = entry.path();
            // A process of another machine or container holds its lock.
            if fs::File::open(&path).is_ok_and(|file| file.try_lock().is_ok()) {
                let _ = fs::remove_file(path);
            }
        }
    }
}

/// The process that a temporary file is of, by its name.
fn process_of(name: &str) -> Option<u32> {
    let rest = name.strip_prefix(PREFIX)?;
    let rest = rest.strip_suffix(SUFFIX)?;
    rest.split_once('-')?.0.parse().ok()
}

/// Whether a process is running.
fn is_running(process: u32) -> bool {
    let process = Pid::from_u32(process);
    let mut system = System::new();
    system.refresh_processes(ProcessesToUpdate::Some(&[process]), true);
    system.process(process).is_some()
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
    fn dropped_it_leaves_the_old_file_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.csv");
        fs::write(&path, "old").unwrap();
        let mut file = WholeFile::beside(&path).unwrap();
        file.write_all(b"new").unwrap();
        let under_way = names(folder.path());
        assert_eq!(process_of(&under_way[0]), Some(process::id()), "{under_way:?}");
        drop(file);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["state.csv"]);
    }

    #[test]
    fn what_a_killed_program_left_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        // No system has a process of this number.
        let left = format!("{PREFIX}4294967290-abc{SUFFIX}");
        let held = format!("{PREFIX}4294967291-abc{SUFFIX}");
        let own = format!("{PREFIX}{}-abc{SUFFIX}", process::id());
        let others = [".carom-x.tmp", ".carom-7.tmp", "notes.tmp", &own, &held];
        for name in others.iter().copied().chain([left.as_str()]) {
            fs::write(folder.path().join(name), "x").unwrap();
        }
        let holder = fs::File::open(folder.path().join(&held)).unwrap();
        holder.try_lock().unwrap();
        write_whole(&folder.path().join("state.csv"), b"id\n").unwrap();
        let mut expected: Vec<&str> = others.to_vec();
        expected.push("state.csv");
        expected.sort_unstable();
        assert_eq!(names(folder.path()), expected);
    }
}
