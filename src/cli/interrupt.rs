//! Interrupt: how the program ends when it is asked to, by Ctrl-C, by `kill`, or
//! as its terminal goes away.

use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::sync::{Mutex, PoisonError};

use carom::output::abandon_unfinished;

/// What is said when the program is asked to end.
static LAST_WORDS: Mutex<Option<String>> = Mutex::new(None);

/// Whether a run is under way that keeps itself when it is asked to end.
static KEEPS: AtomicBool = AtomicBool::new(false);

/// Whether it is asked to keep itself now.
static KEEP: AtomicBool = AtomicBool::new(false);

/// The status that it is asked to end with; 0 if it is not.
static END: AtomicI32 = AtomicI32::new(0);

/// From now on, a run asks itself what was asked of it ([`is_asked_to_keep`],
/// [`asked_to_end`]), or no longer does.
pub fn keeps(keeps: bool) {
    KEEPS.store(keeps, Ordering::SeqCst);
}

/// Whether the run has been asked to keep itself since this was called last.
pub fn is_asked_to_keep() -> bool {
    KEEP.swap(false, Ordering::SeqCst)
}

/// The status that the run has been asked to end with, if it has.
pub fn asked_to_end() -> Option<i32> {
    Some(END.load(Ordering::SeqCst)).filter(|status| *status != 0)
}

/// Sets what is said when the program is asked to end.
pub fn last_words(words: String) {
    *LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner) = Some(words);
}

/// Ends the program, and leaves nothing half written. A run that keeps itself does so
/// first, unless it is asked a second time.
fn end(status: i32) {
    if KEEPS.load(Ordering::SeqCst) && END.swap(status, Ordering::SeqCst) == 0 {
        return;
    }
    abandon_unfinished(|| {
        let words = LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(words) = &*words {
            eprintln!("\n{}", super::plain(words));
        }
        std::process::exit(status);
    });
}

/// From now on an interrupt ends the program with the status that a shell
/// reports for it, 128 and the signal's number, and removes what is half
/// written. A file that grows past its limit is an error of writing.
///
/// To be called before there is another thread. Without it a run is still
/// right; an interrupt would only leave a `.carom-….tmp` behind.
#[cfg(unix)]
pub fn watch() {
    use nix::sys::signal::{SigSet, Signal};
    let mut waited_for = SigSet::empty();
    let ending = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP, Signal::SIGXCPU];
    for signal in ending.into_iter().chain([Signal::SIGUSR1]) {
        // A script's shell lets its background jobs ignore Ctrl-C, which goes to all of
        // a terminal; one that is sent to this process alone is meant.
        if signal == Signal::SIGINT || !is_ignored(signal as u32) {
            waited_for.add(signal);
        }
    }
    let mut blocked = waited_for;
    blocked.add(Signal::SIGXFSZ);
    if blocked.thread_block().is_err() {
        return;
    }
    let waiting = std::thread::Builder::new().name("signals".into()).spawn(move || {
        while let Ok(signal) = waited_for.wait() {
            if signal == Signal::SIGUSR1 && KEEPS.load(Ordering::SeqCst) {
                KEEP.store(true, Ordering::SeqCst);
            } else {
                end(128 + signal as i32);
            }
        }
    });
    if waiting.is_err() {
        // Signals end the program as they end any other, then.
        let _ = waited_for.thread_unblock();
    }
}

/// As above, with Ctrl-C only.
#[cfg(not(unix))]
pub fn watch() {
    let _ = ctrlc::set_handler(|| end(130));
}

/// Whether the program was started so that a signal does nothing, as `nohup`
/// does: it stays so.
#[cfg(unix)]
fn is_ignored(signal: u32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}
