//! The builder: a scene as code describes it, and how it is built.

use super::error::SceneError;
use super::origin::Origin;
use super::spheres::{Sphere, Spheres};
use super::{Encounters, Scene, SteppedSettings, check, check_bodies, generate};
use crate::bodies::Bodies;
use crate::contact::Surface;
use crate::motion::Integrator;
use crate::real::Real;
use crate::scene::{EngineKind, Impact, OrientationUpdate};
use crate::space::PeriodicBox;
use crate::surroundings::{Cuboid, FixedSphere, Plane, Shape};
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

/// Whether and how space closes upon itself.
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

/// A scene in the making. See the [module](super) for an example.
#[derive(Clone, Debug)]
pub struct SceneBuilder<T: Real> {
    pub(super) name: String,
    pub(super) engine: EngineKind,
    pub(super) duration: Option<f64>,
    pub(super) gravity: Vec3<T>,
    pub(super) surface: Surface,
    pub(super) encounters: Encounters,
    pub(super) periodic: Periodicity<T>,
    pub(super) surroundings: Vec<Given<Shape<T>, Shape<f64>>>,
    pub(super) stepped: SteppedSettings,
    pub(super) seed: u64,
    pub(super) entries: Vec<Entry<T>>,
    pub(super) origin: Origin,
}

impl<T: Real> Default for SceneBuilder<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real> SceneBuilder<T> {
    /// An empty scene: no gravity, smooth surfaces, nothing fixed, the stepped
    /// engine, seed 0.
    #[must_use]
    pub fn new() -> Self {
        Self {
            name: "scene".to_owned(),
            engine: EngineKind::default(),
            duration: None,
            gravity: Vec3::ZERO,
            surface: Surface::default(),
            encounters: Encounters::default(),
            periodic: Periodicity::Open,
            surroundings: Vec::new(),
            stepped: SteppedSettings::default(),
            seed: 0,
            entries: Vec::new(),
            origin: Origin::code("scene"),
        }
    }

    /// What errors and the summary call the scene.
    #[must_use]
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self.origin = Origin::code(&self.name);
        self
    }

    /// What moves the scene through time.
    #[must_use]
    pub fn engine(mut self, engine: EngineKind) -> Self {
        self.engine = engine;
        self
    }

    /// How long a run takes, time.
    #[must_use]
    pub fn duration(mut self, duration: f64) -> Self {
        self.duration = Some(duration);
        self
    }

    /// The uniform acceleration, length per time².
    #[must_use]
    pub fn gravity(mut self, gravity: impl Into<Vec3<T>>) -> Self {
        self.gravity = gravity.into();
        self
    }

    /// What happens to the slip of two surfaces when they meet.
    #[must_use]
    pub fn surface(mut self, surface: Surface) -> Self {
        self.surface = surface;
        self
    }

    /// Who can meet whom.
    #[must_use]
    pub fn encounters(mut self, encounters: Encounters) -> Self {
        self.encounters = encounters;
        self
    }

    /// The box that space closes upon itself in.
    #[must_use]
    pub fn periodic(mut self, periodic: PeriodicBox<T>) -> Self {
        let exact = PeriodicBox { lower: exact(periodic.lower), upper: exact(periodic.upper) };
        self.periodic = Periodicity::Box(Given { rounded: periodic, exact });
        self
    }

    /// A periodic cube from the origin up, of the size that the one group with
    /// a [number density](Spheres::number_density) asks for.
    #[must_use]
    pub fn periodic_cube(mut self) -> Self {
        self.periodic = Periodicity::Cube;
        self
    }

    /// Adds something fixed in space.
    #[must_use]
    pub fn surroundings(mut self, shape: impl Into<Shape<T>>) -> Self {
        let rounded = shape.into();
        self.surroundings.push(Given { rounded, exact: converted(rounded, exact, T::to_f64) });
        self
    }

    /// Length of a step of the stepped engine, time.
    #[must_use]
    pub fn dt(mut self, dt: f64) -> Self {
        self.stepped.dt = Some(dt);
        self
    }

    /// How the stepped engine takes a step of free flight.
    #[must_use]
    pub fn integrator(mut self, integrator: Integrator) -> Self {
        self.stepped.integrator = integrator;
        self
    }

    /// Where inside a step of the stepped engine a contact takes effect.
    #[must_use]
    pub fn impact(mut self, impact: Impact) -> Self {
        self.stepped.impact = impact;
        self
    }

    /// When the stepped engine brings orientations up to date.
    #[must_use]
    pub fn orientation(mut self, orientation: OrientationUpdate) -> Self {
        self.stepped.orientation = orientation;
        self
    }

    /// The seed of the random numbers of all groups that have none of their
    /// own.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Adds one sphere.
    #[must_use]
    pub fn sphere(mut self, sphere: Sphere) -> Self {
        self.entries.push(Entry::One(sphere));
        self
    }

    /// Adds many spheres.
    #[must_use]
    pub fn spheres(mut self, spheres: Spheres) -> Self {
        self.entries.push(Entry::Many(spheres));
        self
    }

    /// Adds spheres whose whole state is there already. If they are all there
    /// is, nothing is copied.
    #[must_use]
    pub fn bodies(mut self, bodies: Bodies<T>) -> Self {
        self.entries.push(Entry::Ready(Box::new(bodies)));
        self
    }

    /// Places the spheres, and checks everything.
    ///
    /// # Errors
    /// The first mistake found: a value out of range, values that contradict
    /// each other, spheres that overlap, lie in something solid or outside of
    /// their box, more spheres than there is room for, or none at all.
    pub fn build(mut self) -> Result<Scene<T>, SceneError> {
        check::settings(&self)?;
        let ranges = check::entries(&self)?;
        let periodic = generate::periodic_box(&self)?;
        let bodies = generate::bodies(&mut self, periodic.map(|given| given.exact), &ranges)?;
        let periodic = periodic.map(|given| given.rounded);
        let bodies = check_bodies::bodies(&self, periodic, bodies, &ranges)?;
        Ok(Scene {
            name: self.name,
            engine: self.engine,
            duration: self.duration,
            gravity: self.gravity,
            surface: self.surface,
            encounters: self.encounters,
            periodic,
            surroundings: self.surroundings.into_iter().map(|given| given.rounded).collect(),
            stepped: self.stepped,
            bodies,
        })
    }

    /// A periodic box in `f64`.
    pub(super) fn set_periodic(&mut self, exact: PeriodicBox<f64>) {
        self.periodic = Periodicity::Box(rounded_box(exact));
    }

    /// Something fixed, in `f64`.
    pub(super) fn add_surroundings(&mut self, exact: Shape<f64>) {
        let rounded = converted(exact, rounded, T::from_f64);
        self.surroundings.push(Given { rounded, exact });
    }
}

/// A periodic box in `f64` and in the scene's precision.
pub(super) fn rounded_box<T: Real>(exact: PeriodicBox<f64>) -> GivenBox<T> {
    let rounded = PeriodicBox { lower: rounded(exact.lower), upper: rounded(exact.upper) };
    Given { rounded, exact }
}

/// A vector in `f64`.
pub(super) fn exact<T: Real>(vector: Vec3<T>) -> Vec3<f64> {
    vector.to_array().map(T::to_f64).into()
}

/// A vector of `f64` in the scene's precision.
pub(super) fn rounded<T: Real>(vector: Vec3<f64>) -> Vec3<T> {
    vector.to_array().map(T::from_f64).into()
}

/// A shape in another precision.
fn converted<A: Copy, B>(
    shape: Shape<A>,
    vector: impl Fn(Vec3<A>) -> Vec3<B>,
    number: impl Fn(A) -> B,
) -> Shape<B> {
    match shape {
        Shape::Plane(plane) => {
            Shape::Plane(Plane { point: vector(plane.point), normal: vector(plane.normal) })
        }
        Shape::Cuboid(cuboid) => Shape::Cuboid(Cuboid {
            lower: vector(cuboid.lower),
            upper: vector(cuboid.upper),
            inside: cuboid.inside,
        }),
        Shape::FixedSphere(sphere) => Shape::FixedSphere(FixedSphere {
            center: vector(sphere.center),
            radius: number(sphere.radius),
            inside: sphere.inside,
        }),
    }
}
