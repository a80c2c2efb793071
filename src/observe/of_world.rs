//! What can be observed of a scene in motion.

use super::Energy;
use crate::engine::{EventDriven, Stepped, World};
use crate::real::Real;

impl<T: Real> Stepped<T> {
    /// The energy of all bodies now.
    ///
    /// ```
    /// # use carom::{Stepped, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = Stepped::new(scene)?;
    /// assert_eq!(world.energy().translational, 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn energy(&self) -> Energy {
        Energy::of(&self.bodies(), self.gravity())
    }
}

impl<T: Real> EventDriven<T> {
    /// The energy of all bodies now.
    ///
    /// ```
    /// # use carom::{EventDriven, Scene, Sphere};
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = EventDriven::new(scene)?;
    /// assert_eq!(world.energy().translational, 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn energy(&self) -> Energy {
        Energy::of(&self.bodies(), self.gravity())
    }
}

impl<T: Real> World<T> {
    /// The energy of all bodies now.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// assert_eq!(world.energy().translational, 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn energy(&self) -> Energy {
        Energy::of(&self.bodies(), self.gravity())
    }
}
