//! `holefill inspect`: the boundary loops of a mesh.

use crate::args::InspectArgs;
use crate::{Failure, Outcome, console, input, report, table};
use serde_json::{Value, json};

pub(crate) fn run(args: &InspectArgs) -> Result<Outcome, Failure> {
    let loaded = input::load(&args.input, false)?;
    let loops = &loaded.boundary.loops;
    let text = if args.json {
        report::pretty(&json!({
            "vertices": loaded.mesh.positions().len(),
            "triangles": loaded.mesh.triangles().len(),
            "defects": report::defects(loaded.mesh.defects()),
            "notes": loaded.file.notes,
            "loops": loops.iter().map(report::boundary_loop).collect::<Vec<Value>>(),
            "seconds": {
                "read": loaded.seconds.read,
                "build": loaded.seconds.build,
                "loops": loaded.seconds.loops,
            },
        }))
    } else {
        table::loops(loops)
    };
    if loops.is_empty() {
        console::message("no holes");
    }
    console::print(&text)?;
    Ok(Outcome::Complete)
}
