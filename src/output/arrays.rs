//! Arrays: columns of a table as arrays of NumPy, or as a table of Parquet.

use std::io::{self, Write};

use super::npz::{Archive, store_array};
use super::parquet::{Column, GROUP, Table, Values};

/// A column of a table; rows may have nothing in it.
#[derive(Clone, Debug, PartialEq)]
pub enum Array {
    /// Whole numbers of 64 bits.
    Whole(Vec<Option<u64>>),
    /// Numbers in double precision.
    Numbers(Vec<Option<f64>>),
    /// Texts.
    Texts(Vec<Option<String>>),
}

/// Writes columns as a `.npz` archive of one array each, as `numpy.load` reads it. Where a row
/// has nothing, the array has 0, `nan` or an empty text.
///
/// ```
/// use carom::output::{Array, write_arrays};
///
/// let columns = [("seed".to_owned(), Array::Whole(vec![Some(1), None]))];
/// let bytes = write_arrays(Vec::new(), &columns)?;
/// assert!(bytes.starts_with(b"PK\x03\x04"));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// If the output takes no more.
pub fn write_arrays<W: Write>(output: W, columns: &[(String, Array)]) -> io::Result<W> {
    let mut archive = Archive::new(output);
    for (name, array) in columns {
        let (kind, len, bytes) = match array {
            Array::Whole(values) => {
                let bytes = values.iter().flat_map(|value| value.unwrap_or(0).to_le_bytes());
                ("<u8".to_owned(), values.len(), bytes.collect())
            }
            Array::Numbers(values) => {
                let bytes = values.iter().flat_map(|value| value.unwrap_or(f64::NAN).to_le_bytes());
                ("<f8".to_owned(), values.len(), bytes.collect())
            }
            Array::Texts(texts) => {
                let longest = texts.iter().flatten().map(|text| text.chars().count()).max();
                // NumPy has no texts of length 0.
                let longest = longest.unwrap_or(0).max(1);
                (format!("<U{longest}"), texts.len(), wide(texts, longest))
            }
        };
        let bytes: Vec<u8> = bytes;
        store_array(name, &bytes, &kind, &format!("({len},)"), &mut archive)?;
    }
    archive.finish()
}

/// Texts of one length, four bytes a character, filled up with zeros.
fn wide(texts: &[Option<String>], length: usize) -> Vec<u8> {
    let characters = texts.iter().flat_map(|text| {
        let end = core::iter::repeat(0);
        text.iter().flat_map(|text| text.chars()).map(u32::from).chain(end).take(length)
    });
    characters.flat_map(u32::to_le_bytes).collect()
}

/// Writes columns as a table of Parquet; where a row has nothing, so has the table.
///
/// ```
/// use carom::output::{Array, write_table};
///
/// let columns = [("seed".to_owned(), Array::Whole(vec![Some(1), None]))];
/// let bytes = write_table(Vec::new(), &columns)?;
/// assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// If the output takes no more.
pub fn write_table<W: Write>(output: W, columns: &[(String, Array)]) -> io::Result<W> {
    let rows = columns.iter().map(|(_, array)| array.len()).max().unwrap_or(0);
    let mut table = Table::new(output);
    // Without a row there is a group too, of which nothing but the columns is kept.
    for start in (0..rows.max(1)).step_by(GROUP) {
        let some = start..rows.min(start + GROUP);
        let columns = columns.iter().map(|(name, array)| match array {
            Array::Whole(values) => {
                Column::of(name, &values[some.clone()], Values::Unsigned, |it| *it as i64)
            }
            Array::Numbers(values) => {
                Column::of(name, &values[some.clone()], Values::Double, |it| *it)
            }
            Array::Texts(values) => {
                Column::of(name, &values[some.clone()], Values::Text, |it| it.as_str().into())
            }
        });
        table.add(&columns.collect::<Vec<_>>())?;
    }
    table.finish()
}

impl Array {
    fn len(&self) -> usize {
        match self {
            Self::Whole(values) => values.len(),
            Self::Numbers(values) => values.len(),
            Self::Texts(values) => values.len(),
        }
    }
}
