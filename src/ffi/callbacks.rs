//! Functions of the caller that are told what happens.

use super::types::{
    HOLEFILL_LOG_DEBUG, HOLEFILL_LOG_INFO, HOLEFILL_LOG_WARNING, HOLEFILL_PROGRESS_VERSION,
    HolefillFillOptions, HolefillLogCallback, HolefillLogLevel, HolefillProgress,
    HolefillProgressCallback,
};
use crate::fill::progress::{Progress, ProgressCallback};
use crate::fill::report::{FillReport, HoleReport, HoleStatus};
use std::ffi::{CString, c_void};
use std::ops::ControlFlow;
use std::time::Instant;

/// The callbacks of one call.
pub(super) struct Callbacks {
    progress: HolefillProgressCallback,
    progress_data: *mut c_void,
    log: HolefillLogCallback,
    log_data: *mut c_void,
    log_level: HolefillLogLevel,
    start: Instant,
}

// SAFETY: the documentation of `HolefillProgressCallback` says that any thread may call it, and one at a time does:
// `Watch` holds a lock meanwhile. The data is handed through and never looked at. The log is called on the
// calling thread only.
unsafe impl Sync for Callbacks {}

impl Callbacks {
    pub(super) fn none() -> Self {
        Self {
            progress: None,
            progress_data: std::ptr::null_mut(),
            log: None,
            log_data: std::ptr::null_mut(),
            log_level: 0,
            start: Instant::now(),
        }
    }

    /// # Safety
    /// The functions can be called with their data as long as the result lives, from any thread.
    pub(super) unsafe fn new(options: &HolefillFillOptions) -> Self {
        Self {
            progress: options.progress,
            progress_data: options.progress_data,
            log: options.log,
            log_data: options.log_data,
            log_level: options.log_level,
            start: Instant::now(),
        }
    }

    /// A progress callback and no log.
    ///
    /// # Safety
    /// As for [`new`](Self::new).
    pub(super) unsafe fn of_progress(
        progress: HolefillProgressCallback,
        progress_data: *mut c_void,
    ) -> Self {
        Self {
            progress,
            progress_data,
            ..Self::none()
        }
    }

    /// Calls `work` with the progress callback, as the algorithms take it.
    pub(super) fn with_progress<R>(
        &self,
        work: impl FnOnce(Option<ProgressCallback<'_>>) -> R,
    ) -> R {
        let tell = |progress: Progress| self.tell(progress);
        match self.progress {
            Some(_) => work(Some(&tell)),
            None => work(None),
        }
    }

    /// Tells how far the work has come, and asks whether to go on.
    fn tell(&self, progress: Progress) -> ControlFlow<()> {
        let Some(callback) = self.progress else {
            return ControlFlow::Continue(());
        };
        let told = HolefillProgress {
            struct_size: size_of::<HolefillProgress>() as u32,
            version: HOLEFILL_PROGRESS_VERSION,
            holes_done: progress.holes_done as u64,
            holes_total: progress.holes_total as u64,
            seconds: self.start.elapsed().as_secs_f64(),
        };
        // SAFETY: the promise given to the constructor.
        match unsafe { callback(&told, self.progress_data) } {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }

    /// Tells what happened to the holes.
    pub(super) fn log(&self, report: &FillReport) {
        if self.log.is_none() {
            return;
        }
        for hole in &report.holes {
            for attempt in &hole.tried {
                self.say(
                    HOLEFILL_LOG_DEBUG,
                    format!(
                        "loop {}: {} not used: {}",
                        hole.id, attempt.method, attempt.reason
                    ),
                );
            }
            match hole.status {
                HoleStatus::Filled => self.say(HOLEFILL_LOG_INFO, filled(hole)),
                HoleStatus::Kept => {}
                HoleStatus::Failed | HoleStatus::Cancelled => self.say(
                    HOLEFILL_LOG_WARNING,
                    format!("loop {} stays open: {}", hole.id, hole.reason),
                ),
            }
        }
    }

    fn say(&self, level: HolefillLogLevel, message: String) {
        let Some(log) = self.log else {
            return;
        };
        if self.log_level != 0 && level > self.log_level {
            return;
        }
        let message = message.replace(['\0', '\n'], " ");
        if let Ok(message) = CString::new(message) {
            // SAFETY: the promise given to `new`; the text lives during the call.
            unsafe { log(level, message.as_ptr(), self.log_data) };
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
