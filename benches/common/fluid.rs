//! The fluid that the event-driven engine is measured on.

use carom::contact::Surface;
use carom::scene::{Buildable, Scene, SceneError, Spheres};

/// Equal spheres of mass 1 and temperature 1 in a periodic cube, at the start
/// on a lattice. Rough ones spin, at the same temperature.
#[derive(Clone, Copy)]
pub struct Fluid {
    /// How many.
    pub bodies: u64,
    /// Number density, in units of the diameter.
    pub density: f64,
    /// Diameter, length.
    pub diameter: f64,
    /// Of all bodies.
    pub surface: Surface,
    /// Of the velocities.
    pub seed: u64,
}

impl Fluid {
    /// The fluid at its start.
    pub fn scene<T: Buildable>(&self) -> Result<Scene<T>, SceneError> {
        let mut spheres = Spheres::fcc(self.bodies)
            .number_density(self.density / self.diameter.powi(3))
            .radius(self.diameter / 2.0)
            .temperature(1.0)
            .seed(self.seed);
        if self.surface == Surface::Rough {
            spheres = spheres.spin_temperature(1.0);
        }
        Scene::builder().surface(self.surface).periodic_cube().spheres(spheres).build()
    }
}
