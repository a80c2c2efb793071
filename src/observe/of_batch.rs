//! What can be observed of the scenes of a batch.

use super::Energy;
use crate::engine::Batch;
use crate::real::Real;
use crate::vec3::Vec3;

impl<T: Real> Batch<T> {
    /// The energy of all bodies of each scene now; `None` as
    /// [`bodies`](Batch::bodies) has it.
    ///
    /// ```
    /// use carom::scene::EngineKind;
    /// use carom::{Batch, Execution, Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([2.0, 0.0, 0.0]);
    /// let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125);
    /// let scene = scene.sphere(ball).build()?;
    /// let batch = Batch::varied(&scene, 3, Execution::new(), |k, scene| {
    ///     scene.bodies.velocity[0][0] = k as f64;
    /// })?;
    /// let energies: Vec<_> = batch.energies().into_iter().flatten().collect();
    /// assert_eq!(energies.iter().map(|energy| energy.total()).collect::<Vec<_>>(), [0.0, 0.5, 2.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn energies(&self) -> Vec<Option<Energy>> {
        self.observe(|scene, bodies| match self.finer_bodies(scene) {
            Some(finer) => Energy::of(&finer, self.gravity(scene).unwrap_or(Vec3::ZERO).cast()),
            None => Energy::of(bodies, self.gravity(scene).unwrap_or(Vec3::ZERO)),
        })
    }
}
