//! k-harmonic fairing: moves the interior vertices of a patch to the minimum of an energy. The rim and the mesh round
//! it do not move.
//!
//! Let `L` be the stiffness matrix of the Laplacian, `M` the diagonal matrix of the vertex areas, and `x` the
//! positions. The energies are
//!
//! * order 1: the membrane energy `xᵀ L x`;
//! * order 2: `|M^(-1/2) L x|²`, summed over interior and rim vertices. It reads one ring of triangles of the mesh,
//!   which gives common tangent planes;
//! * order 3: `gᵀ L g` with `g = M⁻¹ L x`, over interior, rim and ring 1 vertices. It reads two rings, which gives
//!   common curvature.
//!
//! Each is minimized by one sparse linear system.
//!
//! Sources: L. Kobbelt, S. Campagna, J. Vorsatz, H.-P. Seidel, "Interactive multi-resolution modeling on
//! arbitrary meshes", SIGGRAPH 1998; M. Botsch, L. Kobbelt, "An intuitive framework for real-time freeform
//! modeling", ACM TOG 23(3), 2004; P. Liepa, "Filling holes in meshes", SGP 2003, for the names of the orders.
//!
//! In `L` as a quadratic form, negative weights count as zero (except for [`Weights::Voronoi`]), so that the form
//! stays definite where triangles are not Delaunay. Vertices that triangles do not surround, as on another boundary,
//! contribute no energy.
//!
//! Cost: see [`fair`]. Not guaranteed: that the result has no self-intersection, or that it stays near the rim.

use super::laplacian::{Coefficient, FairingDomain, Weights};
use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::adjacency::CompressedRows;
use crate::math::sparse::SpdSolver;
use crate::math::symmetric::SymmetricMatrix;
use crate::patch::PatchSurface;
use crate::surroundings::Surroundings;

/// Order of the energy, which is the number of rings of triangles that it reads plus one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Order {
    /// Membrane: positions are continuous.
    One = 1,
    /// Thin plate: tangent planes are continuous.
    Two = 2,
    /// Minimal variation of curvature: curvatures are continuous.
    Three = 3,
}

/// Usual number of entries of a column of the system from the diagonal down: two rings round a vertex of valence six.
const USUAL_COLUMN: usize = 10;

/// Usual number of entries of a row of the Laplacian, at a vertex of valence six.
const USUAL_ROW: usize = 7;

/// Moves the interior vertices of `surface` to the minimum of the energy. The job of `solver` can be cancelled.
///
/// # Errors
/// [`crate::ErrorKind::Solver`] when the system cannot be solved, [`crate::ErrorKind::Cancelled`]; `surface` is then
/// unchanged.
///
/// # Complexity
/// That of one sparse Cholesky factorization in the number of interior vertices `n`: about `n^1.5`.
pub(crate) fn fair(
    surface: &mut PatchSurface,
    surroundings: &Surroundings,
    order: Order,
    weights: Weights,
    solver: &mut SpdSolver<'_>,
) -> Result<()> {
    let interior = surface.points.len() - surface.rim_count;
    if interior == 0 {
        return Ok(());
    }
    let job = solver.job();
    let domain = FairingDomain::new(surface, surroundings, order as u32 - 1, weights, job)?;
    let (matrix, right_side) = match order {
        Order::One => membrane_equations(&domain, &domain.points[..domain.rim_count], job)?,
        _ => Operator::new(&domain, order).normal_equations(&domain.points, job)?,
    };
    let solution = solver.solve(matrix, &right_side)?;
    give_back(domain, job)?;
    surface.points[surface.rim_count..].copy_from_slice(&solution);
    Ok(())
}

/// Frees the memory of a domain, which takes milliseconds when it is large, and checks whether the job is cancelled.
fn give_back(domain: FairingDomain, job: &Job<'_>) -> Result<()> {
    drop(domain);
    job.ask()
}

/// Extends values at the rim to the interior vertices, three numbers at a time, by the harmonic function with uniform
/// weights. Each interior value is the mean of its neighbors' values, so all stay in the range of the rim.
///
/// # Errors
/// [`crate::ErrorKind::Solver`] when the system cannot be solved.
pub(crate) fn extend_from_rim(
    surface: &PatchSurface,
    rim_values: &[Vec3],
    solver: &mut SpdSolver<'_>,
) -> Result<Vec<Vec3>> {
    let job = solver.job();
    let around = Surroundings::default();
    let domain = FairingDomain::new(surface, &around, 0, Weights::Uniform, job)?;
    let (matrix, right_side) = membrane_equations(&domain, rim_values, job)?;
    let solution = solver.solve(matrix, &right_side)?;
    give_back(domain, job)?;
    Ok(solution)
}

/// Extends values at the rim and round it to the interior vertices, three numbers at a time, by the minimum of the
/// thin-plate energy. They continue with the slope that they have at the rim, and may leave the range of the rim.
/// `around_values` belong to the points of `surroundings`.
///
/// # Errors
/// [`crate::ErrorKind::Solver`] when the system cannot be solved.
pub(crate) fn extend_with_slope(
    surface: &PatchSurface,
    surroundings: &Surroundings,
    rim_values: &[Vec3],
    around_values: &[Vec3],
    solver: &mut SpdSolver<'_>,
) -> Result<Vec<Vec3>> {
    let job = solver.job();
    let domain = FairingDomain::new(surface, surroundings, 1, Weights::Cotangent, job)?;
    let mut values = vec![Vec3::zeros(); domain.vertex_count()];
    values[..domain.rim_count].copy_from_slice(rim_values);
    values[domain.patch_count..].copy_from_slice(around_values);
    let operator = Operator::new(&domain, Order::Two);
    let (matrix, right_side) = operator.normal_equations(&values, job)?;
    let solution = solver.solve(matrix, &right_side)?;
    give_back(domain, job)?;
    Ok(solution)
}

/// The energy of order two or three as a quadratic form, applied to sparse vectors.
struct Operator<'a> {
    domain: &'a FairingDomain,
    order: Order,
    /// Whether the vertex is in the sum of the energy.
    is_summed: Vec<bool>,
}

impl<'a> Operator<'a> {
    fn new(domain: &'a FairingDomain, order: Order) -> Self {
        let last_level = if order == Order::Three { 1 } else { 0 };
        let is_summed = (0..domain.vertex_count())
            .map(|v| domain.levels[v] <= last_level && domain.is_complete[v])
            .collect();
        Self {
            domain,
            order,
            is_summed,
        }
    }

    /// `out += factor * L[:, vertex]` restricted to the summed rows.
    fn add_column(&self, vertex: usize, factor: f64, out: &mut SparseVector) {
        let mut diagonal = 0.0;
        for e in self.domain.row(vertex) {
            diagonal += e.weight;
            if self.is_summed[e.column as usize] {
                out.add(e.column, factor * e.weight);
            }
        }
        if self.is_summed[vertex] {
            out.add(vertex as u32, -factor * diagonal);
        }
    }

    /// `out += factor * K[:, vertex]` where `K` is the stiffness matrix between summed vertices.
    fn add_stiffness(&self, vertex: usize, factor: f64, out: &mut SparseVector) {
        let mut diagonal = 0.0;
        for e in self.domain.row(vertex) {
            if self.is_summed[e.column as usize] {
                let weight = self.domain.form_weight(e);
                diagonal += weight;
                out.add(e.column, -factor * weight);
            }
        }
        out.add(vertex as u32, factor * diagonal);
    }

    /// The rows `S L[:, vertex]` of the normal equations, with `S` the inner product of the energy.
    fn weighted_column(&self, vertex: usize, scratch: &mut Scratch) {
        scratch.a.clear();
        scratch.b.clear();
        self.add_column(vertex, 1.0, &mut scratch.a);
        for &r in &scratch.a.support {
            let value = scratch.a.values[r as usize] / self.domain.areas[r as usize];
            match self.order {
                Order::Three => self.add_stiffness(r as usize, value, &mut scratch.b),
                _ => scratch.b.add(r, value),
            }
        }
        if self.order == Order::Three {
            for &r in &scratch.b.support {
                scratch.b.values[r as usize] /= self.domain.areas[r as usize];
            }
        }
    }

    /// Matrix and right-hand side over the interior vertices; the others keep their `values`.
    fn normal_equations(
        &self,
        values: &[Vec3],
        job: &Job<'_>,
    ) -> Result<(SymmetricMatrix, Vec<Vec3>)> {
        let domain = self.domain;
        let mut fixed = vec![Vec3::zeros(); domain.vertex_count()];
        for v in self.fixed_vertices() {
            let p = values[v];
            let mut diagonal = 0.0;
            for e in domain.row(v) {
                diagonal += e.weight;
                fixed[e.column as usize] += e.weight * p;
            }
            fixed[v] -= diagonal * p;
        }
        let rows = self.interior_rows();
        let mut scratch = Scratch::new(domain.vertex_count());
        let interior = domain.patch_count - domain.rim_count;
        let mut matrix = SymmetricMatrix {
            column_starts: Vec::with_capacity(interior + 1),
            rows: Vec::with_capacity(USUAL_COLUMN * interior),
            values: Vec::with_capacity(USUAL_COLUMN * interior),
        };
        matrix.column_starts.push(0);
        let mut right_side = Vec::with_capacity(interior);
        for v in domain.rim_count..domain.patch_count {
            job.tick(100)?;
            self.weighted_column(v, &mut scratch);
            let Scratch { b, c, .. } = &mut scratch;
            c.clear();
            let mut sum = Vec3::zeros();
            for &r in &b.support {
                let value = b.values[r as usize];
                sum -= value * fixed[r as usize];
                let from_the_end = rows.of(r).iter().rev();
                for e in from_the_end.take_while(|e| e.column as usize >= v) {
                    c.add(e.column, value * e.weight);
                }
            }
            right_side.push(sum);
            c.support.sort_unstable();
            let first = domain.rim_count as u32;
            matrix.rows.extend(c.support.iter().map(|&i| i - first));
            let values = c.support.iter().map(|&i| c.values[i as usize]);
            matrix.values.extend(values);
            matrix.column_starts.push(matrix.rows.len() as u32);
        }
        Ok((matrix, right_side))
    }

    /// The rows of `L` at the summed vertices, with the diagonal, restricted to interior columns.
    fn interior_rows(&self) -> CompressedRows<Coefficient> {
        let domain = self.domain;
        let interior = domain.rim_count..domain.patch_count;
        let mut rows =
            CompressedRows::with_capacity(domain.vertex_count(), USUAL_ROW * interior.len());
        for (r, is_summed) in self.is_summed.iter().enumerate() {
            let row = if *is_summed { domain.row(r) } else { &[] };
            let (before, behind) = row.split_at(row.partition_point(|e| (e.column as usize) < r));
            let diagonal = Coefficient {
                column: r as u32,
                weight: -row.iter().map(|e| e.weight).sum::<f64>(),
            };
            let whole = before.iter().chain([&diagonal]).chain(behind);
            let inside = |e: &&Coefficient| *is_summed && interior.contains(&(e.column as usize));
            rows.append(whole.filter(inside).copied());
        }
        rows
    }

    fn fixed_vertices(&self) -> impl Iterator<Item = usize> {
        let domain = self.domain;
        (0..domain.rim_count).chain(domain.patch_count..domain.vertex_count())
    }
}

/// Matrix and right-hand side of the membrane over the interior vertices.
fn membrane_equations(
    domain: &FairingDomain,
    rim_values: &[Vec3],
    job: &Job<'_>,
) -> Result<(SymmetricMatrix, Vec<Vec3>)> {
    let mut matrix = SymmetricMatrix {
        column_starts: vec![0],
        ..SymmetricMatrix::default()
    };
    let mut right_side = Vec::with_capacity(domain.patch_count - domain.rim_count);
    for v in domain.rim_count..domain.patch_count {
        job.tick(10)?;
        let diagonal_at = matrix.values.len();
        matrix.rows.push((v - domain.rim_count) as u32);
        matrix.values.push(0.0);
        let mut sum = Vec3::zeros();
        for e in domain.row(v) {
            let weight = domain.form_weight(e);
            matrix.values[diagonal_at] += weight;
            let u = e.column as usize;
            if u < domain.rim_count {
                sum += weight * rim_values[u];
            } else if u > v {
                matrix.rows.push((u - domain.rim_count) as u32);
                matrix.values.push(-weight);
            }
        }
        right_side.push(sum);
        matrix.column_starts.push(matrix.rows.len() as u32);
    }
    Ok((matrix, right_side))
}

struct Scratch {
    a: SparseVector,
    b: SparseVector,
    c: SparseVector,
}

impl Scratch {
    fn new(size: usize) -> Self {
        Self {
            a: SparseVector::new(size),
            b: SparseVector::new(size),
            c: SparseVector::new(size),
        }
    }
}

/// A vector with few non-zero entries, stored densely with a list of them.
struct SparseVector {
    values: Vec<f64>,
    is_listed: Vec<bool>,
    support: Vec<u32>,
}

impl SparseVector {
    fn new(size: usize) -> Self {
        Self {
            values: vec![0.0; size],
            is_listed: vec![false; size],
            support: Vec::new(),
        }
    }

    fn add(&mut self, index: u32, value: f64) {
        let i = index as usize;
        if !self.is_listed[i] {
            self.is_listed[i] = true;
            self.support.push(index);
        }
        self.values[i] += value;
    }

    fn clear(&mut self) {
        for &index in &self.support {
            self.values[index as usize] = 0.0;
            self.is_listed[index as usize] = false;
        }
        self.support.clear();
    }
}
