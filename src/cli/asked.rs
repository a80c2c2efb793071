//! Asked: a file that a run writes again and again on its way, by options or by the
//! scene.

use std::path::PathBuf;

use carom::scene::{SceneFile, Written};

use super::failure::Failure;

/// The most times that something is written on the way.
const MOST_TIMES: f64 = 1e7;

/// A file to write, and how often.
#[derive(Clone, Debug)]
pub struct Asked {
    pub path: PathBuf,
    pub every: f64,
    /// Whether an option names the file, not the scene.
    pub is_option: bool,
}

/// What a person calls the things that are asked for.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// Many of them.
    pub things: &'static str,
    /// The option of the file. Its time has the same name with `-every`.
    pub option: &'static str,
    /// The table of the scene.
    pub table: &'static str,
}

impl Asked {
    /// What the options ask, and in their place the scene; `None` if neither does.
    pub fn of(
        words: Words,
        (path, every): (Option<&PathBuf>, Option<f64>),
        scene: Written,
        duration: f64,
    ) -> Result<Option<Self>, Failure> {
        let Words { things, option, table } = words;
        let is_option = path.is_some();
        let (path, every) = match (path.cloned().or(scene.file), every.or(scene.every)) {
            (None, None) => return Ok(None),
            (Some(path), Some(every)) => (path, every),
            (path, _) => {
                let missing = if path.is_none() { "file" } else { "time between them" };
                return Err(Failure::Argument(format!(
                    "{things} are asked for, but no {missing}; give {option} FILE and \
                     {option}-every TIME, or `file` and `every` under [{table}]"
                )));
            }
        };
        let times = duration / every;
        if times > MOST_TIMES {
            return Err(Failure::Argument(format!(
                "{things} every {every:?} would be {times:.1e} until {duration:?}, more than \
                 {MOST_TIMES:e}; take a longer time between them ({option}-every)"
            )));
        }
        Ok(Some(Self { path, every, is_option }))
    }

    /// The failure that the file's name makes.
    pub fn refused(&self, words: Words, file: &SceneFile, wanted: &str) -> Failure {
        let path = self.path.display();
        if self.is_option {
            return Failure::Argument(format!("{} is {path}; {wanted}", words.option));
        }
        let found = format!("{:?}", path.to_string());
        file.mistake(&format!("{}.file", words.table), &found, wanted).into()
    }
}
