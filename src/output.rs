//! Output: what happens in a run, as files.
//!
//! Events, states and time series become comma-separated values with all their digits, on
//! anything that implements [`io::Write`]. With the feature `study` there are frames of a
//! trajectory in the formats of other programs ([`FrameWriter`]), and a [`WholeFile`] to
//! write into, which has its name only once it is whole.

#[cfg(feature = "study")]
mod arrays;
mod events;
mod findings;
#[cfg(feature = "study")]
mod frames;
#[cfg(feature = "study")]
mod npz;
#[cfg(feature = "study")]
mod parquet;
#[cfg(feature = "study")]
mod recorded;
mod sealed;
mod series;
mod state;
#[cfg(feature = "study")]
mod whole_file;

#[cfg(feature = "study")]
pub use arrays::{Array, write_arrays, write_table};
#[cfg(feature = "study")]
pub use events::EventArrays;
pub use events::{EVENT_COLUMNS, EventFilter, EventWriter};
pub use findings::write_findings;
#[cfg(feature = "study")]
pub use frames::{Frame, FrameFormat, FrameWriter, quaternion_of};
#[cfg(feature = "study")]
pub use recorded::{FrameError, FramePlace, FrameReader, RecordedFrame};
pub use sealed::{Unsealed, sealed, unsealed};
pub use series::{SeriesColumn, SeriesWriter};
pub use state::{STATE_COLUMNS, write_state};
#[cfg(feature = "study")]
pub(crate) use whole_file::Listed;
#[cfg(feature = "study")]
pub use whole_file::{WholeFile, abandon_unfinished, write_whole};

use core::fmt;
use std::io::{self, Write as _};

use crate::real::Real;

/// A line of comma-separated values under way: numbers become the shortest
/// digits that read back as the same bits.
#[derive(Debug, Default)]
struct CsvLine {
    fields: csv::ByteRecord,
    digits: Vec<u8>,
}

impl CsvLine {
    /// Adds numbers, one field each.
    fn numbers<T: Real>(&mut self, values: impl IntoIterator<Item = T>) {
        for value in values {
            self.digits.clear();
            push_number(&mut self.digits, value);
            self.fields.push_field(&self.digits);
        }
    }

    /// Adds anything that shows itself without a comma.
    fn shown(&mut self, value: impl fmt::Display) {
        self.digits.clear();
        let _ = write!(self.digits, "{value}");
        self.fields.push_field(&self.digits);
    }

    /// Adds empty fields.
    fn empty(&mut self, count: usize) {
        for _ in 0..count {
            self.fields.push_field(b"");
        }
    }

    /// Writes the line and starts the next one.
    fn finish<W: io::Write>(&mut self, writer: &mut csv::Writer<W>) -> io::Result<()> {
        writer.write_byte_record(&self.fields).map_err(as_io)?;
        self.fields.clear();
        Ok(())
    }
}

/// Adds the shortest digits that read back as the same bits.
fn push_number<T: Real>(text: &mut Vec<u8>, value: T) {
    // Formatting takes most of the time of a file of numbers, and `ryu` is several
    // times as fast as the standard library.
    let mut digits = ryu::Buffer::new();
    // Half of the numbers in a frame are these; the other zero is not equal in its sign.
    if value == T::ONE {
        return text.extend_from_slice(b"1.0");
    }
    if value == T::ZERO && !value.to_f64().is_sign_negative() {
        return text.extend_from_slice(b"0.0");
    }
    match T::NAME {
        "f32" => text.extend_from_slice(digits.format(value.to_f64() as f32).as_bytes()),
        "f64" => text.extend_from_slice(digits.format(value.to_f64()).as_bytes()),
        // A buffer in memory takes everything.
        _ => drop(write!(text, "{value}")),
    }
}

/// Whether numbers are stored as `f32`, and not as `f64`.
///
/// # Errors
/// In a precision that files of bytes have no type for.
#[cfg(feature = "study")]
fn is_single<T: Real>() -> io::Result<bool> {
    match T::NAME {
        "f32" => Ok(true),
        "f64" => Ok(false),
        other => {
            let problem = format!("arrays, .vtp and .parquet have no type for {other}; text has");
            Err(io::Error::new(io::ErrorKind::InvalidInput, problem))
        }
    }
}

/// A writer of comma-separated values that hands on large pieces.
fn csv_writer<W: io::Write>(output: W) -> csv::Writer<W> {
    csv::WriterBuilder::new().buffer_capacity(1 << 18).from_writer(output)
}

/// The error of the output itself, so that its kind can be asked for. Writing
/// rows of one length fails for no other reason.
fn as_io(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        kind => io::Error::other(format!("{kind:?}")),
    }
}
