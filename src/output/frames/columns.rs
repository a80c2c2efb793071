//! Arrays of NumPy, one for each column, frames × bodies.

use std::io::{self, Write};
use std::path::Path;

use super::Frame;
use super::figures::{kinds, quaternion_of};
use crate::output::npz::{Archive, NpzColumn};
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
    time: NpzColumn,
    numbers: Vec<NpzColumn>,
    whole: Vec<NpzColumn>,
    frames: usize,
    bodies: usize,
    /// What NumPy calls the precision.
    precision: &'static str,
}

impl<W: Write> NumPy<W> {
    pub fn new(path: &Path, output: W) -> io::Result<Self> {
        let column = |name| NpzColumn::beside(path, name);
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
