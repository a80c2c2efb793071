//! Parquet: a table in typed columns, of which some rows at a time make a group. Nothing is
//! compressed; numbers stand there as they are in memory.
//!
//! Pages have no checksums. Behind each group is the XXH3-64 of its bytes, and before the
//! footer a mark and that of the footer, in eight bytes with the least significant first.
//! Other readers pass over them: the footer says where columns are.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Kind};
use parquet::data_type::{
    ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type,
};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::{
    FileMetaData, KeyValue, ParquetMetaData, ParquetMetaDataReader, ParquetMetaDataWriter,
    RowGroupMetaData,
};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedColumnWriter, SerializedRowGroupWriter, TrackedWrite};
use parquet::schema::types::{ColumnPath, SchemaDescPtr, SchemaDescriptor, Type};
use xxhash_rust::xxh3::xxh3_64;

use crate::real::Real;

/// What every file begins and ends with.
pub const MAGIC: [u8; 4] = *b"PAR1";

/// Bytes behind the data of a footer: its length and the magic.
pub const TAIL: usize = 8;

/// Bytes of a checksum.
pub const SEAL: usize = 8;

/// What stands before the checksum of a footer.
pub const MARK: [u8; 8] = *b"carom\r\n\0";

/// What the program calls itself in a footer, before its version.
pub const PROGRAM: &str = "carom version ";

/// Rows of a group, but for the last one: its columns have 1 MB or less.
pub const GROUP: usize = 1 << 17;

/// Columns whose least and greatest number in a group are in the footer, so that readers can
/// choose groups by them.
const RANGED: [&str; 2] = ["step", "time"];

/// The numbers or texts of a column.
#[derive(Clone, Debug)]
pub enum Values {
    Double(Vec<f64>),
    Single(Vec<f32>),
    Signed(Vec<i64>),
    /// Of 64 bits too.
    Unsigned(Vec<i64>),
    Short(Vec<i32>),
    Text(Vec<ByteArray>),
}

impl Values {
    /// Adds numbers.
    pub fn add<T: Real>(&mut self, numbers: impl Iterator<Item = T>) {
        match self {
            Self::Double(values) => values.extend(numbers.map(Real::to_f64)),
            Self::Single(values) => values.extend(numbers.map(|number| number.to_f64() as f32)),
            // Others take no such numbers.
            _ => {}
        }
    }

    /// Adds whole numbers.
    pub fn add_whole(&mut self, numbers: impl Iterator<Item = i64>) {
        match self {
            Self::Signed(values) | Self::Unsigned(values) => values.extend(numbers),
            Self::Short(values) => values.extend(numbers.map(|number| number as i32)),
            // Others take no such numbers.
            _ => {}
        }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        match self {
            Self::Double(values) => values.clear(),
            Self::Single(values) => values.clear(),
            Self::Signed(values) | Self::Unsigned(values) => values.clear(),
            Self::Short(values) => values.clear(),
            Self::Text(values) => values.clear(),
        }
    }
}

/// A column of some rows.
#[derive(Clone, Debug)]
pub struct Column {
    pub name: String,
    /// Those that are there.
    pub values: Values,
    /// Of each row 1 if it has a value and 0 if not; `None` where all have.
    pub present: Option<Vec<i16>>,
}

impl Column {
    /// A column without gaps.
    pub fn full(name: &str, values: Values) -> Self {
        Self { name: name.to_owned(), values, present: None }
    }

    /// A column in which some rows may have nothing.
    pub fn of<V, U>(
        name: &str,
        values: &[Option<V>],
        kind: fn(Vec<U>) -> Values,
        stored: impl Fn(&V) -> U,
    ) -> Self {
        let present = values.iter().map(|value| i16::from(value.is_some())).collect();
        let values = values.iter().flatten().map(stored).collect();
        Self { name: name.to_owned(), values: kind(values), present: Some(present) }
    }

    /// What the schema says of it.
    fn described(&self) -> ParquetResult<Type> {
        let (kind, logical) = match self.values {
            Values::Double(_) => (Kind::DOUBLE, None),
            Values::Single(_) => (Kind::FLOAT, None),
            Values::Signed(_) => (Kind::INT64, None),
            Values::Unsigned(_) => (Kind::INT64, Some(LogicalType::integer(64, false))),
            Values::Short(_) => (Kind::INT32, None),
            Values::Text(_) => (Kind::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let repetition = match self.present {
            None => Repetition::REQUIRED,
            Some(_) => Repetition::OPTIONAL,
        };
        let described = Type::primitive_type_builder(&self.name, kind);
        described.with_repetition(repetition).with_logical_type(logical).build()
    }

    fn write(&self, mut writer: SerializedColumnWriter<'_>) -> ParquetResult<()> {
        fn batch<D: DataType>(
            writer: &mut SerializedColumnWriter<'_>,
            values: &[D::T],
            present: Option<&[i16]>,
        ) -> ParquetResult<()> {
            writer.typed::<D>().write_batch(values, present, None).map(drop)
        }
        let present = self.present.as_deref();
        match &self.values {
            Values::Double(values) => batch::<DoubleType>(&mut writer, values, present)?,
            Values::Single(values) => batch::<FloatType>(&mut writer, values, present)?,
            Values::Signed(values) | Values::Unsigned(values) => {
                batch::<Int64Type>(&mut writer, values, present)?;
            }
            Values::Short(values) => batch::<Int32Type>(&mut writer, values, present)?,
            Values::Text(values) => batch::<ByteArrayType>(&mut writer, values, present)?,
        }
        writer.close()
    }
}

/// A table under way.
#[derive(Debug)]
pub struct Table<W> {
    output: W,
    /// Of the columns, once there are some.
    schema: Option<SchemaDescPtr>,
    groups: Vec<RowGroupMetaData>,
    notes: Vec<KeyValue>,
}

impl<W: Write> Table<W> {
    /// A table that goes to `output` from its first byte on.
    pub fn new(output: W) -> Self {
        Self { output, schema: None, groups: Vec::new(), notes: Vec::new() }
    }

    /// A table that goes on behind the groups that another one had when it was
    /// [`kept`](Self::kept).
    pub fn resume(output: W, kept: &[u8]) -> io::Result<Self> {
        let Some(data) = kept.len().checked_sub(TAIL) else { return Ok(Self::new(output)) };
        let known = ParquetMetaDataReader::decode_metadata(&kept[..data]).map_err(as_io)?;
        let file = known.file_metadata();
        Ok(Self {
            output,
            schema: Some(file.schema_descr_ptr()),
            notes: file.key_value_metadata().cloned().unwrap_or_default(),
            groups: known.row_groups().to_vec(),
        })
    }

    /// Says something of the table as a whole, in the place of what was said by this name.
    pub fn note(&mut self, name: &str, value: String) {
        self.notes.retain(|note| note.key != name);
        self.notes.push(KeyValue::new(name.to_owned(), value));
    }

    /// Adds a group of rows; the columns are those of the first one.
    pub fn add(&mut self, columns: &[Column]) -> io::Result<()> {
        let schema = self.schema(columns)?;
        let group = self.groups.len() as i32;
        let (bytes, group) = encoded(columns, schema, group, self.end()).map_err(as_io)?;
        if group.num_rows() == 0 {
            return Ok(());
        }
        self.output.write_all(&bytes)?;
        self.output.write_all(&xxh3_64(&bytes).to_le_bytes())?;
        self.groups.push(group);
        Ok(())
    }

    /// What the columns are, by which the file begins.
    fn schema(&mut self, columns: &[Column]) -> io::Result<SchemaDescPtr> {
        if let Some(schema) = &self.schema {
            return Ok(Arc::clone(schema));
        }
        let fields = columns.iter().map(|column| column.described().map(Arc::new));
        let fields = fields.collect::<Result<Vec<_>, _>>().map_err(as_io)?;
        let schema = Type::group_type_builder("schema").with_fields(fields).build();
        let schema = Arc::new(SchemaDescriptor::new(Arc::new(schema.map_err(as_io)?)));
        self.output.write_all(&MAGIC)?;
        Ok(Arc::clone(self.schema.insert(schema)))
    }

    /// The bytes that are written.
    fn end(&self) -> i64 {
        let last = self.groups.last().and_then(|group| group.columns().last());
        last.map_or(MAGIC.len() as i64, |column| {
            column.data_page_offset() + column.compressed_size() + SEAL as i64
        })
    }

    /// What [`resume`](Self::resume) needs to go on behind what is written.
    pub fn kept(&self) -> io::Result<Vec<u8>> {
        let Some(schema) = &self.schema else { return Ok(Vec::new()) };
        let rows = self.groups.iter().map(RowGroupMetaData::num_rows).sum();
        let program = format!("{PROGRAM}{}", env!("CARGO_PKG_VERSION"));
        let (notes, schema) = (Some(self.notes.clone()), Arc::clone(schema));
        let file = FileMetaData::new(1, rows, Some(program), notes, schema, None);
        let known = ParquetMetaData::new(file, self.groups.clone());
        let mut footer = Vec::new();
        ParquetMetaDataWriter::new(&mut footer, &known).finish().map_err(as_io)?;
        Ok(footer)
    }

    /// The output so far.
    pub fn output(&self) -> &W {
        &self.output
    }

    /// Hands what is written on.
    pub fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }

    /// Writes the footer, and gives the output back.
    pub fn finish(mut self) -> io::Result<W> {
        let footer = self.kept()?;
        self.output.write_all(&MARK)?;
        self.output.write_all(&xxh3_64(&footer).to_le_bytes())?;
        self.output.write_all(&footer)?;
        self.output.flush()?;
        Ok(self.output)
    }
}

/// The bytes of a group that is to stand at a place in the file, and what the footer says of
/// it.
fn encoded(
    columns: &[Column],
    schema: SchemaDescPtr,
    number: i32,
    place: i64,
) -> ParquetResult<(Vec<u8>, RowGroupMetaData)> {
    let mut properties = WriterProperties::builder()
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::None);
    for name in RANGED {
        let path = ColumnPath::from(name);
        properties = properties.set_column_statistics_enabled(path, EnabledStatistics::Chunk);
    }
    let mut bytes = TrackedWrite::new(Vec::new());
    let properties = Arc::new(properties.build());
    let mut writer = SerializedRowGroupWriter::new(schema, properties, &mut bytes, number, None);
    for column in columns {
        let next = writer.next_column()?;
        column.write(next.ok_or_else(|| ParquetError::General("a column too many".into()))?)?;
    }
    let group = writer.close()?;
    let moved = group.columns().iter().map(|column| {
        let offset = column.data_page_offset() + place;
        column.clone().into_builder().set_data_page_offset(offset).build()
    });
    let moved = moved.collect::<ParquetResult<Vec<_>>>()?;
    let group = RowGroupMetaData::clone(&group).into_builder().set_column_metadata(moved);
    Ok((bytes.into_inner()?, group.set_file_offset(place).build()?))
}

/// What cannot be written.
fn as_io(error: ParquetError) -> io::Error {
    io::Error::other(error.to_string())
}
