//! Arrays of NumPy, one for each column, frames × bodies.

use std::io::{self, Write};
use std::path::Path;

use super::Frame;
use super::figures::{NUMBERS, WHOLE, quaternion_of};
use crate::bodies::PerBody;
use crate::numbers::array::Each;
use crate::observe::species;
use crate::output::is_single;
use crate::output::npz::{Archive, NpzColumn, store_array};
use crate::real::Real;

/// Arrays under way.
#[derive(Debug)]
pub struct NumPy<W> {
    output: W,
    time: NpzColumn,
    numbers: Vec<NpzColumn>,
    whole: Vec<NpzColumn>,
    frames: usize,
    bodies: usize,
    /// The corners of a periodic box, in bytes.
    corners: Option<[Vec<u8>; 2]>,
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
            corners: None,
            precision: "<f8",
        })
    }

    pub fn write<T: Real>(&mut self, frame: &Frame<'_, T>) -> io::Result<()> {
        let bodies = frame.bodies;
        self.precision = if is_single::<T>()? { "<f4" } else { "<f8" };
        self.bodies = bodies.len();
        self.frames += 1;
        self.corners = frame.space.map(|space| {
            [space.lower, space.upper].each(|corner| {
                let mut bytes = Vec::new();
                corner.to_array().iter().for_each(|value| value.write_bits(&mut bytes));
                bytes
            })
        });
        self.time.add(&frame.time.to_le_bytes())?;
        let count = bodies.len() as u64;
        let quaternions: Option<Vec<[T; 4]>> = bodies
            .orientation
            .is_some()
            .then(|| (0..bodies.len()).map(|index| quaternion_of(bodies, index)).collect());
        let vectors = [&bodies.position, &bodies.velocity, &bodies.spin];
        let (of_vectors, others) = self.numbers.split_at_mut(9);
        for (column, values) in of_vectors.iter_mut().zip(vectors.into_iter().flatten()) {
            add(column, values)?;
        }
        let (of_turns, of_figures) = others.split_at_mut(4);
        for (k, column) in of_turns.iter_mut().enumerate() {
            match &quaternions {
                None => add_same(column, if k == 0 { T::ONE } else { T::ZERO }, count)?,
                Some(turns) => add(column, &turns.iter().map(|turn| turn[k]).collect::<Vec<T>>())?,
            }
        }
        for (column, figure) in of_figures.iter_mut().zip([&bodies.radius, &bodies.mass]) {
            match figure {
                PerBody::Same(value) => add_same(column, *value, count)?,
                PerBody::Each(values) => add(column, values)?,
            }
        }
        let (of_images, of_species) = self.whole.split_at_mut(3);
        for (axis, column) in of_images.iter_mut().enumerate() {
            let image = |index| frame.images.map_or(0, |images| images.of(index)[axis]);
            add_whole(column, (0..bodies.len()).map(image))?;
        }
        let species = species(bodies).into_iter().map(|kind| kind as i32);
        of_species.iter_mut().try_for_each(|column| add_whole(column, species.clone()))
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
        for (name, bytes) in ["lower", "upper"].iter().zip(self.corners.iter().flatten()) {
            store_array(name, bytes, self.precision, "(3,)", &mut archive)?;
        }
        archive.finish()
    }
}

/// Adds numbers of all bodies.
fn add<T: Real>(column: &mut NpzColumn, values: &[T]) -> io::Result<()> {
    let mut bits = Vec::new();
    let first = values.first().map(|first| {
        first.write_bits(&mut bits);
        bits.clone()
    });
    // In their bits: the zeros differ.
    let is_first = |value: &T| {
        bits.clear();
        value.write_bits(&mut bits);
        first.as_ref() == Some(&bits)
    };
    if let Some(first) = &first
        && values.iter().all(is_first)
    {
        return column.add_same(first, values.len() as u64);
    }
    let mut bytes = Vec::with_capacity(size_of_val(values));
    values.iter().for_each(|value| value.write_bits(&mut bytes));
    column.add(&bytes)
}

/// Adds one number for all bodies.
fn add_same<T: Real>(column: &mut NpzColumn, value: T, count: u64) -> io::Result<()> {
    let mut bytes = Vec::new();
    value.write_bits(&mut bytes);
    column.add_same(&bytes, count)
}

/// Adds whole numbers of all bodies.
fn add_whole(
    column: &mut NpzColumn,
    values: impl ExactSizeIterator<Item = i32> + Clone,
) -> io::Result<()> {
    let mut others = values.clone();
    if let Some(first) = others.next()
        && others.all(|value| value == first)
    {
        return column.add_same(&first.to_le_bytes(), values.len() as u64);
    }
    let mut bytes = Vec::with_capacity(4 * values.len());
    values.for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
    column.add(&bytes)
}
