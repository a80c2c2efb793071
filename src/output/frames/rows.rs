//! Rows: the text of many bodies, made piece by piece on all threads.

use std::io::{self, Write as _};

use rayon::prelude::*;

use super::super::push_number;
use crate::bodies::{Bodies, PerBody};
use crate::real::Real;

/// Bodies whose text one thread makes at a time.
const PIECE: usize = 2048;

/// About the bytes of a line.
const ROW: usize = 240;

/// Pieces whose text is in memory at a time.
const PIECES: usize = 32;

/// Writes a line for each of `count` bodies.
pub fn write<W: io::Write>(
    output: &mut W,
    count: usize,
    row: impl Fn(&mut Vec<u8>, usize) + Sync,
) -> io::Result<()> {
    let text = |first: usize| {
        let mut text = Vec::with_capacity(PIECE * ROW);
        for index in first..(first + PIECE).min(count) {
            row(&mut text, index);
            // In the place of the space behind the last value.
            text.pop();
            text.push(b'\n');
        }
        text
    };
    for first in (0..count).step_by(PIECE * PIECES) {
        let pieces = (first..count.min(first + PIECE * PIECES)).into_par_iter().step_by(PIECE);
        let texts: Vec<Vec<u8>> = pieces.map(text).collect();
        for text in texts {
            output.write_all(&text)?;
        }
    }
    Ok(())
}

/// The text of radius and mass, made once where all bodies have the same.
pub struct Figures(Option<Vec<u8>>);

impl Figures {
    pub fn of<T: Real>(bodies: &Bodies<T>) -> Self {
        let (PerBody::Same(radius), PerBody::Same(mass)) = (&bodies.radius, &bodies.mass) else {
            return Self(None);
        };
        let mut text = Vec::new();
        numbers(&mut text, [*radius, *mass]);
        Self(Some(text))
    }

    /// Adds those of a body.
    pub fn add<T: Real>(&self, row: &mut Vec<u8>, bodies: &Bodies<T>, index: usize) {
        match &self.0 {
            Some(text) => row.extend_from_slice(text),
            None => numbers(row, [bodies.radius.of(index), bodies.mass.of(index)]),
        }
    }
}

/// Adds numbers, each with a space behind it.
pub fn numbers<T: Real>(text: &mut Vec<u8>, values: impl IntoIterator<Item = T>) {
    for value in values {
        push_number(text, value);
        text.push(b' ');
    }
}

/// Adds whole numbers, each with a space behind it.
pub fn whole(text: &mut Vec<u8>, values: impl IntoIterator<Item = i64>) {
    for value in values {
        match u8::try_from(value) {
            Ok(digit @ 0..10) => text.push(b'0' + digit),
            // A buffer in memory takes everything.
            _ => drop(write!(text, "{value}")),
        }
        text.push(b' ');
    }
}
