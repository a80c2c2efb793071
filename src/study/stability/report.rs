//! The report of the stress suite: a table for a terminal, files for programs.

use core::fmt;

use serde::{Deserialize, Serialize};

use super::case::{Curve, Findings};
use super::{Case, Extent, Figure, Verdict};
use crate::numbers::array::Each;
use crate::scene::Precision;
use crate::study::chart::Picture;
use crate::study::table::wrapped;
use crate::study::{Machine, Report};

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
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StabilityReport {
    /// On what.
    pub machine: Machine,
    /// How long the runs are.
    pub extent: Extent,
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

impl StabilityReport {
    /// All figures of all cases.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.cases.iter().flat_map(|case| &case.figures)
    }

    /// How many figures have this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.figures().filter(|figure| figure.verdict == verdict).count()
    }
}

impl Report for StabilityReport {
    const NAME: &'static str = "stability";
    type Row<'a> = FigureRecord<'a>;

    fn rows(&self) -> Vec<FigureRecord<'_>> {
        let sections = self.cases.iter().flat_map(|section| {
            section.figures.iter().map(|figure| FigureRecord::of(&section.case, figure))
        });
        sections.collect()
    }

    /// Those of the cases.
    fn pictures(&self) -> Vec<(&'static str, Picture)> {
        let of = |section: &Section| {
            let (name, picture) = super::case(&section.case)?.picture?;
            Some((name, picture(&section.curves)))
        };
        self.cases.iter().filter_map(of).collect()
    }
}

/// A row of the table of comma-separated values.
#[derive(Debug, Serialize)]
pub struct FigureRecord<'a> {
    case: &'a str,
    precision: Precision,
    quantity: &'a str,
    law: &'a str,
    measured: Option<f64>,
    bound: Option<f64>,
    unit: &'a str,
    verdict: Verdict,
}

impl<'a> FigureRecord<'a> {
    fn of(case: &'a str, figure: &'a Figure) -> Self {
        let Figure { precision, quantity, law, measured, bound, unit, verdict } = figure;
        Self {
            case,
            precision: *precision,
            quantity,
            law,
            measured: *measured,
            bound: *bound,
            unit,
            verdict: *verdict,
        }
    }
}

impl fmt::Display for StabilityReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}\n", self.machine)?;
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
                    cells.each(|cell| cell.map_or(String::new(), Figure::to_string));
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
            [Verdict::Holds, Verdict::Deviates, Verdict::Limit].each(|verdict| self.count(verdict));
        writeln!(
            f,
            "{holds} figures hold, {fails} fail, {limits} are beyond the precision (limit: reported, not judged)."
        )
    }
}

/// The figures with both precisions in a row, where quantity and law are the
/// same.
fn rows(figures: &[Figure]) -> Vec<(&str, &str, [Option<&Figure>; 2])> {
    let mut rows: Vec<(&str, &str, [Option<&Figure>; 2])> = Vec::new();
    for figure in figures {
        let column = usize::from(figure.precision == Precision::F64);
        let known = rows.iter().position(|(quantity, law, cells)| {
            *quantity == figure.quantity && *law == figure.law && cells[column].is_none()
        });
        match known {
            Some(known) => rows[known].2[column] = Some(figure),
            None => {
                let mut cells = [None; 2];
                cells[column] = Some(figure);
                rows.push((&figure.quantity, &figure.law, cells));
            }
        }
    }
    rows
}
