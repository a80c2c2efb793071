//! Arrays: columns of a table as arrays of NumPy.

use std::io::{self, Write};

use super::npz::{Archive, store_array};

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Array {
    /// Whole numbers of 64 bits.
    Whole(Vec<u64>),
    /// Numbers in double precision.
    Numbers(Vec<f64>),
    /// Texts.
    Texts(Vec<String>),
}

/// Writes columns as a `.npz` archive of one array each, as `numpy.load` reads it.
///
/// ```
/// use carom::output::{Array, write_arrays};
///
/// let columns = [("seed".to_owned(), Array::Whole(vec![1, 2]))];
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
                let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
                ("<u8".to_owned(), values.len(), bytes)
            }
            Array::Numbers(values) => {
                let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
                ("<f8".to_owned(), values.len(), bytes)
            }
            Array::Texts(texts) => {
                let longest = texts.iter().map(|text| text.chars().count()).max();
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
fn wide(texts: &[String], length: usize) -> Vec<u8> {
    let characters = texts.iter().flat_map(|text| {
        let end = core::iter::repeat(0);
        text.chars().map(u32::from).chain(end).take(length)
    });
    characters.flat_map(u32::to_le_bytes).collect()
}
