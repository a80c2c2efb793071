//! Reading: the files that a scene is made of.

use std::fs::{self, File, Metadata};
use std::io;
use std::path::Path;

/// Opens a regular file. Nothing else is read: a pipe may never have a writer,
/// and a device no end.
pub(super) fn open(path: &Path) -> io::Result<File> {
    let metadata = fs::metadata(path)?;
    if metadata.is_file() {
        return File::open(path);
    }
    let kind = kind(&metadata);
    Err(io::Error::other(format!("it is {kind} and no regular file")))
}

#[cfg(unix)]
fn kind(metadata: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    let kind = metadata.file_type();
    match () {
        () if kind.is_dir() => "a folder",
        () if kind.is_fifo() => "a pipe",
        () if kind.is_socket() => "a socket",
        () => "a device",
    }
}

#[cfg(not(unix))]
fn kind(metadata: &Metadata) -> &'static str {
    if metadata.is_dir() { "a folder" } else { "a device" }
}
