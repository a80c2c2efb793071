//! Workers: the threads that share a piece of work.
//!
//! Work is cut into items whose number and bounds never depend on the threads,
//! and no item's result depends on another's, so any number of threads gives
//! the same bits.

use std::sync::{Mutex, PoisonError};

/// One thread, or a pool of several.
#[derive(Debug, Default)]
pub struct Workers {
    pool: Option<rayon::ThreadPool>,
}

impl Workers {
    /// `threads` workers; 0 takes one for each core. One worker is the calling
    /// thread itself.
    ///
    /// # Errors
    /// If the system has no more threads to give.
    pub fn new(threads: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        let threads = match threads {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            threads => threads,
        };
        let pool = match threads {
            1 => None,
            _ => Some(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?),
        };
        Ok(Self { pool })
    }

    /// How many threads share the work.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.pool.as_ref().map_or(1, rayon::ThreadPool::current_num_threads)
    }

    /// Runs a long piece of work where handing out items costs least.
    pub fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Does the work of each item, side by side: a worker that is free takes the next one. It
    /// allocates nothing.
    pub fn each<I: Send>(&self, items: &mut [I], work: impl Fn(&mut I) + Send + Sync) {
        let workers = items.len().min(self.threads());
        let queue = Mutex::new(items.iter_mut());
        self.fan_out(workers, &|| {
            while let Some(item) = next(&queue) {
                work(item);
            }
        });
    }

    /// The same, where each worker has something of its own; so there are at most as many.
    pub fn each_with<W: Send, I: Send>(
        &self,
        own: &mut [W],
        items: &mut [I],
        work: impl Fn(&mut W, &mut I) + Send + Sync,
    ) {
        let workers = items.len().min(self.threads()).min(own.len());
        let (own, queue) = (Mutex::new(own.iter_mut()), Mutex::new(items.iter_mut()));
        self.fan_out(workers, &|| {
            let Some(own) = next(&own) else { return };
            while let Some(item) = next(&queue) {
                work(own, item);
            }
        });
    }

    /// As many workers do the same work side by side. It is not generic: what wakes threads
    /// is compiled once, not for each kind of item.
    fn fan_out(&self, workers: usize, work: &(dyn Fn() + Sync)) {
        fn split(workers: usize, work: &(dyn Fn() + Sync)) {
            match workers / 2 {
                0 => work(),
                half => drop(rayon::join(|| split(half, work), || split(workers - half, work))),
            }
        }
        if workers > 1 { self.run(|| split(workers, work)) } else { work() }
    }
}

/// The next item of a queue.
fn next<I: Iterator>(queue: &Mutex<I>) -> Option<I::Item> {
    queue.lock().unwrap_or_else(PoisonError::into_inner).next()
}
