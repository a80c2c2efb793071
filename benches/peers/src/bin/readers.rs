//! Reads files of meshes by carom and by the crates `stl_io` and `tobj`, and
//! prints where they differ and how long they take.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml --bin readers
//! ```

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::hint::black_box;
use std::io::Cursor;
use std::path::Path;
use std::time::Instant;

use carom::surroundings::Mesh;
use comfy_table::{CellAlignment, Table, presets};
use oorandom::Rand64;
use tobj::{LoadError, LoadOptions};

/// What a reader makes of a file.
#[derive(Debug, PartialEq)]
struct Read {
    triangles: usize,
    /// Sum of the triangles' areas.
    area: f64,
}

type Outcome = Result<Read, String>;

impl Read {
    fn new(triangles: impl Iterator<Item = [[f64; 3]; 3]>) -> Self {
        let mut read = Self { triangles: 0, area: 0.0 };
        for [a, b, c] in triangles {
            let side = |to: [f64; 3]| [0, 1, 2].map(|k| to[k] - a[k]);
            let ([ux, uy, uz], [vx, vy, vz]) = (side(b), side(c));
            let [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
            read.area += 0.5 * (x * x + y * y + z * z).sqrt();
            read.triangles += 1;
        }
        read
    }

    /// Whether both have the same triangles, as far as `f32` shows it.
    fn agrees(&self, other: &Self) -> bool {
        let off = (self.area - other.area).abs();
        self.triangles == other.triangles && off <= 1e-5 * self.area.abs()
    }

    fn text(&self) -> String {
        let plural = if self.triangles == 1 { "" } else { "s" };
        format!("{} triangle{plural}, area {:.4}", self.triangles, self.area)
    }
}

/// A reader of one format, by name.
struct Reader {
    name: &'static str,
    read: fn(&[u8]) -> Outcome,
    /// The same without anything made of what is read, for the clock.
    load: fn(&[u8]) -> bool,
}

const STL: [Reader; 2] = [
    Reader {
        name: "carom",
        read: |bytes| Mesh::from_stl(bytes).map(of_carom).map_err(|e| e.to_string()),
        load: |bytes| Mesh::<f64>::from_stl(bytes).is_ok(),
    },
    Reader {
        name: "stl_io 0.11",
        read: |bytes| {
            let mesh = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|e| e.to_string())?;
            let corner = |k: usize| mesh.vertices[k].0.map(f64::from);
            Ok(Read::new(mesh.faces.iter().map(|face| face.vertices.map(corner))))
        },
        load: |bytes| black_box(stl_io::read_stl(&mut Cursor::new(bytes))).is_ok(),
    },
];

const OBJ: [Reader; 2] = [
    Reader {
        name: "carom",
        read: |bytes| Mesh::from_obj(bytes).map(of_carom).map_err(|e| e.to_string()),
        load: |bytes| Mesh::<f64>::from_obj(bytes).is_ok(),
    },
    Reader {
        name: "tobj 4.0",
        read: |bytes| {
            let models = by_tobj(bytes).map_err(|e| e.to_string())?;
            Ok(Read::new(models.iter().flat_map(|model| {
                let corner = |k: &u32| {
                    let first = 3 * *k as usize;
                    [0, 1, 2].map(|axis| f64::from(model.mesh.positions[first + axis]))
                };
                model.mesh.indices.chunks_exact(3).map(move |triangle| {
                    let [a, b, c] = [0, 1, 2].map(|k| corner(&triangle[k]));
                    [a, b, c]
                })
            })))
        },
        load: |bytes| black_box(by_tobj(bytes)).is_ok(),
    },
];

fn of_carom(mesh: Mesh<f64>) -> Read {
    let corner = |k: u32| mesh.vertices()[k as usize].to_array();
    Read::new(mesh.triangles().iter().map(|triangle| triangle.map(corner)))
}

fn by_tobj(bytes: &[u8]) -> Result<Vec<tobj::Model>, LoadError> {
    let options = LoadOptions { triangulate: true, ..LoadOptions::default() };
    // No materials: the files name none that are there.
    let materials = |_: &Path| Err(LoadError::OpenFileFailed);
    tobj::load_obj_buf(&mut Cursor::new(bytes), &options, materials).map(|(models, _)| models)
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("{}", differences()?);
    println!("{}", times()?);
    Ok(())
}

/// The files that are refused, or read in two ways.
fn differences() -> Result<Table, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/meshes");
    let mut paths = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<_>, _>>()?;
    paths.sort();
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN).set_header(["file", "carom", "stl_io or tobj"]);
    let mut agreed = 0;
    for path in &paths {
        let is_stl = path.extension().is_some_and(|ending| ending == "stl");
        let [own, other] = if is_stl { STL } else { OBJ };
        let bytes = fs::read(path)?;
        let (own, other) = ((own.read)(&bytes), (other.read)(&bytes));
        if own.as_ref().is_ok_and(|own| other.as_ref().is_ok_and(|other| own.agrees(other))) {
            agreed += 1;
            continue;
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        table.add_row([name.into_owned(), text(&own), text(&other)]);
    }
    table.add_row([format!("{agreed} others of {}", paths.len()), "the same".into(), "".into()]);
    Ok(table)
}

fn text(outcome: &Outcome) -> String {
    match outcome {
        Ok(read) => read.text(),
        Err(error) => format!("refused: {error}"),
    }
}

/// Time to read a million triangles: medians over rounds in which the readers
/// take turns.
fn times() -> Result<Table, Box<dyn Error>> {
    const ROUNDS: usize = 7;
    let (stl, obj) = million()?;
    let corners: Vec<[f64; 3]> = stl_io::read_stl(&mut Cursor::new(&stl))?
        .into_triangle_vec()
        .iter()
        .flat_map(|triangle| triangle.vertices.map(|vertex| vertex.0.map(f64::from)))
        .collect();
    let numbers = corners.len() as u32;
    let triangles: Vec<_> = (0..numbers).step_by(3).map(|k| [k, k + 1, k + 2]).collect();
    let build = || Mesh::new(&corners, &triangles).is_ok();
    let (stl, obj) = (&stl, &obj);
    let [stl_1, stl_2] = STL.map(|reader| (reader.name, move || (reader.load)(stl)));
    let [obj_1, obj_2] = OBJ.map(|reader| (reader.name, move || (reader.load)(obj)));
    let jobs: [(&str, &str, &dyn Fn() -> bool); 5] = [
        ("binary STL", stl_1.0, &stl_1.1),
        ("binary STL", "carom without reading", &build),
        ("binary STL", stl_2.0, &stl_2.1),
        ("OBJ", obj_1.0, &obj_1.1),
        ("OBJ", obj_2.0, &obj_2.1),
    ];
    let mut seconds: [Vec<f64>; 5] = Default::default();
    for _ in 0..ROUNDS {
        for ((_, reader, run), seconds) in jobs.iter().zip(&mut seconds) {
            let start = Instant::now();
            if !run() {
                return Err(format!("{reader} does not read the terrain").into());
            }
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN).set_header([
        "1,000,000 triangles",
        "reader",
        "ms",
        "ratio to carom",
    ]);
    for ((format, reader, _), own) in jobs.iter().zip(&seconds) {
        let carom = jobs.iter().position(|job| job.0 == *format).unwrap_or_default();
        let ratios = own.iter().zip(&seconds[carom]).map(|(own, carom)| own / carom);
        table.add_row([
            (*format).to_owned(),
            (*reader).to_owned(),
            format!("{:.0}", 1e3 * median(own.clone())),
            format!("{:.2}", median(ratios.collect())),
        ]);
    }
    for numeric in [2, 3] {
        if let Some(column) = table.column_mut(numeric) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    Ok(table)
}

/// The middle of an odd number of values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A terrain of a million triangles, as a binary STL file and as an OBJ file.
fn million() -> Result<(Vec<u8>, Vec<u8>), Box<dyn Error>> {
    const COLUMNS: usize = 1000;
    const ROWS: usize = 500;
    let mut random = Rand64::new(1);
    let row = COLUMNS + 1;
    let vertices: Vec<[f32; 3]> = (0..row * (ROWS + 1))
        .map(|k| [(k % row) as f32, (k / row) as f32, random.rand_float() as f32])
        .collect();
    let triangles = (0..COLUMNS * ROWS).flat_map(|k| {
        let a = k / COLUMNS * row + k % COLUMNS;
        [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]
    });
    let mut stl = vec![b' '; 80];
    stl.extend((2 * COLUMNS as u32 * ROWS as u32).to_le_bytes());
    let mut obj = String::new();
    for [x, y, z] in &vertices {
        writeln!(obj, "v {x} {y} {z}")?;
    }
    for corners in triangles {
        stl.extend([0; 12]);
        for place in corners.map(|k| vertices[k]) {
            place.iter().for_each(|c| stl.extend(c.to_le_bytes()));
        }
        stl.extend([0; 2]);
        let [a, b, c] = corners.map(|k| k + 1);
        writeln!(obj, "f {a} {b} {c}")?;
    }
    Ok((stl, obj.into_bytes()))
}
