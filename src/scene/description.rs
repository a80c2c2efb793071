//! Description: what a scene is asked to be, as plain data. A builder or a file
//! fills it in; nothing is checked yet.

use super::inlet::Inlet;
use super::origin::Origin;
use super::settings::{Encounters, EngineKind, SteppedSettings};
use super::spheres::{Sphere, Spheres};
use crate::bodies::{self, Bodies};
use crate::contact::Surface;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::surroundings::Shape;
use crate::vec3::Vec3;

/// A figure of the scene in its own precision, and in the one that random
/// places are drawn in: a scene in `f32` is that in `f64`, rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Given<S, E> {
    pub(super) rounded: S,
    pub(super) exact: E,
}

/// A periodic box in both.
pub(super) type GivenBox<T> = Given<PeriodicBox<T>, PeriodicBox<f64>>;

impl<T: Real> GivenBox<T> {
    /// A box in the scene's precision.
    pub(super) fn rounded(rounded: PeriodicBox<T>) -> Self {
        Self { rounded, exact: rounded.cast() }
    }

    /// A box in `f64`.
    pub(super) fn exact(exact: PeriodicBox<f64>) -> Self {
        Self { rounded: exact.cast(), exact }
    }
}

/// A fixed shape in both.
pub(super) type GivenShape<T> = Given<Shape<T>, Shape<f64>>;

impl<T: Real> GivenShape<T> {
    /// A shape in the scene's precision.
    pub(super) fn rounded(rounded: Shape<T>) -> Self {
        Self { exact: rounded.cast(), rounded }
    }

    /// A shape in `f64`.
    #[cfg(feature = "files")]
    pub(super) fn exact(exact: Shape<f64>) -> Self {
        Self { rounded: exact.cast(), exact }
    }
}

/// Whether and how space is periodic.
#[derive(Clone, Copy, Debug)]
pub(super) enum Periodicity<T> {
    Open,
    Cube,
    Box(GivenBox<T>),
}

/// One or many spheres, in the order they were added.
#[derive(Clone, Debug)]
pub(super) enum Entry<T: Real> {
    One(Sphere),
    Many(Spheres),
    Ready(Box<Bodies<T>>),
}

impl<T: Real> Entry<T> {
    /// What has put them where they are.
    pub(super) fn known_origin(&self) -> bodies::Origin {
        match self {
            Self::One(_) | Self::Many(_) => bodies::Origin::Described,
            Self::Ready(bodies) => bodies.known_origin(),
        }
    }
}

/// All that a scene is made from.
#[derive(Clone, Debug)]
pub struct Description<T: Real> {
    pub(super) name: String,
    pub(super) engine: EngineKind,
    pub(super) duration: Option<f64>,
    pub(super) gravity: Vec3<T>,
    pub(super) surface: Surface,
    pub(super) encounters: Encounters,
    pub(super) periodic: Periodicity<T>,
    pub(super) surroundings: Vec<GivenShape<T>>,
    pub(super) part_names: Vec<Option<String>>,
    pub(super) removes: Vec<bool>,
    pub(super) inlets: Vec<Inlet>,
    pub(super) stepped: SteppedSettings,
    pub(super) seed: u64,
    pub(super) entries: Vec<Entry<T>>,
    pub(super) origin: Origin,
}

impl<T: Real> Description<T> {
    /// An empty scene: no gravity, smooth surfaces, nothing fixed, the stepped
    /// engine, seed 0.
    pub(super) fn new(name: String, origin: Origin) -> Self {
        Self {
            name,
            engine: EngineKind::default(),
            duration: None,
            gravity: Vec3::ZERO,
            surface: Surface::default(),
            encounters: Encounters::default(),
            periodic: Periodicity::Open,
            surroundings: Vec::new(),
            part_names: Vec::new(),
            removes: Vec::new(),
            inlets: Vec::new(),
            stepped: SteppedSettings::default(),
            seed: 0,
            entries: Vec::new(),
            origin,
        }
    }
}
