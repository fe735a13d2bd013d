//! Two-way RMS distance between a patch and the surface that was removed.
//!
//! Both surfaces are sampled evenly by area. A bounding volume hierarchy finds the nearest point of the
//! other surface for each sample. The figure is the root of the mean of both squared distances, over
//! the mean bounding box diagonal of the removed pieces. This code is independent of the library's own
//! measure, so that the judge shares no code with what it judges.

use crate::ply::Mesh;

type Point = [f64; 3];

const MIN_SAMPLES: usize = 30_000;
const MAX_SAMPLES: usize = 80_000;
const SAMPLES_PER_TRIANGLE: usize = 6;
/// Triangles in a leaf of the hierarchy.
const LEAF: usize = 4;

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a + s u + t v`
fn along(a: Point, s: f64, u: Point, t: f64, v: Point) -> Point {
    [0, 1, 2].map(|k| a[k] + s * u[k] + t * v[k])
}

fn area(corners: &[Point; 3]) -> f64 {
    let (u, v) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]));
    let cross = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    0.5 * dot(cross, cross).sqrt()
}

fn segment_distance_sq(p: Point, a: Point, b: Point) -> f64 {
    let (ab, ap) = (sub(b, a), sub(p, a));
    let length_sq = dot(ab, ab);
    let t = if length_sq > 0.0 {
        (dot(ap, ab) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let d = sub(ap, [t * ab[0], t * ab[1], t * ab[2]]);
    dot(d, d)
}

/// Squared distance of a point to a triangle: to its plane if the perpendicular foot is inside, and
/// otherwise to the nearest side. For triangles without area, only the sides count.
fn triangle_distance_sq(p: Point, corners: &[Point; 3]) -> f64 {
    let [a, b, c] = *corners;
    let (u, v, w) = (sub(b, a), sub(c, a), sub(p, a));
    let (uu, uv, vv, wu, wv) = (dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v));
    let determinant = uu * vv - uv * uv;
    if determinant > 0.0 {
        let s = (vv * wu - uv * wv) / determinant;
        let t = (uu * wv - uv * wu) / determinant;
        if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
            let d = sub(p, along(a, s, u, t, v));
            return dot(d, d);
        }
    }
    let sides = [(a, b), (b, c), (c, a)];
    sides
        .into_iter()
        .map(|(a, b)| segment_distance_sq(p, a, b))
        .fold(f64::INFINITY, f64::min)
}

#[derive(Clone, Copy)]
struct Aabb {
    low: Point,
    high: Point,
}

impl Aabb {
    const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    fn add(&mut self, p: Point) {
        self.low = [0, 1, 2].map(|k| self.low[k].min(p[k]));
        self.high = [0, 1, 2].map(|k| self.high[k].max(p[k]));
    }

    fn diagonal(&self) -> f64 {
        let d = sub(self.high, self.low);
        dot(d, d).sqrt()
    }

    fn distance_sq(&self, p: Point) -> f64 {
        let d = [0, 1, 2].map(|k| (self.low[k] - p[k]).max(p[k] - self.high[k]).max(0.0));
        dot(d, d)
    }
}

struct Node {
    bounds: Aabb,
    first: usize,
    count: usize,
    /// Index of the second child; the first follows its parent. None in a leaf.
    second: Option<usize>,
}

/// A bounding volume hierarchy over triangles, split at the median of the longest axis.
struct Tree {
    nodes: Vec<Node>,
    triangles: Vec<[Point; 3]>,
}

impl Tree {
    fn new(mut triangles: Vec<[Point; 3]>) -> Self {
        let mut nodes = Vec::new();
        let count = triangles.len();
        Self::split(&mut nodes, &mut triangles, 0, count);
        Self { nodes, triangles }
    }

    fn split(nodes: &mut Vec<Node>, triangles: &mut [[Point; 3]], first: usize, count: usize) {
        let range = &mut triangles[first..first + count];
        let mut bounds = Aabb::EMPTY;
        range.iter().flatten().for_each(|&p| bounds.add(p));
        let at = nodes.len();
        nodes.push(Node {
            bounds,
            first,
            count,
            second: None,
        });
        if count <= LEAF {
            return;
        }
        let extent = sub(bounds.high, bounds.low);
        let axis = if extent[0] >= extent[1].max(extent[2]) {
            0
        } else if extent[1] >= extent[2] {
            1
        } else {
            2
        };
        let key = |t: &[Point; 3]| t[0][axis] + t[1][axis] + t[2][axis];
        let half = count / 2;
        range.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)));
        Self::split(nodes, triangles, first, half);
        nodes[at].second = Some(nodes.len());
        Self::split(nodes, triangles, first + half, count - half);
    }

    fn distance_sq(&self, p: Point) -> f64 {
        let mut best = f64::INFINITY;
        let mut stack = vec![0];
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at];
            if node.bounds.distance_sq(p) >= best {
                continue;
            }
            let Some(second) = node.second else {
                for corners in &self.triangles[node.first..node.first + node.count] {
                    best = best.min(triangle_distance_sq(p, corners));
                }
                continue;
            };
            let first = at + 1;
            let nearer = |k: usize| self.nodes[k].bounds.distance_sq(p);
            let pair = if nearer(first) <= nearer(second) {
                [second, first]
            } else {
                [first, second]
            };
            stack.extend(pair);
        }
        best
    }
}

fn corners(mesh: &Mesh) -> Vec<[Point; 3]> {
    mesh.triangles
        .iter()
        .map(|t| t.map(|v| mesh.points[v as usize]))
        .collect()
}

/// `n` points, evenly spread by area: one in each of `n` equal shares, its place in the triangle
/// by a Kronecker sequence.
fn samples(triangles: &[[Point; 3]], n: usize) -> Vec<Point> {
    // Powers of the reciprocal of the plastic number: the sequence of lowest known discrepancy.
    const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
    let total: f64 = triangles.iter().map(area).sum();
    let mut out = Vec::with_capacity(n);
    let mut passed = 0.0;
    for triangle in triangles {
        passed += area(triangle);
        let [a, b, c] = *triangle;
        while out.len() < n && (out.len() as f64 + 0.5) / n as f64 * total <= passed {
            let [mut s, mut t] = STEPS.map(|step| (0.5 + step * out.len() as f64).fract());
            if s + t > 1.0 {
                (s, t) = (1.0 - s, 1.0 - t);
            }
            out.push(along(a, s, sub(b, a), t, sub(c, a)));
        }
    }
    out
}

fn mean_sq(from: &[[Point; 3]], to: &Tree, n: usize) -> Option<f64> {
    let points = samples(from, n);
    let sum: f64 = points.iter().map(|&p| to.distance_sq(p)).sum();
    (!points.is_empty()).then(|| sum / points.len() as f64)
}

fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

/// Mean bounding box diagonal of the pieces. Triangles with a common edge belong to one piece.
fn mean_piece_diagonal(mesh: &Mesh) -> f64 {
    let mut edges: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (face, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        edges.extend([[a, b], [b, c], [c, a]].map(|[u, v]| ([u.min(v), u.max(v)], face as u32)));
    }
    edges.sort_unstable();
    let mut parent: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    for pair in edges.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let (a, b) = (root(&mut parent, pair[0].1), root(&mut parent, pair[1].1));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut bounds = vec![Aabb::EMPTY; mesh.triangles.len()];
    for (face, triangle) in corners(mesh).into_iter().enumerate() {
        let piece = root(&mut parent, face as u32) as usize;
        triangle.into_iter().for_each(|p| bounds[piece].add(p));
    }
    let diagonals: Vec<f64> = bounds
        .iter()
        .filter(|b| b.low[0] <= b.high[0])
        .map(Aabb::diagonal)
        .collect();
    diagonals.iter().sum::<f64>() / diagonals.len() as f64
}

/// The figure of this module; `None` if a surface has no area.
pub(crate) fn symmetric_rms(patch: &Mesh, truth: &Mesh) -> Option<f64> {
    let n = (SAMPLES_PER_TRIANGLE * truth.triangles.len()).clamp(MIN_SAMPLES, MAX_SAMPLES);
    let (patch, truth_corners) = (corners(patch), corners(truth));
    let forth = mean_sq(&patch, &Tree::new(truth_corners.clone()), n)?;
    let back = mean_sq(&truth_corners, &Tree::new(patch), n)?;
    Some(((forth + back) / 2.0).sqrt() / mean_piece_diagonal(truth))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit square in `n * n` cells at height `z`, moved along x.
    fn square(n: usize, z: f64, x: f64) -> Mesh {
        let at = |k: usize| k as f64 / n as f64;
        let v = |i: usize, j: usize| (j * (n + 1) + i) as u32;
        Mesh {
            points: (0..=n)
                .flat_map(|j| (0..=n).map(move |i| [at(i) + x, at(j), z]))
                .collect(),
            triangles: (0..n)
                .flat_map(|j| (0..n).map(move |i| (i, j)))
                .flat_map(|(i, j)| {
                    let (a, b, c, d) = (v(i, j), v(i + 1, j), v(i, j + 1), v(i + 1, j + 1));
                    [[a, b, d], [a, d, c]]
                })
                .collect(),
        }
    }

    #[test]
    fn parallel_squares_lie_their_distance_apart() {
        let rms = symmetric_rms(&square(3, 0.25, 0.0), &square(5, 0.0, 0.0)).unwrap();
        assert!((rms - 0.25 / 2f64.sqrt()).abs() < 1e-12, "{rms}");
    }

    #[test]
    fn a_part_that_is_missing_counts_in_one_direction() {
        // The truth reaches half a unit beyond the patch: its distance there is uniform in
        // [0, 1/2] over half of its area.
        let truth = square(8, 0.0, 0.0);
        let mut patch = square(8, 0.0, 0.0);
        patch.points.iter_mut().for_each(|p| p[0] *= 0.5);
        let expected = (0.5 * (0.5 * 0.25 / 3.0f64)).sqrt() / 2f64.sqrt();
        let rms = symmetric_rms(&patch, &truth).unwrap();
        assert!((rms - expected).abs() < 1e-3 * expected, "{rms} {expected}");
    }

    #[test]
    fn the_scale_is_the_mean_diagonal_of_the_pieces() {
        let (mut two, other) = (square(2, 0.0, 0.0), square(1, 0.0, 5.0));
        let shift = two.points.len() as u32;
        two.points
            .extend(other.points.iter().map(|p| [p[0], 3.0 * p[1], p[2]]));
        two.triangles
            .extend(other.triangles.iter().map(|t| t.map(|v| v + shift)));
        let expected = (2f64.sqrt() + 10f64.sqrt()) / 2.0;
        assert!((mean_piece_diagonal(&two) - expected).abs() < 1e-12);
    }

    #[test]
    fn the_tree_finds_what_a_search_of_all_finds() {
        let mut mesh = square(6, 0.0, 0.0);
        for (k, p) in mesh.points.iter_mut().enumerate() {
            p[2] = (3.0 * p[0] + k as f64).sin();
        }
        mesh.triangles.push([0, 0, 5]);
        let triangles = corners(&mesh);
        let tree = Tree::new(triangles.clone());
        for k in 0..500 {
            let f = |m: f64| 3.0 * (m * f64::from(k)).sin();
            let p = [f(0.7), f(1.3), f(2.1)];
            let all = triangles
                .iter()
                .map(|t| triangle_distance_sq(p, t))
                .fold(f64::INFINITY, f64::min);
            // A box may round to lie an ulp farther away than what is in it.
            assert!((tree.distance_sq(p) - all).abs() <= 1e-14 * all);
        }
    }

    #[test]
    fn nothing_to_compare_gives_no_figure() {
        assert_eq!(symmetric_rms(&Mesh::default(), &square(1, 0.0, 0.0)), None);
        assert_eq!(symmetric_rms(&square(1, 0.0, 0.0), &Mesh::default()), None);
    }
}
