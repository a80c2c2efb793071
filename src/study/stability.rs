//! Stability: the stress suite. Each case has a law that should hold, by a known
//! solution or by theory, and is measured and judged in both precisions.
//!
//! ```no_run
//! use carom::study::{Journal, stability};
//!
//! let cases: Vec<&stability::Case> = stability::cases().iter().collect();
//! let report = stability::study(&cases, stability::Extent::Quick, &Journal::unwritten(), &())?;
//! println!("{report}");
//! # Ok::<(), carom::study::StudyError>(())
//! ```

mod case;
mod figure;
mod report;

mod cradle;
mod crystal;
mod drift;
mod far;
mod galperin;
mod gas;
mod grazing;
mod masses;
mod orientation;
mod pair;
mod radii;
mod reversal;
mod rotation;
mod speeds;
mod superball;
mod wedge;

use serde::Serialize;

use super::{Journal, Machine, Order, Point, StudyError, Watch, chart};

pub use case::{Case, Curve, Extent, Findings};
pub use figure::{Figure, Verdict};
pub use report::{Section, StabilityReport};

/// All cases.
#[must_use]
pub fn cases() -> &'static [Case] {
    const CASES: &[Case] = &[
        drift::CASE,
        rotation::CASE,
        masses::CASE,
        radii::CASE,
        speeds::CASE,
        far::CASE,
        grazing::CASE,
        galperin::CASE,
        wedge::CASE,
        crystal::CASE,
        cradle::CASE,
        superball::CASE,
        reversal::CASE,
    ];
    CASES
}

/// The case of that name, if there is one.
#[must_use]
pub fn case(name: &str) -> Option<&'static Case> {
    cases().iter().find(|case| case.name == name)
}

/// All that the results depend on: what their journal is opened with.
#[must_use]
pub fn heading(extent: Extent) -> impl Serialize {
    ("stability", extent)
}

/// Measures some cases, several points at once.
///
/// The journal is to be opened for [`heading`] of the extent; a case that is studied with
/// others has the same points as by itself.
///
/// # Errors
/// If a scene has a mistake, or the journal cannot be written. An engine that
/// gives up is a figure that deviates.
pub fn study(
    cases: &[&Case],
    extent: Extent,
    journal: &Journal,
    watch: &dyn Watch,
) -> Result<StabilityReport, StudyError> {
    let mut points = Vec::new();
    let mut counts = Vec::new();
    for case in cases {
        let trials = (case.trials)(extent);
        counts.push(trials.len());
        points.extend(trials.into_iter().map(|mut point| {
            point.key = format!("{}: {}", case.name, point.key);
            point
        }));
    }
    let mut findings = Point::all(&points, journal, Order::AtOnce, watch)?.into_iter();
    let sections = cases.iter().zip(counts).map(|(case, count)| {
        Section::new(case, (case.combine)(findings.by_ref().take(count).collect()))
    });
    Ok(StabilityReport { machine: Machine::here(), extent, cases: sections.collect() })
}
