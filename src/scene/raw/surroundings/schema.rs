//! The schema of `[[surroundings]]`: the keys of all shapes, and for each shape which of them
//! it has.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use super::super::schema::list_of_numbers;
use super::{
    COPIES, KEYS, NAME, REMOVES, ROTATION, RawRotation, RawRow, RawSurroundings, SCALE, SENSOR,
    SHAPE, SHAPE_NAMES, TRANSLATION,
};
use crate::surroundings::{Key, Meaning, shape_kinds};

impl JsonSchema for RawSurroundings {
    fn schema_name() -> Cow<'static, str> {
        "RawSurroundings".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut keys = Map::new();
        let mut add = |name: &str, words: &str, schema: Schema| {
            let mut schema = schema.to_value();
            schema["description"] = words.into();
            keys.insert(name.to_owned(), schema);
        };
        add(SHAPE, "What the part is.", json_schema!({ "enum": *SHAPE_NAMES }));
        for key in KEYS.iter() {
            add(key.name, words(key), meant(key.meaning));
        }
        let flag = || json_schema!({ "type": "boolean" });
        let rows = generator.subschema_for::<Vec<RawRow>>();
        add(NAME, "What it is called, as no other part is.", json_schema!({ "type": "string" }));
        add(COPIES, "The same shape again, in up to three rows of rows.", rows);
        add(SENSOR, "Whether it only counts what passes through it.", flag());
        add(REMOVES, "Whether it takes out of the world what touches it.", flag());
        let rotation = generator.subschema_for::<RawRotation>();
        add(SCALE, "How many times as large it is made, first of all.", above_zero());
        add(ROTATION, "How it is turned, after it is scaled.", rotation);
        add(TRANSLATION, "How it is moved, last of all, length.", list_of_numbers(3));
        let names: Vec<&str> = KEYS.iter().map(|key| key.name).collect();
        let of_shapes: Vec<Value> = shape_kinds()
            .map(|kind| {
                let own: Vec<&str> = kind.keys.iter().map(|key| key.name).collect();
                let foreign = names.iter().filter(|name| !own.contains(name));
                let foreign = foreign.map(|name| ((*name).to_owned(), Value::Bool(false)));
                json!({
                    "if": { "properties": { SHAPE: { "enum": kind.names().collect::<Vec<_>>() } } },
                    "then": { "properties": foreign.collect::<Map<_, _>>() },
                })
            })
            .collect();
        json_schema!({
            "type": "object",
            "properties": keys,
            "additionalProperties": false,
            "required": [SHAPE],
            "allOf": of_shapes,
        })
    }
}

/// What the value of a key can be.
fn meant(meaning: Meaning) -> Schema {
    let list = |items: Schema| json_schema!({ "type": "array", "items": items });
    let number = || json_schema!({ "type": "number" });
    match meaning {
        Meaning::Point | Meaning::Direction => list_of_numbers(3),
        Meaning::Points => list(list_of_numbers(3)),
        Meaning::Profile => list(list_of_numbers(2)),
        Meaning::Length | Meaning::Ratio => json_schema!({ "type": "number", "minimum": 0 }),
        Meaning::Flag => json_schema!({ "type": "boolean" }),
        Meaning::Triples => list(json_schema!({
            "type": "array",
            "items": { "type": "integer", "minimum": 0 },
            "minItems": 3,
            "maxItems": 3,
        })),
        Meaning::Numbers => json_schema!({ "anyOf": [number(), list(number())] }),
        Meaning::Count => json_schema!({ "type": "integer", "minimum": 1 }),
        Meaning::Path => json_schema!({ "type": "string" }),
    }
}

fn above_zero() -> Schema {
    json_schema!({ "type": "number", "exclusiveMinimum": 0 })
}

/// What a key says.
fn words(key: &Key) -> &'static str {
    match key.name {
        "point" => "A point of the plane, length.",
        "normal" => "Out of the solid side of the plane, of any length but 0.",
        "lower" => "The corner with the least coordinates, length.",
        "upper" => "The corner with the greatest coordinates, length.",
        "center" => "The middle, length.",
        "radius" => "The radius; of a cone or a tube that of its base, length.",
        "inside" => "Whether the spheres are inside: a container.",
        "a" => "One end of the line that all of the capsule is within the radius of, length.",
        "b" => "The other end of that line, length.",
        "axis" => "Along the axis, of any length but 0.",
        "height" => "From end to end along the axis, length.",
        "half_height" => "From the middle to either end along the axis, length.",
        "apex" => "The tip of a cone without end, length.",
        "slope" => "Of a cone without end: radius over height.",
        "base" => "The middle of the base, from which the axis leads to the top, length.",
        "top_radius" => {
            "The radius of the top, length: of a cone 0 by default, of a tube its radius."
        }
        "major" => "Of the circle along which the tube of a torus runs, length.",
        "minor" => "Of the tube of a torus, length.",
        "inner" => "The radius of the hole, length.",
        "outer" => "The radius of the rim, length.",
        "profile" => "Places [distance from the axis, height along it from the center], length.",
        "closed" => "Whether the last place of the profile leads to its first one.",
        "vertices" => "The corners, length.",
        "triangles" => "Three numbers of vertices each, from 0.",
        "file" => {
            "The path, from the folder of the scene file: .stl or .obj of a mesh, .csv or .png of a heightfield."
        }
        "origin" => {
            "The point of the grid with the least x and y, and a height that is added to all, length."
        }
        "spacing" => {
            "From one point of the grid to the next, one number or one each along x and y, length."
        }
        "columns" => "How many points there are along x, from 2.",
        "rows" => "How many points there are along y, from 2.",
        "heights" => "The heights, row by row, length.",
        "range" => "The heights of black and white of a picture, length.",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_key_has_words() {
        for key in KEYS.iter() {
            assert_ne!(words(key), "", "{}", key.name);
        }
    }
}
