//! Axis: what a direction of a chart shows, and the round numbers on it.

use core::ops::Range;

use plotters::coord::ranged1d::{NoDefaultFormatting, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// How far a scale goes, and how it is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal ways are equal differences.
    #[default]
    Linear,
    /// Equal ways are equal ratios; what is not positive is not drawn.
    Logarithmic,
}

/// One of the two directions of a chart.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// How it is divided.
    pub scale: Scale,
}

impl Axis {
    /// What the axis shows.
    #[must_use]
    pub fn new(label: &str, scale: Scale) -> Self {
        Self { label: label.to_owned(), scale }
    }

    /// Where a value is: the axis itself is linear in it.
    pub(super) fn coordinate(&self, value: f64) -> Option<f64> {
        let coordinate = match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic if value > 0.0 => value.log10(),
            Scale::Logarithmic => return None,
        };
        coordinate.is_finite().then_some(coordinate)
    }

    /// From where to where the values reach, with a margin.
    fn range(&self, values: impl Iterator<Item = f64>) -> Range<f64> {
        let (least, greatest) = values
            .filter_map(|value| self.coordinate(value))
            .fold((f64::MAX, f64::MIN), |(least, greatest), v| (least.min(v), greatest.max(v)));
        if least > greatest {
            return 0.0..1.0;
        }
        let margin = match greatest - least {
            0.0 => 0.5,
            span => span * 0.04,
        };
        least - margin..greatest + margin
    }
}

/// A range of an axis with round numbers on it.
pub(super) struct Divided {
    range: RangedCoordf64,
    span: Range<f64>,
    scale: Scale,
}

impl Divided {
    /// An axis for these values.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let span = axis.range(values);
        Self { range: span.clone().into(), span, scale: axis.scale }
    }
}

impl Ranged for Divided {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<H: plotters::coord::ranged1d::KeyPointHint>(&self, hint: H) -> Vec<f64> {
        let decades = self.span.end - self.span.start;
        if self.scale == Scale::Linear {
            return self.range.key_points(hint);
        }
        // Powers of ten; between them others where there are few.
        let every = (decades / 8.0).ceil().max(1.0);
        let parts: &[f64] = match decades {
            d if d < 0.3 => &[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0],
            d if d < 1.0 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
            d if d < 3.0 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let first = (self.span.start / every).floor() * every;
        let powers = (0..).map(|k| first + every * f64::from(k)).take_while(|p| *p < self.span.end);
        let points = powers.flat_map(|power| parts.iter().map(move |part| power + part.log10()));
        points.filter(|point| self.span.contains(point)).collect()
    }

    fn range(&self) -> Range<f64> {
        self.span.clone()
    }
}

impl ValueFormatter<f64> for Divided {
    fn format_ext(&self, coordinate: &f64) -> String {
        match self.scale {
            Scale::Linear => short(*coordinate),
            Scale::Logarithmic => short(10.0_f64.powf(*coordinate)),
        }
    }
}

/// A round number in few letters.
fn short(value: f64) -> String {
    // What is left of a sum that should be 0.
    let value = if value.abs() < 1e-300 { 0.0 } else { value };
    let size = value.abs();
    if value == 0.0 || (1e-2..1e5).contains(&size) {
        let digits = format!("{value:.3}");
        return digits.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    let digits = format!("{value:.1e}");
    digits.replace(".0e", "e")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let written = [0.0, 0.05, 1.0, 1234.5, 1e5, 2.5e-7, 1e-12].map(short);
        assert_eq!(written, ["0", "0.05", "1", "1234.5", "1e5", "2.5e-7", "1e-12"]);
    }
}
