//! Runs work that cannot be cancelled on a thread of its own, so that its caller can be cancelled.

use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// Time between two checks whether the job is cancelled.
const PERIOD: Duration = Duration::from_millis(5);

/// Runs `work` on a thread of its own and waits for its result, unless `job` is cancelled.
///
/// If `job` is cancelled, the function returns and cancels the job of `work`. The thread lives on until `work` checks
/// its job or ends; then its memory is freed. `work` owns all its data.
///
/// # Errors
/// [`ErrorKind::Cancelled`] when `job` is cancelled, [`ErrorKind::Limit`] when no thread can be started.
pub(crate) fn run_in_background<T: Send + 'static>(
    job: &Job<'_>,
    work: impl FnOnce(&Job<'_>) -> T + Send + 'static,
) -> Result<T> {
    let is_given_up = Arc::new(AtomicBool::new(false));
    let (sender, receiver) = mpsc::channel();
    let is_given_up_there = Arc::clone(&is_given_up);
    let run = move || {
        let result = work(&Job::new(&*is_given_up_there));
        // After a cancellation there is no receiver.
        let _ = sender.send(result);
    };
    let started = thread::Builder::new()
        .name("holefill".to_owned())
        .spawn(run);
    started.map_err(|e| Error::limit(format!("cannot start a thread: {e}")))?;
    loop {
        match receiver.recv_timeout(PERIOD) {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Error::new(ErrorKind::Solver, "the work broke off"));
            }
        }
        if let Err(cancelled) = job.ask() {
            is_given_up.store(true, Ordering::Relaxed);
            return Err(cancelled);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    #[test]
    fn the_result_comes_back_and_a_stop_does_not_wait_for_it() {
        assert_eq!(run_in_background(&Job::unlimited(), |_| 7).unwrap(), 7);
        let (sender, receiver) = mpsc::channel();
        let start = Instant::now();
        let outcome = run_in_background(&Job::new(&|| true), move |job| {
            while job.ask().is_ok() && start.elapsed() < Duration::from_secs(60) {
                thread::yield_now();
            }
            let _ = sender.send(job.ask().is_err());
        });
        assert_eq!(outcome.unwrap_err().kind(), ErrorKind::Cancelled);
        assert!(
            receiver.recv().unwrap(),
            "the work is told that it was given up"
        );
    }

    #[test]
    fn work_that_panics_is_an_error() {
        let outcome = run_in_background::<()>(&Job::unlimited(), |_| panic!("on purpose"));
        assert_eq!(outcome.unwrap_err().kind(), ErrorKind::Solver);
    }
}
