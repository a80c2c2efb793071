//! Arrays of NumPy under way: a `.npz` archive with one array for each column, as
//! `numpy.load` reads it.
//!
//! A column goes on until the end, and so to a file of its own until then; as long as all of
//! its numbers are one, they are only counted.

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
    /// A number, and how often it was there before anything else.
    same: Option<(Vec<u8>, u64)>,
}

/// How many bytes of one number are made at a time.
const PIECE: usize = 1 << 16;

impl NpzColumn {
    /// In a file without a name, in the folder of the archive at a path, where there is
    /// room for it.
    pub fn beside(path: &Path, name: &'static str) -> io::Result<Self> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let file = tempfile::tempfile_in(folder.unwrap_or(Path::new(".")))?;
        let file = BufWriter::with_capacity(1 << 16, file);
        Ok(Self { name, file, crc: Hasher::new(), length: 0, same: None })
    }

    /// Adds the bytes of some numbers.
    pub fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
        if let Some((number, count)) = self.same.take() {
            repeated(&number, count, |piece| self.append(piece))?;
        }
        self.append(bytes)
    }

    /// Adds a number, by its bytes, as often as `count`.
    pub fn add_same(&mut self, number: &[u8], count: u64) -> io::Result<()> {
        match &mut self.same {
            Some((other, before)) if other == number => *before += count,
            None if self.length == 0 => self.same = Some((number.to_vec(), count)),
            _ => {
                self.add(&[])?;
                return repeated(number, count, |piece| self.append(piece));
            }
        }
        Ok(())
    }

    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
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
        let name = format!("{}.npy", self.name);
        if let Some((number, count)) = self.same {
            repeated(&number, count, |piece| {
                crc.update(piece);
                Ok(())
            })?;
            let size = (number.len() as u64).saturating_mul(count);
            let piece = number.repeat(PIECE / number.len().max(1));
            let same = Same { piece, at: 0, size };
            let size = head.len() as u64 + size;
            return archive.add(&name, size, crc.finalize(), &mut head.as_slice().chain(same));
        }
        crc.combine(&self.crc);
        let mut file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.rewind()?;
        let size = head.len() as u64 + self.length;
        archive.add(&name, size, crc.finalize(), &mut head.as_slice().chain(file))
    }
}

/// The bytes of a number as often as `count`, piece by piece.
fn repeated(
    number: &[u8],
    count: u64,
    mut take: impl FnMut(&[u8]) -> io::Result<()>,
) -> io::Result<()> {
    let most = (PIECE / number.len().max(1)) as u64;
    let piece = number.repeat(most.min(count) as usize);
    let mut left = count;
    while left > 0 {
        let now = left.min(most);
        take(&piece[..now as usize * number.len()])?;
        left -= now;
    }
    Ok(())
}

/// The bytes of a piece again and again.
struct Same {
    piece: Vec<u8>,
    at: u64,
    size: u64,
}

impl Read for Same {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.at == self.size {
            return Ok(0);
        }
        let from = (self.at % self.piece.len() as u64) as usize;
        let left = (self.size - self.at).min(buffer.len() as u64) as usize;
        let count = left.min(self.piece.len() - from);
        buffer[..count].copy_from_slice(&self.piece[from..from + count]);
        self.at += count as u64;
        Ok(count)
    }
}

/// Adds a small array of this type and shape.
pub fn store_array<W: Write>(
    name: &str,
    bytes: &[u8],
    kind: &str,
    shape: &str,
    archive: &mut Archive<W>,
) -> io::Result<()> {
    let mut all = head(kind, shape);
    all.extend_from_slice(bytes);
    let crc = crc32fast::hash(&all);
    archive.add(&format!("{name}.npy"), all.len() as u64, crc, &mut all.as_slice())
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
