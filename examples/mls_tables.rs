//! Runs the experiments of J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed
//! from point clouds", 2006, Tables 1, 3 and 4, on models that are at hand, and prints them as Markdown beside
//! the paper's figures:
//!
//! ```sh
//! cargo run --example mls_tables -- ../shared/data/cases > docs/results/mls.md
//! ```
//!
//! The argument is the folder of the models; each has `input.ply` and `meta.json` with the loops that stay open.

// Printing is what it is for.
#![allow(clippy::print_stdout)]

use holefill::{
    BoundaryLoops, FillOptions, FillReport, HoleStatus, Method, Selection, TriMesh, fill_holes, io,
};
use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

/// Runs of each measurement, of which the fastest counts.
const RUNS: usize = 5;

/// A row of the paper's Table 1 and the model that comes nearest to it.
struct Row {
    paper: &'static str,
    vertices_before: usize,
    vertices_after: usize,
    vicinity: usize,
    seconds: f64,
    model: &'static str,
}

const TABLE_1: [Row; 5] = [
    Row {
        paper: "Bunny",
        vertices_before: 35_947,
        vertices_after: 36_478,
        vicinity: 1_246,
        seconds: 6.43,
        model: "bunny_natural",
    },
    Row {
        paper: "Bust",
        vertices_before: 12_853,
        vertices_after: 16_162,
        vicinity: 1_506,
        seconds: 72.85,
        model: "skull_patches",
    },
    Row {
        paper: "Angel",
        vertices_before: 10_189,
        vertices_after: 11_264,
        vicinity: 347,
        seconds: 4.16,
        model: "gargoyle_like",
    },
    Row {
        paper: "Armchair",
        vertices_before: 64_159,
        vertices_after: 65_114,
        vicinity: 1_873,
        seconds: 10.93,
        model: "colored_bunny",
    },
    Row {
        paper: "Buddha",
        vertices_before: 143_298,
        vertices_after: 144_701,
        vicinity: 1_154,
        seconds: 10.32,
        model: "lion_natural",
    },
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("which folder are the models in?")?;
    let folder = Path::new(&folder);
    println!("# Moving least squares beside the paper\n");
    println!(
        "J. Wang, M. M. Oliveira, \"Filling holes on locally smooth surfaces reconstructed from point clouds\", 2006. Made by `cargo run --example mls_tables -- FOLDER` on one thread; times are the fastest of {RUNS} runs, of filling alone. The paper's are from a Pentium 4 with 2.0 GHz.\n"
    );
    println!("## Table 1: statistics and running times\n");
    println!(
        "The paper's models are not at hand, but for the bunny; each row has one of ours beside it that is as near as we have. `mls` holes are those that the method filled, of all.\n"
    );
    println!(
        "| paper | vertices | after | new | seconds | ours | vertices | after | new | `mls` holes | seconds | paper's over ours |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for row in &TABLE_1 {
        let (mesh, selection) = read(folder, row.model)?;
        let (report, after, seconds) = fill(&mesh, &selection, &options(&[])?)?;
        let by_mls = report
            .holes
            .iter()
            .filter(|h| h.method == Some(Method::Mls))
            .count();
        let before = mesh.positions().len();
        println!(
            "| {} | {} | {} | {} | {} | `{}` | {before} | {} | {} | {by_mls} of {} | {seconds:.4} | {:.0} |",
            row.paper,
            row.vertices_before,
            row.vertices_after,
            row.vertices_after - row.vertices_before,
            row.seconds,
            row.model,
            after.positions().len(),
            after.positions().len() - before,
            report.count(HoleStatus::Filled),
            row.seconds / seconds,
        );
    }
    rows_by_size()?;
    caps(folder)?;
    scaling()?;
    Ok(())
}

/// Tables 3 and 4: two caps of a sphere.
fn caps(folder: &Path) -> Result<(), Box<dyn Error>> {
    println!("\n## Tables 3 and 4: caps of a sphere\n");
    println!(
        "A sphere of radius 5 without a cap of half-angle 30 and 60 degrees; 180 points of the vicinity each (Table 3). The error is the mean distance of the new vertices from the sphere, over its radius. The plane makes the paper's \"egg\" of the larger cap; the curved domain does not.\n"
    );
    println!(
        "| model | vertices | triangles | after, paper | after, ours | domain | mean error | seconds |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | --- | ---: | ---: |");
    for (model, paper) in [("mls_cap30", "3542 / 7080"), ("mls_cap60", "3672 / 7098")] {
        let (mesh, selection) = read(folder, model)?;
        for domain in ["plane", "curved"] {
            let (_, after, seconds) =
                fill(&mesh, &selection, &options(&[("mls.domain", domain)])?)?;
            let new = &after.positions()[mesh.positions().len()..];
            let error =
                |p: &[f64; 3]| (p.iter().map(|x| x * x).sum::<f64>().sqrt() / 5.0 - 1.0).abs();
            let mean = new.iter().map(error).sum::<f64>() / new.len().max(1) as f64;
            println!(
                "| `{model}` | {} | {} | {paper} | {} / {} | {domain} | {mean:.1e} | {seconds:.4} |",
                mesh.positions().len(),
                mesh.triangles().len(),
                after.positions().len(),
                after.triangles().len(),
            );
        }
    }
    Ok(())
}

/// Holes of the sizes in the paper's Table 1, each as one cap of a sphere.
fn rows_by_size() -> Result<(), Box<dyn Error>> {
    println!("\n## Table 1 by size\n");
    println!(
        "The cost depends on the points of the vicinity m and the samples k. One hole each with at least the m and the k of the paper's row, in a sphere:\n"
    );
    println!("| paper | m | k | seconds | ours m | k | seconds | paper's over ours |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for row in &TABLE_1 {
        let samples = row.vertices_after - row.vertices_before;
        // So that the vicinity ends well before the equator, where the plane would see it fold.
        let least = 6 * ((8.0 * row.vicinity as f64).sqrt() / 6.0).ceil() as usize;
        let caps = [10, 15, 20, 30].map(|degrees| (least, degrees));
        let finer = (1..).map(|i| (least + 12 * i, 30));
        for (meridians, degrees) in caps.into_iter().chain(finer) {
            let cap = Cap::new(meridians, degrees);
            let beta = cap.beta(row.vicinity.div_ceil(meridians));
            let (m, k, seconds) = cap.measure(beta)?;
            if m >= row.vicinity && k >= samples {
                println!(
                    "| {} | {} | {samples} | {} | {m} | {k} | {seconds:.4} | {:.0} |",
                    row.paper,
                    row.vicinity,
                    row.seconds,
                    row.seconds / seconds
                );
                break;
            }
        }
    }
    Ok(())
}

/// The time over m and k.
fn scaling() -> Result<(), Box<dyn Error>> {
    println!("\n## Cost over m and k\n");
    println!(
        "A cap of 30 degrees of finer and finer spheres, with a narrow and a wide vicinity. The time over m k tends to a constant.\n"
    );
    println!("| m | k | seconds | nanoseconds / (m k) | |");
    println!("| ---: | ---: | ---: | ---: | --- |");
    for rows in [3, 6] {
        for meridians in [30, 60, 120, 240] {
            let cap = Cap::new(meridians, 30);
            let (m, k, seconds) = cap.measure(cap.beta(rows))?;
            let per_product = seconds / (m * k) as f64 * 1e9;
            // A bar of one mark for each factor of the square root of ten from a tenth of a millisecond on.
            let marks = (2.0 * (seconds * 1e4).log10()).round().max(0.0) as usize;
            println!(
                "| {m} | {k} | {seconds:.4} | {per_product:.0} | {} |",
                "#".repeat(marks)
            );
        }
    }
    Ok(())
}

/// A sphere of meridians and parallels as far apart, without a cap round its pole.
struct Cap {
    meridians: usize,
    mesh: TriMesh,
}

impl Cap {
    fn new(meridians: usize, degrees: usize) -> Self {
        let rows = meridians / 2;
        let first = rows * degrees / 180;
        let at = |row: usize, i: usize| {
            let (theta, phi) = (
                TAU / 2.0 * row as f64 / rows as f64,
                TAU * i as f64 / meridians as f64,
            );
            [
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            ]
        };
        let parallels = first..rows;
        let mut positions: Vec<[f64; 3]> = parallels
            .clone()
            .flat_map(|row| (0..meridians).map(move |i| at(row, i)))
            .collect();
        positions.push([0.0, 0.0, -1.0]);
        let mut triangles = Vec::new();
        for row in parallels {
            let v = |row: usize, i: usize| match row == rows {
                true => ((rows - first) * meridians) as u32,
                false => ((row - first) * meridians + i % meridians) as u32,
            };
            for i in 0..meridians {
                triangles.push([v(row, i), v(row + 1, i), v(row, i + 1)]);
                if row + 1 < rows {
                    triangles.push([v(row, i + 1), v(row + 1, i), v(row + 1, i + 1)]);
                }
            }
        }
        let mesh = TriMesh::new(positions, triangles).expect("a sphere is a mesh");
        Self { meridians, mesh }
    }

    /// The width of a vicinity of so many parallels, the rim's among them, in sampling steps.
    fn beta(&self, parallels: usize) -> f64 {
        let p = |v: u32| self.mesh.positions()[v as usize];
        let rim = self.meridians as u32;
        let touching = self
            .mesh
            .triangles()
            .iter()
            .filter(|t| t.iter().any(|&v| v < rim));
        let area: f64 = touching.map(|t| area(t.map(p))).sum();
        let step = (area / (3.0 * f64::from(rim))).sqrt();
        let apart = distance(p(0), p(rim));
        (parallels as f64 - 0.5) * apart / step
    }

    /// Points of the vicinity, samples and seconds.
    fn measure(&self, beta: f64) -> Result<(usize, usize, f64), Box<dyn Error>> {
        let step_over = self.beta(1) * 2.0; // one parallel in steps
        let rows = (beta / step_over).ceil() as usize;
        let options = options(&[("mls.beta", &beta.to_string()), ("mls.domain", "plane")])?;
        let (report, after, seconds) = fill(&self.mesh, &Selection::default(), &options)?;
        if report.holes.iter().any(|h| h.method != Some(Method::Mls)) {
            return Err("a cap was not filled by mls".into());
        }
        let samples = after.positions().len() - self.mesh.positions().len();
        Ok((rows * self.meridians, samples, seconds))
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3)
        .map(|k| (a[k] - b[k]) * (a[k] - b[k]))
        .sum::<f64>()
        .sqrt()
}

fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let (x, y, z) = (distance(a, b), distance(b, c), distance(c, a));
    let s = (x + y + z) / 2.0;
    (s * (s - x) * (s - y) * (s - z)).max(0.0).sqrt()
}

fn options(parameters: &[(&str, &str)]) -> Result<FillOptions, holefill::Error> {
    let mut options = FillOptions::default();
    options.method = Method::Mls;
    options.threads = 1;
    for (name, value) in parameters {
        options.set(name, value)?;
    }
    Ok(options)
}

fn read(folder: &Path, model: &str) -> Result<(TriMesh, Selection), Box<dyn Error>> {
    let data = io::read(folder.join(model).join("input.ply"))?;
    let mesh = TriMesh::with_attributes(
        data.positions,
        data.triangles,
        data.vertex_attributes,
        data.face_attributes,
    )?;
    let text = std::fs::read_to_string(folder.join(model).join("meta.json"))?;
    let meta: serde_json::Value = serde_json::from_str(&text)?;
    let vertex = |v: &serde_json::Value| v.as_u64().and_then(|v| u32::try_from(v).ok());
    let keep = meta["keep_loops"].as_array().into_iter().flatten();
    let selection = Selection {
        keep: keep
            .filter_map(|l| Some([vertex(&l["edge"][0])?, vertex(&l["edge"][1])?]))
            .collect(),
        ..Selection::default()
    };
    Ok((mesh, selection))
}

/// The report, the filled mesh and the least seconds of filling.
fn fill(
    mesh: &TriMesh,
    selection: &Selection,
    options: &FillOptions,
) -> Result<(FillReport, TriMesh, f64), holefill::Error> {
    let boundary = BoundaryLoops::find(mesh);
    let run = || -> Result<(FillReport, TriMesh), holefill::Error> {
        let mut filled = mesh.clone();
        let report = fill_holes(&mut filled, &boundary, selection, options, None)?;
        Ok((report, filled))
    };
    let (report, filled) = run()?;
    let mut least = report.fill_seconds;
    for _ in 1..RUNS {
        least = least.min(run()?.0.fill_seconds);
    }
    Ok((report, filled, least))
}
