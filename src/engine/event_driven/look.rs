//! Look: what can be seen of the world at any time, without touching it.

use super::agenda::{Agenda, Mark};
use super::flight::Record;
use super::{Effort, EventDriven};
use crate::bodies::Bodies;
use crate::column::Column;
use crate::compensated::CompensatedSum;
use crate::engine::Collisions;
use crate::engine::plan::{Plan, Turning};
use crate::mat3::Mat3;
use crate::motion::flight::Wrap;
use crate::motion::integrator::{Coasting, VelocityVerlet};
use crate::motion::rotation::turned;
use crate::real::Real;
use crate::vec3::Vec3;

impl<T: Real> EventDriven<T> {
    /// What the scene needs.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Time since the start.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The uniform acceleration, length per time².
    #[must_use]
    pub fn gravity(&self) -> Vec3<T> {
        self.gravity
    }

    /// Collisions since the start.
    #[must_use]
    pub fn collisions(&self) -> Collisions {
        self.collisions
    }

    /// The sum of all impulses of the surroundings on the bodies since the
    /// start, mass × length per time.
    #[must_use]
    pub fn impulse_from_surroundings(&self) -> [f64; 3] {
        self.tallies.impulse()
    }

    /// `Σ J_n·(c_a − c_b)` over all collisions of pairs since the start, mass ×
    /// length² per time: the collisions' part of the virial pressure.
    #[must_use]
    pub fn virial(&self) -> f64 {
        self.tallies.virial()
    }

    /// Mean length of the flights between collisions, those under way counted
    /// up to now: the sum of all ways over the number of their ends. `None`
    /// before the first collision. In a field the ways are taken as straight.
    #[must_use]
    pub fn mean_free_path(&self) -> Option<f64> {
        let ends = self.collisions.ends();
        let now = self.now();
        let under_way: CompensatedSum = (0..self.records.len())
            .map(|place| {
                let flight = self.records[place].flight();
                (flight.velocity.length() * (now - flight.since)).to_f64()
            })
            .collect();
        (ends > 0).then(|| (self.tallies.path() + under_way.value()) / ends as f64)
    }

    /// Now, since the period's start.
    pub(super) fn now(&self) -> T {
        self.in_period(self.time)
    }

    /// What it took to find the collisions so far.
    #[must_use]
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// The bodies now, in the scene's order.
    #[must_use]
    pub fn bodies(&self) -> Bodies<T> {
        let len = self.records.len();
        let now = self.now();
        let columns = || core::array::from_fn(|_| Column::new(len, T::ZERO));
        let mut bodies = self.bodies.clone();
        (bodies.position, bodies.velocity, bodies.spin) = (columns(), columns(), columns());
        if self.plan.turning != Turning::Never {
            let rows = Mat3::<T>::IDENTITY.rows();
            bodies
                .orientation
                .get_or_insert_with(|| Box::new(rows.map(|element| Column::new(len, element))));
        }
        for place in 0..len {
            let at = self.index[place] as usize;
            let (position, velocity) = self.state_of(place, now);
            let position = self.periodic.map_or(position, |space| space.wrap(position));
            let spin = self.spin_of(place);
            for k in 0..3 {
                bodies.position[k][at] = position.to_array()[k];
                bodies.velocity[k][at] = velocity.to_array()[k];
                bodies.spin[k][at] = spin.to_array()[k];
            }
            let orientation = match self.turned.get(place) {
                Some(&(orientation, since)) => turned(orientation, spin, now - since),
                None => turned(self.bodies.orientation_of(at), spin, T::from_f64(self.time)),
            };
            if let Some(rows) = &mut bodies.orientation {
                for (column, element) in rows.iter_mut().zip(orientation.rows()) {
                    column[at] = element;
                }
            }
        }
        bodies
    }

    /// Centre and velocity of the body at a place, at a time of this period.
    #[inline(always)]
    pub(super) fn state_of(&self, place: usize, time: T) -> (Vec3<T>, Vec3<T>) {
        let flight = self.records[place].flight();
        if self.plan.has_field {
            flight.at::<VelocityVerlet>(time, self.gravity)
        } else {
            flight.at::<Coasting>(time, self.gravity)
        }
    }

    /// Angular velocity of the body at a place.
    #[inline(always)]
    pub(super) fn spin_of(&self, place: usize) -> Vec3<T> {
        match self.spins.get(place) {
            Some(&spin) => spin,
            None => self.bodies.spin_of(self.index[place] as usize),
        }
    }

    /// The bytes of memory that the engine holds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.records.capacity() * size_of::<Record<T>>()
            + self.agendas.capacity() * size_of::<Agenda<T>>()
            + self.marks.capacity() * size_of::<Mark>()
            + self.spins.capacity() * size_of::<Vec3<T>>()
            + self.turned.capacity() * size_of::<(Mat3<T>, T)>()
            + self.index.capacity() * size_of::<u32>()
            + self.bodies.bytes()
            + self.inverse_mass.bytes()
            + self.inverse_inertia.bytes()
            + self.coarse.bytes()
            + self.cells.bytes()
            + self.calendar.bytes()
            + self.near.bytes()
    }
}
