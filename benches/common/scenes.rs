//! The gas that engines are measured on.

use std::f64::consts::PI;

use carom::contact::Surface;
use carom::real::Real;
use carom::scene::{Buildable, Impact, Scene, SceneBuilder, SceneError, Spheres};
use carom::surroundings::Cuboid;

/// Share of the container's volume that the spheres fill.
const PACKING_FRACTION: f64 = 0.1;

/// Root mean square of the distance that a sphere moves in one step, diameters.
const DIAMETERS_A_STEP: f64 = 0.02;

/// Spheres of diameter 1, mass 1 and temperature 1 at random in `side`³.
pub fn spheres(bodies: usize) -> (Spheres, f64) {
    let side = (bodies as f64 * PI / 6.0 / PACKING_FRACTION).cbrt();
    let spheres = Spheres::random(bodies as u64).radius(0.5).temperature(1.0).seed(1);
    (spheres.within([0.0; 3], [side; 3]), side)
}

/// A scene of any spheres that move at temperature 1.
pub fn steps<T: Real>() -> SceneBuilder<T> {
    Scene::builder().impact(Impact::EndOfStep).dt(DIAMETERS_A_STEP / 3_f64.sqrt())
}

/// A closed container of that side.
pub fn container<T: Real>(side: f64) -> Cuboid<T> {
    Cuboid::container([T::ZERO; 3], [T::from_f64(side); 3])
}

/// A gas of equal spheres in a closed container, without gravity; rough ones
/// spin.
pub fn gas<T: Buildable>(bodies: usize, surface: Surface) -> Result<Scene<T>, SceneError> {
    let (mut spheres, side) = spheres(bodies);
    if surface == Surface::Rough {
        spheres = spheres.spin_temperature(1.0);
    }
    steps().surface(surface).surroundings(container(side)).spheres(spheres).build()
}
