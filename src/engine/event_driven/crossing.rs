//! Crossing: when a body leaves its cell, and what it finds in the next one.

use core::hint::select_unpredictable;

use super::agenda::Exit;
use super::features::search_features_of_cell;
use super::region::Region;
use super::search::{Blocked, Nearby, search_greater, search_shell};
use super::setting::Setting;
use crate::lane::Lane;
use crate::real::Real;

/// How long a point at `position` that moves with `speed` and `acceleration` stays
/// in the span from `low` to `high`, and whether it leaves upwards. It is inside,
/// or beyond an end by rounding.
#[inline]
fn leaves<T: Real>([low, high]: [T; 2], position: T, speed: T, acceleration: T) -> (T, bool) {
    let positive = |value: T| value.greater(T::ZERO);
    if acceleration == T::ZERO {
        if speed == T::ZERO {
            return (T::from_f64(f64::INFINITY), false);
        }
        // Without branches: which way it is cannot be predicted. The other end is behind.
        let ends = [(high - position) / speed, (low - position) / speed];
        return (positive(ends[0].greater(ends[1])), speed.gt(T::ZERO));
    }
    // The way ahead in the direction of the acceleration, and against it.
    let is_up = acceleration > T::ZERO;
    let (along, against) =
        if is_up { (high - position, position - low) } else { (position - low, high - position) };
    let speed = if is_up { speed } else { -speed };
    let strength = acceleration.abs();
    let two = T::whole(2);
    if speed < T::ZERO {
        let rest = speed * speed - two * strength * positive(against);
        if rest > T::ZERO {
            return (two * positive(against) / (Lane::sqrt(rest) - speed), !is_up);
        }
    }
    let root = Lane::sqrt(speed * speed + two * strength * positive(along));
    let time = if speed > T::ZERO {
        two * positive(along) / (root + speed)
    } else {
        (root - speed) / strength
    };
    (time, is_up)
}

/// Works out when the body in a slot leaves its cell.
#[inline(always)]
pub(super) fn plan_crossing<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    now: T,
    period: T,
) {
    if !setting.has_cells {
        region.agendas[slot as usize].leaves_cell = period;
        return;
    }
    let (position, velocity) = region.state_of(setting, slot as usize, now);
    let (position, velocity) = (position.to_array(), velocity.to_array());
    let gravity = setting.gravity.to_array();
    let agenda = &mut region.agendas[slot as usize];
    let (mut first, mut exit) = (T::from_f64(1e30), Exit { axis: 0, up: false });
    for axis in 0..3 {
        let bounds = region.cells.finest.grid.bounds(agenda.cell, axis);
        let (time, up) = leaves(bounds, position[axis], velocity[axis], gravity[axis]);
        // Without branches: which axis it is cannot be predicted.
        let is_first = time.lt(first);
        first = select_unpredictable(is_first, time, first);
        exit = select_unpredictable(is_first, Exit { axis: axis as u8, up }, exit);
    }
    agenda.leaves_cell = now + first;
    agenda.exit = exit;
}

/// Takes the body in a slot to the next cell, and looks who is ahead.
pub(super) fn cross<T: Real>(
    setting: &Setting<T>,
    region: &mut Region<'_, T>,
    slot: u32,
    now: T,
    period: T,
) -> Result<(), Blocked> {
    let agenda = &region.agendas[slot as usize];
    let Exit { axis, up } = agenda.exit;
    let axis = usize::from(axis);
    let from = agenda.cell;
    let mut cell = from;
    cell[axis] += if up { 1 } else { -1 };
    let level = region.level_of(slot as usize);
    let is_new = |region: &Region<'_, T>, level: usize| {
        region.cells.len() == 1
            || region.cells.cell_at(level, from) != region.cells.cell_at(level, cell)
    };
    let is_entered = setting.plan.has_pairs && is_new(region, level);
    let mut nearby = Nearby { list: 0, len: 0 };
    if is_entered {
        let own = region.cells.cell_at(level, cell);
        let members = region.cells.at(level);
        let found = &mut region.worker.found[0];
        nearby.len = members.ahead(own, axis, up, found).ok_or(Blocked)?;
        if !region.holds_found(0, nearby.len) || !region.can_enter(cell, 1) {
            return Err(Blocked);
        }
    }
    region.worker.account.effort.crossings += 1;
    if is_entered {
        region.move_to(level, slot, cell);
    }
    region.agendas[slot as usize].cell = cell;
    plan_crossing(setting, region, slot, now, period);
    if setting.plan.features > 0 {
        search_features_of_cell(setting, region, slot, now);
    }
    if !setting.plan.has_pairs {
        return Ok(());
    }
    if is_entered {
        (setting.search_bodies)(setting, region, slot, nearby, now);
        search_greater(setting, region, slot, level, now);
    }
    for finer in level + 1..region.cells.len() {
        if is_new(region, finer) {
            search_shell(setting, region, slot, [level, finer], now);
        }
    }
    Ok(())
}
