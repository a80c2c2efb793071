//! What a case of the stress suite is made of.

use serde::{Deserialize, Serialize};

use super::Figure;
use super::chart::Picture;
use crate::engine::Compiled;
use crate::lane::Lane;
use crate::numbers::array::Each;
use crate::real::{DoubleDouble, Real};
use crate::scene::Precision;
use crate::study::{Point, StudyError};
use crate::vec3::Vec3;

/// How long runs are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extent {
    /// What the laws ask for: about ten minutes on two cores.
    Full,
    /// About a hundredth of it, to see that everything works.
    Quick,
}

impl Extent {
    /// One of two figures.
    pub(super) fn of<N>(self, full: N, quick: N) -> N {
        match self {
            Self::Full => full,
            Self::Quick => quick,
        }
    }
}

/// Points of a curve in a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Of what it was measured.
    pub precision: Precision,
    /// What it is of.
    pub name: String,
    /// From left to right.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// A curve of numbers. What is no number becomes the greatest one: it does
    /// not hold, and a file can keep it.
    pub(super) fn new(precision: Precision, name: String, points: Vec<(f64, f64)>) -> Self {
        let number = |value: f64| if value.is_finite() { value } else { f64::MAX };
        let points = points.into_iter().map(|(x, y)| (x, number(y))).collect();
        Self { precision, name, points }
    }
}

/// A figure of the values that several runs have at each point.
pub(super) fn at_points(runs: &[&Curve], figure: impl Fn(&[f64]) -> f64) -> Vec<(f64, f64)> {
    let Some(first) = runs.first() else { return Vec::new() };
    let at = |(point, &(n, _)): (usize, &(f64, f64))| {
        let values: Vec<f64> =
            runs.iter().filter_map(|run| run.points.get(point)).map(|(_, value)| *value).collect();
        (n, figure(&values))
    };
    first.points.iter().enumerate().map(at).collect()
}

/// What a trial found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// What was measured and judged.
    pub figures: Vec<Figure>,
    /// What is drawn, or judged together with that of other trials.
    pub curves: Vec<Curve>,
}

impl Findings {
    /// All of several.
    pub(super) fn joined(all: Vec<Self>) -> Self {
        let mut joined = Self::default();
        for findings in all {
            joined.figures.extend(findings.figures);
            joined.curves.extend(findings.curves);
        }
        joined
    }
}

impl From<Vec<Figure>> for Findings {
    fn from(figures: Vec<Figure>) -> Self {
        Self { figures, curves: Vec::new() }
    }
}

impl From<Vec<Curve>> for Findings {
    fn from(curves: Vec<Curve>) -> Self {
        Self { figures: Vec::new(), curves }
    }
}

/// A piece of a case, with a result of its own.
pub(super) type Trial = Point<'static, Findings>;

/// The name of a picture, and how it is drawn.
pub(super) type Drawn = (&'static str, fn(&[Curve]) -> Picture);

/// A known solution or a law, and how carom is held to it.
pub struct Case {
    /// What the command line calls it.
    pub name: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// What should hold, and its source.
    pub law: &'static str,
    pub(super) trials: fn(Extent) -> Vec<Trial>,
    /// What becomes of the findings of all trials.
    pub(super) combine: fn(Vec<Findings>) -> Findings,
    /// What shows it.
    pub(super) picture: Option<Drawn>,
}

/// A precision that is studied, with a better one to judge it by.
pub(super) trait Studied: Compiled {
    /// Its name.
    const PRECISION: Precision;
    /// A precision with twice the digits.
    type Judge: Real;
}

impl Studied for f32 {
    const PRECISION: Precision = Precision::F32;
    type Judge = f64;
}

impl Studied for f64 {
    const PRECISION: Precision = Precision::F64;
    type Judge = DoubleDouble;
}

/// A vector in the studied precision.
pub(super) fn t3<T: Real>(vector: [f64; 3]) -> [T; 3] {
    vector.each(T::from_f64)
}

/// In ε of the precision.
pub(super) fn in_epsilon<T: Real>(error: f64) -> f64 {
    error / T::EPSILON.to_f64()
}

/// The greatest; NaN if there is one.
pub(super) fn greatest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| if value <= most { most } else { value })
}

/// A trial in one precision. An engine that gives up fails the law; it does not
/// end the study.
pub(super) fn trial<T: Studied, F: Into<Findings>>(
    key: impl Into<String>,
    seconds: f64,
    measure: impl Fn() -> Result<F, StudyError> + Send + Sync + 'static,
) -> Trial {
    let name = key.into();
    Point::new(format!("{name} {}", T::NAME), seconds, move || match measure() {
        Ok(findings) => Ok(findings.into()),
        Err(StudyError::Engine(error)) => {
            Ok(vec![Figure::not_run(T::PRECISION, &name, &error)].into())
        }
        Err(error) => Err(error),
    })
}

/// Pseudo-random numbers, the same on every machine: SplitMix64 (Steele, Lea and
/// Flood 2014).
pub(super) struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [-1, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() as i64 >> 10) as f64 / (1_u64 << 53) as f64
    }

    /// A direction.
    pub fn direction(&mut self) -> Vec3<f64> {
        loop {
            let vector = Vec3::new(self.unit(), self.unit(), self.unit());
            let square = vector.length_squared();
            if (0.01..=1.0).contains(&square) {
                return vector * (1.0 / square.sqrt());
            }
        }
    }
}

/// The same number in every precision is a ratio of whole numbers.
pub(super) fn ratio<T: Studied>(numerator: i32, denominator: i32) -> T::Judge {
    <T::Judge as Lane>::ratio(numerator, denominator)
}
