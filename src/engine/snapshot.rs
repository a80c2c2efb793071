//! Snapshot: all that a run has to remember at a moment, so that it can go on as if
//! it had never stopped.
//!
//! What follows from the scene is not kept, and what can be found again is not either:
//! candidates, cells, agendas.

use serde::{Deserialize, Serialize};

use super::account::Account;
use super::event_driven::EventState;
use super::flow::FlowState;
use super::handles::Handles;
use super::later::Elapsed;
use super::sensed::Seen;
use super::stepped::StepState;
use crate::bodies::{Bodies, Columns3, Origin, PerBody};
use crate::column::Column;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::scene::Scene;
use crate::vec3::Vec3;

/// The state of a world at a moment, without its scene. It is plain data for any
/// serialiser of serde.
///
/// Of a world that was changed it has the bodies and the gravity, but no shapes: where parts
/// of the surroundings were added or removed, it goes on in the scene with the parts as they
/// are, [`World::scene`](super::World::scene).
///
/// ```
/// use carom::engine::{Snapshot, World};
/// use carom::{Execution, SceneFile, state_hash};
///
/// let file = SceneFile::builtin("superball").ok_or("no such scene")?;
/// let mut world = World::new(file.build::<f64>()?, Execution::default())?;
/// world.advance(0.5)?;
/// let snapshot: Snapshot = world.snapshot();
/// world.advance(0.5)?;
/// // Any number of times, on other threads and lanes, in another program.
/// let mut again = World::resume(file.build::<f64>()?, Execution::new().threads(1), &snapshot)?;
/// assert_eq!(again.time(), 0.5);
/// again.advance(0.5)?;
/// assert_eq!(state_hash(&again.bodies()), state_hash(&world.bodies()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot {
    pub(super) account: Account,
    pub(super) state: State,
    /// Of a world that was changed: what had elapsed before, the time that was asked for,
    /// and what it went on from.
    pub(super) later: Option<Box<SavedLater>>,
    /// What sensors have seen, of a scene that has any.
    pub(super) seen: Option<Box<Seen>>,
    /// What has come and gone by the scene, if anything does.
    pub(super) flow: Option<Box<FlowState>>,
}

/// What a snapshot of a changed world has besides.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct SavedLater {
    pub elapsed: Elapsed,
    pub asked: Option<f64>,
    pub start: SavedStart,
    pub handles: Handles,
    /// If parts of the surroundings were added or removed.
    pub parts: Option<SavedParts>,
}

/// Which parts a changed world has. Their shapes are in its scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct SavedParts {
    pub handles: Handles,
    fingerprint: u64,
}

impl SavedParts {
    pub fn of<T: Real>(scene: &Scene<T>, handles: &Handles) -> Self {
        Self { handles: handles.clone(), fingerprint: fingerprint(scene) }
    }

    /// Their names, if they are those of a scene.
    pub fn names<T: Real>(&self, scene: &Scene<T>) -> Result<Handles, Misfit> {
        let is_same = self.handles.count() == scene.surroundings.len()
            && self.fingerprint == fingerprint(scene);
        is_same.then(|| self.handles.clone()).ok_or(Misfit("parts of the surroundings"))
    }
}

/// A hash of all shapes of a scene: numbers are written with all their digits.
fn fingerprint<T: Real>(scene: &Scene<T>) -> u64 {
    let text = format!("{:?} {:?}", scene.surroundings, scene.removes);
    xxhash_rust::xxh3::xxh3_64(text.as_bytes())
}

impl Snapshot {
    /// The state of an engine that was not changed on the way.
    pub(super) fn of(account: &Account, state: State) -> Self {
        Self { account: account.clone(), state, later: None, seen: None, flow: None }
    }
}

/// What an engine started with, besides what its scene says.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct SavedStart {
    gravity: Reals,
    position: Reals3,
    velocity: Reals3,
    spin: Reals3,
    orientation: Option<[Reals; 9]>,
    /// One number for all bodies, or one for each.
    radius: Reals,
    mass: Reals,
    inertia: Reals,
}

impl SavedStart {
    pub fn of<T: Real>(gravity: Vec3<T>, bodies: &Bodies<T>) -> Self {
        let figure = |figure: &PerBody<T>| match figure {
            PerBody::Same(value) => Reals::of([*value]),
            PerBody::Each(column) => Reals::of(column.iter().copied()),
        };
        let column = |column: &Column<T>| Reals::of(column.iter().copied());
        Self {
            gravity: Reals::of(gravity.to_array()),
            position: reals3(&bodies.position),
            velocity: reals3(&bodies.velocity),
            spin: reals3(&bodies.spin),
            orientation: bodies.orientation.as_ref().map(|rows| rows.refs().each(column)),
            radius: figure(&bodies.radius),
            mass: figure(&bodies.mass),
            inertia: figure(&bodies.inertia),
        }
    }

    pub fn read<T: Real>(&self) -> Result<(Vec3<T>, Bodies<T>), Misfit> {
        let len = self.position[0].len();
        let figure = |reals: &Reals, what| -> Result<PerBody<T>, Misfit> {
            if reals.len() == 1 {
                return Ok(PerBody::Same(reals.read(1, what)?[0]));
            }
            let values: Vec<T> = reals.read(len, what)?;
            Ok(PerBody::Each(Column::from_values(values.into_iter(), T::ONE)))
        };
        let orientation = match &self.orientation {
            None => None,
            Some(rows) => {
                let mut columns = Box::new(array::from_fn(|_| Column::new(0, T::ZERO)));
                for (column, row) in columns.iter_mut().zip(rows) {
                    *column = row.column(len, "orientations")?;
                }
                Some(columns)
            }
        };
        let gravity: Vec<T> = self.gravity.read(3, "gravity")?;
        let bodies = Bodies {
            origin: Origin::Described,
            position: columns3(&self.position, len, "positions")?,
            velocity: columns3(&self.velocity, len, "velocities")?,
            spin: columns3(&self.spin, len, "spins")?,
            orientation,
            radius: figure(&self.radius, "radii")?,
            mass: figure(&self.mass, "masses")?,
            inertia: figure(&self.inertia, "moments of inertia")?,
        };
        Ok((Vec3::new(gravity[0], gravity[1], gravity[2]), bodies))
    }
}

/// The state of either engine.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) enum State {
    Stepped(StepState),
    EventDriven(EventState),
    /// Of an engine without bodies.
    Idle {
        time: f64,
        steps: u64,
    },
}

/// Numbers of one precision, bit by bit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Reals {
    Single(Vec<f32>),
    Double(Vec<f64>),
    /// A number and what it leaves out.
    Pairs(Vec<[f64; 2]>),
}

/// A snapshot of another scene, engine or precision: which figure does not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Misfit(pub &'static str);

impl Reals {
    pub fn of<T: Real>(values: impl IntoIterator<Item = T>) -> Self {
        let values = values.into_iter();
        match T::NAME {
            "f32" => Self::Single(values.map(|value| value.to_f64() as f32).collect()),
            "f64" => Self::Double(values.map(Real::to_f64).collect()),
            _ => Self::Pairs(values.map(Real::halves).collect()),
        }
    }

    /// How many they are.
    fn len(&self) -> usize {
        match self {
            Self::Single(values) => values.len(),
            Self::Double(values) => values.len(),
            Self::Pairs(values) => values.len(),
        }
    }

    /// The numbers, if they are of this precision and as many.
    pub fn read<T: Real>(&self, count: usize, what: &'static str) -> Result<Vec<T>, Misfit> {
        let values: Vec<T> = match (self, T::NAME) {
            (Self::Single(values), "f32") => {
                values.iter().map(|&value| T::from_f64(f64::from(value))).collect()
            }
            (Self::Double(values), "f64") => values.iter().copied().map(T::from_f64).collect(),
            (Self::Pairs(values), name) if !["f32", "f64"].contains(&name) => {
                values.iter().copied().map(T::from_halves).collect()
            }
            _ => return Err(Misfit("precision")),
        };
        if values.len() == count { Ok(values) } else { Err(Misfit(what)) }
    }

    pub fn column<T: Real>(&self, count: usize, what: &'static str) -> Result<Column<T>, Misfit> {
        Ok(Column::from(self.read::<T>(count, what)?.as_slice()))
    }
}

/// Three columns of numbers.
pub(super) type Reals3 = [Reals; 3];

/// What is kept of three columns.
pub(super) fn reals3<T: Real>(columns: &Columns3<T>) -> Reals3 {
    columns.refs().each(|column| Reals::of(column.iter().copied()))
}

/// Three columns again.
pub(super) fn columns3<T: Real>(
    [x, y, z]: &Reals3,
    count: usize,
    what: &'static str,
) -> Result<Columns3<T>, Misfit> {
    Ok([x.column(count, what)?, y.column(count, what)?, z.column(count, what)?])
}

/// What is kept of vectors, a column for each axis.
pub(super) fn reals3_of<T: Real>(vectors: impl Iterator<Item = Vec3<T>> + Clone) -> Reals3 {
    array::from_fn(|axis| Reals::of(vectors.clone().map(|vector| vector.to_array()[axis])))
}
