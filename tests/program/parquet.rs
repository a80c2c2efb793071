//! Tables of Parquet: their rows and types, what reads them, and what damages them.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use carom::output::{FrameReader, RecordedFrame};
use parquet::data_type::{ByteArrayType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::parser::parse_message_type;

use crate::frames::entries;
use crate::{BOX, FLUID, Folder, rows};

/// A file as another program reads it: names, rows, rows of each group, notes.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<Field>>,
    groups: Vec<i64>,
    notes: Vec<(String, String)>,
}

impl Table {
    fn of(path: &Path) -> Self {
        let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
        let known = reader.metadata();
        let file = known.file_metadata();
        assert!(file.created_by().unwrap().starts_with("carom version "));
        let notes = file.key_value_metadata().into_iter().flatten();
        let columns = file.schema_descr().columns();
        let fields = |row: parquet::record::Row| {
            row.get_column_iter().map(|(_, field)| field.clone()).collect()
        };
        Self {
            names: columns.iter().map(|column| column.name().to_owned()).collect(),
            rows: reader.get_row_iter(None).unwrap().map(|row| fields(row.unwrap())).collect(),
            groups: known.row_groups().iter().map(|group| group.num_rows()).collect(),
            notes: notes.map(|note| (note.key.clone(), note.value.clone().unwrap())).collect(),
        }
    }

    fn column(&self, name: &str) -> Vec<&Field> {
        let at = self.names.iter().position(|other| other == name).unwrap();
        self.rows.iter().map(|row| &row[at]).collect()
    }

    fn note(&self, name: &str) -> Option<&str> {
        self.notes.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }
}

/// A number's bytes as an array of NumPy has them.
fn bytes(field: &Field) -> Vec<u8> {
    match field {
        Field::Double(value) => value.to_le_bytes().to_vec(),
        Field::Float(value) => value.to_le_bytes().to_vec(),
        Field::Int(value) => value.to_le_bytes().to_vec(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn rows_have_the_bits_of_arrays() {
    for (scene, precision) in [(FLUID, "f32"), (FLUID, "f64"), (BOX, "f32"), (BOX, "f64")] {
        let folder = Folder::with(scene);
        let run = format!(
            "run scene.toml --engine event-driven --precision {precision} --duration 0.3 \
             --record-every 0.1 --record run"
        );
        folder.says(&format!("{run}.npz")).well();
        folder.says(&format!("{run}.parquet")).well();
        let table = Table::of(&folder.path("run.parquet"));
        let bodies = if scene == FLUID { 256 } else { 20 };
        assert_eq!(table.rows.len(), 4 * bodies);
        assert_eq!(table.names[..3], ["step", "time", "id"]);
        let arrays = entries(&fs::read(folder.path("run.npz")).unwrap());
        let mut compared = 0;
        for (name, array) in &arrays {
            let name = name.strip_suffix(".npy").unwrap();
            if ["time", "lower", "upper"].contains(&name) {
                continue;
            }
            let column: Vec<u8> = table.column(name).into_iter().flat_map(bytes).collect();
            assert!(!column.is_empty() && array.ends_with(&column), "{precision}: {name}");
            assert_eq!(table.names[3 + compared], name);
            compared += 1;
        }
        assert_eq!((compared, table.names.len()), (19, 22));
        for (row, fields) in table.rows.iter().enumerate() {
            let (frame, body) = ((row / bodies) as i64, (row % bodies) as i64);
            assert_eq!(fields[0], Field::Long(frame));
            let times = [0.0, 0.1, 0.2, 0.3].map(Field::Double);
            assert_eq!(fields[1], times[frame as usize]);
            assert_eq!(fields[2], Field::Long(body));
        }
        assert_eq!(table.note("precision"), Some(precision));
        assert_eq!(table.note("scene"), Some("scene"));
        assert_eq!(table.note("seed"), Some(if scene == BOX { "3" } else { "0" }));
        let upper = (scene == FLUID).then_some("8.0 8.0 8.0");
        assert_eq!(table.note("upper"), upper);
    }
}

/// Everything of frames, to be compared.
fn shown(frame: &RecordedFrame) -> String {
    let RecordedFrame { time, bodies, space, images, .. } = frame;
    let columns = (&bodies.position, &bodies.velocity, &bodies.radius, &bodies.mass);
    format!("{time:?} {columns:?} {space:?} {images:?}")
}

fn frames(path: &Path) -> Vec<String> {
    FrameReader::open(path).unwrap().map(|frame| shown(&frame.unwrap())).collect()
}

#[test]
fn groups_divide_frames_and_readers_do_not_see_it() {
    let folder = Folder::with(BOX);
    let run = "run scene.toml --engine event-driven --record-every 2.5e-4 --record run";
    folder.says(&format!("{run}.npz")).well();
    folder.says(&format!("{run}.parquet")).well();
    let table = Table::of(&folder.path("run.parquet"));
    assert_eq!(table.groups, [1 << 17, 8001 * 20 - (1 << 17)]);
    let (one, other) = (frames(&folder.path("run.npz")), frames(&folder.path("run.parquet")));
    assert_eq!(other.len(), 8001);
    assert!(one == other);
    // A state is one frame.
    folder.says("run scene.toml --state end.parquet").well();
    folder.says("run scene.toml --state end.npz").well();
    assert_eq!(frames(&folder.path("end.parquet")), frames(&folder.path("end.npz")));
}

#[test]
fn damage_is_found_wherever_it_is() {
    let folder = Folder::with(BOX);
    let run = "run scene.toml --duration 0.02 --record-every 0.01 --record run.parquet";
    folder.says(run).well();
    let whole = fs::read(folder.path("run.parquet")).unwrap();
    let path = folder.path("bad.parquet");
    let read = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        FrameReader::open(&path).and_then(|frames| frames.collect::<Result<Vec<_>, _>>())
    };
    assert_eq!(read(&whole).unwrap().len(), 3);
    // Some of all; each was tried once.
    for length in (0..whole.len()).step_by(7) {
        let error = read(&whole[..length]).unwrap_err().to_string();
        assert!(error.contains("bad.parquet: is no whole table"), "{length}: {error}");
    }
    for at in (0..whole.len()).step_by(3) {
        let mut changed = whole.clone();
        changed[at] ^= 1 << (at % 8);
        let error = read(&changed).map(|frames| frames.len()).unwrap_err().to_string();
        assert!(error.contains("bad.parquet: "), "{at}: {error}");
    }
    let mut changed = whole.clone();
    changed[500] ^= 1;
    fs::write(&path, changed).unwrap();
    let message = folder.says("analyse bad.parquet --kind speed-distribution").fails_with(1);
    assert!(message.contains("bad.parquet: byte 4: damaged: the checksum"), "{message}");
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let message = folder.says("analyse bad.parquet").fails_with(1);
    assert!(message.contains("bad.parquet: is no whole table of Parquet"), "{message}");
    for foreign in [&b""[..], b"PAR1", b"PAR1PAR1", b"PAR1\0\0\0\0PAR1", b"id,x\n0,1\n2,3\n"] {
        assert!(read(foreign).is_err());
    }
}

/// A table of another program: with gaps allowed, with dictionaries, frames by their times.
fn foreign(rows: usize, gap: bool) -> Vec<u8> {
    let schema = "message schema { OPTIONAL DOUBLE x; OPTIONAL DOUBLE y; OPTIONAL DOUBLE z;
                  REQUIRED DOUBLE radius; OPTIONAL INT64 time; REQUIRED BYTE_ARRAY name (UTF8); }";
    let schema = Arc::new(parse_message_type(schema).unwrap());
    let properties = Arc::new(WriterProperties::builder().build());
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, properties).unwrap();
    for _ in 0..2 {
        let mut group = writer.next_row_group().unwrap();
        let mut number = 0;
        while let Some(mut column) = group.next_column().unwrap() {
            let present = vec![1; rows];
            let present = (number != 3 && number != 5).then_some(&present[..]);
            let few = [vec![0; usize::from(gap)], vec![1; rows - usize::from(gap)]].concat();
            match number {
                4 => {
                    let times: Vec<i64> = (0..rows).map(|row| (row / 3) as i64).collect();
                    column.typed::<Int64Type>().write_batch(&times, present, None).unwrap();
                }
                5 => {
                    let names = vec!["ball".into(); rows];
                    column.typed::<ByteArrayType>().write_batch(&names, None, None).unwrap();
                }
                _ => {
                    let values: Vec<f64> = (0..rows).map(|row| 1.0 + (row % 3) as f64).collect();
                    let (values, present) = match number {
                        0 => (&values[usize::from(gap)..], Some(&few[..])),
                        _ => (&values[..], present),
                    };
                    column.typed::<DoubleType>().write_batch(values, present, None).unwrap();
                }
            }
            column.close().unwrap();
            number += 1;
        }
        group.close().unwrap();
    }
    writer.into_inner().unwrap()
}

#[test]
fn tables_of_other_programs_are_read_and_no_damage_makes_it_panic() {
    let folder = Folder::with(BOX);
    let path = folder.path("other.parquet");
    let read = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        FrameReader::open(&path).and_then(|frames| frames.collect::<Result<Vec<_>, _>>())
    };
    let whole = foreign(6, false);
    let frames = read(&whole).unwrap();
    assert_eq!(
        frames.iter().map(|frame| frame.time).collect::<Vec<_>>(),
        [Some(0.0), Some(1.0), Some(0.0), Some(1.0)]
    );
    assert_eq!(frames[1].bodies.position[2][..], [1.0, 2.0, 3.0]);
    let error = read(&foreign(6, true)).unwrap_err().to_string();
    assert!(error.contains("x: it does not have a number in each of 6 rows"), "{error}");
    for length in 0..whole.len() {
        assert!(read(&whole[..length]).is_err(), "{length}");
    }
    for at in (0..whole.len()).step_by(5) {
        for bits in [0x01, 0x80, 0xff] {
            let mut changed = whole.clone();
            changed[at] ^= bits;
            // What has no checksums can be something else.
            let _ = read(&changed);
        }
    }
}

#[test]
fn a_batch_has_the_values_of_its_rows() {
    let scene = BOX.replace("duration = 2.0", "duration = 0.2");
    let folder = Folder::with(&scene);
    let batch = "batch scene.toml --count 5 --vary spheres[0].radius=0.4,0.5 \
                 --vary surface.kind=rough,smooth --observe temperature,x[0],steps --output rows";
    folder.says(&format!("{batch}.csv")).well();
    folder.says(&format!("{batch}.parquet")).well();
    let (names, texts) = rows(&folder.path("rows.csv"));
    let table = Table::of(&folder.path("rows.parquet"));
    assert_eq!(table.names, names);
    assert_eq!(folder.names(), ["rows.csv", "rows.parquet", "scene.toml"]);
    for (fields, texts) in table.rows.iter().zip(&texts) {
        for ((name, field), text) in names.iter().zip(fields).zip(texts) {
            let same = match field {
                Field::ULong(value) => *text == value.to_string(),
                Field::Double(value) => text.parse() == Ok(*value),
                Field::Str(value) => text == value,
                Field::Null => text.is_empty(),
                _ => false,
            };
            assert!(same, "{name}: {field:?} and {text}");
        }
    }
    assert_eq!(table.rows.len(), 5);
    assert!(matches!(table.column("state_hash")[0], Field::Str(hash) if hash.starts_with("0x")));
    // A scene that fails has nothing but why.
    let batch = "batch scene.toml --count 2 --vary spheres[0].radius=0.5,3 --output r.parquet";
    assert_eq!(folder.says(batch).status, Some(1));
    let table = Table::of(&folder.path("r.parquet"));
    assert_eq!(
        (table.column("pairs")[1], table.column("failure")[0]),
        (&Field::Null, &Field::Null)
    );
    assert!(matches!(table.column("failure")[1], Field::Str(_)));
}
