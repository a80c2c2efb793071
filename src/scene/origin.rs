//! Origin: where the values of a scene come from, so that an error can say it.
//!
//! A value is known by its key path (`spheres[2].radius`). The lines of a file
//! are only looked up when there is an error to tell: the text is parsed once
//! more, with the spans of its keys.

use core::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Keyed, Place, Problem, SceneError};

/// Where the values of a scene come from.
#[derive(Clone, Debug)]
pub(super) struct Origin {
    /// The file, or the name of the scene.
    scene: String,
    /// The text of the file; `None` for a scene built in code.
    text: Option<Arc<str>>,
    /// Key paths whose values came from an option of the program.
    options: Vec<(&'static str, &'static str)>,
}

impl Origin {
    /// A scene built in code.
    pub(super) fn code(scene: &str) -> Self {
        Self { scene: scene.to_owned(), text: None, options: Vec::new() }
    }

    /// A scene file.
    pub(super) fn file(scene: &str, text: Arc<str>) -> Self {
        Self { scene: scene.to_owned(), text: Some(text), options: Vec::new() }
    }

    /// Whether there is a file.
    pub(super) fn is_file(&self) -> bool {
        self.text.is_some()
    }

    /// Notes that an option of the program gave the value of a key.
    pub(super) fn overridden(&mut self, key: &'static str, option: &'static str) {
        self.options.push((key, option));
    }

    /// The error that a problem with the value of a key makes.
    pub(super) fn error(&self, key: impl Into<String>, problem: Problem) -> SceneError {
        let key = key.into();
        let option = self.options.iter().find(|(path, _)| *path == key).map(|(_, option)| *option);
        let line = match (&self.text, option) {
            (Some(text), None) => offset_of(text, &key).map(|offset| line_at(text, offset)),
            _ => None,
        };
        self.error_at(key, line, option, problem)
    }

    /// The error that a problem with a key of an entry makes; an entry without a
    /// name is the scene.
    pub(super) fn error_in(&self, entry: &str, problem: impl Into<Keyed>) -> SceneError {
        let (key, problem) = problem.into();
        let dot = if entry.is_empty() || key.is_empty() { "" } else { "." };
        self.error(format!("{entry}{dot}{key}"), problem)
    }

    /// The error that the TOML library reports, in this crate's words.
    pub(super) fn toml_error(&self, error: &toml::de::Error) -> SceneError {
        let text = self.text.as_deref().unwrap_or("");
        let span = error.span();
        let line = span.as_ref().map(|span| line_at(text, span.start));
        match DeTable::parse(text) {
            Err(_) => {
                self.error_at(String::new(), line, None, Problem::Syntax(error.message().into()))
            }
            Ok(root) => {
                let mut key = String::new();
                if let Some(span) = span {
                    find_key(root.get_ref(), "", &span, &mut key);
                }
                self.error_at(key, line, None, reworded(error.message()))
            }
        }
    }

    fn error_at(
        &self,
        key: String,
        line: Option<usize>,
        option: Option<&'static str>,
        problem: Problem,
    ) -> SceneError {
        let place = Place { scene: self.scene.clone(), line, key, option };
        SceneError { place: Box::new(place), problem: Box::new(problem) }
    }
}

/// What serde says, in the form that all problems have.
fn reworded(message: &str) -> Problem {
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
