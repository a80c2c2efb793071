//! Progress: a bar on the terminal while a run goes on.

use core::time::Duration;
use std::io::{self, IsTerminal, Write};
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};

use carom::engine::World;
use carom::observe::Energy;
use carom::real::Real;
use carom::scene::EngineKind;
use carom::study::Course;
use carom::study::table::{difference, grouped};
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::outlook::ahead;

/// How finely the bar shows how far the run is.
const GRAINS: f64 = 1e6;

/// A run that takes longer than this is announced where there is no bar.
const LONG: f64 = 60.0;

/// What of a run is seen before it is announced.
const SEEN: Duration = Duration::from_secs(2);

/// Into how many parts the lines about a long run divide it.
const PARTS: u32 = 40;

/// From one line about a long run to the next, at least and at most.
const BETWEEN: [Duration; 2] = [Duration::from_secs(60), Duration::from_secs(3600)];

/// A bar on standard error, if that is a terminal; else lines, now and then, about a
/// long run.
pub struct Progress {
    course: Course,
    /// The energy at the start, and what bodies can fall through.
    energy: (Energy, f64),
    bar: Option<ProgressBar>,
    is_announced: bool,
    /// How long the engine has been at work when the next line is due.
    next: Duration,
}

impl Progress {
    /// The bar of a run that begins with an energy, by which its error is measured, and
    /// that which bodies can fall through.
    pub fn new(course: Course, energy: (Energy, f64)) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(GRAINS as u64);
            let template = "{bar:20} {percent:>3}%  {elapsed} gone  {msg}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar
        });
        Self { course, energy, bar, is_announced: false, next: BETWEEN[0] }
    }

    /// Shows how far the run is.
    pub fn show<T: Real>(&mut self, world: &World<T>, busy: Duration) {
        let Some(bar) = &self.bar else {
            self.announce(world, busy);
            self.report(world, busy);
            return;
        };
        let count = world.collisions().total();
        let (done, unit) = match world.plan().engine {
            EngineKind::Stepped => (world.steps(), "steps"),
            _ => (count, "collisions"),
        };
        let rate = done as f64 / busy.as_secs_f64().max(1e-9);
        let time = shown_time(world.time());
        let part = self.course.done(world);
        // The bar's own estimate says 0 as long as it sees nothing move.
        let left = left(part, busy);
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

impl Progress {
    /// Says how far a long run is, when a line is due.
    fn report<T: Real>(&mut self, world: &World<T>, busy: Duration) {
        if busy < self.next {
            return;
        }
        let part = self.course.done(world);
        let whole = Duration::try_from_secs_f64(busy.as_secs_f64() / part.max(1e-9));
        let [least, most] = BETWEEN;
        self.next = busy + whole.map_or(most, |whole| (whole / PARTS).clamp(least, most));
        let (before, fall) = &self.energy;
        let change = world.energy().relative_change(before, *fall);
        let line = line(world.time(), part, world.collisions().total(), change, busy);
        // A message that cannot be written ends no run.
        let _ = writeln!(io::stderr(), "{line}");
    }
}

/// A line about a run under way.
fn line(time: f64, part: f64, collisions: u64, change: f64, busy: Duration) -> String {
    format!(
        "time {}, {:.1} %, {} collisions, energy changed by {}, {} gone, {}",
        shown_time(time),
        100.0 * part,
        grouped(collisions),
        difference(change),
        HumanDuration(busy),
        left(part, busy)
    )
}

/// A time in few digits.
fn shown_time(time: f64) -> String {
    if time < 0.01 { format!("{time:.2e}") } else { format!("{time:.4}") }
}

/// How long the rest of a run takes.
fn left(part: f64, busy: Duration) -> String {
    let left = Duration::try_from_secs_f64(busy.as_secs_f64() * (1.0 / part - 1.0));
    left.map_or_else(|_| "no end in sight".into(), |left| format!("{} left", HumanDuration(left)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_far_a_run_is() {
        let line = line(12.5, 0.125, 1_234_567, -2.5e-14, Duration::from_secs(600));
        assert_eq!(
            line,
            "time 12.5000, 12.5 %, 1,234,567 collisions, energy changed by -2.50e-14, 10 minutes gone, \
             70 minutes left"
        );
        assert_eq!(left(0.0, Duration::from_secs(1)), "no end in sight");
    }
}
