//! Work: packs and single worlds go on, on all threads, and what has gone wrong is found.

use super::pack::Pack;
use super::{Batch, Fault, Place, REPORTED};
use crate::engine::{ChangeError, Compiled, EngineError, Event, LONGEST_RUN, World};
use crate::real::Real;
use crate::scene::{MOST_STEPS, Scene};

/// What a world that runs alone does, with the number of its scene.
pub type Going<'a, T> = dyn Fn(usize, &mut World<T>) -> Result<(), EngineError> + Sync + 'a;

/// A scene that runs alone.
#[derive(Debug)]
pub struct Alone<T: Real> {
    pub scene: usize,
    pub world: World<T>,
    pub fault: Option<Fault>,
    pub events: Vec<Event<T>>,
}

impl<T: Real> Alone<T> {
    /// Notes why it does not go on, if it does not.
    fn note(&mut self, done: Result<(), EngineError>) {
        let bodies = self.world.bodies();
        let mut columns = bodies.position.iter().chain(&bodies.velocity);
        let is_finite = columns.all(|column| column.iter().all(|value| value.is_finite()));
        self.fault = match done {
            Err(error) => Some(Fault::Engine(error)),
            Ok(()) if !is_finite => Some(Fault::NotFinite { time: self.world.time() }),
            Ok(()) => None,
        };
    }
}

impl<T: Compiled> Batch<T> {
    pub(super) fn check_duration(&self, duration: f64) -> Result<(), EngineError> {
        let seats = self.packs.iter().flat_map(|pack| &pack.moving.seats);
        let lengths = seats.filter(|seat| seat.scene.is_some()).map(|seat| seat.exact_dt);
        let alone = self.alone.iter().filter_map(|alone| match &alone.world {
            World::Stepped(world) => Some(world.exact_dt()),
            World::EventDriven(_) => None,
        });
        let dt = lengths.chain(alone).fold(f64::INFINITY, f64::min);
        if !(0.0..LONGEST_RUN).contains(&duration) {
            return Err(EngineError::NoDuration(duration));
        }
        if duration / dt > MOST_STEPS {
            return Err(EngineError::Duration { duration, dt });
        }
        Ok(())
    }

    /// Lets all scenes go on: those in lanes to their goals.
    pub(in crate::engine) fn go_on(&mut self, alone: &Going<'_, T>) {
        let Self { setting, workers, meetings, packs, .. } = self;
        workers.each_with(meetings, packs, |meetings, pack| {
            pack.go(setting, meetings.as_mut(), u64::MAX, None);
        });
        workers.each(&mut self.alone, |one| {
            if !self.faults.contains_key(&one.scene) {
                let done = alone(one.scene, &mut one.world);
                one.note(done);
            }
        });
        self.find_faults();
    }

    /// All that [`for_each_event`](Batch::for_each_event) does once the time is known to be right.
    pub(in crate::engine) fn go_and_tell(
        &mut self,
        duration: f64,
        on_event: &mut dyn FnMut(usize, &Event<T>),
    ) {
        self.set_goals(|seat| seat.steps.saturating_add(steps_in(duration, seat.exact_dt)));
        self.recorded.resize_with(self.packs.len(), Vec::new);
        let Self { setting, workers, meetings, packs, alone, recorded, faults, .. } = self;
        while packs.iter().any(Pack::is_under_way) {
            let mut pieces: Vec<_> = packs.iter_mut().zip(&mut *recorded).collect();
            workers.each_with(meetings, &mut pieces, |meetings, (pack, events)| {
                pack.go(setting, meetings.as_mut(), REPORTED, Some(events));
            });
            for events in &mut *recorded {
                events.sort_by_key(|(scene, _)| *scene);
                events.iter().for_each(|(scene, event)| on_event(*scene, event));
                events.clear();
            }
        }
        workers.each(alone, |alone| {
            if !faults.contains_key(&alone.scene) {
                let Alone { world, events, .. } = alone;
                let done = world.for_each_event(duration, |event| events.push(*event));
                alone.note(done);
            }
        });
        for Alone { scene, events, .. } in alone {
            events.drain(..).for_each(|event| on_event(*scene, &event));
        }
        self.find_faults();
    }

    /// [`reset`](Batch::reset).
    pub(in crate::engine) fn put_back(
        &mut self,
        scene: usize,
        start: &Scene<T>,
    ) -> Result<(), ChangeError> {
        let place = self.place(scene)?;
        let checked;
        let start = if self.check.accepts(start) {
            start
        } else {
            checked = start.checked_again()?;
            &checked
        };
        match place {
            Place::Lane { pack, lane } if self.setting.takes(start) => {
                let pack = &mut self.packs[pack as usize];
                pack.seat(&self.setting, lane as usize, scene, start);
            }
            place => {
                let world = World::new(start.clone(), self.execution.threads(1))?;
                let alone = Alone { scene, world, fault: None, events: Vec::new() };
                match place {
                    Place::Alone(old) => self.alone[old as usize] = alone,
                    _ => {
                        self.places[scene] = Place::Alone(self.alone.len() as u32);
                        self.alone.push(alone);
                    }
                }
                if let Place::Lane { pack, lane } = place {
                    self.packs[pack as usize].vacate(&self.setting, lane as usize);
                }
            }
        }
        self.durations[scene] = start.duration.unwrap_or(f64::NAN);
        self.faults.remove(&scene);
        Ok(())
    }
}

/// The whole number of steps that is nearest to a duration.
pub(super) fn steps_in(duration: f64, dt: f64) -> u64 {
    if dt > 0.0 { (duration / dt).round() as u64 } else { 0 }
}
