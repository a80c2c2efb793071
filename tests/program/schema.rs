//! The schema of scene files: it takes what is read, and nothing else.

use std::collections::BTreeSet;

use carom::SceneFile;
use carom::scene::builtin_scenes;
use serde_json::{Map, Value, json};

use crate::{BOX, FLUID, Folder};

/// The schema that the program prints.
fn schema() -> Value {
    serde_json::from_str(&Folder::with("").says("scenes --schema").well()).unwrap()
}

/// Whether a value is as a schema of draft 2020-12 has it, as far as this one goes.
fn fits(schema: &Value, value: &Value) -> bool {
    let Value::Object(rules) = schema else { return *schema == json!(true) };
    let holds = |rule: &String, wanted: &Value| match (rule.as_str(), value) {
        ("type", _) => match wanted.as_str().unwrap() {
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "number" => value.is_number(),
            "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
            other => panic!("a type {other}"),
        },
        ("const", _) => value == wanted,
        ("enum", _) => wanted.as_array().unwrap().contains(value),
        ("anyOf", _) => all(wanted).any(|schema| fits(schema, value)),
        ("oneOf", _) => all(wanted).filter(|schema| fits(schema, value)).count() == 1,
        ("allOf", _) => all(wanted).all(|schema| fits(schema, value)),
        ("if", _) => !fits(wanted, value) || fits(&rules["then"], value),
        ("minimum", Value::Number(_)) => value.as_f64() >= wanted.as_f64(),
        ("maximum", Value::Number(_)) => value.as_f64() <= wanted.as_f64(),
        ("exclusiveMinimum", Value::Number(_)) => value.as_f64() > wanted.as_f64(),
        ("items", Value::Array(items)) => items.iter().all(|item| fits(wanted, item)),
        ("minItems", Value::Array(items)) => items.len() as u64 >= wanted.as_u64().unwrap(),
        ("maxItems", Value::Array(items)) => items.len() as u64 <= wanted.as_u64().unwrap(),
        ("required", Value::Object(table)) => {
            all(wanted).all(|key| table.contains_key(key.as_str().unwrap()))
        }
        ("properties", Value::Object(table)) => table
            .iter()
            .all(|(key, value)| wanted.get(key).is_none_or(|schema| fits(schema, value))),
        ("additionalProperties", Value::Object(table)) => {
            let known = &rules["properties"];
            *wanted == json!(false) && table.keys().all(|key| known.get(key).is_some())
        }
        ("$schema" | "title" | "description" | "then", _) => true,
        (
            "minimum"
            | "maximum"
            | "exclusiveMinimum"
            | "items"
            | "minItems"
            | "maxItems"
            | "required"
            | "properties"
            | "additionalProperties",
            _,
        ) => true,
        (rule, _) => panic!("a rule {rule}"),
    };
    rules.iter().all(|(rule, wanted)| holds(rule, wanted))
}

fn all(list: &Value) -> impl Iterator<Item = &Value> {
    list.as_array().unwrap().iter()
}

/// A scene file as the values that it has.
fn values(text: &str) -> Value {
    let table: toml::Table = toml::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    serde_json::to_value(table).unwrap()
}

#[test]
fn what_is_read_fits() {
    let schema = schema();
    let builtin = builtin_scenes().iter().map(|scene| scene.text);
    let others = [
        BOX,
        FLUID,
        "",
        "spheres = { file = \"state.csv\" }",
        "precision = \"dd\"\nperiodic = { lower = [0, 0, 0], upper = [1, 2, 3.5] }",
        "[[analyse]]\nkind = \"structure-factor\"\nrange = [0, 4]\nspecies = [1, 2]",
        "[[surroundings]]\nshape = \"annulus\"\ncenter = [0, 0, 0]\naxis = [0, 0, 1]\ninner = 0\nouter = 2",
        "[[surroundings]]\nshape = \"heightfield\"\nspacing = [1, 2]\nfile = \"a.png\"\nrange = [0, 1]",
    ];
    for text in builtin.chain(others) {
        assert!(fits(&schema, &values(text)), "{text}");
        SceneFile::parse("it", text).unwrap();
    }
}

#[test]
fn what_is_a_mistake_does_not_fit() {
    let schema = schema();
    let ball = "[[spheres]]\nposition = [0, 0, 0]\nradius = 0.5\n";
    assert!(fits(&schema, &values(ball)));
    for mistake in [
        "gravty = [0, 0, -1]",
        "gravity = [0, 0]",
        "gravity = -9.81",
        "duration = \"1\"",
        "duration = 0",
        "seed = -1",
        "seed = 1.5",
        "precision = \"f16\"",
        "engine = \"evented\"",
        "encounters = true",
        "periodic = \"box\"",
        "periodic = { lower = [0, 0, 0] }",
        "spheres = 3",
        "surface = { kind = \"sticky\" }",
        "stepped = { dt = -1.0 }",
        "stepped = { integrator = \"verlet\" }",
        "record = { file = 3 }",
        "snapshot = { wall = 0 }",
        "series = { columns = \"energy\" }",
        "analyse = [{ bins = 5 }]",
        "analyse = [{ kind = \"bond-order\", bins = 0 }]",
        "inlet = [{ rate = 0 }]",
        "spheres = [{ colour = 1 }]",
        "spheres = [{ radius = -0.5 }]",
        "spheres = [{ radius = [0.5] }]",
        "spheres = [{ count = 0 }]",
        "spheres = [{ arrangement = \"hcp\" }]",
        "surroundings = [{ point = [0, 0, 0] }]",
        "surroundings = [{ shape = \"plain\" }]",
        "surroundings = [{ shape = \"plane\", radius = 1 }]",
        "surroundings = [{ shape = \"sphere\", inside = 1 }]",
        "surroundings = [{ shape = \"mesh\", vertices = [[0, 0]] }]",
        "surroundings = [{ shape = \"box\", rotation = { axis = [0, 0, 1] } }]",
        "surroundings = [{ shape = \"box\", copies = [{ count = 2 }] }]",
    ] {
        assert!(!fits(&schema, &values(mistake)), "{mistake}");
    }
}

/// Visits each table of a schema: its keys, and a file with a key in it that means nothing.
fn tables(
    schema: &Value,
    file: &dyn Fn(&str) -> String,
    visit: &mut dyn FnMut(&Map<String, Value>, String),
) {
    if let Some(Value::Object(keys)) = schema.get("properties") {
        visit(keys, file("{ nonsense = 1 }"));
        for (key, own) in keys {
            tables(own, &|value| file(&format!("{{ {key} = {value} }}")), visit);
        }
    }
    if let Some(items) = schema.get("items") {
        tables(items, &|value| file(&format!("[{value}]")), visit);
    }
    for choice in schema.get("anyOf").and_then(Value::as_array).into_iter().flatten() {
        tables(choice, file, visit);
    }
}

/// Of each table the reader names the keys that it knows, in the message about another one.
#[test]
fn it_has_the_keys_that_are_read() {
    let mut count = 0;
    let top = |value: &str| value.trim().trim_start_matches('{').trim_end_matches('}').to_owned();
    tables(&schema(), &top, &mut |keys, file| {
        count += 1;
        let message = SceneFile::parse("it", &file).unwrap_err().to_string();
        let (_, known) = message.split_once("known are").unwrap_or_else(|| panic!("{message}"));
        let read: BTreeSet<&str> = known.split('`').skip(1).step_by(2).collect();
        let there: BTreeSet<&str> = keys.keys().map(String::as_str).collect();
        assert_eq!(there, read, "{file}");
        for (key, schema) in keys {
            assert!(schema["description"].as_str().is_some_and(|it| it.len() > 8), "{file}: {key}");
        }
    });
    // The file, nine tables, and those of spheres in both ways, a rotation and copies.
    assert_eq!(count, 14);
}

#[test]
fn a_schema_is_of_no_scene() {
    let message = Folder::with("").says("scenes superball --schema").fails_with(2);
    assert!(message.contains("--schema"), "{message}");
}
