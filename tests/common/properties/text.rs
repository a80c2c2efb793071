//! Text: whatever stands in a scene file, it is a scene or one clear error.

use carom::engine::Compiled;
use carom::scene::{Precision, Scene, SceneError, SceneFile};
use toml::Value;

use super::builder::moves_a_little;
use super::{Outcome, check_message};

/// More bodies than this are legal, and take their time.
const MOST_BODIES: u64 = 100;

/// Bytes as the text of a scene file: read, checked, built in its precision, and moved
/// a little.
pub fn text(bytes: &[u8]) -> Outcome {
    let Ok(text) = core::str::from_utf8(bytes) else { return Outcome::Refused };
    let file = match SceneFile::parse("fuzz", text) {
        Ok(file) => file,
        Err(error) => {
            check_message(&error.to_string());
            return Outcome::Refused;
        }
    };
    // Other files are no part of the input.
    if !file.state_files().is_empty() || bodies_asked(text) > MOST_BODIES {
        return Outcome::Refused;
    }
    match file.precision {
        Precision::F32 => built(file.build::<f32>()),
        _ => built(file.build::<f64>()),
    }
}

fn built<T: Compiled>(scene: Result<Scene<T>, SceneError>) -> Outcome {
    match scene {
        Ok(scene) => moves_a_little(scene),
        Err(error) => {
            check_message(&error.to_string());
            Outcome::Refused
        }
    }
}

/// The counts of all groups together.
fn bodies_asked(text: &str) -> u64 {
    let Ok(table) = text.parse::<toml::Table>() else { return 0 };
    let entries = match table.get("spheres") {
        Some(Value::Array(entries)) => entries.as_slice(),
        Some(entry) => core::slice::from_ref(entry),
        None => &[],
    };
    let counts = entries.iter().map(|entry| match entry.get("count") {
        Some(Value::Integer(count)) => u64::try_from(*count).unwrap_or(0),
        _ => 1,
    });
    counts.fold(0, u64::saturating_add)
}
