//! Arrays of NumPy under way: a `.npz` archive with one array for each column, as
//! `numpy.load` reads it.
//!
//! A column goes on until the end, and so to a file of its own until then.

mod zip;

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, Write};
use std::path::Path;

use crc32fast::Hasher;

pub use zip::Archive;

/// One array under way.
#[derive(Debug)]
pub struct NpzColumn {
    name: &'static str,
    file: BufWriter<File>,
    crc: Hasher,
    length: u64,
}

impl NpzColumn {
    /// In a file without a name, in the folder of the archive at a path, where there is
    /// room for it.
    pub fn beside(path: &Path, name: &'static str) -> io::Result<Self> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let file = tempfile::tempfile_in(folder.unwrap_or(Path::new(".")))?;
        let file = BufWriter::with_capacity(1 << 16, file);
        Ok(Self { name, file, crc: Hasher::new(), length: 0 })
    }

    /// Adds the bytes of some numbers.
    pub fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.crc.update(bytes);
        self.length += bytes.len() as u64;
        self.file.write_all(bytes)
    }

    /// Moves to an archive, as an array of this type and shape.
    pub fn store<W: Write>(
        self,
        kind: &str,
        shape: &str,
        archive: &mut Archive<W>,
    ) -> io::Result<()> {
        let head = head(kind, shape);
        let mut crc = Hasher::new();
        crc.update(&head);
        crc.combine(&self.crc);
        let mut file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.rewind()?;
        let size = head.len() as u64 + self.length;
        let name = format!("{}.npy", self.name);
        archive.add(&name, size, crc.finalize(), &mut head.as_slice().chain(file))
    }
}

/// What stands before the data of an array: format 1.0 of NumPy.
fn head(kind: &str, shape: &str) -> Vec<u8> {
    let mut text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    // The data starts at a multiple of 64 bytes, after a line's end.
    let before = 10;
    let end = (before + text.len() + 1).next_multiple_of(64);
    text.extend(core::iter::repeat_n(' ', end - before - text.len() - 1));
    text.push('\n');
    let mut head = b"\x93NUMPY\x01\x00".to_vec();
    head.extend_from_slice(&(text.len() as u16).to_le_bytes());
    head.extend_from_slice(text.as_bytes());
    head
}
