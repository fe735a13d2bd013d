//! Test meshes made in code: regular shapes, holes cut into them, and everything that can be wrong
//! with a mesh. The unit tests of the crate include this file too.
#![allow(dead_code, reason = "each test program uses a part of it")]

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

pub(crate) type Point = [f64; 3];

/// Positions and triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Arrays {
    pub(crate) positions: Vec<Point>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Pseudo-random numbers (SplitMix64), the same on every machine.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `n`, which must not be 0.
    pub(crate) fn below(&mut self, n: u32) -> u32 {
        (self.next() % u64::from(n)) as u32
    }

    /// Between -1 and 1.
    pub(crate) fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

pub(crate) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

impl Arrays {
    pub(crate) fn new(positions: Vec<Point>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            positions,
            triangles,
        }
    }

    pub(crate) fn centroid(&self, triangle: [u32; 3]) -> Point {
        let [a, b, c] = triangle.map(|v| self.positions[v as usize]);
        [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0)
    }

    /// Without the triangles whose centroid is in the hole, and without the vertices that then have no
    /// triangle.
    pub(crate) fn cut(&self, is_hole: impl Fn(Point) -> bool) -> Self {
        let kept = self
            .triangles
            .iter()
            .copied()
            .filter(|&t| !is_hole(self.centroid(t)))
            .collect();
        Self::new(self.positions.clone(), kept).without_isolated_vertices()
    }

    pub(crate) fn without_isolated_vertices(&self) -> Self {
        let mut new_of = vec![None; self.positions.len()];
        let mut out = Self::default();
        for &t in &self.triangles {
            out.triangles.push(t.map(|v| {
                *new_of[v as usize].get_or_insert_with(|| {
                    out.positions.push(self.positions[v as usize]);
                    out.positions.len() as u32 - 1
                })
            }));
        }
        out
    }

    pub(crate) fn mapped(&self, f: impl FnMut(Point) -> Point) -> Self {
        let positions = self.positions.iter().copied().map(f).collect();
        Self::new(positions, self.triangles.clone())
    }

    /// Every coordinate moved by up to `amount`.
    pub(crate) fn jittered(&self, amount: f64, seed: u64) -> Self {
        let mut noise = Noise(seed);
        self.mapped(|p| p.map(|c| c + amount * noise.signed()))
    }

    /// Scaled, turned about an axis that is not special, then moved.
    pub(crate) fn moved(&self, scale: f64, angle: f64, offset: Point) -> Self {
        let n = norm([1.0, 2.0, 3.0]);
        let axis = [1.0 / n, 2.0 / n, 3.0 / n];
        let (sin, cos) = angle.sin_cos();
        self.mapped(|p| {
            let cross = [
                axis[1] * p[2] - axis[2] * p[1],
                axis[2] * p[0] - axis[0] * p[2],
                axis[0] * p[1] - axis[1] * p[0],
            ];
            let along = (1.0 - cos) * dot(axis, p);
            [0, 1, 2].map(|k| scale * (cos * p[k] + sin * cross[k] + along * axis[k]) + offset[k])
        })
    }

    /// Vertices and triangles in another order, and every triangle begun at another corner.
    pub(crate) fn shuffled(&self, seed: u64) -> Self {
        let mut noise = Noise(seed);
        let mut order = |n: usize| {
            let mut order: Vec<u32> = (0..n as u32).collect();
            for i in (1..n).rev() {
                order.swap(i, noise.below(i as u32 + 1) as usize);
            }
            order
        };
        let (vertices, faces) = (order(self.positions.len()), order(self.triangles.len()));
        let mut new_of = vec![0; vertices.len()];
        for (new, &old) in vertices.iter().enumerate() {
            new_of[old as usize] = new as u32;
        }
        let turned = |f: &u32| {
            let mut t = self.triangles[*f as usize].map(|v| new_of[v as usize]);
            t.rotate_left(noise.below(3) as usize);
            t
        };
        Self::new(
            vertices
                .iter()
                .map(|&v| self.positions[v as usize])
                .collect(),
            faces.iter().map(turned).collect(),
        )
    }

    /// Both, as separate components.
    pub(crate) fn beside(&self, other: &Self) -> Self {
        let shift = self.positions.len() as u32;
        let mut both = self.clone();
        both.positions.extend_from_slice(&other.positions);
        let shifted = other.triangles.iter().map(|t| t.map(|v| v + shift));
        both.triangles.extend(shifted);
        both
    }

    pub(crate) fn with_triangle(&self, triangle: [u32; 3]) -> Self {
        let mut out = self.clone();
        out.triangles.push(triangle);
        out
    }

    pub(crate) fn with_vertex(&self, position: Point) -> Self {
        let mut out = self.clone();
        out.positions.push(position);
        out
    }

    /// The triangle `face` turned the other way round.
    pub(crate) fn with_flipped(&self, face: usize) -> Self {
        let mut out = self.clone();
        out.triangles[face].swap(0, 1);
        out
    }

    /// Number of vertices - edges + triangles, counting what triangles use.
    pub(crate) fn euler_characteristic(&self) -> i64 {
        let mut edges: Vec<(u32, u32)> = self
            .triangles
            .iter()
            .flat_map(|t| (0..3).map(|k| (t[k], t[(k + 1) % 3])))
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut vertices: Vec<u32> = self.triangles.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices.len() as i64 - edges.len() as i64 + self.triangles.len() as i64
    }
}

/// A grid of `n` by `m` quads, each cut in two; quad `(i, j)` has its low corner at vertex
/// `i * (m + 1) + j`.
pub(crate) fn grid(n: usize, m: usize, at: impl Fn(usize, usize) -> Point) -> Arrays {
    let mut out = Arrays::default();
    for i in 0..=n {
        for j in 0..=m {
            out.positions.push(at(i, j));
        }
    }
    for i in 0..n {
        for j in 0..m {
            let v = (i * (m + 1) + j) as u32;
            let w = v + m as u32 + 1;
            out.triangles.push([v, w, w + 1]);
            out.triangles.push([v, w + 1, v + 1]);
        }
    }
    out
}

/// A sheet of `n` by `n` quads over the square `[0, n]²`.
pub(crate) fn sheet(n: usize, height: impl Fn(f64, f64) -> f64) -> Arrays {
    grid(n, n, |i, j| {
        let (x, y) = (i as f64, j as f64);
        [x, y, height(x, y)]
    })
}

/// Waves two quads high and some ten quads long.
pub(crate) fn waves(x: f64, y: f64) -> f64 {
    (0.6 * x).sin() * (0.5 * y).cos()
}

/// The flat sheet without the quads that `is_hole` names by their low corner.
pub(crate) fn sheet_without(n: usize, is_hole: impl Fn(usize, usize) -> bool) -> Arrays {
    sheet(n, |_, _| 0.0).cut(|c| is_hole(c[0] as usize, c[1] as usize))
}

/// The unit sphere: an octahedron each of whose edges is cut into `n`.
pub(crate) fn sphere(n: usize) -> Arrays {
    let mut out = Arrays::default();
    let mut index = BTreeMap::new();
    let n = n as i64;
    for octant in 0..8 {
        let sign = [0, 1, 2].map(|k| if octant >> k & 1 == 0 { 1 } else { -1 });
        let is_mirrored = sign.iter().product::<i64>() < 0;
        let mut vertex = |i: i64, j: i64| {
            let p = [i * sign[0], j * sign[1], (n - i - j) * sign[2]];
            *index.entry(p).or_insert_with(|| {
                let p = p.map(|c| c as f64);
                out.positions.push(p.map(|c| c / norm(p)));
                out.positions.len() as u32 - 1
            })
        };
        let mut triangles = Vec::new();
        for i in 0..n {
            for j in 0..n - i {
                triangles.push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 1 < n {
                    triangles.push([vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
        }
        for mut t in triangles {
            if is_mirrored {
                t.swap(0, 1);
            }
            out.triangles.push(t);
        }
    }
    out
}

/// The cube `[-1, 1]³` with `n` by `n` quads on each side.
pub(crate) fn cube(n: usize) -> Arrays {
    let mut out = Arrays::default();
    let mut index = BTreeMap::new();
    for axis in 0..3 {
        for is_high in [false, true] {
            let mut vertex = |i: usize, j: usize| {
                let mut key = [0; 3];
                key[axis] = if is_high { n } else { 0 };
                key[(axis + 1) % 3] = i;
                key[(axis + 2) % 3] = j;
                *index.entry(key).or_insert_with(|| {
                    out.positions
                        .push(key.map(|k| 2.0 * k as f64 / n as f64 - 1.0));
                    out.positions.len() as u32 - 1
                })
            };
            for i in 0..n {
                for j in 0..n {
                    let quad = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                    let [a, b, c, d] = quad.map(|(i, j)| vertex(i, j));
                    for mut t in [[a, b, c], [a, c, d]] {
                        if !is_high {
                            t.swap(0, 1);
                        }
                        out.triangles.push(t);
                    }
                }
            }
        }
    }
    out
}

/// Rings of `around` vertices, the last one joined to the first, each ring to the next.
fn tube(
    around: usize,
    rings: usize,
    at: impl Fn(usize, usize) -> Point,
    is_closed: bool,
) -> Arrays {
    let mut out = Arrays::default();
    for ring in 0..rings {
        for k in 0..around {
            out.positions.push(at(ring, k));
        }
    }
    let spans = if is_closed { rings } else { rings - 1 };
    for ring in 0..spans {
        for k in 0..around {
            let v = |r: usize, k: usize| ((r % rings) * around + k % around) as u32;
            let quad = [
                v(ring, k),
                v(ring, k + 1),
                v(ring + 1, k + 1),
                v(ring + 1, k),
            ];
            out.triangles.push([quad[0], quad[1], quad[2]]);
            out.triangles.push([quad[0], quad[2], quad[3]]);
        }
    }
    out
}

/// A cylinder of radius 1 about the z axis, open at both ends, with `rings` circles of `around` vertices
/// as far apart as the vertices are.
pub(crate) fn cylinder(around: usize, rings: usize) -> Arrays {
    let step = 2.0 * (PI / around as f64).sin();
    let at = |ring: usize, k: usize| {
        let angle = TAU * k as f64 / around as f64;
        [angle.cos(), angle.sin(), step * ring as f64]
    };
    tube(around, rings, at, false)
}

/// A torus of radii 2 and 1.
pub(crate) fn torus(around: usize, rings: usize) -> Arrays {
    let at = |ring: usize, k: usize| {
        let (a, b) = (
            TAU * ring as f64 / rings as f64,
            -TAU * k as f64 / around as f64,
        );
        let r = 2.0 + b.cos();
        [r * a.cos(), r * a.sin(), b.sin()]
    };
    tube(around, rings, at, true)
}

/// A Möbius strip of `n` quads, one quad wide. It has one boundary.
pub(crate) fn moebius(n: usize) -> Arrays {
    let mut out = Arrays::default();
    for i in 0..n {
        let angle = TAU * i as f64 / n as f64;
        for side in [-0.3, 0.3] {
            let r = 1.0 + side * (angle / 2.0).cos();
            out.positions
                .push([r * angle.cos(), r * angle.sin(), side * (angle / 2.0).sin()]);
        }
    }
    for i in 0..n {
        let v = |k: usize| (2 * i + k) as u32;
        // The last quad meets the first one turned over.
        let [c, d] = if i + 1 == n { [1, 0] } else { [v(2), v(3)] };
        out.triangles.push([v(0), c, d]);
        out.triangles.push([v(0), d, v(1)]);
    }
    out
}

/// `n` triangles round vertex 0, closed or not, with radius 1.
pub(crate) fn fan(n: usize, is_closed: bool) -> Arrays {
    let mut out = Arrays::new(vec![[0.0; 3]], Vec::new());
    let count = if is_closed { n } else { n + 1 };
    for k in 0..count {
        let angle = TAU * k as f64 / (n + 1) as f64;
        out.positions.push([angle.cos(), angle.sin(), 0.0]);
    }
    for k in 0..n {
        let next = (k + 1) % count;
        out.triangles.push([0, 1 + k as u32, 1 + next as u32]);
    }
    out
}

/// Three sectors of a disc that meet at vertex 0 only, with three holes between them.
pub(crate) fn three_fans() -> Arrays {
    let disc = tube(
        12,
        3,
        |ring, k| {
            let (r, angle) = (3.0 - ring as f64, TAU * k as f64 / 12.0);
            [r * angle.cos(), r * angle.sin(), 0.0]
        },
        false,
    );
    // The outer ring of triangles stays whole.
    let mut out = Arrays::new(disc.positions.clone(), disc.triangles[..24].to_vec());
    out.positions.push([0.0; 3]);
    for k in (0..12).filter(|k| k % 4 < 2) {
        let quad = disc.triangles[24 + 2 * k..26 + 2 * k].iter();
        out.triangles.extend(quad);
        out.triangles
            .push([24 + k as u32, 24 + (k as u32 + 1) % 12, 36]);
    }
    out
}

pub(crate) fn triangle() -> Arrays {
    Arrays::new(
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        vec![[0, 1, 2]],
    )
}

/// Two triangles that share an edge and lie in a plane.
pub(crate) fn two_triangles() -> Arrays {
    triangle()
        .with_vertex([1.0, 1.0, 0.0])
        .with_triangle([1, 3, 2])
}

pub(crate) fn tetrahedron() -> Arrays {
    let mut out = triangle().with_vertex([0.0, 0.0, 1.0]);
    out.triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    out
}

/// A block of quads from the sheet's hole, `low..high` in both directions.
fn block(i: usize, j: usize, low: usize, high: usize) -> bool {
    (low..high).contains(&i) && (low..high).contains(&j)
}

/// A mesh with a name and what is known of its boundary.
pub(crate) struct Fixture {
    pub(crate) name: &'static str,
    pub(crate) mesh: Arrays,
    /// Names of the classes of its loops, sorted.
    pub(crate) classes: Vec<&'static str>,
}

fn fixture(name: &'static str, mesh: Arrays, classes: &[&'static str]) -> Fixture {
    let classes = classes.to_vec();
    Fixture {
        name,
        mesh,
        classes,
    }
}

/// A sheet of 12 by 12 quads with one hole of 4 by 4 quads in the middle.
pub(crate) fn sheet_with_hole() -> Arrays {
    sheet(12, waves).cut(|c| block(c[0] as usize, c[1] as usize, 4, 8))
}

/// A sheet whose hole has `islands` loose sheets of 2 by 2 quads in it.
pub(crate) fn sheet_with_islands(islands: usize) -> Arrays {
    let is_island = |i: usize, j: usize| {
        (0..islands).any(|k| (4 + 4 * k..6 + 4 * k).contains(&i) && (4..6).contains(&j))
    };
    let n = 6 + 4 * islands.max(1);
    sheet(n, |x, y| 0.3 * waves(x, y)).cut(|c| {
        let (i, j) = (c[0] as usize, c[1] as usize);
        (2..n - 2).contains(&i) && (2..8).contains(&j) && !is_island(i, j)
    })
}

/// Two holes that touch in one vertex, `size` quads wide.
pub(crate) fn touching_holes(size: usize) -> Arrays {
    sheet_without(2 * size + 4, |i, j| {
        block(i, j, 2, 2 + size) || block(i, j, 2 + size, 2 + 2 * size)
    })
}

/// A hole with a tongue that hangs on one vertex.
pub(crate) fn tongue() -> Arrays {
    sheet_without(10, |i, j| {
        block(i, j, 1, 8) && (i, j) != (1, 1) && !block(i, j, 2, 4)
    })
}

/// Two holes that touch in the vertices 0 and 1: each would best be closed along the chord between them,
/// which only one can have.
pub(crate) fn holes_that_share_two_vertices() -> Arrays {
    let positions = vec![
        [-0.5, 0.0, 0.0],
        [0.5, 0.0, 0.0],
        [0.0, -1.0, 1.0],
        [0.0, 1.0, 1.0],
        [0.0, -1.0, -1.0],
        [0.0, 1.0, -1.0],
    ];
    Arrays::new(positions, vec![[0, 4, 2], [4, 1, 2], [0, 3, 5], [3, 1, 5]])
}

/// Every kind of mesh, good and bad.
pub(crate) fn fixtures() -> Vec<Fixture> {
    let holed = sheet_with_hole();
    let vertex = |mesh: &Arrays, x: f64, y: f64| {
        let found = mesh.positions.iter().position(|p| p[0] == x && p[1] == y);
        found.expect("a vertex of the sheet") as u32
    };
    let (a, b) = (vertex(&holed, 4.0, 5.0), vertex(&holed, 3.0, 5.0));
    let (c, d) = (vertex(&holed, 1.0, 1.0), vertex(&holed, 2.0, 1.0));
    // A third triangle at an edge.
    let flap = |a, b| {
        let tip = holed.positions.len() as u32;
        holed
            .with_vertex([4.0, 5.5, 3.0])
            .with_triangle([a, b, tip])
    };
    let sphere = sphere(8).jittered(0.01, 1);
    let flat_fan = fan(5000, true);
    vec![
        fixture("empty", Arrays::default(), &[]),
        fixture(
            "isolated vertices",
            Arrays::new(vec![[1.0; 3]; 4], vec![]),
            &[],
        ),
        fixture("triangle", triangle(), &["outer-rim"]),
        fixture("two triangles", two_triangles(), &["outer-rim"]),
        fixture("tetrahedron", tetrahedron(), &[]),
        fixture("sphere", sphere.clone(), &[]),
        fixture(
            "sphere with a hole",
            sphere.cut(|c| c[2] > 0.7),
            &["simple"],
        ),
        fixture(
            "sphere with two holes",
            sphere.cut(|c| c[2].abs() > 0.7),
            &["simple", "simple"],
        ),
        fixture(
            "cube without a corner",
            cube(8).cut(|c| c.iter().all(|&x| x > 0.3)),
            &["simple"],
        ),
        fixture("cylinder", cylinder(16, 6), &["simple", "simple"]),
        fixture("torus", torus(12, 24), &[]),
        fixture(
            "torus with a gap",
            torus(12, 24).cut(|c| c[0] > 0.0 && c[1].abs() < 0.7),
            &["simple", "simple"],
        ),
        fixture("sheet", sheet(8, waves), &["outer-rim"]),
        fixture("sheet with a hole", holed.clone(), &["outer-rim", "simple"]),
        fixture(
            "touching holes",
            touching_holes(3),
            &["outer-rim", "touching", "touching"],
        ),
        fixture(
            "three fans",
            three_fans(),
            &["outer-rim", "touching", "touching", "touching"],
        ),
        fixture("tongue", tongue(), &["island", "outer-rim", "touching"]),
        fixture(
            "island",
            sheet_with_islands(1),
            &["island", "outer-rim", "simple"],
        ),
        fixture(
            "three islands",
            sheet_with_islands(3),
            &["island", "island", "island", "outer-rim", "simple"],
        ),
        fixture("moebius strip", moebius(12), &["not-oriented"]),
        fixture(
            "flipped triangle inside",
            holed.with_flipped(0),
            &["not-oriented", "simple"],
        ),
        fixture(
            "flap at the rim",
            flap(a, b),
            &["open-chain", "open-chain", "outer-rim"],
        ),
        fixture(
            "flap inside",
            flap(c, d),
            &["open-chain", "outer-rim", "simple"],
        ),
        fixture(
            "duplicate triangle",
            holed.with_triangle(holed.triangles[40]),
            &["outer-rim", "simple"],
        ),
        fixture(
            "degenerate triangle",
            holed.with_triangle([a, b, a]),
            &["outer-rim", "simple"],
        ),
        fixture(
            "all vertices equal",
            holed.mapped(|_| [0.5; 3]),
            &["simple", "simple"],
        ),
        fixture(
            "collinear vertices",
            holed.mapped(|p| [p[0] + 13.0 * p[1], 0.0, 0.0]),
            &["simple", "simple"],
        ),
        fixture("fan of 5000", flat_fan, &["outer-rim"]),
        fixture("open fan of 5000", fan(5000, false), &["outer-rim"]),
        fixture(
            "holes that share two vertices",
            holes_that_share_two_vertices(),
            &["touching", "touching"],
        ),
    ]
}
