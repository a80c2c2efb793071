//! Turns: body after body, whoever is next.

use core::cmp::Ordering;

use super::EventDriven;
use super::agenda::{Agenda, Next};
use super::calendar::Turn;
use super::search::rank;
use crate::engine::{EngineError, Listener};
use crate::real::Real;

/// Turns that may pass while time stands still, for scenes of few bodies.
const PATIENCE: u64 = 1 << 20;

impl<T: Real> EventDriven<T> {
    /// Sees to it that time advances.
    #[inline(always)]
    pub(super) fn check_progress(&mut self, turn: Turn<T>) -> Result<(), EngineError> {
        if turn.time > self.progress {
            self.progress = turn.time + self.period * (T::EPSILON * T::whole(64));
            self.standstill = 0;
            return Ok(());
        }
        self.standstill += 1;
        if self.standstill <= PATIENCE + 64 * self.records.len() as u64 {
            return Ok(());
        }
        self.time = self.origin.value() + turn.time.to_f64();
        let (events, time) = (self.standstill, self.time);
        Err(EngineError::Stalled { time, events, body: self.index[turn.place as usize] })
    }

    #[inline(always)]
    pub(super) fn next_turn(&mut self) -> Option<Turn<T>> {
        let (agendas, index) = (&self.agendas, &self.index);
        self.calendar
            .next(|place| agendas[place as usize].next_time(), |a, b| order(agendas, index, a, b))
    }

    /// Enters the next turn of the body at a place.
    #[inline(always)]
    pub(super) fn enter(&mut self, place: u32) {
        let time = self.agendas[place as usize].next_time();
        let (agendas, index) = (&self.agendas, &self.index);
        self.calendar.enter(Turn { time, place }, |a, b| order(agendas, index, a, b));
    }

    #[inline(always)]
    pub(super) fn take_turn(&mut self, turn: Turn<T>, on_event: &mut Listener<'_, T>) {
        let Turn { time, place } = turn;
        self.turns += 1;
        match self.agendas[place as usize].next() {
            Next::LeavesCell => self.cross(place, time),
            Next::Searches => {
                self.effort.searches += 1;
                self.search(place, time);
            }
            Next::Meets(expected) => match expected.partner.decoded() {
                Err(feature) => {
                    self.collide_with_feature(place, feature, time, on_event);
                    return;
                }
                Ok(other) if self.marks[other as usize].changes == expected.changes => {
                    self.collide_pair(place, other, time, on_event);
                    return;
                }
                Ok(_) => self.agendas[place as usize].drop_first(),
            },
        }
        self.enter(place);
    }
}

/// The order of turns at equal times: what is no collision first, so that all
/// collisions of that time are known before one happens.
fn order<T: Real>(agendas: &[Agenda<T>], index: &[u32], a: u32, b: u32) -> Ordering {
    let of = |place: u32| match agendas[place as usize].next() {
        Next::Meets(expected) => Some(rank(index, place, expected.partner)),
        _ => None,
    };
    of(a).cmp(&of(b))
}
