//! Snapshot: what the stepped engine has to remember at the end of a step.

use serde::{Deserialize, Serialize};

use super::clock::Clock;
use super::region::Region;
use super::setting::Setting;
use super::state::Low;
use crate::bodies::{Bodies, Columns3};
use crate::column::Column;
use crate::engine::snapshot::{Misfit, Reals, Reals3, columns3, reals3};
use crate::numbers::array::{self, Each};
use crate::real::Real;

/// The bodies by index, whatever slots they are in.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::engine) struct StepState {
    steps: u64,
    position: Reals3,
    velocity: Reals3,
    /// What the rounding of positions and of velocities leaves out.
    low: Option<[Reals3; 2]>,
    spin: Reals3,
    orientation: Option<[Reals; 9]>,
    marks: Marks,
}

/// When the stored orientations were true.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Marks {
    pub step: Vec<u32>,
    pub ago: Option<Reals>,
    pub counted_from: u64,
}

/// What is to be remembered.
pub(super) fn save<T: Real>(region: &Region<T>, clock: &Clock) -> StepState {
    let state = &region.state;
    let ordered = |columns: &Columns3<T>| reals3(&state.by_index(columns));
    StepState {
        steps: clock.steps,
        position: ordered(&state.position),
        velocity: ordered(&state.velocity),
        low: state.low.as_ref().map(|low| {
            let is_empty = low.velocity[0].is_empty();
            let velocity = if is_empty { reals3(&low.velocity) } else { ordered(&low.velocity) };
            [ordered(&low.position), velocity]
        }),
        spin: reals3(&state.spin),
        orientation: state
            .orientation
            .as_ref()
            .map(|rows| rows.refs().each(|column| Reals::of(column.iter().copied()))),
        marks: state.orientations.save(),
    }
}

/// Goes on from there, with a region of the scene at its start.
pub(super) fn restore<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<T>,
    clock: &mut Clock,
    mut bodies: Bodies<T>,
    saved: &StepState,
) -> Result<(), Misfit> {
    let len = bodies.len();
    // As they are stored, not as they are shown.
    bodies.orientation.clone_from(&region.state.orientation);
    let mut fresh = Region::new(setting, bodies);
    let state = &mut fresh.state;
    state.position = columns3(&saved.position, len, "positions")?;
    state.velocity = columns3(&saved.velocity, len, "velocities")?;
    state.spin = columns3(&saved.spin, len, "spins")?;
    match (&mut state.low, &saved.low) {
        (None, None) => {}
        (Some(low), Some([position, velocity])) => {
            let moved = low.velocity[0].len();
            let position = columns3(position, len, "sums of positions")?;
            let velocity = columns3(velocity, moved, "sums of velocities")?;
            **low = Low { position, velocity };
        }
        _ => return Err(Misfit("sums")),
    }
    state.orientation = match &saved.orientation {
        None if state.orientation.is_none() => None,
        None => return Err(Misfit("orientations")),
        Some(rows) => {
            let mut columns: [Column<T>; 9] = array::from_fn(|_| Column::new(0, T::ZERO));
            for (column, row) in columns.iter_mut().zip(rows) {
                *column = row.column(len, "orientations")?;
            }
            Some(Box::new(columns))
        }
    };
    state.orientations.restore(&saved.marks)?;
    clock.steps = saved.steps;
    *region = fresh;
    Ok(())
}
