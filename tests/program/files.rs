//! The files that a run writes.

use std::fs;
use std::path::Path;
use std::str::FromStr;

use carom::bodies::Bodies;
use carom::observe::state_hash;
use carom::real::Real;

use crate::{BOX, FLUID, Folder, rows};

const EVENTS: &str = "time,a,b,surroundings,x,y,z,nx,ny,nz,jn,jtx,jty,jtz,\
                      vax,vay,vaz,wax,way,waz,vbx,vby,vbz,wbx,wby,wbz";
const STATE: &str = "id,x,y,z,vx,vy,vz,wx,wy,wz,\
                     m00,m01,m02,m10,m11,m12,m20,m21,m22,radius,mass";

#[test]
fn events_are_rows_in_order() {
    let scenes = [BOX, FLUID].into_iter();
    for (scene, engine) in scenes.flat_map(|scene| ["stepped", "event-driven"].map(|e| (scene, e)))
    {
        let folder = Folder::with(scene);
        let run = format!("run scene.toml --json --engine {engine}");
        let summary = folder.says(&format!("{run} --events events.csv")).summary();
        let (header, rows) = rows(&folder.path("events.csv"));
        assert_eq!(header.join(","), EVENTS);
        let (fixed, pairs): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row[2].is_empty());
        assert_eq!(summary["collisions"]["pairs"], pairs.len());
        assert_eq!(summary["collisions"]["surroundings"], fixed.len());
        for row in &fixed {
            assert_eq!(row[3], "0");
            assert!(row[20..].iter().all(String::is_empty));
        }
        for row in &pairs {
            assert!(row[1].parse::<u32>().unwrap() < row[2].parse::<u32>().unwrap());
            assert_eq!(row[3], "");
            assert!(row[20..].iter().all(|field| field.parse::<f64>().is_ok()));
        }
        let mut before = (0.0, 0, -1);
        for row in &rows {
            assert!(row[4..20].iter().all(|field| field.parse::<f64>().unwrap().is_finite()));
            assert!(row[10].parse::<f64>().unwrap() >= 0.0);
            let normal: f64 = row[7..10].iter().map(|n| n.parse::<f64>().unwrap().powi(2)).sum();
            assert!((normal - 1.0).abs() < 1e-14);
            let order = (
                row[0].parse::<f64>().unwrap(),
                row[1].parse::<u32>().unwrap(),
                row[2].parse::<i64>().unwrap_or(-1),
            );
            assert!(before <= order, "{before:?} {order:?}");
            before = order;
        }
        assert!(before.0 <= summary["time"].as_f64().unwrap());
        let quiet = folder.says(&run).summary();
        assert_eq!(quiet["state_hash"], summary["state_hash"]);
    }
}

#[test]
fn a_state_reads_back_to_the_same_bits() {
    fn check<T: Real + std::str::FromStr>(precision: &str) {
        let folder = Folder::with(BOX);
        let run = format!("run scene.toml --json --precision {precision} --state state.csv");
        let summary = folder.says(&run).summary();
        let (header, rows) = rows(&folder.path("state.csv"));
        assert_eq!(header.join(","), STATE);
        assert_eq!(rows.len(), 20);
        assert!(rows.iter().enumerate().all(|(index, row)| row[0] == index.to_string()));
        let state = Bodies::<T>::from_positions(&fields(&rows, 1))
            .velocities(&fields(&rows, 4))
            .spins(&fields(&rows, 7))
            .orientations(&fields(&rows, 10))
            .radii(fields::<T, 1>(&rows, 19).as_flattened())
            .masses(fields::<T, 1>(&rows, 20).as_flattened())
            .build()
            .unwrap();
        assert_eq!(summary["state_hash"], state_hash(&state).to_string());
        assert_eq!(state.radius.of(0), T::ratio(1, 2));
        assert_eq!(state.mass.of(0), T::whole(3));
    }
    check::<f32>("f32");
    check::<f64>("f64");
}

#[test]
fn files_are_replaced_when_whole_and_nothing_else_is_left() {
    let folder = Folder::with(BOX);
    fs::write(folder.path("state.csv"), "old").unwrap();
    folder.says("run scene.toml --events events.csv --state state.csv").well();
    assert!(folder.read("state.csv").starts_with(STATE));
    assert!(folder.read("events.csv").starts_with(EVENTS));
    assert_eq!(folder.names(), ["events.csv", "scene.toml", "state.csv"]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_no_file() {
    interrupted("stepped");
    interrupted("event-driven");
}

#[cfg(unix)]
fn interrupted(engine: &str) {
    use std::time::{Duration, Instant};
    let folder = Folder::with(BOX);
    fs::write(folder.path("state.csv"), "old").unwrap();
    let run = format!(
        "run scene.toml --engine {engine} --duration 1e9 --events events.csv --state state.csv"
    );
    let mut child = folder.program(run.split(' ')).spawn().unwrap();
    let patience = Instant::now();
    while folder.names().len() < 4 {
        assert!(patience.elapsed() < Duration::from_secs(60), "{:?}", folder.names());
        std::thread::sleep(Duration::from_millis(10));
    }
    // The handler is there a moment after the files are.
    std::thread::sleep(Duration::from_millis(300));
    let kill = std::process::Command::new("kill").arg("-INT").arg(child.id().to_string()).status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(folder.names(), ["scene.toml", "state.csv"]);
    assert_eq!(folder.read("state.csv"), "old");
}

/// `N` numbers of each row, from a field on.
fn fields<T: Real + FromStr, const N: usize>(rows: &[Vec<String>], first: usize) -> Vec<[T; N]> {
    let number = |text: &String| match text.parse() {
        Ok(value) => value,
        Err(_) => panic!("{text}"),
    };
    rows.iter().map(|row| std::array::from_fn(|k| number(&row[first + k]))).collect()
}

/// The arrays of an archive that are stored as they are, by name: NumPy's heading, data.
fn arrays(path: &Path) -> Vec<(String, String, Vec<u8>)> {
    let bytes = fs::read(path).unwrap();
    let number = |at: usize, len: usize| {
        bytes[at..at + len].iter().rev().fold(0_usize, |all, &byte| all << 8 | usize::from(byte))
    };
    let (mut at, mut arrays) = (0, Vec::new());
    while bytes[at..].starts_with(b"PK\x03\x04") {
        let (name, extra) = (number(at + 26, 2), number(at + 28, 2));
        let start = at + 30 + name + extra;
        // The sizes are those of ZIP64, in the extra field.
        let size = number(at + 30 + name + 4, 8);
        let head = 10 + number(start + 8, 2);
        let text = String::from_utf8_lossy(&bytes[start + 10..start + head]).into_owned();
        let name = String::from_utf8(bytes[at + 30..at + 30 + name].to_vec()).unwrap();
        arrays.push((name, text, bytes[start + head..start + size].to_vec()));
        at = start + size;
    }
    arrays
}

#[test]
fn events_are_arrays_too() {
    for (precision, kind, width) in [("f64", "'<f8'", 8), ("f32", "'<f4'", 4)] {
        let folder = Folder::with(BOX);
        let run = format!("run scene.toml --json --duration 1 --precision {precision}");
        let rows_said = folder.says(&format!("{run} --events e.csv")).summary();
        let said = folder.says(&format!("{run} --events e.npz")).summary();
        assert_eq!(said["state_hash"], rows_said["state_hash"]);
        assert_eq!(folder.names(), ["e.csv", "e.npz", "scene.toml"]);
        let (header, rows) = rows(&folder.path("e.csv"));
        let arrays = arrays(&folder.path("e.npz"));
        assert_eq!(arrays.len(), header.len());
        assert!(rows.len() > 20);
        for (column, (name, head, data)) in arrays.iter().enumerate() {
            assert_eq!(*name, format!("{}.npy", header[column]));
            assert!(head.contains(&format!("'shape': ({},)", rows.len())), "{head}");
            let (own, width) = match column {
                0 => ("'<f8'", 8),
                1..=3 => ("'<i4'", 4),
                _ => (kind, width),
            };
            assert!(head.contains(own), "{name}: {head}");
            for (row, bytes) in rows.iter().zip(data.chunks(width)) {
                let text = &row[column];
                let is_same = match own {
                    "'<i4'" => {
                        let number = i32::from_le_bytes(bytes.try_into().unwrap());
                        text.parse() == Ok(number) || text.is_empty() && number == -1
                    }
                    "'<f8'" => {
                        let number = f64::from_le_bytes(bytes.try_into().unwrap());
                        text.parse() == Ok(number) || text.is_empty() && number.is_nan()
                    }
                    _ => {
                        let number = f32::from_le_bytes(bytes.try_into().unwrap());
                        text.parse() == Ok(number) || text.is_empty() && number.is_nan()
                    }
                };
                assert!(is_same, "{name}: {text} {bytes:?}");
            }
            assert_eq!(data.len(), width * rows.len());
        }
        let size = |name: &str| fs::metadata(folder.path(name)).unwrap().len();
        println!("{precision}: {} and {} bytes", size("e.csv"), size("e.npz"));
    }
}

#[test]
fn some_of_the_events() {
    let folder = Folder::with(BOX);
    for engine in ["stepped", "event-driven"] {
        let run = format!("run scene.toml --json --engine {engine}");
        let written = |options: &str| {
            folder.says(&format!("{run} --events e.csv {options}")).summary();
            rows(&folder.path("e.csv")).1
        };
        let all = written("");
        let time = |row: &Vec<String>| row[0].parse::<f64>().unwrap();
        let is_of = |row: &Vec<String>, bodies: &[&str]| {
            bodies.contains(&row[1].as_str()) || bodies.contains(&row[2].as_str())
        };
        let some: Vec<_> = all.iter().filter(|row| time(row) >= 1.25).cloned().collect();
        assert!(!some.is_empty() && some.len() < all.len());
        assert_eq!(written("--events-from 1.25"), some);
        let some: Vec<_> = all.iter().step_by(7).cloned().collect();
        assert_eq!(written("--events-every 7"), some);
        let bodies = ["0", "4", "5", "6"];
        let some: Vec<_> = all.iter().filter(|row| is_of(row, &bodies)).cloned().collect();
        assert!(!some.is_empty() && some.len() < all.len());
        assert_eq!(written("--events-of 0,4-6"), some);
        let some = all.iter().filter(|row| time(row) >= 0.5 && is_of(row, &["0"]));
        let some: Vec<_> = some.step_by(3).cloned().collect();
        let options = "--events-from 0.5 --events-of 0 --events-every 3";
        assert_eq!(written(options), some);
        // Also where the run is kept on the way and goes on.
        let keep = format!("--events e.csv {options} --snapshot kept --snapshot-every 0.3");
        folder.says(&format!("{run} --duration 1.1 {keep}")).summary();
        folder.says(&format!("run --resume kept --duration 2 --events e.csv {options}")).well();
        assert_eq!(rows(&folder.path("e.csv")).1, some);
        fs::remove_file(folder.path("kept")).unwrap();
    }
}

#[test]
fn filters_that_mean_nothing_are_refused() {
    let folder = Folder::with(BOX);
    for (options, words) in [
        ("--events-from 1", "--events"),
        ("--events e.csv --events-from -1", "0 or more"),
        ("--events e.csv --events-every 0", "--events-every"),
        ("--events e.csv --events-of 20", "--events-of 20: there are 20 bodies"),
        ("--events e.csv --events-of 5-3", "20-29"),
        ("--events e.csv --events-of ball", "20-29"),
        ("--events e.vtk", "its ending must be .csv or .npz"),
        ("--events e.npz --snapshot kept", "can be continued: .csv"),
    ] {
        let message = folder.says(&format!("run scene.toml {options}")).fails_with(2);
        assert!(message.contains(words), "{options}: {message}");
        assert_eq!(folder.names(), ["scene.toml"]);
    }
}
