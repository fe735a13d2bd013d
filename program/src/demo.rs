//! `holefill demo`: makes a damaged model, and fills it like any other.

use crate::args::{DemoArgs, FillArgs, FillHow};
use crate::model::damaged_knot;
use crate::{Failure, Outcome, console, fill};
use holefill::io::{self, MeshData};
use std::fs;

pub(crate) fn run(args: &DemoArgs) -> Result<Outcome, Failure> {
    let dir = &args.dir;
    fs::create_dir_all(dir)
        .map_err(|e| Failure::file(format!("cannot create the folder {}: {e}", dir.display())))?;
    let damaged = dir.join("damaged.ply");
    let (positions, triangles) = damaged_knot();
    io::write(&damaged, &MeshData::new(positions, triangles))
        .map_err(|e| Failure::file(e.to_string()))?;
    let fill = FillArgs {
        input: damaged,
        output: dir.join("filled.ply"),
        how: FillHow::default(),
        threads: 0,
        report: Some(dir.join("report.json")),
        preview: Some(dir.join("preview.png")),
        quiet: false,
    };
    let outcome = fill::run(&fill)?;
    let files = ["damaged.ply", "filled.ply", "report.json", "preview.png"];
    let places = files.map(|file| format!("{}\n", dir.join(file).display()));
    console::print(&format!("\n{}", places.concat()))?;
    Ok(outcome)
}
