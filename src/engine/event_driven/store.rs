//! Store: the bodies and cells of all regions.

use super::agenda::{Agenda, PartnerCode};
use super::coarse::Screening;
use super::flight::{Flight, Record};
use super::log::{Log, Mark};
use super::region::{Region, Worker};
use super::setting::Setting;
use super::window::Window;
use crate::engine::plan::Turning;
use crate::mat3::Mat3;
use crate::real::Real;
use crate::space::levels::Levels;
use crate::space::pieces::Pieces;
use crate::vec3::Vec3;

/// What regions are parts of, a column each: see [`Region`].
#[derive(Debug)]
pub(super) struct Store<T: Real> {
    pub records: Vec<Record<T>>,
    pub coarse: Vec<Record<T::Coarse>>,
    pub agendas: Vec<Agenda<T>>,
    pub marks: Vec<Mark>,
    pub next: Vec<T>,
    pub spins: Vec<Vec3<T>>,
    pub turned: Vec<(Mat3<T>, T)>,
    pub index: Vec<u32>,

    pub cells: Levels<T>,
    pub screening: Screening<T::Coarse>,
    /// The logs of all workers but one that is at work.
    pub logs: Vec<Log<T>>,
}

impl<T: Real> Store<T> {
    /// The bodies of a scene at its start.
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
            coarse: Vec::new(),
            agendas: vec![Agenda::new([0; 3]); len],
            marks: vec![Mark::NEW; len],
            next: Vec::new(),
            spins: (0..spinning).map(|index| bodies.spin_of(index)).collect(),
            turned: (0..spinning).map(|index| (bodies.orientation_of(index), T::ZERO)).collect(),
            index: (0..len as u32).collect(),
            cells,
            screening: Screening::new(setting.gravity, setting.periodic),
            logs: Vec::new(),
        }
    }

    /// All of it as one region.
    pub fn whole<'a>(
        &'a mut self,
        worker: &'a mut Worker<T>,
        window: Option<Window<T>>,
    ) -> Region<'a, T> {
        Region {
            records: Pieces::whole(&mut self.records),
            coarse: Pieces::whole(&mut self.coarse),
            agendas: Pieces::whole(&mut self.agendas),
            marks: Pieces::whole(&mut self.marks),
            next: Pieces::whole(&mut self.next),
            spins: Pieces::whole(&mut self.spins),
            turned: Pieces::whole(&mut self.turned),
            index: &self.index,
            cells: self.cells.held(),
            screening: &self.screening,
            logs: &self.logs,
            worker,
            window,
            is_whole: true,
        }
    }

    /// Whether the body in a slot was taken out.
    pub fn is_out(&self, slot: usize) -> bool {
        self.marks[slot].last == PartnerCode::OUT
    }

    /// The slots of the bodies that there are.
    pub fn slots(&self) -> impl Iterator<Item = usize> + Clone {
        (0..self.records.len()).filter(|&slot| !self.is_out(slot))
    }

    /// Forgets the bodies that were taken out: all but their agendas, which are to be begun.
    pub fn forget_out(&mut self) {
        if self.slots().count() == self.records.len() {
            return;
        }
        let is_out: Vec<bool> = (0..self.records.len()).map(|slot| self.is_out(slot)).collect();
        fn keep<V>(values: &mut Vec<V>, is_out: &[bool]) {
            let mut out = is_out.iter();
            values.retain(|_| out.next() != Some(&true));
        }
        keep(&mut self.records, &is_out);
        keep(&mut self.index, &is_out);
        keep(&mut self.marks, &is_out);
        keep(&mut self.spins, &is_out);
        keep(&mut self.turned, &is_out);
    }

    /// The spin of the body in a slot.
    pub fn spin_of(&self, setting: &Setting<T>, slot: usize) -> Vec3<T> {
        let changed = self.spins.get(slot).copied();
        setting.spin_of(self.index[slot], changed.unwrap_or(Vec3::ZERO))
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.records.capacity() * size_of::<Record<T>>()
            + self.coarse.capacity() * size_of::<Record<T::Coarse>>()
            + self.agendas.capacity() * size_of::<Agenda<T>>()
            + self.marks.capacity() * size_of::<Mark>()
            + self.next.capacity() * size_of::<T>()
            + self.spins.capacity() * size_of::<Vec3<T>>()
            + self.turned.capacity() * size_of::<(Mat3<T>, T)>()
            + self.index.capacity() * size_of::<u32>()
            + self.cells.bytes()
            + self.logs.iter().map(Log::bytes).sum::<usize>()
    }
}
