//! Functions of the caller that are told what happens.

use super::types::*;
use crate::fill::progress::{Progress, ProgressCallback};
use crate::fill::report::{FillReport, HoleReport, HoleStatus};
use std::ffi::CString;
use std::ops::ControlFlow;
use std::time::Instant;

/// The callbacks of one call.
pub(super) struct Callbacks {
    /// Of these the callbacks, their data and the level of the log.
    given: HolefillFillOptions,
    start: Instant,
}

// SAFETY: the documentation of `HolefillProgressCallback` says that any thread may call it, and one at a time does:
// `Watch` holds a lock meanwhile. The data is handed through and never looked at. The log is called on the
// calling thread only.
unsafe impl Sync for Callbacks {}

impl Callbacks {
    /// # Safety
    /// The functions can be called with their data as long as the result lives, from any thread.
    pub(super) unsafe fn new(given: HolefillFillOptions) -> Self {
        let start = Instant::now();
        Self { given, start }
    }

    /// Calls `work` with the progress callback, as the algorithms take it.
    pub(super) fn with_progress<R>(
        &self,
        work: impl FnOnce(Option<ProgressCallback<'_>>) -> R,
    ) -> R {
        let tell = |progress: Progress| self.tell(progress);
        match self.given.progress {
            Some(_) => work(Some(&tell)),
            None => work(None),
        }
    }

    /// Tells how far the work has come, and asks whether to go on.
    fn tell(&self, progress: Progress) -> ControlFlow<()> {
        let Some(callback) = self.given.progress else {
            return ControlFlow::Continue(());
        };
        let told = HolefillProgress {
            holes_done: progress.holes_done as u64,
            holes_total: progress.holes_total as u64,
            seconds: self.start.elapsed().as_secs_f64(),
            ..Default::default()
        };
        // SAFETY: the promise given to the constructor.
        match unsafe { callback(&told, self.given.progress_data) } {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }

    /// Tells what happened to the holes.
    pub(super) fn log(&self, report: &FillReport) {
        if self.given.log.is_none() {
            return;
        }
        for hole in &report.holes {
            let id = hole.id;
            for tried in &hole.tried {
                let text = format!("loop {id}: {} not used: {}", tried.method, tried.reason);
                self.say(HOLEFILL_LOG_DEBUG, text);
            }
            match hole.status {
                HoleStatus::Filled => self.say(HOLEFILL_LOG_INFO, filled(hole)),
                HoleStatus::Kept => {}
                HoleStatus::Failed | HoleStatus::Cancelled => {
                    let text = format!("loop {id} stays open: {}", hole.reason);
                    self.say(HOLEFILL_LOG_WARNING, text);
                }
            }
        }
    }

    fn say(&self, level: HolefillLogLevel, message: String) {
        let Some(log) = self.given.log else {
            return;
        };
        if self.given.log_level != 0 && level > self.given.log_level {
            return;
        }
        let message = message.replace(['\0', '\n'], " ");
        if let Ok(message) = CString::new(message) {
            // SAFETY: the promise given to `new`; the text lives during the call.
            unsafe { log(level, message.as_ptr(), self.given.log_data) };
        }
    }
}

fn filled(hole: &HoleReport) -> String {
    let method = hole.method.map_or("", |m| m.name());
    let mut text = format!(
        "loop {} filled: {method}, {} new vertices, {} new triangles",
        hole.id,
        hole.new_vertices.len(),
        hole.new_triangles.len()
    );
    if !hole.reason.is_empty() {
        text = format!("{text}; {}", hole.reason);
    }
    text
}
