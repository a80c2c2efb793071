//! The files that a run writes.

use std::fs;
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
