//! Tries the properties on inputs out of numbers, with a stable compiler:
//!
//! ```text
//! seeded TARGET COUNT [FIRST]     inputs FIRST to FIRST + COUNT
//! seeded TARGET FILE              the input in a file
//! ```
//!
//! Half of the inputs are those in `corpus/TARGET` with a few bytes or lines changed. One
//! that breaks a property, or takes longer than [`LONGEST`], is left in
//! `artifacts/TARGET/`.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};
use std::{env, fs, panic, process, thread};

use carom_fuzz::properties::{Inputs, Kind, PROPERTIES, corpus};

/// What an input may take.
const LONGEST: Duration = Duration::from_secs(20);

/// The input that is being tried, its number, and since when.
static PRESENT: Mutex<Option<(Vec<u8>, u64, Instant)>> = Mutex::new(None);

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let names = PROPERTIES.map(|(name, _)| name);
    let [name, what, rest @ ..] = arguments.as_slice() else {
        return usage(&names);
    };
    let Some((name, property)) = PROPERTIES.into_iter().find(|(found, _)| found == name) else {
        return usage(&names);
    };
    if let Ok(bytes) = fs::read(what) {
        println!("{name}: {:?}", property(&bytes));
        return;
    }
    let first = rest.first().map_or(Ok(0), |text| text.parse::<u64>());
    let (Ok(count), Ok(first)) = (what.parse::<u64>(), first) else { return usage(&names) };

    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut given = corpus(&folder.join("corpus").join(name));
    if name == "mesh" {
        given.extend(corpus(&folder.join("../tests/data/meshes")));
    }
    let inputs = Inputs::new(given, Kind::of(name));
    keep_what_breaks(folder.join("artifacts").join(name));
    let start = Instant::now();
    let mut outcomes = [0_u64; 3];
    let mut slowest = (Duration::ZERO, first);
    for number in first..first.saturating_add(count) {
        let bytes = inputs.input(number);
        let begin = Instant::now();
        *PRESENT.lock().unwrap() = Some((bytes.clone(), number, begin));
        outcomes[property(&bytes) as usize] += 1;
        slowest = slowest.max((begin.elapsed(), number));
    }
    let [refused, ran, stopped] = outcomes;
    println!(
        "{name}: {count} inputs from {first} on in {:.0} s: {refused} refused, {ran} ran, {stopped} \
         stopped; the slowest, {}, took {:.2} s",
        start.elapsed().as_secs_f64(),
        slowest.1,
        slowest.0.as_secs_f64()
    );
}

fn usage(names: &[&str]) {
    eprintln!(
        "usage: seeded TARGET COUNT [FIRST] | seeded TARGET FILE; targets: {}",
        names.join(", ")
    );
    process::exit(2);
}

/// Leaves an input that panics, or takes too long, in a folder.
fn keep_what_breaks(folder: PathBuf) {
    let keep = move |kind: &str, bytes: &[u8], number: u64| {
        let path = folder.join(format!("{kind}-{number}"));
        let written = fs::create_dir_all(&folder).and_then(|()| fs::write(&path, bytes));
        eprintln!("input {number} is left in {}: {written:?}", path.display());
    };
    let keep_slow = keep.clone();
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        usual(info);
        if let Ok(mut present) = PRESENT.lock()
            && let Some((bytes, number, _)) = present.take()
        {
            keep("broken", &bytes, number);
        }
    }));
    thread::spawn(move || {
        loop {
            thread::sleep(Duration::from_secs(1));
            let present = PRESENT.lock().unwrap();
            if let Some((bytes, number, since)) = present.as_ref()
                && since.elapsed() > LONGEST
            {
                keep_slow("slow", bytes, *number);
                process::exit(1);
            }
        }
    });
}
