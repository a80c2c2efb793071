//! Scene: what is simulated, from a file or from a builder, checked.
//!
//! Both ways describe the same thing and go through the same checks: a file
//! ([`SceneFile`]) is read into a [`SceneBuilder`], whose
//! [`build`](SceneBuilder::build) draws the random numbers, places the spheres
//! and looks for mistakes. An engine never sees a scene with one.
//!
//! ```
//! use carom::contact::Surface;
//! use carom::scene::{Scene, Spheres};
//! use carom::surroundings::Cuboid;
//!
//! let scene = Scene::<f64>::builder()
//!     .gravity([0.0, 0.0, -9.81])
//!     .surface(Surface::Rough)
//!     .surroundings(Cuboid::container([0.0; 3], [10.0; 3]))
//!     .spheres(Spheres::random(1_000).radius(0.1).temperature(1.0).seed(7))
//!     .dt(1e-3)
//!     .build()?;
//! assert_eq!(scene.bodies.len(), 1_000);
//! # Ok::<(), carom::scene::SceneError>(())
//! ```
//!
//! Random numbers come from ChaCha8 and pass through `+ − × ÷ √` only, in
//! `f64`: a seed gives the same scene on every machine, rounded to the
//! precision at the end.

mod arrangement;
#[cfg(feature = "files")]
mod assignment;
mod builder;
#[cfg(feature = "files")]
mod builtin;
mod check;
mod check_bodies;
mod checked;
mod coming;
mod compiled;
mod description;
#[cfg(feature = "files")]
mod dilated;
#[cfg(feature = "files")]
mod entries;
mod error;
mod figures;
#[cfg(feature = "files")]
mod file;
mod filling;
#[cfg(feature = "files")]
mod fixed;
mod generate;
mod inlet;
#[cfg(feature = "files")]
mod lines;
mod obstacles;
mod origin;
#[cfg(feature = "files")]
mod outputs;
#[cfg(feature = "files")]
mod pieces;
mod quick;
mod random;
#[cfg(feature = "files")]
mod raw;
#[cfg(feature = "files")]
mod reading;
mod settings;
#[cfg(feature = "files")]
mod source;
mod spheres;
#[cfg(feature = "files")]
mod state_file;

pub use builder::SceneBuilder;
#[cfg(feature = "files")]
pub use builtin::{BuiltinScene, DEFAULT_SCENE, builtin_scenes};
pub(crate) use check_bodies::Placed;
pub use checked::Scene;
pub(crate) use coming::Room;
pub use compiled::Buildable;
pub use error::{Place, Problem, SceneError};
#[cfg(feature = "files")]
pub use file::SceneFile;
pub use inlet::Inlet;
pub(crate) use obstacles::Obstacles;
#[cfg(feature = "files")]
pub use outputs::AskedAnalysis;
pub(crate) use quick::QuickCheck;
pub use random::Random;
#[cfg(feature = "program")]
pub use raw::scene_schema;
#[cfg(feature = "files")]
pub use settings::Written;
pub use settings::{
    AnalysisKind, AnalysisSettings, Encounters, EngineKind, Impact, MOST_BODIES, MOST_STEPS,
    OrientationUpdate, Precision, SteppedSettings, Summation,
};
#[cfg(feature = "files")]
pub use source::SceneSource;
pub use spheres::{Arrangement, Sphere, Spheres, Spread};
