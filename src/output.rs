//! Output: what a run leaves behind.
//!
//! Events and states go to files ([`OutputFile`]) as comma-separated values
//! with all their digits; the [`Summary`] is printed for a person or as JSON.

mod events;
mod file;
mod report;
mod state;
mod summary;
pub(crate) mod table;

pub use events::{EVENT_COLUMNS, EventWriter};
pub use file::{Destination, OutputError, OutputFile};
pub use state::{STATE_COLUMNS, write_state};
pub use summary::{
    AngularMomentumSummary, EnergyParts, EnergySummary, MomentumSummary, Setup, Summary, Work,
    shortest,
};

use core::fmt::{self, Write as _};
use std::io;

use crate::real::Real;

/// A row of comma-separated values under way: numbers become the shortest
/// digits that read back as the same bits.
#[derive(Debug, Default)]
struct Row {
    fields: csv::ByteRecord,
    digits: String,
}

impl Row {
    /// Adds numbers, one field each.
    fn numbers<T: Real>(&mut self, values: impl IntoIterator<Item = T>) {
        for value in values {
            // A fraction of the time of the standard library's formatting, which
            // is what a state file of many bodies is made of.
            let mut digits = ryu::Buffer::new();
            match T::NAME {
                "f32" => self.fields.push_field(digits.format(value.to_f64() as f32).as_bytes()),
                "f64" => self.fields.push_field(digits.format(value.to_f64()).as_bytes()),
                _ => self.shown(value),
            }
        }
    }

    /// Adds anything that shows itself without a comma.
    fn shown(&mut self, value: impl fmt::Display) {
        self.digits.clear();
        let _ = write!(self.digits, "{value}");
        self.fields.push_field(self.digits.as_bytes());
    }

    /// Adds empty fields.
    fn empty(&mut self, count: usize) {
        for _ in 0..count {
            self.fields.push_field(b"");
        }
    }

    /// Writes the row and starts the next one.
    fn finish<W: io::Write>(&mut self, writer: &mut csv::Writer<W>) -> io::Result<()> {
        writer.write_byte_record(&self.fields).map_err(as_io)?;
        self.fields.clear();
        Ok(())
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
