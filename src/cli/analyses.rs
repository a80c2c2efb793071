//! Analyses: what a run finds of its bodies on its way.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use carom::bodies::Bodies;
use carom::engine::{Event, World};
use carom::observe::{Analysis, Figure, Images, Moment};
use carom::output::write_findings;
use carom::real::Real;
use carom::scene::{AnalysisKind, Scene, SceneFile};
use carom::space::PeriodicBox;
use carom::study::Course;
use carom::study::table::{Table, counted, digits, rounded};
use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::output_file::{OutputError, OutputFile};
use super::pace::{KeptPace, Pace};

/// How often bodies are looked at in a run, if its scene does not say.
const LOOKS: f64 = 200.0;

/// The same where what follows upon what is seen.
const LOOKS_IN_TIME: f64 = 2000.0;

/// The most looks.
const MOST_LOOKS: f64 = 1e7;

/// An analysis that a scene asks for.
#[derive(Clone, Debug)]
pub struct AskedAnalysis {
    kind: AnalysisKind,
    pub path: PathBuf,
    every: f64,
    analysis: Analysis,
}

impl AskedAnalysis {
    /// Those of a scene file, of a scene at its start.
    pub fn all<T: Real>(
        file: &SceneFile,
        scene: &Scene<T>,
        (duration, equilibration): (f64, f64),
    ) -> Result<Vec<Self>, Failure> {
        let asked = file.analyses()?;
        if !asked.is_empty() && file.has_flow() {
            let wanted = "analyses follow the same spheres from the start, and here some come or go; \
                          leave it out, and record frames";
            return Err(file.mistake("analyse", "there", wanted).into());
        }
        let bodies = if asked.is_empty() { None } else { Some(scene.bodies.cast::<f64>()) };
        let space = scene.periodic.map(PeriodicBox::cast);
        let images = vec![[0; 3]; if space.is_some() { scene.bodies.len() } else { 0 }];
        let mut all: Vec<Self> = Vec::new();
        for (index, asked) in asked.into_iter().enumerate() {
            let Some(bodies) = &bodies else { break };
            let key = |key: &str| format!("analyse[{index}].{key}");
            let kind = asked.settings.kind;
            let follows = matches!(
                kind,
                AnalysisKind::MeanSquaredDisplacement | AnalysisKind::VelocityAutocorrelation
            );
            let looks = if follows { LOOKS_IN_TIME } else { LOOKS };
            let every = asked.written.every.unwrap_or((duration - equilibration) / looks);
            if duration / every > MOST_LOOKS {
                let wanted = format!("the bodies can be looked at {MOST_LOOKS:e} times");
                return Err(file.mistake(&key("every"), &format!("{every:?}"), &wanted).into());
            }
            let path = asked.written.file.unwrap_or_else(|| beside(file, kind));
            if path.extension().is_none_or(|ending| ending != "csv") {
                let found = format!("{:?}", path.display().to_string());
                let wanted = "its ending must be .csv";
                return Err(file.mistake(&key("file"), &found, wanted).into());
            }
            if let Some(other) = all.iter().position(|other| other.path == path) {
                let found = format!("{:?}", path.display().to_string());
                let wanted = format!("that is the file of analyse[{other}]; give each its own");
                return Err(file.mistake(&key("file"), &found, &wanted).into());
            }
            let images = space.is_some().then_some(images.as_slice());
            let start = Moment { time: 0.0, bodies, space, images };
            let analysis = Analysis::new(&asked.settings, &start)
                .map_err(|unfit| file.mistake(&key(unfit.key), &unfit.found, &unfit.wanted))?;
            all.push(Self { kind, path, every, analysis });
        }
        Ok(all)
    }
}

/// Sends the findings of one of many runs, by its key, to files of its own in a folder, and
/// gives their names.
pub fn of_one_run(
    file: &SceneFile,
    asked: &mut [AskedAnalysis],
    folder: &Path,
    key: &str,
) -> Result<Vec<String>, Failure> {
    let mut names: Vec<String> = Vec::with_capacity(asked.len());
    for (index, asked) in asked.iter_mut().enumerate() {
        let stem = asked.path.file_stem().unwrap_or_default().to_string_lossy();
        let name = format!("{}.csv", name_of_run(&stem, key));
        if let Some(other) = names.iter().position(|other| *other == name) {
            let found = format!("{:?}", asked.path.display().to_string());
            let wanted = format!(
                "of many runs all are in one folder, and analyse[{other}] has a file of that name; \
                 give each its own"
            );
            return Err(file.mistake(&format!("analyse[{index}].file"), &found, &wanted).into());
        }
        asked.path = folder.join(&name);
        names.push(name);
    }
    Ok(names)
}

/// The name of a file of a run: what is in it, and the key of the run as far as it can be in
/// a name.
fn name_of_run(stem: &str, key: &str) -> String {
    /// Names of files end at 255 bytes.
    const LONGEST: usize = 180;
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._=+-[]".contains(c);
    let plain = key.trim().replace(' ', "_");
    let name = format!("{stem}_{plain}");
    if name.len() <= LONGEST && plain.chars().all(is_plain) {
        return name;
    }
    let letters = plain.chars().map(|c| if is_plain(c) { c } else { '_' });
    let start: String = letters.take(LONGEST / 2).collect();
    format!("{stem}_{start}_{:016x}", xxhash_rust::xxh3::xxh3_64(key.as_bytes()))
}

/// The file of an analysis that names none.
fn beside(file: &SceneFile, kind: AnalysisKind) -> PathBuf {
    file.in_folder(&format!("{}-{}.csv", file.name, kind.name()))
}

/// An analysis of a run that was kept.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct KeptAnalysis {
    pace: KeptPace,
    analysis: Analysis,
}

/// What came of an analysis, for the summary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    pub kind: AnalysisKind,
    pub file: String,
    /// How often the bodies were looked at.
    pub looks: u64,
    pub figures: BTreeMap<&'static str, Figure>,
}

impl Found {
    /// The findings of an analysis, whose columns are in a file.
    pub fn of(kind: AnalysisKind, path: &Path, findings: carom::observe::Findings) -> Self {
        let figures = findings.figures.into_iter().map(|figure| (figure.name, figure)).collect();
        Self { kind, file: path.display().to_string(), looks: findings.looks, figures }
    }

    /// What a person reads of it.
    pub fn table(&self) -> Table {
        let mut table = Table::of_texts();
        let looks = counted(self.looks, "look");
        table.row(self.kind.name(), [format!("{looks}, in {}", self.file)]);
        for (name, figure) in &self.figures {
            let error = figure.error.map_or(String::new(), |it| format!(" ± {}", rounded(it)));
            let drift = if figure.drifts { ", still drifting" } else { "" };
            let label = format!("  {}", name.replace('_', " "));
            table.row(&label, [format!("{}{error}{drift}", digits(figure.mean))]);
        }
        table
    }
}

/// The analyses of a run under way.
#[derive(Default)]
pub struct Analyses {
    all: Vec<Analysing>,
}

struct Analysing {
    kind: AnalysisKind,
    path: PathBuf,
    file: OutputFile,
    pace: Pace,
    analysis: Analysis,
}

impl Analyses {
    /// Analyses into open files from a time of a run on, after what was kept.
    pub fn new<T: Real>(
        asked: Vec<AskedAnalysis>,
        files: Vec<OutputFile>,
        (world, course): (&World<T>, &Course),
        start: f64,
        kept: Option<&[KeptAnalysis]>,
    ) -> Self {
        let begin = |(index, (asked, file)): (usize, (AskedAnalysis, OutputFile))| {
            let AskedAnalysis { kind, path, every, analysis } = asked;
            // A run that goes on is looked at as often as before.
            let kept = kept.and_then(|kept| kept.get(index));
            let every = kept.map_or(every, |kept| kept.pace.every());
            let pace = Pace::new(world, course, every, start, kept.map(|kept| kept.pace));
            let analysis = kept.map_or(analysis, |kept| kept.analysis.clone());
            Analysing { kind, path, file, pace, analysis }
        };
        Self { all: asked.into_iter().zip(files).enumerate().map(begin).collect() }
    }

    /// Whether one is of collisions.
    pub fn hears(&self) -> bool {
        self.all.iter().any(|it| it.analysis.hears())
    }

    pub fn hear<T: Real>(&mut self, event: &Event<T>) {
        self.all.iter_mut().for_each(|it| it.analysis.hear(event));
    }

    /// Where the bodies are to be looked at next.
    pub fn mark(&self) -> Option<f64> {
        self.all.iter().filter_map(|it| it.pace.mark()).reduce(f64::min)
    }

    /// Looks at the bodies at a place, for those that are due there.
    pub fn look<T: Real>(
        &mut self,
        world: &World<T>,
        bodies: &Bodies<T>,
        space: Option<PeriodicBox<T>>,
        images: Option<&Images<T>>,
    ) {
        let position = Course::position(world);
        let bodies = bodies.cast::<f64>();
        let moment = Moment {
            time: world.time(),
            bodies: &bodies,
            space: space.map(PeriodicBox::cast),
            images: images.map(Images::counts),
        };
        for it in self.all.iter_mut().filter(|it| it.pace.mark() == Some(position)) {
            it.analysis.look(&moment);
            it.pace.pass(position);
        }
    }

    /// What is to be remembered.
    pub fn kept(&self) -> Vec<KeptAnalysis> {
        let kept =
            |it: &Analysing| KeptAnalysis { pace: it.pace.kept(), analysis: it.analysis.clone() };
        self.all.iter().map(kept).collect()
    }

    /// The files, whole but for their final names, and what is in them.
    pub fn finish(self) -> Result<Vec<(OutputFile, Found)>, OutputError> {
        let finish = |it: Analysing| {
            let findings = it.analysis.findings();
            let file = write_findings(it.file, &findings);
            let file =
                file.map_err(|source| OutputError::Write { path: it.path.clone(), source })?;
            Ok((file, Found::of(it.kind, &it.path, findings)))
        };
        self.all.into_iter().map(finish).collect()
    }
}
