//! Workers: the threads that share a piece of work.
//!
//! Work is cut into items whose number and bounds never depend on the threads,
//! and no item's result depends on another's, so any number of threads gives
//! the same bits.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

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

    /// Does the work of each item, side by side, of many that differ in length. It allocates
    /// nothing.
    pub fn spread<I: Send>(&self, items: &mut [I], work: impl Fn(&mut I) + Send + Sync) {
        match &self.pool {
            Some(pool) if items.len() > 1 => {
                let workers = items.len().min(pool.current_num_threads());
                let queue = Mutex::new(items.iter_mut());
                let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
                fan_out(pool, workers, &|| {
                    while let Some(item) = next() {
                        work(item);
                    }
                });
            }
            _ => items.iter_mut().for_each(work),
        }
    }

    /// Does the work of each item, side by side.
    pub fn each<I: Send>(&self, items: &mut [I], work: impl Fn(&mut I) + Send + Sync) {
        match &self.pool {
            Some(pool) if items.len() > 1 => {
                let mut tasks: Vec<_> = items.iter_mut().map(|item| || work(item)).collect();
                let mut tasks: Vec<_> = tasks.iter_mut().map(|task| task as Task).collect();
                share(pool, &mut tasks);
            }
            _ => items.iter_mut().for_each(work),
        }
    }
}

/// The work of one item.
type Task<'a> = &'a mut (dyn FnMut() + Send);

/// Not generic: what hands out work is compiled once, not for each kind of item.
fn share(pool: &rayon::ThreadPool, tasks: &mut [Task]) {
    pool.install(|| tasks.par_iter_mut().for_each(|task| task()));
}

/// Not generic either: as many workers do the same work side by side.
fn fan_out(pool: &rayon::ThreadPool, workers: usize, work: &(dyn Fn() + Sync)) {
    fn split(workers: usize, work: &(dyn Fn() + Sync)) {
        match workers / 2 {
            0 => work(),
            half => drop(rayon::join(|| split(half, work), || split(workers - half, work))),
        }
    }
    pool.install(|| split(workers, work));
}
