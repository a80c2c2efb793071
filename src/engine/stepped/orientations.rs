//! Orientations: since when each body has been turning with its present spin.

#[cfg(feature = "files")]
use super::snapshot::Marks;
use crate::column::Column;
use crate::engine::plan::Turning;
#[cfg(feature = "files")]
use crate::engine::snapshot::{Misfit, Reals};
use crate::real::Real;

/// Steps after which the counters of all bodies start again.
const COUNTED: u64 = 1 << 31;

/// When the stored orientations were true.
#[derive(Debug)]
pub struct Orientations<T: Real> {
    turning: Turning,
    /// The step, since the counters' start, at or before whose end a body was
    /// last turned.
    step: Vec<u32>,
    /// By how much before the end of that step, where contacts have times.
    ago: Option<Column<T>>,
    counted_from: u64,
}

impl<T: Real> Orientations<T> {
    pub fn new(turning: Turning, len: usize, is_within_step: bool) -> Self {
        let len = if turning == Turning::FromLastContact { len } else { 0 };
        Self {
            turning,
            step: vec![0; len],
            ago: is_within_step.then(|| Column::new(len, T::ZERO)),
            counted_from: 0,
        }
    }

    /// What a snapshot keeps.
    #[cfg(feature = "files")]
    pub fn save(&self) -> Marks {
        Marks {
            step: self.step.clone(),
            ago: self.ago.as_ref().map(|column| Reals::of(column.iter().copied())),
            counted_from: self.counted_from,
        }
    }

    /// Goes on with what a snapshot has kept.
    #[cfg(feature = "files")]
    pub fn restore(&mut self, saved: &Marks) -> Result<(), Misfit> {
        if saved.step.len() != self.step.len() {
            return Err(Misfit("orientations"));
        }
        match (&mut self.ago, &saved.ago) {
            (None, None) => {}
            (Some(column), Some(ago)) => *column = ago.column(column.len(), "orientations")?,
            _ => return Err(Misfit("orientations")),
        }
        self.step.clone_from(&saved.step);
        self.counted_from = saved.counted_from;
        Ok(())
    }

    /// How long body `index` has been turning since its stored orientation, a
    /// time `ago` before the end of step `steps`.
    pub fn since(&self, index: usize, steps: u64, dt: T, ago: T) -> T {
        let since = |from: u64| T::from_f64((steps - from) as f64) * dt - ago;
        match self.turning {
            Turning::Never | Turning::EachStep => T::ZERO,
            Turning::FromStart => since(self.counted_from),
            Turning::FromLastContact => {
                let turned = since(self.counted_from + u64::from(self.step[index]));
                self.ago.as_ref().map_or(turned, |column| turned + column[index])
            }
        }
    }

    /// Whether collisions change spins, so that each body has a time of its own.
    pub fn is_counted(&self) -> bool {
        self.turning == Turning::FromLastContact
    }

    /// Notes that the orientation stored for a body is that of a time `ago` before
    /// the end of step `steps`.
    #[inline]
    pub fn mark(&mut self, index: usize, steps: u64, ago: T) {
        self.step[index] = (steps - self.counted_from) as u32;
        if let Some(column) = &mut self.ago {
            column[index] = ago;
        }
    }

    /// Whether the counters have to start again before they overflow.
    pub fn is_full(&self, steps: u64) -> bool {
        self.is_counted() && steps >= self.full_at()
    }

    /// The number of steps at which they do.
    pub fn full_at(&self) -> u64 {
        self.counted_from + COUNTED
    }

    /// Starts the counters again: all stored orientations are those of the end of
    /// step `steps`, also where spins never change.
    pub fn restart(&mut self, steps: u64) {
        self.step.fill(0);
        if let Some(column) = &mut self.ago {
            column.fill(T::ZERO);
        }
        self.counted_from = steps;
    }

    /// The bytes of the marks.
    pub fn bytes(&self) -> usize {
        size_of_val(self.step.as_slice()) + self.ago.as_ref().map_or(0, Column::bytes)
    }
}
