//! Memory: what the system says of this process.

use std::fs;

/// Forgets the greatest resident size of this process so far; `false` where the
/// system cannot (it is Linux that can).
pub(super) fn forget_peak() -> bool {
    fs::write("/proc/self/clear_refs", "5").is_ok()
}

/// The greatest resident size of this process since then, bytes; `None` where
/// the system does not say.
pub(super) fn peak_resident() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_is_written_to_counts() {
        // Only where the system says.
        if !forget_peak() {
            return;
        }
        let taken = vec![1_u8; 1 << 24];
        let peak = peak_resident();
        assert!(std::hint::black_box(&taken).iter().all(|&byte| byte == 1));
        assert!(peak.is_none_or(|bytes| bytes > 1 << 24), "{peak:?}");
    }
}
