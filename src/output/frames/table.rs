//! A table of Parquet: a row for each body of a frame, frame after frame.

use std::io::{self, Write};
use std::ops::Range;

use super::Frame;
use super::figures::{NUMBERS, WHOLE, quaternion_of};
use crate::observe::species;
use crate::output::is_single;
use crate::output::parquet::{Column, GROUP, Table, Values};
use crate::real::Real;

/// What stands before the figures of a body.
const HEADING: [&str; 3] = ["step", "time", "id"];

/// The columns, without a row.
fn columns(is_single: bool) -> Vec<Column> {
    let heading = HEADING.iter().map(|name| match *name {
        "time" => Column::full(name, Values::Double(Vec::new())),
        _ => Column::full(name, Values::Signed(Vec::new())),
    });
    let numbers = NUMBERS.iter().map(|name| match is_single {
        true => Column::full(name, Values::Single(Vec::new())),
        false => Column::full(name, Values::Double(Vec::new())),
    });
    let whole = WHOLE.iter().map(|name| Column::full(name, Values::Short(Vec::new())));
    heading.chain(numbers).chain(whole).collect()
}

/// Rows under way.
#[derive(Debug)]
pub struct Rows<W> {
    table: Table<W>,
    /// The columns of rows that are in no group yet, and how many these are.
    pending: Vec<Column>,
    count: usize,
}

impl<W: Write> Rows<W> {
    pub fn new(output: W) -> Self {
        Self { table: Table::new(output), pending: Vec::new(), count: 0 }
    }

    /// Rows behind those that another table had when it was kept.
    pub fn resume(output: W, kept: &[u8]) -> io::Result<Self> {
        let table = Table::resume(output, kept)?;
        Ok(Self { table, pending: Vec::new(), count: 0 })
    }

    /// Says something of the frames as a whole.
    pub fn note(&mut self, name: &str, value: String) {
        self.table.note(name, value);
    }

    pub fn write<T: Real>(&mut self, frame: &Frame<'_, T>) -> io::Result<()> {
        if self.pending.is_empty() {
            self.pending = columns(is_single::<T>()?);
            self.note("precision", T::NAME.to_owned());
        }
        if let Some(space) = frame.space {
            for (name, corner) in [("lower", space.lower), ("upper", space.upper)] {
                let [x, y, z] = corner.to_array();
                self.note(name, format!("{x:?} {y:?} {z:?}"));
            }
        }
        let species = species(frame.bodies);
        let mut next = 0;
        while next < frame.bodies.len() {
            let end = frame.bodies.len().min(next + GROUP - self.count);
            self.add(frame, &species, next..end);
            next = end;
            if self.count == GROUP {
                self.group()?;
            }
        }
        Ok(())
    }

    /// Adds the rows of some bodies.
    fn add<T: Real>(&mut self, frame: &Frame<'_, T>, species: &[u32], some: Range<usize>) {
        let bodies = frame.bodies;
        let each = || some.clone();
        self.count += some.len();
        let mut columns = self.pending.iter_mut().map(|column| &mut column.values);
        for (name, column) in HEADING.into_iter().zip(columns.by_ref()) {
            match name {
                "time" => column.add(each().map(|_| frame.time)),
                "step" => column.add_whole(each().map(|_| frame.step as i64)),
                _ => column.add_whole(each().map(|body| frame.number(body))),
            }
        }
        let vectors = [&bodies.position, &bodies.velocity, &bodies.spin];
        for (values, column) in vectors.into_iter().flatten().zip(columns.by_ref()) {
            column.add(values[each()].iter().copied());
        }
        let turns: Vec<[T; 4]> = each().map(|body| quaternion_of(bodies, body)).collect();
        for (k, column) in (0..4).zip(columns.by_ref()) {
            column.add(turns.iter().map(|turn| turn[k]));
        }
        for (figure, column) in [&bodies.radius, &bodies.mass].into_iter().zip(columns.by_ref()) {
            column.add(each().map(|body| figure.of(body)));
        }
        for (axis, column) in (0..3).zip(columns.by_ref()) {
            let image = |body| frame.images.map_or(0, |images| images.of(body)[axis]);
            column.add_whole(each().map(|body| i64::from(image(body))));
        }
        if let Some(column) = columns.next() {
            column.add_whole(each().map(|body| i64::from(species[body])));
        }
    }

    /// Puts the rows so far into a group.
    fn group(&mut self) -> io::Result<()> {
        self.table.add(&self.pending)?;
        self.count = 0;
        for column in &mut self.pending {
            column.values.clear();
        }
        Ok(())
    }

    /// Hands all frames so far on to the output, and returns what [`resume`](Self::resume)
    /// needs.
    pub fn keep(&mut self) -> io::Result<(&W, Vec<u8>)> {
        self.group()?;
        self.table.flush()?;
        let kept = self.table.kept()?;
        Ok((self.table.output(), kept))
    }

    pub fn finish(mut self) -> io::Result<W> {
        if self.pending.is_empty() {
            self.pending = columns(false);
        }
        self.group()?;
        self.table.finish()
    }
}
