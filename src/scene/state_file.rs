//! State file: spheres read back from comma-separated values, as a run writes
//! them.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use csv::{ByteRecord, ReaderBuilder};

use super::check_bodies::is_rotation;
use super::error::{Place, Problem, SceneError};
use super::figures::{Figures, Values};
use super::filling::Filling;
use super::random::Seed;
use super::settings::MOST_BODIES;
use super::spheres::Spheres;
use crate::bodies::{Bodies, Origin, PerBody};
use crate::column::Column;
use crate::mat3::Mat3;
use crate::numbers::array::{self, Each};
use crate::real::Real;

const POSITION: [&str; 3] = ["x", "y", "z"];
const VELOCITY: [&str; 3] = ["vx", "vy", "vz"];
const SPIN: [&str; 3] = ["wx", "wy", "wz"];
const ORIENTATION: [&str; 9] = ["m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"];
const RADIUS: [&str; 1] = ["radius"];
const MASS: [&str; 1] = ["mass"];

/// Bytes read at once.
const PIECE: usize = 1 << 20;

/// The most bytes of a field that a message shows.
const SHOWN: usize = 40;

/// A file of comma-separated values whose header is read.
#[derive(Debug)]
pub(super) struct StateFile {
    path: PathBuf,
    /// What messages call it.
    name: String,
    reader: csv::Reader<File>,
    fields: usize,
    position: [usize; 3],
    velocity: Option<[usize; 3]>,
    spin: Option<[usize; 3]>,
    orientation: Option<[usize; 9]>,
    radius: Option<usize>,
    mass: Option<usize>,
}

/// What a file has columns for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Has {
    pub(super) velocity: bool,
    pub(super) spin: bool,
    pub(super) radius: bool,
    pub(super) mass: bool,
}

impl StateFile {
    /// Reads the names of the columns.
    pub(super) fn new(path: &Path, file: File) -> Result<Self, SceneError> {
        let name = path.display().to_string();
        let mut reader =
            ReaderBuilder::new().flexible(true).buffer_capacity(PIECE).from_reader(file);
        let header = match reader.byte_headers() {
            Ok(header) => header.clone(),
            Err(error) => return Err(unreadable(&name, &error)),
        };
        if header.is_empty() {
            let wanted = "a state file has a line with the names of its columns, and then a line \
                          for each sphere";
            let problem = Problem::Value { found: "empty".to_owned(), wanted: wanted.to_owned() };
            return Err(mistake(&name, None, "", problem));
        }
        let columns = Columns { name: &name, header };
        let first = |column: [usize; 1]| column[0];
        let columns = Self {
            fields: columns.header.len(),
            position: columns.required(POSITION)?,
            velocity: columns.all_or_none(VELOCITY)?,
            spin: columns.all_or_none(SPIN)?,
            orientation: columns.all_or_none(ORIENTATION)?,
            radius: columns.all_or_none(RADIUS)?.map(first),
            mass: columns.all_or_none(MASS)?.map(first),
            path: path.into(),
            name: name.clone(),
            reader,
        };
        Ok(columns)
    }

    /// What it has columns for.
    pub(super) fn has(&self) -> Has {
        Has {
            velocity: self.velocity.is_some(),
            spin: self.spin.is_some(),
            radius: self.radius.is_some(),
            mass: self.mass.is_some(),
        }
    }

    /// Reads all spheres. What the file has no column for is as in a group that
    /// is described so.
    pub(super) fn bodies<T: Real>(
        mut self,
        spheres: &Spheres,
        seed: Seed,
    ) -> Result<Bodies<T>, SceneError> {
        let rows = Rows::<T>::read(&mut self)?;
        let count = rows.position[0].len();
        let [radius, mass] = [rows.radius, rows.mass].each(|column| column.map(Values::listed));
        let figures = Figures::beside(&spheres.make, count, seed, radius, mass);
        let figure = |values: &Values| match values {
            Values::Same(value) => PerBody::Same(T::from_f64(*value)),
            Values::Each(values) => {
                PerBody::from_values(values.iter().map(|value| T::from_f64(*value)), T::ONE)
            }
        };
        let [radius, mass, inertia] =
            [&figures.radius, &figures.mass, &figures.inertia].each(figure);
        let velocity = match rows.velocity {
            Some(columns) => columns.each(column),
            None => Filling::velocities(count, spheres, &figures, seed),
        };
        let spin = match rows.spin {
            Some(columns) => columns.each(column),
            None => Filling::spins(count, spheres, &figures, seed),
        };
        drop(figures);
        // Axes that are the world's are not stored.
        let is_turned = |columns: &[Vec<T>; 9]| {
            let world = Mat3::<T>::IDENTITY.rows();
            columns.iter().zip(world).any(|(column, axis)| column.iter().any(|m| *m != axis))
        };
        let orientation = rows.orientation.filter(|columns| is_turned(columns));
        Ok(Bodies {
            origin: Origin::State,
            position: rows.position.each(column),
            velocity,
            spin,
            orientation: orientation.map(|columns| Box::new(columns.each(column))),
            radius,
            mass,
            inertia,
        })
    }

    /// A mistake in a line.
    fn mistake(&self, record: &ByteRecord, key: &str, problem: Problem) -> SceneError {
        let line = record.position().map(|position| {
            let blank = blank_lines(&self.path, position.byte()).unwrap_or(0);
            position.line() as usize + blank
        });
        mistake(&self.name, line, key, problem)
    }
}

/// How many blank lines a file has from a byte on: the reader counts them to the
/// record behind them.
fn blank_lines(path: &Path, start: u64) -> io::Result<usize> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(start))?;
    let mut lines = 0;
    for byte in BufReader::new(file).bytes() {
        match byte? {
            b'\n' => lines += 1,
            b'\r' => {}
            _ => break,
        }
    }
    Ok(lines)
}

fn column<T: Real>(values: Vec<T>) -> Column<T> {
    Column::from_values(values.into_iter(), T::ZERO)
}

/// The columns of a file, as they are read.
struct Rows<T> {
    position: [Vec<T>; 3],
    velocity: Option<[Vec<T>; 3]>,
    spin: Option<[Vec<T>; 3]>,
    orientation: Option<[Vec<T>; 9]>,
    radius: Option<Vec<f64>>,
    mass: Option<Vec<f64>>,
}

impl<T: Real> Rows<T> {
    fn read(file: &mut StateFile) -> Result<Self, SceneError> {
        let three = || [const { Vec::new() }; 3];
        let mut rows = Self {
            position: three(),
            velocity: file.velocity.map(|_| three()),
            spin: file.spin.map(|_| three()),
            orientation: file.orientation.map(|_| [const { Vec::new() }; 9]),
            radius: file.radius.map(|_| Vec::new()),
            mass: file.mass.map(|_| Vec::new()),
        };
        let mut record = ByteRecord::new();
        loop {
            match file.reader.read_byte_record(&mut record) {
                Ok(true) => rows.add(file, &record)?,
                Ok(false) => break,
                Err(error) => return Err(unreadable(&file.name, &error)),
            }
        }
        if rows.position[0].is_empty() {
            let found = "without spheres".to_owned();
            let wanted = "below the names of the columns there is a line for each".to_owned();
            return Err(mistake(&file.name, None, "", Problem::Value { found, wanted }));
        }
        Ok(rows)
    }

    fn add(&mut self, file: &StateFile, record: &ByteRecord) -> Result<(), SceneError> {
        let fail = |key: &str, problem| file.mistake(record, key, problem);
        let value = |found: String, wanted: String| Problem::Value { found, wanted };
        if record.len() != file.fields {
            let found = format!("{} fields long", record.len());
            let wanted = format!("there are {} columns", file.fields);
            return Err(fail("the line", value(found, wanted)));
        }
        if self.position[0].len() as u64 >= MOST_BODIES {
            let wanted = format!("a scene can have {MOST_BODIES} spheres at most");
            return Err(fail("the line", value("one too many".to_owned(), wanted)));
        }
        add(&mut self.position, file.position, POSITION, record, &fail)?;
        if let (Some(columns), Some(at)) = (&mut self.velocity, file.velocity) {
            add(columns, at, VELOCITY, record, &fail)?;
        }
        if let (Some(columns), Some(at)) = (&mut self.spin, file.spin) {
            add(columns, at, SPIN, record, &fail)?;
        }
        if let (Some(columns), Some(at)) = (&mut self.orientation, file.orientation) {
            add(columns, at, ORIENTATION, record, &fail)?;
            let rows: [T; 9] = array::from_fn(|k| columns[k].last().copied().unwrap_or(T::ZERO));
            if !is_rotation(Mat3::from_rows(rows)) {
                let wanted = "its columns must be orthonormal and right-handed";
                let problem = value("no rotation".to_owned(), wanted.to_owned());
                return Err(fail("columns m00 to m22", problem));
            }
        }
        let figures =
            [(&mut self.radius, file.radius, RADIUS[0]), (&mut self.mass, file.mass, MASS[0])];
        for (column, at, name) in figures {
            let (Some(column), Some(at)) = (column, at) else { continue };
            let number = number::<T>(&record[at]).map(|(_, exact)| exact);
            let number = number.filter(|number| T::from_f64(*number) > T::ZERO);
            let Some(number) = number else {
                let wanted = "it must be a finite number greater than 0".to_owned();
                return Err(fail(&format!("column {name}"), value(shown(&record[at]), wanted)));
            };
            column.push(number);
        }
        Ok(())
    }
}

/// Adds the numbers of a line to their columns.
fn add<T: Real, const N: usize>(
    columns: &mut [Vec<T>; N],
    at: [usize; N],
    names: [&str; N],
    record: &ByteRecord,
    fail: &impl Fn(&str, Problem) -> SceneError,
) -> Result<(), SceneError> {
    for ((column, at), name) in columns.iter_mut().zip(at).zip(names) {
        let Some((number, _)) = number::<T>(&record[at]) else {
            let wanted = format!("it must be a finite number that {} can hold", T::NAME);
            let problem = Problem::Value { found: shown(&record[at]), wanted };
            return Err(fail(&format!("column {name}"), problem));
        };
        column.push(number);
    }
    Ok(())
}

/// A finite number: the nearest one of the precision, and that of `f64`.
fn number<T: Real>(field: &[u8]) -> Option<(T, f64)> {
    let text = core::str::from_utf8(field).ok()?.trim();
    let exact: f64 = text.parse().ok()?;
    // Not by way of f64, which would round twice. With no more digits than an f64 it is one
    // in every precision, as in the scene file.
    let nearest = match T::NAME {
        "f32" => T::from_f64(f64::from(text.parse::<f32>().ok()?)),
        "f64" => T::from_f64(exact),
        _ if digits(text) <= DIGITS => T::from_f64(exact),
        _ => T::from_str_radix(text, 10).ok()?,
    };
    nearest.is_finite().then_some((nearest, exact))
}

/// The most decimal digits that an `f64` is known by.
const DIGITS: usize = 17;

/// How many digits a number is written with, those in front of its first one above 0 not
/// counted.
fn digits(text: &str) -> usize {
    let mantissa = text.split(['e', 'E']).next().unwrap_or(text);
    mantissa.bytes().filter(u8::is_ascii_digit).skip_while(|digit| *digit == b'0').count()
}

/// A field in a message.
fn shown(field: &[u8]) -> String {
    let text = String::from_utf8_lossy(field);
    if text.chars().count() <= SHOWN {
        return format!("{text:?}");
    }
    let start: String = text.chars().take(SHOWN).collect();
    format!("{start:?}…")
}

/// The names of the columns.
struct Columns<'a> {
    name: &'a str,
    header: ByteRecord,
}

impl Columns<'_> {
    fn required<const N: usize>(&self, names: [&str; N]) -> Result<[usize; N], SceneError> {
        let mut at = [0; N];
        for (at, name) in at.iter_mut().zip(names) {
            let Some(found) = self.find(name)? else {
                let known: Vec<_> =
                    self.header.iter().take(8).map(String::from_utf8_lossy).collect();
                let known = shown(known.join(",").as_bytes());
                let wanted = format!("the first line has the names of the columns, and is {known}");
                return Err(self.mistake(name, Problem::missing(wanted)));
            };
            *at = found;
        }
        Ok(at)
    }

    /// Columns that only say something together.
    fn all_or_none<const N: usize>(
        &self,
        names: [&str; N],
    ) -> Result<Option<[usize; N]>, SceneError> {
        let mut at = [0; N];
        let mut there = None;
        let mut missing = None;
        for (at, name) in at.iter_mut().zip(names) {
            match self.find(name)? {
                Some(found) => (*at, there) = (found, Some(name)),
                None => missing = Some(name),
            }
        }
        match (there, missing) {
            (None, _) => Ok(None),
            (Some(_), None) => Ok(Some(at)),
            (Some(there), Some(missing)) => {
                let problem = Problem::missing(format!("it belongs to column {there}"));
                Err(self.mistake(missing, problem))
            }
        }
    }

    /// Where the column of a name is.
    fn find(&self, name: &str) -> Result<Option<usize>, SceneError> {
        let mut found = None;
        for (at, field) in self.header.iter().enumerate() {
            let field = field.trim_ascii();
            if field == name.as_bytes() && found.replace(at).is_some() {
                let problem = Problem::conflict("another of that name", "remove one of them");
                return Err(self.mistake(name, problem));
            }
            if field != name.as_bytes() && field.eq_ignore_ascii_case(name.as_bytes()) {
                let wanted = format!("the name of that column is {name}");
                let problem = Problem::Value { found: shown(field), wanted };
                return Err(self.mistake(name, problem));
            }
        }
        Ok(found)
    }

    fn mistake(&self, column: &str, problem: Problem) -> SceneError {
        mistake(self.name, Some(1), &format!("column {column}"), problem)
    }
}

fn mistake(name: &str, line: Option<usize>, key: &str, problem: Problem) -> SceneError {
    let place = Place { scene: name.to_owned(), line, key: key.to_owned(), option: None };
    SceneError { place: Box::new(place), problem: Box::new(problem) }
}

/// A file that stops to be read.
fn unreadable(name: &str, error: &csv::Error) -> SceneError {
    let line = error.position().map(|position| position.line() as usize);
    let found = "no longer readable here".to_owned();
    mistake(name, line, "", Problem::Value { found, wanted: error.to_string() })
}
