//! `[[surroundings]]` as it is written: a shape, and the keys of all shapes,
//! sorted out by the shape later.

#[cfg(feature = "program")]
mod schema;

use core::fmt;
use std::sync::LazyLock;

use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

use super::{Number, Numbers, Pair, Vector, Whole};
use crate::numbers::array::Each;
use crate::surroundings::{FilePath, Key, Meaning, ShapeEntry, ShapeKind, Value, shape_kinds};

/// An entry.
#[derive(Clone, Debug, Default)]
pub(in crate::scene) struct RawSurroundings {
    pub(in crate::scene) shape: Option<&'static ShapeKind>,
    pub(in crate::scene) values: ShapeEntry,
    pub(in crate::scene) name: Option<String>,
    pub(in crate::scene) copies: Option<Vec<RawRow>>,
    pub(in crate::scene) sensor: bool,
    pub(in crate::scene) removes: bool,
    pub(in crate::scene) translation: Option<Vector>,
    pub(in crate::scene) rotation: Option<RawRotation>,
    pub(in crate::scene) scale: Option<Number>,
}

impl RawSurroundings {
    /// Moves every point away from the origin by a factor.
    pub(in crate::scene) fn dilate(&mut self, factor: f64) {
        if self.values.files().next().is_some() {
            let Number(scale) = self.scale.unwrap_or(Number(1.0));
            self.scale = Some(Number(scale * factor));
        } else {
            self.values.dilate(factor);
        }
        let center = self.rotation.as_mut().and_then(|rotation| rotation.center.as_mut());
        let steps = self.copies.iter_mut().flatten().filter_map(|row| row.step.as_mut());
        for Vector(point) in self.translation.as_mut().into_iter().chain(center).chain(steps) {
            *point = point.each(|component| component * factor);
        }
    }
}

/// `rotation`: how a shape is turned.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct RawRotation {
    /// What it is turned about, of any length but 0.
    #[cfg_attr(feature = "program", schemars(required))]
    pub(in crate::scene) axis: Option<Vector>,
    /// How far, with the right hand, rad.
    #[cfg_attr(feature = "program", schemars(required))]
    pub(in crate::scene) angle: Option<Number>,
    /// A point of that axis, length; the origin by default.
    pub(in crate::scene) center: Option<Vector>,
}

/// One of `copies`: as many shapes, each a step from the one before.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct RawRow {
    /// How many there are in place of each one.
    #[cfg_attr(feature = "program", schemars(required, extend("minimum" = 1)))]
    pub(in crate::scene) count: Option<Whole>,
    /// From one to the next, length.
    #[cfg_attr(feature = "program", schemars(required))]
    pub(in crate::scene) step: Option<Vector>,
}

/// What a shape's name stands under.
const SHAPE: &str = "shape";
/// What a part is called.
const NAME: &str = "name";
/// The copies of a shape.
const COPIES: &str = "copies";
/// Whether a part only counts.
const SENSOR: &str = "sensor";
/// Whether a part takes out what touches it.
const REMOVES: &str = "removes";
/// Where a shape is moved to.
const TRANSLATION: &str = "translation";
/// How a shape is turned.
const ROTATION: &str = "rotation";
/// How a shape is scaled.
const SCALE: &str = "scale";

/// The keys of all shapes, each once: in the order of the shapes, those that
/// later ones have too behind.
pub(in crate::scene) static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
    let mut keys: Vec<Key> = Vec::new();
    for key in shape_kinds().flat_map(|kind| kind.keys) {
        keys.retain(|other| other.name != key.name);
        keys.push(*key);
    }
    keys
});

/// The names of all keys.
static KEY_NAMES: LazyLock<Vec<&str>> = LazyLock::new(|| {
    let own = KEYS.iter().map(|key| key.name);
    [SHAPE]
        .into_iter()
        .chain(own)
        .chain([NAME, COPIES, SENSOR, REMOVES, TRANSLATION, ROTATION, SCALE])
        .collect()
});

/// The names of all shapes.
static SHAPE_NAMES: LazyLock<Vec<&str>> =
    LazyLock::new(|| shape_kinds().flat_map(ShapeKind::names).collect());

/// One of the keys.
enum Field {
    Shape,
    Name,
    Copies,
    Sensor,
    Removes,
    Translation,
    Rotation,
    Scale,
    Of(Key),
}

impl<'de> Deserialize<'de> for Field {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Taker;
        impl Visitor<'_> for Taker {
            type Value = Field;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a key")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Field, E> {
                match name {
                    SHAPE => return Ok(Field::Shape),
                    NAME => return Ok(Field::Name),
                    COPIES => return Ok(Field::Copies),
                    SENSOR => return Ok(Field::Sensor),
                    REMOVES => return Ok(Field::Removes),
                    TRANSLATION => return Ok(Field::Translation),
                    ROTATION => return Ok(Field::Rotation),
                    SCALE => return Ok(Field::Scale),
                    _ => {}
                }
                let key = KEYS.iter().find(|key| key.name == name);
                key.map(|key| Field::Of(*key)).ok_or_else(|| E::unknown_field(name, &KEY_NAMES))
            }
        }
        deserializer.deserialize_identifier(Taker)
    }
}

/// A shape by its name.
struct Named(&'static ShapeKind, &'static str);

impl<'de> Deserialize<'de> for Named {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Taker;
        impl Visitor<'_> for Taker {
            type Value = Named;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "one of `{}`", SHAPE_NAMES.join("`, `"))
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Named, E> {
                let mut names =
                    shape_kinds().flat_map(|kind| kind.names().map(move |name| Named(kind, name)));
                names
                    .find(|Named(_, own)| *own == name)
                    .ok_or_else(|| E::unknown_variant(name, &SHAPE_NAMES))
            }
        }
        deserializer.deserialize_str(Taker)
    }
}

impl<'de> Deserialize<'de> for RawSurroundings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Taker;
        impl<'de> Visitor<'de> for Taker {
            type Value = RawSurroundings;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table with a shape")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<RawSurroundings, A::Error> {
                let mut raw = RawSurroundings::default();
                while let Some(field) = map.next_key()? {
                    match field {
                        Field::Shape => {
                            let Named(shape, name) = map.next_value()?;
                            raw.shape = Some(shape);
                            raw.values.shape = name;
                        }
                        Field::Name => raw.name = Some(map.next_value()?),
                        Field::Copies => raw.copies = Some(map.next_value()?),
                        Field::Sensor => raw.sensor = map.next_value()?,
                        Field::Removes => raw.removes = map.next_value()?,
                        Field::Translation => raw.translation = Some(map.next_value()?),
                        Field::Rotation => raw.rotation = Some(map.next_value()?),
                        Field::Scale => raw.scale = Some(map.next_value()?),
                        Field::Of(key) => raw.values.add(key, value(key, &mut map)?),
                    }
                }
                Ok(raw)
            }
        }
        deserializer.deserialize_map(Taker)
    }
}

/// The value of a key.
fn value<'de, A: MapAccess<'de>>(key: Key, map: &mut A) -> Result<Value, A::Error> {
    Ok(match key.meaning {
        Meaning::Point | Meaning::Direction => {
            let Vector(vector) = map.next_value()?;
            Value::Vector(vector)
        }
        Meaning::Points => {
            let points: Vec<Vector> = map.next_value()?;
            Value::Points(points.into_iter().map(|Vector(point)| point).collect())
        }
        Meaning::Profile => {
            let places: Vec<Pair> = map.next_value()?;
            Value::Profile(places.into_iter().map(|Pair(place)| place).collect())
        }
        Meaning::Length | Meaning::Ratio => {
            let Number(number) = map.next_value()?;
            Value::Number(number)
        }
        Meaning::Flag => Value::Flag(map.next_value()?),
        Meaning::Triples => Value::Triples(map.next_value()?),
        Meaning::Numbers => {
            let Numbers(numbers) = map.next_value()?;
            Value::Numbers(numbers)
        }
        Meaning::Count => {
            let Whole(count) = map.next_value()?;
            Value::Count(count)
        }
        Meaning::Path => Value::Path(FilePath::new(map.next_value()?)),
    })
}

#[cfg(test)]
mod tests {
    use super::{KEYS, shape_kinds};

    /// The keys are read before it is known which shape they are of.
    #[test]
    fn a_key_means_the_same_in_all_shapes() {
        for kind in shape_kinds() {
            for key in kind.keys {
                assert!(KEYS.contains(key), "{key:?} of a {} means something else", kind.name);
            }
        }
    }
}
