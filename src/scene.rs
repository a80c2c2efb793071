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
mod builder;
mod builtin;
mod check;
mod check_bodies;
mod dilated;
mod error;
mod figures;
mod file;
mod filling;
mod generate;
mod obstacles;
mod origin;
mod random;
mod raw;
mod settings;
mod spheres;

use crate::bodies::Bodies;
use crate::contact::Surface;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::surroundings::Shape;
use crate::vec3::Vec3;

pub use builder::SceneBuilder;
pub use builtin::{BuiltinScene, DEFAULT_SCENE, builtin_scenes};
pub use error::{Place, Problem, SceneError};
pub use file::SceneFile;
pub use settings::{Encounters, EngineKind, Impact, OrientationUpdate, Precision, SteppedSettings};
pub use spheres::{Arrangement, Sphere, Spheres, Spread};

/// The most bodies that a scene may have: one hundred million.
pub const MOST_BODIES: u64 = 100_000_000;

/// The most steps that a run may have: `2⁵³`, up to which their count is exact
/// in an `f64`.
pub const MOST_STEPS: f64 = 9_007_199_254_740_992.0;

/// A checked scene: what an engine takes.
///
/// It can only be had from a [`SceneBuilder`] or a [`SceneFile`]; the fields
/// are for reading. Units are the user's own as long as they agree.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Scene<T: Real> {
    /// What the summary calls it.
    pub name: String,
    /// What moves it through time.
    pub engine: EngineKind,
    /// How long a run takes, time. Without it, the user of the library decides
    /// as he goes.
    pub duration: Option<f64>,
    /// The uniform acceleration, length per time².
    pub gravity: Vec3<T>,
    /// What happens to the slip of two surfaces when they meet.
    pub surface: Surface,
    /// Who can meet whom.
    pub encounters: Encounters,
    /// The box that space closes upon itself in, if it does. Every side is at
    /// least twice the greatest diameter, so that of all images of two bodies
    /// only the nearest can touch.
    pub periodic: Option<PeriodicBox<T>>,
    /// What is fixed in space, in the order of the file.
    pub surroundings: Vec<Shape<T>>,
    /// What only the stepped engine asks.
    pub stepped: SteppedSettings,
    /// The spheres, in the order of the file.
    pub bodies: Bodies<T>,
}

impl<T: Real> Scene<T> {
    /// An empty scene to add to.
    #[must_use]
    pub fn builder() -> SceneBuilder<T> {
        SceneBuilder::new()
    }
}
