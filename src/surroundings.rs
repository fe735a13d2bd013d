//! Normals and noise of the known surface, from quadrics fitted to positions alone.
//!
//! Based on: F. Cazals, M. Pouget, "Estimating differential quantities using polynomial fitting of osculating
//! jets", Computer Aided Geometric Design 22(2), 2005, section 3 (height functions over a local frame, fitted by
//! least squares with truncated singular values). Unlike there, neighbours are taken by edges, not by distance:
//! rings round a vertex stay on the sheet and follow the sampling where it is stretched.
//!
//! Normals of triangles average over half an edge; at a rim they do so to one side only and lean by the angle that
//! the surface turns over half an edge. The quadric's tangent plane at the vertex does not.
//!
//! A fit costs `O(k)` for `k` neighbours, some twenty, and a 5x5 or 6x6 eigenvalue problem. Not guaranteed: that
//! the fitted normal is better than that of the triangles where the surface has a crease.

use crate::error::Result;
use crate::job::Job;
use crate::math::{Vec3, unit};
use crate::patch::HoleShape;
use nalgebra::{SMatrix, SVector, SymmetricEigen};
use std::f64::consts::FRAC_1_SQRT_2;

/// Rings of neighbours that a fit starts with.
const RINGS: usize = 2;
/// A fit wants this many vertices, the fitted one included, and takes up to [`EXTRA_RINGS`] more rings for them.
const ENOUGH_NEIGHBORS: usize = 9;
const EXTRA_RINGS: usize = 2;
/// Fewer neighbours than this do not determine a quadric.
const FEWEST_NEIGHBORS: usize = 6;
/// Cosine of the angle between normals from which on a neighbour lies on another side of the model.
const SAME_SIDE: f64 = 0.2;
/// Singular values below this share of the largest are noise of the sampling pattern.
const SINGULAR_SHARE: f64 = 1e-3;
/// Decay of the weights with the squared distance, in units of the mean squared distance: an interpolating fit
/// is local, a smoothing one needs all its neighbours.
const INTERPOLATING_DECAY: f64 = 1.0;
const SMOOTHING_DECAY: f64 = 0.3;
/// Vertices at which noise is estimated, at most: their median does not need all.
const NOISE_PROBES: usize = 50;
/// What a quadric misses of a smooth surface grows with the cube of the distance: over three rings it deviates by
/// 1.5³ times as much as over two, in squares by this factor. Noise does not grow.
const SQUARED_GROWTH: f64 = 11.390625;

/// The known surface round a hole as vertices with neighbours.
pub(crate) struct Band {
    /// Positions: rim vertices, then those of the surroundings.
    pub(crate) points: Vec<Vec3>,
    /// Ring of each vertex, 0 on the rim.
    pub(crate) levels: Vec<u32>,
    /// Normals averaged over the triangles at each vertex with their angles as weights; zero where there is none.
    pub(crate) triangle_normals: Vec<Vec3>,
    neighbor_starts: Vec<u32>,
    neighbors: Vec<u32>,
}

/// The surface near a vertex as a smoothing fit sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smoothed {
    /// The vertex moved onto the fitted quadric.
    pub(crate) point: Vec3,
    /// Unit normal of the quadric there.
    pub(crate) normal: Vec3,
    /// Standard deviation of the neighbours from the quadric.
    pub(crate) deviation: f64,
}

impl Band {
    /// Reads the surroundings of a hole. `O(n)` for `n` triangles in them.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Cancelled`] when the job is stopped.
    pub(crate) fn new(hole: &HoleShape, job: &Job<'_>) -> Result<Self> {
        let rim_count = hole.points.len();
        let mut points = hole.points.clone();
        points.extend_from_slice(&hole.surroundings.points);
        let mut levels = vec![0; rim_count];
        levels.extend_from_slice(&hole.surroundings.levels);
        let mut triangle_normals = vec![Vec3::zeros(); points.len()];
        let triangles = &hole.surroundings.triangles;
        let mut starts = vec![0_u32; points.len() + 1];
        for t in triangles {
            job.tick(4)?;
            let p = t.map(|v| points[v as usize]);
            let normal = unit((p[1] - p[0]).cross(&(p[2] - p[0])));
            for k in 0..3 {
                let a = t[k];
                starts[a as usize + 1] += 2;
                let angle = (p[(k + 1) % 3] - p[k]).angle(&(p[(k + 2) % 3] - p[k]));
                triangle_normals[a as usize] += angle * normal;
            }
        }
        triangle_normals.iter_mut().for_each(|n| *n = unit(*n));
        job.ask()?;
        for v in 0..points.len() {
            starts[v + 1] += starts[v];
        }
        // The two other corners of each triangle at each vertex: most neighbours occur twice.
        let mut places = starts.clone();
        let mut corners = vec![0_u32; 6 * triangles.len()];
        for t in triangles {
            job.tick(4)?;
            for k in 0..3 {
                let place = &mut places[t[k] as usize];
                let at = *place as usize;
                (corners[at], corners[at + 1]) = (t[(k + 1) % 3], t[(k + 2) % 3]);
                *place += 2;
            }
        }
        let mut neighbor_starts = vec![0_u32; points.len() + 1];
        let mut neighbors = Vec::with_capacity(corners.len() / 2);
        for v in 0..points.len() {
            job.tick(4)?;
            let row = &mut corners[starts[v] as usize..starts[v + 1] as usize];
            row.sort_unstable();
            for (i, &u) in row.iter().enumerate() {
                if i == 0 || u != row[i - 1] {
                    neighbors.push(u);
                }
            }
            neighbor_starts[v + 1] = neighbors.len() as u32;
        }
        job.ask()?;
        Ok(Self {
            points,
            levels,
            triangle_normals,
            neighbor_starts,
            neighbors,
        })
    }

    /// The vertices whose level is in `levels`, in ascending order.
    pub(crate) fn vertices_in(&self, levels: std::ops::Range<u32>) -> Vec<u32> {
        (0..self.points.len() as u32)
            .filter(|&v| levels.contains(&self.levels[v as usize]))
            .collect()
    }

    /// The unit normal at a vertex of the quadric that passes through it and fits its neighbours; that of the
    /// triangles where there are too few neighbours.
    pub(crate) fn interpolating_normal(&self, vertex: u32) -> Vec3 {
        let fallback = self.triangle_normals[vertex as usize];
        let mut near = self.neighborhood(vertex, RINGS);
        near.retain(|&u| u != vertex);
        if near.len() + 1 < FEWEST_NEIGHBORS {
            return fallback;
        }
        let frame = JetFrame::new(self.points[vertex as usize], fallback);
        let (rows, _) = frame.heights(&self.points, &near);
        let Some(c) = least_squares(&rows, INTERPOLATING_DECAY, 0.0) else {
            return fallback;
        };
        unit(frame.normal - c[1] * frame.u - c[2] * frame.v)
    }

    /// The same at the first `count` vertices: those of the rim come first.
    ///
    /// # Errors
    /// `Cancelled` when the job is stopped.
    pub(crate) fn interpolating_normals(&self, count: usize, job: &Job<'_>) -> Result<Vec<Vec3>> {
        let mut normals = Vec::with_capacity(count);
        for v in 0..count {
            job.tick(200)?;
            normals.push(self.interpolating_normal(v as u32));
        }
        Ok(normals)
    }

    /// The quadric that fits a vertex and its neighbours within `rings`, without passing through any of them;
    /// `None` where there are too few.
    pub(crate) fn smoothed(&self, vertex: u32, rings: usize) -> Option<Smoothed> {
        let near = self.neighborhood(vertex, rings);
        if near.len() < FEWEST_NEIGHBORS {
            return None;
        }
        let mean: Vec3 = near
            .iter()
            .map(|&u| self.triangle_normals[u as usize])
            .sum();
        let frame = JetFrame::new(self.points[vertex as usize], unit(mean));
        let (rows, scale) = frame.heights(&self.points, &near);
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
    /// neighbours, without what fits over two and over three rings show to be the shape of the surface.
    pub(crate) fn noise(&self, last_level: u32) -> f64 {
        let vertices = self.vertices_in(0..last_level + 1);
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

    fn neighbors(&self, vertex: u32) -> &[u32] {
        let at = |v: u32| self.neighbor_starts[v as usize] as usize;
        &self.neighbors[at(vertex)..at(vertex + 1)]
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
                for &u in self.neighbors(near[i]) {
                    if !near.contains(&u) {
                        near.push(u);
                    }
                }
            }
            ring_start = ring_end;
        }
        let normal = self.triangle_normals[vertex as usize];
        near.retain(|&u| self.triangle_normals[u as usize].dot(&normal) > SAME_SIDE);
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
        // The axis that the normal has least of gives the best conditioned product.
        let axis = normal.iamin();
        let u = unit(normal.cross(&Vec3::ith(axis, 1.0)));
        Self {
            origin,
            normal,
            u,
            v: normal.cross(&u),
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
