//! Order: which collision is the first that is not the double-double's.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::engine::{Event, Partner};
use crate::real::Real;

/// A collision, as far as its place in the order goes.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// When.
    pub time: f64,
    /// The first body.
    pub body: u32,
    /// What it met.
    pub met: Met,
}

/// What a body met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Met {
    /// Another body.
    Body(u32),
    /// A part of the surroundings.
    Surroundings(u32),
}

/// A collision that is not the double-double's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Departure {
    /// The double-double's collision in whose place it is, from 1.
    pub collision: u64,
    /// When that is.
    pub time: f64,
    /// Collisions per body up to it.
    pub collisions_per_body: f64,
}

/// The first ones of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Departures {
    /// The first that is out of order. Two that have nothing to do with each
    /// other may be interchanged: no body notices.
    pub order: Option<Departure>,
    /// The first that a body has with another partner than it should.
    pub partner: Option<Departure>,
}

impl Seen {
    /// Of an engine's report.
    #[must_use]
    pub fn of<T: Real>(event: &Event<T>) -> Self {
        let met = match event.partner {
            Partner::Body { index, .. } => Met::Body(index),
            Partner::Surroundings(part) => Met::Surroundings(part),
        };
        Self { time: event.time, body: event.a, met }
    }

    /// The bodies that take part, each with what it met.
    fn parties(self) -> impl Iterator<Item = (u32, Met)> {
        let other = match self.met {
            Met::Body(other) => Some((other, Met::Body(self.body))),
            Met::Surroundings(_) => None,
        };
        [Some((self.body, self.met)), other].into_iter().flatten()
    }
}

/// What only one of the two runs has had so far of a body's collisions: what it
/// should meet, and what it has met.
type Ahead = (VecDeque<(Met, Departure)>, VecDeque<Met>);

/// Compares the collisions of a run with those that should be.
#[derive(Debug)]
pub struct Comparer {
    bodies: usize,
    found: Departures,
    /// Collisions of the double-double so far, and the ends of flights in them.
    counted: (u64, u64),
    /// What only one of the two has had so far.
    ahead: VecDeque<(Seen, Departure)>,
    ahead_here: VecDeque<Seen>,
    of_each: Vec<Ahead>,
}

impl Comparer {
    /// For so many bodies.
    #[must_use]
    pub fn new(bodies: usize) -> Self {
        Self {
            bodies,
            found: Departures::default(),
            counted: (0, 0),
            ahead: VecDeque::new(),
            ahead_here: VecDeque::new(),
            of_each: vec![(VecDeque::new(), VecDeque::new()); bodies],
        }
    }

    /// Whether there is nothing left to find.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.found.partner.is_some()
    }

    /// What was found so far.
    #[must_use]
    pub fn found(&self) -> Departures {
        self.found
    }

    /// Goes on with the collisions of a stretch of time: those that should be
    /// and those that are.
    pub fn compare(&mut self, should: &[Seen], is: &[Seen]) {
        if self.is_done() {
            return;
        }
        for seen in should {
            self.counted.0 += 1;
            self.counted.1 += seen.parties().count() as u64;
            let place = Departure {
                collision: self.counted.0,
                time: seen.time,
                collisions_per_body: self.counted.1 as f64 / self.bodies as f64,
            };
            self.ahead.push_back((*seen, place));
            for (body, met) in seen.parties() {
                self.of_each[body as usize].0.push_back((met, place));
            }
        }
        for seen in is {
            self.ahead_here.push_back(*seen);
            for (body, met) in seen.parties() {
                self.of_each[body as usize].1.push_back(met);
            }
        }
        self.compare_order();
        self.compare_partners();
    }

    fn compare_order(&mut self) {
        while self.found.order.is_none() && !self.ahead_here.is_empty() {
            let Some((should, place)) = self.ahead.pop_front() else { return };
            let is = self.ahead_here.pop_front();
            if is.is_none_or(|is| (is.body, is.met) != (should.body, should.met)) {
                self.found.order = Some(place);
            }
        }
        if self.found.order.is_some() {
            self.ahead.clear();
            self.ahead_here.clear();
        }
    }

    fn compare_partners(&mut self) {
        for (should, is) in &mut self.of_each {
            while let (Some(&(met, place)), Some(&found)) = (should.front(), is.front()) {
                if met != found {
                    let earliest = self.found.partner.is_none_or(|old| place.time < old.time);
                    if earliest {
                        self.found.partner = Some(place);
                    }
                    break;
                }
                should.pop_front();
                is.pop_front();
            }
        }
    }
}
