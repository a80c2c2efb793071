//! Checked: a scene without a mistake, and the way from its description.

use super::check_bodies::{Placed, Sources};
use super::compiled::Buildable;
use super::description::{Description, Entry, GivenBox, GivenShape, Periodicity};
use super::error::SceneError;
use super::inlet::Inlet;
use super::origin::Origin;
use super::settings::{Encounters, EngineKind, SteppedSettings};
use super::{check, check_bodies, generate};
use crate::bodies::Bodies;
use crate::contact::Surface;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::surroundings::Shape;
use crate::vec3::Vec3;

/// A checked scene: what an engine takes.
///
/// It is made by a [`SceneBuilder`](super::SceneBuilder) or a
/// [`SceneFile`](super::SceneFile); the fields are for reading. Units are the
/// user's own as long as they agree.
///
/// ```
/// use carom::{Plane, Scene, Sphere};
///
/// let scene = Scene::<f64>::builder()
///     .gravity([0.0, 0.0, -9.81])
///     .surroundings(Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
///     .sphere(Sphere::new([0.0, 0.0, 2.0]).radius(0.5))
///     .build()?;
/// assert_eq!((scene.bodies.len(), scene.surroundings.len()), (1, 1));
/// assert_eq!(scene.gravity.z, -9.81);
/// # Ok::<(), carom::SceneError>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Scene<T: Real> {
    /// What the summary calls it.
    pub name: String,
    /// What moves it through time.
    pub engine: EngineKind,
    /// How long a run takes, time. Without it, the user of the library decides
    /// on the way.
    pub duration: Option<f64>,
    /// The uniform acceleration, length per time².
    pub gravity: Vec3<T>,
    /// What happens to the slip of two surfaces when they meet.
    pub surface: Surface,
    /// What spheres can meet.
    pub encounters: Encounters,
    /// The box of a periodic space, if it is one. Every side is at
    /// least twice the greatest diameter, so that of all images of two bodies
    /// only the nearest can touch.
    pub periodic: Option<PeriodicBox<T>>,
    /// What is fixed in space, in the order of the file.
    pub surroundings: Vec<Shape<T>>,
    /// What these parts are called, as many; `None` without a name.
    pub part_names: Vec<Option<String>>,
    /// Whether they take out of the world the spheres that touch them, as many.
    pub removes: Vec<bool>,
    /// Where spheres come in, each with its seed.
    pub inlets: Vec<Inlet>,
    /// What only the stepped engine asks.
    pub stepped: SteppedSettings,
    /// The spheres, in the order of the file.
    pub bodies: Bodies<T>,
}

impl<T: Buildable> Scene<T> {
    /// The same scene with other bodies, which are checked as
    /// [`SceneBuilder::bodies`](super::SceneBuilder::bodies) has it: what a world has left is
    /// taken, however deep a step has left bodies in each other.
    ///
    /// ```
    /// use carom::{Scene, Sphere, Stepped};
    ///
    /// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// let scene = Scene::<f64>::builder().dt(0.015625).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// let mut world = Stepped::new(scene.clone())?;
    /// world.advance(0.25)?;
    /// let mut bodies = world.bodies();
    /// let later = scene.with_bodies(bodies.clone())?;
    /// assert_eq!(later.bodies.position_of(0).x, 0.25);
    /// // A state that is written to is checked.
    /// bodies.position[0][1] = 0.75;
    /// let error = scene.with_bodies(bodies).unwrap_err();
    /// assert!(error.to_string().contains("they overlap"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If they cannot be in the scene: see [`SceneBuilder::build`](super::SceneBuilder::build).
    pub fn with_bodies(&self, bodies: Bodies<T>) -> Result<Self, SceneError> {
        T::checked(self.description(bodies), None)
    }

    /// [`with_bodies`](Scene::with_bodies) where a world has left them, but for what was
    /// `placed` since, which is checked.
    pub(crate) fn with_placed(
        &self,
        bodies: Bodies<T>,
        placed: Placed<'_>,
    ) -> Result<Self, SceneError> {
        T::checked(self.description(bodies.left_by_world()), Some(placed))
    }
}

impl<T: Real> Scene<T> {
    fn description(&self, bodies: Bodies<T>) -> Description<T> {
        Description {
            engine: self.engine,
            duration: self.duration,
            gravity: self.gravity,
            surface: self.surface,
            encounters: self.encounters,
            periodic: self
                .periodic
                .map_or(Periodicity::Open, |space| Periodicity::Box(GivenBox::rounded(space))),
            surroundings: self.surroundings.iter().cloned().map(GivenShape::rounded).collect(),
            part_names: self.part_names.clone(),
            removes: self.removes.clone(),
            inlets: self.inlets.clone(),
            stepped: self.stepped,
            entries: vec![Entry::Ready(Box::new(bodies))],
            ..Description::new(self.name.clone(), Origin::code(&self.name))
        }
    }

    /// The same without bodies.
    pub(crate) fn without_bodies(&self) -> Self {
        Self {
            name: self.name.clone(),
            engine: self.engine,
            duration: self.duration,
            gravity: self.gravity,
            surface: self.surface,
            encounters: self.encounters,
            periodic: self.periodic,
            surroundings: self.surroundings.clone(),
            part_names: self.part_names.clone(),
            removes: self.removes.clone(),
            inlets: self.inlets.clone(),
            stepped: self.stepped,
            bodies: Bodies::none(),
        }
    }

    /// Checks a description, places the spheres, and checks what they make
    /// together.
    pub(super) fn checked(
        mut asked: Description<T>,
        placed: Option<Placed<'_>>,
    ) -> Result<Self, SceneError> {
        check::settings(&asked)?;
        let ranges = check::entries(&asked)?;
        let periodic = generate::periodic_box(&asked)?;
        for inlet in &mut asked.inlets {
            inlet.seed.get_or_insert(asked.seed);
        }
        let origins: Vec<_> = asked.entries.iter().map(Entry::known_origin).collect();
        let bodies = generate::bodies(&mut asked, periodic.map(|given| given.exact), &ranges)?;
        let periodic = periodic.map(|given| given.rounded);
        let bodies = check_bodies::bodies(
            &asked,
            periodic,
            bodies,
            Sources { ranges: &ranges, origins: &origins, placed },
        )?;
        Ok(Self {
            name: asked.name,
            engine: asked.engine,
            duration: asked.duration,
            gravity: asked.gravity,
            surface: asked.surface,
            encounters: asked.encounters,
            periodic,
            surroundings: asked.surroundings.into_iter().map(|given| given.rounded).collect(),
            part_names: asked.part_names,
            removes: asked.removes,
            inlets: asked.inlets,
            stepped: asked.stepped,
            bodies,
        })
    }
}
