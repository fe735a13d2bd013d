//! Normals and noise of the known surface, from quadrics fitted to positions alone.
//!
//! Based on: F. Cazals, M. Pouget, "Estimating differential quantities using polynomial fitting of osculating
//! jets", Computer Aided Geometric Design 22(2), 2005, section 3 (height functions over a local frame, fitted by
//! least squares with truncated singular values). Unlike there, neighbors are taken by edges, not by distance:
//! rings round a vertex stay on the sheet and follow the sampling where it is stretched.
//!
//! Normals of triangles average over half an edge; at a rim they do so to one side only and lean by the angle that
//! the surface turns over half an edge. The quadric's tangent plane at the vertex does not.
//!
//! A fit costs `O(k)` for `k` neighbors, some twenty, and a 5x5 or 6x6 eigenvalue problem. Not guaranteed: that
//! the fitted normal is better than that of the triangles where the surface has a crease.

use super::Surroundings;
use crate::error::Result;
use crate::job::Job;
use crate::math::adjacency::CompressedRows;
use crate::math::frame::axes_across;
use crate::math::{Vec3, unit};
use nalgebra::{SMatrix, SVector, SymmetricEigen};
use std::f64::consts::FRAC_1_SQRT_2;

/// Rings of neighbors that a fit starts with.
const RINGS: usize = 2;
/// A fit wants this many vertices, the fitted one included, and takes up to [`EXTRA_RINGS`] more rings for them.
const ENOUGH_NEIGHBORS: usize = 9;
const EXTRA_RINGS: usize = 2;
/// Fewer neighbors than this do not determine a quadric.
const FEWEST_NEIGHBORS: usize = 6;
/// Cosine of the angle between normals from which on a neighbor lies on another side of the model.
const SAME_SIDE: f64 = 0.2;
/// Singular values below this share of the largest are noise of the sampling pattern.
const SINGULAR_SHARE: f64 = 1e-3;
/// Decay of the weights with the squared distance, in units of the mean squared distance: an interpolating fit
/// is local, a smoothing one needs all its neighbors.
const INTERPOLATING_DECAY: f64 = 1.0;
const SMOOTHING_DECAY: f64 = 0.3;
/// Vertices at which noise is estimated, at most: their median does not need all.
const NOISE_PROBES: usize = 50;
/// What a quadric misses of a smooth surface grows with the cube of the distance: over three rings it deviates by
/// 1.5³ times as much as over two, in squares by this factor. Noise does not grow.
const SQUARED_GROWTH: f64 = 11.390625;

/// Fits quadrics to the known surface round a hole.
pub(crate) struct QuadricFits<'a> {
    pub(crate) around: &'a Surroundings,
    /// Those of the triangles, see [`Surroundings::normals`].
    pub(crate) normals: &'a [Vec3],
    neighbors: &'a CompressedRows<u32>,
}

/// The surface near a vertex as a smoothing fit sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smoothed {
    /// The vertex moved onto the fitted quadric.
    pub(crate) point: Vec3,
    /// Unit normal of the quadric there.
    pub(crate) normal: Vec3,
    /// Standard deviation of the neighbors from the quadric.
    pub(crate) deviation: f64,
}

impl<'a> QuadricFits<'a> {
    /// Nothing is fitted yet.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Cancelled`] when the job is stopped.
    pub(crate) fn new(around: &'a Surroundings, job: &Job<'_>) -> Result<Self> {
        Ok(Self {
            around,
            normals: around.normals(job)?,
            neighbors: around.neighbors(job)?,
        })
    }

    /// The unit normal at a vertex of the quadric that passes through it and fits its neighbors; that of the
    /// triangles where there are too few neighbors.
    pub(crate) fn interpolating_normal(&self, vertex: u32) -> Vec3 {
        let fallback = self.normals[vertex as usize];
        let mut near = self.neighborhood(vertex, RINGS);
        near.retain(|&u| u != vertex);
        if near.len() + 1 < FEWEST_NEIGHBORS {
            return fallback;
        }
        let frame = JetFrame::new(self.around.points()[vertex as usize], fallback);
        let (rows, _) = frame.heights(self.around.points(), &near);
        let Some(c) = least_squares(&rows, INTERPOLATING_DECAY, 0.0) else {
            return fallback;
        };
        unit(frame.normal - c[1] * frame.u - c[2] * frame.v)
    }

    /// The same at the vertices of the rim.
    ///
    /// # Errors
    /// `Cancelled` when the job is stopped.
    pub(crate) fn normals_at_rim(&self, job: &Job<'_>) -> Result<Vec<Vec3>> {
        let count = self.around.rim().len();
        let mut normals = Vec::with_capacity(count);
        for v in 0..count {
            job.tick(200)?;
            normals.push(self.interpolating_normal(v as u32));
        }
        Ok(normals)
    }

    /// The quadric that fits a vertex and its neighbors within `rings`, without passing through any of them;
    /// `None` where there are too few.
    pub(crate) fn smoothed(&self, vertex: u32, rings: usize) -> Option<Smoothed> {
        let near = self.neighborhood(vertex, rings);
        if near.len() < FEWEST_NEIGHBORS {
            return None;
        }
        let mean: Vec3 = near.iter().map(|&u| self.normals[u as usize]).sum();
        let frame = JetFrame::new(self.around.points()[vertex as usize], unit(mean));
        let (rows, scale) = frame.heights(self.around.points(), &near);
        let c = least_squares(&rows, SMOOTHING_DECAY, 1.0)?;
        let squares: f64 = rows
            .iter()
            .map(|&[u, v, w]| (monomials(1.0, u, v).dot(&c) - w).powi(2))
            .sum();
        let freedom = rows.len().saturating_sub(c.len()).max(1);
        Some(Smoothed {
            point: frame.origin + c[0] * scale * frame.normal,
            normal: unit(frame.normal - c[1] * frame.u - c[2] * frame.v),
            deviation: (squares / freedom as f64).sqrt() * scale,
        })
    }

    /// The noise of the positions: the median over the vertices of their deviation from quadrics fitted to their
    /// neighbors, without what fits over two and over three rings show to be the shape of the surface.
    pub(crate) fn noise(&self, last_level: u32) -> f64 {
        let vertices = self.around.vertices_in(0..last_level + 1);
        let stride = vertices.len().div_ceil(NOISE_PROBES).max(1);
        let mut deviations: Vec<f64> = vertices
            .iter()
            .step_by(stride)
            .filter_map(|&v| {
                let near = self.smoothed(v, RINGS)?.deviation.powi(2);
                let far = self.smoothed(v, RINGS + 1)?.deviation.powi(2);
                let noise = (SQUARED_GROWTH * near - far) / (SQUARED_GROWTH - 1.0);
                Some(noise.max(0.0).sqrt())
            })
            .collect();
        deviations.sort_unstable_by(f64::total_cmp);
        deviations.get(deviations.len() / 2).copied().unwrap_or(0.0)
    }

    /// The vertex and those within `rings` edges of it, more if these are few, on its side of the model.
    fn neighborhood(&self, vertex: u32, rings: usize) -> Vec<u32> {
        let mut near = vec![vertex];
        let mut ring_start = 0;
        for ring in 0..rings + EXTRA_RINGS {
            if ring >= rings && near.len() >= ENOUGH_NEIGHBORS {
                break;
            }
            let ring_end = near.len();
            for i in ring_start..ring_end {
                for &u in self.neighbors.of(near[i]) {
                    if !near.contains(&u) {
                        near.push(u);
                    }
                }
            }
            ring_start = ring_end;
        }
        let normal = self.normals[vertex as usize];
        near.retain(|&u| self.normals[u as usize].dot(&normal) > SAME_SIDE);
        near
    }
}

/// A vertex and the axes round it.
struct JetFrame {
    origin: Vec3,
    normal: Vec3,
    u: Vec3,
    v: Vec3,
}

impl JetFrame {
    fn new(origin: Vec3, normal: Vec3) -> Self {
        let [u, v] = axes_across(&normal);
        Self {
            origin,
            normal,
            u,
            v,
        }
    }

    /// Heights `w` over the tangent plane's coordinates `u`, `v`, divided by the root mean square of these, which
    /// is returned as well.
    fn heights(&self, points: &[Vec3], near: &[u32]) -> (Vec<[f64; 3]>, f64) {
        let mut rows: Vec<[f64; 3]> = near
            .iter()
            .map(|&p| points[p as usize] - self.origin)
            .map(|d| [d.dot(&self.u), d.dot(&self.v), d.dot(&self.normal)])
            .collect();
        let squares: f64 = rows.iter().map(|[u, v, _]| u * u + v * v).sum();
        let scale = (squares / rows.len() as f64)
            .sqrt()
            .max(f64::MIN_POSITIVE.sqrt());
        rows.iter_mut().flatten().for_each(|x| *x /= scale);
        (rows, scale)
    }
}

type Coefficients = SVector<f64, 6>;

/// The terms of a quadric over the plane, scaled so that turning the plane keeps the length of the coefficients: what
/// is left out as singular then does not depend on its axes.
fn monomials(constant: f64, u: f64, v: f64) -> Coefficients {
    let mixed = u * v * FRAC_1_SQRT_2;
    Coefficients::from([constant, u, v, u * u / 2.0, mixed, v * v / 2.0])
}

/// The quadric that fits the heights with weights `exp(-2 decay (u² + v²))`, without its constant term when
/// `constant` is zero; singular values that are too small are left out. `None` when something is not finite.
fn least_squares(rows: &[[f64; 3]], decay: f64, constant: f64) -> Option<Coefficients> {
    let mut matrix = Matrix::zeros();
    let mut right_side = Coefficients::zeros();
    for &[u, v, w] in rows {
        let b = monomials(constant, u, v);
        let weight = (-2.0 * decay * (u * u + v * v)).exp();
        matrix.ger(weight, &b, &b, 1.0);
        right_side.axpy(weight * w, &b, 1.0);
    }
    if !matrix.iter().chain(&right_side).all(|x| x.is_finite()) {
        return None;
    }
    if constant == 0.0 {
        // The mean of the other eigenvalues keeps the constant term at zero and the condition of the matrix.
        matrix[(0, 0)] = matrix.trace() / (right_side.len() - 1) as f64;
    }
    well_conditioned_solution(matrix, &right_side)
        .or_else(|| Some(truncated_solution(matrix, &right_side)))
}

type Matrix = SMatrix<f64, 6, 6>;

/// The solution of a system none of whose singular values is too small; `None` where that is not certain.
fn well_conditioned_solution(matrix: Matrix, right_side: &Coefficients) -> Option<Coefficients> {
    let cholesky = matrix.cholesky()?;
    // The trace bounds the largest eigenvalue, that of the inverse the inverse of the smallest.
    let condition = matrix.trace() * cholesky.inverse().trace();
    (condition * SINGULAR_SHARE * SINGULAR_SHARE < 1.0).then(|| cholesky.solve(right_side))
}

/// The solution without the singular values that are too small.
fn truncated_solution(matrix: Matrix, right_side: &Coefficients) -> Coefficients {
    let eigen = SymmetricEigen::new(matrix);
    let smallest = SINGULAR_SHARE * SINGULAR_SHARE * eigen.eigenvalues.max();
    let mut solution = Coefficients::zeros();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > smallest {
            solution.axpy(vector.dot(right_side) / value, &vector, 1.0);
        }
    }
    solution
}
