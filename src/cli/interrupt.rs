//! Interrupt: what Ctrl-C leaves behind.

use std::fs;
use std::path::PathBuf;

/// What a shell reports for a program ended by Ctrl-C.
const INTERRUPTED: i32 = 130;

/// Removes these temporary files if the program is interrupted or asked to end.
/// Without any, the system ends the program as it ends any other.
pub fn remove_on_interrupt(temporary: Vec<PathBuf>) {
    if temporary.is_empty() {
        return;
    }
    // Without a handler the run is still right; an interrupt would only leave
    // a `.carom-….tmp` behind.
    let _ = ctrlc::set_handler(move || {
        for path in &temporary {
            let _ = fs::remove_file(path);
        }
        std::process::exit(INTERRUPTED);
    });
}
