//! Closed output: whether the program was started without a standard output, as
//! `carom run >&-` does.

use std::io;
#[cfg(unix)]
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(unix)]
static IS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Looks before `main`: Rust's own start opens `/dev/null` in the place of what
/// is closed, and whatever is printed would vanish without an error.
#[cfg(unix)]
#[ctor::ctor]
fn look() {
    let is_there = |path: &str| std::fs::metadata(path).is_ok();
    IS_CLOSED.store(is_there("/dev/fd") && !is_there("/dev/fd/1"), Ordering::Relaxed);
}

/// The error of writing to a standard output that is closed.
pub fn open() -> io::Result<()> {
    #[cfg(unix)]
    if IS_CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::other("it is closed"));
    }
    Ok(())
}
