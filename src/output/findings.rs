//! Findings of an analysis, as comma-separated values.

use std::io;

use super::{CsvLine, as_io, csv_writer};
use crate::observe::Findings;

/// Writes the columns of findings under their names, with all digits; a figure that means
/// nothing leaves its field empty.
///
/// ```
/// use carom::Bodies;
/// use carom::observe::{Analysis, Moment};
/// use carom::output::write_findings;
/// use carom::scene::{AnalysisKind, AnalysisSettings};
///
/// let bodies = Bodies::from_positions(&[[0.0; 3], [3.0, 0.0, 0.0]])
///     .velocities(&[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
///     .radius(0.5)
///     .build()?;
/// let moment = Moment { time: 0.0, bodies: &bodies, space: None, images: None };
/// let settings = AnalysisSettings::of(AnalysisKind::VelocityAutocorrelation);
/// let mut analysis = Analysis::new(&settings, &moment)?;
/// analysis.look(&moment);
/// let mut text = Vec::new();
/// write_findings(&mut text, &analysis.findings())?;
/// assert_eq!(String::from_utf8(text)?, "time,correlation,error,diffusion\n0.0,1.0,,0.0\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the output takes no more.
pub fn write_findings<W: io::Write>(output: W, findings: &Findings) -> io::Result<W> {
    let mut writer = csv_writer(output);
    let columns = &findings.columns;
    writer.write_record(columns.iter().map(|(name, _)| *name)).map_err(as_io)?;
    let mut line = CsvLine::default();
    for row in 0..columns.first().map_or(0, |(_, column)| column.len()) {
        for (_, column) in columns {
            match column[row].filter(|value| value.is_finite()) {
                Some(value) => line.numbers([value]),
                None => line.empty(1),
            }
        }
        line.finish(&mut writer)?;
    }
    writer.into_inner().map_err(csv::IntoInnerError::into_error)
}
