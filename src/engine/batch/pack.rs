//! Pack: a scene in each lane.
//!
//! Element `body × width + lane` of a column is that of a body in the scene of a lane: one
//! load brings the same body of all scenes. A lane without a scene, or with one that rests,
//! has no places, so that nothing touches anything in it.

use super::moving::{Moving, Values, columns};
use super::seat::Seat;
use super::setting::Setting;
use super::step::Events;
use super::within::Meetings;
use crate::bodies::{Bodies, Columns3, Origin};
use crate::column::Column;
use crate::engine::Compiled;
use crate::mat3::Mat3;
use crate::motion::rotation::turned;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::scene::{Scene, Summation};
use crate::vec3::Vec3;

/// The scenes of a pack.
#[derive(Debug)]
pub struct Pack<T: Real> {
    /// Centres, length.
    pub position: Columns3<T>,
    /// What the rounding of positions leaves out; empty where sums are plain.
    pub low: Columns3<T>,
    pub radius: Values<T>,
    pub moving: Moving<T>,
    /// Accelerations, by lane.
    pub gravity: Columns3<T>,
    /// The lanes, by bits, that have left the numbers.
    broken: u32,
}

impl<T: Real> Pack<T> {
    /// Lanes without scenes.
    pub fn new(setting: &Setting<T>) -> Self {
        let (plan, width) = (&setting.plan, setting.width);
        let len = plan.bodies * width;
        let if_so = |is_so: bool| if is_so { len } else { 0 };
        let is_compensated = plan.summation == Summation::Compensated;
        let values = |has_each: bool| Values::new(len, width, !has_each);
        Self {
            position: columns(len, nowhere()),
            low: columns(if_so(is_compensated), T::ZERO),
            radius: values(plan.has_radii),
            moving: Moving {
                width,
                velocity: columns(len, T::ZERO),
                low: columns(if_so(is_compensated && plan.has_field), T::ZERO),
                spin: columns(if_so(plan.changes_spins), T::ZERO),
                orientation: Mat3::IDENTITY
                    .rows()
                    .each(|element| Column::new(if_so(plan.changes_spins), element)),
                has_equal_radii: !plan.has_radii,
                mass: values(plan.has_masses),
                inertia: values(plan.has_radii || plan.has_masses),
                dt: Column::new(width, T::ZERO),
                seats: (0..width).map(|_| Seat::empty(setting)).collect(),
                taken: 0,
                full_at: u64::MAX,
            },
            gravity: columns(width, T::ZERO),
            broken: 0,
        }
    }

    /// Puts a scene that [`Setting::takes`] into a lane.
    pub fn seat(&mut self, setting: &Setting<T>, lane: usize, number: usize, scene: &Scene<T>) {
        let bodies = &scene.bodies;
        let moving = &mut self.moving;
        let shape = (moving.width, bodies.len());
        let mut seat = Seat::empty(setting);
        seat.scene = Some(number);
        seat.exact_dt = scene.stepped.dt.unwrap_or_default();
        seat.has_orientation = bodies.orientation.is_some() || setting.plan.changes_spins;
        let is_spinning = bodies.spin.iter().any(|column| column.iter().any(|&w| w != T::ZERO));
        if is_spinning {
            moving.need_spins(shape.0 * shape.1);
        }
        if bodies.orientation.is_some() {
            moving.need_orientations(shape.0 * shape.1);
        }
        let put = |column: &mut Column<T>, of: &dyn Fn(usize) -> T| {
            if !column.is_empty() {
                (0..shape.1).for_each(|body| column[body * shape.0 + lane] = of(body));
            }
        };
        for axis in 0..3 {
            put(&mut self.position[axis], &|body| bodies.position[axis][body]);
            put(&mut moving.velocity[axis], &|body| bodies.velocity[axis][body]);
            put(&mut moving.spin[axis], &|body| bodies.spin[axis][body]);
            put(&mut self.low[axis], &|_| T::ZERO);
            put(&mut moving.low[axis], &|_| T::ZERO);
            self.gravity[axis][lane] = scene.gravity.to_array()[axis];
        }
        for (element, column) in moving.orientation.iter_mut().enumerate() {
            put(column, &|body| bodies.orientation_of(body).rows()[element]);
        }
        moving.dt[lane] = T::from_f64(seat.exact_dt);
        self.radius.set(shape, lane, &bodies.radius);
        moving.has_equal_radii = self.radius.is_same;
        moving.mass.set(shape, lane, &bodies.mass);
        moving.inertia.set(shape, lane, &bodies.inertia);
        moving.seats[lane] = seat;
    }

    /// The bodies of the scene in a lane, as a world of it would give them.
    pub fn bodies(&self, setting: &Setting<T>, lane: usize) -> Bodies<T> {
        let (moving, len) = (&self.moving, setting.plan.bodies);
        let column = |column: &Column<T>| {
            let value = |body| column.get(body * moving.width + lane).copied();
            Column::from_values((0..len).map(|body| value(body).unwrap_or(T::ZERO)), T::ZERO)
        };
        let values = |values: &Values<T>| values.of((moving.width, len), lane);
        let mut bodies = Bodies {
            origin: Origin::Described,
            position: self.position.refs().each(column),
            velocity: moving.velocity.refs().each(column),
            spin: moving.spin.refs().each(column),
            orientation: None,
            radius: values(&self.radius),
            mass: values(&moving.mass),
            inertia: values(&moving.inertia),
        };
        let seat = &moving.seats[lane];
        let is_turning = bodies.spin.iter().any(|column| column.iter().any(|&w| w != T::ZERO));
        if is_turning || seat.has_orientation {
            let turned = |body: usize| {
                let since = seat.orientations.since(body, seat.steps, moving.dt[lane], T::ZERO);
                turned(moving.stored_orientation(body, lane), bodies.spin_of(body), since).rows()
            };
            let rows: Vec<[T; 9]> = (0..len).map(turned).collect();
            bodies.orientation = Some(Box::new(array::from_fn(|element| {
                Column::from_values(rows.iter().map(|row| row[element]), T::ZERO)
            })));
        }
        bodies.left_by_world()
    }

    /// Leaves a lane without a scene.
    pub fn vacate(&mut self, setting: &Setting<T>, lane: usize) {
        self.moving.seats[lane] = Seat::empty(setting);
        self.clear(lane);
    }

    /// Takes the places of a lane away, so that nothing happens in it.
    fn clear(&mut self, lane: usize) {
        for column in &mut self.position {
            column.iter_mut().skip(lane).step_by(self.moving.width).for_each(|x| *x = nowhere());
        }
    }

    /// Keeps what is in a lane aside while the others go on.
    pub fn park(&mut self, lane: usize) {
        let width = self.moving.width;
        let mut parked = Vec::new();
        for column in self.columns_mut() {
            parked.extend(column.iter().skip(lane).step_by(width));
        }
        self.moving.seats[lane].parked = parked;
        self.clear(lane);
    }

    /// Brings it back.
    pub fn unpark(&mut self, lane: usize) {
        let width = self.moving.width;
        let parked = core::mem::take(&mut self.moving.seats[lane].parked);
        let mut parked = parked.into_iter();
        for column in self.columns_mut() {
            for (slot, value) in column.iter_mut().skip(lane).step_by(width).zip(&mut parked) {
                *slot = value;
            }
        }
    }

    /// Moves the scene in a lane of another pack into a lane of this one.
    pub fn take_over(&mut self, setting: &Setting<T>, lane: usize, other: &mut Self, from: usize) {
        let shape = (self.moving.width, setting.plan.bodies);
        if !other.moving.spin[0].is_empty() {
            self.moving.need_spins(shape.0 * shape.1);
        }
        if !other.moving.orientation[0].is_empty() {
            self.moving.need_orientations(shape.0 * shape.1);
        }
        for (own, others) in self.columns_mut().zip(other.columns_mut()) {
            let others = others.iter().skip(from).step_by(shape.0);
            own.iter_mut().skip(lane).step_by(shape.0).zip(others).for_each(|(a, b)| *a = *b);
        }
        let (own, others) = (&mut self.moving, &mut other.moving);
        for (own, others) in [
            (&mut self.radius, &other.radius),
            (&mut own.mass, &others.mass),
            (&mut own.inertia, &others.inertia),
        ] {
            own.set(shape, lane, &others.of(shape, from));
        }
        own.has_equal_radii = self.radius.is_same;
        own.seats[lane] = core::mem::replace(&mut others.seats[from], Seat::empty(setting));
        other.clear(from);
    }

    /// All columns that change on the way, and those by lane.
    fn columns_mut(&mut self) -> impl Iterator<Item = &mut Column<T>> {
        let Moving { velocity, low, spin, orientation, dt, .. } = &mut self.moving;
        let moving = velocity.iter_mut().chain(low).chain(spin).chain(orientation);
        let low = &mut self.low;
        let by_lane = self.gravity.iter_mut().chain([dt]);
        self.position.iter_mut().chain(moving).chain(low).chain(by_lane)
    }

    /// Whether any lane has a scene.
    pub fn has_scenes(&self) -> bool {
        self.moving.seats.iter().any(|seat| seat.scene.is_some())
    }

    /// Whether a scene has not reached its goal.
    pub fn is_under_way(&self) -> bool {
        self.moving.seats.iter().any(Seat::is_under_way)
    }

    /// Whether a lane has left the numbers.
    pub fn has_broken(&self) -> bool {
        self.broken != 0
    }

    /// The lanes that have, from now on forgotten.
    pub fn broken_lanes(&mut self) -> impl Iterator<Item = usize> + use<T> {
        let broken = core::mem::take(&mut self.broken);
        (0..self.moving.width).filter(move |lane| broken >> lane & 1 != 0)
    }

    /// Takes steps until all scenes have reached their goals, or this many.
    pub fn go(
        &mut self,
        setting: &Setting<T>,
        mut meetings: Option<&mut Meetings<T>>,
        most: u64,
        mut events: Option<&mut Events<T>>,
    ) where
        T: Compiled,
    {
        let mut left = most;
        loop {
            let seats = self.moving.seats.iter().filter(|seat| seat.is_under_way());
            let Some(ahead) = seats.map(|seat| seat.goal - seat.steps).min() else { break };
            let steps = ahead.min(left);
            if steps == 0 {
                break;
            }
            for lane in 0..self.moving.width {
                let seat = &self.moving.seats[lane];
                if seat.scene.is_some() && !seat.is_under_way() && !seat.is_parked() {
                    self.park(lane);
                }
            }
            let (meetings, events) = (meetings.as_deref_mut(), events.as_deref_mut());
            T::advance_pack(setting, self, meetings, steps, events);
            left -= steps;
        }
        for lane in 0..self.moving.width {
            if self.moving.seats[lane].is_parked() {
                self.unpark(lane);
            }
        }
    }

    /// Notes the lanes, by bits, that are not finite though they should be.
    pub fn note_broken(&mut self, lanes: u32) {
        for (lane, seat) in self.moving.seats.iter().enumerate() {
            let is_moving = seat.scene.is_some() && !seat.is_parked();
            self.broken |= lanes & u32::from(is_moving) << lane;
        }
    }

    /// The centre of a body.
    pub fn position_of(&self, body: usize, lane: usize) -> Vec3<T> {
        self.position.refs().each(|column| column[body * self.moving.width + lane]).into()
    }

    /// Gives a body an impulse, and lets its scene go on as a new one in that state.
    pub fn push(&mut self, lane: usize, body: usize, impulse: Vec3<T>) {
        let moving = &mut self.moving;
        let (width, index) = (moving.width, body * moving.width + lane);
        let mass = moving.mass.column[moving.mass.index(width, body, lane)];
        let change = impulse * (T::ONE / mass);
        for (column, change) in moving.velocity.iter_mut().zip(change.to_array()) {
            column[index] = column[index] + change;
        }
        moving.turn_to_now(lane);
        for column in self.low.iter_mut().chain(&mut moving.low) {
            column.iter_mut().skip(lane).step_by(width).for_each(|low| *low = T::ZERO);
        }
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        let Moving { velocity, low, spin, orientation, mass, inertia, dt, seats, .. } =
            &self.moving;
        let moving = velocity.iter().chain(low).chain(spin).chain(orientation);
        let figures = [&self.radius, mass, inertia].each(|values| &values.column);
        let others = self.gravity.iter().chain([dt]).chain(figures);
        let columns = self.position.iter().chain(&self.low).chain(moving);
        let seats = seats.iter().map(|seat| size_of::<Seat<T>>() + seat.orientations.bytes());
        columns.chain(others).map(Column::bytes).sum::<usize>() + seats.sum::<usize>()
    }
}

/// The place of what is not there: it touches nothing.
fn nowhere<T: Real>() -> T {
    T::from_f64(f64::NAN)
}
