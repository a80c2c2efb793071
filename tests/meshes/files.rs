//! Files of meshes: good ones, odd ones that are reported, and bad ones that are refused with
//! the byte or the line.

use std::path::{Path, PathBuf};

use carom::SceneFile;
use carom::scene::SceneError;
use carom::surroundings::{Mesh, MeshError, Shape};
use png::{BitDepth, ColorType};

use crate::{Net, grid, icosphere};

/// Triangles, vertices; open, non-manifold and flipped edges; degenerate, components; and the
/// volume, if it is closed.
type Wanted = (usize, usize, [usize; 3], usize, usize, Option<f64>);

/// A unit cube.
const CUBE: Wanted = (12, 8, [0, 0, 0], 0, 1, Some(1.0));

const GOOD: [(&str, Wanted); 25] = [
    ("cube.stl", CUBE),
    ("cube-ascii.stl", CUBE),
    ("cube-quads.obj", CUBE),
    ("cube-negative-indices.obj", CUBE),
    ("cube-texture-normals.obj", CUBE),
    ("ascii-crlf-uppercase.stl", CUBE),
    ("ascii-name-with-spaces.stl", CUBE),
    ("ascii-no-end.stl", CUBE),
    ("binary-that-says-solid.stl", CUBE),
    ("ascii-two-solids.stl", (24, 8, [0, 18, 0], 0, 1, None)),
    ("icosphere-0.stl", (20, 12, [0, 0, 0], 0, 1, None)),
    ("concave-pentagon.obj", (3, 5, [5, 0, 0], 0, 1, None)),
    ("bent-quad.obj", (2, 4, [4, 0, 0], 0, 1, None)),
    ("continued-line.obj", (1, 3, [3, 0, 0], 0, 1, None)),
    ("vertex-colours-and-w.obj", (1, 3, [3, 0, 0], 0, 1, None)),
    ("open-cube.stl", (10, 8, [4, 0, 0], 0, 1, None)),
    ("inside-out-cube.stl", (12, 8, [0, 0, 0], 0, 1, Some(-1.0))),
    ("one-flipped-face.stl", (12, 8, [0, 0, 3], 0, 1, None)),
    ("degenerate.stl", (15, 9, [2, 1, 0], 3, 1, None)),
    ("sliver.stl", (3, 4, [3, 0, 0], 0, 1, None)),
    ("non-manifold-fan.stl", (3, 5, [6, 1, 0], 0, 1, None)),
    ("duplicate-triangle.stl", (13, 8, [0, 3, 0], 0, 1, None)),
    ("t-junction.stl", (4, 6, [8, 0, 0], 0, 1, None)),
    ("crack-1e-6.stl", (2, 6, [6, 0, 0], 0, 2, None)),
    ("far-from-origin.stl", (12, 8, [0, 0, 0], 0, 1, Some(1.0))),
];

/// What is wrong, and where.
const BAD: [(&str, &str); 15] = [
    (
        "truncated.stl",
        "byte 80: it says that there are 12 triangles, which are 684 bytes, and the file has 455",
    ),
    ("count-too-great.stl", "byte 80: it says that there are 4"),
    ("count-too-small.stl", "byte 80: it says that there are 5 triangles, which are 334 bytes"),
    ("header-only.stl", "byte 80: it says that there are no triangles"),
    ("empty.stl", "byte 0: the file ends here; a binary STL file has 84 bytes at least"),
    ("shorter-than-header.stl", "byte 40: the file ends here"),
    ("not-a-number.stl", "byte 96: a coordinate of triangle 0 is NaN; it must be finite"),
    ("infinite.stl", "byte 96: a coordinate of triangle 0 is inf; it must be finite"),
    ("comma-decimal.stl", "line 2: \"-1,000000\" stands where a number, with a point"),
    ("ascii-cut.stl", "line 43: the file ends here without \"endsolid\", and what it has is not"),
    ("index-out-of-range.obj", "line 9: a face has the vertex 9, and there are 8 up to here"),
    ("index-zero.obj", "line 9: a face has the vertex 0"),
    ("two-corners.obj", "line 9: a face of 2 corners"),
    ("lines-and-points-only.obj", "line 9: a line or a point"),
    ("bad-number.obj", "line 1: \"zero\" stands where a number belongs"),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/meshes")
}

#[test]
fn good_files_have_the_right_geometry() {
    for (name, (triangles, vertices, [open, several, flipped], degenerate, components, volume)) in
        GOOD
    {
        let mesh =
            Mesh::<f64>::load(&folder().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let report = mesh.report();
        assert_eq!(report.triangles, triangles, "{name}: {report:?}");
        assert_eq!([report.vertices, report.open_edges], [vertices, open], "{name}: {report:?}");
        assert_eq!(
            [report.non_manifold_edges, report.flipped_edges, report.degenerate, report.components],
            [several, flipped, degenerate, components],
            "{name}: {report:?}"
        );
        let shape = Shape::from(mesh);
        if volume == Some(1.0) {
            assert!(shape.area().is_some_and(|area| (area - 12.0).abs() < 1e-9), "{name}");
        }
        if let Some(volume) = volume {
            assert!(report.is_closed(), "{name}");
            assert!((report.volume - volume).abs() < 1e-12, "{name}: {}", report.volume);
        }
    }
}

#[test]
fn bad_files_are_refused_with_their_place() {
    for (name, wanted) in BAD {
        let error = Mesh::<f64>::load(&folder().join(name)).map(|_| name).unwrap_err();
        assert!(error.to_string().starts_with(wanted), "{name}: {error}");
    }
    let known = GOOD.iter().map(|good| good.0).chain(BAD.iter().map(|bad| bad.0));
    let mut known: Vec<_> = known.chain(["beyond-f32-squares.stl"]).collect();
    known.sort_unstable();
    let entries = std::fs::read_dir(folder()).unwrap();
    let mut found: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
    found.sort_unstable();
    assert_eq!(found, known);
}

/// The same as bytes of an STL file.
fn stl(net: &Net) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((net.triangles.len() as u32).to_le_bytes());
    for triangle in &net.triangles {
        bytes.extend([0; 12]);
        for corner in triangle {
            let place = net.vertices[*corner as usize];
            place.iter().for_each(|c| bytes.extend((*c as f32).to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn large_files_are_read_whole() {
    for level in 1..5 {
        let report = Mesh::<f64>::from_stl(&stl(&icosphere(1.0, level))).unwrap().report();
        let triangles = 20 << (2 * level);
        assert_eq!((report.triangles, report.vertices), (triangles, triangles / 2 + 2));
        assert!(report.is_closed() && report.components == 1);
    }
    let terrain = grid(100, |i, j| [i as f64, j as f64, ((3 * i + 5 * j) % 7) as f64 * 0.125]);
    let binary = Mesh::<f64>::from_stl(&stl(&terrain)).unwrap();
    let lines = terrain.vertices.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = terrain.triangles.iter().map(|t| t.map(|k| k + 1));
    let faces = faces.map(|[a, b, c]| format!("f {a} {b} {c}\n"));
    let text: String = lines.chain(faces).collect();
    let text = Mesh::<f64>::from_obj(text.as_bytes()).unwrap();
    assert_eq!(binary.report(), text.report());
    assert_eq!(binary.vertices(), text.vertices());
    assert_eq!(binary.triangles(), text.triangles());
    assert_eq!((binary.report().open_edges, binary.report().triangles), (400, 20_000));
}

/// Cut anywhere, changed anywhere: an error or a mesh, never a panic.
#[test]
fn no_file_is_too_broken_for_a_message() {
    let mut tried = 0;
    for entry in std::fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        let bytes = std::fs::read(&path).unwrap();
        let read = |bytes: &[u8]| {
            let stl = Mesh::<f32>::from_stl(bytes).map(|mesh| mesh.report());
            let obj = Mesh::<f32>::from_obj(bytes).map(|mesh| mesh.report());
            [stl.map(|report| report.triangles), obj.map(|report| report.triangles)]
        };
        let step = bytes.len() / 23 + 1;
        for end in (0..bytes.len()).step_by(step) {
            for found in read(&bytes[..end]) {
                assert!(found.is_err() || found.is_ok_and(|triangles| triangles > 0));
                tried += 1;
            }
            let mut changed = bytes.clone();
            changed[end] = changed[end].wrapping_add(0x5b);
            tried += read(&changed).len();
        }
    }
    assert!(tried > 1000, "{tried}");
}

#[test]
fn numbers_that_make_no_mesh_are_refused() {
    let corners = [[0.0_f64; 3], [1.0, 0.0, 0.0], [0.0, f64::NAN, 0.0]];
    assert!(matches!(Mesh::new(&corners, &[]), Err(MeshError::NoTriangles)));
    let error = Mesh::new(&corners, &[[0, 1, 7]]).unwrap_err().to_string();
    assert_eq!(error, "triangle 0 has the vertex 7, and there are 3; vertices count from 0");
    let error = Mesh::new(&corners, &[[0, 1, 2]]).unwrap_err().to_string();
    assert!(error.starts_with("vertex 2 is not finite"), "{error}");
}

/// A scene with one shape, whose paths start in the folder of the files, and a sphere that
/// is far away.
fn scene(precision: &str, shape: &str) -> Result<SceneFile, String> {
    let shape = shape.replace("file = \"", &format!("file = \"{}/", folder().display()));
    let text = format!(
        "precision = \"{precision}\"\n[[surroundings]]\n{shape}\n[[spheres]]\nposition = [-90, \
         -90, 90]\nradius = 1\n"
    );
    SceneFile::parse("scene.toml", &text).map_err(|error| error.to_string())
}

fn refused(precision: &str, shape: &str) -> String {
    let file = match scene(precision, shape) {
        Ok(file) => file,
        Err(error) => return error,
    };
    let error = match precision {
        "f32" => file.build::<f32>().map(|_| ()).unwrap_err(),
        _ => file.build::<f64>().map(|_| ()).unwrap_err(),
    };
    error.to_string()
}

#[test]
fn scene_files_name_meshes() {
    let built = |shape: &str| {
        scene("f64", shape).unwrap().build::<f64>().unwrap_or_else(|e| panic!("{shape}: {e}"))
    };
    let count = |shape: &str| built(shape).surroundings[0].mesh().unwrap().triangles().len();
    assert_eq!(count("shape = \"mesh\"\nfile = \"cube.stl\""), 12);
    assert_eq!(
        count(
            "shape = \"mesh\"\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\ntriangles = [[0, 1, 2]]"
        ),
        1
    );
    assert_eq!(
        count(
            "shape = \"heightfield\"\nspacing = 0.5\ncolumns = 3\nrows = 2\nheights = [0, 1, 0, 1, 0, 1]"
        ),
        4
    );
    let placed = built(
        "shape = \"mesh\"\nfile = \"cube.stl\"\nscale = 2.0\nrotation = { axis = [0, 0, 2], angle \
         = 1.5707963267948966 }\ntranslation = [10, 0, 0]",
    );
    let [lower, upper] = placed.surroundings[0].mesh().unwrap().bounds();
    let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12);
    assert!(near(lower.to_array(), [8.0, 0.0, 0.0]) && near(upper.to_array(), [10.0, 2.0, 2.0]));
}

#[test]
fn scene_files_with_bad_meshes_name_file_key_and_place() {
    let mesh = |file: &str| format!("shape = \"mesh\"\nfile = \"{file}\"");
    for (shape, parts) in [
        (mesh("truncated.stl"), ["surroundings[0].file", "truncated.stl", "byte 80", "455"]),
        (mesh("ascii-cut.stl"), ["surroundings[0].file", "ascii-cut.stl", "line ", "ends here"]),
        (mesh("bad-number.obj"), ["surroundings[0].file", "bad-number.obj", "line 1", "zero"]),
        (mesh("none.stl"), ["surroundings[0].file", "none.stl", "cannot be read", "path"]),
        (mesh("cube.ply"), ["surroundings[0].file", "cube.ply", ".stl nor .obj", "path"]),
        (
            "shape = \"mesh\"".to_owned(),
            ["surroundings[0].vertices", "missing", "list of points", "[["],
        ),
        (
            format!("{}\nvertices = [[0, 0, 0]]", mesh("cube.stl")),
            ["surroundings[0].vertices", "beside a file", "leave out", "one"],
        ),
        (
            "shape = \"mesh\"\nvertices = [[0, 0, 0]]\ntriangles = [[0, 0, 1]]".to_owned(),
            ["surroundings[0].triangles", "vertex 1", "there are 1", "from 0"],
        ),
        (
            "shape = \"mesh\"\nvertices = [[0, 0, 0]]\ntriangles = [[0, 0]]".to_owned(),
            ["triangles", "3", "length", "2"],
        ),
        (
            "shape = \"heightfield\"\nspacing = 1\ncolumns = 2\nrows = 2\nheights = [0, 0, 0]"
                .to_owned(),
            ["surroundings[0].heights", "a list of 3", "2 columns", "4 heights"],
        ),
        (
            "shape = \"heightfield\"\nspacing = [1, 0]\ncolumns = 2\nrows = 2\nheights = [0]"
                .to_owned(),
            ["surroundings[0].spacing", "[1.0, 0.0]", "greater than 0", "along"],
        ),
    ] {
        let error = refused("f64", &shape);
        for part in parts {
            assert!(error.contains(part), "{part:?} is not in: {error}");
        }
    }
    // Its squares leave the range of a single only.
    let beyond = mesh("beyond-f32-squares.stl");
    assert!(scene("f64", &beyond).unwrap().build::<f64>().is_ok());
    let error = refused("f32", &beyond);
    for part in ["surroundings[0].file", "byte 84", "triangle 0", "f32 can square"] {
        assert!(error.contains(part), "{part:?} is not in: {error}");
    }
}

#[test]
fn heights_are_read_from_tables() {
    let folder = tempfile::tempdir().unwrap();
    let read = |table: &str| {
        std::fs::write(folder.path().join("heights.csv"), table).unwrap();
        let text = "[[surroundings]]\nshape = \"heightfield\"\norigin = [1, 2]\nspacing = [1, \
                    2]\nfile = \"heights.csv\"\n[[spheres]]\nposition = [0, 0, 9]\nradius = 1\n";
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).unwrap();
        SceneFile::load(&path).unwrap().build::<f64>()
    };
    let scene = read("0, 1, 0.5\r\n0,2,1e-1\r\n\r\n").unwrap();
    let mesh = scene.surroundings[0].mesh().unwrap();
    assert_eq!(mesh.triangles().len(), 4);
    assert_eq!(mesh.bounds().map(|corner| corner.to_array()), [[1.0, 2.0, 0.0], [3.0, 4.0, 2.0]]);
    for (table, parts) in [
        ("0,1\n0,x\n", ["heights.csv", "line 2", "column 2 is \"x\""]),
        ("0,1\n0,nan\n", ["heights.csv", "line 2", "finite"]),
        ("0,1\n0\n", ["heights.csv", "line 2", "it has 1 heights"]),
        ("0,1\n", ["heights.csv", "no grid", "two rows"]),
        ("", ["heights.csv", "no grid", "two columns"]),
    ] {
        let error = read(table).map(|_| ()).unwrap_err().to_string();
        for part in parts {
            assert!(error.contains(part), "{part:?} is not in: {error}");
        }
    }
}

/// A picture of some colours and depth.
fn picture(colours: ColorType, depth: BitDepth, [width, height]: [u32; 2], data: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(colours);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    file
}

#[test]
fn heights_are_read_from_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let read = |keys: &str, file: &[u8]| {
        std::fs::write(folder.path().join("heights.png"), file).unwrap();
        let text = format!(
            "[[surroundings]]\nshape = \"heightfield\"\norigin = [1, 2, 3]\nspacing = 0.5\nfile = \
             \"heights.png\"\n{keys}\n[[spheres]]\nposition = [0, 0, 99]\nradius = 1\n"
        );
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).unwrap();
        let scene = SceneFile::load(&path)?.build::<f64>()?;
        let mesh = scene.surroundings[0].mesh().unwrap();
        let mut places: Vec<_> = mesh.vertices().iter().map(|v| v.to_array()).collect();
        // Row by row.
        places.sort_by(|a, b| [a[1], a[0]].partial_cmp(&[b[1], b[0]]).unwrap());
        Ok(places.into_iter().map(|[_, _, z]| z).collect::<Vec<_>>())
    };
    let (grey, wide) = (ColorType::Grayscale, [3, 2]);
    let deep: Vec<u8> =
        [0, 1, 65535, 32768, 256, 4369].into_iter().flat_map(u16::to_be_bytes).collect();
    let sixteen = picture(grey, BitDepth::Sixteen, wide, &deep);
    let height = |level: f64| 3.0 + (-2.0 + 8.0 * level);
    let levels = [32768.0, 256.0, 4369.0, 0.0, 1.0, 65535.0].map(|level: f64| level / 65535.0);
    let right = levels.map(height).to_vec();
    assert_eq!(read("range = [-2, 6]", &sixteen).unwrap(), right);

    let eight = picture(grey, BitDepth::Eight, wide, &[0, 51, 255, 102, 204, 255]);
    let right = vec![3.4, 3.8, 4.0, 3.0, 3.2, 4.0];
    assert_eq!(read("", &eight).unwrap(), right);
    let colours = [0, 0, 0, 51, 51, 51, 255, 255, 255, 102, 102, 102, 204, 204, 204, 255, 255, 255];
    assert_eq!(read("", &picture(ColorType::Rgb, BitDepth::Eight, wide, &colours)).unwrap(), right);
    let one_bit = picture(grey, BitDepth::One, wide, &[0b1010_0000, 0b0110_0000]);
    assert_eq!(read("", &one_bit).unwrap(), [3.0, 4.0, 4.0, 4.0, 3.0, 4.0]);
    let opaque = [9, 255, 9, 255, 9, 255, 9, 255, 9, 255, 9, 255];
    read("", &picture(ColorType::GrayscaleAlpha, BitDepth::Eight, wide, &opaque)).unwrap();

    let refused = |keys: &str, file: &[u8], parts: &[&str]| {
        let error: SceneError = read(keys, file).unwrap_err();
        let error = error.to_string();
        for part in parts {
            assert!(error.contains(part), "{part:?} is not in: {error}");
        }
    };
    let mut red = colours;
    red[5] = 52;
    let red = picture(ColorType::Rgb, BitDepth::Eight, wide, &red);
    refused(
        "",
        &red,
        &["surroundings[0].file", "heights.png", "pixel 1 from the left and 0", "grey"],
    );
    let mut clear = opaque;
    clear[11] = 254;
    let clear = picture(ColorType::GrayscaleAlpha, BitDepth::Eight, wide, &clear);
    refused("", &clear, &["pixel 2 from the left and 1 from the top", "opaque"]);
    let row = picture(grey, BitDepth::Eight, [3, 1], &[0; 3]);
    refused("", &row, &["heights.png", "two rows"]);
    refused("range = [0]", &eight, &["surroundings[0].range", "black and white"]);
    refused("range = [0, nan]", &eight, &["surroundings[0].range"]);
    refused("", b"0,1\n2,3\n", &["heights.png", "no picture"]);
    for length in 0..sixteen.len() {
        refused("", &sixteen[..length], &["heights.png", "no picture"]);
    }
    // More pixels than its bytes can have, with a right sum of the header.
    let mut huge = picture(grey, BitDepth::Eight, [60_000, 2], &[0; 120_000]);
    huge.truncate(100);
    refused("", &huge, &["60000 × 2 pixels"]);
}
