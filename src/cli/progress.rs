//! Progress: a bar on the terminal while a run goes on.

use core::time::Duration;
use std::io::{self, IsTerminal};

use carom::engine::World;
use carom::real::Real;
use carom::scene::EngineKind;
use carom::study::Course;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

/// How finely the bar shows how far the run is.
const GRAINS: f64 = 1e6;

/// A bar on standard error, if that is a terminal.
pub struct Progress {
    course: Course,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// The bar of a run.
    pub fn new(course: Course) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(GRAINS as u64);
            let template = "{bar:20} {percent:>3}%  {msg}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar
        });
        Self { course, bar }
    }

    /// Shows how far the run is.
    pub fn show<T: Real>(&self, world: &World<T>, busy: Duration) {
        let Some(bar) = &self.bar else { return };
        let count = world.collisions().total();
        let (done, unit) = match world.plan().engine {
            EngineKind::Stepped => (world.steps(), "steps"),
            _ => (count, "collisions"),
        };
        let rate = done as f64 / busy.as_secs_f64().max(1e-9);
        let time = world.time();
        let time = if time < 0.01 { format!("{time:.2e}") } else { format!("{time:.4}") };
        let part = self.course.done(world);
        // The bar's own estimate says 0 as long as it sees nothing move.
        let left = Duration::try_from_secs_f64(busy.as_secs_f64() * (1.0 / part - 1.0));
        let left = left.map_or_else(
            |_| "no end in sight".into(),
            |left| format!("{} left", HumanDuration(left)),
        );
        bar.set_message(format!("time {time}  {count} collisions  {rate:.0} {unit}/s  {left}"));
        bar.set_position((part * GRAINS) as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
