//! Mistakes in values: what is wrong with a key's value, and what would be right.

use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// A value that cannot be.
#[derive(Clone, Debug)]
pub(crate) struct Mistake {
    /// The key of the value.
    pub(crate) key: &'static str,
    /// What the value is; `None` if it is missing.
    pub(crate) found: Option<String>,
    /// What would be right.
    pub(crate) wanted: String,
}

impl Mistake {
    /// A value where another would be right.
    pub(crate) fn value(
        key: &'static str,
        found: impl core::fmt::Debug,
        wanted: impl Into<String>,
    ) -> Self {
        Self::described(key, format!("{found:?}"), wanted)
    }

    /// A value where another would be right, `found` in words.
    pub(crate) fn described(
        key: &'static str,
        found: impl Into<String>,
        wanted: impl Into<String>,
    ) -> Self {
        Self { key, found: Some(found.into()), wanted: wanted.into() }
    }

    /// A value that has to be there.
    pub(crate) fn missing(key: &'static str, wanted: impl Into<String>) -> Self {
        Self { key, found: None, wanted: wanted.into() }
    }
}

/// Whether a number is finite and greater than 0, in a precision too.
pub(crate) fn is_positive<T: Real>(value: f64) -> bool {
    let rounded = T::from_f64(value);
    value.is_finite() && rounded > T::ZERO && rounded.is_finite()
}

/// A mistake unless a number, `what`, is finite and greater than 0.
pub(crate) fn positive<T: Real>(key: &'static str, value: f64, what: &str) -> Result<(), Mistake> {
    if is_positive::<T>(value) {
        return Ok(());
    }
    let precision = if value > 0.0 && value.is_finite() {
        format!(" in {} too", T::NAME)
    } else {
        String::new()
    };
    let wanted = format!("{what} must be finite and greater than 0{precision}");
    Err(Mistake::value(key, value, wanted))
}

/// A mistake unless a number, `what`, is 0, or finite and greater than 0.
pub(crate) fn not_negative<T: Real>(
    key: &'static str,
    value: f64,
    what: &str,
) -> Result<(), Mistake> {
    if value == 0.0 {
        return Ok(());
    }
    positive::<T>(key, value, &format!("{what}, if not 0,"))
}

/// A mistake unless `what`, all components of a vector, are finite in a
/// precision.
pub(crate) fn finite<T: Real>(
    key: &'static str,
    vector: Vec3<f64>,
    what: &str,
) -> Result<(), Mistake> {
    let vector = vector.to_array();
    if vector.iter().all(|c| T::from_f64(*c).is_finite()) {
        return Ok(());
    }
    Err(Mistake::value(key, vector, format!("{what} must be finite in {}", T::NAME)))
}

/// A mistake unless a point, length, is finite.
pub(crate) fn point<T: Real>(key: &'static str, point: Vec3<T>) -> Result<(), Mistake> {
    finite::<T>(key, point.cast(), "every component")
}

/// A mistake unless these are the corners of a box, the keys `lower` and
/// `upper`.
pub(crate) fn corners<T: Real>(lower: Vec3<T>, upper: Vec3<T>) -> Result<(), Mistake> {
    point("lower", lower)?;
    point("upper", upper)?;
    let sides = (upper - lower).to_array();
    if sides.iter().all(|side| *side > T::ZERO && side.is_finite()) {
        return Ok(());
    }
    let [lower, upper] = [lower, upper].each(|corner| corner.cast::<f64>().to_array());
    let wanted = format!("every component must be below that of upper, {upper:?}");
    Err(Mistake::value("lower", lower, wanted))
}

/// A mistake unless a direction has come out as a unit vector.
pub(crate) fn direction<T: Real>(key: &'static str, unit: Vec3<T>) -> Result<(), Mistake> {
    if (unit.length().to_f64() - 1.0).abs() < 1e-3 {
        return Ok(());
    }
    let wanted = format!("{} must be finite and have a length greater than 0", an(key));
    Err(Mistake::described(key, "no direction", wanted))
}

/// A key with its article.
fn an(key: &str) -> String {
    let article = if key.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    format!("{article} {key}")
}
