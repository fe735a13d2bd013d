//! The Laplacian of a patch together with the triangles round it.
//!
//! Based on: U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates",
//! Experimental Mathematics 2(1), 1993 (cotangent weights); lumped areas as in M. Botsch, L. Kobbelt,
//! "An intuitive framework for real-time freeform modeling", ACM TOG 23(3), 2004.

use crate::error::{Result, proceed_unless};
use crate::math::{Vec3, cross_normal};
use crate::patch::{PatchSurface, Surroundings};

/// Cotangents are limited to those of an angle of about half a degree: beyond it they carry more rounding
/// than shape.
const LARGEST_COTANGENT: f64 = 100.0;
/// Vertex areas are at least this share of the mean one, so that a sliver does not outweigh everything.
const SMALLEST_AREA_SHARE: f64 = 1e-3;

/// Triangles or rows assembled between two questions whether to go on.
const ROWS_PER_CHECK: usize = 1 << 13;

/// Edge weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weights {
    /// One for each edge, and area one for each vertex: needs no shape, so it serves as a start.
    Uniform,
    /// One for each edge, and as area of a vertex the number of its edges: with order two the second-order
    /// umbrella vector of every interior vertex vanishes at the minimum.
    Umbrella,
    /// Half the cotangents of the opposite angles, and a third of the triangles' areas.
    Cotangent,
}

/// An entry of a row of the Laplacian.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub(crate) column: u32,
    pub(crate) weight: f64,
}

/// A patch joined to its surroundings: positions, Laplacian rows and areas.
///
/// Vertices are numbered rim, interior, surroundings.
pub(crate) struct Domain {
    pub(crate) rim_count: usize,
    /// Number of rim and interior vertices.
    pub(crate) patch_count: usize,
    pub(crate) points: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// 0 for rim and interior vertices, the ring for those of the surroundings.
    pub(crate) levels: Vec<u32>,
    row_starts: Vec<u32>,
    entries: Vec<Entry>,
    /// Area of each vertex.
    pub(crate) areas: Vec<f64>,
    /// Whether all edges at the vertex have two triangles, so that its row is that of the closed surface.
    pub(crate) is_complete: Vec<bool>,
}

impl Domain {
    /// Joins the patch to the rings of its surroundings below `ring_count`.
    ///
    /// # Errors
    /// `Cancelled` when `interrupted`, which is asked from time to time, returns true.
    pub(crate) fn new(
        surface: &PatchSurface,
        surroundings: &Surroundings,
        ring_count: u32,
        weights: Weights,
        interrupted: &dyn Fn() -> bool,
    ) -> Result<Self> {
        let patch_count = surface.points.len();
        let shift = (patch_count - surface.rim_count) as u32;
        let rim_count = surface.rim_count;
        let level_of = |v: u32| {
            if (v as usize) < rim_count {
                0
            } else {
                surroundings.levels[v as usize - rim_count]
            }
        };
        let ring_of = |t: &[u32; 3]| t.iter().map(|&v| level_of(v)).min().unwrap_or(0);
        let global = |v: u32| {
            if (v as usize) < rim_count {
                v
            } else {
                v + shift
            }
        };
        let mut triangles = surface.triangles.clone();
        let near = surroundings
            .triangles
            .iter()
            .filter(|t| ring_of(t) < ring_count);
        triangles.extend(near.map(|t| t.map(global)));
        let mut points = surface.points.clone();
        points.extend_from_slice(&surroundings.points);
        let mut levels = vec![0; patch_count];
        levels.extend_from_slice(&surroundings.levels);
        let mut domain = Self {
            rim_count,
            patch_count,
            row_starts: Vec::new(),
            entries: Vec::new(),
            areas: vec![0.0; points.len()],
            is_complete: vec![true; points.len()],
            points,
            triangles,
            levels,
        };
        domain.assemble(weights, interrupted)?;
        Ok(domain)
    }

    /// Number of vertices.
    pub(crate) fn vertex_count(&self) -> usize {
        self.points.len()
    }

    /// Off-diagonal entries of the row of `vertex`, with ascending columns; the diagonal is minus their sum.
    pub(crate) fn row(&self, vertex: usize) -> &[Entry] {
        &self.entries[self.row_starts[vertex] as usize..self.row_starts[vertex + 1] as usize]
    }

    fn assemble(&mut self, weights: Weights, interrupted: &dyn Fn() -> bool) -> Result<()> {
        let count = self.vertex_count();
        let mut starts = vec![0_u32; count + 1];
        for t in &self.triangles {
            for &v in t {
                starts[v as usize + 1] += 2;
            }
        }
        for v in 0..count {
            starts[v + 1] += starts[v];
        }
        let mut slots = starts.clone();
        let zero = Entry {
            column: 0,
            weight: 0.0,
        };
        let mut half_edges = vec![zero; 6 * self.triangles.len()];
        for (i, t) in self.triangles.iter().enumerate() {
            if i % ROWS_PER_CHECK == ROWS_PER_CHECK - 1 {
                proceed_unless(interrupted)?;
            }
            let (cotangents, area) = match weights {
                Weights::Uniform | Weights::Umbrella => ([1.0; 3], 0.0),
                Weights::Cotangent => cotangents_and_area(t.map(|v| &self.points[v as usize])),
            };
            for k in 0..3 {
                let (a, b) = (t[(k + 1) % 3], t[(k + 2) % 3]);
                for (row, column) in [(a, b), (b, a)] {
                    let slot = &mut slots[row as usize];
                    half_edges[*slot as usize] = Entry {
                        column,
                        weight: cotangents[k] / 2.0,
                    };
                    *slot += 1;
                }
                self.areas[t[k] as usize] += area / 3.0;
            }
        }
        // Nearly every edge has two triangles.
        self.entries.reserve(half_edges.len() / 2 + self.rim_count);
        self.row_starts.reserve(count + 1);
        self.row_starts.push(0);
        for v in 0..count {
            if v % ROWS_PER_CHECK == ROWS_PER_CHECK - 1 {
                proceed_unless(interrupted)?;
            }
            let row = &mut half_edges[starts[v] as usize..starts[v + 1] as usize];
            row.sort_by_key(|e| e.column);
            for same in row.chunk_by(|a, b| a.column == b.column) {
                self.is_complete[v] &= same.len() == 2;
                let weight = match weights {
                    Weights::Uniform | Weights::Umbrella => 1.0,
                    Weights::Cotangent => same.iter().map(|e| e.weight).sum(),
                };
                self.entries.push(Entry {
                    column: same[0].column,
                    weight,
                });
            }
            self.row_starts.push(self.entries.len() as u32);
        }
        match weights {
            Weights::Uniform => self.areas.fill(1.0),
            Weights::Umbrella => {
                for (area, ends) in self.areas.iter_mut().zip(self.row_starts.windows(2)) {
                    *area = f64::from(ends[1] - ends[0]).max(1.0);
                }
            }
            Weights::Cotangent => {
                let mean = self.areas.iter().sum::<f64>() / count.max(1) as f64;
                for area in &mut self.areas {
                    *area = area.max(SMALLEST_AREA_SHARE * mean);
                }
            }
        }
        Ok(())
    }
}

/// Cotangent of the angle at each corner, and the area.
fn cotangents_and_area(corners: [&Vec3; 3]) -> ([f64; 3], f64) {
    let double_area = cross_normal(corners[0], corners[1], corners[2]).norm();
    let cotangent = |k: usize| {
        let (p, q, r) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
        let along = (q - p).dot(&(r - p));
        let limit = LARGEST_COTANGENT * double_area;
        // Written without a division by an area that may be zero.
        if along.abs() <= limit && double_area > 0.0 {
            along / double_area
        } else {
            LARGEST_COTANGENT.copysign(along)
        }
    };
    (
        [cotangent(0), cotangent(1), cotangent(2)],
        double_area / 2.0,
    )
}
