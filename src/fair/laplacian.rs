//! The discrete Laplacian of a patch joined to the triangles round it: edge weights and vertex areas.
//!
//! Sources: U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates", Experimental
//! Mathematics 2(1), 1993, for cotangent weights; M. Botsch, L. Kobbelt, "An intuitive framework for real-time
//! freeform modeling", ACM TOG 23(3), 2004, for lumped areas; M. Meyer, M. Desbrun, P. Schröder, A. H. Barr,
//! "Discrete differential-geometry operators for triangulated 2-manifolds", VisMath 2002, section 3.3, for Voronoi
//! areas.
//!
//! Cost: linear in the number of triangles.

use crate::error::Result;
use crate::job::Job;
use crate::math::adjacency::CompressedRows;
use crate::math::{Vec3, cross_normal};
use crate::patch::PatchSurface;
use crate::surroundings::Surroundings;

/// Upper bound on a cotangent, that of about half a degree. A larger one is mostly rounding error.
const LARGEST_COTANGENT: f64 = 100.0;
/// Upper bound on a cosine for Voronoi weights, as in CGAL.
const LARGEST_COSINE: f64 = 0.999;
/// Lower bound on a vertex area, as a share of the mean area, so that a sliver does not dominate the energy.
const SMALLEST_AREA_SHARE: f64 = 1e-3;

/// Edge weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weights {
    /// Weight 1 for each edge, area 1 for each vertex. They do not depend on the shape, so they serve for a start.
    Uniform,
    /// Weight 1 for each edge; the area of a vertex is its valence. With order two, the second-order umbrella vector of
    /// every interior vertex is zero at the minimum.
    Umbrella,
    /// Half the sum of the cotangents of the opposite angles; the area is a third of the triangles' areas.
    Cotangent,
    /// The same weights; the area is that of the Voronoi cell. Only the cotangents are limited, and negative weights
    /// count. This is what CGAL does, for comparison with it.
    Voronoi,
}

/// An entry of a row of the Laplacian.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficient {
    pub(crate) column: u32,
    pub(crate) weight: f64,
}

/// A patch joined to its surroundings: positions, Laplacian rows and areas.
///
/// Vertices are numbered rim, interior, surroundings.
pub(crate) struct FairingDomain {
    pub(crate) rim_count: usize,
    /// Number of rim and interior vertices.
    pub(crate) patch_count: usize,
    pub(crate) points: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// 0 for rim and interior vertices, the ring for those of the surroundings.
    pub(crate) levels: Vec<u32>,
    rows: CompressedRows<Coefficient>,
    /// Area of each vertex.
    pub(crate) areas: Vec<f64>,
    /// Whether negative weights count in the Laplacian as a quadratic form.
    has_negative: bool,
    /// Whether all edges at the vertex have two triangles, so that its row is complete.
    pub(crate) is_complete: Vec<bool>,
}

impl FairingDomain {
    /// Joins the patch to the rings of its surroundings below `ring_count`.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(crate) fn new(
        surface: &PatchSurface,
        surroundings: &Surroundings,
        ring_count: u32,
        weights: Weights,
        job: &Job<'_>,
    ) -> Result<Self> {
        job.ask()?;
        let patch_count = surface.points.len();
        let shift = (patch_count - surface.rim_count) as u32;
        let rim_count = surface.rim_count;
        let level_of = |v: u32| {
            if (v as usize) < rim_count {
                0
            } else {
                surroundings.levels()[v as usize]
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
            .triangles()
            .iter()
            .filter(|t| ring_of(t) < ring_count);
        triangles.extend(near.map(|t| t.map(global)));
        let mut points = surface.points.clone();
        points.extend_from_slice(surroundings.outer());
        let mut levels = vec![0; patch_count];
        levels.extend_from_slice(&surroundings.levels()[surroundings.rim().len()..]);
        let mut domain = Self {
            rim_count,
            patch_count,
            rows: CompressedRows::with_capacity(0, 0),
            areas: vec![0.0; points.len()],
            has_negative: weights == Weights::Voronoi,
            is_complete: vec![true; points.len()],
            points,
            triangles,
            levels,
        };
        job.ask()?;
        domain.assemble(weights, job)?;
        Ok(domain)
    }

    /// Number of vertices.
    pub(crate) fn vertex_count(&self) -> usize {
        self.points.len()
    }

    /// Off-diagonal entries of the row of `vertex`, with ascending columns; the diagonal is minus their sum.
    pub(crate) fn row(&self, vertex: usize) -> &[Coefficient] {
        self.rows.of(vertex as u32)
    }

    /// The weight of an entry in the Laplacian as a quadratic form.
    pub(crate) fn form_weight(&self, entry: &Coefficient) -> f64 {
        if self.has_negative {
            entry.weight
        } else {
            entry.weight.max(0.0)
        }
    }

    fn assemble(&mut self, weights: Weights, job: &Job<'_>) -> Result<()> {
        let count = self.vertex_count();
        // Row and half of the weight of each edge, for either direction, by column.
        let ends = self.triangles.as_flattened().iter().flat_map(|&v| [v, v]);
        let mut by_column = CompressedRows::with_room(count, ends, (0_u32, 0.0));
        job.ask()?;
        for t in &self.triangles {
            job.tick(3)?;
            let corners = || t.map(|v| &self.points[v as usize]);
            let (cotangents, areas) = match weights {
                Weights::Uniform | Weights::Umbrella => ([1.0; 3], [0.0; 3]),
                Weights::Cotangent => cotangents_and_thirds(corners()),
                Weights::Voronoi => cotangents_and_cells(corners()),
            };
            for k in 0..3 {
                let (a, b) = (t[(k + 1) % 3], t[(k + 2) % 3]);
                for (row, column) in [(a, b), (b, a)] {
                    by_column.push(column, (row, cotangents[k] / 2.0));
                }
                self.areas[t[k] as usize] += areas[k];
            }
        }
        // Columns are taken in order, so the entries of each row are in ascending order.
        let zero = Coefficient {
            column: 0,
            weight: 0.0,
        };
        let mut half_edges = by_column.with_same_room(zero);
        for column in 0..count as u32 {
            job.tick(3)?;
            for &(row, weight) in by_column.of(column) {
                half_edges.push(row, Coefficient { column, weight });
            }
        }
        // Nearly every edge has two triangles.
        let room = 3 * self.triangles.len() + self.rim_count;
        self.rows = CompressedRows::with_capacity(count, room);
        for v in 0..count {
            job.tick(3)?;
            let row = half_edges.of(v as u32);
            let entries = row.chunk_by(|a, b| a.column == b.column).map(|same| {
                self.is_complete[v] &= same.len() == 2;
                let weight = match weights {
                    Weights::Uniform | Weights::Umbrella => 1.0,
                    Weights::Cotangent | Weights::Voronoi => same.iter().map(|e| e.weight).sum(),
                };
                let column = same[0].column;
                Coefficient { column, weight }
            });
            self.rows.append(entries);
        }
        match weights {
            Weights::Uniform => self.areas.fill(1.0),
            Weights::Umbrella => {
                for v in 0..count {
                    self.areas[v] = (self.row(v).len() as f64).max(1.0);
                }
            }
            Weights::Cotangent => {
                let mean = self.areas.iter().sum::<f64>() / count.max(1) as f64;
                for area in &mut self.areas {
                    *area = area.max(SMALLEST_AREA_SHARE * mean);
                }
            }
            Weights::Voronoi => {
                for area in &mut self.areas {
                    *area = area.max(f64::MIN_POSITIVE);
                }
            }
        }
        Ok(())
    }
}

/// The cotangent of the angle at each corner, and a third of the area for each corner.
fn cotangents_and_thirds(corners: [&Vec3; 3]) -> ([f64; 3], [f64; 3]) {
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
        [double_area / 6.0; 3],
    )
}

/// The cotangent of the angle at each corner, and the corner's share of the area. The share is the part nearest to the
/// corner. In an obtuse triangle it is half of the area at the obtuse angle and a quarter at the others.
fn cotangents_and_cells(corners: [&Vec3; 3]) -> ([f64; 3], [f64; 3]) {
    let double_area = cross_normal(corners[0], corners[1], corners[2]).norm();
    let side = |k: usize| corners[(k + 2) % 3] - corners[(k + 1) % 3];
    let along = [0, 1, 2].map(|k: usize| -side((k + 1) % 3).dot(&side((k + 2) % 3)));
    let limited = [0, 1, 2].map(|k: usize| {
        let lengths = side((k + 1) % 3).norm() * side((k + 2) % 3).norm();
        let cosine = (along[k] / lengths).clamp(-LARGEST_COSINE, LARGEST_COSINE);
        cosine / (1.0 - cosine * cosine).sqrt()
    });
    let obtuse = along.iter().position(|&a| a < 0.0);
    let areas = [0, 1, 2].map(|k: usize| match obtuse {
        Some(at) if at == k => double_area / 4.0,
        Some(_) => double_area / 8.0,
        None => {
            let part = |j: usize| along[j] / double_area * side(j).norm_squared();
            (part((k + 1) % 3) + part((k + 2) % 3)) / 8.0
        }
    });
    (limited, areas)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voronoi_cells_share_the_area_of_a_triangle() {
        let right = [Vec3::zeros(), 2.0 * Vec3::x(), Vec3::y()];
        let acute = [Vec3::zeros(), 2.0 * Vec3::x(), Vec3::new(0.7, 1.5, 0.3)];
        let obtuse = [Vec3::zeros(), 2.0 * Vec3::x(), Vec3::new(1.0, 0.0, 0.25)];
        for corners in [right, acute, obtuse] {
            let corners = [&corners[0], &corners[1], &corners[2]];
            let (cotangents, cells) = cotangents_and_cells(corners);
            let (same, thirds) = cotangents_and_thirds(corners);
            for k in 0..3 {
                assert!((cotangents[k] - same[k]).abs() < 1e-12);
            }
            let (whole, sum) = (thirds.iter().sum::<f64>(), cells.iter().sum::<f64>());
            assert!((whole - sum).abs() < 1e-15);
        }
        // The cell of the right angle reaches to the middle of the opposite side: half of the triangle.
        let (_, cells) = cotangents_and_cells([&right[0], &right[1], &right[2]]);
        assert!((cells[0] - 0.5).abs() < 1e-15);
        assert!((cells[1] - 0.25).abs() < 1e-15);
    }

    #[test]
    fn cotangents_for_comparison_are_limited_like_those_of_cgal() {
        let needle = [Vec3::zeros(), Vec3::x(), Vec3::new(1.0, 1e-3, 0.0)];
        let (cotangents, _) = cotangents_and_cells([&needle[0], &needle[1], &needle[2]]);
        let limit = LARGEST_COSINE / (1.0 - LARGEST_COSINE * LARGEST_COSINE).sqrt();
        assert!((cotangents[0] - limit).abs() < 1e-12);
    }
}
