//! Kept: a run in a file that it can go on from.

use core::time::Duration;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use carom::bodies::Bodies;
use carom::engine::{Snapshot, World};
use carom::observe::state_hash;
use carom::output::{WholeFile, sealed, unsealed};
use carom::real::Real;
use carom::scene::{SceneFile, SceneSource};
use carom::study::{Course, Schedule};
use serde::{Deserialize, Serialize};

use super::analyses::KeptAnalysis;
use super::arguments::RunArguments;
use super::events::{KeptEvents, shown};
use super::failure::Failure;
use super::interrupt;
use super::measured::Measured;
use super::output_file::{Destination, OutputError};
use super::recording::KeptFrames;
use super::series::KeptSeries;

/// All that a run has to remember.
#[derive(Debug, Serialize, Deserialize)]
pub struct Kept {
    pub source: SceneSource,
    /// The hash of the bodies at the start.
    start: u64,
    /// The time that it is at.
    pub time: f64,
    pub snapshot: Snapshot,
    pub notes: Notes,
}

/// What the program remembers besides the world.
#[derive(Debug, Serialize, Deserialize)]
pub struct Notes {
    /// How far the run was to go, in steps or in time.
    pub length: f64,
    pub measured: Measured,
    /// The boxes of a periodic space that bodies have moved through.
    pub images: Option<Vec<[i32; 3]>>,
    pub events: Option<KeptEvents>,
    pub record: Option<KeptFrames>,
    pub series: Option<KeptSeries>,
    pub analyses: Vec<KeptAnalysis>,
}

impl Kept {
    /// Reads a kept run.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let refused = |reason: String| Failure::Resume { path: path.into(), reason };
        let bytes =
            fs::read(path).map_err(|error| refused(format!("it cannot be read: {error}")))?;
        unsealed(&bytes).map_err(|error| refused(format!("it {error}")))
    }

    /// Whether it is of a scene that starts with these bodies, as the scene was when the
    /// run began.
    pub fn check_start<T: Real>(&self, bodies: &Bodies<T>, path: &Path) -> Result<(), Failure> {
        if state_hash(bodies).0 == self.start {
            return Ok(());
        }
        let reason = "its scene takes spheres from a state file that has changed since; put back \
                      what it was";
        Err(Failure::Resume { path: path.into(), reason: reason.to_owned() })
    }
}

/// Where and how often a run is to be kept.
#[derive(Debug)]
pub struct Keeping {
    pub path: PathBuf,
    every: Option<f64>,
    wall: Option<Duration>,
}

impl Keeping {
    /// What the options ask, and in their place the scene.
    pub fn of(arguments: &RunArguments, file: &SceneFile) -> Result<Option<Self>, Failure> {
        let scene = file.snapshot()?;
        let every = arguments.snapshot_every.or(scene.every);
        let wall = arguments.snapshot_wall.or(file.snapshot_wall()?);
        let Some(path) = arguments.snapshot.clone().or(scene.file) else {
            if every.is_none() && wall.is_none() {
                return Ok(None);
            }
            return Err(Failure::Argument(
                "snapshots are asked for, but no file; give --snapshot FILE, or `file` under \
                 [snapshot]"
                    .to_owned(),
            ));
        };
        let path = Destination::replaceable("--snapshot", &path)?;
        let wall = wall.and_then(|minutes| Duration::try_from_secs_f64(60.0 * minutes).ok());
        Ok(Some(Self { path, every, wall }))
    }

    /// Keeps a run from here on. `options` are what it needs again to go on.
    pub fn begin<T: Real>(self, file: &SceneFile, start: &Bodies<T>, options: String) -> Keeper {
        Keeper {
            path: self.path,
            every: self.every,
            schedule: None,
            wall: self.wall,
            last: Instant::now(),
            source: file.source(),
            start: state_hash(start).0,
            options,
        }
    }
}

/// Keeps a run under way.
#[derive(Debug)]
pub struct Keeper {
    path: PathBuf,
    every: Option<f64>,
    schedule: Option<Schedule>,
    wall: Option<Duration>,
    /// When it was kept last.
    last: Instant,
    source: SceneSource,
    start: u64,
    options: String,
}

impl Keeper {
    /// The run begins, or goes on, on a course.
    pub fn set_out<T: Real>(&mut self, world: &World<T>, course: &Course) {
        let position = Course::position(world);
        self.schedule = self.every.map(|every| {
            let mut schedule = Schedule::new(world, course, every);
            schedule.pass(position);
            schedule
        });
        self.last = Instant::now();
    }

    /// Where it is to be kept next.
    pub fn mark(&self) -> Option<f64> {
        self.schedule.as_ref().and_then(Schedule::mark)
    }

    /// Whether it is to be kept at a place.
    pub fn is_due(&self, position: f64) -> bool {
        self.mark().is_some_and(|mark| mark <= position)
            || self.wall.is_some_and(|wall| self.last.elapsed() >= wall)
            || interrupt::is_asked_to_keep()
    }

    /// Keeps the run. What was kept before stays until this is whole.
    pub fn keep<T: Real>(&mut self, world: &World<T>, notes: Notes) -> Result<(), OutputError> {
        let kept = Kept {
            source: self.source.clone(),
            start: self.start,
            time: world.time(),
            snapshot: world.snapshot(),
            notes,
        };
        let path = &self.path;
        let bytes =
            sealed(&kept).map_err(|reason| OutputError::Path { path: path.clone(), reason })?;
        let write = || {
            let mut file = WholeFile::beside(path)?;
            file.write_all(&bytes)?;
            file.finish()
        };
        write().map_err(|source| OutputError::Write { path: path.clone(), source })?;
        if let Some(schedule) = &mut self.schedule {
            schedule.pass(Course::position(world));
        }
        self.last = Instant::now();
        Ok(())
    }

    /// The end of a run that was asked to end and has been kept.
    pub fn ended(&self, time: f64, status: i32) -> Failure {
        let path = self.path.display();
        Failure::Kept {
            status: u8::try_from(status).unwrap_or(1),
            words: format!(
                "stopped at time {time:?}; {path} has the run, and this goes on with it: carom run \
                 --resume {path}{}",
                self.options
            ),
        }
    }
}

/// The options of a run that goes on, as they are typed.
pub fn options(arguments: &RunArguments) -> String {
    let named = [
        ("--events", &arguments.events),
        ("--record", &arguments.record),
        ("--series", &arguments.series),
        ("--state", &arguments.state),
        ("--snapshot", &arguments.snapshot),
    ];
    let times = [
        ("--events-from", arguments.events_from),
        ("--record-every", arguments.record_every),
        ("--series-every", arguments.series_every),
        ("--snapshot-every", arguments.snapshot_every),
        ("--snapshot-wall", arguments.snapshot_wall),
    ];
    let mut typed = String::new();
    for (option, path) in named {
        if let Some(path) = path {
            typed += &format!(" {option} {}", path.display());
        }
    }
    for (option, time) in times {
        if let Some(time) = time {
            typed += &format!(" {option} {time:?}");
        }
    }
    if let Some(every) = arguments.events_every {
        typed += &format!(" --events-every {every}");
    }
    if !arguments.events_of.is_empty() {
        let ranges: Vec<String> = arguments.events_of.iter().map(shown).collect();
        typed += &format!(" --events-of {}", ranges.join(","));
    }
    typed
}
