//! Others: how much of the machine other programs use while a study measures times.

use std::time::Instant;

use sysinfo::{
    MINIMUM_CPU_UPDATE_INTERVAL, Pid, ProcessRefreshKind, ProcessesToUpdate, System,
    get_current_pid,
};

/// What the system says of its processors, and this process of itself, since a time.
#[derive(Debug)]
pub(super) struct Others {
    system: System,
    own: Option<Pid>,
    start: Instant,
    own_milliseconds: u64,
}

impl Others {
    /// Begins to watch.
    pub fn watch() -> Self {
        let mut others = Self {
            system: System::new(),
            own: get_current_pid().ok(),
            start: Instant::now(),
            own_milliseconds: 0,
        };
        others.system.refresh_cpu_usage();
        others.own_milliseconds = others.own_milliseconds_now().unwrap_or(0);
        others
    }

    /// The processors that other programs have kept busy since then, on the average; `None`
    /// where the system does not say, or after less than a fifth of a second.
    pub fn processors(mut self) -> Option<f64> {
        let wall = self.start.elapsed();
        if wall < MINIMUM_CPU_UPDATE_INTERVAL {
            return None;
        }
        self.system.refresh_cpu_usage();
        let all = f64::from(self.system.global_cpu_usage()) / 100.0;
        let own = self.own_milliseconds_now()? - self.own_milliseconds;
        let own = own as f64 / wall.as_secs_f64() / 1e3;
        let processors = self.system.cpus().len() as f64;
        let others = all * processors - own;
        (processors > 0.0 && others.is_finite()).then(|| others.max(0.0))
    }

    /// The processor time of this process.
    fn own_milliseconds_now(&mut self) -> Option<u64> {
        let own = self.own?;
        let what = ProcessRefreshKind::nothing().with_cpu();
        self.system.refresh_processes_specifics(ProcessesToUpdate::Some(&[own]), false, what);
        Some(self.system.process(own)?.accumulated_cpu_time())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_work_is_not_that_of_others() {
        let others = Others::watch();
        let mut number = 1_u64;
        while others.start.elapsed() < 3 * MINIMUM_CPU_UPDATE_INTERVAL {
            number = std::hint::black_box(number.wrapping_mul(6_364_136_223_846_793_005));
        }
        let threads = std::thread::available_parallelism().map_or(1, usize::from) as f64;
        // What the system says is exact to a tick of its clock.
        assert!(others.processors().is_none_or(|others| others <= threads + 0.5));
        assert!(Others::watch().processors().is_none());
    }
}
