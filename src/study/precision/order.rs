//! Order: which collision is the first that is not the double-double's.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::engine::{Event, Partner};
use crate::real::Real;

/// A collision, as far as its position in the order goes.
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
    /// The double-double's collision that should have been there instead, from 1.
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
    /// For this number of bodies.
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

    /// What was found. A collision from before the time `before` that the other
    /// run has not had by the end is missing there, and no longer only late.
    #[must_use]
    pub fn finish(mut self, before: f64) -> Departures {
        let is_missing = |departure: &&Departure| departure.time < before;
        let missing =
            self.ahead.front().map(|(_, departure)| departure).filter(is_missing).copied();
        let surplus = self.ahead_here.front().map(|seen| Departure {
            collision: self.counted.0 + 1,
            time: seen.time,
            collisions_per_body: self.counted.1 as f64 / self.bodies as f64,
        });
        let ended = missing.or(surplus.filter(|departure| is_missing(&departure)));
        self.found.order = self.found.order.or(ended);
        let of_each = self.of_each.iter().filter_map(|(should, _)| should.front());
        let missing = of_each.map(|(_, departure)| departure).filter(is_missing);
        let first = missing.min_by(|a, b| a.time.total_cmp(&b.time)).copied();
        self.found.partner = self.found.partner.or(first).or(ended);
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
            let departure = Departure {
                collision: self.counted.0,
                time: seen.time,
                collisions_per_body: self.counted.1 as f64 / self.bodies as f64,
            };
            self.ahead.push_back((*seen, departure));
            for (body, met) in seen.parties() {
                self.of_each[body as usize].0.push_back((met, departure));
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
            let Some((should, departure)) = self.ahead.pop_front() else { return };
            let is = self.ahead_here.pop_front();
            if is.is_none_or(|is| (is.body, is.met) != (should.body, should.met)) {
                self.found.order = Some(departure);
            }
        }
        if self.found.order.is_some() {
            self.ahead.clear();
            self.ahead_here.clear();
        }
    }

    fn compare_partners(&mut self) {
        for (should, is) in &mut self.of_each {
            while let (Some(&(met, departure)), Some(&found)) = (should.front(), is.front()) {
                if met != found {
                    let earliest = self.found.partner.is_none_or(|old| departure.time < old.time);
                    if earliest {
                        self.found.partner = Some(departure);
                    }
                    break;
                }
                should.pop_front();
                is.pop_front();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(time: f64, body: u32, other: u32) -> Seen {
        Seen { time, body, met: Met::Body(other) }
    }

    #[test]
    fn order_and_partners_differ_apart() {
        let should = [pair(1.0, 0, 1), pair(1.1, 2, 3), pair(2.0, 0, 2), pair(3.0, 1, 3)];
        // The first two interchanged, which concerns no body; then others meet.
        let is = [should[1], should[0], should[2], pair(3.0, 1, 2)];
        let mut comparer = Comparer::new(4);
        comparer.compare(&should[..3], &is[..1]);
        comparer.compare(&should[3..], &is[1..]);
        let found = comparer.finish(0.0);
        let at = |departure: Option<Departure>| {
            departure.map(|departure| (departure.collision, departure.time))
        };
        assert_eq!(at(found.order), Some((1, 1.0)));
        assert_eq!(at(found.partner), Some((4, 3.0)));
        assert_eq!(found.order.map(|departure| departure.collisions_per_body), Some(0.5));
    }

    #[test]
    fn late_is_not_missing() {
        let all = [pair(1.0, 0, 1), pair(2.0, 0, 2), pair(3.0, 0, 1)];
        for (should, is, before, missing) in [
            (&all[..], &all[..], 3.5, None),
            (&all[..], &all[..2], 2.5, None),
            (&all[..], &all[..2], 3.5, Some(3)),
            (&all[..2], &all[..], 2.5, None),
            (&all[..2], &all[..], 3.5, Some(3)),
        ] {
            let mut comparer = Comparer::new(3);
            comparer.compare(should, is);
            let found = comparer.finish(before);
            assert_eq!(found.order.map(|departure| departure.collision), missing);
            assert_eq!(found.partner.map(|departure| departure.collision), missing);
        }
    }
}
