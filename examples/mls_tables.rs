//! Repeats the experiments of J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed from
//! point clouds", 2006, Tables 1, 3 and 4, on our models. Also measures the cost of the method. Writes Markdown, with
//! the figures of the paper, and a plot:
//!
//! ```sh
//! cargo run --release --example mls_tables -- ../shared/data/cases docs/results
//! ```
//!
//! The first argument is the folder of the models. Each has `input.ply` and `meta.json` with the loops that stay open.
//! The second argument is the folder for `mls.md` and `mls-cost.svg`.

mod shared;

use holefill::{
    BoundaryLoops, FillOptions, HoleStatus, Method, PointCloud, PointOptions, Selection, TriMesh,
    mesh_from_points,
};
use rand::RngExt;
use rand_pcg::Pcg64;
use shared::cap::sphere_without_cap;
use shared::plot::{Line, Scale, plot};
use shared::{Case, Filled, RUNS, Result, command, fill, folders, processor_time};
use std::fmt::Write;
use std::path::Path;

/// A row of the paper's Table 1, and our most similar model.
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

fn main() -> Result<()> {
    let (models, results) = folders()?;
    let mut page = String::from("# Moving least squares compared with the paper\n\n");
    writeln!(
        page,
        "J. Wang, M. M. Oliveira, \"Filling holes on locally smooth surfaces reconstructed from point clouds\", 2006. Made by {}. Seconds are processor time of the whole fill with its checks, on one thread, the least of {RUNS} runs. The paper used a Pentium 4 with 2.0 GHz.\n",
        command("mls_tables")
    )?;
    table_1(&mut page, &models)?;
    rows_by_size(&mut page)?;
    caps(&mut page, &models)?;
    from_points(&mut page, &models)?;
    cost(&mut page, &results)?;
    std::fs::write(results.join("mls.md"), page)?;
    Ok(())
}

fn options(parameters: &[(&str, &str)]) -> Result<FillOptions> {
    shared::options(Method::Mls, parameters)
}

fn table_1(page: &mut String, models: &Path) -> Result<()> {
    page.push_str("## Table 1: statistics and running times\n\nOf the paper's models we only have the bunny. Each row compares a model of the paper with our most similar one. `mls` holes: the holes that the method itself filled, of all.\n\n");
    page.push_str("| paper | vertices | after | new | seconds | ours | vertices | after | new | `mls` holes | seconds | paper's over ours |\n");
    page.push_str(
        "| --- | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for row in &TABLE_1 {
        let case = Case::read(models, row.model)?;
        let filled = case.time(&options(&[])?)?;
        writeln!(
            page,
            "| {} | {} | {} | {} | {} | `{}` | {} | {} | {} | {} of {} | {:.4} | {:.0} |",
            row.paper,
            row.vertices_before,
            row.vertices_after,
            row.vertices_after - row.vertices_before,
            row.seconds,
            row.model,
            case.mesh.positions().len(),
            filled.mesh.positions().len(),
            filled.points,
            filled.by(Method::Mls),
            filled.report.count(HoleStatus::Filled),
            filled.seconds,
            row.seconds / filled.seconds,
        )?;
    }
    Ok(())
}

/// Tables 3 and 4: two caps of a sphere.
fn caps(page: &mut String, models: &Path) -> Result<()> {
    page.push_str("\n## Tables 3 and 4: caps of a sphere\n\nA sphere of radius 5 without a cap of half-angle 30 and 60 degrees; 180 points of the vicinity each (Table 3). The error is the mean distance of the new vertices from the sphere, over its radius. On the larger cap, the plane gives the \"egg\" of the paper; the curved domain does not. `auto` is the default.\n\n");
    page.push_str(
        "| model | vertices | triangles | after, paper | after, ours | domain | mean error | seconds |\n",
    );
    page.push_str("| --- | ---: | ---: | ---: | ---: | --- | ---: | ---: |\n");
    for (model, paper) in [("mls_cap30", "3542 / 7080"), ("mls_cap60", "3672 / 7098")] {
        let case = Case::read(models, model)?;
        let before = case.mesh.positions().len();
        for domain in ["plane", "curved", "auto"] {
            let filled = case.time(&options(&[("mls.domain", domain)])?)?;
            let new = &filled.mesh.positions()[before..];
            let error =
                |p: &[f64; 3]| (p.iter().map(|x| x * x).sum::<f64>().sqrt() / 5.0 - 1.0).abs();
            let mean = new.iter().map(error).sum::<f64>() / new.len().max(1) as f64;
            writeln!(
                page,
                "| `{model}` | {before} | {} | {paper} | {} / {} | {domain} | {mean:.1e} | {:.4} |",
                case.mesh.triangles().len(),
                filled.mesh.positions().len(),
                filled.mesh.triangles().len(),
                filled.seconds,
            )?;
        }
    }
    Ok(())
}

/// Holes of the sizes in the paper's Table 1, each as one cap of a sphere.
fn rows_by_size(page: &mut String) -> Result<()> {
    page.push_str("\n## Table 1 by size\n\nThe cost depends on the points of the vicinity m and the samples k. Each row is one hole in a sphere, with at least the m and the k of the paper:\n\n| paper | m | k | seconds | ours m | k | seconds | paper's over ours |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for row in &TABLE_1 {
        let samples = row.vertices_after - row.vertices_before;
        // The vicinity must end well before the equator, where its projection to the plane folds.
        let least = 6 * ((8.0 * row.vicinity as f64).sqrt() / 6.0).ceil() as usize;
        let caps = [10, 15, 20, 30].map(|degrees| (least, degrees));
        let finer = (1..).map(|i| (least + 12 * i, 30));
        for (meridians, degrees) in caps.into_iter().chain(finer) {
            let cap = Cap::new(meridians, degrees);
            let parallels = row.vicinity.div_ceil(meridians);
            let m = parallels * meridians;
            let filled = cap.fill(parallels, RUNS)?;
            if m >= row.vicinity && filled.points >= samples {
                writeln!(
                    page,
                    "| {} | {} | {samples} | {} | {m} | {} | {:.4} | {:.0} |",
                    row.paper,
                    row.vicinity,
                    row.seconds,
                    filled.points,
                    filled.seconds,
                    row.seconds / filled.seconds
                )?;
                break;
            }
        }
    }
    Ok(())
}

/// The time over m, and over k.
fn cost(page: &mut String, results: &Path) -> Result<()> {
    page.push_str("\n## Cost over m and k\n\n![Time over m k](mls-cost.svg)\n\nCaps of one sphere. Over m: one hole of 30 degrees, with a wider and wider vicinity. Over k: wider and wider holes with three parallels of vicinity. Over both: finer and finer spheres. The time over m k tends to a constant. Where m k is small, the triangulation and the checks dominate.\n\n| | m | k | seconds | nanoseconds / (m k) |\n| --- | ---: | ---: | ---: | ---: |\n");
    let over_m = [2, 3, 4, 6, 8, 11, 15].map(|rows| (120, 30, rows));
    let over_k = [9, 12, 15, 21, 30, 39, 45].map(|degrees| (120, degrees, 3));
    let over_both = [24, 36, 60, 96, 144, 192, 240].map(|meridians| (meridians, 30, 3));
    let mut lines = Vec::new();
    for (name, caps) in [
        ("over m", over_m),
        ("over k", over_k),
        ("over both", over_both),
    ] {
        let mut points = Vec::new();
        for (meridians, degrees, rows) in caps {
            let filled = Cap::new(meridians, degrees).fill(rows, RUNS)?;
            let (m, k) = (rows * meridians, filled.points);
            points.push(((m * k) as f64, filled.seconds));
            let per_product = filled.seconds / (m * k) as f64 * 1e9;
            writeln!(
                page,
                "| {name} | {m} | {k} | {:.4} | {per_product:.0} |",
                filled.seconds
            )?;
        }
        lines.push(Line {
            name: name.to_owned(),
            points,
        });
    }
    plot(
        &results.join("mls-cost.svg"),
        "Processor time of a fill",
        ["m k", "seconds"],
        Scale::Logarithmic,
        &lines,
    )
}

/// A sphere without a cap round its pole.
struct Cap {
    meridians: usize,
    mesh: TriMesh,
}

impl Cap {
    fn new(meridians: usize, degrees: usize) -> Self {
        Self {
            meridians,
            mesh: sphere_without_cap(meridians, degrees),
        }
    }

    /// The width of a vicinity of this many parallels, rim included, in sampling steps.
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

    /// Fills the hole over the plane, with a vicinity of this many parallels.
    fn fill(&self, parallels: usize, runs: usize) -> Result<Filled> {
        let beta = self.beta(parallels).to_string();
        let options = options(&[("mls.beta", &beta), ("mls.domain", "plane")])?;
        let filled = fill(&self.mesh, &Selection::default(), &options, runs)?;
        if filled.by(Method::Mls) != 1 {
            return Err("a cap was not filled by mls".into());
        }
        Ok(filled)
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

/// Makes a mesh from the vertices alone, and fills its holes.
fn from_points(page: &mut String, models: &Path) -> Result<()> {
    page.push_str("\n## From points alone\n\nThe vertices of three models, without their triangles. With noise, they are moved along each axis by up to 1 % of the mean edge. Then all holes are filled by `mls`, except the two ends of the cylinder. More in [points](points.md).\n\n| model | noise | points | used | triangles | edges with more than two triangles | boundary loops, edges | the model's | seconds to the mesh | holes left |\n| --- | ---: | ---: | ---: | ---: | ---: | --- | --- | ---: | ---: |\n");
    for (model, open) in [("bunny_natural", 0), ("mls_cap30", 0), ("cylinder_side", 2)] {
        let case = Case::read(models, model)?;
        let original = loop_sizes(&case.mesh);
        for noise in [0.0, 0.01] {
            let moved = moved(&case.mesh, noise);
            let start = processor_time();
            let (mesh, report) =
                mesh_from_points(PointCloud::new(moved), &PointOptions::default(), None)?;
            let seconds = (processor_time() - start).as_secs_f64();
            let selection = Selection {
                keep_largest: open,
                ..Selection::default()
            };
            let filled = fill(&mesh, &selection, &options(&[])?, 1)?;
            let left = filled.report.count(HoleStatus::Failed);
            writeln!(
                page,
                "| `{model}` | {} % | {} | {:.2} % | {} | {} | {} | {original} | {seconds:.2} | {left} |",
                100.0 * noise,
                report.points,
                100.0 * report.used as f64 / report.points as f64,
                report.triangles,
                crowded_edges(&mesh),
                loop_sizes(&mesh),
            )?;
        }
    }
    Ok(())
}

/// Each coordinate moved at random by up to a share of the mean edge.
fn moved(mesh: &TriMesh, share: f64) -> Vec<[f64; 3]> {
    let positions = mesh.positions();
    let edges = || {
        let triangles = mesh.triangles().iter();
        triangles.flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
    };
    let length = |[a, b]: [u32; 2]| distance(positions[a as usize], positions[b as usize]);
    let mean = edges().map(length).sum::<f64>() / (3 * mesh.triangles().len()) as f64;
    let mut random = Pcg64::new(0, 0);
    let mut by = || share * mean * (2.0 * random.random::<f64>() - 1.0);
    let moved = positions.iter().map(|p| p.map(|x| x + by()));
    moved.collect()
}

/// Edges that more than two triangles share.
fn crowded_edges(mesh: &TriMesh) -> usize {
    let triangles = mesh.triangles().iter();
    let mut edges: Vec<[u32; 2]> = triangles
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    edges.sort_unstable();
    edges
        .chunk_by(|a, b| a == b)
        .filter(|c| c.len() > 2)
        .count()
}

/// The numbers of edges of the boundary loops, the largest first.
fn loop_sizes(mesh: &TriMesh) -> String {
    let loops = BoundaryLoops::find(mesh).loops;
    let mut sizes: Vec<usize> = loops.iter().map(|l| l.edge_count()).collect();
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    let sizes: Vec<String> = sizes.iter().map(usize::to_string).collect();
    sizes.join(", ")
}
