//! A table of Parquet: a row for each body of a frame, frame after frame.

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, PageType};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::{ParquetMetaData, ParquetMetaDataReader, RowGroupMetaData};
use parquet::file::properties::ReaderProperties;
use parquet::file::reader::RowGroupReader;
use parquet::file::serialized_reader::SerializedRowGroupReader;
use xxhash_rust::xxh3::xxh3_64;

use super::bodies::{Columns, NAMES, checked_count, wanted};
use super::lines::finite;
use super::zip::bytes_at;
use super::{FramePlace, RecordedFrame, Wrong};
use crate::output::parquet::{MAGIC, MARK, PROGRAM, SEAL, TAIL};
use crate::scene::MOST_BODIES;
use crate::space::PeriodicBox;

/// Columns of which a frame has one value.
const FRAMES: [&str; 3] = ["frame", "step", "time"];

/// The rows of a table under way.
#[derive(Debug)]
pub struct Rows {
    file: Arc<File>,
    known: ParquetMetaData,
    /// Whether carom wrote it: then groups have checksums.
    is_own: bool,
    space: Option<PeriodicBox<f64>>,
    /// Where the columns of bodies are, what tells frames apart, and the time.
    places: [Option<usize>; NAMES.len()],
    frame: Option<usize>,
    time: Option<usize>,
    next_group: usize,
    /// The rows that were read, of which some went into frames.
    columns: Columns,
    frames: Vec<f64>,
    times: Vec<f64>,
    passed: usize,
}

/// What the footer is, and whether carom wrote it.
fn footer(file: &File) -> Result<(ParquetMetaData, bool), Wrong> {
    let length = file.metadata().map_err(|error| Wrong::unreadable(FramePlace::File, &error))?;
    let length = length.len();
    let foreign = || {
        let problem = "is no whole table of Parquet: its footer, at the end, is missing";
        Wrong::new(FramePlace::File, problem)
    };
    let start = length.checked_sub(TAIL as u64).ok_or_else(foreign)?;
    let tail = bytes_at(file, start, TAIL as u64)?;
    let (size, magic) = tail.split_at(4);
    if magic != MAGIC || bytes_at(file, 0, 4)? != MAGIC {
        return Err(foreign());
    }
    let size = size.iter().rev().fold(0, |size, byte| size << 8 | u64::from(*byte));
    let start = start.checked_sub(size).filter(|start| *start >= 4).ok_or_else(foreign)?;
    let bytes = bytes_at(file, start, size + TAIL as u64)?;
    let before = start.min((MARK.len() + SEAL) as u64);
    let sealed = bytes_at(file, start - before, before)?;
    // One damage can hit one of the two.
    let is_own = sealed.starts_with(&MARK)
        || bytes.windows(PROGRAM.len()).any(|text| text == PROGRAM.as_bytes());
    let place = FramePlace::Byte(start);
    if is_own && sealed != [MARK, xxh3_64(&bytes).to_le_bytes()].as_flattened() {
        return Err(Wrong::new(place, "the footer is damaged: its checksum does not fit"));
    }
    let known = ParquetMetaDataReader::decode_metadata(&bytes[..size as usize]);
    known.map(|known| (known, is_own)).map_err(|error| unread(place, &error))
}

/// Something that the format does not have so.
fn unread(place: FramePlace, error: &ParquetError) -> Wrong {
    Wrong::new(place, format!("cannot be understood: {error}"))
}

impl Rows {
    pub fn open(path: &Path) -> Result<Self, Wrong> {
        let file = File::open(path).map_err(|error| Wrong::unreadable(FramePlace::File, &error))?;
        let (known, is_own) = footer(&file)?;
        let whole = |problem: String| Wrong::new(FramePlace::File, problem);
        let schema = known.file_metadata().schema_descr();
        let place = |name: &str| {
            // A column within another one is named by both.
            schema.columns().iter().position(|column| column.path().parts() == [name])
        };
        let mut places = [None; NAMES.len()];
        for (known, name) in places.iter_mut().zip(NAMES) {
            *known = place(name);
        }
        Columns::check(|name| place(name).is_some()).map_err(&whole)?;
        let corner = |name: &str| corner(&known, name).map_err(&whole);
        let space = corner("lower")?.zip(corner("upper")?);
        let space = space.map(|(lower, upper)| PeriodicBox::new(lower, upper));
        if space.is_some_and(|space| space.sides().to_array().iter().any(|side| *side <= 0.0)) {
            return Err(whole("lower must be below upper along each side".to_owned()));
        }
        let frame = FRAMES.iter().find_map(|name| place(name));
        let time = place("time");
        Ok(Self {
            file: Arc::new(file),
            known,
            is_own,
            space,
            places,
            frame,
            time,
            next_group: 0,
            columns: Columns::default(),
            frames: Vec::new(),
            times: Vec::new(),
            passed: 0,
        })
    }

    /// The next frame; `None` behind the last one.
    pub fn read(&mut self, in_full: bool) -> Result<Option<RecordedFrame>, Wrong> {
        let has = self.places;
        let has = |name: &str| Columns::place(name).is_some_and(|at| has[at].is_some());
        for (place, name) in self.places.iter_mut().zip(NAMES) {
            *place = place.filter(|_| wanted(name, in_full, has));
        }
        while self.frame_end().is_none() && self.next_group < self.known.num_row_groups() {
            self.read_group()?;
            let count = (self.columns.values[0].len() - self.passed) as u64;
            if self.frame_end().is_none() && count > MOST_BODIES {
                checked_count(count).map_err(|it| Wrong::new(FramePlace::File, it))?;
            }
        }
        let start = self.passed;
        let end = self.frame_end().unwrap_or(self.columns.values[0].len());
        if start == end {
            return Ok(None);
        }
        self.passed = end;
        let mut columns = Columns::default();
        for (some, all) in columns.values.iter_mut().zip(&self.columns.values) {
            if let Some(values) = all.get(start..end) {
                *some = values.to_vec();
            }
        }
        let time = self.times.get(start).copied();
        let found = columns.bodies();
        let (bodies, images) = found.map_err(|it| Wrong::new(FramePlace::File, it))?;
        let images = images.filter(|_| self.space.is_some());
        Ok(Some(RecordedFrame { time, bodies, space: self.space, images }))
    }

    /// Where the frame ends that comes next, if rows behind it are there.
    fn frame_end(&self) -> Option<usize> {
        let frames = self.frames.get(self.passed..)?;
        let first = frames.first()?;
        frames.iter().position(|frame| frame != first).map(|count| self.passed + count)
    }

    /// Reads one more group, behind the rows that went into no frame.
    fn read_group(&mut self) -> Result<(), Wrong> {
        let Self { file, known, columns, frames, times, .. } = self;
        let all = columns.values.iter_mut().chain([&mut *frames, &mut *times]);
        for values in all.filter(|values| !values.is_empty()) {
            values.drain(..self.passed);
        }
        self.passed = 0;
        let group = known.row_group(self.next_group);
        if group.num_columns() != known.file_metadata().schema_descr().num_columns() {
            return Err(Wrong::new(FramePlace::File, "groups must have all columns"));
        }
        let place = FramePlace::Byte(check(file, group, self.is_own)?);
        let bad = |error: ParquetError| unread(place, &error);
        let index = known.page_index_for_row_group(self.next_group);
        let properties = Arc::new(ReaderProperties::builder().build());
        let reader = SerializedRowGroupReader::new(Arc::clone(file), group, index, properties);
        let reader = reader.map_err(bad)?;
        let rows = usize::try_from(group.num_rows()).map_err(|error| bad(error.into()))?;
        let columns = self.places.iter().zip(&mut columns.values);
        for (column, values) in columns.chain([(&self.frame, frames), (&self.time, times)]) {
            let Some(column) = *column else { continue };
            let before = values.len();
            let pages = if self.is_own { Ok(()) } else { check_pages(&reader, column) };
            let read = pages.and_then(|()| reader.get_column_reader(column));
            let read = read.and_then(|it| append(it, rows, values));
            let name = group.column(column).column_path().string();
            let bad = |problem: String| Wrong::new(place, format!("{name}: {problem}"));
            read.map_err(|error| bad(format!("cannot be understood: {error}")))?;
            if values.len() - before != rows {
                return Err(bad(format!("it does not have a number in each of {rows} rows")));
            }
            if let Some(value) = values[before..].iter().find(|value| !value.is_finite()) {
                return Err(bad(format!("{value:?} is no finite number")));
            }
        }
        self.next_group += 1;
        Ok(())
    }
}

/// A corner of the box, of which the footer may tell.
fn corner(known: &ParquetMetaData, name: &str) -> Result<Option<[f64; 3]>, String> {
    let notes = known.file_metadata().key_value_metadata().into_iter().flatten();
    let Some(text) = notes.into_iter().find(|note| note.key == name) else { return Ok(None) };
    let numbers = text.value.iter().flat_map(|text| text.split_whitespace()).map(finite);
    match numbers.collect::<Result<Vec<_>, _>>()?[..] {
        [x, y, z] => Ok(Some([x, y, z])),
        _ => Err(format!("{name} must be three numbers")),
    }
}

/// Checks that a group is in the file, and is as it was written; returns its place.
fn check(file: &File, group: &RowGroupMetaData, is_own: bool) -> Result<u64, Wrong> {
    let length = file.metadata().map_err(|error| Wrong::unreadable(FramePlace::File, &error))?;
    let (mut start, mut end) = (length.len(), 0);
    for column in group.columns() {
        let path = column.column_path();
        let wrong = |problem| Wrong::new(FramePlace::File, format!("{path}: {problem}"));
        if column.compression() != Compression::UNCOMPRESSED {
            return Err(wrong("it is compressed; write the table with compression none"));
        }
        let offset = column.dictionary_page_offset().unwrap_or(column.data_page_offset());
        let range = u64::try_from(offset).ok().zip(u64::try_from(column.compressed_size()).ok());
        let (offset, size) = range.ok_or_else(|| wrong("its place is damaged"))?;
        let last = offset.checked_add(size).filter(|last| *last <= length.len());
        end = end.max(last.ok_or_else(|| wrong("it goes on behind the end of the file"))?);
        start = start.min(offset);
    }
    if is_own {
        let bytes = bytes_at(file, start, end.saturating_sub(start) + SEAL as u64)?;
        let (data, seal) = bytes.split_at(bytes.len() - SEAL);
        if xxh3_64(data).to_le_bytes() != seal {
            let problem =
                format!("damaged: the checksum of {} bytes from here does not fit", data.len());
            return Err(Wrong::new(FramePlace::Byte(start), problem));
        }
    }
    Ok(start)
}

/// Checks the encodings of another program's pages: the reader panics at a dictionary that is
/// not there, and at others that are cut.
fn check_pages(group: &dyn RowGroupReader, column: usize) -> ParquetResult<()> {
    let mut has_dictionary = false;
    for page in group.get_column_page_reader(column)? {
        let page = page?;
        has_dictionary |= page.page_type() == PageType::DICTIONARY_PAGE;
        match page.encoding() {
            Encoding::PLAIN | Encoding::DELTA_BINARY_PACKED => {}
            Encoding::PLAIN_DICTIONARY | Encoding::RLE_DICTIONARY if has_dictionary => {}
            other => {
                let problem = format!("its pages are in the encoding {other}; write them plain");
                return Err(ParquetError::General(problem));
            }
        }
    }
    Ok(())
}

/// Adds the numbers of a column.
fn append(reader: ColumnReader, rows: usize, values: &mut Vec<f64>) -> ParquetResult<()> {
    fn all<D: DataType>(mut reader: ColumnReaderImpl<D>, rows: usize) -> ParquetResult<Vec<D::T>> {
        let (mut values, mut levels) = (Vec::new(), Vec::new());
        reader.read_records(rows, Some(&mut levels), None, &mut values)?;
        Ok(values)
    }
    match reader {
        ColumnReader::DoubleColumnReader(reader) => values.extend(all(reader, rows)?),
        ColumnReader::FloatColumnReader(reader) => {
            values.extend(all(reader, rows)?.into_iter().map(f64::from));
        }
        ColumnReader::Int32ColumnReader(reader) => {
            values.extend(all(reader, rows)?.into_iter().map(f64::from));
        }
        ColumnReader::Int64ColumnReader(reader) => {
            values.extend(all(reader, rows)?.into_iter().map(|value| value as f64));
        }
        _ => return Err(ParquetError::General("its numbers must be of 32 or 64 bits".into())),
    }
    Ok(())
}
