//! Lines: where in the text of a scene file a key is. The text is parsed a second
//! time, with the spans of its keys.

use core::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::Problem;

/// What is wrong with a text that does not deserialise: the key, the line, and
/// the message of the TOML library in this crate's words.
pub(super) fn explained(text: &str, error: &toml::de::Error) -> (String, Option<usize>, Problem) {
    let span = error.span();
    let line = span.as_ref().map(|span| line_at(text, span.start));
    match DeTable::parse(text) {
        Err(_) => (String::new(), line, Problem::Syntax(error.message().into())),
        Ok(root) => {
            let mut key = String::new();
            if let Some(span) = span {
                find_key(root.get_ref(), "", &span, &mut key);
            }
            (key, line, reworded(error.message()))
        }
    }
}

/// The line, from 1, of the value of a key path, or of what encloses it.
pub(super) fn line_of(text: &str, path: &str) -> Option<usize> {
    offset_of(text, path).map(|offset| line_at(text, offset))
}

/// What serde says, in the form that all problems have.
pub(super) fn reworded(message: &str) -> Problem {
    let (found, expected) = message.split_once(", expected ").unwrap_or((message, ""));
    if found.starts_with("unknown field") {
        let known = expected.trim_start_matches("one of ").to_owned();
        return Problem::UnknownKey { known };
    }
    let found = [
        ("invalid type: ", ""),
        ("invalid value: ", ""),
        ("unknown variant ", ""),
        ("invalid length ", "an array of length "),
    ]
    .iter()
    .find_map(|(theirs, ours)| Some(format!("{ours}{}", found.strip_prefix(theirs)?)))
    .unwrap_or_else(|| found.to_owned());
    let wanted = if expected.is_empty() {
        "see `carom scenes rough-gas` for an example".to_owned()
    } else {
        format!("it must be {expected}")
    };
    Problem::Value { found, wanted }
}

/// The line, from 1, that a byte is on.
fn line_at(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|byte| *byte == b'\n').count()
}

/// The byte where the value of a key path, or what encloses it, starts; `None`
/// where not even the first part is there.
fn offset_of(text: &str, path: &str) -> Option<usize> {
    let root = DeTable::parse(text).ok()?;
    let mut table = root.get_ref();
    let mut offset = None;
    for part in path.split('.') {
        let (name, index) = match part.split_once('[') {
            Some((name, rest)) => (name, rest.trim_end_matches(']').parse::<usize>().ok()),
            None => (part, None),
        };
        let Some((key, value)) = table.get_key_value(name) else {
            return offset;
        };
        offset = Some(key.span().start);
        let mut value: &Spanned<DeValue<'_>> = value;
        if let Some(index) = index {
            let Some(element) = value.get_ref().as_array().and_then(|array| array.get(index))
            else {
                return offset;
            };
            value = element;
            offset = Some(value.span().start);
        }
        match value.get_ref().as_table() {
            Some(inner) => table = inner,
            None => return offset,
        }
    }
    offset
}

/// Writes to `found` the path of the innermost key or value at a span.
fn find_key(table: &DeTable<'_>, prefix: &str, span: &Range<usize>, found: &mut String) {
    for (key, value) in table.iter() {
        let name: &str = key.get_ref();
        let path = if prefix.is_empty() { name.to_owned() } else { format!("{prefix}.{name}") };
        if key.span().contains(&span.start) {
            found.clone_from(&path);
        }
        find_value(value, path, span, found);
    }
}

fn find_value(value: &Spanned<DeValue<'_>>, path: String, span: &Range<usize>, found: &mut String) {
    if value.span().contains(&span.start) {
        found.clone_from(&path);
    }
    match value.get_ref() {
        DeValue::Table(table) => find_key(table, &path, span, found),
        DeValue::Array(array) => {
            for (index, element) in array.iter().enumerate() {
                find_value(element, format!("{path}[{index}]"), span, found);
            }
        }
        _ => {}
    }
}
