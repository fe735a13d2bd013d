//! Work that can be cancelled.
//!
//! Whoever does long work holds a [`Job`] and tells it, again and again, what was done:
//!
//! ```text
//! fn lengths(edges: &[Edge], job: &Job<'_>) -> Result<Vec<f64>> {
//!     let mut lengths = Vec::with_capacity(edges.len());
//!     for edge in edges {
//!         job.tick(1)?;               // ends the work here once it has to stop
//!         lengths.push(edge.length());
//!     }
//!     Ok(lengths)
//! }
//! ```
//!
//! Most ticks only add their cost to a sum. When the sum reaches [`GRAIN`], the job asks what it was made from:
//!
//! ```text
//!    caller's callback   time budget            flag of a thread
//!              \           /                          |
//!            fill::progress::Watch                AtomicBool          nothing
//!                      |  Stop                        |  Stop            |
//!               Job::new(&watch)              Job::new(&flag)    Job::unlimited()
//!                      |
//!    tick(1) tick(1) tick(300) ... ask() ... tick(1)  ->  Err(Cancelled)
//! ```
//!
//! Ticks decide nothing but whether the work ends: what it computes does not depend on them.

use crate::error::{Error, Result};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

/// Cost between two questions whether to stop: about 0.3 ms of work. Asking takes less than a thousandth of that.
const GRAIN: usize = 10_000;

/// Decides whether work has to stop.
pub(crate) trait Stop: Sync {
    /// Whether the work has to stop. Any thread may ask.
    fn must_stop(&self) -> bool;
}

/// A flag that another thread sets.
impl Stop for AtomicBool {
    fn must_stop(&self) -> bool {
        self.load(Relaxed)
    }
}

/// For tests that count the questions.
#[cfg(test)]
impl<F: Fn() -> bool + Sync> Stop for F {
    fn must_stop(&self) -> bool {
        self()
    }
}

/// Work that its caller can cancel, or whose time can run out.
///
/// Threads may share one. Threads that tick often do better with one each, made from the same [`Stop`].
pub(crate) struct Job<'a> {
    /// `None`: nothing stops it.
    stop: Option<&'a dyn Stop>,
    /// Cost since the last question. A tick that is lost between two threads only delays the next question.
    spent: AtomicUsize,
    is_stopped: AtomicBool,
}

impl<'a> Job<'a> {
    /// Work that `stop` can stop. The first tick asks at once.
    pub(crate) fn new(stop: &'a dyn Stop) -> Self {
        Self {
            stop: Some(stop),
            spent: AtomicUsize::new(GRAIN),
            is_stopped: AtomicBool::new(false),
        }
    }
}

/// Work that nothing stops, for tests that keep a reference.
#[cfg(test)]
pub(crate) static UNLIMITED: Job<'static> = Job::unlimited();

impl Job<'_> {
    /// Work that nothing stops.
    pub(crate) const fn unlimited() -> Job<'static> {
        Job {
            stop: None,
            spent: AtomicUsize::new(0),
            is_stopped: AtomicBool::new(false),
        }
    }

    /// Counts work and ends it, by `?`, once it has to stop.
    ///
    /// The unit of `cost` is some 30 ns: one vertex or triangle in a plain pass over an array. Costs may be wrong by
    /// a factor of ten. In loops whose steps are shorter, tick once for many of them.
    ///
    /// # Errors
    /// `Cancelled` when the work has to stop, and at every tick later.
    #[inline]
    pub(crate) fn tick(&self, cost: usize) -> Result<()> {
        let spent = self.spent.load(Relaxed).saturating_add(cost);
        if spent < GRAIN {
            self.spent.store(spent, Relaxed);
            return Ok(());
        }
        self.ask()
    }

    /// Asks at once. For steps between which nobody can say how long they take.
    ///
    /// # Errors
    /// As [`tick`](Self::tick).
    pub(crate) fn ask(&self) -> Result<()> {
        if self.is_stopped() || self.stop.is_some_and(Stop::must_stop) {
            self.is_stopped.store(true, Relaxed);
            self.spent.store(GRAIN, Relaxed);
            return Err(Error::cancelled());
        }
        self.spent.store(0, Relaxed);
        Ok(())
    }

    /// Whether a question before was answered by a stop: parallel loops that cannot end early skip what is left.
    #[inline]
    pub(crate) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    #[test]
    fn the_first_tick_asks_and_then_one_in_every_grain() {
        let asked = AtomicUsize::new(0);
        let ask = || {
            asked.fetch_add(1, Relaxed);
            false
        };
        let job = Job::new(&ask);
        let questions_after = |ticks: usize, cost: usize| {
            (0..ticks).for_each(|_| job.tick(cost).unwrap());
            asked.load(Relaxed)
        };
        assert_eq!(questions_after(1, 1), 1);
        assert_eq!(questions_after(GRAIN - 1, 1), 1);
        assert_eq!(questions_after(1, 1), 2);
        assert_eq!(questions_after(4, GRAIN / 2), 4);
        assert_eq!(questions_after(3, usize::MAX), 7);
        job.ask().unwrap();
        assert_eq!(asked.load(Relaxed), 8);
    }

    #[test]
    fn what_is_stopped_stays_stopped() {
        let asked = AtomicUsize::new(0);
        // Only the second question is answered by yes.
        let ask = || asked.fetch_add(1, Relaxed) == 1;
        let job = Job::new(&ask);
        job.tick(1).unwrap();
        assert_eq!(job.tick(GRAIN).unwrap_err().kind(), ErrorKind::Cancelled);
        assert!((0..3).all(|_| job.tick(0).is_err() && job.ask().is_err()));
        assert_eq!(asked.load(Relaxed), 2);
    }

    #[test]
    fn all_threads_that_share_a_job_stop() {
        let flag = AtomicBool::new(false);
        let job = Job::new(&flag);
        std::thread::scope(|scope| {
            let work = || while job.tick(1).is_ok() {};
            let threads = [scope.spawn(work), scope.spawn(work)];
            flag.store(true, Relaxed);
            for thread in threads {
                thread.join().unwrap();
            }
        });
        assert!(job.tick(0).is_err());
    }

    #[test]
    fn nothing_stops_an_unlimited_job() {
        let job = Job::unlimited();
        assert!((0..3).all(|_| job.tick(usize::MAX).is_ok() && job.ask().is_ok()));
    }
}
