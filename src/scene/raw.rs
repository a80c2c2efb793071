//! The scene file as it is written, before anything is checked but its keys
//! and types.

mod surroundings;

use core::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer};

pub(super) use surroundings::{KEYS, RawRotation, RawRow, RawSurroundings};

use super::settings::{
    AnalysisKind, Encounters, EngineKind, Impact, OrientationUpdate, Precision, Summation,
};
use super::spheres::{Arrangement, Spread};
use crate::contact::Surface;
use crate::motion::Integrator;

/// The whole file.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawScene {
    pub(super) precision: Option<Precision>,
    pub(super) engine: Option<EngineKind>,
    pub(super) duration: Option<Number>,
    pub(super) equilibrate: Option<Number>,
    pub(super) gravity: Option<Vector>,
    pub(super) seed: Option<Whole>,
    pub(super) encounters: Option<Encounters>,
    pub(super) periodic: Option<RawPeriodic>,
    pub(super) stepped: Option<RawStepped>,
    #[serde(default)]
    pub(super) surface: RawSurface,
    #[serde(default)]
    pub(super) surroundings: Vec<RawSurroundings>,
    #[serde(default, deserialize_with = "entries")]
    pub(super) spheres: Vec<RawSpheres>,
    #[serde(default)]
    pub(super) inlet: Vec<RawInlet>,
    #[serde(default)]
    pub(super) record: RawWritten,
    #[serde(default)]
    pub(super) series: RawSeries,
    #[serde(default)]
    pub(super) snapshot: RawSnapshot,
    #[serde(default)]
    pub(super) analyse: Vec<RawAnalyse>,
}

impl RawScene {
    /// `stepped.dt`.
    pub(super) fn dt(&self) -> Option<Number> {
        self.stepped.as_ref().and_then(|stepped| stepped.dt)
    }
}

/// `[stepped]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawStepped {
    pub(super) dt: Option<Number>,
    pub(super) integrator: Option<Integrator>,
    pub(super) impact: Option<Impact>,
    pub(super) orientation: Option<OrientationUpdate>,
    pub(super) summation: Option<Summation>,
}

/// `[record]`: what a run writes on its way.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawWritten {
    pub(super) file: Option<String>,
    pub(super) every: Option<Number>,
}

/// `[series]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSeries {
    pub(super) file: Option<String>,
    pub(super) every: Option<Number>,
    pub(super) columns: Option<Vec<String>>,
}

/// `[snapshot]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSnapshot {
    pub(super) file: Option<String>,
    pub(super) every: Option<Number>,
    pub(super) wall: Option<Number>,
}

/// `[[analyse]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawAnalyse {
    pub(super) kind: Option<AnalysisKind>,
    pub(super) file: Option<String>,
    pub(super) every: Option<Number>,
    pub(super) bins: Option<Whole>,
    pub(super) range: Option<Spread>,
    pub(super) species: Option<Vec<Whole>>,
}

/// `[surface]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSurface {
    pub(super) kind: Option<Surface>,
}

/// `periodic = "cube"` or `[periodic]`.
#[derive(Clone, Debug)]
pub(super) enum RawPeriodic {
    Cube,
    Box(RawBounds),
}

/// `lower` and `upper`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawBounds {
    pub(super) lower: Option<Vector>,
    pub(super) upper: Option<Vector>,
}

/// `[[spheres]]`: the keys of one, of many and of those in a file.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSpheres {
    pub(super) file: Option<String>,
    pub(super) position: Option<Vector>,
    pub(super) count: Option<Whole>,
    pub(super) arrangement: Option<Arrangement>,
    pub(super) lower: Option<Vector>,
    pub(super) upper: Option<Vector>,
    pub(super) number_density: Option<Number>,
    pub(super) radius: Option<Spread>,
    pub(super) mass: Option<Spread>,
    pub(super) density: Option<Spread>,
    pub(super) inertia_factor: Option<Number>,
    pub(super) velocity: Option<Vector>,
    pub(super) spin: Option<Vector>,
    pub(super) temperature: Option<Number>,
    pub(super) spin_temperature: Option<Number>,
}

/// `[[inlet]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawInlet {
    pub(super) position: Option<Vector>,
    pub(super) lower: Option<Vector>,
    pub(super) upper: Option<Vector>,
    pub(super) center: Option<Vector>,
    pub(super) axis: Option<Vector>,
    pub(super) reach: Option<Number>,
    pub(super) every: Option<Number>,
    pub(super) rate: Option<Number>,
    pub(super) count: Option<Whole>,
    pub(super) from: Option<Number>,
    pub(super) seed: Option<Whole>,
    pub(super) radius: Option<Spread>,
    pub(super) mass: Option<Spread>,
    pub(super) density: Option<Spread>,
    pub(super) inertia_factor: Option<Number>,
    pub(super) velocity: Option<Vector>,
    pub(super) spin: Option<Vector>,
    pub(super) temperature: Option<Number>,
    pub(super) spin_temperature: Option<Number>,
}

/// A number, whole or not.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number(pub(super) f64);

/// Its value, if it is given.
pub(super) fn number(value: Option<Number>) -> Option<f64> {
    value.map(|Number(value)| value)
}

/// A whole number from 0 up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whole(pub(super) u64);

/// Numbers.
#[derive(Clone, Debug)]
pub(super) struct Numbers(pub(super) Vec<f64>);

/// Three numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vector(pub(super) [f64; 3]);

/// Two numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair(pub(super) [f64; 2]);

/// The numbers of an array, which has as many.
fn numbers<'de, const N: usize, A: SeqAccess<'de>>(
    mut elements: A,
    expected: &dyn serde::de::Expected,
    count: &str,
) -> Result<[f64; N], A::Error> {
    let mut numbers = [0.0; N];
    for (index, number) in numbers.iter_mut().enumerate() {
        let element: Option<Number> = elements.next_element()?;
        *number = element.ok_or_else(|| A::Error::invalid_length(index, expected))?.0;
    }
    match elements.next_element::<serde::de::IgnoredAny>()? {
        None => Ok(numbers),
        Some(_) => Err(A::Error::custom(format!("too long an array, expected {count} numbers"))),
    }
}

/// Takes what a value may be, and names it in errors.
macro_rules! deserialize {
    ($type:ident, $method:ident, $expecting:literal, { $($visit:item)* }) => {
        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Taker;
                impl<'de> Visitor<'de> for Taker {
                    type Value = $type;
                    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                        f.write_str($expecting)
                    }
                    $($visit)*
                }
                deserializer.$method(Taker)
            }
        }
    };
}

deserialize!(Number, deserialize_any, "a number", {
    fn visit_f64<E: Error>(self, value: f64) -> Result<Number, E> {
        Ok(Number(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Number, E> {
        Ok(Number(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Number, E> {
        Ok(Number(value as f64))
    }

    fn visit_i128<E: Error>(self, value: i128) -> Result<Number, E> {
        Ok(Number(value as f64))
    }

    fn visit_u128<E: Error>(self, value: u128) -> Result<Number, E> {
        Ok(Number(value as f64))
    }
});

deserialize!(Whole, deserialize_any, "a whole number from 0 up", {
    fn visit_i64<E: Error>(self, value: i64) -> Result<Whole, E> {
        let invalid = |_| E::invalid_value(serde::de::Unexpected::Signed(value), &self);
        u64::try_from(value).map(Whole).map_err(invalid)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Whole, E> {
        Ok(Whole(value))
    }
});

deserialize!(Numbers, deserialize_any, "a number, or a list of them", {
    fn visit_f64<E: Error>(self, value: f64) -> Result<Numbers, E> {
        Ok(Numbers(vec![value]))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Numbers, E> {
        Ok(Numbers(vec![value as f64]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Numbers, A::Error> {
        let mut numbers = Vec::new();
        while let Some(Number(number)) = elements.next_element()? {
            numbers.push(number);
        }
        Ok(Numbers(numbers))
    }
});

deserialize!(Vector, deserialize_any, "three numbers, as in [0.0, 0.0, 1.0]", {
    fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<Vector, A::Error> {
        numbers(elements, &self, "three").map(Vector)
    }
});

deserialize!(Pair, deserialize_any, "two numbers, [distance from the axis, height]", {
    fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<Pair, A::Error> {
        numbers(elements, &self, "two").map(Pair)
    }
});

deserialize!(Spread, deserialize_any, "a number, or two, [least, greatest], to spread over", {
    fn visit_f64<E: Error>(self, value: f64) -> Result<Spread, E> {
        Ok(Spread::Same(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Spread, E> {
        Ok(Spread::Same(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Spread, E> {
        Ok(Spread::Same(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<Spread, A::Error> {
        let [least, greatest] = numbers(elements, &self, "two")?;
        Ok(Spread::Uniform { least, greatest })
    }
});

deserialize!(RawPeriodic, deserialize_any, "a table of lower and upper, or \"cube\"", {
    fn visit_str<E: Error>(self, text: &str) -> Result<RawPeriodic, E> {
        if text == "cube" {
            return Ok(RawPeriodic::Cube);
        }
        Err(E::invalid_value(serde::de::Unexpected::Str(text), &self))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawPeriodic, A::Error> {
        RawBounds::deserialize(MapAccessDeserializer::new(map)).map(RawPeriodic::Box)
    }
});

/// `[[spheres]]`, or the one entry that `spheres = { … }` is.
fn entries<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<RawSpheres>, D::Error> {
    struct Taker;
    impl<'de> Visitor<'de> for Taker {
        type Value = Vec<RawSpheres>;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("[[spheres]] entries, or a table as { file = \"state.csv\" }")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Self::Value, A::Error> {
            let mut entries = Vec::new();
            while let Some(entry) = elements.next_element()? {
                entries.push(entry);
            }
            Ok(entries)
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
            RawSpheres::deserialize(MapAccessDeserializer::new(map)).map(|entry| vec![entry])
        }
    }
    deserializer.deserialize_any(Taker)
}
