//! The program from outside: what it prints, what it writes, what it refuses.

mod analyses;
mod bad_input;
mod batch;
mod cases;
mod double_double;
mod ends;
mod event_driven;
mod files;
mod flow;
mod frames;
mod measured;
mod parquet;
mod picture;
mod schema;
mod series;
mod snapshots;
mod sound;
mod states;
mod streams;
mod study;
mod summary;
mod sweep;
mod view;

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// Twenty rough spheres of two kinds that fall about in a box.
const BOX: &str = r#"
duration = 2.0
gravity = [0.0, 0.0, -1.0]
seed = 3

[stepped]
dt = 0.01

[surface]
kind = "rough"

[[surroundings]]
shape = "box"
lower = [0.0, 0.0, 0.0]
upper = [4.0, 4.0, 4.0]
inside = true

[[spheres]]
position = [2.0, 2.0, 3.4]
radius = 0.5
mass = 3.0
spin = [1.0, 2.0, 3.0]

[[spheres]]
count = 19
arrangement = "random"
lower = [0.0, 0.0, 0.0]
upper = [4.0, 4.0, 2.8]
radius = 0.3
temperature = 1.0
"#;

/// A smooth fluid in a periodic box.
const FLUID: &str = r#"
duration = 1.0
periodic = "cube"

[stepped]
dt = 0.002

[[spheres]]
count = 256
arrangement = "fcc"
number_density = 0.5
radius = 0.5
temperature = 1.0
"#;

/// The program in a folder of its own.
struct Folder {
    folder: TempDir,
}

impl Folder {
    /// A folder with one scene file, `scene.toml`.
    fn with(scene: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), scene).unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// The names of all files, sorted.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The program, to be run in this folder.
    fn program<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carom"));
        command.current_dir(self.folder.path()).args(arguments);
        command
    }

    /// What the program with these arguments, separated by spaces, says.
    fn says(&self, arguments: &str) -> Said {
        Said::from(self.program(arguments.split_whitespace()).output().unwrap())
    }
}

/// What the program said.
#[derive(Debug)]
struct Said {
    status: Option<i32>,
    output: String,
    errors: String,
}

impl From<Output> for Said {
    fn from(output: Output) -> Self {
        Self {
            status: output.status.code(),
            output: String::from_utf8(output.stdout).unwrap(),
            errors: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

impl Said {
    /// What it printed, all being well.
    #[track_caller]
    fn well(self) -> String {
        assert_eq!((self.status, self.errors.as_str()), (Some(0), ""), "{self:?}");
        self.output
    }

    /// The summary it printed, all being well.
    #[track_caller]
    fn summary(self) -> serde_json::Value {
        serde_json::from_str(&self.well()).unwrap()
    }

    /// Its one message, with this exit status and nothing printed.
    #[track_caller]
    fn fails_with(self, status: i32) -> String {
        assert_eq!((self.status, self.output.as_str()), (Some(status), ""), "{self:?}");
        // On a slow machine there is a line before it about how long a run takes.
        let is_outlook = |line: &&str| line.contains("; a shorter --duration ");
        let message: String = self.errors.split_inclusive('\n').skip_while(is_outlook).collect();
        assert!(message.starts_with("error: "), "{self:?}");
        assert_eq!(message.matches("error: ").count(), 1, "{self:?}");
        assert!(!message.contains("panicked"), "{self:?}");
        message
    }
}

/// The rows of a file of comma-separated values, under their header.
fn rows(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows = reader
        .records()
        .map(|record| record.unwrap().iter().map(str::to_owned).collect())
        .collect();
    (header, rows)
}
