//! Plan: what a scene needs, found once before it runs.
//!
//! A scene pays only for what it uses. The plan says which figures are loaded,
//! computed and stored, and which kernels do it; `carom explain` prints it.

use core::fmt;

use super::{Execution, Impact, Lanes, OrientationUpdate};
use crate::bodies::PerBody;
use crate::contact::Surface;
use crate::motion::Integrator;
use crate::real::Real;
use crate::scene::{Encounters, Scene};

/// What becomes of the orientations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// No body spins and no contact can make it.
    Never,
    /// Spins never change: one closed form from the start, when asked.
    FromStart,
    /// Contacts change spins: a closed form from a body's last contact.
    FromLastContact,
    /// `M ← R M` for every body in each step.
    EachStep,
}

/// What a scene needs of the stepped engine.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The precision's name.
    pub precision: &'static str,
    /// How many bodies there are.
    pub bodies: usize,
    /// Worker threads.
    pub threads: usize,
    /// Reals at once in sweeps over all bodies.
    pub sweep_lanes: usize,
    /// Reals at once where bodies are gathered by pairs.
    pub gather_lanes: usize,
    /// Whether there is a field: velocities change in flight.
    pub has_field: bool,
    /// How flight is integrated.
    pub integrator: Integrator,
    /// When contacts take effect.
    pub impact: Impact,
    /// Whether positions are wrapped and differences taken to the nearest image.
    pub is_periodic: bool,
    /// Whether bodies meet each other.
    pub has_pairs: bool,
    /// How many fixed features bodies meet.
    pub features: usize,
    /// Whether contacts read and change spins.
    pub is_rough: bool,
    /// Whether radii are loaded for each body.
    pub has_radii: bool,
    /// Whether masses are loaded for each body.
    pub has_masses: bool,
    /// What becomes of the orientations.
    pub turning: Turning,
}

impl Plan {
    /// The plan of a scene.
    #[must_use]
    pub fn new<T: Real>(scene: &Scene<T>, execution: Execution, threads: usize) -> Self {
        let (sweep_lanes, gather_lanes) = lanes::<T>(execution.lanes);
        let is_rough = scene.surface == Surface::Rough && scene.encounters != Encounters::None;
        let bodies = &scene.bodies;
        let is_spinning = bodies.spin.iter().any(|column| column.iter().any(|&w| w != T::ZERO));
        let features = match scene.encounters {
            Encounters::None => 0,
            _ => scene.surroundings.iter().map(|shape| shape.features().len()).sum(),
        };
        let turning = match scene.stepped.orientation {
            _ if !is_rough && !is_spinning => Turning::Never,
            OrientationUpdate::EachStep => Turning::EachStep,
            OrientationUpdate::WhenAsked if is_rough => Turning::FromLastContact,
            OrientationUpdate::WhenAsked => Turning::FromStart,
        };
        Self {
            precision: T::NAME,
            bodies: bodies.len(),
            threads,
            sweep_lanes,
            gather_lanes,
            has_field: scene.gravity.to_array().iter().any(|&a| a != T::ZERO),
            integrator: scene.stepped.integrator,
            impact: scene.stepped.impact,
            is_periodic: scene.periodic.is_some(),
            has_pairs: scene.encounters == Encounters::All && bodies.len() > 1,
            features,
            is_rough,
            has_radii: matches!(bodies.radius, PerBody::Each(_)),
            has_masses: matches!(bodies.mass, PerBody::Each(_)),
            turning,
        }
    }
}

/// The widths for sweeps and for gathers. Measured: the widest packs are best
/// in sweeps; where lanes are filled one by one, half of it, and 16 never are.
fn lanes<T: Real>(lanes: Lanes) -> (usize, usize) {
    match lanes {
        Lanes::Auto if size_of::<T>() <= 4 => (16, 8),
        Lanes::Auto => (8, 4),
        Lanes::Scalar => (1, 1),
        Lanes::Four => (4, 4),
        Lanes::Eight => (8, 8),
        Lanes::Sixteen => (16, 8),
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut row = |what: &str, how: &str| writeln!(f, "{what:<22}{how}");
        let integrator = match self.integrator {
            Integrator::SemiImplicitEuler => "semi-implicit Euler",
            Integrator::ExplicitEuler => "explicit Euler",
            Integrator::VelocityVerlet => "velocity Verlet",
        };
        row("engine", "stepped")?;
        row("bodies", &format!("{} in {}", self.bodies, self.precision))?;
        row("lanes", &format!("{} in sweeps, {} in gathers", self.sweep_lanes, self.gather_lanes))?;
        row("threads", &self.threads.to_string())?;
        row(
            "flight",
            &if self.has_field {
                format!("{integrator}: positions and velocities are updated")
            } else {
                "no field: positions are updated, velocities only read".to_owned()
            },
        )?;
        row(
            "space",
            if self.is_periodic {
                "periodic: positions are wrapped, differences taken to the nearest image"
            } else {
                "open: no wrapping"
            },
        )?;
        row(
            "pairs",
            match (self.has_pairs, self.has_radii) {
                (false, _) => "skipped: bodies do not meet each other",
                (true, false) => "grid and candidate list; one radius for all, none is loaded",
                (true, true) => "grids by size and candidate list; radii are loaded",
            },
        )?;
        row(
            "surroundings",
            &match self.features {
                0 => "skipped: there is nothing to meet".to_owned(),
                1 => "1 feature, tested where a body is near".to_owned(),
                count => format!("{count} features, tested where a body is near"),
            },
        )?;
        let contacts = self.has_pairs || self.features > 0;
        row(
            "impact",
            match (contacts, self.impact) {
                (false, _) => "skipped: there are no contacts",
                (true, Impact::EndOfStep) => "at the end of the step",
                (true, Impact::SubStep) => "at the time of impact inside the step",
            },
        )?;
        row(
            "surfaces",
            match (contacts, self.is_rough) {
                (false, _) => "skipped: there are no contacts",
                (true, false) => "smooth: spins are never read",
                (true, true) => "rough: spins are read and changed at contacts",
            },
        )?;
        row(
            "masses",
            match (contacts, self.has_masses) {
                (false, _) => "skipped: there are no contacts",
                (true, false) => "one for all, none is loaded",
                (true, true) => "loaded at contacts",
            },
        )?;
        row(
            "orientations",
            match self.turning {
                Turning::Never => "skipped: nothing spins",
                Turning::FromStart => "one closed form from the start, when asked",
                Turning::FromLastContact => "a closed form from the last contact, when asked",
                Turning::EachStep => "turned in each step, as the scene wants it",
            },
        )
    }
}
