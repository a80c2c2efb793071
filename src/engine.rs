//! Engines: what moves a scene through time.

mod account;
mod batch;
mod change;
mod compiled;
mod event;
mod event_driven;
mod flow;
mod frame;
mod handles;
mod idle;
mod interface;
mod later;
mod parts;
mod plan;
mod sensed;
#[cfg(feature = "files")]
mod snapshot;
mod stepped;
mod survey;
mod world;

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

pub use account::Effort;
pub use batch::{Batch, BatchError, Fault, PackView};
pub use change::{Change, ChangeError};
pub use compiled::Compiled;
pub use event::{Event, Listener, Partner};
pub use event_driven::EventDriven;
pub use flow::{Exchange, Exchanged};
pub use handles::{BodyHandle, PartHandle};
pub use parts::PartTotals;
pub use plan::{Plan, Turning};
#[cfg(feature = "files")]
pub use snapshot::Snapshot;
pub use stepped::Stepped;
pub use survey::{Contact, Hit, Survey, Touched};
pub use world::World;

/// How many reals a kernel works on at once.
///
/// ```
/// use carom::Lanes;
/// assert_eq!(Lanes::Eight.to_string(), "8");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Lanes {
    /// The fastest widths for each kernel.
    #[default]
    Auto,
    /// One: the scalar reference path.
    Scalar,
    /// Four.
    #[cfg_attr(feature = "files", serde(rename = "4"))]
    Four,
    /// Eight.
    #[cfg_attr(feature = "files", serde(rename = "8"))]
    Eight,
    /// Sixteen.
    #[cfg_attr(feature = "files", serde(rename = "16"))]
    Sixteen,
}

impl Lanes {
    /// What the program calls it.
    ///
    /// ```
    /// use carom::Lanes;
    /// assert_eq!((Lanes::Auto.name(), Lanes::Sixteen.name()), ("auto", "16"));
    /// ```
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Scalar => "scalar",
            Self::Four => "4",
            Self::Eight => "8",
            Self::Sixteen => "16",
        }
    }
}

impl fmt::Display for Lanes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// In which order the event-driven engine works collisions off. It changes no bit of the
/// result.
///
/// ```
/// use carom::{Execution, Order};
/// assert_eq!(Execution::new().order(Order::Strict).order.name(), "strict");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Order {
    /// Whichever is faster.
    #[default]
    Auto,
    /// One after the other in time.
    Strict,
    /// Window after window of time, in each block after block of neighbours, on all
    /// threads; what turns out to be too early is taken back.
    Windows,
}

impl Order {
    /// What the program calls it.
    ///
    /// ```
    /// use carom::Order;
    /// assert_eq!((Order::Auto.name(), Order::Windows.name()), ("auto", "windows"));
    /// ```
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Strict => "strict",
            Self::Windows => "windows",
        }
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The most worker threads that the program and the studies ask for.
///
/// ```
/// use carom::Execution;
/// use carom::engine::MOST_THREADS;
/// assert!(Execution::new().threads(4).threads <= MOST_THREADS);
/// ```
pub const MOST_THREADS: usize = 1024;

/// The longest run of the event-driven engine, in its own unit of time: a million of its
/// longest periods.
///
/// ```
/// use carom::engine::LONGEST_RUN;
/// use carom::{EventDriven, Scene, Sphere};
///
/// let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
/// let mut world = EventDriven::new(Scene::<f64>::builder().sphere(ball).build()?)?;
/// assert!(world.advance(10.0 * LONGEST_RUN).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub const LONGEST_RUN: f64 = 1e30;

/// On what a scene is run; it changes no bit of the result.
///
/// ```
/// use carom::{Execution, Lanes, Scene, Sphere, Stepped};
///
/// let ball = Sphere::new([0.0; 3]).radius(0.5);
/// let scene = Scene::<f32>::builder().sphere(ball).dt(1e-3).build()?;
/// let execution = Execution::new().threads(1).lanes(Lanes::Scalar);
/// let world = Stepped::with_execution(scene, execution)?;
/// assert_eq!(world.plan().threads, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Execution {
    /// How many reals a kernel works on at once.
    pub lanes: Lanes,
    /// Worker threads; 0 takes all cores.
    pub threads: usize,
    /// The order of the event-driven engine.
    #[cfg_attr(feature = "files", serde(default))]
    pub order: Order,
}

impl Execution {
    /// The fastest lanes, and all cores.
    ///
    /// ```
    /// use carom::{Execution, Lanes};
    /// assert_eq!(Execution::new(), Execution::default());
    /// assert_eq!(Execution::new().lanes(Lanes::Four).threads(2).threads, 2);
    /// ```
    #[must_use]
    pub const fn new() -> Self {
        Self { lanes: Lanes::Auto, threads: 0, order: Order::Auto }
    }

    /// How many reals a kernel works on at once.
    #[must_use]
    pub const fn lanes(mut self, lanes: Lanes) -> Self {
        self.lanes = lanes;
        self
    }

    /// Worker threads; 0 takes all cores.
    #[must_use]
    pub const fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// The order of the event-driven engine.
    #[must_use]
    pub const fn order(mut self, order: Order) -> Self {
        self.order = order;
        self
    }
}

/// Collisions counted by an engine.
///
/// ```
/// use carom::{EventDriven, Plane, Scene, Sphere};
///
/// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
/// let floor = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
/// let scene = Scene::<f64>::builder().surroundings(floor).sphere(ball).build()?;
/// let mut world = EventDriven::new(scene)?;
/// world.advance(1.0)?;
/// let collisions = world.collisions();
/// assert_eq!((collisions.pairs, collisions.surroundings), (0, 1));
/// assert_eq!((collisions.total(), collisions.ends()), (1, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Collisions {
    /// Between two bodies.
    pub pairs: u64,
    /// Between a body and something fixed.
    pub surroundings: u64,
}

impl Collisions {
    /// All of them.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.pairs + self.surroundings
    }

    /// Those after an earlier count.
    ///
    /// ```
    /// # use carom::engine::Collisions;
    /// assert_eq!(Collisions::default().since(Collisions::default()).total(), 0);
    /// ```
    #[must_use]
    pub fn since(&self, earlier: Self) -> Self {
        Self {
            pairs: self.pairs - earlier.pairs,
            surroundings: self.surroundings - earlier.surroundings,
        }
    }

    /// The ends of flights: a collision of two bodies ends two.
    #[must_use]
    pub fn ends(&self) -> u64 {
        2 * self.pairs + self.surroundings
    }
}

/// Why an engine can't take a scene, or can't go on.
///
/// ```
/// use carom::{EngineError, Scene, Sphere, Stepped};
///
/// let ball = Sphere::new([0.0; 3]).radius(0.5);
/// let scene = Scene::<f64>::builder().sphere(ball).build()?;
/// assert!(matches!(Stepped::new(scene), Err(EngineError::NoStep)));
/// # Ok::<(), carom::SceneError>(())
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// The stepped engine needs the length of a step.
    #[error(
        "the scene has no step; set `dt` under [stepped], or `--dt`, or `.dt()` of the builder, to \
         its length in time"
    )]
    NoStep,
    /// A world can't be advanced by this.
    #[error(
        "a world can't be advanced by {duration}; give a duration from 0 to 2^53 steps of {dt}"
    )]
    Duration {
        /// What was asked for, time.
        duration: f64,
        /// The length of a step, time.
        dt: f64,
    },
    /// An event-driven world can't be advanced by this.
    #[error(
        "a world can't be advanced by {0}; give a duration from 0 up, shorter than {longest:e}",
        longest = LONGEST_RUN
    )]
    NoDuration(f64),
    /// Collisions follow each other while time stands still.
    #[error(
        "time stands still at {time:?}: {events} events in a row without progress, the last one of \
         sphere {body}, which rests on something, slides along something hollow in ever smaller hops, \
         or has no room"
    )]
    Stalled {
        /// Simulated time.
        time: f64,
        /// Events since time last advanced.
        events: u64,
        /// The scene's index of a body that takes part.
        body: u32,
    },
    /// The squares of speeds are no longer numbers.
    #[error(
        "at time {time:?} the speeds leave the range of numbers; `--precision f64`, or units in which \
         lengths and speeds are nearer to 1, may keep them in it"
    )]
    TooFast {
        /// Simulated time.
        time: f64,
    },
    /// Spheres cannot come or go as the scene has it.
    #[error("at time {time:?} spheres cannot come or go: {reason}")]
    Exchange {
        /// Simulated time.
        time: f64,
        /// Why not.
        reason: String,
    },
    /// A snapshot of another scene.
    #[error(
        "the snapshot is not of this scene, by its {0}; give the scene, engine and precision that it \
         was taken of"
    )]
    Snapshot(&'static str),
    /// The system has no threads to give.
    #[error("the threads could not be started: {0}; ask for fewer with `--threads`")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}
