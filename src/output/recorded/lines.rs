//! Lines of a text, with their numbers.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::str::FromStr;

use super::{FramePlace, Wrong};

/// The most bytes that a line of frames has.
const LONGEST: u64 = 1 << 20;

/// A text under way.
#[derive(Debug)]
pub struct Lines {
    reader: BufReader<File>,
    text: Vec<u8>,
    line: u64,
}

impl Lines {
    pub fn open(path: &Path) -> Result<Self, Wrong> {
        let file = File::open(path).map_err(|error| Wrong::unreadable(FramePlace::File, &error))?;
        let reader = BufReader::with_capacity(1 << 18, file);
        Ok(Self { reader, text: Vec::new(), line: 0 })
    }

    /// Where the last line is.
    pub fn place(&self) -> FramePlace {
        FramePlace::Line(self.line)
    }

    /// Something is wrong with the last line.
    pub fn wrong(&self, problem: impl Into<String>) -> Wrong {
        Wrong::new(self.place(), problem)
    }

    /// The next line, without its end; `None` behind the last one.
    pub fn next(&mut self) -> Result<Option<&str>, Wrong> {
        self.text.clear();
        self.line += 1;
        let mut limited = self.reader.by_ref().take(LONGEST);
        let read = limited.read_until(b'\n', &mut self.text);
        let place = FramePlace::Line(self.line);
        let count = read.map_err(|error| Wrong::unreadable(place, &error))?;
        if count == 0 {
            return Ok(None);
        }
        if count as u64 == LONGEST {
            return Err(Wrong::new(place, "is too long for a line of frames"));
        }
        let text = str::from_utf8(&self.text).map_err(|_| Wrong::new(place, "is not text"))?;
        Ok(Some(text.trim_end()))
    }

    /// The next line of a frame that has begun.
    pub fn within(&mut self) -> Result<&str, Wrong> {
        let line = self.line + 1;
        self.next()?.ok_or_else(|| {
            Wrong::new(FramePlace::Line(line), "the file ends in the middle of a frame")
        })
    }
}

/// A number of some kind.
pub fn number<N: FromStr>(text: &str, wanted: &str) -> Result<N, String> {
    text.trim().parse().map_err(|_| {
        let cut: String = text.chars().take(40).collect();
        format!("{cut:?} stands where {wanted} is to be")
    })
}

/// A finite number.
pub fn finite(text: &str) -> Result<f64, String> {
    let value: f64 = number(text, "a number")?;
    if value.is_finite() { Ok(value) } else { Err(format!("{text} is no finite number")) }
}
