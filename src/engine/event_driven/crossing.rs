//! Crossing: when a body leaves its cell, and what it finds in the next one.

use super::EventDriven;
use crate::lane::Lane;
use crate::real::Real;

/// The face of a cell that a body leaves it through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Exit {
    pub axis: u8,
    pub up: bool,
}

/// How long a point at `place` that moves with `speed` and `acceleration` stays
/// in the span from `low` to `high`, and whether it leaves upwards. It is inside, or beyond an
/// end by rounding.
fn leaves<T: Real>([low, high]: [T; 2], place: T, speed: T, acceleration: T) -> (T, bool) {
    let positive = |value: T| value.greater(T::ZERO);
    if acceleration == T::ZERO {
        let up = speed > T::ZERO;
        let way = if up { high - place } else { place - low };
        return (positive(way) / speed.abs(), up);
    }
    // The way ahead in the direction of the acceleration, and against it.
    let is_up = acceleration > T::ZERO;
    let (along, against) =
        if is_up { (high - place, place - low) } else { (place - low, high - place) };
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

impl<T: Real> EventDriven<T> {
    /// Works out when the body at a place leaves its cell.
    pub(super) fn plan_crossing(&mut self, place: u32, now: T) {
        if !self.has_cells {
            self.agendas[place as usize].leaves_cell = self.period;
            return;
        }
        let (position, velocity) = self.state_of(place as usize, now);
        let (position, velocity) = (position.to_array(), velocity.to_array());
        let gravity = self.gravity.to_array();
        let agenda = &mut self.agendas[place as usize];
        let mut first = (T::from_f64(1e30), Exit { axis: 0, up: false });
        for axis in 0..3 {
            let bounds = self.cells.bounds(agenda.cell, axis);
            let (time, up) = leaves(bounds, position[axis], velocity[axis], gravity[axis]);
            if time < first.0 {
                first = (time, Exit { axis: axis as u8, up });
            }
        }
        agenda.leaves_cell = now + first.0;
        agenda.exit = first.1;
    }

    /// Takes the body at a place to the next cell, and looks who is ahead.
    pub(super) fn cross(&mut self, place: u32, now: T) {
        self.effort.crossings += 1;
        let agenda = &mut self.agendas[place as usize];
        let Exit { axis, up } = agenda.exit;
        let axis = usize::from(axis);
        let from = agenda.cell;
        agenda.cell[axis] += if up { 1 } else { -1 };
        let cell = agenda.cell;
        if self.plan.has_pairs {
            self.cells.remove(from, place);
            self.cells.insert(cell, place);
            self.make_room();
        }
        self.plan_crossing(place, now);
        if self.plan.features > 0 {
            self.search_features_of_cell(place);
        }
        if self.plan.has_pairs {
            let len = self.cells.ahead(cell, axis, up, &mut self.found);
            (self.search_bodies)(self, place, len, now);
        }
    }

    /// Keeps the buffer as large as the cells may ask.
    pub(super) fn make_room(&mut self) {
        let most = self.cells.most();
        if self.found.len() < most {
            self.found.resize(most, 0);
        }
    }
}
