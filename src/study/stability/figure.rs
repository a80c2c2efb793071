//! Figures: what was measured, what it should be, and what came of it.

use core::fmt;

use serde::{Deserialize, Serialize};

use crate::engine::EngineError;
use crate::scene::Precision;

/// What came of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The figure is what the law says.
    Holds,
    /// It is not.
    Deviates,
    /// The precision has too few digits for it, as theory says: shown, not judged.
    Limit,
    /// Of another method, to compare with: shown, not judged.
    Compared,
}

/// A figure in one precision, and its law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Of what it was measured.
    pub precision: Precision,
    /// What was measured.
    pub quantity: String,
    /// What it should be, in a few letters.
    pub law: String,
    /// What it is; `None` if that is no number.
    pub measured: Option<f64>,
    /// The greatest measured value, or the greatest difference from the expected
    /// one, that the law allows.
    pub bound: Option<f64>,
    /// Of the three above; empty for a count or a ratio.
    pub unit: String,
    /// What came of the law.
    pub verdict: Verdict,
}

impl Figure {
    /// A figure that is `bound` or less, in either direction.
    ///
    /// ```
    /// use carom::scene::Precision::F32;
    /// use carom::study::stability::{Figure, Verdict};
    /// assert_eq!(Figure::at_most(F32, "energy", -3.0, 4.0, "ε").verdict, Verdict::Holds);
    /// assert_eq!(Figure::at_most(F32, "energy", f64::NAN, 4.0, "ε").verdict, Verdict::Deviates);
    /// ```
    #[must_use]
    pub fn at_most(
        precision: Precision,
        quantity: impl Into<String>,
        measured: f64,
        bound: f64,
        unit: &str,
    ) -> Self {
        let law = format!("≤ {}", with_unit(bound, unit));
        Self::new(precision, quantity.into(), law, [measured, 0.0, bound], unit)
    }

    /// A figure that is exactly this one.
    #[must_use]
    pub fn equal(
        precision: Precision,
        quantity: impl Into<String>,
        measured: f64,
        exact: f64,
        unit: &str,
    ) -> Self {
        let law = format!("= {}", with_unit(exact, unit));
        Self::new(precision, quantity.into(), law, [measured, exact, 0.0], unit)
    }

    /// A figure that differs from the expected one by no more than a tolerance.
    #[must_use]
    pub fn near(
        precision: Precision,
        quantity: impl Into<String>,
        measured: f64,
        expected: f64,
        tolerance: f64,
        unit: &str,
    ) -> Self {
        let law = format!("{} ± {}", number(expected), with_unit(tolerance, unit));
        Self::new(precision, quantity.into(), law, [measured, expected, tolerance], unit)
    }

    /// Where an engine gave up instead.
    #[must_use]
    pub fn not_run(precision: Precision, quantity: &str, error: &EngineError) -> Self {
        Self {
            precision,
            quantity: format!("{quantity}: {error}"),
            law: "runs to its end".to_owned(),
            measured: None,
            bound: None,
            unit: String::new(),
            verdict: Verdict::Deviates,
        }
    }

    fn new(
        precision: Precision,
        quantity: String,
        law: String,
        [measured, expected, tolerance]: [f64; 3],
        unit: &str,
    ) -> Self {
        // No number is near to anything.
        let holds = (measured - expected).abs() <= tolerance;
        Self {
            precision,
            quantity,
            law,
            measured: measured.is_finite().then_some(measured),
            bound: tolerance.is_finite().then_some(tolerance),
            unit: unit.to_owned(),
            verdict: if holds { Verdict::Holds } else { Verdict::Deviates },
        }
    }

    /// The same with the law in other words.
    #[must_use]
    pub fn with_law(self, law: &str) -> Self {
        Self { law: law.to_owned(), ..self }
    }

    /// The same, not judged, as theory says that the precision cannot do it.
    #[must_use]
    pub fn beyond_precision(self) -> Self {
        Self { verdict: Verdict::Limit, ..self }
    }

    /// [`beyond_precision`](Self::beyond_precision) if that is so.
    #[must_use]
    pub fn beyond_precision_if(self, is_beyond: bool) -> Self {
        if is_beyond { self.beyond_precision() } else { self }
    }

    /// The same of a method that carom does not use: not judged.
    #[must_use]
    pub fn compared(self) -> Self {
        Self { law: "other method".to_owned(), bound: None, verdict: Verdict::Compared, ..self }
    }
}

/// The figure and what came of its law.
impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let measured = match self.measured {
            Some(value) => with_unit(value, &self.unit),
            None => "no number".to_owned(),
        };
        f.pad(&match self.verdict {
            Verdict::Holds => format!("{measured}  holds"),
            Verdict::Deviates => format!("{measured}  FAILS"),
            Verdict::Limit => format!("{measured}  limit"),
            Verdict::Compared => format!("{measured}       "),
        })
    }
}

fn with_unit(value: f64, unit: &str) -> String {
    if unit.is_empty() { number(value) } else { format!("{} {unit}", number(value)) }
}

/// A number in few letters, a count with all of its digits.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if value.fract() == 0.0 && size < 1e10 => format!("{value:.0}"),
        _ if !(1e-3..1e4).contains(&size) => format!("{value:.2e}"),
        _ if size >= 100.0 => format!("{value:.0}"),
        _ if size >= 10.0 => format!("{value:.1}"),
        _ if size >= 0.1 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}
