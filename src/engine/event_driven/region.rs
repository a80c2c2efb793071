//! Region: what one worker writes.

use super::agenda::{Agenda, Mark, PartnerCode};
use super::calendar::Calendar;
use super::coarse::Coarse;
use super::flight::{Flight, Record};
use super::meeting::Meetings;
use super::setting::Setting;
use crate::engine::plan::Turning;
use crate::mat3::Mat3;
use crate::real::Real;
use crate::space::levels::Levels;
use crate::vec3::Vec3;

/// The bodies of a region and what is ahead of them, by slot: neighbours in
/// space are neighbours in memory.
///
/// A restart file keeps `records`, `marks`, `spins`, `turned` and `index`; all
/// else is made where a period begins.
#[derive(Debug)]
pub(super) struct Region<T: Real> {
    pub records: Vec<Record<T>>,
    pub agendas: Vec<Agenda<T>>,
    pub marks: Vec<Mark>,
    /// Where contacts change spins: those of the bodies.
    pub spins: Vec<Vec3<T>>,
    /// Where contacts change spins: orientations, and since when they are true.
    pub turned: Vec<(Mat3<T>, T)>,
    /// The scene's index of the body in each slot.
    pub index: Vec<u32>,

    pub cells: Levels<T>,
    pub calendar: Calendar<T>,
    pub coarse: Coarse<T::Coarse>,
    /// A body has become so fast that the period is too long for it.
    pub is_too_fast: bool,

    /// The neighbours that a search has found.
    pub found: Vec<u32>,
    /// The contacts that it has worked out.
    pub meetings: Meetings<T>,
}

impl<T: Real> Region<T> {
    /// The bodies of a scene at its start, in the scene's order.
    pub fn new(setting: &Setting<T>, cells: Levels<T>) -> Self {
        let bodies = &setting.bodies;
        let len = bodies.len();
        let record = |index: usize| {
            Record::new(Flight {
                position: bodies.position_of(index),
                velocity: bodies.velocity_of(index),
                since: T::ZERO,
                radius: bodies.radius.of(index),
            })
        };
        let spinning = if setting.plan.turning == Turning::FromLastContact { len } else { 0 };
        Self {
            records: (0..len).map(record).collect(),
            agendas: vec![Agenda::new([0; 3]); len],
            marks: vec![Mark { changes: 0, last: PartnerCode::NONE }; len],
            spins: (0..spinning).map(|index| bodies.spin_of(index)).collect(),
            turned: (0..spinning).map(|index| (bodies.orientation_of(index), T::ZERO)).collect(),
            index: (0..len as u32).collect(),
            found: vec![0; cells.most()],
            cells,
            calendar: Calendar::new(),
            coarse: Coarse::new(setting.gravity, setting.periodic),
            is_too_fast: false,
            meetings: Meetings::new(),
        }
    }

    /// Centre and velocity of the body in a slot, at a time of this period.
    #[inline(always)]
    pub fn state_of(&self, setting: &Setting<T>, slot: usize, time: T) -> (Vec3<T>, Vec3<T>) {
        setting.state_of(&self.records[slot].flight(), time)
    }

    /// Angular velocity of the body in a slot.
    #[inline(always)]
    pub fn spin_of(&self, setting: &Setting<T>, slot: usize) -> Vec3<T> {
        match self.spins.get(slot) {
            Some(&spin) => spin,
            None => setting.bodies.spin_of(self.index[slot] as usize),
        }
    }

    /// The level of cells that the body in a slot belongs to.
    #[inline(always)]
    pub fn level_of(&self, slot: usize) -> usize {
        if self.cells.len() == 1 {
            return 0;
        }
        self.cells.level_of(self.records[slot].flight().radius)
    }

    /// Keeps the buffer as large as the cells may ask.
    pub fn make_room(&mut self) {
        let most = self.cells.most();
        if self.found.len() < most {
            self.found.resize(most, 0);
        }
    }

    /// The bytes of memory that it holds.
    pub fn bytes(&self) -> usize {
        self.records.capacity() * size_of::<Record<T>>()
            + self.agendas.capacity() * size_of::<Agenda<T>>()
            + self.marks.capacity() * size_of::<Mark>()
            + self.spins.capacity() * size_of::<Vec3<T>>()
            + self.turned.capacity() * size_of::<(Mat3<T>, T)>()
            + self.index.capacity() * size_of::<u32>()
            + self.coarse.bytes()
            + self.cells.bytes()
            + self.calendar.bytes()
    }
}
