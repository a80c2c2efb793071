//! Progress: a bar on the terminal while a run goes on.

use core::time::Duration;
use std::io::{self, IsTerminal};

use carom::engine::Collisions;
use indicatif::{ProgressBar, ProgressStyle};

/// A bar on standard error, if that is a terminal.
pub struct Progress {
    bar: Option<ProgressBar>,
}

impl Progress {
    /// The bar of a run of `steps` steps.
    pub fn new(steps: u64) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(steps);
            let template = "{bar:20} {percent:>3}%  {msg}  {eta} left";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar
        });
        Self { bar }
    }

    /// Shows how far the run is.
    pub fn show(&self, steps: u64, time: f64, collisions: Collisions, busy: Duration) {
        let Some(bar) = &self.bar else { return };
        let count = collisions.pairs + collisions.surroundings;
        let rate = steps as f64 / busy.as_secs_f64().max(1e-9);
        let time = if time < 0.01 { format!("{time:.2e}") } else { format!("{time:.4}") };
        bar.set_message(format!("time {time}  {count} collisions  {rate:.0} steps/s"));
        bar.set_position(steps);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
