//! Arrays of NumPy, one for each column, frames × bodies.

use std::fs::File;
use std::path::Path;

use super::bodies::{Columns, NAMES, checked_count, wanted};
use super::zip::{Entry, bytes_at, entries};
use super::{FramePlace, RecordedFrame, Wrong};
use crate::numbers::array;
use crate::space::PeriodicBox;

/// The kinds of numbers that can be read.
#[derive(Clone, Copy, Debug)]
enum Kind {
    F4,
    F8,
    I4,
    I8,
}

impl Kind {
    fn size(self) -> u64 {
        match self {
            Self::F4 | Self::I4 => 4,
            Self::F8 | Self::I8 => 8,
        }
    }

    /// Numbers from their bytes.
    fn read(self, bytes: &[u8]) -> Vec<f64> {
        let four = |bytes: &[u8]| [bytes[0], bytes[1], bytes[2], bytes[3]];
        let eight = |bytes: &[u8]| array::from_fn(|k| bytes[k]);
        let pieces = bytes.chunks_exact(self.size() as usize);
        match self {
            Self::F4 => pieces.map(|it| f64::from(f32::from_le_bytes(four(it)))).collect(),
            Self::I4 => pieces.map(|it| f64::from(i32::from_le_bytes(four(it)))).collect(),
            Self::F8 => pieces.map(|it| f64::from_le_bytes(eight(it))).collect(),
            Self::I8 => pieces.map(|it| i64::from_le_bytes(eight(it)) as f64).collect(),
        }
    }
}

/// An array, by where it is.
#[derive(Clone, Debug)]
struct Array {
    kind: Kind,
    shape: Vec<u64>,
    /// Where its numbers begin.
    start: u64,
}

impl Array {
    /// Numbers from one on, which are to be finite.
    fn read(&self, file: &mut File, first: u64, count: u64) -> Result<Vec<f64>, Wrong> {
        let start = self.start + first * self.kind.size();
        let values = self.kind.read(&bytes_at(file, start, count * self.kind.size())?);
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let at = FramePlace::Byte(start + index as u64 * self.kind.size());
            return Err(Wrong::new(at, format!("{:?} is no finite number", values[index])));
        }
        Ok(values)
    }

    /// What stands before the numbers of an array.
    fn of(file: &mut File, entry: &Entry) -> Result<Self, Wrong> {
        let wrong = |problem: &str| {
            Wrong::new(FramePlace::Byte(entry.start), format!("{}: {problem}", entry.name))
        };
        let begin = bytes_at(file, entry.start, entry.size.min(12))?;
        if begin.len() < 12 || !begin.starts_with(b"\x93NUMPY") {
            return Err(wrong("it is no array of NumPy"));
        }
        let (before, length) = match begin[6] {
            1 => (10, u64::from(u16::from_le_bytes([begin[8], begin[9]]))),
            _ => (12, u64::from(u32::from_le_bytes([begin[8], begin[9], begin[10], begin[11]]))),
        };
        if before + length > entry.size {
            return Err(wrong("its heading is damaged"));
        }
        let text = bytes_at(file, entry.start + before, length)?;
        let text = String::from_utf8_lossy(&text);
        let kind = match () {
            () if text.contains("'<f8'") => Kind::F8,
            () if text.contains("'<f4'") => Kind::F4,
            () if text.contains("'<i4'") => Kind::I4,
            () if text.contains("'<i8'") => Kind::I8,
            () => return Err(wrong("its numbers must be <f8, <f4, <i8 or <i4")),
        };
        if !text.contains("'fortran_order': False") {
            return Err(wrong("its rows must be frames (order C)"));
        }
        let shape = text.split_once("'shape': (").and_then(|(_, rest)| rest.split_once(')'));
        let shape = shape.ok_or_else(|| wrong("it has no shape"))?.0;
        let shape = shape.split(',').map(str::trim).filter(|size| !size.is_empty());
        let shape: Result<Vec<u64>, _> = shape.map(str::parse).collect();
        let shape = shape.map_err(|_| wrong("its shape is damaged"))?;
        let count = shape.iter().try_fold(kind.size(), |all, size| all.checked_mul(*size));
        if count.is_none_or(|size| size != entry.size - before - length) {
            return Err(wrong("it has more or fewer numbers than its shape says"));
        }
        Ok(Self { kind, shape, start: entry.start + before + length })
    }
}

/// The frames of an archive under way.
#[derive(Debug)]
pub struct Arrays {
    file: File,
    times: Vec<f64>,
    space: Option<PeriodicBox<f64>>,
    columns: [Option<Array>; NAMES.len()],
    bodies: u64,
    next: u64,
}

impl Arrays {
    pub fn open(path: &Path) -> Result<Self, Wrong> {
        let mut file =
            File::open(path).map_err(|error| Wrong::unreadable(FramePlace::File, &error))?;
        let entries = entries(&mut file)?;
        let mut array = |name: &str| {
            let name = format!("{name}.npy");
            let entry = entries.iter().find(|entry| entry.name == name);
            entry.map(|entry| Array::of(&mut file, entry)).transpose()
        };
        let whole = |problem: String| Wrong::new(FramePlace::File, problem);
        let time = array("time")?.ok_or_else(|| whole("there is no array time".to_owned()))?;
        let corners = [array("lower")?, array("upper")?];
        let mut columns = [const { None }; NAMES.len()];
        for (column, name) in columns.iter_mut().zip(NAMES) {
            *column = array(name)?;
        }
        Columns::check(|name| Columns::place(name).is_some_and(|at| columns[at].is_some()))
            .map_err(&whole)?;
        let shape = columns[0].as_ref().map_or(Vec::new(), |x: &Array| x.shape.clone());
        let [frames, bodies] = shape[..] else {
            return Err(whole("the arrays must be frames × bodies".to_owned()));
        };
        let differs = |array: &&Array| array.shape != [frames, bodies];
        if time.shape != [frames] || columns.iter().flatten().any(|array| differs(&array)) {
            let problem = format!("the arrays must all be of {frames} frames × {bodies} bodies");
            return Err(whole(problem));
        }
        checked_count(bodies).map_err(&whole)?;
        let times = time.read(&mut file, 0, frames)?;
        let mut corner = |array: &Option<Array>| -> Result<Option<[f64; 3]>, Wrong> {
            let Some(array) = array.as_ref().filter(|array| array.shape == [3]) else {
                return Ok(None);
            };
            let values = array.read(&mut file, 0, 3)?;
            Ok(Some([values[0], values[1], values[2]]))
        };
        let space = corner(&corners[0])?.zip(corner(&corners[1])?);
        let space = space.map(|(lower, upper)| PeriodicBox::new(lower, upper));
        if space.is_some_and(|space| space.sides().to_array().iter().any(|side| *side <= 0.0)) {
            return Err(whole("lower must be below upper along each side".to_owned()));
        }
        Ok(Self { file, times, space, columns, bodies, next: 0 })
    }

    /// The next frame; `None` behind the last one.
    pub fn read(&mut self, in_full: bool) -> Result<Option<RecordedFrame>, Wrong> {
        let Some(time) = self.times.get(self.next as usize).copied() else { return Ok(None) };
        let first = self.next * self.bodies;
        let mut columns = Columns::default();
        let has = |name: &str| Columns::place(name).is_some_and(|at| self.columns[at].is_some());
        let columns_of = columns.values.iter_mut().zip(&self.columns).zip(NAMES);
        for ((values, array), name) in columns_of {
            if let Some(array) = array.as_ref().filter(|_| wanted(name, in_full, has)) {
                *values = array.read(&mut self.file, first, self.bodies)?;
            }
        }
        self.next += 1;
        let at = self.columns[0].as_ref().map_or(0, |x| x.start + first * x.kind.size());
        let found = columns.bodies();
        let (bodies, images) = found.map_err(|it| Wrong::new(FramePlace::Byte(at), it))?;
        let images = images.filter(|_| self.space.is_some());
        Ok(Some(RecordedFrame { time: Some(time), bodies, space: self.space, images }))
    }
}
