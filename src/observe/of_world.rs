//! What can be observed of a scene in motion.

use super::{Energy, Totals};
use crate::bodies::Bodies;
use crate::engine::{EventDriven, Stepped, World};
use crate::real::Real;
use crate::vec3::Vec3;

/// The energy of bodies in a field, in double precision where they are known to it.
fn energy<T: Real>(
    finer: Option<Bodies<f64>>,
    bodies: impl FnOnce() -> Bodies<T>,
    gravity: Vec3<T>,
) -> Energy {
    match finer {
        Some(bodies) => Energy::of(&bodies, gravity.cast()),
        None => Energy::of(&bodies(), gravity),
    }
}

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
        energy(self.finer_bodies(), || self.bodies(), self.gravity())
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
        energy(self.finer_bodies(), || self.bodies(), self.gravity())
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
        energy(self.finer_bodies(), || self.bodies(), self.gravity())
    }

    /// What motion conserves, now. Far from its origin a scene in single precision is
    /// moved in a frame of its own; there the places have more digits than in
    /// [`bodies`](World::bodies), and these count.
    ///
    /// ```
    /// # use carom::{Execution, Scene, Sphere};
    /// # use carom::engine::World;
    /// # use carom::scene::EngineKind;
    /// # let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// # let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// # let mut world = World::new(scene, Execution::default())?;
    /// assert_eq!(world.totals().momentum.0.x, 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn totals(&self) -> Totals {
        match self.finer_bodies() {
            Some(bodies) => Totals::of(&bodies, self.gravity().cast()),
            None => Totals::of(&self.bodies(), self.gravity()),
        }
    }
}
