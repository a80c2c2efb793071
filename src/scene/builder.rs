//! The builder: a scene as code describes it.

use super::checked::Scene;
use super::description::{Description, Entry, GivenBox, GivenShape, Periodicity};
use super::error::SceneError;
use super::origin::Origin;
use super::settings::{Encounters, EngineKind, Impact, OrientationUpdate, Summation};
use super::spheres::{Sphere, Spheres};
use crate::bodies::Bodies;
use crate::contact::Surface;
use crate::motion::Integrator;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::surroundings::Shape;
use crate::vec3::Vec3;

/// A scene in the making. See the [module](super) for an example.
#[derive(Clone, Debug)]
pub struct SceneBuilder<T: Real> {
    description: Description<T>,
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
        let name = "scene".to_owned();
        let origin = Origin::code(&name);
        Self { description: Description::new(name, origin) }
    }

    /// What errors and the summary call the scene.
    #[must_use]
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.description.name = name.into();
        self.description.origin = Origin::code(&self.description.name);
        self
    }

    /// What moves the scene through time.
    #[must_use]
    pub fn engine(mut self, engine: EngineKind) -> Self {
        self.description.engine = engine;
        self
    }

    /// How long a run takes, time.
    #[must_use]
    pub fn duration(mut self, duration: f64) -> Self {
        self.description.duration = Some(duration);
        self
    }

    /// The uniform acceleration, length per time².
    #[must_use]
    pub fn gravity(mut self, gravity: impl Into<Vec3<T>>) -> Self {
        self.description.gravity = gravity.into();
        self
    }

    /// What happens to the slip of two surfaces when they meet.
    #[must_use]
    pub fn surface(mut self, surface: Surface) -> Self {
        self.description.surface = surface;
        self
    }

    /// What spheres can meet.
    #[must_use]
    pub fn encounters(mut self, encounters: Encounters) -> Self {
        self.description.encounters = encounters;
        self
    }

    /// The box that space closes upon itself in.
    #[must_use]
    pub fn periodic(mut self, periodic: PeriodicBox<T>) -> Self {
        self.description.periodic = Periodicity::Box(GivenBox::rounded(periodic));
        self
    }

    /// A periodic cube from the origin up, of the size that the one group with
    /// a [number density](Spheres::number_density) asks for.
    #[must_use]
    pub fn periodic_cube(mut self) -> Self {
        self.description.periodic = Periodicity::Cube;
        self
    }

    /// Adds something fixed in space.
    #[must_use]
    pub fn surroundings(mut self, shape: impl Into<Shape<T>>) -> Self {
        self.description.surroundings.push(GivenShape::rounded(shape.into()));
        self
    }

    /// Length of a step of the stepped engine, time.
    #[must_use]
    pub fn dt(mut self, dt: f64) -> Self {
        self.description.stepped.dt = Some(dt);
        self
    }

    /// How the stepped engine takes a step of free flight.
    #[must_use]
    pub fn integrator(mut self, integrator: Integrator) -> Self {
        self.description.stepped.integrator = integrator;
        self
    }

    /// Where inside a step of the stepped engine a contact takes effect.
    #[must_use]
    pub fn impact(mut self, impact: Impact) -> Self {
        self.description.stepped.impact = impact;
        self
    }

    /// When the stepped engine brings orientations up to date.
    #[must_use]
    pub fn orientation(mut self, orientation: OrientationUpdate) -> Self {
        self.description.stepped.orientation = orientation;
        self
    }

    /// How the stepped engine adds up positions and velocities from step to step.
    #[must_use]
    pub fn summation(mut self, summation: Summation) -> Self {
        self.description.stepped.summation = summation;
        self
    }

    /// The seed of the random numbers of all groups that have none of their
    /// own.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.description.seed = seed;
        self
    }

    /// Adds one sphere.
    #[must_use]
    pub fn sphere(mut self, sphere: Sphere) -> Self {
        self.description.entries.push(Entry::One(sphere));
        self
    }

    /// Adds many spheres.
    #[must_use]
    pub fn spheres(mut self, spheres: Spheres) -> Self {
        self.description.entries.push(Entry::Many(spheres));
        self
    }

    /// Adds spheres whose whole state is there already. If they are all there
    /// is, nothing is copied.
    #[must_use]
    pub fn bodies(mut self, bodies: Bodies<T>) -> Self {
        self.description.entries.push(Entry::Ready(Box::new(bodies)));
        self
    }

    /// Places the spheres, and checks everything.
    ///
    /// # Errors
    /// The first mistake found: a value out of range, values that contradict
    /// each other, spheres that overlap, lie in something solid or outside of
    /// their box, more spheres than there is room for, or none at all.
    pub fn build(self) -> Result<Scene<T>, SceneError> {
        Scene::new(self.description)
    }
}

impl<T: Real> Scene<T> {
    /// An empty scene to add to.
    #[must_use]
    pub fn builder() -> SceneBuilder<T> {
        SceneBuilder::new()
    }
}
