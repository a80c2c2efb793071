//! Settings: what a scene asks of numbers, surfaces, time and engines.

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use crate::motion::Integrator;
#[cfg(feature = "study")]
use crate::real::DoubleDouble;
use crate::real::Real;

/// In which numbers a scene is computed.
///
/// ```
/// use carom::scene::Precision;
/// assert_eq!(Precision::F32.name(), "f32");
/// assert_eq!(Precision::F32.epsilon(), f64::from(f32::EPSILON));
/// assert_eq!(Precision::default(), Precision::F64);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Precision {
    /// Single precision, 24 binary digits.
    F32,
    /// Double precision, 53 binary digits.
    #[default]
    F64,
    /// [Double-double](crate::DoubleDouble), 105 binary digits, at some forty times the cost.
    #[cfg(feature = "study")]
    #[cfg_attr(feature = "files", serde(rename = "dd"))]
    DoubleDouble,
}

impl Precision {
    /// What the scene file and the summary call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => f32::NAME,
            Self::F64 => f64::NAME,
            #[cfg(feature = "study")]
            Self::DoubleDouble => DoubleDouble::NAME,
        }
    }

    /// Distance from 1 to the next greater number.
    #[must_use]
    pub fn epsilon(self) -> f64 {
        match self {
            Self::F32 => f64::from(f32::EPSILON),
            Self::F64 => f64::EPSILON,
            #[cfg(feature = "study")]
            Self::DoubleDouble => DoubleDouble::EPSILON.high(),
        }
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How an engine goes through time.
///
/// ```
/// use carom::scene::EngineKind;
/// use carom::{Scene, Sphere};
///
/// let ball = Sphere::new([0.0; 3]).radius(0.5);
/// let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven).sphere(ball).build()?;
/// assert_eq!(scene.engine, EngineKind::EventDriven);
/// # Ok::<(), carom::SceneError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum EngineKind {
    /// Steps of fixed length.
    Stepped,
    /// Every collision at its exact time.
    #[default]
    EventDriven,
}

/// What spheres can meet.
///
/// ```
/// use carom::engine::World;
/// use carom::scene::Encounters;
/// use carom::{Execution, Scene, Sphere};
///
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5);
/// let scene = Scene::<f64>::builder().encounters(Encounters::None).dt(0.5);
/// let scene = scene.sphere(ball(0.0)).sphere(ball(2.0)).build()?;
/// assert!(!World::new(scene, Execution::default())?.plan().has_pairs);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Encounters {
    /// Spheres meet each other and the surroundings.
    #[default]
    All,
    /// Spheres meet the surroundings only, and pass through each other.
    Surroundings,
    /// Spheres fly freely through everything.
    None,
}

/// What only the stepped engine asks.
///
/// ```
/// use carom::scene::SteppedSettings;
/// use carom::Impact;
///
/// let usual = SteppedSettings::default();
/// let settings = SteppedSettings { dt: Some(1e-3), impact: Impact::SubStep, ..usual };
/// assert_eq!(settings.integrator, usual.integrator);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteppedSettings {
    /// Length of a step, time. The stepped engine needs it.
    pub dt: Option<f64>,
    /// How a step of free flight is taken.
    pub integrator: Integrator,
    /// Where inside a step a contact takes effect.
    pub impact: Impact,
    /// When orientations are brought up to date.
    pub orientation: OrientationUpdate,
    /// How positions and velocities are added up from step to step.
    pub summation: Summation,
}

/// Where inside a step of the stepped engine a contact takes effect.
///
/// ```
/// use carom::{Impact, Plane, Scene, Sphere, Stepped};
///
/// // A ball comes to a floor in the middle of a step.
/// let height = |impact| -> Result<f64, Box<dyn std::error::Error>> {
///     let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([0.0, 0.0, -2.0]);
///     let floor = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
///     let scene = Scene::builder().dt(0.5).impact(impact).surroundings(floor).sphere(ball);
///     let mut world = Stepped::new(scene.build()?)?;
///     world.advance(0.5)?;
///     Ok(world.bodies().position_of(0).z)
/// };
/// assert_eq!(height(Impact::EndOfStep)?, 0.0);
/// assert_eq!(height(Impact::SubStep)?, 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Impact {
    /// At the end of the step, where the bodies are found to overlap: the fastest way.
    /// A sphere in a field may sink into what it lies on.
    EndOfStep,
    /// At the time of impact inside the step: back to contact, impulse at the
    /// true normal, forward again.
    #[default]
    SubStep,
}

impl fmt::Display for Impact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::EndOfStep => "at the end of a step",
            Self::SubStep => "at their time within a step",
        })
    }
}

/// When orientations are brought up to date.
///
/// ```
/// use carom::engine::Turning;
/// use carom::scene::OrientationUpdate;
/// use carom::{Scene, Sphere, Stepped};
///
/// let top = Sphere::new([0.0; 3]).radius(0.5).spin([0.0, 0.0, 1.0]);
/// let scene = Scene::<f64>::builder().dt(0.5).orientation(OrientationUpdate::EachStep);
/// let world = Stepped::new(scene.sphere(top).build()?)?;
/// assert_eq!(world.plan().turning, Turning::EachStep);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum OrientationUpdate {
    /// As a closed form of the last change of spin, when it is asked for.
    #[default]
    WhenAsked,
    /// `M ← R M` in each step.
    EachStep,
}

/// How the stepped engine adds up positions and velocities from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Summation {
    /// Compensated where steps are short beside the coordinates: less than `2²⁶`
    /// units in the last digit of these. In `f32` that is every scene, in `f64` few.
    #[default]
    Auto,
    /// Rounded in each step: a body that moves by less than half a unit in the last
    /// digit of its position stands still.
    Plain,
    /// What the rounding leaves out is added in the next step.
    Compensated,
}

/// What a scene file asks a run to write on its way, and how often.
///
/// ```
/// use carom::SceneFile;
/// let file = SceneFile::parse("ball", "[record]\nfile = \"ball.dump\"\nevery = 0.5\n")?;
/// let record = file.record()?;
/// assert_eq!((record.file, record.every), (Some("ball.dump".into()), Some(0.5)));
/// # Ok::<(), carom::SceneError>(())
/// ```
#[cfg(feature = "files")]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    /// The file.
    pub file: Option<std::path::PathBuf>,
    /// Time from one to the next.
    pub every: Option<f64>,
}

/// What of the bodies is analysed on the way of a run, or in the frames of one.
///
/// ```
/// use carom::scene::AnalysisKind;
/// assert_eq!(AnalysisKind::BondOrder.name(), "bond-order");
/// assert_eq!(AnalysisKind::ALL.len(), 7);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum AnalysisKind {
    /// How many bodies are at a distance from another, `g(r)`.
    RadialDistribution,
    /// How far bodies have moved after a time.
    MeanSquaredDisplacement,
    /// How much of a velocity is left after a time.
    VelocityAutocorrelation,
    /// How many bodies have a speed.
    SpeedDistribution,
    /// How long bodies fly from one collision to the next, and how far.
    CollisionStatistics,
    /// How the neighbours of a body are arranged, `q₆`.
    BondOrder,
    /// The density in waves, `S(k)`.
    StructureFactor,
}

impl AnalysisKind {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::RadialDistribution,
        Self::MeanSquaredDisplacement,
        Self::VelocityAutocorrelation,
        Self::SpeedDistribution,
        Self::CollisionStatistics,
        Self::BondOrder,
        Self::StructureFactor,
    ];

    /// What the scene file calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RadialDistribution => "radial-distribution",
            Self::MeanSquaredDisplacement => "mean-squared-displacement",
            Self::VelocityAutocorrelation => "velocity-autocorrelation",
            Self::SpeedDistribution => "speed-distribution",
            Self::CollisionStatistics => "collision-statistics",
            Self::BondOrder => "bond-order",
            Self::StructureFactor => "structure-factor",
        }
    }
}

/// An analysis and what is chosen of it; what is not chosen is by the bodies.
///
/// ```
/// use carom::scene::{AnalysisKind, AnalysisSettings};
/// let usual = AnalysisSettings::of(AnalysisKind::RadialDistribution);
/// let settings = AnalysisSettings { bins: Some(400), range: Some([None, Some(3.0)]), ..usual };
/// assert_eq!(settings.species, None);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AnalysisSettings {
    /// What is analysed.
    pub kind: AnalysisKind,
    /// Into how many bins the range is divided.
    pub bins: Option<u64>,
    /// From where to where it goes: distances, times, wave numbers, scaled speeds.
    pub range: Option<[Option<f64>; 2]>,
    /// Of which kinds of bodies, as [`species`](crate::observe::species) counts them from 1;
    /// of all by default.
    pub species: Option<Vec<u64>>,
}

impl AnalysisSettings {
    /// An analysis with nothing chosen.
    #[must_use]
    pub fn of(kind: AnalysisKind) -> Self {
        Self { kind, bins: None, range: None, species: None }
    }
}

/// The most bodies that a scene may have: one hundred million.
///
/// ```
/// assert_eq!(carom::scene::MOST_BODIES, 100_000_000);
/// ```
pub const MOST_BODIES: u64 = 100_000_000;

/// The most steps that a run may have: `2⁵³`, up to which their count is exact
/// in an `f64`.
///
/// ```
/// assert_eq!(carom::scene::MOST_STEPS, 2.0_f64.powi(53));
/// ```
pub const MOST_STEPS: f64 = 9_007_199_254_740_992.0;
