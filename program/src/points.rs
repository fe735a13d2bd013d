//! `holefill points`: reads points, makes a mesh of them, optionally fills its holes, and writes it.

use crate::args::PointsArgs;
use crate::fill::{
    check_destinations, file_failure, fill, limit_threads, options, selection, write_mesh,
};
use crate::input::seconds_since;
use crate::{Failure, Outcome, console, report, table};
use holefill::io::{self, MeshData};
use holefill::{
    AttributeValues, Attributes, BoundaryLoops, ErrorKind, FillReport, HoleStatus, PointCloud,
    PointOptions, PointReport, mesh_from_points,
};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// The attributes that hold normals.
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];

/// Seconds that the steps took.
#[derive(Default)]
struct Seconds {
    read: f64,
    reconstruct: f64,
    fill: f64,
    write: f64,
}

pub(crate) fn run(args: &PointsArgs) -> Result<Outcome, Failure> {
    let extra: Vec<&Path> = args.report.iter().map(|path| path.as_path()).collect();
    check_destinations(&args.input, &args.output, &extra)?;
    let fill_options = options(&args.how, args.threads)?;
    let selection = selection(&args.how)?;
    limit_threads(args.threads.into())?;

    let mut seconds = Seconds::default();
    let start = Instant::now();
    let mut file = io::read_points(&args.input).map_err(|e| Failure::file(e.to_string()))?;
    if !args.quiet {
        console::notes(&file.notes);
    }
    seconds.read = seconds_since(start);

    let start = Instant::now();
    let cloud = take_points(&mut file, args.ignore_normals);
    let mut point_options = PointOptions::default();
    point_options.radius = args.radius;
    point_options.neighbours = args.neighbours.into();
    let (mut mesh, points) =
        mesh_from_points(cloud, &point_options, None).map_err(|e| match e.kind() {
            ErrorKind::InvalidInput | ErrorKind::Geometry => {
                Failure::file(format!("{}: {e}", args.input.display()))
            }
            _ => file_failure(e),
        })?;
    seconds.reconstruct = seconds_since(start);
    let boundary = BoundaryLoops::find(&mesh);
    if !args.quiet {
        console::notes(&summary(&points, boundary.loops.len()));
    }

    let mut holes = None;
    if args.fill {
        let start = Instant::now();
        selection
            .reasons_to_keep(&boundary)
            .map_err(|e| Failure::usage(e.to_string()))?;
        holes = Some(fill(
            &mut mesh,
            &boundary,
            &selection,
            &fill_options,
            args.quiet,
        )?);
        seconds.fill = seconds_since(start);
    }

    let start = Instant::now();
    let written = write_mesh(&args.output, mesh, file, args.quiet)?;
    seconds.write = seconds_since(start);
    if let Some(path) = &args.report {
        let text = as_json(&points, &boundary, holes.as_ref(), &written, &seconds);
        io::replace(path, |out| out.write_all(text.as_bytes())).map_err(file_failure)?;
    }
    outcome(&boundary, holes.as_ref(), args.quiet)
}

/// Moves the points out of `file`, with their normals unless `ignore_normals` is set.
fn take_points(file: &mut MeshData, ignore_normals: bool) -> PointCloud {
    let normals = if ignore_normals {
        None
    } else {
        normals(&file.vertex_attributes)
    };
    PointCloud {
        positions: std::mem::take(&mut file.positions),
        attributes: std::mem::take(&mut file.vertex_attributes),
        normals,
    }
}

fn normals(attributes: &Attributes) -> Option<Vec<[f64; 3]>> {
    let [x, y, z] = NORMAL.map(|name| match attributes.get(name) {
        Some(AttributeValues::Scalars(values)) => Some(values),
        _ => None,
    });
    let (x, y, z) = (x?, y?, z?);
    (0..attributes.len())
        .map(|v| Some([x.get(v)?, y.get(v)?, z.get(v)?]))
        .collect()
}

fn summary(points: &PointReport, loops: usize) -> Vec<String> {
    let mut lines = vec![format!(
        "{} triangles from {} of {} points, {} boundary loops",
        points.triangles, points.used, points.points, loops
    )];
    if points.duplicates > 0 {
        lines.push(format!(
            "{} points have the same position as an earlier one; no triangle uses them",
            points.duplicates
        ));
    }
    if points.unused > 0 {
        lines.push(format!("no triangle uses {} other points", points.unused));
    }
    lines
}

fn as_json(
    points: &PointReport,
    boundary: &BoundaryLoops,
    holes: Option<&FillReport>,
    written: &MeshData,
    seconds: &Seconds,
) -> String {
    let [smallest, median, largest] = points.radius;
    report::pretty(&json!({
        "input": {"points": points.points, "estimated_normals": points.estimated_normals},
        "used": points.used,
        "duplicates": points.duplicates,
        "unused": points.unused,
        "triangles": points.triangles,
        "pieces": points.pieces,
        "radius": {"smallest": smallest, "median": median, "largest": largest},
        "loops": boundary.loops.iter().map(report::boundary_loop).collect::<Vec<Value>>(),
        "holes": holes.map(|r| &r.holes),
        "output": {"vertices": written.positions.len(), "triangles": written.triangles.len()},
        "seconds": {
            "read": seconds.read,
            "reconstruct": seconds.reconstruct,
            "fill": seconds.fill,
            "write": seconds.write,
        },
    }))
}

fn outcome(
    boundary: &BoundaryLoops,
    holes: Option<&FillReport>,
    quiet: bool,
) -> Result<Outcome, Failure> {
    let Some(holes) = holes else {
        if !quiet && !boundary.loops.is_empty() {
            console::print(&table::loops(&boundary.loops))?;
        }
        return Ok(Outcome::Complete);
    };
    if !quiet {
        console::print(&table::holes(holes))?;
    }
    let unfilled = holes.count(HoleStatus::Failed) + holes.count(HoleStatus::Cancelled);
    if unfilled == 0 {
        return Ok(Outcome::Complete);
    }
    console::message(&format!(
        "{unfilled} of {} holes could not be filled",
        holes.holes.len()
    ));
    Ok(Outcome::SomeFailed)
}
