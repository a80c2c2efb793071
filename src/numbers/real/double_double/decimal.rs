//! Decimal: the two halves of a double-double as one decimal number, and back.
//!
//! The standard library writes every digit of an `f64` and reads any number of digits
//! correctly rounded; what is here adds and rounds such texts.

use core::num::ParseFloatError;

/// Digits enough for most numbers, 107 bits.
const USUAL: i32 = 32;

/// Fewer digits are those of an `f64`, where a second half is left out.
const LEAST: usize = 18;

/// From this power of ten on, and below the least, numbers have an exponent.
const PLAIN: core::ops::Range<i32> = -5..33;

/// `Σ digits[k] · 10^(exponent − k)`, or less than 0.
#[derive(Clone, Debug, PartialEq)]
struct Decimal {
    is_negative: bool,
    digits: Vec<u8>,
    exponent: i32,
}

impl Decimal {
    /// A finite number, with all of its digits.
    fn of(value: f64) -> Self {
        // It is a whole number times this power of two: of a negative one, as many digits
        // stand behind the point.
        let power = ((value.to_bits() >> 52) & 0x7ff).max(1) as i32 - 1075;
        let before = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 + 2 };
        let count = (before - power.min(0)).max(1) as usize;
        Self::read(&format!("{value:.count$e}"))
    }

    /// A number that the standard library has taken for one.
    fn read(text: &str) -> Self {
        let (is_negative, text) = match text.strip_prefix('-') {
            Some(text) => (true, text),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits = whole.bytes().chain(part.bytes()).map(|digit| digit - b'0').collect();
        // No f64 that is finite and not 0 has an exponent out of this range.
        let exponent = exponent.parse().unwrap_or(0_i32).clamp(-100_000, 100_000);
        Self { is_negative, digits, exponent: exponent + whole.len() as i32 - 1 }.trimmed()
    }

    /// Without zeros at either end.
    fn trimmed(mut self) -> Self {
        let zeros = self.digits.iter().take_while(|digit| **digit == 0).count();
        self.digits.drain(..zeros);
        self.exponent -= zeros as i32;
        while self.digits.last() == Some(&0) {
            self.digits.pop();
        }
        self
    }

    /// The sum of both.
    fn plus(&self, other: &Self) -> Self {
        let top = self.exponent.max(other.exponent) + 1;
        let last = |decimal: &Self| decimal.exponent - decimal.digits.len() as i32;
        let bottom = last(self).min(last(other));
        let mut sum = vec![0_i8; (top - bottom).max(1) as usize];
        for decimal in [self, other] {
            let start = (top - decimal.exponent) as usize;
            for (place, digit) in sum[start..].iter_mut().zip(&decimal.digits) {
                *place += if decimal.is_negative { -(*digit as i8) } else { *digit as i8 };
            }
        }
        let is_negative = carried(&mut sum);
        let digits = sum.into_iter().map(|digit| digit as u8).collect();
        Self { is_negative, digits, exponent: top }.trimmed()
    }

    /// Rounded to a number of digits.
    fn rounded(&self, count: usize) -> Self {
        let mut digits = self.digits.clone();
        let is_up = digits.get(count).is_some_and(|digit| *digit >= 5);
        digits.truncate(count);
        digits.insert(0, 0);
        if is_up {
            for digit in digits.iter_mut().rev() {
                *digit += 1;
                if *digit < 10 {
                    break;
                }
                *digit = 0;
            }
        }
        Self { digits, exponent: self.exponent + 1, ..*self }.trimmed()
    }

    /// The nearest `f64`.
    fn to_f64(&self) -> f64 {
        let whole: String = self.digits.iter().map(|digit| char::from(b'0' + digit)).collect();
        let exponent = self.exponent + 1 - self.digits.len() as i32;
        let size = format!("0{whole}e{exponent}").parse().unwrap_or(0.0);
        if self.is_negative { -size } else { size }
    }

    /// With this many digits at least.
    fn text(&self, least: usize) -> String {
        let mut digits: String = self.digits.iter().map(|digit| char::from(b'0' + digit)).collect();
        digits.extend(core::iter::repeat_n('0', least.saturating_sub(digits.len())));
        let sign = if self.is_negative { "-" } else { "" };
        let or_zero = |digits: &str| if digits.is_empty() { "0".into() } else { digits.to_owned() };
        if digits.is_empty() {
            return "0.0".to_owned();
        }
        if !PLAIN.contains(&self.exponent) {
            let (first, rest) = digits.split_at(1);
            let point = if rest.is_empty() { "" } else { "." };
            return format!("{sign}{first}{point}{rest}e{}", self.exponent);
        }
        if self.exponent < 0 {
            let zeros = "0".repeat((-1 - self.exponent) as usize);
            return format!("{sign}0.{zeros}{digits}");
        }
        let before = self.exponent as usize + 1;
        digits.extend(core::iter::repeat_n('0', before.saturating_sub(digits.len())));
        let (whole, part) = digits.split_at(before);
        format!("{sign}{whole}.{}", or_zero(part))
    }
}

/// Makes places digits of the size of a sum; whether it is below 0.
fn carried(sum: &mut [i8]) -> bool {
    let is_negative = sum.iter().find(|place| **place != 0).is_some_and(|place| *place < 0);
    if is_negative {
        sum.iter_mut().for_each(|place| *place = -*place);
    }
    // The first place says it: those behind it are -9 or more, together less than a unit of it.
    for k in (1..sum.len()).rev() {
        let carry = sum[k].div_euclid(10);
        sum[k] = sum[k].rem_euclid(10);
        sum[k - 1] += carry;
    }
    is_negative
}

/// The digits that read back as these halves.
pub fn text([high, low]: [f64; 2]) -> String {
    if !high.is_finite() || !low.is_finite() || high == 0.0 {
        return format!("{high:?}");
    }
    let exact = Decimal::of(high).plus(&Decimal::of(low));
    if low != 0.0 {
        // What is below half a unit in the last place of the second half.
        let needed = (high / low).abs().log10() as i32 + 16;
        for count in [USUAL, USUAL + 1, USUAL + 2, needed, needed + 1, needed + 2] {
            let text = exact.rounded(count.max(USUAL) as usize).text(LEAST);
            if halves(&text).is_ok_and(|read| read == [high, low]) {
                return text;
            }
        }
    }
    exact.text(if low == 0.0 { 1 } else { LEAST })
}

/// The halves of the double-double that is nearest to a decimal number.
pub fn halves(text: &str) -> Result<[f64; 2], ParseFloatError> {
    let high: f64 = text.parse()?;
    if !high.is_finite() || high == 0.0 {
        return Ok([high, 0.0]);
    }
    let mut whole = Decimal::of(high);
    whole.is_negative = !whole.is_negative;
    Ok([high, Decimal::read(text).plus(&whole).to_f64()])
}
