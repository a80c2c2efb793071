//! Seat: the scene in a lane.

use super::setting::Setting;
use crate::engine::Collisions;
use crate::engine::plan::{Plan, Turning};
use crate::engine::stepped::Orientations;
use crate::real::Real;
use crate::scene::Impact;

/// The scene in a lane.
#[derive(Debug)]
pub struct Seat<T: Real> {
    /// Its number; `None` where the lane is empty.
    pub scene: Option<usize>,
    pub exact_dt: f64,
    /// Steps taken, and those after which it rests.
    pub steps: u64,
    pub goal: u64,
    pub collisions: Collisions,
    pub orientations: Orientations<T>,
    /// Whether its bodies have orientations of their own.
    pub has_orientation: bool,
    /// What is in the lane, while it goes on without that.
    pub parked: Vec<T>,
}

impl<T: Real> Seat<T> {
    /// A lane without a scene.
    pub fn empty(setting: &Setting<T>) -> Self {
        let Plan { changes_spins, bodies, impact, .. } = setting.plan;
        // Of what never changes one form from the start is enough.
        let turning = if changes_spins { Turning::FromLastContact } else { Turning::FromStart };
        Self {
            scene: None,
            exact_dt: 0.0,
            steps: 0,
            goal: 0,
            collisions: Collisions::default(),
            orientations: Orientations::new(turning, bodies, impact == Impact::SubStep),
            has_orientation: false,
            parked: Vec::new(),
        }
    }

    /// Whether it has not reached its goal.
    pub fn is_under_way(&self) -> bool {
        self.scene.is_some() && self.steps < self.goal
    }

    /// Whether what is in the lane is kept aside.
    pub fn is_parked(&self) -> bool {
        !self.parked.is_empty()
    }

    /// Time since the start of its scene.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.exact_dt
    }
}
