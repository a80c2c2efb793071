//! State: the bodies as the stepped engine keeps them.

use super::orientations::Orientations;
use crate::bodies::{Bodies, Columns3, Origin, PerBody, at};
use crate::column::Column;
use crate::engine::plan::{Plan, Turning};
use crate::mat3::Mat3;
use crate::motion::flight::Wrap;
use crate::motion::rotation::turned;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::scene::{Impact, Summation};
use crate::space::PeriodicBox;
use crate::space::broadphase::Surveyed;
use crate::surroundings::Features;
use crate::vec3::Vec3;
use crate::workers::Workers;

/// Bodies reordered as one piece of work.
const REORDERED: usize = 1 << 11;

/// The hot figures in the order of *slots*, which the broad phase renews so
/// that neighbours in space are neighbours in memory; the cold ones, read only
/// at a contact, in the scene's order.
#[derive(Debug)]
pub(in crate::engine) struct State<T: Real> {
    /// Centres by slot, length.
    pub position: Columns3<T>,
    /// Velocities by slot, length per time.
    pub velocity: Columns3<T>,
    /// What the rounding of positions and velocities leaves out, by slot, where
    /// sums are compensated.
    pub low: Option<Box<Low<T>>>,
    /// Radii by slot, length.
    pub radius: PerBody<T>,
    /// The scene's index of the body at each slot.
    pub index: Vec<u32>,
    /// Angular velocities by index, rad per time.
    pub spin: Columns3<T>,
    /// Orientations by index; those of a scene whose spins never change stay
    /// as they were at the start.
    pub orientation: Option<Box<[Column<T>; 9]>>,
    /// Masses by index.
    pub mass: PerBody<T>,
    /// `1/m` by index.
    pub inverse_mass: PerBody<T>,
    /// Moments of inertia by index.
    pub inertia: PerBody<T>,
    /// `1/I` by index.
    pub inverse_inertia: PerBody<T>,
    pub orientations: Orientations<T>,
    spare: Column<T>,
    spare_index: Vec<u32>,
}

/// What the rounding of sums leaves out.
#[derive(Debug)]
pub(in crate::engine) struct Low<T: Real> {
    /// Of positions, length.
    pub position: Columns3<T>,
    /// Of velocities, length per time; empty where nothing changes them in flight.
    pub velocity: Columns3<T>,
}

impl<T: Real> Low<T> {
    fn new(len: usize, has_field: bool) -> Self {
        let columns = |len| array::from_fn(|_| Column::new(len, T::ZERO));
        Self { position: columns(len), velocity: columns(if has_field { len } else { 0 }) }
    }
}

impl<T: Real> State<T> {
    /// The bodies at the start. Where contacts take effect within a step, the times
    /// of orientations lie within one too.
    pub fn new(bodies: Bodies<T>, plan: &Plan) -> Self {
        let len = bodies.len();
        let turning = plan.turning;
        let is_compensated = plan.summation == Summation::Compensated;
        let mut state = Self {
            orientations: Orientations::new(turning, len, plan.impact == Impact::SubStep),
            low: is_compensated.then(|| Box::new(Low::new(len, plan.has_field))),
            index: (0..len as u32).collect(),
            inverse_mass: bodies.mass.map(|mass| T::ONE / mass),
            inverse_inertia: bodies.inertia.map(|inertia| T::ONE / inertia),
            position: bodies.position,
            velocity: bodies.velocity,
            radius: bodies.radius,
            spin: bodies.spin,
            orientation: bodies.orientation,
            mass: bodies.mass,
            inertia: bodies.inertia,
            spare: Column::new(len, T::ZERO),
            spare_index: Vec::new(),
        };
        if matches!(turning, Turning::FromLastContact | Turning::EachStep) {
            state.own_orientations();
        }
        state
    }

    /// Puts the body at slot `order[k]` to slot `k`.
    pub fn reorder(&mut self, order: &[u32], workers: &Workers) {
        let hot = self.position.iter_mut().chain(&mut self.velocity);
        let radius = match &mut self.radius {
            PerBody::Same(_) => None,
            PerBody::Each(column) => Some(column),
        };
        let low = self.low.iter_mut().flat_map(|low| {
            let Low { position, velocity } = &mut **low;
            position.iter_mut().chain(velocity)
        });
        for column in hot.chain(radius).chain(low).filter(|column| !column.is_empty()) {
            permute(column, order, &mut self.spare, workers);
            core::mem::swap(column, &mut self.spare);
        }
        self.spare_index.resize(order.len(), 0);
        permute(&self.index, order, &mut self.spare_index, workers);
        core::mem::swap(&mut self.index, &mut self.spare_index);
    }

    /// Moves the body in a slot, within its space. Where it has collided its place is
    /// that of its surface at rounding: nothing is left out.
    #[inline]
    pub fn shift(&mut self, slot: usize, way: Vec3<T>, periodic: Option<PeriodicBox<T>>) {
        let mut position = at(&self.position, slot);
        match &mut self.low {
            None => position += way,
            Some(low) => {
                position += way + at(&low.position, slot);
                put(&mut low.position, slot, Vec3::ZERO);
            }
        }
        let position = periodic.map_or(position, |space| space.wrap(position));
        put(&mut self.position, slot, position);
    }

    /// Gives the body in a slot a velocity.
    #[inline]
    pub fn set_velocity(&mut self, slot: usize, velocity: Vec3<T>) {
        put(&mut self.velocity, slot, velocity);
        if let Some(low) = &mut self.low
            && !low.velocity[0].is_empty()
        {
            put(&mut low.velocity, slot, Vec3::ZERO);
        }
    }

    /// What the broad phase looks at.
    pub fn surveyed<'a>(
        &'a self,
        periodic: Option<PeriodicBox<T>>,
        features: &'a Features<T>,
        pairs: bool,
    ) -> Surveyed<'a, T, Features<T>> {
        Surveyed {
            position: &self.position,
            radius: &self.radius,
            periodic,
            parts: features,
            pairs,
        }
    }

    /// Gives every body an orientation of its own.
    fn own_orientations(&mut self) {
        let len = self.index.len();
        let rows = Mat3::<T>::IDENTITY.rows();
        self.orientation
            .get_or_insert_with(|| Box::new(rows.each(|element| Column::new(len, element))));
    }

    /// Columns by slot in the scene's order.
    pub fn by_index(&self, columns: &Columns3<T>) -> Columns3<T> {
        array::from_fn(|axis| {
            let mut ordered = Column::new(self.index.len(), T::ZERO);
            for (&value, &index) in columns[axis].iter().zip(&self.index) {
                ordered[index as usize] = value;
            }
            ordered
        })
    }

    /// The bodies in the scene's order at the end of step `steps`.
    pub fn bodies(&self, steps: u64, dt: T) -> Bodies<T> {
        let len = self.index.len();
        let radius = match &self.radius {
            PerBody::Same(radius) => PerBody::Same(*radius),
            PerBody::Each(radii) => {
                let mut ordered = Column::new(len, T::ONE);
                for (&radius, &index) in radii.iter().zip(&self.index) {
                    ordered[index as usize] = radius;
                }
                PerBody::Each(ordered)
            }
        };
        let mut bodies = Bodies {
            origin: Origin::Described,
            position: self.by_index(&self.position),
            velocity: self.by_index(&self.velocity),
            spin: self.spin.clone(),
            orientation: None,
            radius,
            mass: self.mass.clone(),
            inertia: self.inertia.clone(),
        };
        let is_turning = self.spin.iter().any(|column| column.iter().any(|&w| w != T::ZERO));
        if is_turning || self.orientation.is_some() {
            let mut rows = Box::new(array::from_fn(|_| Column::new(len, T::ZERO)));
            for index in 0..len {
                let since = self.orientations.since(index, steps, dt, T::ZERO);
                let turned = self.turned(index, since);
                set_rows(&mut rows, index, turned);
            }
            bodies.orientation = Some(rows);
        }
        bodies.left_by_world()
    }

    /// The orientation of the body with an index, a time after the stored one.
    fn turned(&self, index: usize, time: T) -> Mat3<T> {
        let stored = match &self.orientation {
            None => Mat3::IDENTITY,
            Some(rows) => Mat3::from_rows(array::from_fn(|k| rows[k][index])),
        };
        turned(stored, at(&self.spin, index), time)
    }

    /// Brings the orientation of a body up to a time `ago` before the end of step
    /// `steps`, before its spin changes.
    #[inline]
    pub fn catch_up(&mut self, index: usize, steps: u64, dt: T, ago: T) {
        if self.orientations.is_counted() {
            self.turn(index, self.orientations.since(index, steps, dt, ago));
            self.orientations.mark(index, steps, ago);
        }
    }

    /// Starts the counters of orientations again before they overflow.
    pub fn keep_count(&mut self, steps: u64, dt: T) {
        if self.orientations.is_full(steps) {
            for index in 0..self.index.len() {
                self.turn(index, self.orientations.since(index, steps, dt, T::ZERO));
            }
            self.orientations.restart(steps);
        }
    }

    /// Turns the stored orientation of a body on by a time of constant spin.
    fn turn(&mut self, index: usize, time: T) {
        let turned = self.turned(index, time);
        if let Some(rows) = &mut self.orientation {
            set_rows(rows, index, turned);
        }
    }

    /// The bytes that the state holds.
    pub fn bytes(&self) -> usize {
        let three = |columns: &Columns3<T>| columns.iter().map(Column::bytes).sum::<usize>();
        three(&self.position)
            + three(&self.velocity)
            + self.low.as_ref().map_or(0, |low| three(&low.position) + three(&low.velocity))
            + three(&self.spin)
            + self.orientation.as_ref().map_or(0, |rows| rows.iter().map(Column::bytes).sum())
            + self.radius.bytes()
            + self.mass.bytes()
            + self.inverse_mass.bytes()
            + self.inertia.bytes()
            + self.inverse_inertia.bytes()
            + self.orientations.bytes()
            + self.spare.bytes()
            + size_of::<u32>() * (self.index.capacity() + self.spare_index.capacity())
    }
}

/// Puts the value at `order[k]` to slot `k`.
fn permute<A: Copy + Send + Sync>(values: &[A], order: &[u32], slots: &mut [A], workers: &Workers) {
    let mut chunks: Vec<_> = slots.chunks_mut(REORDERED).zip(order.chunks(REORDERED)).collect();
    workers.each(&mut chunks, |(slots, order)| {
        for (slot, &from) in slots.iter_mut().zip(*order) {
            *slot = values[from as usize];
        }
    });
}

fn set_rows<T: Real>(rows: &mut [Column<T>; 9], index: usize, orientation: Mat3<T>) {
    for (column, element) in rows.iter_mut().zip(orientation.rows()) {
        column[index] = element;
    }
}

/// Writes a vector to element `index` of three columns.
#[inline(always)]
pub(super) fn put<T: Real>(columns: &mut Columns3<T>, index: usize, value: Vec3<T>) {
    for (column, component) in columns.iter_mut().zip(value.to_array()) {
        column[index] = component;
    }
}
