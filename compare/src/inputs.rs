//! The large inputs: deterministic meshes with holes of a known size.

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use serde_json::json;

use crate::Result;
use crate::ply::{self, Mesh};

/// A mesh, the loop that stays open, and the other holes.
pub(crate) struct Input {
    pub(crate) name: &'static str,
    pub(crate) mesh: Mesh,
    /// A directed boundary edge (as in its face) of the loop to keep.
    pub(crate) keep: Option<[u32; 2]>,
    pub(crate) holes: usize,
    pub(crate) hole_edges: usize,
}

/// Rows of triangles around a wide rim: enough for the stencil of second-order fairing.
const RING_ROWS: usize = 4;
/// Rows of whole cells around a slit, for the same reason.
const SLIT_MARGIN: usize = 4;

/// Makes every input below `dir`.
pub(crate) fn write_all(dir: &Path) -> Result<()> {
    write(dir, many_holes("many_holes_1m", 780, 1000))?;
    write(dir, slit("slit_10k", 10_000))?;
    write(dir, slit("slit_100k", 100_000))?;
    write(dir, rim("rim_400", 400))?;
    write(dir, rim("rim_1000", 1000))?;
    write(dir, rim("rim_3000", 3000))?;
    write(dir, sheet("hole_in_40k", 141))?;
    write(dir, sheet("hole_in_4m", 1414))
}

fn write(dir: &Path, input: Input) -> Result<()> {
    let folder = dir.join(input.name);
    fs::create_dir_all(&folder)?;
    ply::write(&folder.join("input.ply"), &input.mesh)?;
    let keep_loops: Vec<_> = input
        .keep
        .iter()
        .map(|edge| json!({ "edge": edge }))
        .collect();
    let meta = json!({
        "name": input.name,
        "n_triangles": input.mesh.triangles.len(),
        "holes_to_fill": input.holes,
        "hole_edges": input.hole_edges,
        "keep_loops": keep_loops,
    });
    fs::write(folder.join("meta.json"), format!("{meta:#}\n"))?;
    println!("{}: {} triangles", input.name, input.mesh.triangles.len());
    Ok(())
}

/// The mesh without unused vertices. The others keep their order.
fn compact(points: Vec<[f64; 3]>, mut triangles: Vec<[u32; 3]>) -> Mesh {
    let mut index = vec![u32::MAX; points.len()];
    for &v in triangles.iter().flatten() {
        index[v as usize] = 0;
    }
    let mut used = Vec::new();
    for (point, slot) in points.into_iter().zip(&mut index) {
        if *slot == 0 {
            *slot = used.len() as u32;
            used.push(point);
        }
    }
    for v in triangles.iter_mut().flatten() {
        *v = index[*v as usize];
    }
    Mesh {
        points: used,
        triangles,
    }
}

/// The two triangles of the cell with corners (i, j) and (i + 1, j + 1), counter-clockwise, split
/// along the diagonal between these, so that the grid is a lattice of triangles.
fn cell(i: usize, j: usize) -> [[(usize, usize); 3]; 2] {
    let (a, b, c, d) = ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1));
    [[a, b, d], [a, d, c]]
}

/// Steps between two points of that lattice.
fn lattice_distance(a: (usize, usize), b: (usize, usize)) -> usize {
    let (di, dj) = (a.0 as i64 - b.0 as i64, a.1 as i64 - b.1 as i64);
    di.abs().max(dj.abs()).max((di - dj).abs()) as usize
}

/// Whether a triangle of the lattice lies in the hexagon of that many steps, whose rim has six
/// times as many edges.
fn in_hexagon(corners: &[(usize, usize); 3], center: (usize, usize), steps: usize) -> bool {
    corners
        .iter()
        .all(|&corner| lattice_distance(corner, center) <= steps)
}

/// A closed bumpy sphere of `2 n^2` triangles without `holes` hexagons of 36 edges. It is a square grid,
/// folded to an octahedron, with opposite halves of each side joined.
fn many_holes(name: &'static str, n: usize, holes: usize) -> Input {
    const STEPS: usize = 6;
    let side = (holes as f64).sqrt().ceil() as usize;
    let spacing = n as f64 / side as f64;
    let center_of = |k: usize| (((k as f64) + 0.5) * spacing) as usize;
    let vertex = |(i, j): (usize, usize)| {
        let (i, j) = if j == 0 || j == n {
            (i.min(n - i), j)
        } else {
            (i, j)
        };
        let (i, j) = if i == 0 || i == n {
            (i, j.min(n - j))
        } else {
            (i, j)
        };
        let (i, j) = if (i == 0 || i == n) && (j == 0 || j == n) {
            (0, 0)
        } else {
            (i, j)
        };
        (j * (n + 1) + i) as u32
    };
    let grid = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
    let points = grid
        .map(|(i, j)| bumpy_sphere(i as f64 / n as f64, j as f64 / n as f64))
        .collect();
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let in_hole = |corners: &[(usize, usize); 3]| {
        let (i, j) = corners[0];
        let (column, row) = ((i as f64 / spacing) as usize, (j as f64 / spacing) as usize);
        let index = row.min(side - 1) * side + column.min(side - 1);
        let center = (center_of(index % side), center_of(index / side));
        index < holes && in_hexagon(corners, center, STEPS)
    };
    let triangles = cells
        .flat_map(|(i, j)| cell(i, j))
        .filter(|corners| !in_hole(corners))
        .map(|corners| corners.map(vertex))
        .collect();
    Input {
        name,
        mesh: compact(points, triangles),
        keep: None,
        holes,
        hole_edges: 6 * STEPS,
    }
}

/// The octahedral map of the unit square, with bumps.
fn bumpy_sphere(s: f64, t: f64) -> [f64; 3] {
    let (u, v) = (2.0 * s - 1.0, 2.0 * t - 1.0);
    let z = 1.0 - u.abs() - v.abs();
    let (x, y) = if z >= 0.0 {
        (u, v)
    } else {
        ((1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v))
    };
    let norm = (x * x + y * y + z * z).sqrt();
    let (x, y, z) = (x / norm, y / norm, z / norm);
    let radius = 1.0 + 0.03 * ((7.0 * x).sin() + (9.0 * y + 1.0).sin() + (8.0 * z + 2.0).sin());
    [radius * x, radius * y, radius * z]
}

/// A wavy sheet with a wavy slit two cells wide whose rim has `edges` edges.
fn slit(name: &'static str, edges: usize) -> Input {
    const WIDTH: usize = 2;
    let length = (edges - 2 * WIDTH) / 2;
    let (columns, rows) = (length + 2 * SLIT_MARGIN, WIDTH + 2 * SLIT_MARGIN);
    let vertex = |(i, j): (usize, usize)| (j * (columns + 1) + i) as u32;
    let point = |i: usize, j: usize| {
        let (x, y) = (i as f64, j as f64);
        let across = y + 15.0 * (TAU * x / 200.0).sin();
        [
            x,
            across,
            4.0 * (TAU * x / 90.0).sin() + 0.8 * (TAU * (across + 0.3 * x) / 31.0).cos(),
        ]
    };
    let points = (0..=rows)
        .flat_map(|j| (0..=columns).map(move |i| point(i, j)))
        .collect();
    let in_slit = |i: usize, j: usize| {
        (SLIT_MARGIN..SLIT_MARGIN + length).contains(&i)
            && (SLIT_MARGIN..SLIT_MARGIN + WIDTH).contains(&j)
    };
    let triangles = (0..rows)
        .flat_map(|j| (0..columns).map(move |i| (i, j)))
        .filter(|&(i, j)| !in_slit(i, j))
        .flat_map(|(i, j)| cell(i, j))
        .map(|corners| corners.map(vertex))
        .collect();
    let mesh = compact(points, triangles);
    Input {
        name,
        mesh,
        keep: Some([0, 1]),
        holes: 1,
        hole_edges: 2 * (length + WIDTH),
    }
}

/// A band of triangles on the unit sphere around a cap with five lobes whose rim has `edges` edges.
fn rim(name: &'static str, edges: usize) -> Input {
    let edge = TAU * 1f64.sin() / edges as f64;
    let row_height = edge * 3f64.sqrt() / 2.0;
    let point = |column: usize, row: usize| {
        let phi = TAU * (column as f64 + row as f64 / 2.0) / edges as f64;
        let theta = 1.0 + 0.15 * (5.0 * phi).cos() + row as f64 * row_height;
        [
            theta.sin() * phi.cos(),
            theta.sin() * phi.sin(),
            theta.cos(),
        ]
    };
    let points = (0..=RING_ROWS)
        .flat_map(|r| (0..edges).map(move |c| point(c, r)))
        .collect();
    let vertex = |column: usize, row: usize| (row * edges + column % edges) as u32;
    let triangles = (0..RING_ROWS)
        .flat_map(|r| (0..edges).map(move |c| (c, r)))
        .flat_map(|(c, r)| {
            let (a, b) = (vertex(c, r), vertex(c + 1, r));
            let (below, next) = (vertex(c, r + 1), vertex(c + 1, r + 1));
            [[a, below, b], [b, below, next]]
        })
        .collect();
    let keep = Some([vertex(0, RING_ROWS), vertex(1, RING_ROWS)]);
    Input {
        name,
        mesh: Mesh { points, triangles },
        keep,
        holes: 1,
        hole_edges: edges,
    }
}

/// A wavy sheet of `2 n^2` triangles with a hole of 60 edges in its middle. Positions are relative to
/// the hole, so that its neighborhood has the same bits for every `n`.
fn sheet(name: &'static str, n: usize) -> Input {
    const STEPS: usize = 10;
    let center = (n / 2, n / 2);
    let vertex = |(i, j): (usize, usize)| (j * (n + 1) + i) as u32;
    let point = |i: usize, j: usize| {
        let (x, y) = (i as f64 - center.0 as f64, j as f64 - center.1 as f64);
        [x, y, 2.0 * (TAU * x / 40.0).sin() * (PI * y / 25.0).cos()]
    };
    let points = (0..=n)
        .flat_map(|j| (0..=n).map(move |i| point(i, j)))
        .collect();
    let triangles = (0..n)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .flat_map(|(i, j)| cell(i, j))
        .filter(|corners| !in_hexagon(corners, center, STEPS))
        .map(|corners| corners.map(vertex))
        .collect();
    let mesh = compact(points, triangles);
    Input {
        name,
        mesh,
        keep: Some([0, 1]),
        holes: 1,
        hole_edges: 6 * STEPS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boundary edges as loops of vertices. Fails on a non-manifold mesh.
    fn boundary_loops(mesh: &Mesh) -> Vec<Vec<u32>> {
        let mut edges: Vec<[u32; 2]> = mesh
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        edges.sort_unstable();
        assert!(
            edges.windows(2).all(|pair| pair[0] != pair[1]),
            "an edge used twice the same way"
        );
        let boundary: Vec<[u32; 2]> = edges
            .iter()
            .copied()
            .filter(|[a, b]| edges.binary_search(&[*b, *a]).is_err())
            .collect();
        assert!(
            boundary.windows(2).all(|pair| pair[0][0] != pair[1][0]),
            "a pinched vertex"
        );
        let mut seen = vec![false; boundary.len()];
        let mut loops = Vec::new();
        for start in 0..boundary.len() {
            let (mut at, mut corners) = (start, Vec::new());
            while !seen[at] {
                seen[at] = true;
                corners.push(boundary[at][0]);
                at = boundary.partition_point(|edge| edge[0] < boundary[at][1]);
            }
            if !corners.is_empty() {
                loops.push(corners);
            }
        }
        loops
    }

    /// V - E + F of the closed surface with every loop capped by one face.
    fn euler(mesh: &Mesh, loops: &[Vec<u32>]) -> i64 {
        let rim: usize = loops.iter().map(Vec::len).sum();
        let edges = (3 * mesh.triangles.len() + rim) / 2;
        mesh.points.len() as i64 - edges as i64 + (mesh.triangles.len() + loops.len()) as i64
    }

    fn check(input: &Input) {
        let loops = boundary_loops(&input.mesh);
        let kept = |corners: &Vec<u32>| {
            input.keep.is_some_and(|[a, b]| {
                let at = corners.iter().position(|&v| v == a);
                at.is_some_and(|at| corners[(at + 1) % corners.len()] == b)
            })
        };
        assert_eq!(
            loops.iter().filter(|l| kept(l)).count(),
            usize::from(input.keep.is_some())
        );
        let holes: Vec<usize> = loops.iter().filter(|l| !kept(l)).map(Vec::len).collect();
        assert_eq!(holes, vec![input.hole_edges; input.holes]);
        assert_eq!(euler(&input.mesh, &loops), 2, "a sphere with holes");
        assert!(input.mesh.points.iter().flatten().all(|x| x.is_finite()));
        let mut used = vec![false; input.mesh.points.len()];
        input
            .mesh
            .triangles
            .iter()
            .flatten()
            .for_each(|&v| used[v as usize] = true);
        assert!(used.into_iter().all(|used| used));
    }

    #[test]
    fn a_bumpy_sphere_has_the_holes_asked_for_and_is_closed_elsewhere() {
        for holes in [1, 4, 7, 9] {
            let input = many_holes("small", 60, holes);
            check(&input);
            assert_eq!(input.mesh.triangles.len(), 2 * 60 * 60 - 216 * holes);
        }
    }

    #[test]
    fn a_slit_has_the_rim_asked_for() {
        for edges in [40, 100, 1000] {
            let input = slit("small", edges);
            assert_eq!(input.hole_edges, edges);
            check(&input);
        }
    }

    #[test]
    fn a_rim_lies_on_the_sphere_and_faces_outward() {
        let input = rim("small", 60);
        check(&input);
        for &[a, b, c] in &input.mesh.triangles {
            let [a, b, c] = [a, b, c].map(|v| input.mesh.points[v as usize]);
            assert!((a.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-12);
            let determinant = a[0] * (b[1] * c[2] - b[2] * c[1])
                - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            assert!(determinant > 0.0);
        }
    }

    #[test]
    fn the_same_hole_has_the_same_neighborhood_in_sheets_of_any_size() {
        let (small, large) = (sheet("small", 31), sheet("large", 60));
        check(&small);
        check(&large);
        let near = |input: &Input| -> Vec<[f64; 3]> {
            let inside = |p: &&[f64; 3]| p[0].abs() <= 15.0 && p[1].abs() <= 15.0;
            input.mesh.points.iter().filter(inside).copied().collect()
        };
        assert_eq!(near(&small), near(&large));
    }
}
