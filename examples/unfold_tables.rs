//! Repeats the experiment of A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular
//! meshes by curve unfolding", 2009, Table 1, on our models. Also measures the cost of unfolding. Writes Markdown, with
//! the figures of the paper, and a plot:
//!
//! ```sh
//! cargo run --release --example unfold_tables -- ../shared/data/cases docs/results
//! ```
//!
//! The first argument is the folder of the models, each with `input.ply` and `meta.json`. The second argument is the
//! folder for `unfold.md` and `unfold-growth.svg`.

mod shared;

use holefill::{
    BoundaryLoops, Method, Selection, UnfoldOptions, UnfoldSolver, Unfolding, unfold_curve,
};
use robust::{Coord, orient2d};
use shared::plot::{Line, Scale, plot};
use shared::{Case, Result, command, fill, folders, least_seconds, options, processor_time};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

/// Number of seeds over which figures are averaged; the paper averages over as many runs.
const SEEDS: u64 = 10;

/// Runs of the annealing for each seed. The paper makes up to 100, which take minutes on a rim that is not unfolded.
const ANNEALING_RUNS: usize = 5;

/// The most similar row of the paper for each of our models.
const MODELS: [(&str, &str); 9] = [
    ("bunny_natural", "Bunny"),
    ("armpit", "Armpit"),
    ("human_armpit", "Armpit"),
    ("head_like", "Head 3"),
    ("human_head_large", "Head 1"),
    ("human_head_twisted", "Head 3"),
    ("human_shoulder_wrap", "Head 2"),
    ("seam_twist", "Head 2"),
    ("helix_wrap", "Head 3"),
];

/// Models with more rims of the sizes in the paper's table.
const MORE_MODELS: [&str; 4] = [
    "elephant_fringe",
    "elephant_irregular",
    "skull_patches",
    "colored_bunny",
];

/// The edges of the paper's rims.
const PAPER_EDGES: std::ops::RangeInclusive<usize> = 33..=79;

/// The paper fills this many holes with this many edges together in 6.5 minutes.
const MANY_HOLES: usize = 8;
const MANY_EDGES: usize = 666;

/// The rim of a hole.
struct Rim<'a> {
    case: &'a Case,
    edge: [u32; 2],
    points: Vec<[f64; 3]>,
}

fn main() -> Result<()> {
    let (models, results) = folders()?;
    let mut page = String::from("# Curve unfolding compared with the paper\n\n");
    writeln!(
        page,
        "A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, \"Filling holes in triangular meshes by curve unfolding\", 2009. Made by {}. Seconds are processor time on one thread. Figures of unfolding are means over {SEEDS} seeds; those of the paper are means over 10 runs.\n",
        command("unfold_tables")
    )?;
    let cases: Vec<Case> = MODELS
        .iter()
        .map(|m| m.0)
        .chain(MORE_MODELS)
        .map(|name| Case::read(&models, name))
        .collect::<Result<_>>()?;
    let mut rims = Vec::new();
    for case in &cases {
        rims.extend(rims_of(case)?);
    }
    table_1(&mut page, &cases, &rims)?;
    paper_sizes(&mut page, &rims)?;
    many_holes(&mut page, &rims)?;
    growth(&mut page, &results)?;
    std::fs::write(results.join("unfold.md"), page)?;
    Ok(())
}

/// The rims of a model's holes.
fn rims_of(case: &Case) -> Result<Vec<Rim<'_>>> {
    let boundary = BoundaryLoops::find(&case.mesh);
    let kept = case.selection.reasons_to_keep(&boundary)?;
    let holes = boundary.loops.iter().zip(kept).filter(|(_, k)| k.is_none());
    Ok(holes
        .map(|(rim, _)| Rim {
            case,
            edge: rim.edge(),
            points: rim
                .vertices
                .iter()
                .map(|&v| case.mesh.positions()[v as usize])
                .collect(),
        })
        .collect())
}

/// Results of unfolding a rim with all seeds.
#[derive(Default)]
struct Unfolded {
    /// Sum over the seeds.
    steps: f64,
    each: Vec<f64>,
    failures: usize,
}

/// The figures of all rims of a model, each a mean over the seeds.
#[derive(Default)]
struct Sums {
    steps: f64,
    seconds: f64,
    /// Rims that were not unfolded.
    failures: usize,
}

impl Sums {
    fn steps(&self) -> String {
        match self.failures {
            0 => format!("{:.1}", self.steps),
            _ => "–".to_owned(),
        }
    }
}

fn unfold(points: &[[f64; 3]], solver: UnfoldSolver) -> Result<Unfolded> {
    let mut options = UnfoldOptions::default();
    options.solver = solver;
    if solver == UnfoldSolver::Annealing {
        options.restarts = Some(ANNEALING_RUNS);
    }
    let mut all = Unfolded::default();
    for seed in 0..SEEDS {
        let start = processor_time();
        let found = unfold_curve(points, &options, seed);
        let seconds = (processor_time() - start).as_secs_f64();
        all.each.push(seconds);
        match found {
            Ok(found) if is_simple(&found.polygon) => {
                all.steps += (found.runs.saturating_sub(1) * options.steps + found.steps) as f64;
            }
            Ok(_) => return Err("a polygon is not simple".into()),
            Err(_) => {
                // The other seeds would fail too, after the same time.
                all.failures += 1;
                break;
            }
        }
    }
    Ok(all)
}

/// Whether no two edges of the polygon meet, except in a common vertex. Decided exactly for each pair.
fn is_simple(polygon: &[[f64; 2]]) -> bool {
    let m = polygon.len();
    let at = |i: usize| polygon[i % m];
    let side = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        let [a, b, c] = [a, b, c].map(|[x, y]| Coord { x, y });
        orient2d(a, b, c)
    };
    let is_between = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (0..2).all(|k| a[k].min(b[k]) <= c[k] && c[k] <= a[k].max(b[k]))
    };
    (0..m).all(|i| {
        (i + 1..m).all(|k| {
            let (a, b, c, d) = (at(i), at(i + 1), at(k), at(k + 1));
            let sides = [
                (side(a, b, c), a, b, c),
                (side(a, b, d), a, b, d),
                (side(c, d, a), c, d, a),
                (side(c, d, b), c, d, b),
            ];
            let is_neighbor = k == i + 1 || (i == 0 && k == m - 1);
            if is_neighbor {
                // The far ends must not lie on the other edge.
                return !sides
                    .iter()
                    .any(|&(s, p, q, r)| s == 0.0 && r != p && r != q && is_between(p, q, r));
            }
            let touches = sides
                .iter()
                .any(|&(s, p, q, r)| s == 0.0 && is_between(p, q, r));
            let crosses = (sides[0].0 > 0.0) != (sides[1].0 > 0.0)
                && (sides[2].0 > 0.0) != (sides[3].0 > 0.0);
            !touches && !crosses
        })
    })
}

const METHODS: [Method; 2] = [Method::UnfoldArea, Method::UnfoldFairing];

fn table_1(page: &mut String, cases: &[Case], rims: &[Rim<'_>]) -> Result<()> {
    page.push_str("## Table 1\n\nThe paper: n vertices of the model, m of the rim, d accepted steps.\n\n| model | n | m | d | unfolding, seconds | embedding, `E_AREA` | `E_DF` |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n| Bunny | 1494 | 79 | 1.0 | 2 | 1 | – |\n| Armpit | 9951 | 35 | 4.8 | 3 | < 1 | < 1 |\n| Head 1 | 1177 | 33 | 2.0 | 2 | < 1 | < 1 |\n| Head 2 | 1189 | 53 | 2.9 | 5 | < 1 | < 1 |\n| Head 3 | 1157 | 63 | 16.4 | 2 | – | 5.3 |\n\n");
    page.push_str("Ours, on the most similar models. If a model has more than one hole, its figures are sums. `descent` is the default solver; d = 0 means that the projection of the rim was already simple. `annealing` is the solver of the paper. It projects only after a whole run, so its d counts all accepted steps of that run. Here it gets five runs for each seed; if they do not unfold a rim, no other seed is tried. Embedding is the whole fill with its checks, without the unfolding. Exact predicates checked every polygon again, edge by edge.\n\n");
    page.push_str("| model | nearest | n | m | d, `descent` | `annealing` | rims not unfolded, `descent` | `annealing` | unfolding, seconds, `descent` | `annealing` | embedding, `unfold-area` | `unfold-fairing` |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    let mut filled_rows = String::new();
    for (case, (_, paper)) in cases.iter().zip(MODELS) {
        let own: Vec<&Rim<'_>> = rims.iter().filter(|r| r.case.name == case.name).collect();
        // Of all rims, means over the seeds.
        let mut sums = [Sums::default(), Sums::default()];
        for (sum, solver) in sums
            .iter_mut()
            .zip([UnfoldSolver::Descent, UnfoldSolver::Annealing])
        {
            for rim in &own {
                let found = unfold(&rim.points, solver)?;
                let runs = found.each.len() as f64;
                sum.steps += found.steps / runs;
                sum.seconds += found.each.iter().sum::<f64>() / runs;
                sum.failures += found.failures;
            }
        }
        let mut embedding = [0.0; 2];
        for (i, method) in METHODS.into_iter().enumerate() {
            let filled = case.time(&options(method, &[])?)?;
            embedding[i] = (filled.seconds - sums[0].seconds).max(0.0);
            writeln!(
                filled_rows,
                "| `{}` | `{method}` | {} of {} | {} | {} | {:.4} |",
                case.name,
                filled.by(method),
                case.holes,
                filled.points,
                filled.intersections(),
                filled.seconds
            )?;
        }
        let [descent, annealing] = &sums;
        writeln!(
            page,
            "| `{}` | {paper} | {} | {} | {} | {} | {} | {} | {:.4} | {:.4} | {:.4} | {:.4} |",
            case.name,
            case.mesh.positions().len(),
            own.iter().map(|r| r.points.len()).sum::<usize>(),
            descent.steps(),
            annealing.steps(),
            descent.failures,
            annealing.failures,
            descent.seconds,
            annealing.seconds,
            embedding[0],
            embedding[1]
        )?;
    }
    writeln!(
        page,
        "\n## The patches\n\nHoles: those that the method itself filled, of all. Intersections: pairs of triangles of the patch that intersect each other or the mesh.\n\n| model | method | holes | new vertices | intersections | seconds |\n| --- | --- | ---: | ---: | ---: | ---: |\n{filled_rows}"
    )?;
    Ok(())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let m = values.len();
    (values[(m - 1) / 2] + values[m / 2]) / 2.0
}

/// Seconds of filling one hole with each seed.
fn fills(rim: &Rim<'_>, method: Method) -> Result<Vec<f64>> {
    let selection = Selection {
        only: vec![rim.edge],
        ..Selection::default()
    };
    (0..SEEDS)
        .map(|seed| {
            let mut options = options(method, &[])?;
            options.seed = seed;
            Ok(fill(&rim.case.mesh, &selection, &options, 1)?.seconds)
        })
        .collect()
}

fn paper_sizes(page: &mut String, rims: &[Rim<'_>]) -> Result<()> {
    page.push_str("## Rims as large as the paper's\n\nAll rims of 33 to 79 edges in these and four more models. Median over the seeds, in milliseconds, of the unfolding and of the whole fill. In the paper, the unfolding alone takes 2 to 5 seconds.\n\n| model | edges | unfolding | `unfold-area` | `unfold-fairing` |\n| --- | ---: | ---: | ---: | ---: |\n");
    let mut slowest = 0.0_f64;
    for rim in rims
        .iter()
        .filter(|r| PAPER_EDGES.contains(&r.points.len()))
    {
        let unfolding = 1e3 * median(unfold(&rim.points, UnfoldSolver::Descent)?.each);
        let mut medians = [0.0; 2];
        for (median_of, method) in medians.iter_mut().zip(METHODS) {
            *median_of = 1e3 * median(fills(rim, method)?);
            slowest = slowest.max(*median_of);
        }
        writeln!(
            page,
            "| `{}` | {} | {unfolding:.3} | {:.2} | {:.2} |",
            rim.case.name,
            rim.points.len(),
            medians[0],
            medians[1]
        )?;
    }
    writeln!(page, "\nThe slowest median is {slowest:.1} milliseconds.\n")?;
    Ok(())
}

/// Indices of `count` rims with `edges` edges in total; the first such choice.
fn choose(rims: &[Rim<'_>], count: usize, edges: usize) -> Option<Vec<usize>> {
    // chosen[k][e]: k rims with e edges in total.
    let mut chosen: Vec<Vec<Option<Vec<usize>>>> = vec![vec![None; edges + 1]; count + 1];
    chosen[0][0] = Some(Vec::new());
    for (i, rim) in rims.iter().enumerate() {
        let m = rim.points.len();
        for k in (0..count).rev() {
            for e in 0..(edges + 1).saturating_sub(m) {
                if chosen[k + 1][e + m].is_none()
                    && let Some(before) = &chosen[k][e]
                {
                    let mut with = before.clone();
                    with.push(i);
                    chosen[k + 1][e + m] = Some(with);
                }
            }
        }
    }
    chosen[count][edges].take()
}

fn many_holes(page: &mut String, rims: &[Rim<'_>]) -> Result<()> {
    let chosen = choose(rims, MANY_HOLES, MANY_EDGES).ok_or("no eight rims have 666 edges")?;
    writeln!(
        page,
        "## Eight holes with 666 edges\n\nThe paper fills a model with {MANY_HOLES} holes and {MANY_EDGES} rim edges in 6.5 minutes. The same numbers of holes and edges, from the models above:\n\n| model | edges | `unfold-area`, seconds | `unfold-fairing` |\n| --- | ---: | ---: | ---: |"
    )?;
    let mut sums = [0.0; 2];
    for i in chosen {
        let rim = &rims[i];
        let mut medians = [0.0; 2];
        for ((median_of, sum), method) in medians.iter_mut().zip(&mut sums).zip(METHODS) {
            *median_of = median(fills(rim, method)?);
            *sum += *median_of;
        }
        writeln!(
            page,
            "| `{}` | {} | {:.4} | {:.4} |",
            rim.case.name,
            rim.points.len(),
            medians[0],
            medians[1]
        )?;
    }
    writeln!(
        page,
        "| all | {MANY_EDGES} | {:.4} | {:.4} |\n",
        sums[0], sums[1]
    )?;
    Ok(())
}

/// The rim of a strip that winds 1.4 times round a cylinder. It is not knotted, but every projection crosses itself.
fn winding_strip(m: usize) -> Vec<[f64; 3]> {
    const TURNS: f64 = 1.4;
    const WIDTH: f64 = 0.5;
    let length = TURNS * TAU.hypot(1.0);
    let perimeter = 2.0 * (length + WIDTH);
    let at = |along: f64, up: f64| {
        let angle = TURNS * TAU * along / length;
        [angle.cos(), angle.sin(), angle / TAU + up]
    };
    (0..m)
        .map(|i| {
            let s = perimeter * i as f64 / m as f64;
            if s < length {
                at(s, 0.0)
            } else if s < length + WIDTH {
                at(length, s - length)
            } else if s < 2.0 * length + WIDTH {
                at(2.0 * length + WIDTH - s, WIDTH)
            } else {
                at(0.0, perimeter - s)
            }
        })
        .collect()
}

/// A circle that goes up and down, whose projection is simple.
fn wave(m: usize) -> Vec<[f64; 3]> {
    (0..m)
        .map(|i| {
            let t = TAU * i as f64 / m as f64;
            [t.cos(), t.sin(), 0.4 * (3.0 * t).sin()]
        })
        .collect()
}

fn growth(page: &mut String, results: &Path) -> Result<()> {
    page.push_str("## Growth\n\n![Time of a step over the edges of the rim](unfold-growth.svg)\n\nMicroseconds per step. For `descent`: the rim of a strip that winds 1.4 times round a cylinder. It is unfolded in the given number of steps, all accepted. `annealing` does not unfold this rim, so its figures are for a run of 2000 steps on a circle that goes up and down, over all steps, accepted or not.\n\n| m | `descent`, steps | per step | nanoseconds over m² | `annealing`, accepted | per step | nanoseconds over m² |\n| ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    let mut lines = ["descent", "annealing", "m², through the first of descent"].map(|name| Line {
        name: name.to_owned(),
        points: Vec::new(),
    });
    for m in [50, 100, 200, 400, 700, 1000] {
        let mut annealing = UnfoldOptions::default();
        annealing.solver = UnfoldSolver::Annealing;
        annealing.steps = 2000;
        annealing.restarts = Some(1);
        let runs = [
            (winding_strip(m), UnfoldOptions::default()),
            (wave(m), annealing),
        ];
        write!(page, "| {m} ")?;
        for (line, (points, options)) in lines.iter_mut().zip(&runs) {
            let run = || -> Result<Unfolding> { Ok(unfold_curve(points, options, 0)?) };
            let accepted = run()?.steps;
            let steps = match options.solver {
                UnfoldSolver::Descent => accepted.max(1),
                UnfoldSolver::Annealing => options.steps,
            };
            let micros = 1e6 * least_seconds(run)? / steps as f64;
            line.points.push((m as f64, micros));
            let per_square = 1e3 * micros / (m * m) as f64;
            write!(page, "| {accepted} | {micros:.1} | {per_square:.2} ")?;
        }
        page.push_str("|\n");
    }
    let (first_m, first) = lines[0].points[0];
    lines[2].points = lines[0]
        .points
        .iter()
        .map(|(m, _)| (*m, first * (m / first_m).powi(2)))
        .collect();
    plot(
        &results.join("unfold-growth.svg"),
        "Processor time per step",
        ["edges of the rim", "microseconds"],
        Scale::Logarithmic,
        &lines,
    )
}
