//! Output: what a run leaves behind.
//!
//! Events and states go to files ([`OutputFile`]) as comma-separated values
//! with all their digits; the [`Summary`] is printed for a person or as JSON.

mod events;
mod file;
mod report;
mod state;
mod summary;
mod table;

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
            self.digits.clear();
            // `Debug` of a float is its shortest form, with an exponent where
            // `Display` would write hundreds of zeros. A `String` takes it all.
            let _ = write!(self.digits, "{value:?}");
            self.fields.push_field(self.digits.as_bytes());
        }
    }

    /// Adds a whole number.
    fn whole(&mut self, value: impl fmt::Display) {
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

/// Writing rows of one length fails for no other reason than its output.
fn as_io(error: csv::Error) -> io::Error {
    error.into()
}
