//! The files of a study.

use std::io::Write;
use std::path::Path;

use super::StudyError;
use crate::output::OutputFile;

/// Writes a whole file, which has its name only once it is whole.
pub(super) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    let mut file = OutputFile::open(path)?;
    file.write_all(bytes).map_err(|error| file.error(error))?;
    Ok(file.finish()?)
}
