//! Clock: how far time is.

/// Steps taken. A restart file keeps it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    pub steps: u64,
}

impl Clock {
    /// Time since the start: steps times their length as the scene gives it,
    /// not as the precision rounds it.
    pub fn time(self, exact_dt: f64) -> f64 {
        self.steps as f64 * exact_dt
    }

    /// The time so long before the end of the present step: in the step, however its
    /// length is rounded.
    pub fn time_before_end(self, exact_dt: f64, ago: f64) -> f64 {
        let start = Self { steps: self.steps.saturating_sub(1) }.time(exact_dt);
        (self.time(exact_dt) - ago).max(start)
    }
}
