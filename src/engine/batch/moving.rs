//! Moving: what contacts read and change of the scenes of a pack.

use super::seat::Seat;
use crate::bodies::{Columns3, PerBody};
use crate::column::Column;
use crate::lane::Lane;
use crate::mat3::Mat3;
use crate::motion::rotation::turned;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

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
    pub(super) taken: u64,
    /// After how many of them marks of orientations have to start again.
    pub(super) full_at: u64,
}

/// A figure of the bodies: a value for each, or one for all of a scene.
#[derive(Debug)]
pub struct Values<T: Real> {
    pub column: Column<T>,
    /// Whether the bodies of each scene have one value.
    pub is_same: bool,
}

impl<T: Real> Values<T> {
    pub fn new(len: usize, width: usize, is_same: bool) -> Self {
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

    pub fn set(&mut self, (width, bodies): (usize, usize), lane: usize, figure: &PerBody<T>) {
        if let (true, PerBody::Each(_)) = (self.is_same, figure) {
            let values = (0..bodies * width).map(|k| self.column[k % width]);
            *self = Self { column: Column::from_values(values, T::ONE), is_same: false };
        }
        for body in 0..if self.is_same { 1 } else { bodies } {
            let index = self.index(width, body, lane);
            self.column[index] = figure.of(body);
        }
    }

    pub fn of(&self, (width, bodies): (usize, usize), lane: usize) -> PerBody<T> {
        if self.is_same {
            return PerBody::Same(self.column[lane]);
        }
        PerBody::from_values((0..bodies).map(|body| self.column[body * width + lane]), T::ONE)
    }
}

impl<T: Real> Moving<T> {
    pub fn need_spins(&mut self, len: usize) {
        if self.spin[0].is_empty() {
            self.spin = columns(len, T::ZERO);
        }
    }

    pub fn need_orientations(&mut self, len: usize) {
        if self.orientation[0].is_empty() {
            self.orientation = Mat3::IDENTITY.rows().each(|element| Column::new(len, element));
        }
    }

    /// The velocity of a body.
    pub fn velocity_of(&self, body: usize, lane: usize) -> Vec3<T> {
        self.velocity.refs().each(|column| column[body * self.width + lane]).into()
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
    pub fn turn_to_now(&mut self, lane: usize) {
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

fn is_not_zero<T: Real>(value: &T) -> bool {
    *value != T::ZERO
}

pub(super) fn columns<T: Real>(len: usize, value: T) -> Columns3<T> {
    array::from_fn(|_| Column::new(len, value))
}
