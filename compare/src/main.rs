//! Compares the `holefill` program with CGAL's hole filling (`cgal_fill`).
//!
//! `inputs` makes the large inputs. `run` measures both programs on them and on a folder of cases. `ablate` measures
//! the effect of each stage of the method `auto`.

mod ablation;
mod deviation;
mod inputs;
mod job;
mod judge;
mod measure;
mod ply;
mod process;
mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

/// Errors: of a file, of a program, or a report that does not have the expected form.
type Error = Box<dyn std::error::Error>;
type Result<T> = std::result::Result<T, Error>;

#[derive(Parser)]
#[command(version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Make the large inputs, one folder each: `DIR/NAME/input.ply` and `meta.json`.
    Inputs {
        /// Folder to write to; about 150 MB.
        dir: PathBuf,
    },
    /// Measure both programs, print the table and check every target.
    Run(RunArgs),
    /// Switch off the stages of `auto`, prescribe its candidates, and print both tables.
    Ablate(AblateArgs),
}

#[derive(Args)]
struct AblateArgs {
    /// Folder of cases, each with `input.ply`, `truth.ply` and `meta.json`.
    #[arg(long)]
    cases: PathBuf,
    /// The program built from `compare/CMakeLists.txt`; optional.
    #[arg(long, default_value = "compare/build/cgal_fill")]
    cgal: PathBuf,
    /// The holefill program.
    #[arg(long, default_value = "target/release/holefill")]
    holefill: PathBuf,
    /// Where outputs and reports go.
    #[arg(long, default_value = "compare/out")]
    out: PathBuf,
    /// Also write the tables to this file.
    #[arg(long)]
    markdown: Option<PathBuf>,
    /// Only cases whose name contains this text.
    #[arg(long)]
    only: Option<String>,
    /// Only cases with at most this many rim edges to fill.
    #[arg(long, default_value_t = 1000)]
    most_edges: u64,
    /// Seconds after which a program is stopped.
    #[arg(long, default_value_t = 200.0)]
    limit_seconds: f64,
}

#[derive(Args)]
struct RunArgs {
    /// Folder of cases, each with `input.ply`, `meta.json` and optionally `truth.ply`.
    #[arg(long)]
    cases: Option<PathBuf>,
    /// Folder made by `inputs`.
    #[arg(long)]
    inputs: Option<PathBuf>,
    /// The program built from `compare/CMakeLists.txt`.
    #[arg(long, default_value = "compare/build/cgal_fill")]
    cgal: PathBuf,
    /// The holefill program.
    #[arg(long, default_value = "target/release/holefill")]
    holefill: PathBuf,
    /// Where outputs and reports go.
    #[arg(long, default_value = "compare/out")]
    out: PathBuf,
    /// Also write the table to this file.
    #[arg(long)]
    markdown: Option<PathBuf>,
    /// External scorer, called as `CMD CASE_DIR OUTPUT --json`, in place of the built-in measure.
    #[arg(long)]
    scorer: Option<String>,
    /// Only cases and inputs whose name contains this text.
    #[arg(long)]
    only: Option<String>,
    /// Runs of each program, of which the median is taken; a fill above one second runs once.
    #[arg(long, default_value_t = 5)]
    repeats: usize,
    /// Seconds of filling after which a program is stopped.
    #[arg(long, default_value_t = 200.0)]
    limit_seconds: f64,
}

fn run(args: &RunArgs) -> Result<bool> {
    let results = measure::measure(&measure::Settings {
        cases: args.cases.clone(),
        inputs: args.inputs.clone(),
        cgal: args.cgal.clone(),
        holefill: args.holefill.clone(),
        out: args.out.clone(),
        scorer: args.scorer.clone(),
        only: args.only.clone(),
        repeats: args.repeats.max(1),
        limit_seconds: args.limit_seconds,
    })?;
    let verdicts = table::verdicts(&results);
    let text = table::markdown(&results, &verdicts);
    show(&text, args.markdown.as_deref())?;
    Ok(verdicts.iter().all(|verdict| verdict.met == Some(true)))
}

fn ablate(args: &AblateArgs) -> Result<bool> {
    let text = ablation::table(&ablation::Settings {
        cases: args.cases.clone(),
        holefill: args.holefill.clone(),
        cgal: args.cgal.clone(),
        out: args.out.clone(),
        only: args.only.clone(),
        most_edges: args.most_edges,
        limit_seconds: args.limit_seconds,
    })?;
    show(&text, args.markdown.as_deref())?;
    Ok(true)
}

/// Prints the text and writes it to a file if there is one.
fn show(text: &str, file: Option<&Path>) -> Result<()> {
    print!("{text}");
    if let Some(path) = file {
        std::fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    }
    Ok(())
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Inputs { dir } => inputs::write_all(&dir).map(|()| true),
        Command::Run(args) => run(&args),
        Command::Ablate(args) => ablate(&args),
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(3),
        Err(error) => {
            eprintln!("holefill-compare: {error}");
            ExitCode::FAILURE
        }
    }
}
