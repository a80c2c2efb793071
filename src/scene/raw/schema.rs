//! The schema of the scene file, for editors: what is read here, as a JSON Schema.
//!
//! Tables and names are derived; what has a reader of its own has its schema here, or in
//! `surroundings/schema.rs`.

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::Value;

use super::{Number, RawBounds, RawPeriodic, RawScene, RawSpheres, Spread, Vector, Whole};

/// The JSON Schema (draft 2020-12) of the scene file, by which an editor checks and completes
/// one.
///
/// ```
/// let schema = carom::scene::scene_schema();
/// assert!(schema.contains("\"gravity\""));
/// ```
#[must_use]
pub fn scene_schema() -> String {
    let settings =
        SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true);
    let mut schema = settings.into_generator().into_root_schema_for::<RawScene>().to_value();
    tidy(&mut schema);
    schema["title"] = "Scene of carom".into();
    schema["description"] = "docs/scene-file.md of carom says more.".into();
    format!("{schema:#}")
}

/// Takes out what TOML has no word for, and what documents of a program have beside a sentence.
fn tidy(schema: &mut Value) {
    match schema {
        Value::Object(keys) => {
            // A key that is left out is null in Rust, and cannot be so in a file.
            keys.retain(|key, value| key != "default" && (key != "format" || value.is_object()));
            if let Some(Value::Array(types)) = keys.get_mut("type") {
                types.retain(|name| name != "null");
                if let [only] = &types[..] {
                    keys["type"] = only.clone();
                }
            }
            if let Some(Value::Array(names)) = keys.get_mut("enum") {
                names.retain(|name| !name.is_null());
            }
            if let Some(Value::Array(choices)) = keys.get_mut("anyOf") {
                choices.retain(|choice| *choice != serde_json::json!({ "type": "null" }));
                if let [Value::Object(only)] = &mut choices[..] {
                    let only = core::mem::take(only);
                    keys.remove("anyOf");
                    for (key, value) in only {
                        keys.entry(key).or_insert(value);
                    }
                }
            }
            if let Some(Value::String(words)) = keys.get_mut("description") {
                *words = plain(words);
            }
            keys.values_mut().for_each(tidy);
        }
        Value::Array(values) => values.iter_mut().for_each(tidy),
        _ => {}
    }
}

/// The first paragraph of a document, without its links and line ends.
fn plain(words: &str) -> String {
    let first = words.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    let mut plain = String::new();
    let mut rest = first.as_str();
    while let Some((before, link)) = rest.split_once('[') {
        let Some((name, after)) = link.split_once(']') else { break };
        plain += before;
        match after.strip_prefix('(').and_then(|target| target.split_once(')')) {
            Some((_, behind)) => (plain += name, rest = behind).1,
            // What is code is a link; all else stands in brackets.
            None if name.starts_with('`') => (plain += name, rest = after).1,
            None => (plain += &format!("[{name}]"), rest = after).1,
        }
    }
    (plain + rest).replace('`', "")
}

/// A schema that is written out where it is used.
macro_rules! written_out {
    ($type:ident, $generator:ident => $schema:expr) => {
        impl JsonSchema for $type {
            fn schema_name() -> Cow<'static, str> {
                stringify!($type).into()
            }

            fn inline_schema() -> bool {
                true
            }

            fn json_schema($generator: &mut SchemaGenerator) -> Schema {
                $schema
            }
        }
    };
}

written_out!(Number, _generator => json_schema!({ "type": "number" }));

written_out!(Whole, _generator => json_schema!({ "type": "integer", "minimum": 0 }));

written_out!(Vector, _generator => list_of_numbers(3));

written_out!(Spread, _generator => json_schema!({
    "anyOf": [
        { "type": "number", "exclusiveMinimum": 0 },
        {
            "type": "array",
            "items": { "type": "number", "exclusiveMinimum": 0 },
            "minItems": 2,
            "maxItems": 2,
        },
    ],
}));

written_out!(RawPeriodic, generator => json_schema!({
    "anyOf": [{ "const": "cube" }, generator.subschema_for::<RawBounds>()],
}));

/// So many numbers.
pub(super) fn list_of_numbers(count: usize) -> Schema {
    json_schema!({
        "type": "array",
        "items": { "type": "number" },
        "minItems": count,
        "maxItems": count,
    })
}

/// `[[spheres]]`, or `spheres = { … }`.
pub(super) fn entries_schema(generator: &mut SchemaGenerator) -> Schema {
    let entry = generator.subschema_for::<RawSpheres>();
    json_schema!({ "anyOf": [{ "type": "array", "items": entry }, entry] })
}

/// How far an analysis goes.
pub(super) fn range_schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "anyOf": [{ "type": "number", "exclusiveMinimum": 0 }, list_of_numbers(2)] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_lose_their_links() {
        assert_eq!(plain("[`Rough`](super::Rough): a\nb\n\n```\nc"), "Rough: a b");
        assert_eq!(
            plain("See [this](there), or a table [stepped]."),
            "See this, or a table [stepped]."
        );
        assert_eq!(plain("[`VelocityVerlet`]: exact"), "VelocityVerlet: exact");
        assert_eq!(plain("a [half"), "a [half");
    }
}
