//! carom as a peer: both engines, in both precisions.

use std::cell::OnceCell;
use std::error::Error;

use carom::bodies::{Bodies, BodiesError, PerBody};
use carom::engine::{self, Batch, Compiled, Execution};
use carom::motion::Integrator;
use carom::scene::{self, EngineKind, Impact, OrientationUpdate};
use carom::surroundings::{Cuboid, Mesh, MeshError, Plane};
use carom::vec3::Vec3;

use crate::mesh;
use crate::peer::{Collisions, Peer, PeerError, Precision, World};
use crate::scene::{Encounters, RADIUS, Scene, Sphere, Surroundings};
use crate::several::Several;

/// How carom is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Settings {
    /// As it comes: contacts where bodies overlap at the end of a step,
    /// semi-implicit Euler, orientations as a closed form when asked for.
    Defaults,
    /// Contacts at their time inside the step, velocity Verlet, and
    /// orientations turned in every step.
    SubStep,
    /// No steps: from collision to collision.
    EventDriven,
    /// Many scenes in lanes: as it comes, and with contacts inside the step.
    Batch,
    BatchSubStep,
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

    fn worlds(&self, scenes: &[Scene], threads: usize) -> Result<Box<dyn World>, PeerError> {
        if !matches!(self.settings, Settings::Batch | Settings::BatchSubStep) {
            return Several::of(self, scenes, threads);
        }
        let batch = match self.precision {
            Precision::F32 => self.batch::<f32>(scenes, threads),
            Precision::F64 => self.batch::<f64>(scenes, threads),
        };
        batch.map_err(|error| PeerError::Engine { engine: self.name, message: error.to_string() })
    }

    fn world(&self, scene: &Scene, threads: usize) -> Result<Box<dyn World>, PeerError> {
        let world = match self.precision {
            Precision::F32 => self.boxed::<f32>(scene, threads),
            Precision::F64 => self.boxed::<f64>(scene, threads),
        };
        world.map_err(|error| PeerError::Engine { engine: self.name, message: error.to_string() })
    }
}

impl Carom {
    fn boxed<T: Compiled>(
        &self,
        scene: &Scene,
        threads: usize,
    ) -> Result<Box<dyn World>, Box<dyn Error>> {
        let execution = Execution::new().threads(threads);
        let world = engine::World::<T>::new(translated(scene, self.settings)?, execution)?;
        Ok(Box::new(CaromWorld { name: self.name, world, dt: scene.dt, bodies: OnceCell::new() }))
    }

    fn batch<T: Compiled>(
        &self,
        scenes: &[Scene],
        threads: usize,
    ) -> Result<Box<dyn World>, Box<dyn Error>> {
        let all: Result<Vec<_>, _> =
            scenes.iter().map(|scene| translated::<T>(scene, self.settings)).collect();
        let all = all?;
        let execution = Execution::new().threads(threads);
        let batch = Batch::made(all.len(), execution, |k| Ok(all[k].clone()))?;
        let bodies = scenes.first().map_or(0, |scene| scene.spheres.len());
        Ok(Box::new(CaromBatch { name: self.name, batch, bodies }))
    }
}

/// The scene as carom has it.
fn translated<T: Compiled>(
    scene: &Scene,
    settings: Settings,
) -> Result<scene::Scene<T>, Box<dyn Error>> {
    let real = T::from_f64;
    let mut builder = scene::Scene::builder()
        .gravity([T::ZERO, T::ZERO, real(scene.gravity)])
        .encounters(match scene.encounters {
            Encounters::None => scene::Encounters::None,
            Encounters::Surroundings => scene::Encounters::Surroundings,
            Encounters::All => scene::Encounters::All,
        })
        .dt(scene.dt)
        .impact(Impact::EndOfStep)
        .integrator(Integrator::SemiImplicitEuler)
        .bodies(bodies(&scene.spheres)?);
    builder = match &scene.surroundings {
        Surroundings::None => builder,
        Surroundings::Floor => builder
            .surroundings(Plane { point: Vec3::ZERO, normal: [T::ZERO, T::ZERO, T::ONE].into() }),
        Surroundings::Container { side } => {
            builder.surroundings(Cuboid::container([T::ZERO; 3], [real(*side); 3]))
        }
        Surroundings::FlatMesh(mesh) => builder.surroundings(triangles(mesh)?),
        Surroundings::Terrain(terrain) => builder.surroundings(triangles(&terrain.mesh)?),
    };
    builder = match settings {
        Settings::Defaults | Settings::Batch => builder.engine(EngineKind::Stepped),
        Settings::BatchSubStep => builder
            .engine(EngineKind::Stepped)
            .impact(Impact::SubStep)
            .integrator(Integrator::VelocityVerlet),
        Settings::SubStep => builder
            .engine(EngineKind::Stepped)
            .impact(Impact::SubStep)
            .integrator(Integrator::VelocityVerlet)
            .orientation(OrientationUpdate::EachStep),
        Settings::EventDriven => builder.engine(EngineKind::EventDriven),
    };
    Ok(builder.build()?)
}

fn triangles<T: Compiled>(mesh: &mesh::Mesh) -> Result<Mesh<T>, MeshError> {
    let vertices: Vec<[T; 3]> = mesh.vertices.iter().map(|v| v.map(T::from_f64)).collect();
    Mesh::new(&vertices, &mesh.triangles)
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
    name: &'static str,
    world: engine::World<T>,
    dt: f64,
    /// All bodies after the last step, once one has been asked for.
    bodies: OnceCell<Bodies<T>>,
}

impl<T: Compiled> CaromWorld<T> {
    fn bodies(&self) -> &Bodies<T> {
        self.bodies.get_or_init(|| self.world.bodies())
    }
}

impl<T: Compiled> World for CaromWorld<T> {
    fn advance(&mut self, steps: usize) -> Result<(), PeerError> {
        self.bodies.take();
        match &mut self.world {
            engine::World::Stepped(world) => world.advance_steps(steps as u64),
            engine::World::EventDriven(world) => {
                world.advance(steps as f64 * self.dt).map_err(|error| PeerError::Engine {
                    engine: self.name,
                    message: error.to_string(),
                })?;
            }
        }
        Ok(())
    }

    fn advance_counted(&mut self, steps: usize) -> Result<Option<Collisions>, PeerError> {
        let before = self.world.collisions();
        self.advance(steps)?;
        let after = self.world.collisions();
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

struct CaromBatch<T: Compiled> {
    name: &'static str,
    batch: Batch<T>,
    /// Of each scene.
    bodies: usize,
}

impl<T: Compiled> CaromBatch<T> {
    fn of<R>(&self, body: usize, of: impl Fn(&Bodies<T>, usize) -> R) -> R {
        let (scene, body) = (body / self.bodies, body % self.bodies);
        of(&self.batch.bodies(scene).expect("no scene of a gas goes wrong"), body)
    }
}

impl<T: Compiled> World for CaromBatch<T> {
    fn advance(&mut self, steps: usize) -> Result<(), PeerError> {
        let done = self.batch.advance_steps(steps as u64);
        done.map_err(|error| PeerError::Engine { engine: self.name, message: error.to_string() })
    }

    fn advance_counted(&mut self, steps: usize) -> Result<Option<Collisions>, PeerError> {
        let count = |batch: &Batch<T>| {
            batch.collisions().fold([0, 0], |[pairs, surroundings], collisions| {
                [pairs + collisions.pairs, surroundings + collisions.surroundings]
            })
        };
        let before = count(&self.batch);
        self.advance(steps)?;
        let after = count(&self.batch);
        Ok(Some(Collisions { pairs: after[0] - before[0], surroundings: after[1] - before[1] }))
    }

    fn position(&self, body: usize) -> [f64; 3] {
        self.of(body, |bodies, body| array(bodies.position_of(body)))
    }

    fn velocity(&self, body: usize) -> [f64; 3] {
        self.of(body, |bodies, body| array(bodies.velocity_of(body)))
    }

    fn spin(&self, body: usize) -> [f64; 3] {
        self.of(body, |bodies, body| array(bodies.spin_of(body)))
    }

    fn orientation(&self, body: usize) -> [f64; 4] {
        self.of(body, |bodies, body| quaternion(bodies.orientation_of(body).rows().map(T::to_f64)))
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

fn carom(name: &'static str, precision: Precision, settings: Settings) -> Box<dyn Peer> {
    Box::new(Carom { name, precision, settings })
}

/// carom's stepped engine in both precisions, as it comes and at its most accurate.
pub fn engines() -> Vec<Box<dyn Peer>> {
    let mut engines = vec![
        carom("carom f32", Precision::F32, Settings::Defaults),
        carom("carom f64", Precision::F64, Settings::Defaults),
    ];
    engines.extend(sub_step());
    engines
}

fn sub_step() -> [Box<dyn Peer>; 2] {
    [
        carom("carom f32, sub-step", Precision::F32, Settings::SubStep),
        carom("carom f64, sub-step", Precision::F64, Settings::SubStep),
    ]
}

/// carom's batches, and its worlds one by one as they come.
pub fn batches() -> Vec<Box<dyn Peer>> {
    vec![
        carom("carom f32, batch", Precision::F32, Settings::Batch),
        carom("carom f64, batch", Precision::F64, Settings::Batch),
        carom("carom f32, batch, sub-step", Precision::F32, Settings::BatchSubStep),
        carom("carom f64, batch, sub-step", Precision::F64, Settings::BatchSubStep),
        carom("carom f32, one by one", Precision::F32, Settings::Defaults),
        carom("carom f64, one by one", Precision::F64, Settings::Defaults),
    ]
}

/// carom as it goes with meshes: impacts at their time, in both engines.
pub fn with_meshes() -> Vec<Box<dyn Peer>> {
    let mut engines = Vec::from(sub_step());
    engines.extend([
        carom("carom f32, event-driven", Precision::F32, Settings::EventDriven),
        carom("carom f64, event-driven", Precision::F64, Settings::EventDriven),
    ]);
    engines
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
