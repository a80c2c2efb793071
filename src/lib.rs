//! Rigid spheres in motion: free flight and elastic collisions, smooth and
//! perfectly rough, between spheres and with fixed surroundings.
//!
//! Every formula is one function, generic over the precision ([`f32`] or
//! [`f64`]) and over the number of reals that go through it at once (1, 4, 8
//! or 16 [lanes](lane)). The lanes, the threads and the instruction set change
//! the time of a run and no bit of its result.
//!
//! # A first program
//!
//! ```
//! use carom::{Cuboid, EventDriven, Scene, Spheres, Surface};
//!
//! let scene = Scene::<f64>::builder()
//!     .gravity([0.0, 0.0, -9.81])
//!     .surface(Surface::Rough)
//!     .surroundings(Cuboid::container([0.0; 3], [10.0; 3]))
//!     .spheres(Spheres::random(10_000).radius(0.1).temperature(1.0).seed(7))
//!     .build()?;
//! let mut world = EventDriven::new(scene)?;
//! world.advance(0.1)?;
//! println!("{}", world.energy());
//! assert!(world.collisions().pairs > 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Stepped::new`] takes the same scene once it has a step: `.dt(1e-3)` before
//! `.build()`. The same scene as a file for the program `carom` is in
//! `docs/scene-file.md` of the repository.
//!
//! # Modules, in the order of the data
//!
//! | module | what it has |
//! |---|---|
//! | [`scene`] | what is simulated, from a file or a builder, checked |
//! | [`bodies`], [`mod@column`] | the spheres, a padded column for each component |
//! | [`surroundings`] | what is fixed in space, and the periodic box |
//! | [`engine`] | the plan of a scene, and the engines that move it |
//! | [`motion`] | free flight: integrators and rotation |
//! | [`contact`] | impulses and the time of contact |
//! | [`observe`] | energy, momentum, temperature, pressure, the state hash |
//! | [`output`] | events and states as files |
//! | [`study`] | run time against error, precision, stability, scaling |
//!
//! Under all of them are the numbers: [`real`] (the precisions), [`lane`]
//! (several reals at once), [`vec3`], [`mat3`], [`trigonometry`] and
//! [`compensated`] (sums and products whose rounding error is kept).
//!
//! # Formulas without an engine
//!
//! The formulas are public, over single numbers, lanes and slices: see
//! [`motion::flight`](mod@motion::flight), [`motion::turning`] and [`contact::collide`].
//! [`Bodies::from_positions`] takes a program's own arrays into a scene.
//!
//! ```
//! use carom::contact::{Party, Rough, collide};
//! use carom::Vec3;
//!
//! // A solid ball of mass 1 and radius ½ comes down on a rough floor.
//! let mut ball = Party {
//!     velocity: Vec3::new(1.0, 0.0, -1.0_f64),
//!     spin: Vec3::new(0.0, 0.0, 0.0),
//!     inverse_mass: 1.0,
//!     inverse_inertia: 10.0,
//!     share: 1.0,
//! };
//! let from_contact_to_center = Vec3::new(0.0, 0.0, 0.5);
//! collide(Rough, from_contact_to_center, &mut ball, &mut Party::immovable());
//! assert_eq!(ball.velocity.z, 1.0);
//! assert!((ball.velocity.x - 3.0 / 7.0).abs() < 1e-15);
//! ```
//!
//! # Limits
//!
//! The [stepped](Stepped) engine misses what begins and ends within a step,
//! unless impacts are looked for [inside of it](Impact::SubStep). The
//! [event-driven](EventDriven) engine misses nothing, works on one thread where bodies are
//! few ([`Order`]), and gives an [error](EngineError::Stalled) for a sphere that rests on something
//! under gravity, which never stops colliding. Bodies are spheres; what is
//! fixed is one of the shapes of [`surroundings`]. Collisions lose no energy:
//! there is no restitution below 1 and no friction between "none" and "perfect".
//! A scene has at most [a hundred million](scene::MOST_BODIES) bodies, and the
//! squares of its lengths and speeds must be in the precision's range.
//! `docs/conventions.md` in the repository has all of them.
//!
//! # Features and safety
//!
//! The feature `program`, a default, builds the program and with it the feature
//! `study`: the [studies](study) and the [double-double](DoubleDouble). The
//! feature `files`, which they need, has scene files, events and states as files,
//! and the state hash. A program of yours that only moves spheres takes
//! `default-features = false`: 20 crates instead of 138. The crate has no unsafe code
//! (`unsafe_code = "forbid"`). User input gives errors, not panics.
//!
//! The instructions are chosen when the crate is compiled. Without flags that
//! is SSE2 on x86-64; a crate that depends on this one gets the instructions of
//! the machine at hand with, in its own `.cargo/config.toml`,
//!
//! ```toml
//! [build]
//! rustflags = ["-C", "target-cpu=native"]
//! ```

pub mod bodies;
pub mod column;
pub mod contact;
pub mod engine;
pub mod motion;
mod numbers;
pub mod observe;
#[cfg(feature = "files")]
pub mod output;
pub mod scene;
pub mod space;
#[cfg(feature = "study")]
pub mod study;
pub mod surroundings;
mod workers;

pub use numbers::{compensated, lane, mat3, real, trigonometry, vec3};

// What a first program needs.
pub use bodies::Bodies;
pub use contact::Surface;
pub use engine::{
    Batch, EngineError, Event, EventDriven, Execution, Lanes, Order, Partner, Stepped,
};
pub use motion::Integrator;
#[cfg(feature = "files")]
pub use observe::state_hash;
pub use observe::{AngularMomentum, Energy, Momentum, Temperature};
#[cfg(feature = "study")]
pub use real::DoubleDouble;
#[cfg(feature = "files")]
pub use scene::SceneFile;
pub use scene::{Encounters, Impact, Scene, SceneBuilder, SceneError, Sphere, Spheres};
pub use space::PeriodicBox;
pub use surroundings::{Cuboid, FixedSphere, Plane};
pub use vec3::Vec3;

/// The programs of the README are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
