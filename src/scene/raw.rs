//! The scene file as it is written, before anything is checked but its keys
//! and types.

#[cfg(feature = "program")]
mod schema;
mod surroundings;

use core::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer};

#[cfg(feature = "program")]
pub use schema::scene_schema;
pub(super) use surroundings::{KEYS, RawRotation, RawRow, RawSurroundings};

use super::settings::{
    AnalysisKind, Encounters, EngineKind, Impact, OrientationUpdate, Precision, Summation,
};
use super::spheres::{Arrangement, Spread};
use crate::contact::Surface;
use crate::motion::Integrator;
#[cfg(feature = "program")]
use schema::{entries_schema, range_schema};

/// The whole file.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawScene {
    /// In which numbers the scene is computed; f64 by default.
    pub(super) precision: Option<Precision>,
    /// What moves the scene through time: event-driven by default, stepped with a table
    /// [stepped].
    pub(super) engine: Option<EngineKind>,
    /// How long a run takes, time.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) duration: Option<Number>,
    /// How much of the run passes before collisions are counted and the gas is measured,
    /// time.
    #[cfg_attr(feature = "program", schemars(extend("minimum" = 0)))]
    pub(super) equilibrate: Option<Number>,
    /// A uniform field, length/time²; zero by default.
    pub(super) gravity: Option<Vector>,
    /// Of all random numbers; 0 by default.
    pub(super) seed: Option<Whole>,
    /// What spheres can meet.
    pub(super) encounters: Option<Encounters>,
    /// A periodic space: its box, or "cube" for one that is sized by a number_density.
    pub(super) periodic: Option<RawPeriodic>,
    /// What the stepped engine asks.
    pub(super) stepped: Option<RawStepped>,
    /// The surfaces of all spheres and of what is fixed.
    #[serde(default)]
    pub(super) surface: RawSurface,
    /// What is fixed in space, part by part.
    #[serde(default)]
    pub(super) surroundings: Vec<RawSurroundings>,
    /// The spheres: one, many, or those of a state file in each entry.
    #[serde(default, deserialize_with = "entries")]
    #[cfg_attr(feature = "program", schemars(schema_with = "entries_schema"))]
    pub(super) spheres: Vec<RawSpheres>,
    /// Sources of spheres, which come on the way.
    #[serde(default)]
    pub(super) inlet: Vec<RawInlet>,
    /// Frames of the trajectory.
    #[serde(default)]
    pub(super) record: RawWritten,
    /// Figures in time.
    #[serde(default)]
    pub(super) series: RawSeries,
    /// The run itself, to go on from.
    #[serde(default)]
    pub(super) snapshot: RawSnapshot,
    /// What is found of the spheres on the way.
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
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawStepped {
    /// Length of a step, time.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) dt: Option<Number>,
    /// How a step of free flight is taken; velocity-verlet by default.
    pub(super) integrator: Option<Integrator>,
    /// Where inside a step a contact takes effect; sub-step by default.
    pub(super) impact: Option<Impact>,
    /// When orientations are brought up to date; when-asked by default.
    pub(super) orientation: Option<OrientationUpdate>,
    /// How positions and velocities are added up from step to step; auto by default.
    pub(super) summation: Option<Summation>,
}

/// `[record]`: what a run writes on its way.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawWritten {
    /// The path, from the folder of the scene file; its ending chooses the format: .dump,
    /// .lammpstrj, .xyz, .extxyz, .pvd, .npz or .parquet.
    pub(super) file: Option<String>,
    /// From one frame to the next, time.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) every: Option<Number>,
}

/// `[series]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawSeries {
    /// The path, from the folder of the scene file, ending in .csv.
    pub(super) file: Option<String>,
    /// From one row to the next, time.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) every: Option<Number>,
    /// Which columns, in which order; all by default.
    pub(super) columns: Option<Vec<String>>,
}

/// `[snapshot]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawSnapshot {
    /// The path, from the folder of the scene file.
    pub(super) file: Option<String>,
    /// From one snapshot to the next, time.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) every: Option<Number>,
    /// From one snapshot to the next, minutes of the clock on the wall.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) wall: Option<Number>,
}

/// `[[analyse]]`.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawAnalyse {
    /// What is found.
    #[cfg_attr(feature = "program", schemars(required))]
    pub(super) kind: Option<AnalysisKind>,
    /// The path, from the folder of the scene file, ending in .csv; SCENE-KIND.csv by
    /// default.
    pub(super) file: Option<String>,
    /// From one look to the next, time.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) every: Option<Number>,
    /// Into how many bins the range is divided.
    #[cfg_attr(feature = "program", schemars(range(min = 1, max = 100_000)))]
    pub(super) bins: Option<Whole>,
    /// How far it goes, or from where to where.
    #[serde(default)]
    #[cfg_attr(feature = "program", schemars(schema_with = "range_schema"))]
    pub(super) range: Option<Spread>,
    /// Which kinds of spheres, counted from 1; all by default.
    pub(super) species: Option<Vec<Whole>>,
}

/// `[surface]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawSurface {
    /// Frictionless, or with the slip reversed; smooth by default.
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
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawBounds {
    /// The corner with the least coordinates, length.
    #[cfg_attr(feature = "program", schemars(required))]
    pub(super) lower: Option<Vector>,
    /// The corner with the greatest coordinates, length.
    #[cfg_attr(feature = "program", schemars(required))]
    pub(super) upper: Option<Vector>,
}

/// `[[spheres]]`: the keys of one, of many and of those in a file.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawSpheres {
    /// The spheres of a state file; the path, from the folder of the scene file.
    pub(super) file: Option<String>,
    /// Of one sphere: where its centre is, length.
    pub(super) position: Option<Vector>,
    /// How many spheres there are.
    #[cfg_attr(feature = "program", schemars(extend("minimum" = 1)))]
    pub(super) count: Option<Whole>,
    /// How many spheres are placed.
    pub(super) arrangement: Option<Arrangement>,
    /// The box that many fill, surfaces included: its corner with the least coordinates,
    /// length.
    pub(super) lower: Option<Vector>,
    /// The box that many fill: its corner with the greatest coordinates, length.
    pub(super) upper: Option<Vector>,
    /// Of many in a periodic cube, which it sizes, 1/length³.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) number_density: Option<Number>,
    /// A radius, or [least, greatest] to spread them evenly, length.
    pub(super) radius: Option<Spread>,
    /// A mass, or [least, greatest] to spread them evenly; 1 by default.
    pub(super) mass: Option<Spread>,
    /// A density in place of a mass, or [least, greatest], mass/length³.
    pub(super) density: Option<Spread>,
    /// Moment of inertia over m r²: 0.4 for solid spheres, the default; 2/3 for thin shells.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) inertia_factor: Option<Number>,
    /// A velocity, of many added to all, length/time.
    pub(super) velocity: Option<Vector>,
    /// An angular velocity, of many added to all, rad/time.
    pub(super) spin: Option<Vector>,
    /// Of many: kT of their random velocities, energy.
    #[cfg_attr(feature = "program", schemars(extend("minimum" = 0)))]
    pub(super) temperature: Option<Number>,
    /// Of many: kT of their random spins, energy.
    #[cfg_attr(feature = "program", schemars(extend("minimum" = 0)))]
    pub(super) spin_temperature: Option<Number>,
}

/// `[[inlet]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RawInlet {
    /// Where the centres come, length.
    pub(super) position: Option<Vector>,
    /// Or the box in which they come: its corner with the least coordinates, length.
    pub(super) lower: Option<Vector>,
    /// The corner of that box with the greatest coordinates, length.
    pub(super) upper: Option<Vector>,
    /// Or the middle of the disc in which they come, length.
    pub(super) center: Option<Vector>,
    /// Across that disc, of any length but 0.
    pub(super) axis: Option<Vector>,
    /// The radius of that disc, length.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) reach: Option<Number>,
    /// From one sphere to the next, time.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) every: Option<Number>,
    /// Spheres per time, in place of every.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) rate: Option<Number>,
    /// How many come; without end by default.
    #[cfg_attr(feature = "program", schemars(extend("minimum" = 1)))]
    pub(super) count: Option<Whole>,
    /// When the first one comes, time; 0 by default.
    #[cfg_attr(feature = "program", schemars(extend("minimum" = 0)))]
    pub(super) from: Option<Number>,
    /// Of the random numbers of this inlet; that of the scene by default.
    pub(super) seed: Option<Whole>,
    /// A radius, or [least, greatest] to spread them evenly, length.
    pub(super) radius: Option<Spread>,
    /// A mass, or [least, greatest] to spread them evenly; 1 by default.
    pub(super) mass: Option<Spread>,
    /// A density in place of a mass, or [least, greatest], mass/length³.
    pub(super) density: Option<Spread>,
    /// Moment of inertia over m r²: 0.4 for solid spheres, the default; 2/3 for thin shells.
    #[cfg_attr(feature = "program", schemars(extend("exclusiveMinimum" = 0)))]
    pub(super) inertia_factor: Option<Number>,
    /// Their velocity, length/time.
    pub(super) velocity: Option<Vector>,
    /// Their angular velocity, rad/time.
    pub(super) spin: Option<Vector>,
    /// kT of random velocities, which are added, energy.
    #[cfg_attr(feature = "program", schemars(extend("minimum" = 0)))]
    pub(super) temperature: Option<Number>,
    /// kT of random spins, which are added, energy.
    #[cfg_attr(feature = "program", schemars(extend("minimum" = 0)))]
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
