//! Assignments: values that are put in the place of a scene file's before it is
//! read as a scene, as `--set spheres[0].radius=0.4` does.

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::error::Problem;
use super::lines::reworded;

/// A key path of the file and the value that it gets.
#[derive(Clone, Debug)]
pub(super) struct Assignment {
    /// As it was given.
    key: String,
    path: Vec<Part>,
    value: String,
}

/// One step on the way from the top of the file to a value.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Key(String),
    Index(usize),
}

/// Why a text is no scene.
pub(super) enum Refused {
    /// By itself.
    Text(toml::de::Error),
    /// Because of the value that an assignment gives this key.
    Assignment(String, Problem),
}

/// What the entries of spheres stand under.
const SPHERES: &str = "spheres";

impl Assignment {
    /// Reads `KEY=VALUE`.
    pub(super) fn parse(text: &str) -> Result<Self, Problem> {
        let wanted = "it must be KEY=VALUE, as in spheres[0].radius=0.4 or surface.kind=rough";
        let mistake = || Problem::value(text, wanted);
        let (key, value) = text.split_once('=').ok_or_else(mistake)?;
        let (key, value) = (key.trim(), value.trim());
        let path = parts(key).ok_or_else(mistake)?;
        if value.is_empty() {
            return Err(mistake());
        }
        Ok(Self { key: key.to_owned(), path, value: value.to_owned() })
    }

    /// The key path.
    pub(super) fn key(&self) -> &str {
        &self.key
    }

    /// Whether it is about the entries of spheres.
    pub(super) fn is_of_spheres(&self) -> bool {
        matches!(self.path.first(), Some(Part::Key(key)) if key == SPHERES)
    }

    /// The entry of spheres that it changes, if it is one.
    pub(super) fn entry(&self) -> Option<usize> {
        match self.path.get(1) {
            Some(Part::Index(index)) if self.is_of_spheres() => Some(*index),
            _ => None,
        }
    }

    /// The same for a text that lacks the first entries of spheres.
    pub(super) fn after(&self, entries: usize) -> Self {
        let mut path = self.path.clone();
        if let Some(Part::Index(index)) = path.get_mut(1) {
            *index -= entries;
        }
        Self { path, ..self.clone() }
    }

    /// Puts the value into a file.
    fn apply<'a>(&'a self, root: &mut DeTable<'a>) -> Result<(), Problem> {
        // What is no TOML is a word, so that a shell's quotes need no others inside.
        let value = DeValue::parse(&self.value)
            .unwrap_or_else(|_| unlocated(DeValue::String(self.value.as_str().into())));
        let Some((Part::Key(first), mut rest)) = self.path.split_first() else { return Ok(()) };
        if rest.is_empty() {
            root.insert(unlocated(first.as_str().into()), value);
            return Ok(());
        }
        let mut place = table_entry(root, first);
        if first == SPHERES && rest.first() == Some(&Part::Index(0)) && place.get_ref().is_table() {
            // The only entry may stand without the brackets of a list.
            rest = &rest[1..];
        }
        for part in rest {
            place = match (part, place.get_mut()) {
                (Part::Key(key), DeValue::Table(table)) => table_entry(table, key),
                (Part::Key(key), other) => {
                    let wanted = format!("only a table has a key `{key}`");
                    return Err(Problem::Value { found: format!("in a {}", kind(other)), wanted });
                }
                (Part::Index(index), DeValue::Array(array)) => {
                    let length = array.len();
                    array.get_mut(*index).ok_or_else(|| Problem::Value {
                        found: "beyond the end of its list".to_owned(),
                        wanted: format!("entries are counted from 0, and there are {length}"),
                    })?
                }
                (Part::Index(index), other) => {
                    let wanted = format!("only a list has an entry [{index}]");
                    return Err(Problem::Value { found: format!("in a {}", kind(other)), wanted });
                }
            };
        }
        *place = value;
        Ok(())
    }
}

/// What is wrong with the assignments of a text, if one of them is: the first that
/// makes it no scene.
pub(super) fn read<T: DeserializeOwned>(text: &str, set: &[Assignment]) -> Result<T, Refused> {
    if set.is_empty() {
        return toml::from_str(text).map_err(Refused::Text);
    }
    let root = DeTable::parse(text).map_err(Refused::Text)?;
    let whole = applied(root.clone(), set);
    whole.or_else(|refused| {
        // A mistake of the text's own is found with its line.
        toml::from_str::<T>(text).map_err(Refused::Text)?;
        let earlier = (1..set.len()).map(|count| applied::<T>(root.clone(), &set[..count]));
        Err(earlier.filter_map(Result::err).next().unwrap_or(refused))
    })
}

/// A text with assignments; the last one is blamed.
fn applied<'a, T: DeserializeOwned>(
    mut root: Spanned<DeTable<'a>>,
    set: &'a [Assignment],
) -> Result<T, Refused> {
    for assignment in set {
        let blame = |problem| Refused::Assignment(assignment.key.clone(), problem);
        assignment.apply(root.get_mut()).map_err(blame)?;
    }
    T::deserialize(Deserializer::from(root)).map_err(|error| {
        let last = set.last().map_or("", Assignment::key);
        Refused::Assignment(last.to_owned(), reworded(error.message()))
    })
}

/// The value of a key; an empty table where there was none.
fn table_entry<'t, 'a>(table: &'t mut DeTable<'a>, key: &'a str) -> &'t mut Spanned<DeValue<'a>> {
    let empty = || unlocated(DeValue::Table(DeTable::new()));
    table.entry(unlocated(key.into())).or_insert_with(empty)
}

/// What a value is, in words.
fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::Array(_) => "list",
        DeValue::Table(_) => "table",
        DeValue::String(_) => "text",
        _ => "single value",
    }
}

/// What stands in no text.
fn unlocated<T>(value: T) -> Spanned<T> {
    Spanned::new(0..0, value)
}

/// The parts of a key path as `spheres[0].radius`.
fn parts(key: &str) -> Option<Vec<Part>> {
    let mut parts = Vec::new();
    for piece in key.split('.') {
        let (name, mut rest) = piece.split_at(piece.find('[').unwrap_or(piece.len()));
        let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || !name.chars().all(is_bare) {
            return None;
        }
        parts.push(Part::Key(name.to_owned()));
        while !rest.is_empty() {
            let (index, after) = rest.strip_prefix('[')?.split_once(']')?;
            parts.push(Part::Index(index.parse().ok()?));
            rest = after;
        }
    }
    Some(parts)
}
