//! Axis: what a direction of a chart shows, and the round numbers on it.

use core::ops::Range;

use crate::numbers::array::Each;
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
    /// Values that it reaches to, whatever is drawn: charts with the same ones can be
    /// compared.
    pub reach: Vec<f64>,
}

impl Axis {
    /// What the axis shows.
    #[must_use]
    pub fn new(label: &str, scale: Scale) -> Self {
        Self { label: label.to_owned(), scale, ..Self::default() }
    }

    /// The same with these values written beside it.
    #[must_use]
    pub fn with_ticks(self, ticks: impl IntoIterator<Item = f64>) -> Self {
        Self { ticks: ticks.into_iter().collect(), ..self }
    }

    /// The same that reaches to these values.
    #[must_use]
    pub fn reaching(self, values: impl IntoIterator<Item = f64>) -> Self {
        Self { reach: values.into_iter().collect(), ..self }
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
pub(super) struct Divided {
    /// With the strip of 0.
    span: Range<f64>,
    /// Where 0 is, and the end of its strip, if there is one.
    zero: Option<[f64; 2]>,
    axis: Axis,
    /// Whether numbers on it are powers of ten.
    in_powers: bool,
}

/// A number beside an axis.
#[derive(Debug, PartialEq)]
pub(super) struct Tick {
    /// Where it is, 0 to 1 from one end of the axis to the other.
    pub share: f64,
    pub label: String,
}

/// What a power of ten is multiplied by for the numbers between it and the next one, from
/// many to few.
const BETWEEN: [&[f64]; 5] = [
    &[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0],
    &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
    &[1.0, 2.0, 5.0],
    &[1.0, 3.0],
    &[1.0],
];

impl Divided {
    /// An axis for these values, with a margin.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let (mut least, mut greatest, mut has_zero) = (f64::MAX, f64::MIN, false);
        for value in values.chain(axis.reach.iter().copied()) {
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
        Self { span, zero, axis: axis.clone(), in_powers }
    }

    /// Where a value is, 0 to 1 from one end of the axis to the other; `None` for what
    /// cannot be shown.
    pub(super) fn share(&self, value: f64) -> Option<f64> {
        match self.zero {
            Some([place, _]) if value == 0.0 => Some(self.share_of(place)),
            _ => self.axis.coordinate(value).map(|coordinate| self.share_of(coordinate)),
        }
    }

    /// The end of the strip of 0.
    pub(super) fn edge_of_zero(&self) -> Option<f64> {
        self.zero.map(|[_, edge]| self.share_of(edge))
    }

    fn share_of(&self, coordinate: f64) -> f64 {
        (coordinate - self.span.start) / (self.span.end - self.span.start)
    }

    /// The numbers beside it, about as many as this at the most; those that are given, and
    /// that of the strip of 0, are all there.
    pub(super) fn ticks(&self, most: usize) -> Vec<Tick> {
        let coordinates: Vec<f64> = match self.axis.scale {
            _ if !self.axis.ticks.is_empty() => {
                self.axis.ticks.iter().filter_map(|&tick| self.axis.coordinate(tick)).collect()
            }
            Scale::Linear => self.round_differences(most),
            Scale::Logarithmic => self.round_ratios(most),
        };
        let zero =
            self.zero.map(|[place, _]| Tick { share: self.share_of(place), label: "0".to_owned() });
        let others = coordinates
            .into_iter()
            .map(|at| Tick { share: self.share_of(at), label: self.label(at) });
        zero.into_iter().chain(others).collect()
    }

    /// Multiples of 1, 2 or 5 times a power of ten.
    fn round_differences(&self, most: usize) -> Vec<f64> {
        let least = (self.span.end - self.span.start) / most as f64;
        let power = 10.0_f64.powf(least.log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].each(|part| part * power);
        // A rounding does not decide.
        let step = steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9));
        let step = step.unwrap_or(10.0 * power);
        let first = (self.span.start / step).ceil();
        let count = (self.span.end / step - first).floor().max(-1.0) as i32 + 1;
        (0..count).map(|k| (first + f64::from(k)) * step).collect()
    }

    /// Powers of ten; between them others where there are few.
    fn round_ratios(&self, most: usize) -> Vec<f64> {
        let start = self.zero.map_or(self.span.start, |[_, edge]| edge);
        let decades = self.span.end - start;
        let ratios = |every: f64, parts: &[f64]| -> Vec<f64> {
            let first = (start / every).floor() * every;
            let powers =
                (0..).map(|k| first + every * f64::from(k)).take_while(|p| *p < self.span.end);
            let points =
                powers.flat_map(|power| parts.iter().map(move |part| power + part.log10()));
            points.filter(|point| (start..self.span.end).contains(point)).collect()
        };
        let densest = match decades {
            d if d < 0.3 => 0,
            d if d < 1.0 => 1,
            d if d < 3.0 => 2,
            _ => 4,
        };
        let few = |points: &Vec<f64>| points.len() <= most;
        let within = BETWEEN[densest..].iter().map(|parts| ratios(1.0, parts)).find(few);
        let every = || (2..).map(|every| ratios(f64::from(every), &[1.0])).find(few);
        within.or_else(every).unwrap_or_default()
    }

    fn label(&self, coordinate: f64) -> String {
        match self.axis.scale {
            Scale::Linear => short(coordinate),
            Scale::Logarithmic if self.in_powers => in_powers(10.0_f64.powf(coordinate)),
            Scale::Logarithmic => short(10.0_f64.powf(coordinate)),
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
            [divided.share(0.0), divided.edge_of_zero(), divided.share(1e-8)].map(Option::unwrap);
        assert!(0.0 < zero && zero < edge && edge < least);
        assert_eq!(labels(&divided, 10)[..2], ["0", "10⁻⁸"]);
        let without = Divided::new(&axis, [1e-8, 1e-2].into_iter());
        assert_eq!((without.share(0.0), without.edge_of_zero()), (None, None));
    }

    fn labels(divided: &Divided, most: usize) -> Vec<String> {
        divided.ticks(most).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_those_that_are_given() {
        let axis = Axis::new("lanes", Scale::Logarithmic).with_ticks([1.0, 4.0, 8.0, 16.0]);
        let divided = Divided::new(&axis, [1.0, 16.0].into_iter());
        assert_eq!(labels(&divided, 2), ["1", "4", "8", "16"]);
    }

    #[test]
    fn round_numbers_are_as_many_as_have_room() {
        let linear = Axis::new("time", Scale::Linear);
        let divided = Divided::new(&linear, [0.0, 1.0].into_iter());
        assert_eq!(labels(&divided, 6), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(labels(&divided, 3), ["0", "0.5", "1"]);
        let same = Divided::new(&linear, [7.0, 7.0].into_iter());
        assert_eq!(labels(&same, 3), ["6.5", "7", "7.5"]);
        let error = Axis::new("error", Scale::Logarithmic);
        let divided = Divided::new(&error, [1e-15, 1e-1].into_iter());
        for most in 2..16 {
            let found = labels(&divided, most);
            assert!((2..=most + 1).contains(&found.len()), "{most}: {found:?}");
        }
        let near = Divided::new(&error, [1.0, 1.5].into_iter());
        assert!(labels(&near, 8).len() >= 3);
    }

    #[test]
    fn what_is_reached_to_is_on_it() {
        let axis = Axis::new("error", Scale::Logarithmic).reaching([1e-9, 1.0]);
        let divided = Divided::new(&axis, [1e-3].into_iter());
        assert!(divided.share(1e-9).unwrap() > 0.0 && divided.share(1.0).unwrap() < 1.0);
    }
}
