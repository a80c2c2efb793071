//! Stability: the stress suite. Each case has a law that should hold, by a known
//! solution or by theory, and is measured and judged in both precisions.
//!
//! ```no_run
//! use carom::study::stability::{Extent, Stability, cases};
//! use carom::study::{Journal, Study};
//!
//! let study = Stability::new(cases().iter().collect(), Extent::Quick);
//! let report = study.measure(&Journal::unwritten(), &())?;
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

use super::{Journal, Machine, Order, Point, Study, StudyError, Watch, chart};

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

/// The study: some cases, measured several points at once.
pub struct Stability {
    cases: Vec<&'static Case>,
    extent: Extent,
}

impl Stability {
    /// Of some cases. One that is studied with others has the same points as by itself.
    #[must_use]
    pub fn new(cases: Vec<&'static Case>, extent: Extent) -> Self {
        Self { cases, extent }
    }
}

impl Study for Stability {
    const NAME: &'static str = "stability";
    const ORDER: Order = Order::AtOnce;
    type Outcome = Findings;
    type Report = StabilityReport;

    fn settings(&self) -> impl Serialize {
        self.extent
    }

    fn points(&self, _: &Journal, _: &dyn Watch) -> Result<Vec<Point<'_, Findings>>, StudyError> {
        let of = |case: &&Case| {
            let trials = (case.trials)(self.extent).into_iter();
            let name = case.name;
            trials.map(move |trial| trial.of(name))
        };
        Ok(self.cases.iter().flat_map(of).collect())
    }

    /// An engine that gives up is a figure that deviates.
    fn report(
        &self,
        findings: Vec<Findings>,
        _: Option<f64>,
    ) -> Result<StabilityReport, StudyError> {
        let mut findings = findings.into_iter();
        let sections = self.cases.iter().map(|case| {
            let trials = (case.trials)(self.extent).len();
            Section::new(case, (case.combine)(findings.by_ref().take(trials).collect()))
        });
        let cases = sections.collect();
        Ok(StabilityReport { machine: Machine::here(), extent: self.extent, cases })
    }
}
