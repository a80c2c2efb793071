//! Error: why a mesh cannot be made.

use std::path::PathBuf;
use std::{fmt, io};

/// A mesh that cannot be made of a file or of numbers.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no triangle in it.
    #[error("it has no triangles; a mesh has one at least")]
    NoTriangles,

    /// There are more triangles than a mesh can have.
    #[error("it has {triangles} triangles; 2^28 - 1 is the most there can be")]
    TooMany {
        /// How many.
        triangles: u64,
    },

    /// A triangle names a vertex that there is not.
    #[error(
        "triangle {triangle} has the vertex {vertex}, and there are {vertices}; vertices count \
         from 0"
    )]
    NoVertex {
        /// The triangle.
        triangle: usize,
        /// The number that it gives.
        vertex: u64,
        /// How many vertices there are.
        vertices: usize,
    },

    /// A vertex is not finite.
    #[error("vertex {vertex} is not finite; every coordinate must be a number")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },

    /// Heights do not make a grid.
    #[error(
        "{heights} heights in rows of {columns} make no grid; it has two columns and two rows at \
         least"
    )]
    NoGrid {
        /// How many a row has.
        columns: usize,
        /// How many there are.
        heights: usize,
    },

    /// Something is wrong at a place of a file.
    #[error("{place}: {problem}")]
    Content {
        /// Where.
        place: FilePlace,
        /// What is wrong, and what would be right.
        problem: String,
    },

    /// A picture has no heights.
    #[error("it is no picture of heights: {0}")]
    Picture(String),

    /// A file cannot be read.
    #[error("it cannot be read: {0}")]
    Unreadable(#[from] io::Error),

    /// The ending of a file's name says nothing.
    #[error("{} is neither .stl nor .obj, by the ending of its name", .0.display())]
    UnknownFormat(PathBuf),
}

/// A place of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FilePlace {
    /// A byte, from 0.
    Byte(u64),
    /// A line, from 1.
    Line(usize),
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::Line(line) => write!(f, "line {line}"),
        }
    }
}

impl MeshError {
    pub(in crate::surroundings) fn at_byte(byte: usize, problem: impl Into<String>) -> Self {
        Self::Content { place: FilePlace::Byte(byte as u64), problem: problem.into() }
    }

    pub(in crate::surroundings) fn at_line(line: usize, problem: impl Into<String>) -> Self {
        Self::Content { place: FilePlace::Line(line), problem: problem.into() }
    }
}
