//! Points: the pieces of work that a study is made of, each with a result that
//! is kept as soon as it is there.

use std::sync::Mutex;
use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::StudyError;
use super::journal::Journal;

/// What a point of a study does.
type Measure<'a, R> = Box<dyn Fn() -> Result<R, StudyError> + Send + Sync + 'a>;

/// A piece of work of a study.
pub struct Point<'a, R> {
    /// What it is called; no other point of the study has this name.
    pub key: String,
    /// How long it should take, seconds. Only the proportions matter once some
    /// points are done.
    pub seconds: f64,
    measure: Measure<'a, R>,
}

/// What a study reports its progress to.
pub trait Watch: Sync {
    /// This is done before the points are begun.
    fn says(&self, what: &str) {
        let _ = what;
    }

    /// The points that are ahead, of those in all, which should take this number of
    /// seconds.
    fn begins(&self, ahead: usize, all: usize, seconds: f64);

    /// A point is done; the others should take this number of seconds.
    fn is_done(&self, key: &str, seconds_left: f64);
}

/// Without a watcher.
impl Watch for () {
    fn begins(&self, _: usize, _: usize, _: f64) {}
    fn is_done(&self, _: &str, _: f64) {}
}

/// In what order the points of a study are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// One after another: for those that measure time.
    OneByOne,
    /// As many at once as there are cores.
    AtOnce,
}

impl<'a, R: Serialize + DeserializeOwned + Send> Point<'a, R> {
    /// A point that does this, in about this number of seconds.
    pub fn new(
        key: impl Into<String>,
        seconds: f64,
        measure: impl Fn() -> Result<R, StudyError> + Send + Sync + 'a,
    ) -> Self {
        Self { key: key.into(), seconds, measure: Box::new(measure) }
    }

    /// The same, named as a part of something.
    pub(super) fn of(self, whole: &str) -> Self {
        Self { key: format!("{whole}: {}", self.key), ..self }
    }

    /// The results of all points, in their order: those that the journal has from
    /// an earlier time, and the others, each written down when it is done.
    ///
    /// # Errors
    /// The first one that a point has, or if the journal cannot be written.
    pub fn all(
        points: &[Self],
        journal: &Journal,
        order: Order,
        watch: &dyn Watch,
    ) -> Result<Vec<R>, StudyError> {
        let mut results: Vec<Option<R>> =
            points.iter().map(|point| journal.result(&point.key)).collect::<Result<_, _>>()?;
        let ahead: Vec<usize> = (0..points.len()).filter(|&k| results[k].is_none()).collect();
        let cores = match order {
            Order::OneByOne => 1,
            Order::AtOnce => rayon::current_num_threads().min(ahead.len()).max(1),
        };
        let seconds: f64 = ahead.iter().map(|&k| points[k].seconds).sum();
        watch.begins(ahead.len(), points.len(), seconds / cores as f64);
        let state = Mutex::new((seconds, 0.0));
        let start = Instant::now();
        let measure = |&k: &usize| {
            let point = &points[k];
            let result = (point.measure)()?;
            journal.keep(&point.key, &result)?;
            let mut state = state.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            state.0 -= point.seconds;
            state.1 += point.seconds;
            let left = state.0 * start.elapsed().as_secs_f64() / state.1.max(f64::MIN_POSITIVE);
            watch.is_done(&point.key, left);
            Ok((k, result))
        };
        let measured: Vec<(usize, R)> = match order {
            Order::OneByOne => ahead.iter().map(measure).collect::<Result<_, StudyError>>()?,
            Order::AtOnce => {
                ahead.par_iter().with_max_len(1).map(measure).collect::<Result<_, StudyError>>()?
            }
        };
        for (k, result) in measured {
            results[k] = Some(result);
        }
        Ok(results.into_iter().flatten().collect())
    }
}
