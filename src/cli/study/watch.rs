//! Watch: how far a study is, on the terminal.

use core::time::Duration;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

use carom::study::Watch;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use crate::cli::interrupt::last_words;

/// Seconds from which the length of a study is announced.
const LONG: f64 = 10.0;

/// From one line about a long study to the next, where there is no terminal.
const BETWEEN: Duration = Duration::from_secs(60);

/// Shows on standard error how far a study is.
pub struct Teller {
    bar: Mutex<Option<ProgressBar>>,
    log: Mutex<Log>,
}

/// What the lines about a long study say.
struct Log {
    done: usize,
    all: usize,
    last: Instant,
}

impl Teller {
    /// For a study whose points go into this folder or file.
    pub fn new(path: &Path) -> Self {
        let path = path.display();
        last_words(format!("interrupted; the finished points are in {path}: start again to go on"));
        let log = Log { done: 0, all: 0, last: Instant::now() };
        Self { bar: Mutex::new(None), log: Mutex::new(log) }
    }
}

impl Watch for Teller {
    fn says(&self, what: &str) {
        if let (true, Ok(mut shown)) = (io::stderr().is_terminal(), self.bar.lock()) {
            let bar = shown.get_or_insert_with(ProgressBar::new_spinner);
            bar.set_message(what.to_owned());
            bar.enable_steady_tick(Duration::from_millis(200));
        }
    }

    fn begins(&self, ahead: usize, all: usize, seconds: f64) {
        if ahead == 0 {
            return;
        }
        if seconds >= LONG {
            let done = match all - ahead {
                0 => String::new(),
                done => format!("{done} of {all} points are there already; "),
            };
            let plural = if ahead == 1 { "" } else { "s" };
            eprintln!("{done}{ahead} point{plural} ahead, {}", about(seconds));
        }
        if let Ok(mut log) = self.log.lock() {
            *log = Log { done: all - ahead, all, last: Instant::now() };
        }
        if !io::stderr().is_terminal() {
            return;
        }
        let bar = ProgressBar::new(all as u64).with_position((all - ahead) as u64);
        if let Ok(style) = ProgressStyle::with_template("{bar:20} {pos}/{len}  {wide_msg}") {
            bar.set_style(style);
        }
        if seconds > 0.0 {
            bar.set_message(about(seconds));
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        if let Ok(mut shown) = self.bar.lock()
            && let Some(before) = shown.replace(bar)
        {
            before.finish_and_clear();
        }
    }

    fn is_done(&self, key: &str, seconds_left: f64) {
        if let (false, Ok(mut log)) = (io::stderr().is_terminal(), self.log.lock()) {
            log.done += 1;
            if log.last.elapsed() >= BETWEEN {
                log.last = Instant::now();
                let (done, all) = (log.done, log.all);
                // A message that cannot be written ends no study.
                let _ =
                    writeln!(io::stderr(), "{done} of {all} done, {} left", about(seconds_left));
            }
        }
        let Ok(shown) = self.bar.lock() else { return };
        let Some(bar) = &*shown else { return };
        bar.inc(1);
        bar.set_message(format!("{} left; done: {key}", about(seconds_left)));
    }
}

impl Drop for Teller {
    fn drop(&mut self) {
        if let Ok(Some(bar)) = self.bar.get_mut() {
            bar.finish_and_clear();
        }
    }
}

/// A length of wall time, roughly.
fn about(seconds: f64) -> String {
    match Duration::try_from_secs_f64(seconds) {
        Ok(duration) => format!("about {}", HumanDuration(duration)),
        Err(_) => "no end in sight".to_owned(),
    }
}
