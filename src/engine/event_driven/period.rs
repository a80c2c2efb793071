//! Period: a stretch of time with an origin of its own.
//!
//! Times are counted from the period's start, so that a long run has times as
//! exact as a short one. Where a period begins, every flight starts anew, bodies
//! are sorted by cell and all that is ahead is looked for again.

use super::EventDriven;
use super::agenda::{Agenda, Mark, PartnerCode};
use super::coarse::Scales;
use super::flight::{Flight, Record};
use crate::column::Column;
use crate::engine::plan::Turning;
use crate::motion::flight::Wrap;
use crate::motion::rotation::turned;
use crate::real::Real;
use crate::space::Space;

/// How far bodies fly in a period, in mean distances, at the mean speed.
const FLIGHT: f64 = 8.0;

/// How much faster than the mean the fastest body may be before it is the one
/// that a period is measured by.
const FAST: f64 = 8.0;

/// Turns for which a span of the calendar is made.
const TOGETHER: f64 = 24.0;

/// Turns for each body in the first period, before any were counted.
const TURNS: f64 = 64.0;

/// The longest period, about 10²⁴, for bodies that meet nothing or stand still.
const LONGEST: f64 = (1_u128 << 80) as f64;

impl<T: Real> EventDriven<T> {
    /// Puts the bodies of the scene in their places, and begins the first
    /// period.
    pub(super) fn settle(&mut self) {
        let len = self.bodies.len();
        let bodies = &self.bodies;
        let flight = |index: usize| Flight {
            position: bodies.position_of(index),
            velocity: bodies.velocity_of(index),
            since: T::ZERO,
            radius: bodies.radius.of(index),
        };
        self.records = (0..len).map(|index| Record::new(flight(index))).collect();
        if self.plan.turning == Turning::FromLastContact {
            self.spins = (0..len).map(|index| bodies.spin_of(index)).collect();
            self.turned = (0..len).map(|index| (bodies.orientation_of(index), T::ZERO)).collect();
        }
        // What is kept by place is kept once.
        let nothing = || core::array::from_fn(|_| Column::new(0, T::ZERO));
        (self.bodies.position, self.bodies.velocity) = (nothing(), nothing());
        if !self.spins.is_empty() {
            (self.bodies.spin, self.bodies.orientation) = (nothing(), None);
        }
        self.marks = vec![Mark { changes: 0, last: PartnerCode::NONE }; len];
        self.agendas = vec![Agenda::new([0; 3]); len];
        self.begin_period(T::ZERO);
    }

    /// A time since the start of the run, as one since the start of the present
    /// period.
    pub(super) fn in_period(&self, time: f64) -> T {
        T::from_f64(time - self.origin.value()) - T::from_f64(self.origin.remainder())
    }

    /// Ends the present period at a time of it, and begins the next one.
    pub(super) fn begin_period(&mut self, end: T) {
        for place in 0..self.records.len() {
            self.end_flight(place, end, T::ZERO);
        }
        let rounded = end.to_f64();
        self.origin.add(rounded);
        // What a finer precision than `f64` has besides.
        self.origin.add((end - T::from_f64(rounded)).to_f64());
        self.is_too_fast = false;
        self.last_time = T::ZERO;
        self.progress = T::ZERO;
        self.choose_period();
        let turns = if self.turns == 0 || end == T::ZERO {
            TURNS * self.records.len() as f64 / self.period.to_f64()
        } else {
            self.turns as f64 / end.to_f64()
        };
        self.calendar.begin(self.period, turns, TOGETHER);
        self.turns = 0;
        self.sort();
        self.coarse.begin(&self.records, &self.scales());
        for place in 0..self.records.len() as u32 {
            self.plan_crossing(place, T::ZERO);
            self.search(place, T::ZERO);
            self.enter(place);
        }
    }

    /// Ends the flight of the body at a place at a time. The next one starts at
    /// `since`, which is that time or, in the next period, its start.
    #[inline(always)]
    pub(super) fn end_flight(&mut self, place: usize, time: T, since: T) {
        let (position, velocity) = self.state_of(place, time);
        let before = self.records[place].flight();
        self.tallies.flight(before.velocity.length() * (time - before.since));
        let mut flight = Flight { position, velocity, since, radius: before.radius };
        if let Some(space) = self.periodic {
            flight.position = space.wrap(position);
            let turns = space.turns(position - flight.position);
            let cell = &mut self.agendas[place].cell;
            *cell = self.cells.turned_back(*cell, turns);
        }
        self.records[place] = Record::new(flight);
        if let Some((orientation, turned_at)) = self.turned.get_mut(place) {
            *orientation = turned(*orientation, self.spins[place], time - *turned_at);
            *turned_at = since;
        }
    }

    /// The power of two nearest below the time that bodies take for a few mean
    /// distances: multiples of it are added up without rounding.
    fn choose_period(&mut self) {
        if !self.plan.has_pairs && self.features.is_empty() {
            (self.period, self.too_fast) = (T::from_f64(LONGEST), T::from_f64(LONGEST));
            return;
        }
        let len = self.records.len();
        let mut squares = vec![0.0; len];
        for (record, &index) in self.records.iter().zip(&self.index) {
            squares[index as usize] = record.flight().velocity.length_squared().to_f64();
        }
        // In the scene's order: the sum must not depend on places.
        let mean = squares.iter().sum::<f64>() / len as f64;
        let most = squares.iter().fold(0.0, |most: f64, &square| most.max(square));
        let spacing = self.spacing.to_f64();
        let fallen = self.gravity.length().to_f64() * spacing;
        let speed = mean.max(most / (FAST * FAST)).max(fallen).sqrt();
        let flight = (FLIGHT * spacing / speed).clamp(1e-25, LONGEST);
        self.period = T::from_f64(power_of_two_below(flight));
        let limit = 2.0 * FAST * speed;
        self.too_fast = T::from_f64((limit * limit).max(1e-30));
    }

    /// What the errors of the coarse precision are measured by.
    fn scales(&self) -> Scales {
        let greatest = |most: f64, value: T| most.max(value.to_f64().abs());
        let extent = self.records.iter().fold(0.0, |most, record| {
            record.flight().position.to_array().into_iter().fold(most, greatest)
        });
        let least = self
            .records
            .iter()
            .fold(f64::INFINITY, |least: f64, record| least.min(record.flight().radius.to_f64()));
        let fallen = self.gravity.length().to_f64() * self.period.to_f64();
        Scales {
            extent,
            neighbourhood: self.cells.neighbourhood(),
            reach: 2.0 * least,
            speed: self.too_fast.to_f64().sqrt() + fallen,
            period: self.period.to_f64(),
        }
    }

    /// Sorts the bodies by cell: neighbours in space become neighbours in
    /// memory.
    fn sort(&mut self) {
        let cells = &mut self.cells;
        cells.clear();
        let mut order: Vec<(u32, u32, u32)> = Vec::with_capacity(self.records.len());
        for (place, record) in self.records.iter().enumerate() {
            let cell = cells.cell_of(record.flight().position);
            order.push((cells.number_of(cell), self.index[place], place as u32));
        }
        order.sort_unstable();
        let records = &self.records;
        let from = |place: &(u32, u32, u32)| place.2 as usize;
        self.records = order.iter().map(|place| records[from(place)]).collect();
        self.index = order.iter().map(|place| place.1).collect();
        if !self.turned.is_empty() {
            self.spins = order.iter().map(|place| self.spins[from(place)]).collect();
            self.turned = order.iter().map(|place| self.turned[from(place)]).collect();
        }
        self.marks = order.iter().map(|place| self.marks[from(place)]).collect();
        let agenda = |record: &Record<T>| Agenda::new(cells.cell_of(record.flight().position));
        self.agendas = self.records.iter().map(agenda).collect();
        if self.plan.has_pairs {
            for place in 0..self.records.len() {
                self.cells.insert(self.agendas[place].cell, place as u32);
            }
            self.make_room();
        }
    }
}

/// The greatest power of two that is not above a positive number. By its bits: a
/// platform's logarithm may round across one.
fn power_of_two_below(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & f64::INFINITY.to_bits())
}
