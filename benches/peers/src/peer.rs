//! What an engine has to offer to be measured, and the figures it is measured by.

use std::sync::Arc;

use crate::measure;
use crate::mesh::Mesh;
use crate::scene::{Scene, Surroundings};
use crate::several::Several;

/// The floating-point type that an engine computes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits.
    F32,
    /// 64 bits.
    F64,
}

/// Why an engine could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum PeerError {
    /// The engine was built without threads.
    #[cfg(not(feature = "parallel"))]
    #[error("{engine} was built for one thread: build with `--features parallel`")]
    OneThreadOnly {
        /// Name of the engine.
        engine: &'static str,
    },
    /// The engine itself reported an error.
    #[error("{engine}: {message}")]
    Engine {
        /// Name of the engine.
        engine: &'static str,
        /// Its message.
        message: String,
    },
}

impl PeerError {
    /// What happened, without the engine's name and without advice.
    pub fn brief(&self) -> String {
        let text = self.to_string();
        let mut clauses = text.split(": ").skip(1);
        clauses.next().map_or(text.clone(), str::to_owned)
    }
}

/// How often bodies collided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Collisions {
    /// Collisions of two spheres, each counted once.
    pub pairs: u64,
    /// Collisions of a sphere with a wall or a floor.
    pub surroundings: u64,
}

/// A scene inside an engine. Bodies keep the order they have in the scene.
pub trait World {
    /// Makes `steps` steps of the scene's Δt. An engine that gave up on a body
    /// in them reports an error.
    fn advance(&mut self, steps: usize) -> Result<(), PeerError>;

    /// Makes `steps` steps and counts the collisions in them, which may cost
    /// time; `None` when the engine cannot count.
    fn advance_counted(&mut self, steps: usize) -> Result<Option<Collisions>, PeerError>;

    /// Centre of a body.
    fn position(&self, body: usize) -> [f64; 3];

    /// Velocity of a body's centre.
    fn velocity(&self, body: usize) -> [f64; 3];

    /// Angular velocity of a body in the world frame, radians per unit of time.
    fn spin(&self, body: usize) -> [f64; 3];

    /// Rotation from body axes to world axes: quaternion `x, y, z, w`.
    fn orientation(&self, body: usize) -> [f64; 4];
}

/// An engine. Only the methods down to `world` are the engine's own; the
/// others measure every engine in the same way.
pub trait Peer {
    /// Name and precision, as the table shows them.
    fn name(&self) -> &'static str;

    /// The precision that it computes in.
    fn precision(&self) -> Precision;

    /// How many times as many steps it makes in a timed run: what a quick
    /// engine does in the steps of a slow one is too short to time.
    fn haste(&self) -> usize {
        1
    }

    /// Sets up a scene, with `threads` threads.
    fn world(&self, scene: &Scene, threads: usize) -> Result<Box<dyn World>, PeerError>;

    /// Time of a gas in a container.
    fn gas(&self, bodies: usize, steps: usize, threads: usize) -> Result<Timing, PeerError> {
        let world = self.world(&Scene::gas(bodies), threads)?;
        measure::gas(world, bodies, steps * self.haste())
    }

    /// Sets up many scenes of as many spheres.
    fn worlds(&self, scenes: &[Scene], threads: usize) -> Result<Box<dyn World>, PeerError> {
        Several::of(self, scenes, threads)
    }

    /// Time of many small gases.
    fn gases(&self, scenes: &[Scene], steps: usize, threads: usize) -> Result<Timing, PeerError> {
        let bodies = scenes.iter().map(|scene| scene.spheres.len()).sum();
        measure::gas(self.worlds(scenes, threads)?, bodies, steps * self.haste())
    }

    /// Energy change and collisions of a gas in a container.
    fn gas_accuracy(&self, bodies: usize, steps: usize) -> Result<EnergyFigures, PeerError> {
        let scene = Scene::gas(bodies);
        measure::energy(self.world(&scene, 1)?, &scene, steps)
    }

    /// Time of spheres over hills; see [`Scene::terrain`].
    fn terrain(
        &self,
        bodies: usize,
        diameters_a_step: Option<f64>,
        steps: usize,
    ) -> Result<Timing, PeerError> {
        let world = self.world(&Scene::terrain(bodies, diameters_a_step), 1)?;
        measure::terrain(world, bodies, steps)
    }

    /// Energy change of spheres over hills, and those that fall through.
    fn terrain_accuracy(
        &self,
        bodies: usize,
        diameters_a_step: Option<f64>,
        steps: usize,
    ) -> Result<EnergyFigures, PeerError> {
        let scene = Scene::terrain(bodies, diameters_a_step);
        measure::energy(self.world(&scene, 1)?, &scene, steps)
    }

    /// What a ball on a flat mesh differs by from the same on a plane.
    fn seams(&self, drop: f64) -> Result<SeamFigures, PeerError> {
        let on_mesh = Scene::seams(drop, Surroundings::FlatMesh(Arc::new(Mesh::flat())));
        let on_plane = Scene::seams(drop, Surroundings::Floor);
        measure::seams([self.world(&on_mesh, 1)?, self.world(&on_plane, 1)?], Scene::SEAMS_STEPS)
    }

    /// Time of bodies that move and spin and never meet. With `detection` the
    /// engine has to find that out, without being given it.
    fn free_flight(
        &self,
        bodies: usize,
        steps: usize,
        threads: usize,
        detection: bool,
    ) -> Result<Timing, PeerError> {
        let world = self.world(&Scene::free_flight(bodies, detection), threads)?;
        measure::free_flight(world, bodies, steps * self.haste())
    }

    /// Height of a ball after `bounces` bounces on a floor.
    fn bounce(&self, bounces: usize) -> Result<BounceFigures, PeerError> {
        measure::bounce(self.world(&Scene::bounce(), 1)?, bounces)
    }

    /// Orientation of a spinning sphere after `steps` steps.
    fn spin(&self, steps: usize) -> Result<SpinFigures, PeerError> {
        measure::spin(self.world(&Scene::spin(), 1)?, steps)
    }

    /// Velocities after `pairs` smooth collisions of two spheres.
    fn pairs(&self, pairs: usize) -> Result<PairFigures, PeerError> {
        let scene = Scene::pairs(pairs);
        measure::pairs(self.world(&scene, 1)?, &scene)
    }
}

/// Run time.
#[derive(Clone, Copy, Debug)]
pub struct Timing {
    /// Wall time per body and step, nanoseconds.
    pub nanoseconds: f64,
}

/// Quality of many smooth elastic spheres.
#[derive(Clone, Copy, Debug)]
pub struct EnergyFigures {
    /// Final over initial energy, less one. Exact: 0.
    pub energy_change: f64,
    /// Spheres whose centre is outside the container, or not over the hills
    /// inside their room, at the end. Exact: 0.
    pub escaped: usize,
    /// Collisions in the run.
    pub collisions: Option<Collisions>,
    /// Steps in the run.
    pub steps: usize,
}

/// Quality of repeated bounces. Exact: an apex of 1 after any number.
#[derive(Clone, Copy, Debug)]
pub struct BounceFigures {
    /// Bounces until the last apex of at least [`measure::LEAST_APEX`].
    pub bounces: usize,
    /// Height of the last apex over the height of the drop.
    pub apex: f64,
    /// Whether the ball came to rest before it had made all its bounces.
    pub stopped: bool,
}

/// Quality of a flat mesh. Exact: 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeamFigures {
    /// The greatest distance between the ball on the mesh and that on the
    /// plane, diameters.
    pub position: f64,
    /// The greatest difference of their velocities over the velocity along the
    /// floor.
    pub velocity: f64,
}

/// Quality of rotation.
#[derive(Clone, Copy, Debug)]
pub struct SpinFigures {
    /// Angle between the orientation and the exact one, radians, 0 to π.
    pub angle_error: f64,
}

/// Quality of single collisions.
#[derive(Clone, Copy, Debug)]
pub struct PairFigures {
    /// Mean of |v − exact v| over the relative speed before the collision.
    pub mean_velocity_error: f64,
    /// The largest of them.
    pub largest_velocity_error: f64,
    /// Mean relative change of a pair's kinetic energy in its centre-of-mass frame.
    pub mean_energy_change: f64,
}
