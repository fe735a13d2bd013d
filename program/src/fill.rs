//! `holefill fill`: reads a mesh, fills its holes, writes it.

use crate::args::{FillArgs, FillHow};
use crate::input::{LoadSeconds, Loaded, seconds_since};
use crate::preview::Scene;
use crate::report::FillFacts;
use crate::{Failure, Outcome, console, input, preview, report, table};
use holefill::io::{self, MeshData};
use holefill::{
    BoundaryLoops, Error, ErrorKind, FillOptions, FillReport, HoleStatus, Progress, Selection,
    TriMesh,
};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

pub(crate) fn run(args: &FillArgs) -> Result<Outcome, Failure> {
    let extra: Vec<&Path> = [&args.report, &args.preview]
        .into_iter()
        .flatten()
        .map(|path| path.as_path())
        .collect();
    check_destinations(&args.input, &args.output, &extra)?;
    let options = options(&args.how, args.threads)?;
    limit_threads(options.threads)?;
    let selection = selection(&args.how)?;

    let Loaded {
        mut mesh,
        boundary,
        file,
        seconds,
    } = input::load(&args.input, args.quiet)?;
    // Fails before the work starts if a named loop does not exist.
    selection
        .reasons_to_keep(&boundary)
        .map_err(|e| Failure::usage(e.to_string()))?;
    let before = [mesh.positions().len(), mesh.triangles().len()];
    let report = fill(&mut mesh, &boundary, &selection, &options, args.quiet)?;
    let after = [mesh.positions().len(), mesh.triangles().len()];

    let start = Instant::now();
    let mesh = write_mesh(&args.output, mesh, file, args.quiet)?;
    let write_seconds = seconds_since(start);

    if let Some(path) = &args.report {
        let facts = facts(
            args,
            [before, after],
            seconds,
            report.index_seconds,
            write_seconds,
        );
        let text = report::fill(&facts, &report);
        io::replace(path, |out| out.write_all(text.as_bytes())).map_err(file_failure)?;
    }
    if let Some(path) = &args.preview {
        draw(path, &mesh, before[1], &report)?;
    }
    if !args.quiet {
        console::print(&table::holes(&report))?;
    }
    let unfilled = report.count(HoleStatus::Failed) + report.count(HoleStatus::Cancelled);
    if unfilled == 0 {
        return Ok(Outcome::Complete);
    }
    console::message(&format!(
        "{unfilled} of {} holes could not be filled",
        report.holes.len()
    ));
    Ok(Outcome::SomeFailed)
}

/// Rejects destinations that cannot be written, before the work starts: that of the mesh, and the `extra` files.
pub(crate) fn check_destinations(
    input: &Path,
    output: &Path,
    extra: &[&Path],
) -> Result<(), Failure> {
    io::check_extension(output).map_err(|e| Failure::usage(e.to_string()))?;
    for (i, path) in extra.iter().enumerate() {
        let others = [input, output];
        let mut others = others.iter().chain(&extra[..i]);
        if let Some(other) = others.find(|other| io::is_same_destination(path, other)) {
            return Err(Failure::usage(format!(
                "{} would overwrite {}",
                path.display(),
                other.display()
            )));
        }
    }
    for path in std::iter::once(&output).chain(extra) {
        io::check_destination(path).map_err(|e| Failure::file(e.to_string()))?;
    }
    Ok(())
}

/// Limits all parallel work, also that of reading the mesh, to this many threads; 0 is no limit.
pub(crate) fn limit_threads(threads: usize) -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|e| Failure::file(format!("cannot start {threads} threads: {e}")))
}

pub(crate) fn options(how: &FillHow, threads: u16) -> Result<FillOptions, Failure> {
    let mut options = FillOptions::default();
    options.method = how.method;
    options.seed = how.seed;
    options.threads = threads.into();
    for (key, value) in &how.set {
        options
            .set(key, value)
            .map_err(|e| Failure::usage(e.to_string()))?;
    }
    Ok(options)
}

pub(crate) fn selection(how: &FillHow) -> Result<Selection, Failure> {
    let selection = Selection {
        only: how.only.clone(),
        keep: how.keep.clone(),
        max_edges: how.max_edges,
        max_perimeter: how.max_perimeter,
        keep_largest: how.keep_largest,
    };
    // Rules that are invalid for every mesh are found with an empty one, before the file is read.
    let rules = Selection {
        only: Vec::new(),
        keep: Vec::new(),
        ..selection.clone()
    };
    rules
        .reasons_to_keep(&BoundaryLoops::default())
        .map_err(|e| Failure::usage(e.to_string()))?;
    Ok(selection)
}

pub(crate) fn fill(
    mesh: &mut TriMesh,
    boundary: &BoundaryLoops,
    selection: &Selection,
    options: &FillOptions,
    quiet: bool,
) -> Result<FillReport, Failure> {
    let bar = if quiet || !std::io::stderr().is_terminal() {
        ProgressBar::hidden()
    } else {
        progress_bar(boundary.loops.len())
    };
    let advance = |progress: Progress| {
        bar.set_length(progress.holes_total as u64);
        bar.set_position(progress.holes_done as u64);
        ControlFlow::Continue(())
    };
    let result = holefill::fill_holes(mesh, boundary, selection, options, Some(&advance));
    bar.finish_and_clear();
    result.map_err(|e: Error| match e.kind() {
        ErrorKind::InvalidInput => Failure::usage(e.to_string()),
        _ => file_failure(e),
    })
}

fn progress_bar(holes: usize) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(holes as u64), ProgressDrawTarget::stderr());
    match ProgressStyle::with_template("filling [{bar:40}] {pos}/{len} holes, {eta} left") {
        Ok(style) => bar.with_style(style.progress_chars("=> ")),
        Err(_) => bar,
    }
}

/// Writes the mesh with the number types and properties of its input file. Returns the mesh.
pub(crate) fn write_mesh(
    path: &Path,
    mesh: TriMesh,
    mut file: MeshData,
    quiet: bool,
) -> Result<MeshData, Failure> {
    (
        file.positions,
        file.triangles,
        file.vertex_attributes,
        file.face_attributes,
    ) = mesh.into_parts();
    let notes = io::write(path, &file).map_err(file_failure)?;
    if !quiet {
        console::notes(&notes);
    }
    Ok(file)
}

fn facts(
    args: &FillArgs,
    [input, output]: [[usize; 2]; 2],
    load: LoadSeconds,
    index_seconds: f64,
    write_seconds: f64,
) -> FillFacts {
    let available = || std::thread::available_parallelism().map_or(1, usize::from);
    FillFacts {
        input,
        output,
        read_seconds: load.read,
        build_seconds: load.build + load.loops + index_seconds,
        write_seconds,
        threads: if args.threads == 0 {
            available()
        } else {
            args.threads.into()
        },
        seed: args.how.seed,
    }
}

fn draw(
    path: &Path,
    mesh: &MeshData,
    first_new: usize,
    report: &FillReport,
) -> Result<(), Failure> {
    let patches: Vec<_> = report
        .holes
        .iter()
        .map(|h| h.new_triangles.clone())
        .collect();
    let picture = preview::draw(&Scene {
        positions: &mesh.positions,
        triangles: &mesh.triangles,
        first_new,
        patches: &patches,
    });
    io::replace(path, |out| preview::write_png(&picture, out)).map_err(file_failure)
}

pub(crate) fn file_failure(error: Error) -> Failure {
    Failure::file(error.to_string())
}
