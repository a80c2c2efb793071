//! Entry: a shape as a scene file describes it, as plain values under keys.

use super::mistake::Mistake;

/// What the value of a key says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    /// Three numbers, a point of space.
    Point,
    /// Three numbers, of any length.
    Direction,
    /// A list of points.
    Points,
    /// A list of pairs: distances from an axis, and heights along it.
    Profile,
    /// A number.
    Length,
    /// A number without a unit.
    Ratio,
    /// `true` or `false`.
    Flag,
}

/// A key of a shape's entry. A name has one meaning in all shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) meaning: Meaning,
}

/// The corners of a shape.
pub(super) const VERTICES: Key = Key::new("vertices", Meaning::Points);

/// The middle of a shape.
pub(super) const CENTER: Key = Key::new("center", Meaning::Point);

/// The middle of the base of something round.
pub(super) const BASE: Key = Key::new("base", Meaning::Point);

/// A vector along the axis of something round.
pub(super) const AXIS: Key = Key::new("axis", Meaning::Direction);

/// Of something round.
pub(super) const RADIUS: Key = Key::new("radius", Meaning::Length);

/// The radius at the other end.
pub(super) const TOP_RADIUS: Key = Key::new("top_radius", Meaning::Length);

/// From end to end along the axis.
pub(super) const HEIGHT: Key = Key::new("height", Meaning::Length);

/// From the middle to either end along the axis.
pub(super) const HALF_HEIGHT: Key = Key::new("half_height", Meaning::Length);

/// Whether spheres are inside of the shape: a container.
pub(super) const INSIDE: Key = Key::new("inside", Meaning::Flag);

impl Key {
    /// A key of that name.
    pub(super) const fn new(name: &'static str, meaning: Meaning) -> Self {
        Self { name, meaning }
    }
}

/// The value of a key.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    /// Of a point and a direction.
    Vector([f64; 3]),
    /// Of a list of points.
    Points(Vec<[f64; 3]>),
    /// Of a profile.
    Profile(Vec<[f64; 2]>),
    /// Of a length and a ratio.
    Number(f64),
    /// Of a flag.
    Flag(bool),
}

/// The values that an entry gives.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShapeEntry {
    /// What it calls its shape.
    pub(crate) shape: &'static str,
    values: Vec<(Key, Value)>,
}

impl ShapeEntry {
    /// Adds the value of a key, of the key's meaning.
    pub(crate) fn add(&mut self, key: Key, value: Value) {
        self.values.push((key, value));
    }

    /// Whether the key has a value.
    pub(crate) fn has(&self, key: Key) -> bool {
        self.value(key).is_some()
    }

    /// The vector of a key that has to be there.
    pub(super) fn vector(&self, key: Key) -> Result<[f64; 3], Mistake> {
        match self.value(key) {
            Some(Value::Vector(vector)) => Ok(*vector),
            _ => Err(Mistake::missing(key.name, NO_VECTOR)),
        }
    }

    /// The points of a key that has to be there.
    pub(super) fn points(&self, key: Key) -> Result<&[[f64; 3]], Mistake> {
        match self.value(key) {
            Some(Value::Points(points)) => Ok(points),
            _ => Err(Mistake::missing(key.name, NO_POINTS)),
        }
    }

    /// The profile of a key that has to be there.
    pub(super) fn profile(&self, key: Key) -> Result<&[[f64; 2]], Mistake> {
        match self.value(key) {
            Some(Value::Profile(profile)) => Ok(profile),
            _ => Err(Mistake::missing(key.name, NO_PROFILE)),
        }
    }

    /// The number of a key that has to be there; `wanted` says what it is.
    pub(super) fn number(&self, key: Key, wanted: &str) -> Result<f64, Mistake> {
        match self.value(key) {
            Some(Value::Number(number)) => Ok(*number),
            _ => Err(Mistake::missing(key.name, wanted)),
        }
    }

    /// The height, or twice the half of it.
    pub(super) fn height(&self) -> Result<Option<f64>, Mistake> {
        let half = self.optional(HALF_HEIGHT);
        match (self.optional(HEIGHT), half) {
            (Some(_), Some(half)) => {
                let wanted = "an entry has a height or a half_height";
                Err(Mistake::value(HALF_HEIGHT.name, half, wanted))
            }
            (height, half) => Ok(height.or(half.map(|half| 2.0 * half))),
        }
    }

    /// The number of a key that may be there.
    pub(super) fn optional(&self, key: Key) -> Option<f64> {
        match self.value(key) {
            Some(Value::Number(number)) => Some(*number),
            _ => None,
        }
    }

    /// A flag, false if it is not there.
    pub(super) fn flag(&self, key: Key) -> bool {
        matches!(self.value(key), Some(Value::Flag(true)))
    }

    /// Moves every point away from the origin by a factor. The lengths of a
    /// container grow with them, those of a solid stay.
    pub(crate) fn dilate(&mut self, factor: f64) {
        let inside = self.flag(INSIDE);
        for (key, value) in &mut self.values {
            match value {
                Value::Vector(point) if key.meaning == Meaning::Point => {
                    *point = point.map(|component| component * factor);
                }
                Value::Points(points) => {
                    points.iter_mut().flatten().for_each(|component| *component *= factor);
                }
                Value::Profile(places) if inside => {
                    places.iter_mut().flatten().for_each(|length| *length *= factor);
                }
                Value::Number(length) if inside && key.meaning == Meaning::Length => {
                    *length *= factor
                }
                _ => {}
            }
        }
    }

    fn value(&self, key: Key) -> Option<&Value> {
        self.values.iter().find(|(other, _)| *other == key).map(|(_, value)| value)
    }
}

/// What belongs where points are missing.
const NO_POINTS: &str = "a list of points belongs here, as in [[0, 0, 0], [1, 0, 0], …]";

/// What belongs where a profile is missing.
const NO_PROFILE: &str =
    "a list of places [distance from the axis, height] belongs here, as in [[1, 0], [2, 3]]";

/// What belongs where a vector is missing.
pub(crate) const NO_VECTOR: &str = "three numbers belong here, as in [0.0, 0.0, 1.0]";
