//! `holefill compare`: the distance between two meshes.

use crate::args::CompareArgs;
use crate::table::number;
use crate::{Failure, Outcome, console, input, report};
use holefill::deviation::{self, Deviation, NormalAngles, OneWay, PointErrors};
use holefill::io::MeshData;
use serde_json::{Value, json};
use std::fmt::Write;

pub(crate) fn run(args: &CompareArgs) -> Result<Outcome, Failure> {
    let a = input::read(&args.a, false)?;
    let b = input::read(&args.b, false)?;
    let deviation = deviation::compare(&a.positions, &a.triangles, &b.positions, &b.triangles)
        .map_err(|e| {
            let (a, b) = (args.a.display(), args.b.display());
            Failure::file(format!("cannot compare {a} (first) with {b} (second): {e}"))
        })?;
    let text = if args.json {
        as_json(&a, &b, &deviation)
    } else {
        as_table(&deviation)
    };
    console::print(&text)?;
    Ok(Outcome::Complete)
}

fn as_table(deviation: &Deviation) -> String {
    let mut text = format!(
        "{:<12}{:>12}{:>12}{:>12}\n",
        "DISTANCE", "MEAN", "RMS", "MAX"
    );
    let mut row = |name: &str, [mean, rms, max]: [String; 3]| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name:<12}{mean:>12}{rms:>12}{max:>12}");
    };
    for (name, way) in [("A to B", &deviation.a_to_b), ("B to A", &deviation.b_to_a)] {
        row(name, [way.mean, way.rms, way.max].map(number));
    }
    let both = [
        String::new(),
        number(deviation.symmetric_rms),
        number(deviation.hausdorff),
    ];
    row("both ways", both);
    if let Some(NormalAngles {
        mean_deg,
        p95_deg,
        max_deg,
    }) = &deviation.normals
    {
        let _ = writeln!(
            text,
            "normals: mean {mean_deg:.3}°, 95 % below {p95_deg:.3}°, max {max_deg:.3}°"
        );
    }
    if let Some(PointErrors { ape, mpe, vertices }) = &deviation.point_errors {
        let _ = writeln!(
            text,
            "vertices of A that are not in B: {vertices}, APE {}, MPE {}",
            number(*ape),
            number(*mpe)
        );
    }
    text
}

fn as_json(a: &MeshData, b: &MeshData, deviation: &Deviation) -> String {
    let counts = |mesh: &MeshData| json!({"vertices": mesh.positions.len(), "triangles": mesh.triangles.len()});
    let way = |way: &OneWay| json!({"mean": way.mean, "rms": way.rms, "max": way.max});
    let normals = deviation.normals.as_ref().map_or(
        Value::Null,
        |n| json!({"mean_deg": n.mean_deg, "p95_deg": n.p95_deg, "max_deg": n.max_deg}),
    );
    let points = deviation.point_errors.as_ref().map_or(
        Value::Null,
        |p| json!({"ape": p.ape, "mpe": p.mpe, "vertices": p.vertices}),
    );
    report::pretty(&json!({
        "a": counts(a),
        "b": counts(b),
        "a_to_b": way(&deviation.a_to_b),
        "b_to_a": way(&deviation.b_to_a),
        "symmetric_rms": deviation.symmetric_rms,
        "hausdorff": deviation.hausdorff,
        "normals": normals,
        "point_errors": points,
    }))
}
