//! Machine: on what a study was made, so that its times mean something.

use core::fmt;
use std::thread;

use serde::Serialize;
use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};

/// The machine at hand, and for which one the program was built.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// The processor's name, if the system says.
    pub processor: String,
    /// Threads that can run at once.
    pub threads: usize,
    /// Main memory, bytes.
    pub memory: u64,
    /// The operating system.
    pub system: String,
    /// The architecture that the program was built for.
    pub architecture: &'static str,
    /// The vector instructions that it was built with.
    pub instructions: Vec<&'static str>,
    /// The version of carom.
    pub carom: &'static str,
}

/// Of those that widen or fuse, which ones the program was built with.
const INSTRUCTIONS: [(&str, bool); 6] = [
    ("sse2", cfg!(target_feature = "sse2")),
    ("avx", cfg!(target_feature = "avx")),
    ("avx2", cfg!(target_feature = "avx2")),
    ("avx512f", cfg!(target_feature = "avx512f")),
    ("neon", cfg!(target_feature = "neon")),
    ("simd128", cfg!(target_feature = "simd128")),
];

impl Machine {
    /// The machine that this runs on.
    #[must_use]
    pub fn here() -> Self {
        let what = RefreshKind::nothing()
            .with_cpu(CpuRefreshKind::nothing())
            .with_memory(MemoryRefreshKind::nothing().with_ram());
        let system = System::new_with_specifics(what);
        let brand = system.cpus().first().map_or("", |cpu| cpu.brand().trim());
        Self {
            processor: if brand.is_empty() { "unknown".to_owned() } else { brand.to_owned() },
            threads: thread::available_parallelism().map_or(1, usize::from),
            memory: system.total_memory(),
            system: System::long_os_version().unwrap_or_else(|| std::env::consts::OS.to_owned()),
            architecture: std::env::consts::ARCH,
            instructions: INSTRUCTIONS
                .iter()
                .filter(|(_, has)| *has)
                .map(|(name, _)| *name)
                .collect(),
            carom: env!("CARGO_PKG_VERSION"),
        }
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { processor, threads, memory, system, architecture, instructions, carom } = self;
        write!(
            f,
            "{processor}, {threads} threads, {:.0} GB, {system}\ncarom {carom} for {architecture}",
            *memory as f64 * 1e-9
        )?;
        if !instructions.is_empty() {
            write!(f, " with {}", instructions.join(", "))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_what_there_is() {
        let machine = Machine::here();
        assert!(machine.threads >= 1 && machine.memory > 1 << 20);
        assert!(machine.to_string().contains(std::env::consts::ARCH));
    }
}
