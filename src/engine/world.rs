//! World: a scene in motion, by whichever engine moves it.

#[cfg(feature = "files")]
use super::handles::Names;
#[cfg(feature = "files")]
use super::later::Elapsed;
#[cfg(feature = "files")]
use super::snapshot::{Misfit, SavedLater, Snapshot};
use super::{
    Collisions, Compiled, EngineError, Event, EventDriven, Execution, PartTotals, Plan, Stepped,
};
use crate::bodies::Bodies;
use crate::real::Real;
use crate::scene::{EngineKind, Scene};
use crate::space::SphereTree;
#[cfg(feature = "files")]
use crate::surroundings::Shape;
use crate::vec3::Vec3;

/// A scene in motion, by the engine that it names.
///
/// ```
/// use carom::engine::{Execution, World};
/// use carom::scene::SceneFile;
///
/// let scene = SceneFile::builtin("superball").ok_or("no such scene")?.build::<f64>()?;
/// let mut world = World::new(scene, Execution::default())?;
/// world.for_each_event(1.0, |event| println!("sphere {} at {}", event.a, event.time))?;
/// assert!(world.collisions().total() > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub enum World<T: Real> {
    /// In steps.
    Stepped(Stepped<T>),
    /// From collision to collision.
    EventDriven(EventDriven<T>),
}

impl<T: Compiled> World<T> {
    /// A scene at its start.
    ///
    /// ```
    /// use carom::engine::World;
    /// use carom::scene::EngineKind;
    /// use carom::{Execution, Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(1e-3).sphere(ball);
    /// let scene = scene.build()?;
    /// let world = World::new(scene, Execution::default())?;
    /// assert!(matches!(world, World::Stepped(_)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of the engines' own `with_execution`.
    pub fn new(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        Ok(match scene.engine {
            EngineKind::Stepped => Self::Stepped(Stepped::with_execution(scene, execution)?),
            EngineKind::EventDriven => {
                Self::EventDriven(EventDriven::with_execution(scene, execution)?)
            }
        })
    }
}

#[cfg(feature = "files")]
impl<T: Compiled> World<T> {
    /// A scene where a world of it was when its snapshot was taken: it goes on with the
    /// same bits, on whatever lanes and threads. See [`Snapshot`].
    ///
    /// # Errors
    /// If the snapshot is of another scene, as far as that shows, otherwise as
    /// [`new`](World::new).
    pub fn resume(
        scene: Scene<T>,
        execution: Execution,
        snapshot: &Snapshot,
    ) -> Result<Self, EngineError> {
        let misfit = |Misfit(what)| EngineError::Snapshot(what);
        if snapshot.seen.is_some() != scene.surroundings.iter().any(Shape::is_sensor) {
            return Err(misfit(Misfit("sensors")));
        }
        let mut world = match &snapshot.later {
            None => Self::new(scene, execution)?,
            Some(later) => {
                let SavedLater { elapsed, start, handles, parts, .. } = &**later;
                let (gravity, bodies) = start.read().map_err(misfit)?;
                if handles.count_of_engine() != bodies.len() {
                    return Err(misfit(Misfit("bodies")));
                }
                let parts = parts.as_ref().map(|parts| parts.names(&scene)).transpose();
                let names = Names { bodies: handles.clone(), parts: parts.map_err(misfit)? };
                let scene = Scene { gravity, bodies, ..scene };
                Self::later(scene, execution, elapsed.clone(), names)?
            }
        };
        let restored = match &mut world {
            Self::Stepped(world) => world.restore(snapshot),
            Self::EventDriven(world) => world.restore(snapshot),
        };
        restored.map_err(misfit)?;
        Ok(world)
    }

    /// A world of a scene that goes on from what has elapsed.
    fn later(
        scene: Scene<T>,
        execution: Execution,
        elapsed: Elapsed,
        names: Names,
    ) -> Result<Self, EngineError> {
        Ok(match scene.engine {
            EngineKind::Stepped => Self::Stepped(Stepped::later(scene, execution, elapsed, names)?),
            EngineKind::EventDriven => {
                Self::EventDriven(EventDriven::later(scene, execution, elapsed, names)?)
            }
        })
    }
}

#[cfg(feature = "files")]
impl<T: Real> World<T> {
    /// All that it has to remember to go on from here in another world of the same
    /// scene. See [`Snapshot`].
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        match self {
            Self::Stepped(world) => world.save(),
            Self::EventDriven(world) => world.save(),
        }
    }
}

impl<T: Real> World<T> {
    /// What the scene needs.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// println!("{}", world.plan());
    /// assert_eq!(world.plan().bodies, 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn plan(&self) -> &Plan {
        match self {
            Self::Stepped(world) => world.plan(),
            Self::EventDriven(world) => world.plan(),
        }
    }

    /// The bodies now.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// // They meet half-way and go back.
    /// world.advance(1.0)?;
    /// assert_eq!(world.bodies().position_of(0).x, 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn bodies(&self) -> Bodies<T> {
        match self {
            Self::Stepped(world) => world.bodies(),
            Self::EventDriven(world) => world.bodies(),
        }
    }

    /// The bodies now, to be asked by place: which are in a sphere or a box, nearest to a
    /// point, in the way of a ray. It is made of them once and does not follow them.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// world.advance(0.25)?;
    /// assert_eq!(world.sphere_tree().in_sphere([0.0; 3], 1.0), [0]);
    /// assert_eq!(world.sphere_tree().nearest([3.0, 0.0, 0.0], 1), [1]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn sphere_tree(&self) -> SphereTree<T> {
        match self {
            Self::Stepped(world) => world.sphere_tree(),
            Self::EventDriven(world) => world.sphere_tree(),
        }
    }

    /// As [`EventDriven::finer_bodies`].
    pub(crate) fn finer_bodies(&self) -> Option<Bodies<f64>> {
        match self {
            Self::Stepped(world) => world.finer_bodies(),
            Self::EventDriven(world) => world.finer_bodies(),
        }
    }

    /// The uniform acceleration, length per time².
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// assert_eq!(world.gravity().to_array(), [0.0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn gravity(&self) -> Vec3<T> {
        match self {
            Self::Stepped(world) => world.gravity(),
            Self::EventDriven(world) => world.gravity(),
        }
    }

    /// Time since the start.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.time(), 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn time(&self) -> f64 {
        match self {
            Self::Stepped(world) => world.time(),
            Self::EventDriven(world) => world.time(),
        }
    }

    /// Steps taken.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.steps(), 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn steps(&self) -> u64 {
        match self {
            Self::Stepped(world) => world.steps(),
            Self::EventDriven(_) => 0,
        }
    }

    /// Collisions since the start.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.collisions().pairs, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn collisions(&self) -> Collisions {
        match self {
            Self::Stepped(world) => world.collisions(),
            Self::EventDriven(world) => world.collisions(),
        }
    }

    /// Lets time pass: the whole number of steps nearest to the duration, or the
    /// duration itself.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// world.advance(0.25)?;
    /// world.advance(0.75)?;
    /// assert_eq!(world.time(), 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of the engine's own `advance`.
    pub fn advance(&mut self, duration: f64) -> Result<(), EngineError> {
        match self {
            Self::Stepped(world) => world.advance(duration),
            Self::EventDriven(world) => world.advance(duration),
        }
    }

    /// [`advance`](World::advance), and reports every collision on the way, in order
    /// of time.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// world.for_each_event(1.0, |event| assert_eq!(event.time, 0.5))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance`](World::advance).
    pub fn for_each_event(
        &mut self,
        duration: f64,
        on_event: impl FnMut(&Event<T>),
    ) -> Result<(), EngineError> {
        match self {
            Self::Stepped(world) => world.for_each_event(duration, on_event),
            Self::EventDriven(world) => world.for_each_event(duration, on_event),
        }
    }

    /// What the collisions with each part of the surroundings have added up to: with those
    /// that have a name, and with all where there are no more than 64.
    ///
    /// ```
    /// # use carom::{Execution, Plane, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
    /// let floor = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
    /// let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).surroundings(floor).sphere(ball).build()?;
    /// let mut world = World::new(scene, Execution::default())?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.parts()[0].collisions, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn parts(&self) -> Vec<PartTotals> {
        match self {
            Self::Stepped(world) => world.parts(),
            Self::EventDriven(world) => world.parts(),
        }
    }

    /// The impulse of the surroundings on the bodies so far, mass × length per
    /// time.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// world.advance(1.0)?;
    /// assert_eq!(world.impulse_from_surroundings(), [0.0; 3]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn impulse_from_surroundings(&self) -> [f64; 3] {
        match self {
            Self::Stepped(world) => world.impulse_from_surroundings(),
            Self::EventDriven(world) => world.impulse_from_surroundings(),
        }
    }

    /// `Σ σ|J_n|` over the pair collisions so far, mass × length² per time.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// // Masses of 1 at a distance of 1 exchange an impulse of 2.
    /// world.advance(1.0)?;
    /// assert_eq!(world.virial(), 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn virial(&self) -> f64 {
        match self {
            Self::Stepped(world) => world.virial(),
            Self::EventDriven(world) => world.virial(),
        }
    }

    /// Mean length of the flights between collisions, where the engine knows it.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// // Two ways of ½ that ended, two of ½ under way.
    /// world.advance(1.0)?;
    /// assert_eq!(world.mean_free_path(), Some(1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn mean_free_path(&self) -> Option<f64> {
        match self {
            Self::Stepped(_) => None,
            Self::EventDriven(world) => world.mean_free_path(),
        }
    }

    /// The bytes that it holds.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// assert!(world.bytes() > 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::Stepped(world) => world.bytes(),
            Self::EventDriven(world) => world.bytes(),
        }
    }
}
