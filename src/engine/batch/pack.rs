//! Pack: a scene in each lane.
//!
//! Element `body × width + lane` of a column is that of a body in the scene of a lane: one
//! load brings the same body of all scenes. A lane without a scene, or with one that rests,
//! has no places, so that nothing touches anything in it.

use super::setting::Setting;
use super::step::Events;
use crate::bodies::{Bodies, Columns3, Origin, PerBody};
use crate::column::Column;
use crate::engine::plan::{Plan, Turning};
use crate::engine::stepped::Orientations;
use crate::engine::{Collisions, Compiled};
use crate::lane::Lane;
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

/// All of the scenes that contacts read and change.
#[derive(Debug)]
pub struct Moving<T: Real> {
    pub width: usize,
    /// Velocities, length per time.
    pub velocity: Columns3<T>,
    /// What their rounding leaves out; empty where sums are plain or there is no field.
    pub low: Columns3<T>,
    /// Angular velocities, rad per time; empty where nothing spins.
    pub spin: Columns3<T>,
    /// Orientations, as they were stored last; empty where all are those of the world.
    pub orientation: [Column<T>; 9],
    /// Whether the bodies of each scene have one radius.
    pub has_equal_radii: bool,
    pub mass: Values<T>,
    pub inertia: Values<T>,
    /// Lengths of a step, by lane.
    pub dt: Column<T>,
    pub seats: Vec<Seat<T>>,
    /// Steps that all have taken together, and are not counted in the seats yet.
    taken: u64,
    /// After how many of them marks of orientations have to start again.
    full_at: u64,
}

/// A figure of the bodies: a value for each, or one for all of a scene.
#[derive(Debug)]
pub struct Values<T: Real> {
    pub column: Column<T>,
    /// Whether the bodies of each scene have one value.
    pub is_same: bool,
}

/// The scene in a lane.
#[derive(Debug)]
pub struct Seat<T: Real> {
    /// Its number; `None` where the lane is empty.
    pub scene: Option<usize>,
    pub exact_dt: f64,
    /// Steps taken, and those after which it rests.
    pub steps: u64,
    pub goal: u64,
    pub collisions: Collisions,
    pub orientations: Orientations<T>,
    /// Whether its bodies have orientations of their own.
    has_orientation: bool,
    /// What is in the lane, while it goes on without that.
    parked: Vec<T>,
}

impl<T: Real> Values<T> {
    fn new(len: usize, width: usize, is_same: bool) -> Self {
        Self { column: Column::new(if is_same { width } else { len }, T::ONE), is_same }
    }

    /// Where the value of a body stands for the lanes from `lane` on.
    #[inline(always)]
    pub fn index(&self, width: usize, body: usize, lane: usize) -> usize {
        if self.is_same { lane } else { body * width + lane }
    }

    /// The values of a body in all lanes.
    #[inline(always)]
    pub fn load<L: Lane<Scalar = T>>(&self, body: usize) -> L {
        L::load(&self.column[self.index(L::WIDTH, body, 0)..])
    }

    fn set(&mut self, (width, bodies): (usize, usize), lane: usize, figure: &PerBody<T>) {
        if let (true, PerBody::Each(_)) = (self.is_same, figure) {
            let values = (0..bodies * width).map(|k| self.column[k % width]);
            *self = Self { column: Column::from_values(values, T::ONE), is_same: false };
        }
        for body in 0..if self.is_same { 1 } else { bodies } {
            let index = self.index(width, body, lane);
            self.column[index] = figure.of(body);
        }
    }

    fn of(&self, (width, bodies): (usize, usize), lane: usize) -> PerBody<T> {
        if self.is_same {
            return PerBody::Same(self.column[lane]);
        }
        PerBody::from_values((0..bodies).map(|body| self.column[body * width + lane]), T::ONE)
    }
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
    pub fn go(&mut self, setting: &Setting<T>, most: u64, mut events: Option<&mut Events<T>>)
    where
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
            T::advance_pack(setting, self, steps, events.as_deref_mut());
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

impl<T: Real> Moving<T> {
    fn need_spins(&mut self, len: usize) {
        if self.spin[0].is_empty() {
            self.spin = columns(len, T::ZERO);
        }
    }

    fn need_orientations(&mut self, len: usize) {
        if self.orientation[0].is_empty() {
            self.orientation = Mat3::IDENTITY.rows().each(|element| Column::new(len, element));
        }
    }

    /// Steps that the scene in a lane has taken.
    #[inline(always)]
    pub fn steps(&self, lane: usize) -> u64 {
        self.seats[lane].steps + self.taken
    }

    /// Finds when marks of orientations have to start again, before steps are taken.
    pub fn begin(&mut self) {
        let is_under_way = |seat: &&Seat<T>| seat.scene.is_some() && !seat.is_parked();
        let counted = self.seats.iter().filter(is_under_way);
        let counted = counted.filter(|seat| seat.orientations.is_counted());
        let left = counted.map(|seat| seat.orientations.full_at().saturating_sub(seat.steps));
        self.full_at = left.min().unwrap_or(u64::MAX);
    }

    /// Counts a step that all scenes have taken.
    #[inline(always)]
    pub fn count_step(&mut self) {
        self.taken += 1;
        if self.taken >= self.full_at {
            self.restart_marks();
        }
    }

    /// Starts marks of orientations again before they overflow.
    #[cold]
    fn restart_marks(&mut self) {
        for lane in 0..self.width {
            let steps = self.steps(lane);
            let seat = &self.seats[lane];
            if seat.scene.is_some() && !seat.is_parked() && seat.orientations.is_full(steps) {
                self.turn_to_now(lane);
            }
        }
        self.end();
        self.begin();
    }

    /// Stores the orientations of a scene as they are now.
    fn turn_to_now(&mut self, lane: usize) {
        let width = self.width;
        let spins = |column: &Column<T>| column.iter().skip(lane).step_by(width).any(is_not_zero);
        if !self.seats[lane].has_orientation && !self.spin.iter().any(spins) {
            return;
        }
        self.need_orientations(self.velocity[0].len());
        self.seats[lane].has_orientation = true;
        let steps = self.steps(lane);
        for body in 0..self.velocity[0].len() / self.width {
            let since = self.seats[lane].orientations.since(body, steps, self.dt[lane], T::ZERO);
            let index = body * self.width + lane;
            let spin = self.spin.refs().each(|column| column.get(index).copied());
            let spin = spin.each(|component| component.unwrap_or(T::ZERO));
            let rows = turned(self.stored_orientation(body, lane), spin.into(), since).rows();
            for (column, element) in self.orientation.iter_mut().zip(rows) {
                column[index] = element;
            }
        }
        self.seats[lane].orientations.restart(steps);
    }

    /// Counts the steps taken in the seats.
    pub fn end(&mut self) {
        let taken = core::mem::take(&mut self.taken);
        self.seats.iter_mut().filter(|seat| !seat.is_parked()).for_each(|seat| seat.steps += taken);
    }

    /// The orientation of a body as it was stored last.
    pub fn stored_orientation(&self, body: usize, lane: usize) -> Mat3<T> {
        if self.orientation[0].is_empty() {
            return Mat3::IDENTITY;
        }
        let index = body * self.width + lane;
        Mat3::from_rows(self.orientation.refs().each(|column| column[index]))
    }
}

impl<T: Real> Seat<T> {
    fn empty(setting: &Setting<T>) -> Self {
        let Plan { changes_spins, bodies, .. } = setting.plan;
        // Of what never changes one form from the start is enough.
        let turning = if changes_spins { Turning::FromLastContact } else { Turning::FromStart };
        Self {
            scene: None,
            exact_dt: 0.0,
            steps: 0,
            goal: 0,
            collisions: Collisions::default(),
            orientations: Orientations::new(turning, bodies, false),
            has_orientation: false,
            parked: Vec::new(),
        }
    }

    /// Whether it has not reached its goal.
    pub fn is_under_way(&self) -> bool {
        self.scene.is_some() && self.steps < self.goal
    }

    /// Whether what is in the lane is kept aside.
    pub fn is_parked(&self) -> bool {
        !self.parked.is_empty()
    }

    /// Time since the start of its scene.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.exact_dt
    }
}

fn is_not_zero<T: Real>(value: &T) -> bool {
    *value != T::ZERO
}

/// The place of what is not there: it touches nothing.
fn nowhere<T: Real>() -> T {
    T::from_f64(f64::NAN)
}

fn columns<T: Real>(len: usize, value: T) -> Columns3<T> {
    array::from_fn(|_| Column::new(len, value))
}
