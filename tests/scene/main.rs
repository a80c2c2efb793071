//! Scene files and builders, from the outside.

mod assignments;
mod dilated;
mod made;
mod mistakes;

use carom::scene::{Buildable, SceneError, SceneFile};

/// A scene with a stepped engine, and more text behind it.
fn file(text: &str) -> Result<SceneFile, SceneError> {
    SceneFile::parse("s.toml", &format!("stepped = {{ dt = 0.1 }}\n{text}"))
}

/// The message that a scene in `f64` gets; the text starts on line 2.
#[track_caller]
fn message(text: &str) -> String {
    message_in::<f64>(text)
}

#[track_caller]
fn message_in<T: Buildable>(text: &str) -> String {
    let error = file(text).and_then(|file| file.build::<T>()).map(|_| ()).unwrap_err();
    let message = error.to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

const BALL: &str = "[[spheres]]\nposition = [0, 0, 0]\nradius = 1\n";

/// The message to one more key of a sphere, which stands on line 5.
#[track_caller]
fn ball_message(key: &str) -> String {
    message(&format!("{BALL}{key}\n"))
}

/// The message to a group with these keys, the first of them on line 3.
#[track_caller]
fn group_message(keys: &str) -> String {
    message(&format!("[[spheres]]\n{keys}\n"))
}

#[track_caller]
fn assert_starts(message: &str, start: &str) {
    assert!(message.starts_with(start), "{message:?} does not start with {start:?}");
}
