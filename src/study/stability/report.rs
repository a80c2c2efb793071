//! The report of the stress suite: a table for a terminal, files for programs.

use core::fmt;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::case::{Curve, Findings};
use super::{Case, Figure, Verdict};
use crate::scene::Precision;
use crate::study::StudyError;
use crate::study::file::write_file;

/// What came of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// The name of the case.
    pub case: String,
    /// What it is about.
    pub title: String,
    /// What should hold.
    pub law: String,
    /// What was measured.
    pub figures: Vec<Figure>,
    /// What is drawn.
    pub curves: Vec<Curve>,
}

/// What came of all cases of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Case by case.
    pub cases: Vec<Section>,
}

/// Of the table, letters.
const WIDTH: usize = 100;
const QUANTITY: usize = 39;
const LAW: usize = 18;
const CELL: usize = 20;

impl Section {
    pub(super) fn new(case: &Case, findings: Findings) -> Self {
        Self {
            case: case.name.to_owned(),
            title: case.title.to_owned(),
            law: case.law.to_owned(),
            figures: findings.figures,
            curves: findings.curves,
        }
    }
}

impl Report {
    /// All figures of all cases.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.cases.iter().flat_map(|case| &case.figures)
    }

    /// How many figures have this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.figures().filter(|figure| figure.verdict == verdict).count()
    }

    /// Writes `stability.csv`, `stability.json` and the pictures of the cases
    /// into a folder.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), StudyError> {
        let path = folder.join("stability.json");
        let failed = |source| StudyError::File { path: path.clone(), source };
        let json = serde_json::to_string_pretty(self).map_err(|error| failed(error.into()))?;
        write_file(&path, (json + "\n").as_bytes())?;
        let path = folder.join("stability.csv");
        write_file(
            &path,
            &self.csv().map_err(|source| StudyError::File { path: path.clone(), source })?,
        )?;
        for section in &self.cases {
            let case = super::cases().iter().find(|case| case.name == section.case);
            if let Some((name, picture)) = case.and_then(|case| case.picture) {
                picture(&section.curves).write(folder, name)?;
            }
        }
        Ok(())
    }

    fn csv(&self) -> std::io::Result<Vec<u8>> {
        let mut table = csv::Writer::from_writer(Vec::new());
        table.write_record([
            "case",
            "precision",
            "quantity",
            "law",
            "measured",
            "bound",
            "unit",
            "verdict",
        ])?;
        for section in &self.cases {
            for figure in &section.figures {
                let Figure { precision, quantity, law, measured, bound, unit, verdict } = figure;
                table.serialize((
                    &section.case,
                    precision,
                    quantity,
                    law,
                    measured,
                    bound,
                    unit,
                    verdict,
                ))?;
            }
        }
        table.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for section in &self.cases {
            writeln!(f, "{}: {}", section.case, section.title)?;
            for line in wrapped(&section.law, WIDTH - 2) {
                writeln!(f, "  {line}")?;
            }
            writeln!(
                f,
                "{:QUANTITY$} {:LAW$} {:>CELL$} {:>CELL$}",
                "", "", "f32       ", "f64       "
            )?;
            for (quantity, law, cells) in rows(&section.figures) {
                let mut lines = wrapped(quantity, QUANTITY - 2).into_iter();
                let first = lines.next().unwrap_or_default();
                let [single, double] =
                    cells.map(|cell| cell.map_or(String::new(), Figure::to_string));
                let line = format!(
                    "  {first:width$} {law:LAW$} {single:>CELL$} {double:>CELL$}",
                    width = QUANTITY - 2
                );
                writeln!(f, "{}", line.trim_end())?;
                for line in lines {
                    writeln!(f, "    {line}")?;
                }
            }
            writeln!(f)?;
        }
        let [holds, fails, limits] =
            [Verdict::Holds, Verdict::Deviates, Verdict::Limit].map(|verdict| self.count(verdict));
        writeln!(
            f,
            "{holds} figures hold, {fails} fail, {limits} are beyond the precision (limit: told, not judged)."
        )
    }
}

/// The figures with both precisions in a row, where quantity and law are the
/// same.
fn rows(figures: &[Figure]) -> Vec<(&str, &str, [Option<&Figure>; 2])> {
    let mut rows: Vec<(&str, &str, [Option<&Figure>; 2])> = Vec::new();
    for figure in figures {
        let column = usize::from(figure.precision == Precision::F64);
        let place = rows.iter().position(|(quantity, law, cells)| {
            *quantity == figure.quantity && *law == figure.law && cells[column].is_none()
        });
        match place {
            Some(place) => rows[place].2[column] = Some(figure),
            None => {
                let mut cells = [None; 2];
                cells[column] = Some(figure);
                rows.push((&figure.quantity, &figure.law, cells));
            }
        }
    }
    rows
}

/// A text in lines of at most so many letters.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
