//! Entry: a shape as a scene file describes it, as plain values under keys.

use std::path::{Path, PathBuf};

use super::mistake::Mistake;
use crate::numbers::array::Each;

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
    /// A list of three whole numbers each.
    Triples,
    /// A list of lengths, or one.
    Numbers,
    /// A whole number.
    Count,
    /// The path of a file.
    Path,
}

/// A key of a shape's entry. A name has one meaning in all shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) meaning: Meaning,
}

/// The corners of a shape.
pub(super) const VERTICES: Key = Key::new("vertices", Meaning::Points);

/// What a shape is made of.
pub(super) const FILE: Key = Key::new("file", Meaning::Path);

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
    /// Of a list of three whole numbers each.
    Triples(Vec<[u32; 3]>),
    /// Of a list of numbers.
    Numbers(Vec<f64>),
    /// Of a whole number.
    Count(u64),
    /// Of a path.
    Path(FilePath),
}

/// The path of a file.
#[derive(Clone, Debug)]
pub(crate) struct FilePath {
    /// As it is given.
    pub(crate) given: String,
    /// From the folder that it starts from.
    pub(super) whole: PathBuf,
}

impl FilePath {
    /// A path as it is given.
    pub(crate) fn new(given: String) -> Self {
        Self { whole: PathBuf::from(&given), given }
    }

    /// A file that is refused.
    pub(super) fn mistake(&self, key: Key, error: &dyn core::fmt::Display) -> Mistake {
        let wanted = "give the path of another file, from the folder of the scene file";
        Mistake::described(key.name, format!("{:?}: {error}", self.given), wanted)
    }
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

    /// The triples of a key that has to be there.
    pub(super) fn triples(&self, key: Key) -> Result<&[[u32; 3]], Mistake> {
        match self.value(key) {
            Some(Value::Triples(triples)) => Ok(triples),
            _ => Err(Mistake::missing(key.name, NO_TRIPLES)),
        }
    }

    /// The numbers of a key that may be there.
    pub(super) fn numbers(&self, key: Key) -> Option<&[f64]> {
        match self.value(key) {
            Some(Value::Numbers(numbers)) => Some(numbers),
            _ => None,
        }
    }

    /// The whole number of a key that has to be there; `wanted` says what it is.
    pub(super) fn count(&self, key: Key, wanted: &str) -> Result<usize, Mistake> {
        match self.value(key) {
            Some(Value::Count(count)) => Ok(usize::try_from(*count).unwrap_or(usize::MAX)),
            _ => Err(Mistake::missing(key.name, wanted)),
        }
    }

    /// The path of a key that may be there.
    pub(super) fn path(&self, key: Key) -> Option<&FilePath> {
        match self.value(key) {
            Some(Value::Path(path)) => Some(path),
            _ => None,
        }
    }

    /// The files that the entry names.
    pub(crate) fn files(&self) -> impl Iterator<Item = &str> {
        self.values.iter().filter_map(|(_, value)| match value {
            Value::Path(path) => Some(path.given.as_str()),
            _ => None,
        })
    }

    /// The same with all paths from a folder.
    #[must_use]
    pub(crate) fn in_folder(&self, folder: &Path) -> Self {
        let mut entry = self.clone();
        for (_, value) in &mut entry.values {
            if let Value::Path(path) = value {
                path.whole = folder.join(&path.given);
            }
        }
        entry
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
                    *point = point.each(|component| component * factor);
                }
                Value::Numbers(lengths) => {
                    lengths.iter_mut().for_each(|length| *length *= factor);
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

/// What belongs where triples are missing.
const NO_TRIPLES: &str =
    "a list of three numbers of vertices each, from 0, belongs here, as in [[0, 1, 2], …]";

/// What belongs where a vector is missing.
pub(crate) const NO_VECTOR: &str = "three numbers belong here, as in [0.0, 0.0, 1.0]";
