//! Axis: what a direction of a chart shows, and the round numbers on it.

use core::ops::Range;

use plotters::coord::ranged1d::{NoDefaultFormatting, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::study::table::power_of_ten;

/// How far a scale goes, and how it is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal ways are equal differences.
    #[default]
    Linear,
    /// Equal ways are equal ratios. What is exactly 0 stands in a strip of its own beside
    /// them; what is negative is not drawn.
    Logarithmic,
}

/// One of the two directions of a chart.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// How it is divided.
    pub scale: Scale,
    /// The values that are written beside it; none for round numbers.
    pub ticks: Vec<f64>,
}

impl Axis {
    /// What the axis shows.
    #[must_use]
    pub fn new(label: &str, scale: Scale) -> Self {
        Self { label: label.to_owned(), scale, ticks: Vec::new() }
    }

    /// The same with these values written beside it.
    #[must_use]
    pub fn with_ticks(self, ticks: impl IntoIterator<Item = f64>) -> Self {
        Self { ticks: ticks.into_iter().collect(), ..self }
    }

    /// Where a value is: the axis itself is linear in it.
    fn coordinate(&self, value: f64) -> Option<f64> {
        let coordinate = match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic if value > 0.0 => value.log10(),
            Scale::Logarithmic => return None,
        };
        coordinate.is_finite().then_some(coordinate)
    }
}

/// A range of an axis with round numbers on it.
#[derive(Clone)]
pub(super) struct Divided {
    range: RangedCoordf64,
    /// With the strip of 0.
    span: Range<f64>,
    /// Where 0 is, and the end of its strip, if there is one.
    zero: Option<[f64; 2]>,
    axis: Axis,
    /// Whether numbers on it are powers of ten.
    in_powers: bool,
}

impl Divided {
    /// An axis for these values, with a margin.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let (mut least, mut greatest, mut has_zero) = (f64::MAX, f64::MIN, false);
        for value in values {
            has_zero |= value == 0.0;
            if let Some(value) = axis.coordinate(value) {
                (least, greatest) = (least.min(value), greatest.max(value));
            }
        }
        let mut span = if least > greatest {
            0.0..1.0
        } else {
            let margin = if greatest > least { (greatest - least) * 0.04 } else { 0.5 };
            least - margin..greatest + margin
        };
        let decades = span.end - span.start;
        let in_powers = decades > 3.0 || span.start < -2.0 || span.end > 5.0;
        let zero = (has_zero && axis.scale == Scale::Logarithmic).then(|| {
            let strip = decades * 0.08;
            [span.start - strip / 2.0, span.start]
        });
        if let Some([place, edge]) = zero {
            span.start -= 2.0 * (edge - place);
        }
        let range = span.clone().into();
        Self { range, span, zero, axis: axis.clone(), in_powers }
    }

    /// Where a value is.
    pub(super) fn coordinate(&self, value: f64) -> Option<f64> {
        match self.zero {
            Some([place, _]) if value == 0.0 => Some(place),
            _ => self.axis.coordinate(value),
        }
    }

    /// From where to where it goes.
    pub(super) fn span(&self) -> Range<f64> {
        self.span.clone()
    }

    /// The end of the strip of 0.
    pub(super) fn edge_of_zero(&self) -> Option<f64> {
        self.zero.map(|[_, edge]| edge)
    }

    /// Powers of ten; between them others where there are few.
    fn round_ratios(&self) -> Vec<f64> {
        let start = self.edge_of_zero().unwrap_or(self.span.start);
        let decades = self.span.end - start;
        let every = (decades / 8.0).ceil().max(1.0);
        let parts: &[f64] = match decades {
            d if d < 0.3 => &[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0],
            d if d < 1.0 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
            d if d < 3.0 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let first = (start / every).floor() * every;
        let powers = (0..).map(|k| first + every * f64::from(k)).take_while(|p| *p < self.span.end);
        let points = powers.flat_map(|power| parts.iter().map(move |part| power + part.log10()));
        points.filter(|point| (start..self.span.end).contains(point)).collect()
    }
}

impl Ranged for Divided {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<H: plotters::coord::ranged1d::KeyPointHint>(&self, hint: H) -> Vec<f64> {
        let zero = self.zero.map(|[place, _]| place);
        let points = match self.axis.scale {
            _ if !self.axis.ticks.is_empty() => {
                self.axis.ticks.iter().filter_map(|&tick| self.axis.coordinate(tick)).collect()
            }
            Scale::Linear => self.range.key_points(hint),
            Scale::Logarithmic => self.round_ratios(),
        };
        zero.into_iter().chain(points).collect()
    }

    fn range(&self) -> Range<f64> {
        self.span.clone()
    }
}

impl ValueFormatter<f64> for Divided {
    fn format_ext(&self, coordinate: &f64) -> String {
        if self.zero.is_some_and(|[place, _]| *coordinate <= place) {
            return "0".to_owned();
        }
        match self.axis.scale {
            Scale::Linear => short(*coordinate),
            Scale::Logarithmic if self.in_powers => in_powers(10.0_f64.powf(*coordinate)),
            Scale::Logarithmic => short(10.0_f64.powf(*coordinate)),
        }
    }
}

/// A round number in few letters.
fn short(value: f64) -> String {
    // What is left of a sum that should be 0.
    let value = if value.abs() < 1e-300 { 0.0 } else { value };
    if value == 0.0 || (1e-2..1e5).contains(&value.abs()) {
        let digits = format!("{value:.3}");
        return digits.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    in_powers(value)
}

/// A number as a power of ten, with up to two digits before it.
fn in_powers(value: f64) -> String {
    let text = format!("{value:.1e}");
    let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
    let power = power_of_ten(power.parse().unwrap_or(0));
    match digits.trim_end_matches(".0") {
        "1" => power,
        "-1" => format!("-{power}"),
        digits => format!("{digits}·{power}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let written = [0.0, 0.05, 1.0, 1234.5, 1e5, 2.5e-7, -1e-12].map(short);
        assert_eq!(written, ["0", "0.05", "1", "1234.5", "10⁵", "2.5·10⁻⁷", "-10⁻¹²"]);
        assert_eq!([1.0, 20.0].map(in_powers), ["10⁰", "2·10¹"]);
    }

    #[test]
    fn zeros_have_a_strip_of_their_own() {
        let axis = Axis::new("error", Scale::Logarithmic);
        let divided = Divided::new(&axis, [1e-8, 0.0, 1e-2].into_iter());
        let [zero, edge, least] =
            [divided.coordinate(0.0), divided.edge_of_zero(), divided.coordinate(1e-8)]
                .map(|c| c.unwrap());
        assert!(divided.span.start < zero && zero < edge && edge < least);
        let points = divided.key_points(10);
        assert_eq!(divided.format_ext(&points[0]), "0");
        assert_eq!(divided.format_ext(&points[1]), "10⁻⁸");
        let without = Divided::new(&axis, [1e-8, 1e-2].into_iter());
        assert_eq!((without.coordinate(0.0), without.edge_of_zero()), (None, None));
    }

    #[test]
    fn ticks_are_those_that_are_given() {
        let axis = Axis::new("lanes", Scale::Logarithmic).with_ticks([1.0, 4.0, 8.0, 16.0]);
        let divided = Divided::new(&axis, [1.0, 16.0].into_iter());
        let written: Vec<_> =
            divided.key_points(10).iter().map(|point| divided.format_ext(point)).collect();
        assert_eq!(written, ["1", "4", "8", "16"]);
    }
}
