//! Runs one program to its end, and measures its time and its peak memory.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::Result;

/// Time between two reads of the child's peak memory. Growth after the last read is missed.
const POLL: Duration = Duration::from_millis(4);

/// How a program ended.
#[derive(Debug)]
pub(crate) struct Outcome {
    /// Exit status; `None` if a signal ended the program.
    pub(crate) code: Option<i32>,
    pub(crate) timed_out: bool,
    /// Largest resident set seen, in kilobytes; `None` without `/proc`.
    pub(crate) peak_kilobytes: Option<u64>,
}

fn peak_kilobytes(pid: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// `LOG.extension`; dots in the name stay.
pub(crate) fn beside(log: &Path, extension: &str) -> PathBuf {
    let mut name = log.as_os_str().to_owned();
    name.push(".");
    name.push(extension);
    name.into()
}

/// Runs a program with its output in `LOG.out` and its messages in `LOG.err`. Stops it after `limit`.
pub(crate) fn run(command: &[String], log: &Path, limit: Duration) -> Result<Outcome> {
    let [program, args @ ..] = command else {
        return Err("no program to run".into());
    };
    let mut child = Command::new(program)
        .args(args)
        .stdin(Stdio::null())
        .stdout(File::create(beside(log, "out"))?)
        .stderr(File::create(beside(log, "err"))?)
        .spawn()
        .map_err(|e| format!("cannot start {program}: {e}"))?;
    let start = Instant::now();
    let mut peak = None;
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Outcome {
                code: status.code(),
                timed_out: false,
                peak_kilobytes: peak,
            });
        }
        peak = peak.max(peak_kilobytes(child.id()));
        if start.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(Outcome {
                code: None,
                timed_out: true,
                peak_kilobytes: peak,
            });
        }
        thread::sleep(POLL);
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str, name: &str, limit: Duration) -> Outcome {
        let log =
            std::env::temp_dir().join(format!("holefill-compare-{}-{name}", std::process::id()));
        let command = ["sh", "-c", script].map(str::to_owned);
        let outcome = run(&command, &log, limit).unwrap();
        for extension in ["out", "err"] {
            fs::remove_file(beside(&log, extension)).unwrap();
        }
        outcome
    }

    #[test]
    fn the_exit_status_of_a_program_is_told() {
        let outcome = shell("exit 3", "status", Duration::from_secs(60));
        assert_eq!(outcome.code, Some(3));
        assert!(!outcome.timed_out);
    }

    #[test]
    fn a_program_that_never_ends_is_stopped() {
        let outcome = shell("exec sleep 600", "stopped", Duration::from_millis(50));
        assert!(outcome.timed_out);
        assert_eq!(outcome.code, None);
    }

    #[test]
    fn a_missing_program_is_an_error() {
        let command = ["/nowhere/holefill".to_owned()];
        let log =
            std::env::temp_dir().join(format!("holefill-compare-{}-none", std::process::id()));
        assert!(run(&command, &log, Duration::from_secs(1)).is_err());
    }
}
