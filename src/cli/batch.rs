//! `carom batch`: a scene many times with other seeds and values, as many at once as lanes
//! and threads take.

mod draw;
mod observed;
mod rows;

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use carom::engine::{Batch, BatchError, Compiled, Execution};
use carom::observe::{Energy, fall_energy, state_hash};
use carom::scene::{Precision, Scene, SceneFile};
use carom::study::table::{counted, grouped};
use carom::study::{Journal, Order, Point, StudyError, Subject};
use serde::{Deserialize, Serialize};

use super::arguments::{BatchArguments, SceneArguments};
use super::failure::Failure;
use super::outlook;
use super::output_file::{Destination, OutputFile};
use super::print;
use super::run::totals_at_start;
use super::scene_argument::scene_file;
use super::study::refuse_flow;
use super::study::watch::Teller;
use super::variation::{blamed, refuse_both, seeds, tell_passed_over, varied};
use draw::Varied;
use observed::{End, Observed};
use rows::{Row, Table};

/// Scenes at once, which a journal keeps as a whole: enough to fill lanes and threads many
/// times over.
const AT_ONCE: usize = 4096;

/// All that the scenes are made of.
struct Planned<'a> {
    base: SceneFile,
    arguments: &'a SceneArguments,
    varied: Varied,
    seeds: Vec<u64>,
    observed: Vec<Observed>,
    execution: Execution,
}

/// What came of the scenes of a point. The journal keeps it.
#[derive(Serialize, Deserialize)]
struct Finished {
    rows: Vec<Row>,
    /// How many of them were in lanes.
    in_lanes: usize,
}

/// Runs all scenes and writes their rows.
pub fn batch(arguments: &BatchArguments) -> Result<(), Failure> {
    let base = scene_file(&arguments.scene)?;
    refuse_flow(&base, "a batch")?;
    if base.precision == Precision::DoubleDouble {
        let reason = "the precision is dd, and a batch is in f32 or f64: there are no lanes of \
                      double-doubles; take one of these, or `carom sweep`";
        return Err(Failure::Argument(format!("{}: {reason}", base.name)));
    }
    let varied = Varied::parse(&arguments.vary)?;
    refuse_both(&arguments.scene, &varied.keys())?;
    refuse_unfit(&varied)?;
    let observed = arguments.observe.iter().map(|name| Observed::parse(name));
    let observed = observed.collect::<Result<Vec<_>, _>>()?;
    let seeds = seeds(&base, "--count", arguments.count)?;
    let execution = arguments.scene.execution();
    let planned = Planned { base, arguments: &arguments.scene, varied, seeds, observed, execution };
    let format = Format::of(&arguments.output)?;
    planned.check_first()?;
    tell_passed_over(&planned.base, "a batch", &[]);
    let opened = OutputFile::open(&arguments.output);
    let mut output = opened.map_err(|source| Failure::Open { option: "--output", source })?;

    let (journal, kept) = planned.journal(arguments)?;
    let teller = Teller::new(kept.as_deref().unwrap_or(&arguments.output));
    let scenes = 0..planned.seeds.len();
    let points = scenes.clone().step_by(AT_ONCE).map(|start| {
        let scenes = start..scenes.end.min(start + AT_ONCE);
        let key = format!("scenes {} to {}", scenes.start, scenes.end - 1);
        let planned = &planned;
        Point::new(key, scenes.len() as f64 * f64::MIN_POSITIVE, move || {
            match planned.base.precision {
                Precision::F32 => planned.run::<f32>(scenes.clone()),
                _ => planned.run::<f64>(scenes.clone()),
            }
        })
    });
    let points: Vec<_> = points.collect();
    let finished = Point::all(&points, &journal, Order::OneByOne, &teller)?;
    drop((teller, points, journal));

    let in_lanes: usize = finished.iter().map(|finished| finished.in_lanes).sum();
    let rows: Vec<Row> = finished.into_iter().flat_map(|finished| finished.rows).collect();
    let table = Table { keys: planned.varied.keys(), observed: &planned.observed, rows: &rows };
    let written = match format {
        Format::Rows => table.write_csv(&mut output),
        Format::Arrays => table.write_npz(&mut output),
        Format::Parquet => table.write_parquet(&mut output),
    };
    written.map_err(|error| output.error(error))?;
    output.finish()?;
    if let Some(kept) = kept {
        // What cannot be removed is of no harm: the next batch says what it is.
        let _ = std::fs::remove_file(kept);
    }
    planned.tell(&rows, in_lanes, &arguments.output)
}

/// Keys that every scene of a batch has in common.
fn refuse_unfit(varied: &Varied) -> Result<(), Failure> {
    for (key, why) in [
        ("precision", "all scenes of a batch are computed in one precision"),
        ("seed", "scene k has the scene file's seed plus k"),
        ("equilibrate", "the rows of a batch are those of whole runs"),
    ] {
        if varied.keys().contains(&key) {
            return Err(Failure::Argument(format!("--vary {key}: {why}; take `carom sweep`")));
        }
    }
    Ok(())
}

/// What the rows become.
#[derive(Clone, Copy)]
enum Format {
    /// Comma-separated values.
    Rows,
    /// Arrays of NumPy.
    Arrays,
    /// A table of Parquet.
    Parquet,
}

impl Format {
    /// By the ending of a path; devices and pipes take rows.
    fn of(path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().and_then(|ending| ending.to_str());
        match ending {
            Some("csv") => Ok(Self::Rows),
            Some("npz") => Ok(Self::Arrays),
            Some("parquet") => Ok(Self::Parquet),
            _ if !matches!(Destination::of(path), Ok(Destination::Regular(_))) => Ok(Self::Rows),
            _ => Err(Failure::Argument(format!(
                "--output is {}; it must end in .csv, .npz or .parquet",
                path.display()
            ))),
        }
    }
}

impl Planned<'_> {
    /// The file of a scene, with its seed and values.
    fn file(&self, scene: usize) -> Result<SceneFile, Failure> {
        let seed = self.seeds[scene];
        let values = self.varied.values(scene as u64, seed);
        let mut file = match values.is_empty() {
            true => self.base.clone(),
            false => varied(&self.base, self.arguments, &self.varied.keys(), &values)?,
        };
        file.seed = seed;
        Ok(file)
    }

    /// A scene, and its energy at the start and what its bodies can fall through.
    fn scene<T: Compiled>(&self, scene: usize) -> Result<(Scene<T>, Energy, f64), Failure> {
        let file = self.file(scene)?;
        let duration = file.run_duration()?;
        if file.equilibration(duration)? > 0.0 {
            let wanted = "the rows of a batch are those of whole runs; leave it out, or take `carom \
                          sweep`";
            return Err(file.mistake("equilibrate", "there", wanted).into());
        }
        let mut built = file.build::<T>()?;
        built.duration = Some(duration);
        outlook::check(&built, duration, self.execution)?;
        let before = totals_at_start(&built)?.energy;
        let fall = fall_energy(&built);
        Ok((built, before, fall))
    }

    /// Finds a mistake of the first scene, which is most likely one of all.
    fn check_first(&self) -> Result<(), Failure> {
        let checked = match self.base.precision {
            Precision::F32 => self.scene::<f32>(0).map(drop),
            _ => self.scene::<f64>(0).map(drop),
        };
        checked.map_err(|failure| match failure {
            Failure::Scene(error) => blamed(&error, &self.varied.keys()),
            other => other,
        })
    }

    /// The rows that are there, beside the output, and where that is; in memory if the output
    /// is no file.
    fn journal(&self, arguments: &BatchArguments) -> Result<(Journal, Option<PathBuf>), Failure> {
        let Ok(Destination::Regular(output)) = Destination::of(&arguments.output) else {
            return Ok((Journal::unwritten(), None));
        };
        let mut name = output.file_name().unwrap_or_default().to_owned();
        name.push(".points.jsonl");
        let path = output.with_file_name(name);
        if arguments.restart && path.exists() {
            let failed = |source| StudyError::File { path: path.clone(), source };
            std::fs::remove_file(&path).map_err(failed)?;
        }
        let options = (arguments.scene.engine, arguments.scene.precision.map(|p| p.to_string()));
        let asked = (&arguments.vary, &arguments.observe);
        let study = ("batch", Subject::of(&self.base), options, asked);
        Ok((Journal::open(&path, &study)?, Some(path)))
    }

    /// Runs some of the scenes.
    fn run<T: Compiled>(&self, scenes: Range<usize>) -> Result<Finished, StudyError> {
        let mut starts: Vec<OnceLock<Result<(Energy, f64), String>>> = Vec::new();
        starts.resize_with(scenes.len(), OnceLock::new);
        let made = Batch::<T>::made(scenes.len(), self.execution, |k| {
            // What is made a second time is the same.
            match self.scene(scenes.start + k) {
                Ok((scene, before, fall)) => {
                    let _ = starts[k].set(Ok((before, fall)));
                    Ok(scene)
                }
                Err(failure) => {
                    let text = failure.to_string();
                    let error = self.base.mistake("", "no scene with these values", &text);
                    let _ = starts[k].set(Err(text));
                    Err(error)
                }
            }
        });
        let mut batch = match made {
            Ok(batch) => Some(batch),
            Err(BatchError::Engine(error)) => return Err(error.into()),
            // None of them is a scene.
            Err(_) => None,
        };
        let mut energies = vec![None; scenes.len()];
        if let Some(batch) = &mut batch {
            batch.run();
            energies = batch.energies();
        }
        let mut rows = Vec::with_capacity(scenes.len());
        for (k, scene) in scenes.enumerate() {
            let start = starts[k].take().unwrap_or_else(|| Err("it was not made".to_owned()));
            let outcome = start.and_then(|start| {
                let batch = batch.as_ref().ok_or("it was not made")?;
                self.outcome(batch, k, start, energies[k])
            });
            let seed = self.seeds[scene];
            let row = Row { scene: scene as u64, seed, ..outcome.unwrap_or_else(Row::failed) };
            rows.push(Row { values: self.varied.values(scene as u64, seed), ..row });
        }
        Ok(Finished { in_lanes: batch.map_or(0, |batch| batch.in_lanes()), rows })
    }

    /// What came of a scene, or why nothing did.
    fn outcome<T: Compiled>(
        &self,
        batch: &Batch<T>,
        scene: usize,
        (before, fall): (Energy, f64),
        energy: Option<Energy>,
    ) -> Result<Row, String> {
        if let Some(fault) = batch.fault(scene) {
            return Err(fault.to_string());
        }
        let lost = || "its bodies are lost".to_owned();
        let energy = energy.ok_or_else(lost)?;
        let bodies = batch.bodies(scene).ok_or_else(lost)?;
        let collisions = batch.collisions_of(scene).unwrap_or_default();
        let end = End {
            time: batch.time(scene).unwrap_or_default(),
            steps: batch.steps(scene).unwrap_or_default(),
            energy,
            bodies: &bodies,
        };
        let energy_change = energy.relative_change(&before, fall);
        if !energy_change.is_finite() {
            return Err("the energy of all bodies is no longer finite".to_owned());
        }
        Ok(Row {
            state_hash: Some(state_hash(&bodies).to_string()),
            pairs: Some(collisions.pairs),
            surroundings: Some(collisions.surroundings),
            energy_change: Some(energy_change),
            observed: self.observed.iter().map(|observed| observed.of(&end)).collect(),
            ..Row::default()
        })
    }

    /// Says what was done; an error if a scene came to no end.
    fn tell(&self, rows: &[Row], in_lanes: usize, output: &Path) -> Result<(), Failure> {
        let collisions = rows.iter().filter_map(|row| Some(row.pairs? + row.surroundings?));
        let text = format!(
            "{}: {}, {} of them in lanes and the others one by one; {}\nTheir rows are in {}.\n",
            self.base.name,
            counted(rows.len() as u64, "scene"),
            grouped(in_lanes as u64),
            counted(collisions.sum(), "collision"),
            output.display()
        );
        if !matches!(Destination::of(output), Ok(Destination::StandardOutput)) {
            print(&text)?;
        }
        let failures: Vec<&Row> = rows.iter().filter(|row| row.failure.is_some()).collect();
        match failures.first() {
            None => Ok(()),
            Some(first) => Err(Failure::Runs {
                failed: failures.len(),
                runs: rows.len(),
                path: output.to_path_buf(),
                first: format!("scene {}: {}", first.scene, first.failure.as_deref().unwrap_or("")),
            }),
        }
    }
}
