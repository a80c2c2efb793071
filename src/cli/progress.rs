//! Progress: a bar on the terminal while a run goes on.

use core::time::Duration;
use std::io::{self, IsTerminal, Write};
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};

use carom::engine::World;
use carom::real::Real;
use carom::scene::EngineKind;
use carom::study::Course;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::outlook::ahead;

/// How finely the bar shows how far the run is.
const GRAINS: f64 = 1e6;

/// A run that takes longer than this is announced where there is no bar.
const LONG: f64 = 60.0;

/// What of a run is seen before it is announced.
const SEEN: Duration = Duration::from_secs(2);

/// A bar on standard error, if that is a terminal; else a line, once, about a long
/// run.
pub struct Progress {
    course: Course,
    bar: Option<ProgressBar>,
    is_announced: bool,
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
        Self { course, bar, is_announced: false }
    }

    /// Shows how far the run is.
    pub fn show<T: Real>(&mut self, world: &World<T>, busy: Duration) {
        let Some(bar) = &self.bar else {
            self.announce(world, busy);
            return;
        };
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

impl Progress {
    /// Says how long the run will take, by its beginning, if that is long.
    fn announce<T: Real>(&mut self, world: &World<T>, busy: Duration) {
        if self.is_announced || busy < SEEN {
            return;
        }
        self.is_announced = true;
        let left = busy.as_secs_f64() * (1.0 / self.course.done(world) - 1.0);
        if left > LONG {
            let shorter = match world.plan().engine {
                EngineKind::Stepped => "a shorter --duration or a longer --dt makes",
                _ => "a shorter --duration makes",
            };
            // A message that cannot be written ends no run.
            let _ = writeln!(io::stderr(), "{}; {shorter} it shorter", ahead(left));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A line on the terminal while a scene is set up, once that takes a second.
pub struct SettingUp {
    shown: Option<(Sender<()>, JoinHandle<()>)>,
}

impl SettingUp {
    /// Set-up begins.
    pub fn new() -> Self {
        let is_seen = io::stderr().is_terminal();
        let shown = is_seen.then(|| {
            let (done, is_done) = channel();
            let show = move || {
                if is_done.recv_timeout(Duration::from_secs(1)).is_err() {
                    let bar = ProgressBar::new_spinner().with_message("setting up the scene");
                    bar.enable_steady_tick(Duration::from_millis(200));
                    // The end of set-up, by a word or by a failure.
                    let _ = is_done.recv();
                    bar.finish_and_clear();
                }
            };
            Some((done, thread::Builder::new().name("setting-up".into()).spawn(show).ok()?))
        });
        Self { shown: shown.flatten() }
    }
}

impl Drop for SettingUp {
    fn drop(&mut self) {
        if let Some((done, thread)) = self.shown.take() {
            let _ = done.send(());
            drop(done);
            let _ = thread.join();
        }
    }
}
