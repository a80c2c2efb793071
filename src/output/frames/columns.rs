//! Arrays of NumPy: a `.npz` archive with one array for each column, frames × bodies,
//! as `numpy.load` reads it.
//!
//! A column goes on from frame to frame, and so to a file of its own until the end.

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, Write};
use std::path::Path;

use crc32fast::Hasher;

use super::Frame;
use super::figures::{kinds, quaternion_of};
use super::zip::Archive;
use crate::real::Real;

/// The names of the columns of numbers.
const NUMBERS: [&str; 15] =
    ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "qw", "qx", "qy", "qz", "radius", "mass"];

/// The names of the columns of whole numbers.
const WHOLE: [&str; 4] = ["ix", "iy", "iz", "type"];

/// Arrays under way.
#[derive(Debug)]
pub struct NumPy<W> {
    output: W,
    time: Column,
    numbers: Vec<Column>,
    whole: Vec<Column>,
    frames: usize,
    bodies: usize,
    /// What NumPy calls the precision.
    precision: &'static str,
}

/// One array under way.
#[derive(Debug)]
struct Column {
    name: &'static str,
    file: BufWriter<File>,
    crc: Hasher,
    length: u64,
}

impl Column {
    /// In a file without a name, in the folder where there is room for the archive.
    fn new(name: &'static str, folder: &Path) -> io::Result<Self> {
        let file = BufWriter::with_capacity(1 << 16, tempfile::tempfile_in(folder)?);
        Ok(Self { name, file, crc: Hasher::new(), length: 0 })
    }

    fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.crc.update(bytes);
        self.length += bytes.len() as u64;
        self.file.write_all(bytes)
    }

    /// Moves to an archive, as an array of this type and shape.
    fn store<W: Write>(self, kind: &str, shape: &str, archive: &mut Archive<W>) -> io::Result<()> {
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

impl<W: Write> NumPy<W> {
    pub fn new(path: &Path, output: W) -> io::Result<Self> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let column = |name| Column::new(name, folder.unwrap_or(Path::new(".")));
        Ok(Self {
            output,
            time: column("time")?,
            numbers: NUMBERS.into_iter().map(column).collect::<Result<_, _>>()?,
            whole: WHOLE.into_iter().map(column).collect::<Result<_, _>>()?,
            frames: 0,
            bodies: 0,
            precision: "<f8",
        })
    }

    pub fn write<T: Real>(&mut self, frame: &Frame<'_, T>) -> io::Result<()> {
        let bodies = frame.bodies;
        self.precision = if T::NAME == f32::NAME { "<f4" } else { "<f8" };
        self.bodies = bodies.len();
        self.frames += 1;
        self.time.add(&frame.time.to_le_bytes())?;
        let mut numbers = NUMBERS.map(|_| Vec::with_capacity(bodies.len() * size_of::<T>()));
        let mut whole = WHOLE.map(|_| Vec::with_capacity(bodies.len() * size_of::<i32>()));
        let kinds = kinds(bodies);
        for (index, &kind) in kinds.iter().enumerate() {
            let values = [
                &bodies.position_of(index).to_array()[..],
                &bodies.velocity_of(index).to_array(),
                &bodies.spin_of(index).to_array(),
                &quaternion_of(bodies, index),
                &[bodies.radius.of(index), bodies.mass.of(index)],
            ];
            for (column, value) in numbers.iter_mut().zip(values.iter().copied().flatten()) {
                value.write_bits(column);
            }
            let images = frame.images.map_or([0; 3], |images| images.of(index));
            for (column, value) in whole.iter_mut().zip(images.into_iter().chain([kind as i32])) {
                column.extend_from_slice(&value.to_le_bytes());
            }
        }
        let columns = self.numbers.iter_mut().chain(&mut self.whole);
        for (column, bytes) in columns.zip(numbers.iter().chain(&whole)) {
            column.add(bytes)?;
        }
        Ok(())
    }

    pub fn finish(self) -> io::Result<W> {
        let shape = format!("({}, {})", self.frames, self.bodies);
        let mut archive = Archive::new(self.output);
        self.time.store("<f8", &format!("({},)", self.frames), &mut archive)?;
        for column in self.numbers {
            column.store(self.precision, &shape, &mut archive)?;
        }
        for column in self.whole {
            column.store("<i4", &shape, &mut archive)?;
        }
        archive.finish()
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
