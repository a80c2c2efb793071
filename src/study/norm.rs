//! Norm: what the errors of all bodies amount to.

use core::fmt;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD_NO_PAD;
use serde::{Deserialize, Serialize};

use super::fit::{mean, mean_square};

/// What the errors of all bodies are made one figure by.
///
/// ```
/// use carom::study::Norm;
/// let errors = [3.0, 0.0, 4.0, 0.0];
/// assert_eq!(Norm::RootMeanSquare.of(&errors), 2.5);
/// assert_eq!(Norm::Maximum.of(&errors), 4.0);
/// assert_eq!(Norm::Mean.of(&errors), 1.75);
/// assert_eq!(Norm::Body(0).of(&errors), 3.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Norm {
    /// Of the mean of their squares, the root: the bodies that are far off decide.
    #[default]
    RootMeanSquare,
    /// That of the body that is farthest off.
    Maximum,
    /// Their mean: each body counts alike (L1).
    Mean,
    /// That of one body, by its place in the scene, from 0.
    Body(usize),
}

impl Norm {
    /// Of some errors; NaN where there is no such body.
    #[must_use]
    pub fn of(self, errors: &[f64]) -> f64 {
        match self {
            Self::RootMeanSquare => mean_square(errors.iter().copied()).sqrt(),
            Self::Maximum => errors.iter().copied().fold(0.0, f64::max),
            Self::Mean => mean(errors),
            Self::Body(body) => errors.get(body).copied().unwrap_or(f64::NAN),
        }
    }

    /// Before the name of what it is of.
    pub(super) fn adjective(self) -> &'static str {
        match self {
            Self::RootMeanSquare => "RMS ",
            Self::Maximum => "greatest ",
            Self::Mean => "mean ",
            Self::Body(_) => "",
        }
    }
}

impl fmt::Display for Norm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RootMeanSquare => f.write_str("root mean square"),
            Self::Maximum => f.write_str("greatest of all bodies"),
            Self::Mean => f.write_str("mean of all bodies"),
            Self::Body(body) => write!(f, "of body {body}"),
        }
    }
}

/// Errors of bodies in two bytes each, as their logarithms to 0.14 %: what another norm is
/// made of without a second run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Packed(String);

/// Steps of a logarithm of base 2: errors from 2⁻¹²⁷ to 2¹²⁷.
const STEPS: f64 = 256.0;

/// What stands for an error of 2⁰; 0 stands for 0.
const ONE: f64 = 32_768.0;

impl Packed {
    /// Packs errors that are not negative.
    #[must_use]
    pub fn new(errors: &[f64]) -> Self {
        let code = |error: &f64| match error {
            0.0 => 0,
            error => (error.log2() * STEPS + ONE).round().clamp(1.0, 65_535.0) as u16,
        };
        let bytes: Vec<u8> = errors.iter().flat_map(|error| code(error).to_le_bytes()).collect();
        Self(STANDARD_NO_PAD.encode(bytes))
    }

    /// The errors again; none of a text that is no such code.
    #[must_use]
    pub fn errors(&self) -> Vec<f64> {
        let bytes = STANDARD_NO_PAD.decode(&self.0).unwrap_or_default();
        let error = |pair: &[u8]| match pair {
            [0, 0] => 0.0,
            pair => {
                let code = u16::from_le_bytes([pair[0], pair[1]]);
                ((f64::from(code) - ONE) / STEPS).exp2()
            }
        };
        bytes.chunks_exact(2).map(error).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_is_the_same_to_three_digits() {
        let errors = [0.0, 1.0, 3e-17, 0.1234, 7e9, 1e-300];
        let packed = Packed::new(&errors).errors();
        assert_eq!(packed.len(), errors.len());
        assert_eq!(packed[..2], errors[..2]);
        for (packed, error) in packed.iter().zip(&errors).skip(1).take(4) {
            assert!((packed / error - 1.0).abs() < 1.4e-3, "{packed} {error}");
        }
        assert!(packed[5] > 0.0 && packed[5] < 1e-38);
        assert!(Packed("no code".to_owned()).errors().is_empty());
    }
}
