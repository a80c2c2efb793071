//! Plan: what a scene needs, found once before it runs.
//!
//! A scene pays only for what it uses. The plan says which figures are loaded,
//! computed and stored, and which kernels do it; `carom explain` prints it.

mod rows;

use super::{Execution, Lanes, Order};
use crate::bodies::PerBody;
use crate::contact::Surface;
use crate::lane::Lane;
use crate::motion::Integrator;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::scene::{Encounters, EngineKind, Impact, OrientationUpdate, Scene, Summation};
use crate::surroundings::Shape;
use crate::vec3::Vec3;

/// What becomes of the orientations.
///
/// ```
/// use carom::engine::Turning;
/// use carom::{EventDriven, Scene, Sphere};
///
/// let top = Sphere::new([0.0; 3]).radius(0.5).spin([0.0, 0.0, 1.0]);
/// let world = EventDriven::new(Scene::<f64>::builder().sphere(top).build()?)?;
/// assert_eq!(world.plan().turning, Turning::FromStart);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Turning {
    /// No body spins and no collision can make it.
    Never,
    /// Spins never change: one closed form from the start, when asked.
    FromStart,
    /// Collisions change spins: a closed form from a body's last collision.
    FromLastContact,
    /// `M ← R M` for every body in each step.
    EachStep,
}

/// What a scene needs of an engine. It prints as `carom explain` prints it.
///
/// ```
/// use carom::{EventDriven, Scene, Sphere};
///
/// let ball = Sphere::new([0.0; 3]).radius(0.5);
/// let scene = Scene::<f64>::builder().gravity([0.0, 0.0, -10.0]).sphere(ball).build()?;
/// let world = EventDriven::new(scene)?;
/// assert!(world.plan().has_field && !world.plan().has_pairs);
/// println!("{}", world.plan());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Plan {
    /// The engine that it is made for.
    pub engine: EngineKind,
    /// The precision's name.
    pub precision: &'static str,
    /// How many bodies there are.
    pub bodies: usize,
    /// Worker threads.
    pub threads: usize,
    /// Reals at once in sweeps over all bodies; of the event-driven engine,
    /// where neighbours are screened.
    pub sweep_lanes: usize,
    /// Reals at once where bodies are gathered by pairs.
    pub gather_lanes: usize,
    /// Whether the event-driven engine screens neighbours in a coarser
    /// precision.
    pub has_screening: bool,
    /// In which order the event-driven engine works collisions off.
    pub order: Order,
    /// Whether there is a field: velocities change in flight.
    pub has_field: bool,
    /// How the stepped engine integrates flight.
    pub integrator: Integrator,
    /// How the stepped engine adds up positions and velocities: never
    /// [`Summation::Auto`].
    pub summation: Summation,
    /// When contacts of the stepped engine take effect.
    pub impact: Impact,
    /// Whether positions are wrapped and differences taken to the nearest image.
    pub is_periodic: bool,
    /// Whether bodies meet each other.
    pub has_pairs: bool,
    /// How many fixed features bodies meet.
    pub features: usize,
    /// Whether triangles of meshes are among them.
    pub has_meshes: bool,
    /// How many inlets spheres come from.
    pub inlets: usize,
    /// How many parts remove spheres.
    pub drains: usize,
    /// How many sensors look at flights.
    pub sensors: usize,
    /// Which contact law collisions follow.
    pub surface: Surface,
    /// Whether collisions read and change spins.
    pub changes_spins: bool,
    /// Whether radii are loaded for each body.
    pub has_radii: bool,
    /// Whether masses are loaded for each body.
    pub has_masses: bool,
    /// What becomes of the orientations.
    pub turning: Turning,
}

impl Plan {
    /// The plan of a scene for an engine, whichever the scene itself names.
    ///
    /// ```
    /// use carom::engine::Plan;
    /// use carom::scene::EngineKind;
    /// use carom::{Execution, Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let scene = Scene::<f64>::builder().sphere(ball).build()?;
    /// let plan = Plan::new(&scene, EngineKind::EventDriven, Execution::new(), 1);
    /// assert_eq!((plan.bodies, plan.precision), (1, "f64"));
    /// # Ok::<(), carom::SceneError>(())
    /// ```
    #[must_use]
    pub fn new<T: Real>(
        scene: &Scene<T>,
        engine: EngineKind,
        execution: Execution,
        threads: usize,
    ) -> Self {
        let has_screening =
            engine == EngineKind::EventDriven && size_of::<T::Coarse>() < size_of::<T>();
        let (sweep_lanes, gather_lanes) = match engine {
            EngineKind::Stepped => lanes::<T>(execution.lanes),
            EngineKind::EventDriven => search_lanes::<T>(execution.lanes, has_screening),
        };
        let changes_spins = scene.surface.changes_spins() && scene.encounters != Encounters::None;
        let bodies = &scene.bodies;
        let is_spinning = bodies.spin.iter().any(|column| column.iter().any(|&w| w != T::ZERO));
        let features = match scene.encounters {
            Encounters::None => 0,
            _ => scene.surroundings.iter().map(Shape::count).sum(),
        };
        let turning = match scene.stepped.orientation {
            _ if !changes_spins && !is_spinning => Turning::Never,
            OrientationUpdate::EachStep if engine == EngineKind::Stepped => Turning::EachStep,
            _ if changes_spins => Turning::FromLastContact,
            _ => Turning::FromStart,
        };
        Self {
            engine,
            precision: T::NAME,
            bodies: bodies.len(),
            threads,
            sweep_lanes,
            gather_lanes,
            has_screening,
            order: Order::Strict,
            has_field: has_field(scene),
            integrator: scene.stepped.integrator,
            summation: summation(scene),
            impact: scene.stepped.impact,
            is_periodic: scene.periodic.is_some(),
            has_pairs: scene.encounters == Encounters::All && bodies.len() > 1,
            features,
            has_meshes: features > 0 && scene.surroundings.iter().any(|s| s.mesh().is_some()),
            inlets: scene.inlets.len(),
            drains: scene.removes.iter().filter(|removes| **removes).count(),
            sensors: scene.surroundings.iter().filter(|shape| shape.is_sensor()).count(),
            surface: scene.surface,
            changes_spins,
            has_radii: matches!(bodies.radius, PerBody::Each(_)),
            has_masses: matches!(bodies.mass, PerBody::Each(_)),
            turning,
        }
    }
}

/// Whether velocities change in flight.
pub(super) fn has_field<T: Real>(scene: &Scene<T>) -> bool {
    scene.gravity.to_array().iter().any(|&a| a != T::ZERO)
}

/// How the stepped engine adds up positions and velocities: never [`Summation::Auto`].
pub(super) fn summation<T: Real>(scene: &Scene<T>) -> Summation {
    match scene.stepped.summation {
        Summation::Auto if has_short_steps(scene) => Summation::Compensated,
        Summation::Auto => Summation::Plain,
        summation => summation,
    }
}

/// From this number of bodies on windows are faster than strict order on one thread, and
/// on several. Measured: below, all that is read stays in a cache, and too many bodies are
/// at borders of territories.
const MANY: [usize; 2] = [24_000, 16_000];

/// The most threads that share a window: each has two of at most 64 logs.
const MOST_THREADS: usize = 31;

impl Plan {
    /// Chooses the order of the event-driven engine, and the threads that it has use for.
    pub(super) fn choose_order(&mut self, execution: Execution, can_be_windows: bool) {
        let threads = match execution.threads {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            threads => threads,
        };
        let threads = threads.min(MOST_THREADS);
        let is_wanted = match execution.order {
            Order::Strict => false,
            Order::Windows => true,
            Order::Auto => self.bodies >= MANY[usize::from(threads > 1)],
        };
        let is_windows = is_wanted && can_be_windows;
        self.order = if is_windows { Order::Windows } else { Order::Strict };
        self.threads = if is_windows { threads } else { 1 };
    }
}

/// How many units in the last digit of the coordinates a step must have for plain sums:
/// they err by half a unit in each, always to the same side as long as speed and binary
/// exponent are the same.
const LONG_STEP: f64 = (1_u64 << 26) as f64;

/// Whether steps are so short beside the coordinates that plain sums would show it.
fn has_short_steps<T: Real>(scene: &Scene<T>) -> bool {
    let Some(dt) = scene.stepped.dt else { return false };
    let bodies = &scene.bodies;
    let greatest = |most: f64, value: f64| most.max(value.abs());
    let coordinates = bodies.position.iter().flat_map(|column| column.iter());
    // Bodies do not stay in the origin.
    let extent = bodies.radius.greatest().to_f64();
    let mut extent = coordinates.map(|&x| x.to_f64()).fold(extent, greatest);
    let points = scene.surroundings.iter().flat_map(|shape| shape.points());
    extent = points.flat_map(Vec3::to_array).map(T::to_f64).fold(extent, greatest);
    if let Some(space) = scene.periodic {
        let corners = [space.lower, space.upper].each(Vec3::to_array);
        extent = corners.iter().flatten().map(|&x| x.to_f64()).fold(extent, greatest);
    }
    let components = bodies.velocity.iter().flat_map(|column| column.iter());
    let squares: f64 = components.map(|&v| v.to_f64().powi(2)).sum();
    // What a fall through a radius gives counts as well.
    let gravity = scene.gravity.length().to_f64();
    let fallen = (gravity * bodies.radius.greatest().to_f64()).sqrt();
    let speed = (squares / bodies.len() as f64).sqrt().max(fallen);
    let is_short = |step: f64, whole: f64| step < LONG_STEP * T::EPSILON.to_f64() * whole;
    is_short(speed * dt, extent) || gravity > 0.0 && is_short(gravity * dt, speed)
}

/// The widths for sweeps and for gathers. Measured: the widest packs are best
/// in sweeps; where lanes are filled one by one, half of it, and 16 never are.
fn lanes<T: Real>(lanes: Lanes) -> (usize, usize) {
    match lanes {
        // A precision without packs.
        _ if <T::Pack4 as Lane>::WIDTH == 1 => (1, 1),
        Lanes::Auto if size_of::<T>() <= 4 => (16, 8),
        Lanes::Auto => (8, 4),
        Lanes::Scalar => (1, 1),
        Lanes::Four => (4, 4),
        Lanes::Eight => (8, 8),
        Lanes::Sixteen => (16, 8),
    }
}

/// Neighbours screened at once: sixteen in two registers each leave too few of them.
pub(super) const SCREENED: usize = if cfg!(target_feature = "avx512f") { 16 } else { 8 };

/// The widths for screening neighbours and for contact times. What is screened
/// is half as large, so twice as many are taken at once.
fn search_lanes<T: Real>(lanes: Lanes, has_screening: bool) -> (usize, usize) {
    let (_, gather) = self::lanes::<T>(lanes);
    match lanes {
        _ if has_screening && <T::Pack4 as Lane>::WIDTH == 1 => (SCREENED, gather),
        Lanes::Auto if has_screening => (SCREENED, gather),
        Lanes::Sixteen if has_screening => (16, gather),
        _ => (gather, gather),
    }
}
