//! Fault: why a scene of a batch does not go on, or why there is no batch.

use crate::engine::EngineError;
use crate::scene::SceneError;

/// Why a scene of a batch does not go on. The others do.
///
/// ```
/// use carom::scene::EngineKind;
/// use carom::{Batch, Execution, Scene, Sphere};
///
/// let ball = Sphere::new([0.0; 3]).radius(0.5);
/// let scene = Scene::<f64>::builder().engine(EngineKind::Stepped).dt(0.125).sphere(ball).build()?;
/// let batch = Batch::varied(&scene, 3, Execution::new(), |k, scene| {
///     scene.bodies.velocity[0][0] = if k == 1 { f64::NAN } else { 1.0 };
/// })?;
/// let faults: Vec<_> = batch.faults().map(|(k, fault)| (k, fault.to_string())).collect();
/// assert!(faults[0].0 == 1 && faults[0].1.contains("is not finite"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// It is no scene: a body in another one, a mass of 0.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Its engine cannot take it, or cannot go on.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The motion has left the numbers.
    #[error(
        "by time {time:?} a place or a velocity is no longer finite; a shorter step, f64, or units in \
         which lengths, speeds and times are nearer to 1, may keep them in range"
    )]
    NotFinite {
        /// Simulated time at which it was found.
        time: f64,
    },
}

/// Why there is no batch.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// None of its scenes is one; this is why the first is not.
    #[error("no scene of the batch can be run; the first: {0}")]
    Scene(#[from] SceneError),
    /// The system has no threads to give.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// There is no scene in it.
    #[error("a batch of 0 scenes was asked for; give it at least one")]
    Empty,
}
