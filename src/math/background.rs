//! Work that cannot be interrupted, made so that its caller need not wait for its end.

use crate::error::{Error, ErrorKind, Result, proceed_unless};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// Time between two questions whether to go on.
const PERIOD: Duration = Duration::from_millis(5);

/// Runs `work` on a thread of its own and waits for its result, asking `interrupted` from time to time on the
/// calling thread.
///
/// Once interrupted it waits no longer. The thread lives on until `work`, which owns all that it needs, comes to the
/// next question that it puts to its argument, or to its end; then its memory is free again.
///
/// # Errors
/// [`ErrorKind::Cancelled`] when interrupted, [`ErrorKind::Limit`] when no thread can be started.
pub(crate) fn run_unless<T: Send + 'static>(
    interrupted: &dyn Fn() -> bool,
    work: impl FnOnce(&dyn Fn() -> bool) -> T + Send + 'static,
) -> Result<T> {
    let is_given_up = Arc::new(AtomicBool::new(false));
    let (sender, receiver) = mpsc::channel();
    let is_given_up_there = Arc::clone(&is_given_up);
    let run = move || {
        let result = work(&|| is_given_up_there.load(Ordering::Relaxed));
        // Nobody listens when the work was given up.
        let _ = sender.send(result);
    };
    let started = thread::Builder::new()
        .name("holefill".to_owned())
        .spawn(run);
    started.map_err(|e| Error::new(ErrorKind::Limit, format!("cannot start a thread: {e}")))?;
    loop {
        match receiver.recv_timeout(PERIOD) {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Error::new(ErrorKind::Solver, "the work broke off"));
            }
        }
        if let Err(cancelled) = proceed_unless(interrupted) {
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
    fn the_result_comes_back_and_an_interrupt_does_not_wait_for_it() {
        assert_eq!(run_unless(&|| false, |_| 7).unwrap(), 7);
        let (sender, receiver) = mpsc::channel();
        let start = Instant::now();
        let outcome = run_unless(&|| true, move |is_given_up| {
            while !is_given_up() && start.elapsed() < Duration::from_secs(60) {
                thread::yield_now();
            }
            let _ = sender.send(is_given_up());
        });
        assert_eq!(outcome.unwrap_err().kind(), ErrorKind::Cancelled);
        assert!(
            receiver.recv().unwrap(),
            "the work is told that it was given up"
        );
    }

    #[test]
    fn work_that_panics_is_an_error() {
        let outcome = run_unless::<()>(&|| false, |_| panic!("on purpose"));
        assert_eq!(outcome.unwrap_err().kind(), ErrorKind::Solver);
    }
}
