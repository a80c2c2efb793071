//! Frames of the trajectory: what is in them, and that a run does not feel them.

use std::fs::File;
use std::io::{Cursor, Read};

use crate::{BOX, FLUID, Folder, rows};

/// The numbers after a name in the head of a frame, up to its end.
fn values(line: &str) -> Vec<f64> {
    line.split_whitespace().map(|value| value.parse().unwrap()).collect()
}

/// The frames of a LAMMPS dump: step, bounds, whether periodic, names, rows.
struct Dumped {
    step: u64,
    sides: String,
    bounds: Vec<Vec<f64>>,
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

fn dumped(text: &str) -> Vec<Dumped> {
    let mut lines = text.lines();
    let mut frames = Vec::new();
    while let Some(line) = lines.next() {
        assert_eq!(line, "ITEM: TIMESTEP");
        let step = lines.next().unwrap().parse().unwrap();
        assert_eq!(lines.next(), Some("ITEM: NUMBER OF ATOMS"));
        let count: usize = lines.next().unwrap().parse().unwrap();
        let sides = lines.next().unwrap().strip_prefix("ITEM: BOX BOUNDS ").unwrap().to_owned();
        let bounds = (0..3).map(|_| values(lines.next().unwrap())).collect();
        let names = lines.next().unwrap().strip_prefix("ITEM: ATOMS ").unwrap();
        let names = names.split(' ').map(str::to_owned).collect();
        let rows = (0..count).map(|_| values(lines.next().unwrap())).collect();
        frames.push(Dumped { step, sides, bounds, names, rows });
    }
    frames
}

impl Dumped {
    fn of(&self, name: &str) -> Vec<f64> {
        let column = self.names.iter().position(|other| other == name).unwrap();
        self.rows.iter().map(|row| row[column]).collect()
    }
}

/// A column of a state file.
fn state(folder: &Folder, name: &str) -> Vec<f64> {
    let (names, rows) = rows(&folder.path("state.csv"));
    let column = names.iter().position(|other| other == name).unwrap();
    rows.iter().map(|row| row[column].parse().unwrap()).collect()
}

#[test]
fn frames_change_no_bit_of_a_run() {
    for (scene, engine) in [(BOX, "stepped"), (BOX, "event-driven"), (FLUID, "event-driven")] {
        for precision in ["f32", "f64"] {
            let folder = Folder::with(scene);
            let run = format!(
                "run scene.toml --json --engine {engine} --precision {precision} --duration 0.7"
            );
            let plain = folder.says(&format!("{run} --events plain.csv")).summary();
            for (ending, every) in [
                ("dump", "0.1"),
                ("lammpstrj", "0.7"),
                ("xyz", "0.033"),
                ("npz", "0.2"),
                ("parquet", "0.03"),
            ] {
                let with = folder.says(&format!(
                    "{run} --events with.csv --record frames.{ending} --record-every {every}"
                ));
                let with = with.summary();
                for key in ["state_hash", "collisions", "energy", "momentum", "time"] {
                    assert_eq!(with[key], plain[key], "{engine} {precision} {ending}: {key}");
                }
                assert_eq!(folder.read("with.csv"), folder.read("plain.csv"));
            }
        }
    }
}

#[test]
fn the_last_frame_of_a_dump_is_the_state() {
    let folder = Folder::with(FLUID);
    folder
        .says(
            "run scene.toml --engine event-driven --duration 0.3 --record run.dump --record-every \
             0.1 --state state.csv",
        )
        .well();
    let frames = dumped(&folder.read("run.dump"));
    assert_eq!(frames.iter().map(|frame| frame.step).collect::<Vec<_>>(), [0, 1, 2, 3]);
    let last = &frames[3];
    assert_eq!(last.sides, "pp pp pp");
    assert_eq!(last.bounds[0], last.bounds[2]);
    for (name, column) in [("x", "x"), ("y", "y"), ("vz", "vz"), ("omegax", "wx")] {
        assert_eq!(last.of(name), state(&folder, column), "{name}");
    }
    assert_eq!(last.of("id"), (1..=256).map(f64::from).collect::<Vec<_>>());
    assert_eq!(last.of("type"), vec![1.0; 256]);
    assert_eq!(last.of("quatw"), vec![1.0; 256]);
}

#[test]
fn stepped_frames_are_at_the_step_at_or_behind_their_time() {
    let folder = Folder::with(BOX);
    let run = "run scene.toml --dt 0.02 --duration 0.2 --record run.lammpstrj --record-every 0.05";
    folder.says(run).well();
    let frames = dumped(&folder.read("run.lammpstrj"));
    assert_eq!(frames.iter().map(|frame| frame.step).collect::<Vec<_>>(), [0, 3, 5, 8, 10]);
    assert!(frames.iter().all(|frame| frame.sides == "ff ff ff"));
    assert_eq!(frames[0].of("type")[..3], [1.0, 2.0, 2.0]);
    // 0.1 and 0.3 are no multiples of 0.02 and 0.1 in binary.
    let run = "run scene.toml --dt 0.02 --duration 0.3 --record run.lammpstrj --record-every 0.1";
    folder.says(run).well();
    let frames = dumped(&folder.read("run.lammpstrj"));
    assert_eq!(frames.iter().map(|frame| frame.step).collect::<Vec<_>>(), [0, 5, 10, 15]);
}

#[test]
fn images_count_the_boxes_that_bodies_move_through() {
    // One body alone flies straight: 30 boxes along x, 7.5 back along y.
    let scene = "duration = 15\nperiodic = { lower = [0, 0, 0], upper = [4, 4, 4] }\n\
                 [[spheres]]\nposition = [1, 1, 1]\nvelocity = [8, -2, 0]\nradius = 0.5\n";
    for engine in ["", "--engine stepped --dt 0.01"] {
        let folder = Folder::with(scene);
        folder.says(&format!("run scene.toml {engine} --state end.dump")).well();
        let [end] = &dumped(&folder.read("end.dump"))[..] else { panic!("one frame") };
        assert_eq!([end.of("ix")[0], end.of("iy")[0], end.of("iz")[0]], [30.0, -8.0, 0.0]);
        approx::assert_abs_diff_eq!(end.of("y")[0], 3.0, epsilon = 1e-9);
    }
}

#[test]
fn extended_xyz_has_its_lattice_and_time() {
    let folder = Folder::with(BOX);
    let run = "run scene.toml --engine event-driven --duration 0.5 --record run.xyz --record-every \
               0.25 --state state.csv";
    folder.says(run).well();
    let text = folder.read("run.xyz");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 3 * 22);
    assert_eq!((lines[0], lines[22], lines[44]), ("20", "20", "20"));
    for (frame, time) in ["0.0", "0.25", "0.5"].into_iter().enumerate() {
        let head = lines[22 * frame + 1];
        assert!(head.starts_with("Lattice=\""), "{head}");
        assert!(head.contains(&format!(" Time={time} pbc=\"F F F\"")), "{head}");
        assert!(head.contains("Properties=species:S:1:pos:R:3:"), "{head}");
    }
    let row: Vec<&str> = lines[46].split(' ').collect();
    assert_eq!((row[0], row.len()), ("X1", 1 + 3 + 1 + 2 + 3 + 3 + 3 + 4));
    let x: f64 = row[1].parse().unwrap();
    assert_eq!(x, state(&folder, "x")[0]);
}

#[test]
fn a_series_of_paraview_names_a_file_for_each_frame() {
    let folder = Folder::with(FLUID);
    let run = "run scene.toml --engine event-driven --duration 0.2 --record run.pvd --record-every \
               0.1 --state state.csv";
    folder.says(run).well();
    let names = ["run.pvd", "run_000000.vtp", "run_000001.vtp", "run_000002.vtp"];
    assert_eq!(folder.names()[..4], names);
    let series = folder.read("run.pvd");
    assert!(
        series
            .contains("<DataSet timestep=\"0.2\" group=\"\" part=\"0\" file=\"run_000002.vtp\"/>")
    );
    let text = folder.read("run_000002.vtp");
    for name in ["Points", "id", "type", "radius", "mass", "v", "omega", "Orientation", "image"] {
        assert!(text.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    // The array of positions: its length in bytes, and then the numbers.
    let start = text.find("Name=\"Points\"").unwrap();
    let start = start + text[start..].find('>').unwrap() + 1;
    let end = start + text[start..].find('<').unwrap();
    let bytes = decoded(&text[start..end]);
    let number = |k: usize| f64::from_le_bytes(bytes[8 * k..8 * k + 8].try_into().unwrap());
    assert_eq!(u64::from_le_bytes(bytes[..8].try_into().unwrap()), 256 * 24);
    let x: Vec<f64> = (0..256).map(|body| number(1 + 3 * body)).collect();
    assert_eq!(x, state(&folder, "x"));
    // A series that does not come to its end leaves nothing.
    let folder =
        Folder::with(&FLUID.replace("radius = 0.5", "radius = 0.5\nvelocity = [1e200, 0, 0]"));
    let run =
        "run scene.toml --precision f64 --duration 1e100 --record run.pvd --record-every 1e99";
    let said = folder.says(run);
    assert_ne!(said.status, Some(0), "{said:?}");
    assert_eq!(folder.names(), ["scene.toml"]);
}

/// What base64 text stands for.
fn decoded(text: &str) -> Vec<u8> {
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut bytes = Vec::new();
    let (mut bits, mut count) = (0_u32, 0);
    for digit in text.bytes().filter(|digit| *digit != b'=') {
        let value = digits.iter().position(|other| *other == digit).unwrap() as u32;
        bits = bits << 6 | value;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
            bits &= (1 << count) - 1;
        }
    }
    bytes
}

#[test]
fn numbers_that_stop_being_one_are_all_there() {
    // At rest until a ball comes: its velocity is 0, then is not, then is again.
    let scene = "duration = 3\n[[spheres]]\nposition = [0, 0, 0]\nradius = 0.5\n\
                 [[spheres]]\nposition = [0, 0, 2]\nradius = 0.5\nvelocity = [0, 0, -1]\n\
                 [[spheres]]\nposition = [0, 0, -2]\nradius = 0.5\n";
    let folder = Folder::with(scene);
    folder.says("run scene.toml --record run.npz --record-every 0.75").well();
    let mut bytes = Vec::new();
    File::open(folder.path("run.npz")).unwrap().read_to_end(&mut bytes).unwrap();
    let entries = entries(&bytes);
    let of = |name: &str| {
        let data = &entries.iter().find(|(other, _)| other == name).unwrap().1;
        let numbers = data[data.len() - 5 * 3 * 8..].chunks(8);
        numbers.map(|number| f64::from_le_bytes(number.try_into().unwrap())).collect::<Vec<_>>()
    };
    let before = [0.0, -1.0, 0.0];
    let (between, behind) = ([-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]);
    assert_eq!(of("vz.npy"), [before, before, between, behind, behind].as_flattened());
    assert_eq!(of("vx.npy"), [0.0; 15]);
    assert_eq!(of("z.npy")[..6], [0.0, 2.0, -2.0, 0.0, 1.25, -2.0]);
}

/// The entries of an archive, by its local headers: name and bytes.
pub fn entries(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut reader = Cursor::new(bytes);
    let mut entries = Vec::new();
    loop {
        let mut head = [0; 30];
        reader.read_exact(&mut head[..4]).unwrap();
        if &head[..4] != b"PK\x03\x04" {
            return entries;
        }
        reader.read_exact(&mut head[4..]).unwrap();
        let crc = u32::from_le_bytes(head[14..18].try_into().unwrap());
        let short = |at: usize| usize::from(u16::from_le_bytes([head[at], head[at + 1]]));
        let mut name = vec![0; short(26)];
        reader.read_exact(&mut name).unwrap();
        let mut extra = vec![0; short(28)];
        reader.read_exact(&mut extra).unwrap();
        let size = u64::from_le_bytes(extra[4..12].try_into().unwrap());
        let mut data = vec![0; size as usize];
        reader.read_exact(&mut data).unwrap();
        assert_eq!(crc32fast::hash(&data), crc);
        entries.push((String::from_utf8(name).unwrap(), data));
    }
}

#[test]
fn arrays_of_numpy_are_frames_by_bodies() {
    let folder = Folder::with(FLUID);
    let run = "run scene.toml --engine event-driven --duration 0.2 --record run.npz --record-every \
               0.1 --state state.csv";
    folder.says(run).well();
    let mut bytes = Vec::new();
    File::open(folder.path("run.npz")).unwrap().read_to_end(&mut bytes).unwrap();
    let entries = entries(&bytes);
    let names: Vec<&str> = entries.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names[..4], ["time.npy", "x.npy", "y.npy", "z.npy"]);
    assert_eq!(names[20..], ["lower.npy", "upper.npy"]);
    let array = |name: &str, shape: &str| {
        let data = &entries.iter().find(|(other, _)| other == name).unwrap().1;
        assert_eq!(&data[..8], b"\x93NUMPY\x01\x00");
        let length = 10 + usize::from(u16::from_le_bytes([data[8], data[9]]));
        let head = String::from_utf8_lossy(&data[10..length]).into_owned();
        assert!(head.contains(&format!("'shape': {shape}")), "{head}");
        assert!(length % 64 == 0 && head.ends_with('\n') && head.contains("'<f8'"), "{head}");
        let numbers = data[length..].chunks(8);
        numbers.map(|number| f64::from_le_bytes(number.try_into().unwrap())).collect::<Vec<_>>()
    };
    assert_eq!(array("time.npy", "(3,)"), [0.0, 0.1, 0.2]);
    let x = array("x.npy", "(3, 256)");
    assert_eq!(x[512..], state(&folder, "x"));
    assert_eq!(array("radius.npy", "(3, 256)"), vec![0.5; 3 * 256]);
    // What all bodies share has as many numbers as what they do not.
    assert_eq!(array("qw.npy", "(3, 256)"), vec![1.0; 3 * 256]);
    assert_eq!(array("wz.npy", "(3, 256)"), vec![0.0; 3 * 256]);
    let (lower, upper) = (array("lower.npy", "(3,)"), array("upper.npy", "(3,)"));
    assert_eq!((lower, upper), (vec![0.0; 3], vec![8.0; 3]));
}

#[test]
fn the_scene_can_ask_for_frames_and_options_prevail() {
    let scene = format!("{BOX}\n[record]\nfile = \"own.dump\"\nevery = 0.5\n");
    let folder = Folder::with(&scene);
    folder.says("run scene.toml --duration 1").well();
    assert_eq!(dumped(&folder.read("own.dump")).len(), 3);
    folder.says("run scene.toml --duration 1 --record-every 0.25").well();
    assert_eq!(dumped(&folder.read("own.dump")).len(), 5);
    folder.says("run scene.toml --duration 1 --set record.every=1 --record other.xyz").well();
    assert_eq!(folder.names(), ["other.xyz", "own.dump", "scene.toml"]);
    assert_eq!(folder.read("other.xyz").lines().count(), 2 * 22);
}

#[test]
fn what_cannot_be_recorded_is_refused() {
    let refused = |scene: &str, options: &str, words: &[&str]| {
        let folder = Folder::with(scene);
        let message = folder.says(&format!("run scene.toml {options}")).fails_with(2);
        for word in words {
            assert!(message.contains(word), "no {word:?} in: {message}");
        }
        assert_eq!(folder.names(), ["scene.toml"], "{message}");
    };
    let endings = ".dump, .lammpstrj, .xyz, .extxyz, .pvd, .npz or .parquet";
    refused(BOX, "--record a.vtk --record-every 1", &["--record is a.vtk", endings]);
    refused(BOX, "--record a --record-every 1", &["--record is a", endings]);
    refused(BOX, "--state end.vtk", &["--state is end.vtk", ".csv, ", endings]);
    refused(BOX, "--record a.feather --record-every 1", &["--record is a.feather", endings]);
    refused(BOX, "--record a.dump", &["no time between them", "--record-every TIME"]);
    refused(BOX, "--record-every 1", &["no file", "--record FILE"]);
    refused(BOX, "--record-every 1e-12 --record a.xyz", &["frames every 1e-12", "--record-every"]);
    refused(BOX, "--record scene.dump/x.xyz --record-every 1", &["--record", "no folder"]);
    refused(BOX, "--record a.npz --state a.npz --record-every 1", &["--state and --record"]);
    let with = |keys: &str| format!("{BOX}\n[record]\n{keys}\n");
    refused(&with("file = \"a.vtk\"\nevery = 1"), "", &["scene.toml:33: record.file", endings]);
    refused(&with("file = \"a.xyz\"\nevery = 0"), "", &["scene.toml:34: record.every is 0.0"]);
    refused(&with("file = \"a.xyz\"\nevry = 1"), "", &["scene.toml:34: record.evry"]);
    refused(&with("file = \"a.xyz\""), "", &["no time between them"]);
}
