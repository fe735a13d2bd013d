//! Progress of a fill, and what stops it: its caller, or the end of its time.

use crate::error::{Error, ErrorKind, Result};
use crate::job::Stop;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
use std::sync::{Mutex, TryLockError};
use std::time::{Duration, Instant};

/// How far a fill has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Holes that are finished, whatever their status.
    pub holes_done: usize,
    /// Holes to be filled.
    pub holes_total: usize,
}

/// Called after each hole, and within a hole about every 10 milliseconds with the counts as they are; from any of
/// the filling threads, one call at a time. [`ControlFlow::Break`] cancels the holes that are not finished.
pub type ProgressCallback<'a> = &'a (dyn Fn(Progress) -> ControlFlow<()> + Sync);

/// Time between two calls of the callback within a hole: short enough to stop within 50 ms, long enough to cost
/// nothing.
const PERIOD: Duration = Duration::from_millis(10);

/// Why the work goes on or stops.
const GO_ON: u8 = 0;
const CANCELLED: u8 = 1;
const OUT_OF_TIME: u8 = 2;

/// Counts finished holes, tells the caller, and remembers why the work has to stop.
pub(crate) struct Watch<'a> {
    start: Instant,
    time_budget: Option<f64>,
    callback: Option<ProgressCallback<'a>>,
    progress: Mutex<Progress>,
    /// Microseconds from the start to the last call of the callback.
    told: AtomicU64,
    stop: AtomicU8,
}

impl<'a> Watch<'a> {
    /// `time_budget` is in seconds from now.
    pub(crate) fn new(
        holes_total: usize,
        time_budget: Option<f64>,
        callback: Option<ProgressCallback<'a>>,
    ) -> Self {
        Self {
            start: Instant::now(),
            time_budget,
            callback,
            progress: Mutex::new(Progress {
                holes_done: 0,
                holes_total,
            }),
            told: AtomicU64::new(0),
            stop: AtomicU8::new(GO_ON),
        }
    }

    /// The holes are known now.
    pub(super) fn expect(&mut self, holes_total: usize) {
        let progress = self.progress.get_mut();
        progress.unwrap_or_else(|e| e.into_inner()).holes_total = holes_total;
    }

    /// One more hole is finished.
    pub(super) fn advance(&self) {
        if self.callback.is_none() {
            return;
        }
        // Held during the call, so that the caller sees one call at a time and counts that only grow.
        let mut progress = self.progress.lock().unwrap_or_else(|e| e.into_inner());
        progress.holes_done += 1;
        self.tell(*progress);
    }

    fn tell(&self, progress: Progress) {
        let Some(callback) = self.callback else {
            return;
        };
        if callback(progress) == ControlFlow::Break(()) {
            self.stop_for(CANCELLED);
        }
        let now = self.start.elapsed().as_micros() as u64;
        self.told.store(now, Ordering::Relaxed);
    }

    /// The first reason stands.
    fn stop_for(&self, reason: u8) {
        let relaxed = Ordering::Relaxed;
        // It is no error that another thread was faster.
        let _ = self.stop.compare_exchange(GO_ON, reason, relaxed, relaxed);
    }

    /// Fails when the caller asked to stop.
    pub(super) fn refuse_cancelled(&self) -> Result<()> {
        match self.stop.load(Ordering::Relaxed) {
            CANCELLED => Err(Error::cancelled()),
            _ => Ok(()),
        }
    }

    /// A job that is stopped says that it was cancelled; when it was the time that ran out, this says so.
    pub(crate) fn explain(&self, error: Error) -> Error {
        match (error.kind(), self.time_budget) {
            (ErrorKind::Cancelled, Some(budget))
                if self.stop.load(Ordering::Relaxed) == OUT_OF_TIME =>
            {
                let message = format!("the time budget of {budget} s ran out");
                Error::limit(message)
            }
            _ => error,
        }
    }
}

/// Asks the clock, and from time to time the caller.
impl Stop for Watch<'_> {
    fn must_stop(&self) -> bool {
        if self.stop.load(Ordering::Relaxed) != GO_ON {
            return true;
        }
        if self.callback.is_none() && self.time_budget.is_none() {
            return false;
        }
        let elapsed = self.start.elapsed();
        if self
            .time_budget
            .is_some_and(|budget| elapsed.as_secs_f64() >= budget)
        {
            self.stop_for(OUT_OF_TIME);
        } else if elapsed.as_micros() as u64
            >= self.told.load(Ordering::Relaxed) + PERIOD.as_micros() as u64
        {
            // Another thread that tells the caller right now will do.
            match self.progress.try_lock() {
                Ok(progress) => self.tell(*progress),
                Err(TryLockError::Poisoned(poisoned)) => self.tell(**poisoned.get_ref()),
                Err(TryLockError::WouldBlock) => {}
            }
        }
        self.stop.load(Ordering::Relaxed) != GO_ON
    }
}
