//! Shown: what a picture or a view is of, and how its moments come about.

use std::path::{Path, PathBuf};
use std::time::Instant;

use carom::bodies::Bodies;
use carom::engine::{Compiled, Execution, World};
use carom::observe::fall_energy;
use carom::output::{FrameFormat, FrameReader};
use carom::scene::{EngineKind, Precision, Scene, SceneFile};
use carom::space::PeriodicBox;
use carom::study::{Course, Schedule};
use carom::surroundings::Shape;
use carom::{DoubleDouble, Vec3};

use super::arguments::SceneArguments;
use super::failure::Failure;
use super::journey::Stretch;
use super::outlook;
use super::progress::{Progress, SettingUp};
use super::run::{explained, totals_at_start};
use super::scene_argument::scene_file;

/// The corners of a box, length.
pub type Bounds = [Vec3<f64>; 2];

/// What an argument names.
pub enum Subject {
    Scene(Box<SceneFile>),
    /// Spheres in comma-separated values.
    State(PathBuf),
    /// Frames of a run.
    Frames(PathBuf),
}

/// What does not move.
#[derive(Clone, Debug)]
pub struct Scenery {
    pub name: String,
    pub shapes: Vec<Shape<f64>>,
    pub space: Option<PeriodicBox<f64>>,
    /// Against gravity, or up by custom.
    pub up: Vec3<f64>,
}

/// The spheres at a time.
#[derive(Clone, Debug)]
pub struct Moment {
    /// Time since the start, where it is known.
    pub time: Option<f64>,
    pub bodies: Bodies<f64>,
}

impl Subject {
    /// The scene, the state or the frames that the arguments name.
    pub fn of(arguments: &SceneArguments) -> Result<Self, Failure> {
        let Some(path) = &arguments.scene else {
            return Ok(Self::Scene(scene_file(arguments)?.into()));
        };
        let is_state = path.extension().is_some_and(|ending| ending == "csv");
        let options = [
            ("--precision", arguments.precision.is_some()),
            ("--engine", arguments.engine.is_some()),
            ("--dt", arguments.dt.is_some()),
            ("--seed", arguments.seed.is_some()),
            ("--set", !arguments.set.is_empty()),
        ];
        let is_moved = is_state || FrameFormat::of(path).is_some();
        if let Some((option, _)) = options.iter().find(|(_, is_given)| is_moved && *is_given) {
            let path = path.display();
            return Err(Failure::Argument(format!(
                "{option} is for a scene, and {path} has spheres as they were"
            )));
        }
        match FrameFormat::of(path) {
            Some(FrameFormat::ParaView) => Err(Failure::Argument(format!(
                "{} is a series of ParaView, which is not read; frames are read that end in {}",
                path.display(),
                FrameReader::ENDINGS
            ))),
            Some(_) => Ok(Self::Frames(path.clone())),
            None if is_state => Ok(Self::State(path.clone())),
            None => Ok(Self::Scene(scene_file(arguments)?.into())),
        }
    }

    /// What files of it are called.
    pub fn name(&self) -> String {
        match self {
            Self::Scene(file) => file.name.clone(),
            Self::State(path) | Self::Frames(path) => stem(path),
        }
    }
}

/// The name of a file without its ending.
fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(String::new, |stem| super::plain(&stem.to_string_lossy()))
}

impl Scenery {
    fn of<T: Compiled>(scene: &Scene<T>) -> Self {
        let gravity = scene.gravity.cast::<f64>();
        let pull = gravity.length();
        let up = if pull > 0.0 { gravity * (-1.0 / pull) } else { UP };
        Self {
            name: scene.name.clone(),
            shapes: scene.surroundings.iter().map(Shape::cast).collect(),
            space: scene.periodic.map(|space| space.cast()),
            up,
        }
    }

    fn bare(name: String, space: Option<PeriodicBox<f64>>) -> Self {
        Self { name, shapes: Vec::new(), space, up: UP }
    }

    /// The box around what has an end.
    fn bounds(&self) -> Option<Bounds> {
        let shapes = self.shapes.iter().filter_map(|shape| shape.interior().or(shape.bounds()));
        let space = self.space.map(|space| [space.lower, space.upper]);
        shapes.chain(space).reduce(joined)
    }

    /// The box around everything, spheres in a box among it, with room for what has no end.
    pub fn whole(&self, spheres: Option<Bounds>) -> Bounds {
        let seen = [spheres, self.bounds()].into_iter().flatten().reduce(joined);
        let bounds = seen.unwrap_or([Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 1.0)]);
        let has_end = |shape: &Shape<f64>| shape.bounds().or(shape.interior()).is_some();
        if self.shapes.iter().all(has_end) { bounds } else { with_planes(bounds, &self.shapes) }
    }
}

/// Where there is no gravity.
const UP: Vec3<f64> = Vec3::new(0.0, 0.0, 1.0);

/// The box around two.
pub fn joined(a: Bounds, b: Bounds) -> Bounds {
    [a[0].lesser(b[0]), a[1].greater(b[1])]
}

/// The box around spheres.
pub fn around(bodies: &Bodies<f64>) -> Option<Bounds> {
    let boxes = (0..bodies.len()).map(|k| {
        let (center, radius) = (bodies.position_of(k), bodies.radius.of(k));
        let reach = Vec3::new(radius, radius, radius);
        [center - reach, center + reach]
    });
    boxes.reduce(joined)
}

/// A box that reaches to the planes around it, if they are near, with room around: what has
/// no end fills it.
fn with_planes([lower, upper]: Bounds, shapes: &[Shape<f64>]) -> Bounds {
    /// How far away a plane may be, in diagonals of the box.
    const FAR: f64 = 3.0;
    let middle = (lower + upper) * 0.5;
    let reach = (upper - lower).length();
    let planes = shapes.iter().filter_map(|shape| match shape {
        Shape::Plane(plane) => Some(*plane),
        _ => None,
    });
    // The nearest point of each, and the one that is given: there planes may meet.
    let feet = planes.flat_map(|plane| {
        [middle - plane.normal * (middle - plane.point).dot(plane.normal), plane.point]
    });
    let feet = feet.filter(|foot| (*foot - middle).length() < FAR * reach);
    let bounds = feet.fold([lower, upper], |bounds, foot| joined(bounds, [foot, foot]));
    let sides = (bounds[1] - bounds[0]).to_array();
    let longest = sides.into_iter().fold(0.0, f64::max);
    // At least half as long along one axis as along another, for planes to be seen.
    let room = sides.map(|side| 0.05 * longest + 0.5 * (0.5 * longest - side).max(0.0));
    [bounds[0] - Vec3::from(room), bounds[1] + Vec3::from(room)]
}

/// What moments of a run are looked at.
#[derive(Clone, Copy, Debug)]
pub enum Looks {
    /// The one after a time.
    At(f64),
    /// So many at equal times up to a time, beside the start.
    Frames(u64, f64),
}

/// The scenery of a scene, and its moments, each shown to `see`.
pub fn run_scene(
    file: &SceneFile,
    execution: Execution,
    looks: Looks,
    see: &mut dyn FnMut(&Scenery, Moment),
) -> Result<Scenery, Failure> {
    match file.precision {
        Precision::F32 => run_in::<f32>(file, execution, looks, see),
        Precision::DoubleDouble => run_in::<DoubleDouble>(file, execution, looks, see),
        _ => run_in::<f64>(file, execution, looks, see),
    }
}

fn run_in<T: Compiled>(
    file: &SceneFile,
    execution: Execution,
    looks: Looks,
    see: &mut dyn FnMut(&Scenery, Moment),
) -> Result<Scenery, Failure> {
    let setting_up = SettingUp::new();
    let scene = file.build::<T>()?;
    let scenery = Scenery::of(&scene);
    let (duration, every) = match looks {
        Looks::At(time) => (time, time),
        Looks::Frames(count, duration) => (duration, duration / count as f64),
    };
    if duration == 0.0 {
        see(&scenery, Moment { time: Some(0.0), bodies: scene.bodies.cast() });
        return Ok(scenery);
    }
    outlook::check(&scene, duration, execution)?;
    let before = totals_at_start(&scene)?;
    let fall = fall_energy(&scene);
    let shapes = scene.surroundings.clone();
    let mut world = World::new(scene, execution)?;
    let course = Course::new(&world, duration);
    let mut progress = Progress::new(course, (before.energy, fall));
    drop(setting_up);
    let mut schedule = Schedule::new(&world, &course, every);
    if let Looks::At(_) = looks {
        schedule.pass(0.0);
    }
    let mut stretch = Stretch::new();
    let begin = Instant::now();
    while let Some(mark) = schedule.mark() {
        loop {
            let start = Instant::now();
            let is_there = course
                .advance(&mut world, mark, stretch.0, None)
                .map_err(|error| explained(error.into(), &world, &shapes))?;
            stretch.adapt(start.elapsed());
            progress.show(&world, begin.elapsed());
            if is_there {
                break;
            }
        }
        let bodies = world.bodies().cast();
        check(&bodies, world.time(), world.plan().engine)?;
        see(&scenery, Moment { time: Some(world.time()), bodies });
        schedule.pass(mark);
    }
    Ok(scenery)
}

/// Refuses places that are no longer finite.
fn check(bodies: &Bodies<f64>, time: f64, engine: EngineKind) -> Result<(), Failure> {
    let size =
        |k: usize| bodies.position_of(k).length_squared() + bodies.velocity_of(k).length_squared();
    let lost = (0..bodies.len()).find(|&k| !size(k).is_finite());
    lost.map_or(Ok(()), |k| {
        let what = format!("sphere {k} is no longer at a finite place");
        Err(Failure::NotFinite { time, what, engine })
    })
}

/// The spheres of a state file.
pub fn state(path: &Path) -> Result<(Scenery, Moment), Failure> {
    let name = stem(path);
    // As a text of TOML, whatever is in the path.
    let given = serde_json::to_string(&path.to_string_lossy()).unwrap_or_default();
    let file =
        SceneFile::parse(&name, &format!("encounters = \"none\"\nspheres = {{ file = {given} }}"))?;
    let scene = file.build::<f64>()?;
    Ok((Scenery::bare(name, None), Moment { time: None, bodies: scene.bodies }))
}

/// The moments of frames, each shown to `see` until it has enough.
pub fn frames(
    path: &Path,
    see: &mut dyn FnMut(&Scenery, Moment) -> bool,
) -> Result<Option<Scenery>, Failure> {
    let mut scenery = None;
    for frame in FrameReader::open(path)?.in_full() {
        let frame = frame?;
        let scenery = scenery.get_or_insert_with(|| Scenery::bare(stem(path), frame.space));
        if !see(scenery, Moment { time: frame.time, bodies: frame.bodies }) {
            break;
        }
    }
    Ok(scenery)
}
