//! The command line program `holefill`: fills the holes of a mesh file, and reports the result.
//!
//! Exit status: 0 done, 1 a file cannot be read or written, 2 bad usage, 3 some holes could not be
//! filled. Tables and JSON go to standard output, everything else to standard error.

mod args;
mod compare;
mod console;
mod demo;
mod fill;
mod input;
mod inspect;
mod model;
mod points;
mod preview;
mod raster;
mod report;
mod table;
mod view;

use args::Command;
use std::process::ExitCode;

/// Result of a command that was not aborted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// All requested work is done.
    Complete,
    /// Some holes could not be filled.
    SomeFailed,
}

/// Reason why a command was aborted.
#[derive(Debug)]
enum Failure {
    /// The command line names something that does not exist, or is invalid.
    Usage(String),
    /// A file cannot be read or written.
    File(String),
}

impl Failure {
    fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into())
    }

    fn file(message: impl Into<String>) -> Self {
        Self::File(message.into())
    }
}

fn main() -> ExitCode {
    let command = match args::parse() {
        Ok(command) => command,
        Err(error) => return args::report_error(&error),
    };
    let result = match &command {
        Command::Fill(args) => fill::run(args),
        Command::Points(args) => points::run(args),
        Command::Inspect(args) => inspect::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Demo(args) => demo::run(args),
    };
    match result {
        Ok(Outcome::Complete) => ExitCode::SUCCESS,
        Ok(Outcome::SomeFailed) => ExitCode::from(3),
        Err(Failure::Usage(message)) => {
            console::message(&message);
            ExitCode::from(2)
        }
        Err(Failure::File(message)) => {
            console::message(&message);
            ExitCode::from(1)
        }
    }
}
