//! Errors: where a scene is wrong, what is wrong, and what would be right.

use core::fmt;
use std::io;

use thiserror::Error;

use crate::surroundings::Mistake;

/// Where a mistake is.
///
/// ```
/// use carom::{Scene, Sphere};
///
/// let error = Scene::<f64>::builder().sphere(Sphere::new([0.0; 3])).build().unwrap_err();
/// assert_eq!(error.place.key, "spheres[0].radius");
/// assert_eq!(error.place.line, None);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The file, or the name of the scene.
    pub scene: String,
    /// Line in the file, from 1.
    pub line: Option<usize>,
    /// The key, such as `spheres[2].radius`; empty where no key is to blame.
    pub key: String,
    /// The program's option that gave the value instead of the file.
    pub option: Option<String>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(option) = &self.option {
            return write!(f, "{option}");
        }
        write!(f, "{}", self.scene)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ":")?;
        if self.key.is_empty() { Ok(()) } else { write!(f, " {}", cut(&self.key)) }
    }
}

/// Why there is no scene.
///
/// ```
/// use carom::scene::SceneFile;
///
/// let text = "stepped.dt = 1e-3\n[[spheres]]\nposition = [0, 0, 0]\nradius = -0.5\n";
/// let file = SceneFile::parse("ball.toml", text)?;
/// let error = file.build::<f64>().unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "ball.toml:4: spheres[0].radius is -0.5; a radius must be finite and greater than 0"
/// );
/// # Ok::<(), carom::scene::SceneError>(())
/// ```
#[derive(Debug, Error)]
#[error("{place} {problem}")]
#[non_exhaustive]
pub struct SceneError {
    /// Where the mistake is.
    pub place: Box<Place>,
    /// What is wrong, and what would be right.
    #[source]
    pub problem: Box<Problem>,
}

/// What is wrong with a scene, and what would be right. It reads on from the
/// place.
///
/// ```
/// use carom::scene::Problem;
/// use carom::{Scene, Sphere};
///
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5);
/// let error = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(0.75)).build().unwrap_err();
/// assert!(matches!(*error.problem, Problem::Overlap { a: 0, b: 1, .. }));
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Problem {
    /// The file cannot be read.
    #[error("cannot be read: {0}; give the path of a scene file or the name of a built-in scene")]
    Unreadable(io::Error),
    /// The file is no text.
    #[error("is not text: byte {0} is not UTF-8; a scene file is TOML in UTF-8")]
    NotText(usize),
    /// The text is no TOML.
    #[error("not TOML: {0}")]
    Syntax(String),
    /// A key that means nothing here.
    #[error("is not a key that means something here; known are {known}")]
    UnknownKey {
        /// The keys that do.
        known: String,
    },
    /// A value that is of the wrong type or out of range.
    #[error("is {}; {wanted}", cut(found))]
    Value {
        /// What it is.
        found: String,
        /// What would be right.
        wanted: String,
    },
    /// A value that has to be there.
    #[error("is missing; {wanted}")]
    Missing {
        /// What would be right.
        wanted: String,
    },
    /// A value that has no meaning beside another.
    #[error("cannot stand beside {other}: {reason}")]
    Conflict {
        /// The other one.
        other: String,
        /// Why, and what would be right.
        reason: String,
    },
    /// Two spheres in the same place.
    #[error(
        "puts body {b} into body {a}: they overlap by {}; \
         spheres may touch at the start, not overlap",
        short(*depth)
    )]
    Overlap {
        /// The lesser index.
        a: usize,
        /// The greater index.
        b: usize,
        /// By how much they overlap, length.
        depth: f64,
    },
    /// A sphere where something fixed is, or outside of a box.
    #[error("puts body {body} {beyond}, by {}; {wanted}", short(*depth))]
    Misplaced {
        /// Its index.
        body: usize,
        /// Beyond what it is.
        beyond: String,
        /// How far, length.
        depth: f64,
        /// What would be right.
        wanted: &'static str,
    },
    /// A sphere that has no room to move between two faces.
    #[error(
        "does not fit: {what} body {body} no room in {direction}, along which it moves or is pulled; \
         there must be more than its diameter, {}, or neither velocity nor gravity in {direction}",
        short(*width)
    )]
    Wedged {
        /// What leaves it no room.
        what: String,
        /// Its index.
        body: usize,
        /// In which direction.
        direction: String,
        /// Its diameter, length.
        width: f64,
    },
    /// More spheres than there is room for.
    #[error("is {count}, for which there is no room: {reason}")]
    NoRoom {
        /// How many were asked for.
        count: u64,
        /// What is in the way, and what would be right.
        reason: String,
    },
    /// A scene that cannot have another number of bodies.
    #[error("cannot number {bodies}: {reason}")]
    Unscalable {
        /// How many were asked for.
        bodies: u64,
        /// What is in the way.
        reason: String,
    },
    /// A scene without bodies.
    #[error("the scene has no spheres; add at least one [[spheres]] entry")]
    Empty,
}

impl Problem {
    /// `found` where something else would be right.
    pub(super) fn value(found: impl fmt::Debug, wanted: impl Into<String>) -> Self {
        Self::Value { found: format!("{found:?}"), wanted: wanted.into() }
    }

    /// A value that has to be there.
    pub(super) fn missing(wanted: impl Into<String>) -> Self {
        Self::Missing { wanted: wanted.into() }
    }

    /// A value that has no meaning beside another.
    pub(super) fn conflict(other: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Conflict { other: other.into(), reason: reason.into() }
    }
}

impl From<Mistake> for Problem {
    fn from(Mistake { found, wanted, .. }: Mistake) -> Self {
        match found {
            Some(found) => Self::Value { found, wanted },
            None => Self::Missing { wanted },
        }
    }
}

/// A problem, and the key of its entry that is to blame.
pub(super) type Keyed = (&'static str, Problem);

impl From<Mistake> for Keyed {
    fn from(mistake: Mistake) -> Self {
        (mistake.key, mistake.into())
    }
}

/// A value in a message, cut if it is long.
fn cut(value: &str) -> String {
    /// The most characters.
    const LONGEST: usize = 200;
    match value.char_indices().nth(LONGEST) {
        None => value.to_owned(),
        Some((end, _)) => format!("{}…", &value[..end]),
    }
}

/// A length in a message, with the digits that a person reads.
fn short(length: f64) -> String {
    let rounded = format!("{length:.5e}").parse().unwrap_or(length);
    format!("{rounded:?}")
}
