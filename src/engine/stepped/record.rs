//! Record: the events of one step, put in their order.

use core::cmp::Ordering;

use super::contacts::Contact;
use crate::engine::Event;
use crate::real::Real;

/// The events of one step.
#[derive(Debug)]
pub(super) struct Record<T: Real> {
    events: Vec<(Contact<T>, Event<T>)>,
}

impl<T: Real> Default for Record<T> {
    fn default() -> Self {
        Self { events: Vec::new() }
    }
}

impl<T: Real> Record<T> {
    pub fn push(&mut self, contact: Contact<T>, event: Event<T>) {
        self.events.push((contact, event));
    }

    /// Reports the events in order of time, equal times by rank.
    pub fn report(mut self, on_event: &mut dyn FnMut(&Event<T>)) {
        self.events.sort_by(|(a, one), (b, other)| {
            let times = one.time.partial_cmp(&other.time).unwrap_or(Ordering::Equal);
            times.then_with(|| a.rank.cmp(&b.rank))
        });
        for (_, event) in &self.events {
            on_event(event);
        }
    }
}
