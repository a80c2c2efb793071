//! Origin: where the values of a scene come from, so that an error can say it.
//!
//! A value is known by its key path (`spheres[2].radius`). The lines of a file
//! ([`super::lines`]) are only looked up when there is an error to report.

use std::sync::Arc;

use super::error::{Keyed, Place, Problem, SceneError};
#[cfg(feature = "files")]
use super::lines::{explained, line_of};

/// Where the values of a scene come from.
#[derive(Clone, Debug)]
pub(super) struct Origin {
    /// The file, or the name of the scene.
    scene: String,
    /// The text of the file; `None` for a scene built in code.
    text: Option<Arc<str>>,
    /// Key paths whose values came from an option of the program.
    options: Vec<(String, String)>,
}

impl Origin {
    /// A scene built in code.
    pub(super) fn code(scene: &str) -> Self {
        Self { scene: scene.to_owned(), text: None, options: Vec::new() }
    }

    /// Whether there is a file.
    pub(super) fn is_file(&self) -> bool {
        self.text.is_some()
    }

    /// The error that a problem with the value of a key makes.
    pub(super) fn error(&self, key: impl Into<String>, problem: Problem) -> SceneError {
        let key = key.into();
        let mut options = self.options.iter().filter(|(path, _)| is_within(&key, path));
        let option = options.next_back().map(|(_, option)| option.clone());
        let line = match (&self.text, &option) {
            (Some(text), None) => line_of(text, &key),
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

    fn error_at(
        &self,
        key: String,
        line: Option<usize>,
        option: Option<String>,
        problem: Problem,
    ) -> SceneError {
        let place = Place { scene: self.scene.clone(), line, key, option };
        SceneError { place: Box::new(place), problem: Box::new(problem) }
    }
}

#[cfg(feature = "files")]
impl Origin {
    /// A scene file.
    pub(super) fn file(scene: &str, text: Arc<str>) -> Self {
        Self { scene: scene.to_owned(), text: Some(text), options: Vec::new() }
    }

    /// Notes that an option of the program gave the value of a key.
    pub(super) fn overridden(&mut self, key: &str, option: impl Into<String>) {
        self.options.push((key.to_owned(), option.into()));
    }

    /// The error that an assignment of the program's option `--set` makes.
    pub(super) fn set_error(&self, key: &str, problem: Problem) -> SceneError {
        self.error_at(key.to_owned(), None, Some(set_option(key)), problem)
    }

    /// The error that the TOML library reports, in this crate's words.
    pub(super) fn toml_error(&self, error: &toml::de::Error) -> SceneError {
        let text = self.text.as_deref().unwrap_or("");
        let (key, line, problem) = explained(text, error);
        self.error_at(key, line, None, problem)
    }
}

/// The option that sets a key.
#[cfg(feature = "files")]
pub(super) fn set_option(key: &str) -> String {
    format!("--set {key}").trim_end().to_owned()
}

/// Whether a key path is another one or leads on from it.
fn is_within(key: &str, outer: &str) -> bool {
    let rest = key.strip_prefix(outer);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Without the feature `files` there is no text to have lines.
#[cfg(not(feature = "files"))]
fn line_of(_: &str, _: &str) -> Option<usize> {
    None
}
