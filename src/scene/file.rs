//! The scene file: from TOML to a description.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::assignment::{Assignment, Refused};
use super::builtin;
use super::check;
use super::checked::Scene;
use super::compiled::Buildable;
use super::description::{Description, Entry, GivenBox, GivenShape, Periodicity};
use super::entries;
use super::error::{Problem, SceneError};
use super::fixed;
use super::origin::{Origin, set_option};
use super::pieces;
use super::random::Seed;
use super::raw::{RawPeriodic, RawScene, RawSpheres, Vector, Whole, number};
use super::reading;
use super::settings::{EngineKind, Precision, SteppedSettings};
use super::spheres::{Arrangement, Spheres, Spread};
use super::state_file::StateFile;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::vec3::Vec3;

/// A scene file, read but not yet built: the precision is still to choose.
///
/// | At the top | Default | |
/// |---|---|---|
/// | `precision` | `"f64"` | or `"f32"`, or `"dd"` with the feature `study` |
/// | `engine` | `"event-driven"`; with a `[stepped]` table `"stepped"` | |
/// | `duration` | | time; a run needs it |
/// | `equilibrate` | 0 | time of a run before anything is measured |
/// | `gravity` | `[0, 0, 0]` | length per time² |
/// | `seed` | 0 | of all random numbers |
/// | `encounters` | `"all"` | what spheres can meet; or `"surroundings"`, `"none"` |
/// | `periodic` | | a table with `lower` and `upper`, or `"cube"`, sized by a `number_density` |
///
/// | `[stepped]` | Default | |
/// |---|---|---|
/// | `dt` | | time; a scene of the stepped engine needs it |
/// | `integrator` | `"velocity-verlet"` | or `"semi-implicit-euler"`, `"explicit-euler"` |
/// | `impact` | `"sub-step"` | or `"end-of-step"` |
/// | `orientation` | `"when-asked"` | or `"each-step"` |
/// | `summation` | `"auto"` | or `"plain"`, `"compensated"` |
///
/// `[record]` has the `file` of frames that a run writes, and `every` how much time;
/// `[series]` the same of a time series, and the `columns` in it; `[snapshot]` where and
/// how `every` much time, or `wall` minutes, a run is kept. `[[analyse]]` have the `kind` of
/// an [analysis](super::AnalysisKind), `every` how much time the bodies are looked at, the
/// `file`, and what is chosen: `bins`, `range`, `species`.
///
/// `[surface]` has `kind = "smooth"`, the default, or `"rough"`.
/// `[[surroundings]]` have a `shape` and its keys: `"plane"`, `"box"`, `"sphere"`,
/// `"triangle"`, `"capsule"`, `"cylinder"`, `"cone"`, `"disc"`, `"tube"` and `"torus"`, each
/// of which has a type in [`surroundings`](crate::surroundings) that tells its keys. All may
/// have a `name`, a `scale`, a `rotation` with `axis`, `angle` in rad and `center`, and a
/// `translation`, which take effect in this order.
///
/// | `[[spheres]]` | Default | |
/// |---|---|---|
/// | `position` | | length; makes one sphere |
/// | `file` | | the path of a state file, from the folder of this one: the spheres of its rows |
/// | `count`, `arrangement` | | make many: `"fcc"`, `"cubic"` or `"random"` |
/// | `lower`, `upper` | periodic box or container | the box that many fill |
/// | `number_density` | | instead of a box, with `periodic = "cube"` |
/// | `temperature`, `spin_temperature` | 0 | of many: kT, energy |
/// | `radius` | | length |
/// | `mass` or `density` | mass 1 | |
/// | `inertia_factor` | 0.4 | `I / (m r²)`, above 0 and up to 2/3 |
/// | `velocity`, `spin` | `[0, 0, 0]` | length and rad per time; of many, added to all |
///
/// A state file has at least the columns `x`, `y`, `z`; the other keys stand for
/// columns that it has not. The only entry can also be written
/// `spheres = { file = "state.csv" }`.
///
/// `radius`, `mass` and `density` can be two numbers, `[least, greatest]`, to
/// spread evenly over.
///
/// The public fields are what the program's options set. A field that was
/// changed is blamed on its option (`--dt` for [`dt`](SceneFile::dt)), not on a
/// line of the file.
///
/// ```
/// use carom::scene::SceneFile;
///
/// let mut file = SceneFile::builtin("bouncing-ball").ok_or("no such scene")?;
/// file.dt = Some(1e-4);
/// let scene = file.build::<f32>()?;
/// assert_eq!(scene.bodies.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// What the summary calls the scene: the file's name without its ending.
    pub name: String,
    /// In which numbers the file wants to be computed; `f64` by default.
    pub precision: Precision,
    /// What moves it through time: without the key `engine`, the stepped engine if
    /// there is a `[stepped]` table, else the event-driven one.
    pub engine: EngineKind,
    /// How long a run takes, time.
    pub duration: Option<f64>,
    /// Length of a step of the stepped engine, time.
    pub dt: Option<f64>,
    /// The seed of all random numbers; 0 by default.
    pub seed: u64,
    pub(super) path: String,
    /// What paths in the file start from.
    pub(super) folder: PathBuf,
    pub(super) text: Arc<str>,
    /// What takes the place of the text's values.
    pub(super) set: Vec<String>,
    pub(super) raw: RawScene,
}

impl SceneFile {
    /// Reads a scene file.
    ///
    /// ```
    /// use carom::SceneFile;
    ///
    /// let folder = tempfile::tempdir()?;
    /// let path = folder.path().join("ball.toml");
    /// std::fs::write(&path, "[[spheres]]\nposition = [0, 0, 0]\nradius = 0.5\n")?;
    /// assert_eq!(SceneFile::load(&path)?.name, "ball");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the file cannot be read, is not UTF-8 or TOML, or has an unknown key
    /// or a value of the wrong type.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let shown = path.display().to_string();
        let origin = Origin::code(&shown);
        let bytes = read(path).map_err(|error| origin.error("", Problem::Unreadable(error)))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            origin.error("", Problem::NotText(error.utf8_error().valid_up_to()))
        })?;
        let mut file = Self::parse(&shown, &text)?;
        file.folder = path.parent().unwrap_or(Path::new("")).into();
        if let Some(stem) = path.file_stem() {
            file.name = stem.to_string_lossy().into_owned();
        }
        Ok(file)
    }

    /// Reads the text of a scene file; `name` stands for the file in errors.
    ///
    /// ```
    /// use carom::SceneFile;
    ///
    /// let text = "stepped.dt = 0.1\n[[spheres]]\nposition = [0, 0, 0]\nradius = 0.5\n";
    /// assert_eq!(SceneFile::parse("ball", text)?.build::<f64>()?.bodies.len(), 1);
    /// assert!(SceneFile::parse("ball", "sphere = 1").is_err());
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// If the text is not TOML, or has an unknown key or a value of the wrong
    /// type.
    ///
    /// Paths in it start from the working directory.
    pub fn parse(name: &str, text: &str) -> Result<Self, SceneError> {
        Self::read(name, text.into(), Vec::new())
    }

    /// Reads a text with assignments in the place of its values.
    pub(super) fn read(name: &str, text: Arc<str>, set: Vec<String>) -> Result<Self, SceneError> {
        let origin = Origin::file(name, Arc::clone(&text));
        let assignments: Vec<Assignment> = set
            .iter()
            .map(|set| Assignment::parse(set).map_err(|problem| origin.set_error("", problem)))
            .collect::<Result<_, _>>()?;
        let raw = pieces::scene(&text, &assignments).map_err(|refused| match refused {
            Refused::Text(error) => origin.toml_error(&error),
            Refused::Assignment(key, problem) => origin.set_error(&key, problem),
        })?;
        Ok(Self {
            name: name.to_owned(),
            precision: raw.precision.unwrap_or_default(),
            engine: raw.engine.unwrap_or(match raw.stepped {
                Some(_) => EngineKind::Stepped,
                None => EngineKind::EventDriven,
            }),
            duration: number(raw.duration),
            dt: number(raw.dt()),
            seed: raw.seed.map_or(0, |Whole(seed)| seed),
            path: name.to_owned(),
            folder: PathBuf::new(),
            text,
            set,
            raw,
        })
    }

    /// The built-in scene of that name, if there is one.
    ///
    /// ```
    /// use carom::SceneFile;
    /// assert!(SceneFile::builtin("wedge").is_some());
    /// assert!(SceneFile::builtin("no such scene").is_none());
    /// ```
    #[must_use]
    pub fn builtin(name: &str) -> Option<Self> {
        let scene = builtin::builtin_scenes().iter().find(|scene| scene.name == name)?;
        Self::parse(scene.name, scene.text).ok()
    }

    /// Whether the file says which engine moves it, and does not leave that to its
    /// other keys.
    ///
    /// ```
    /// use carom::scene::SceneFile;
    /// assert!(SceneFile::parse("named", "engine = \"stepped\"")?.names_engine());
    /// assert!(!SceneFile::parse("left open", "duration = 1.0")?.names_engine());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn names_engine(&self) -> bool {
        self.raw.engine.is_some()
    }

    /// The text that it was read from.
    ///
    /// ```
    /// use carom::SceneFile;
    /// let file = SceneFile::parse("fast", "duration = 2.0")?;
    /// assert_eq!(file.text(), "duration = 2.0");
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// How long a run takes, time; an error without it.
    ///
    /// ```
    /// use carom::SceneFile;
    /// assert_eq!(SceneFile::parse("fast", "duration = 2.0")?.run_duration()?, 2.0);
    /// assert!(SceneFile::parse("endless", "")?.run_duration().is_err());
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// If neither the file nor an option says it.
    pub fn run_duration(&self) -> Result<f64, SceneError> {
        self.duration.ok_or_else(|| {
            let wanted = "set `duration` at the top of the file, or --duration";
            self.origin().error("duration", Problem::missing(wanted))
        })
    }

    /// Builds and checks the scene in a precision.
    ///
    /// ```
    /// use carom::SceneFile;
    ///
    /// let file = SceneFile::builtin("bouncing-ball").ok_or("no such scene")?;
    /// let (single, double) = (file.build::<f32>()?, file.build::<f64>()?);
    /// assert_eq!(single.bodies.len(), double.bodies.len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If a value, or what the values make together, is not possible.
    pub fn build<T: Buildable>(&self) -> Result<Scene<T>, SceneError> {
        T::of_file(self)
    }

    /// What the scene is asked to be, in a precision.
    pub(super) fn description<T: Real>(&self) -> Result<Description<T>, SceneError> {
        let origin = self.origin();
        let mut asked = Description::<T>::new(self.name.clone(), origin.clone());
        asked.engine = self.engine;
        asked.duration = self.duration;
        asked.seed = self.seed;
        asked.surface = self.raw.surface.kind.unwrap_or_default();
        asked.encounters = self.raw.encounters.unwrap_or_default();
        let stepped = self.raw.stepped.clone().unwrap_or_default();
        asked.stepped = SteppedSettings {
            dt: self.dt,
            integrator: stepped.integrator.unwrap_or_default(),
            impact: stepped.impact.unwrap_or_default(),
            orientation: stepped.orientation.unwrap_or_default(),
            summation: stepped.summation.unwrap_or_default(),
        };
        if let Some(Vector(gravity)) = self.raw.gravity {
            asked.gravity = Vec3::from(gravity).cast();
        }
        asked.periodic = match &self.raw.periodic {
            None => Periodicity::Open,
            Some(RawPeriodic::Cube) => Periodicity::Cube,
            Some(RawPeriodic::Box(bounds)) => {
                let lower = entries::required(&origin, "periodic", "lower", bounds.lower)?;
                let upper = entries::required(&origin, "periodic", "upper", bounds.upper)?;
                Periodicity::Box(GivenBox::exact(PeriodicBox::new(lower, upper)))
            }
        };
        for (index, raw) in self.raw.surroundings.iter().enumerate() {
            let shape = fixed::shape(&origin, index, raw, &self.folder)?;
            asked.surroundings.push(GivenShape::exact(shape));
            asked.part_names.push(raw.name.clone());
            asked.removes.push(raw.removes);
        }
        for (index, raw) in self.raw.spheres.iter().enumerate() {
            let entry = match &raw.file {
                None => entries::spheres(&origin, index, raw)?,
                Some(file) => self.state(&origin, index, raw, file)?,
            };
            asked.entries.push(entry);
        }
        for (index, raw) in self.raw.inlet.iter().enumerate() {
            asked.inlets.push(entries::inlet(&origin, index, raw)?);
        }
        Ok(asked)
    }

    /// Whether spheres come or go on the way.
    ///
    /// ```
    /// use carom::SceneFile;
    /// let text = "[[inlet]]\nposition = [0, 0, 0]\nradius = 0.5\nevery = 1";
    /// assert!(SceneFile::parse("tap", text)?.has_flow());
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn has_flow(&self) -> bool {
        !self.raw.inlet.is_empty() || self.raw.surroundings.iter().any(|raw| raw.removes)
    }

    /// What the parts of the surroundings are called, in the order of the file, and whether
    /// they are sensors.
    ///
    /// ```
    /// use carom::SceneFile;
    ///
    /// let text = "[[surroundings]]\nshape = \"plane\"\nname = \"floor\"";
    /// let file = SceneFile::parse("named", text)?;
    /// let parts: Vec<_> = file.parts().collect();
    /// assert_eq!(parts, [(Some("floor"), false)]);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    pub fn parts(&self) -> impl Iterator<Item = (Option<&str>, bool)> {
        self.raw.surroundings.iter().map(|raw| (raw.name.as_deref(), raw.sensor))
    }

    /// The files that the scene is read from besides its own.
    #[must_use]
    pub fn state_files(&self) -> Vec<PathBuf> {
        let states = self.raw.spheres.iter().filter_map(|raw| raw.file.as_deref());
        let shapes = self.raw.surroundings.iter().flat_map(|raw| raw.values.files());
        states.chain(shapes).map(|file| self.folder.join(file)).collect()
    }

    /// Spheres from a state file; what it has no column for, from the entry.
    fn state<T: Real>(
        &self,
        origin: &Origin,
        index: usize,
        raw: &RawSpheres,
        file: &str,
    ) -> Result<Entry<T>, SceneError> {
        let entry = format!("spheres[{index}]");
        let conflict = |key: &str, other: &str, reason: &str| {
            origin.error(format!("{entry}.{key}"), Problem::conflict(other, reason))
        };
        let given = ("position", raw.position.is_some());
        if let Some((key, _)) =
            entries::of_many(raw).into_iter().chain([given]).find(|(_, given)| *given)
        {
            return Err(conflict(
                key,
                "file",
                "the file says how many spheres there are and where",
            ));
        }
        let path = self.folder.join(file);
        let opened = reading::open(&path).map_err(|error| {
            let found = format!("{file:?}, which cannot be read: {error}");
            let wanted = "give the path of a state file, from the folder of the scene file";
            let problem = Problem::Value { found, wanted: wanted.to_owned() };
            origin.error(format!("{entry}.file"), problem)
        })?;
        let state = StateFile::new(&path, opened)?;
        let has = state.has();
        for (key, is_given, is_there) in [
            ("radius", raw.radius.is_some(), has.radius),
            ("mass", raw.mass.is_some(), has.mass),
            ("density", raw.density.is_some(), has.mass),
            ("velocity", raw.velocity.is_some(), has.velocity),
            ("temperature", raw.temperature.is_some(), has.velocity),
            ("spin", raw.spin.is_some(), has.spin),
            ("spin_temperature", raw.spin_temperature.is_some(), has.spin),
        ] {
            if is_given && is_there {
                let reason = "the file has columns for it; leave out one of them";
                return Err(conflict(key, &format!("{:?}", path.display().to_string()), reason));
            }
        }
        let mut spheres = Spheres {
            temperature: number(raw.temperature).unwrap_or(0.0),
            spin_temperature: number(raw.spin_temperature).unwrap_or(0.0),
            make: entries::make(raw),
            ..Spheres::new(1, Arrangement::Random)
        };
        let described = &mut spheres.make;
        described.radius = described.radius.or(has.radius.then_some(Spread::Same(1.0)));
        check::described::<T>(&spheres).map_err(|keyed| origin.error_in(&entry, keyed))?;
        let seed = Seed { seed: self.seed, group: index as u64 };
        Ok(Entry::Ready(Box::new(state.bodies(&spheres, seed)?)))
    }

    /// Which values came from where.
    pub(super) fn origin(&self) -> Origin {
        let mut origin = Origin::file(&self.path, Arc::clone(&self.text));
        for assignment in self.set.iter().filter_map(|set| Assignment::parse(set).ok()) {
            origin.overridden(assignment.key(), set_option(assignment.key()));
        }
        let bits = |value: Option<f64>| value.map(f64::to_bits);
        if bits(self.duration) != bits(number(self.raw.duration)) {
            origin.overridden("duration", "--duration");
        }
        if bits(self.dt) != bits(number(self.raw.dt())) {
            origin.overridden("stepped.dt", "--dt");
        }
        origin
    }
}

/// All bytes of a file.
fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut file: File = reading::open(path)?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}
