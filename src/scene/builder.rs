//! The builder: a scene as code describes it.

use super::checked::Scene;
use super::compiled::Buildable;
use super::description::{Description, Entry, GivenBox, GivenShape, Periodicity};
use super::error::SceneError;
use super::inlet::Inlet;
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
///
/// ```
/// use carom::scene::{EngineKind, OrientationUpdate};
/// use carom::{Cuboid, Impact, Integrator, Scene, Sphere, Spheres, Surface};
///
/// let scene = Scene::<f64>::builder()
///     .name("ball-on-grains")
///     .engine(EngineKind::Stepped)
///     .duration(10.0)
///     .gravity([0.0, 0.0, -9.81])
///     .surface(Surface::Rough)
///     .surroundings(Cuboid::container([0.0; 3], [8.0; 3]))
///     .dt(1e-3)
///     .integrator(Integrator::VelocityVerlet)
///     .impact(Impact::SubStep)
///     .orientation(OrientationUpdate::WhenAsked)
///     .seed(7)
///     .sphere(Sphere::new([4.0, 4.0, 7.0]).radius(0.5))
///     .spheres(Spheres::random(50).radius(0.1).within([0.0; 3], [8.0, 8.0, 4.0]))
///     .build()?;
/// assert_eq!(scene.bodies.len(), 51);
/// # Ok::<(), carom::SceneError>(())
/// ```
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
    ///
    /// ```
    /// use carom::{Scene, SceneBuilder, Sphere};
    ///
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene: Scene<f32> = SceneBuilder::new().sphere(ball).build()?;
    /// assert_eq!(scene.bodies.len(), 1);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn new() -> Self {
        let name = "scene".to_owned();
        let origin = Origin::code(&name);
        Self { description: Description::new(name, origin) }
    }

    /// What errors and the summary call the scene.
    ///
    /// ```
    /// # use carom::{Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().name("ball").sphere(ball).build()?;
    /// assert_eq!(scene.name, "ball");
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.description.name = name.into();
        self.description.origin = Origin::code(&self.description.name);
        self
    }

    /// What moves the scene through time.
    ///
    /// ```
    /// # use carom::{Scene, Sphere};
    /// use carom::engine::World;
    /// use carom::scene::EngineKind;
    ///
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball).build()?;
    /// let world = World::new(scene, carom::Execution::default())?;
    /// assert!(matches!(world, World::EventDriven(_)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn engine(mut self, engine: EngineKind) -> Self {
        self.description.engine = engine;
        self
    }

    /// How long a run takes, time.
    ///
    /// ```
    /// # use carom::{Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().duration(2.5).sphere(ball).build()?;
    /// assert_eq!(scene.duration, Some(2.5));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn duration(mut self, duration: f64) -> Self {
        self.description.duration = Some(duration);
        self
    }

    /// The uniform acceleration, length per time².
    ///
    /// ```
    /// # use carom::{Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().gravity([0.0, 0.0, -9.81]).sphere(ball).build()?;
    /// assert_eq!(scene.gravity.z, -9.81);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn gravity(mut self, gravity: impl Into<Vec3<T>>) -> Self {
        self.description.gravity = gravity.into();
        self
    }

    /// What happens to the slip of two surfaces when they meet.
    ///
    /// ```
    /// # use carom::{Scene, Sphere, Surface};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().surface(Surface::Rough).sphere(ball).build()?;
    /// assert_eq!(scene.surface, Surface::Rough);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn surface(mut self, surface: Surface) -> Self {
        self.description.surface = surface;
        self
    }

    /// What spheres can meet.
    ///
    /// ```
    /// use carom::scene::Encounters;
    /// use carom::{Scene, Sphere};
    ///
    /// // Spheres that pass through each other can start in one place.
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder()
    ///     .encounters(Encounters::Surroundings)
    ///     .sphere(ball.clone())
    ///     .sphere(ball)
    ///     .build()?;
    /// assert_eq!(scene.bodies.len(), 2);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn encounters(mut self, encounters: Encounters) -> Self {
        self.description.encounters = encounters;
        self
    }

    /// The box of a periodic space.
    ///
    /// ```
    /// use carom::{PeriodicBox, Scene, Spheres};
    ///
    /// let space = PeriodicBox::new([0.0; 3], [4.0; 3]);
    /// let gas = Spheres::random(100).radius(0.1).temperature(1.0);
    /// let scene = Scene::<f64>::builder().periodic(space).spheres(gas).build()?;
    /// assert_eq!(scene.periodic, Some(space));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn periodic(mut self, periodic: PeriodicBox<T>) -> Self {
        self.description.periodic = Periodicity::Box(GivenBox::rounded(periodic));
        self
    }

    /// A periodic cube from the origin up, of the size that the one group with
    /// a [number density](Spheres::number_density) asks for.
    ///
    /// ```
    /// use carom::{Scene, Spheres};
    ///
    /// // 500 spheres, one for each 2 of volume.
    /// let fluid = Spheres::fcc(500).radius(0.5).number_density(0.5).temperature(1.0);
    /// let scene = Scene::<f64>::builder().periodic_cube().spheres(fluid).build()?;
    /// let side = scene.periodic.map(|cube| cube.sides().x);
    /// assert!(side.is_some_and(|side| (side - 10.0).abs() < 1e-12));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn periodic_cube(mut self) -> Self {
        self.description.periodic = Periodicity::Cube;
        self
    }

    /// Adds something fixed in space.
    ///
    /// ```
    /// use carom::{FixedSphere, Plane, Scene, Sphere};
    ///
    /// let scene = Scene::<f64>::builder()
    ///     .surroundings(Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
    ///     .surroundings(FixedSphere::solid([3.0, 0.0, 0.0], 1.0))
    ///     .sphere(Sphere::new([0.0, 0.0, 2.0]).radius(0.5))
    ///     .build()?;
    /// assert_eq!(scene.surroundings.len(), 2);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn surroundings(mut self, shape: impl Into<Shape<T>>) -> Self {
        self.description.surroundings.push(GivenShape::rounded(shape.into()));
        self.description.part_names.push(None);
        self.description.removes.push(false);
        self
    }

    /// Adds something fixed in space under a name, by which figures of it are called.
    ///
    /// ```
    /// use carom::{Plane, Scene, Sphere};
    ///
    /// let scene = Scene::<f64>::builder()
    ///     .named_surroundings("floor", Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
    ///     .sphere(Sphere::new([0.0, 0.0, 2.0]).radius(0.5))
    ///     .build()?;
    /// assert_eq!(scene.part_names[0].as_deref(), Some("floor"));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn named_surroundings(
        mut self,
        name: impl Into<String>,
        shape: impl Into<Shape<T>>,
    ) -> Self {
        self = self.surroundings(shape);
        self.description.part_names.pop();
        self.description.part_names.push(Some(name.into()));
        self
    }

    /// Adds something fixed in space that takes the spheres which touch it out of the world,
    /// under a name.
    ///
    /// ```
    /// use carom::engine::World;
    /// use carom::{Execution, Plane, Scene, Sphere};
    ///
    /// let ball = |height| {
    ///     Sphere::new([0.0, 0.0, height]).radius(0.5).velocity([0.0, 0.0, -1.0])
    /// };
    /// let scene = Scene::<f64>::builder()
    ///     .removing_surroundings("drain", Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
    ///     .sphere(ball(2.0))
    ///     .sphere(ball(4.0))
    ///     .build()?;
    /// let mut world = World::new(scene, Execution::default())?;
    /// world.advance(3.0)?;
    /// assert_eq!(world.bodies().len(), 1);
    /// assert_eq!(world.exchange().removed.spheres, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn removing_surroundings(
        mut self,
        name: impl Into<String>,
        shape: impl Into<Shape<T>>,
    ) -> Self {
        self = self.named_surroundings(name, shape);
        self.description.removes.pop();
        self.description.removes.push(true);
        self
    }

    /// Adds a source of spheres: see [`Inlet`].
    #[must_use]
    pub fn inlet(mut self, inlet: Inlet) -> Self {
        self.description.inlets.push(inlet);
        self
    }

    /// Length of a step of the stepped engine, time.
    ///
    /// ```
    /// # use carom::{Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().dt(1e-3).sphere(ball).build()?;
    /// assert_eq!(scene.stepped.dt, Some(1e-3));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn dt(mut self, dt: f64) -> Self {
        self.description.stepped.dt = Some(dt);
        self
    }

    /// How the stepped engine takes a step of free flight.
    ///
    /// ```
    /// # use carom::{Integrator, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let verlet = Integrator::VelocityVerlet;
    /// let scene = Scene::<f64>::builder().integrator(verlet).sphere(ball).build()?;
    /// assert_eq!(scene.stepped.integrator, verlet);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn integrator(mut self, integrator: Integrator) -> Self {
        self.description.stepped.integrator = integrator;
        self
    }

    /// Where inside a step of the stepped engine a contact takes effect.
    ///
    /// ```
    /// # use carom::{Impact, Scene, Sphere};
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().impact(Impact::SubStep).sphere(ball).build()?;
    /// assert_eq!(scene.stepped.impact, Impact::SubStep);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn impact(mut self, impact: Impact) -> Self {
        self.description.stepped.impact = impact;
        self
    }

    /// When the stepped engine brings orientations up to date.
    ///
    /// ```
    /// # use carom::{Scene, Sphere};
    /// use carom::scene::OrientationUpdate;
    ///
    /// # let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene =
    ///     Scene::<f64>::builder().orientation(OrientationUpdate::EachStep).sphere(ball).build()?;
    /// assert_eq!(scene.stepped.orientation, OrientationUpdate::EachStep);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
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
    ///
    /// ```
    /// use carom::{Scene, Spheres};
    ///
    /// let drawn = |seed| {
    ///     let gas = Spheres::random(10).radius(0.1).within([0.0; 3], [1.0; 3]);
    ///     Scene::<f64>::builder().seed(seed).spheres(gas).build()
    /// };
    /// assert_eq!(drawn(1)?.bodies, drawn(1)?.bodies);
    /// assert_ne!(drawn(1)?.bodies, drawn(2)?.bodies);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.description.seed = seed;
        self
    }

    /// Adds one sphere.
    ///
    /// ```
    /// use carom::{Scene, Sphere};
    ///
    /// let scene = Scene::<f64>::builder()
    ///     .sphere(Sphere::new([0.0; 3]).radius(0.5))
    ///     .sphere(Sphere::new([2.0, 0.0, 0.0]).radius(1.0))
    ///     .build()?;
    /// assert_eq!(scene.bodies.radius.of(1), 1.0);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn sphere(mut self, sphere: Sphere) -> Self {
        self.description.entries.push(Entry::One(sphere));
        self
    }

    /// Adds many spheres.
    ///
    /// ```
    /// use carom::{Cuboid, Scene, Spheres};
    ///
    /// let scene = Scene::<f64>::builder()
    ///     .surroundings(Cuboid::container([0.0; 3], [4.0; 3]))
    ///     .spheres(Spheres::cubic(64).radius(0.25))
    ///     .build()?;
    /// assert_eq!(scene.bodies.len(), 64);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn spheres(mut self, spheres: Spheres) -> Self {
        self.description.entries.push(Entry::Many(spheres));
        self
    }

    /// Adds spheres whose whole state is there already. If they are all there
    /// is, nothing is copied.
    ///
    /// What a world's own `bodies()` are is not held against overlaps: a step ends with
    /// bodies in each other, and an engine goes on from whatever it leaves. If centres or
    /// radii have been written to since, they may be in others by a tenth of their radii
    /// and the way of two steps.
    ///
    /// ```
    /// use carom::{Bodies, Scene};
    ///
    /// let bodies = Bodies::from_positions(&[[0.0; 3], [2.0, 0.0, 0.0]]).radius(0.5).build()?;
    /// let scene = Scene::<f64>::builder().bodies(bodies.clone()).build()?;
    /// assert_eq!(scene.bodies, bodies);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn bodies(mut self, bodies: Bodies<T>) -> Self {
        self.description.entries.push(Entry::Ready(Box::new(bodies)));
        self
    }
}

impl<T: Buildable> SceneBuilder<T> {
    /// Places the spheres, and checks everything.
    ///
    /// ```
    /// use carom::{Scene, Sphere};
    ///
    /// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5);
    /// let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(0.75));
    /// let error = scene.build().unwrap_err();
    /// assert!(error.to_string().contains("they overlap by 0.25"));
    /// ```
    ///
    /// # Errors
    /// The first mistake found: a value out of range, values that contradict
    /// each other, spheres that overlap, lie in something solid or outside of
    /// their box, more spheres than there is room for, or none at all.
    pub fn build(self) -> Result<Scene<T>, SceneError> {
        T::checked(self.description, None)
    }
}

impl<T: Real> Scene<T> {
    /// An empty scene to add to.
    ///
    /// ```
    /// use carom::{Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
    /// assert_eq!(scene.bodies.len(), 1);
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn builder() -> SceneBuilder<T> {
        SceneBuilder::new()
    }
}
