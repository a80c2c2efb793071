//! Table: heights as a CSV file.

use crate::surroundings::mesh::MeshError;

/// The heights of a text, row by row, and how many a row has.
pub(super) fn read(text: &str) -> Result<(usize, Vec<f64>), MeshError> {
    let (mut columns, mut heights) = (0, Vec::new());
    for (line, row) in (1..).zip(text.lines()) {
        if row.trim().is_empty() {
            continue;
        }
        let before = heights.len();
        for (column, word) in (1..).zip(row.split(',').map(str::trim)) {
            match word.parse::<f64>() {
                Ok(height) if height.is_finite() => heights.push(height),
                _ => {
                    let problem =
                        format!("column {column} is {word:?}, where a finite height belongs");
                    return Err(MeshError::at_line(line, problem));
                }
            }
        }
        let found = heights.len() - before;
        if columns == 0 {
            columns = found;
        } else if found != columns {
            let problem = format!("it has {found} heights, and the rows before have {columns}");
            return Err(MeshError::at_line(line, problem));
        }
    }
    Ok((columns, heights))
}
