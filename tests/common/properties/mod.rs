//! Properties: what holds of every input. The tests and the fuzz targets share them.
//!
//! Each property takes bytes, as a fuzzer makes them, and panics where it is broken.
//! Bytes are read in order and are zeros where they end, so that every input means
//! something, and one that is a little different means a little else.

mod builder;
mod draws;
mod engines;
mod inputs;
mod invariants;
mod mesh;
mod text;

use std::fs;
use std::path::{Path, PathBuf};

pub use builder::builder;
pub use engines::{event_driven, stepped};
pub use inputs::{Inputs, Kind};
pub use mesh::mesh;
pub use text::text;

/// What became of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It is no scene, which an error says.
    Refused,
    /// It is a scene, and was moved.
    Ran,
    /// It is a scene in which time comes to stand still, or that leaves the range of
    /// numbers, which an error says.
    Stopped,
}

/// A property of bytes.
pub type Property = fn(&[u8]) -> Outcome;

/// All of them, by the name of their fuzz target.
pub const PROPERTIES: [(&str, Property); 5] = [
    ("text", text),
    ("mesh", mesh),
    ("builder", builder),
    ("event_driven", event_driven),
    ("stepped", stepped),
];

/// A message says something. (What is in it of the input the program makes plain.)
fn check_message(message: &str) {
    assert!(message.contains(' '), "{message:?}");
}

/// The inputs in a folder, in the order of their names.
pub fn corpus(folder: &Path) -> Vec<Vec<u8>> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths.iter().filter_map(|path| fs::read(path).ok()).collect()
}
