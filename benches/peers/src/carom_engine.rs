//! carom as a peer: its stepped engine in both precisions.

use std::cell::OnceCell;
use std::error::Error;

use carom::bodies::{Bodies, BodiesError, PerBody};
use carom::engine::{Compiled, Execution, Stepped};
use carom::motion::Integrator;
use carom::scene::{self, Encounters};
use carom::scene::{Impact, OrientationUpdate};
use carom::surroundings::{Cuboid, Plane};
use carom::vec3::Vec3;

use crate::peer::{Collisions, Peer, PeerError, Precision, World};
use crate::scene::{RADIUS, Scene, Sphere, Surroundings};

/// How carom's stepped engine is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Settings {
    /// As it comes: contacts where bodies overlap at the end of a step,
    /// semi-implicit Euler, orientations as a closed form when asked for.
    Defaults,
    /// Contacts at their time inside the step, velocity Verlet, and
    /// orientations turned in every step.
    SubStep,
}

/// Moments of inertia of the solid spheres of mass 1.
const INERTIA: f64 = 0.4 * RADIUS * RADIUS;

/// carom in one precision.
struct Carom {
    name: &'static str,
    precision: Precision,
    settings: Settings,
}

impl Peer for Carom {
    fn name(&self) -> &'static str {
        self.name
    }

    fn precision(&self) -> Precision {
        self.precision
    }

    fn haste(&self) -> usize {
        20
    }

    fn world(&self, scene: &Scene, threads: usize) -> Result<Box<dyn World>, PeerError> {
        let world = match self.precision {
            Precision::F32 => boxed::<f32>(scene, threads, self.settings),
            Precision::F64 => boxed::<f64>(scene, threads, self.settings),
        };
        world.map_err(|error| PeerError::Engine { engine: self.name, message: error.to_string() })
    }
}

fn boxed<T: Compiled>(
    scene: &Scene,
    threads: usize,
    settings: Settings,
) -> Result<Box<dyn World>, Box<dyn Error>> {
    let execution = Execution::new().threads(threads);
    let engine = Stepped::<T>::with_execution(translated(scene, settings)?, execution)?;
    Ok(Box::new(CaromWorld { engine, bodies: OnceCell::new() }))
}

/// The scene as carom has it.
fn translated<T: Compiled>(
    scene: &Scene,
    settings: Settings,
) -> Result<scene::Scene<T>, Box<dyn Error>> {
    let real = T::from_f64;
    let mut builder = scene::Scene::builder()
        .gravity([T::ZERO, T::ZERO, real(scene.gravity)])
        .encounters(if scene.collisions { Encounters::All } else { Encounters::None })
        .dt(scene.dt)
        .impact(Impact::EndOfStep)
        .integrator(Integrator::SemiImplicitEuler)
        .bodies(bodies(&scene.spheres)?);
    builder = match scene.surroundings {
        Surroundings::None => builder,
        Surroundings::Floor => builder
            .surroundings(Plane { point: Vec3::ZERO, normal: [T::ZERO, T::ZERO, T::ONE].into() }),
        Surroundings::Container { side } => {
            builder.surroundings(Cuboid::container([T::ZERO; 3], [real(side); 3]))
        }
    };
    if settings == Settings::SubStep {
        builder = builder
            .impact(Impact::SubStep)
            .integrator(Integrator::VelocityVerlet)
            .orientation(OrientationUpdate::EachStep);
    }
    Ok(builder.build()?)
}

fn bodies<T: Compiled>(spheres: &[Sphere]) -> Result<Bodies<T>, BodiesError> {
    let all = |vector: fn(&Sphere) -> [f64; 3]| -> Vec<[T; 3]> {
        spheres.iter().map(|sphere| vector(sphere).map(T::from_f64)).collect()
    };
    let mut bodies = Bodies::from_positions(&all(|sphere| sphere.position))
        .velocities(&all(|sphere| sphere.velocity))
        .spins(&all(|sphere| sphere.spin))
        .radius(T::from_f64(RADIUS))
        .build()?;
    bodies.inertia = PerBody::Same(T::from_f64(INERTIA));
    Ok(bodies)
}

struct CaromWorld<T: Compiled> {
    engine: Stepped<T>,
    /// All bodies after the last step, once one has been asked for.
    bodies: OnceCell<Bodies<T>>,
}

impl<T: Compiled> CaromWorld<T> {
    fn bodies(&self) -> &Bodies<T> {
        self.bodies.get_or_init(|| self.engine.bodies())
    }
}

impl<T: Compiled> World for CaromWorld<T> {
    fn advance(&mut self, steps: usize) -> Result<(), PeerError> {
        self.bodies.take();
        self.engine.advance_steps(steps as u64);
        Ok(())
    }

    fn advance_counted(&mut self, steps: usize) -> Result<Option<Collisions>, PeerError> {
        let before = self.engine.collisions();
        self.advance(steps)?;
        let after = self.engine.collisions();
        Ok(Some(Collisions {
            pairs: after.pairs - before.pairs,
            surroundings: after.surroundings - before.surroundings,
        }))
    }

    fn position(&self, body: usize) -> [f64; 3] {
        array(self.bodies().position_of(body))
    }

    fn velocity(&self, body: usize) -> [f64; 3] {
        array(self.bodies().velocity_of(body))
    }

    fn spin(&self, body: usize) -> [f64; 3] {
        array(self.bodies().spin_of(body))
    }

    fn orientation(&self, body: usize) -> [f64; 4] {
        quaternion(self.bodies().orientation_of(body).rows().map(T::to_f64))
    }
}

fn array<T: Compiled>(vector: Vec3<T>) -> [f64; 3] {
    vector.to_array().map(T::to_f64)
}

/// The quaternion `x, y, z, w` of a rotation matrix in row-major order, by way
/// of its greatest component, so that nothing cancels (Shepperd 1978).
fn quaternion([xx, xy, xz, yx, yy, yz, zx, zy, zz]: [f64; 9]) -> [f64; 4] {
    // Row k: 4 q_k q.
    let products = [
        [1.0 + xx - yy - zz, xy + yx, xz + zx, zy - yz],
        [xy + yx, 1.0 - xx + yy - zz, yz + zy, xz - zx],
        [xz + zx, yz + zy, 1.0 - xx - yy + zz, yx - xy],
        [zy - yz, xz - zx, yx - xy, 1.0 + xx + yy + zz],
    ];
    let greatest =
        (1..4).fold(0, |best, k| if products[k][k] > products[best][best] { k } else { best });
    let scale = 0.5 / products[greatest][greatest].sqrt();
    products[greatest].map(|product| product * scale)
}

/// carom in both precisions, as it comes and at its most accurate.
pub fn engines() -> Vec<Box<dyn Peer>> {
    let carom = |name, precision, settings| Box::new(Carom { name, precision, settings });
    vec![
        carom("carom f32", Precision::F32, Settings::Defaults),
        carom("carom f64", Precision::F64, Settings::Defaults),
        carom("carom f32, sub-step", Precision::F32, Settings::SubStep),
        carom("carom f64, sub-step", Precision::F64, Settings::SubStep),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::{angle_between, rotation};

    #[test]
    fn a_matrix_and_its_quaternion_are_one_rotation() {
        let (a, b) = (-1.0 / 3.0, 2.0 / 3.0);
        let half_turn = quaternion([a, b, b, b, a, b, b, b, a]);
        let exact = rotation([1.0; 3], std::f64::consts::PI);
        assert!(angle_between(half_turn, exact) < 1e-15);

        let quarter_turn = quaternion([0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        let exact = rotation([0.0, 0.0, 2.0], std::f64::consts::FRAC_PI_2);
        assert!(angle_between(quarter_turn, exact) < 1e-15);
    }
}
